//! One interface to the casters or receivers of a planner, a list or a set.

use glam::DVec3;

use super::kind::{Ask, Layers, Role};
use super::packed::AskedRun;
use super::set::CasterSet;
use super::tree::{self, Asked, BoxTree, Counter, Near, with_room};
use crate::Aabb;
use crate::bounds::Placed;

/// Casters or receivers of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Crowd<'a> {
    boxes: Boxes<'a>,
    /// Metres from the world's origin at which tests are taken.
    farthest: f64,
    counter: &'a Counter,
}

#[derive(Clone, Copy)]
enum Boxes<'a> {
    List(&'a BoxTree),
    Set { set: &'a CasterSet, ask: Ask, all: bool },
}

impl<'a> Crowd<'a> {
    /// The boxes of a list, named by their places in it. Tests are taken as seen from `eye`.
    pub fn of_list(list: &'a BoxTree, eye: DVec3, counter: &'a Counter) -> Self {
        Self { boxes: Boxes::List(list), farthest: eye.abs().element_sum(), counter }
    }

    /// The boxes of a set on some of `layers` and with this role, named by their keys.
    pub fn of_set(set: &'a CasterSet, (layers, role): (Layers, Role), eye: DVec3, counter: &'a Counter) -> Self {
        let ask = Ask { layers, role };
        let all = set.parts().2.are_all_for(ask);
        Self { boxes: Boxes::Set { set, ask, all }, farthest: eye.abs().element_sum(), counter }
    }

    /// Calls `visit` with the names of all boxes that pass a monotone test, and with the boxes.
    pub fn each(&self, mut test: impl FnMut(&Placed) -> bool, mut visit: impl FnMut(u32, &Placed)) {
        match self.boxes {
            Boxes::List(list) => {
                tree::each(&self.list(list), self.counter, &mut test, &mut |at, placed| visit(at as u32, placed));
            }
            Boxes::Set { set, ask, .. } => {
                let (runs, loose, kinds) = set.parts();
                for run in runs.iter().flatten() {
                    let name = |lane: usize| run.about(lane as u32).0;
                    let asked = self.run(run, kinds);
                    tree::each(&asked, self.counter, &mut test, &mut |lane, placed| visit(name(lane), placed));
                }
                let asked = loose.asked(ask, kinds, self.farthest);
                tree::each(&asked, self.counter, &mut test, &mut |at, placed| visit(loose.entries[at].key, placed));
            }
        }
    }

    /// [`Crowd::each`] for a set's static casters alone; a list has none.
    pub fn each_static(&self, mut test: impl FnMut(&Placed) -> bool, mut visit: impl FnMut(u32, &Placed)) {
        let Boxes::Set { set, ask, .. } = self.boxes else { return };
        let (runs, loose, kinds) = set.parts();
        for run in runs.iter().flatten() {
            let name = |lane: usize| run.about(lane as u32).0;
            let asked = self.run(run, kinds);
            tree::each(&asked, self.counter, &mut test, &mut |lane, placed| visit(name(lane), placed));
        }
        let asked = loose.asked(ask, kinds, self.farthest);
        tree::each(&asked, self.counter, &mut test, &mut |at, placed| {
            if !loose.entries[at].moves {
                visit(loose.entries[at].key, placed);
            }
        });
    }

    /// Returns whether any box passes a monotone test.
    pub fn any(&self, test: impl Fn(&Placed) -> bool) -> bool {
        let found = std::cell::Cell::new(false);
        self.each(|placed| !found.get() && test(placed), |_, _| found.set(true));
        found.get()
    }

    /// Returns whether there is no box.
    pub fn is_empty(&self) -> bool {
        !self.any(|_| true)
    }

    /// Calls `visit` with the names of the boxes without thickness, and with the boxes.
    pub fn flats(&self, mut visit: impl FnMut(u32, &Placed)) {
        match self.boxes {
            Boxes::List(list) => list.flats().for_each(|(at, placed)| visit(at as u32, placed)),
            // None of them is packed.
            Boxes::Set { set, ask, .. } => {
                let (_, loose, kinds) = set.parts();
                let asked = loose.flats().filter(|(at, _)| ask.is_for(kinds.get(loose.entries[*at].kind)));
                asked.for_each(|(at, placed)| visit(loose.entries[at].key, placed));
            }
        }
    }

    /// The largest measure of any box. `bound` has to be monotone and nowhere less than `measure`.
    pub fn most_within(&self, bound: impl Fn(&Placed) -> f64, measure: impl Fn(&Placed) -> f64) -> f64 {
        let mut best = f64::NEG_INFINITY;
        match self.boxes {
            Boxes::List(list) => best = tree::most(&self.list(list), self.counter, best, (&bound, &measure)),
            Boxes::Set { set, ask, .. } => {
                let (runs, loose, kinds) = set.parts();
                best = tree::most(&loose.asked(ask, kinds, self.farthest), self.counter, best, (&bound, &measure));
                for run in runs.iter().flatten() {
                    best = tree::most(&self.run(run, kinds), self.counter, best, (&bound, &measure));
                }
            }
        }
        best
    }

    /// Gathers the boxes that come near a convex volume.
    pub fn near(&self, ask: &Near<'_>, out: &mut Gathered) {
        out.clear();
        let out = std::cell::RefCell::new(out);
        let end = &mut || out.borrow_mut().end_group();
        match self.boxes {
            Boxes::List(list) => {
                let visit = &mut |at: usize, placed: &Placed| out.borrow_mut().push(at as u32, *placed);
                tree::near(&self.list(list), self.counter, ask, visit, end);
            }
            Boxes::Set { set, ask: asked_for, .. } => {
                let (runs, loose, kinds) = set.parts();
                for run in runs.iter().flatten() {
                    let visit =
                        &mut |lane: usize, placed: &Placed| out.borrow_mut().push(run.about(lane as u32).0, *placed);
                    tree::near(&self.run(run, kinds), self.counter, ask, visit, end);
                }
                let visit = &mut |at: usize, placed: &Placed| out.borrow_mut().push(loose.entries[at].key, *placed);
                tree::near(&loose.asked(asked_for, kinds, self.farthest), self.counter, ask, visit, end);
            }
        }
        out.borrow_mut().finish(self.farthest);
    }

    /// Gathers the boxes that pass a monotone test.
    pub fn gather(&self, test: impl FnMut(&Placed) -> bool, out: &mut Gathered) {
        out.clear();
        self.each(test, |name, placed| {
            out.push(name, *placed);
            if out.len().is_multiple_of(tree::WIDE) {
                out.end_group();
            }
        });
        out.end_group();
        out.finish(self.farthest);
    }

    fn list(&self, tree: &'a BoxTree) -> Asked<'a, impl Fn(usize) -> bool> {
        Asked { tree, farthest: self.farthest, is_for: |_| true }
    }

    fn run<'b>(&self, run: &'b super::packed::Run, kinds: &'b super::kind::Kinds) -> AskedRun<'b> {
        let (ask, all) = match self.boxes {
            Boxes::List(_) => (Ask { layers: Layers::ALL, role: Role::Caster }, true),
            Boxes::Set { ask, all, .. } => (ask, all),
        };
        AskedRun { run, farthest: self.farthest, ask, kinds: (!all).then_some(kinds) }
    }
}

/// Boxes whose largest measure is found without looking at each.
pub(crate) trait Most {
    /// The largest value of a monotone measure; −∞ if there is no box.
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64;

    /// The box around all boxes that pass a monotone test.
    fn bounds(&self, test: impl Fn(&Placed) -> bool) -> Aabb {
        let end = |of: &dyn Fn(&Placed) -> f64| self.most(|it| if test(it) { of(it) } else { f64::NEG_INFINITY });
        let least = |axis: usize| -end(&|it| -(it.center[axis] - it.half[axis]));
        let most = |axis: usize| end(&|it| it.center[axis] + it.half[axis]);
        Aabb::new(DVec3::new(least(0), least(1), least(2)), DVec3::new(most(0), most(1), most(2)))
    }
}

impl Most for Crowd<'_> {
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64 {
        self.most_within(&measure, &measure)
    }
}

impl Most for Gathered {
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64 {
        self.groups.iter().fold(f64::NEG_INFINITY, |best, group| match measure(&group.bounds) > best {
            true => self.boxes[group.range()].iter().map(&measure).fold(best, f64::max),
            false => best,
        })
    }
}

/// Gathered boxes in groups of neighbours, with their names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gathered {
    pub boxes: Vec<Placed>,
    pub names: Vec<u32>,
    pub groups: Vec<Group>,
    /// True once names have been put in order.
    is_ordered: bool,
    /// Places of boxes sorted by name, and the rank of each. Empty if boxes are already in that
    /// order.
    order: Vec<(u32, u32)>,
    ranks: Vec<u32>,
    /// Scratch: a bit for each rank.
    marks: Vec<u64>,
    /// Scratch: places in order.
    ordered: Vec<u32>,
}

/// Boxes that lie beside each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// Box around all of them, with room for rounding.
    pub bounds: Placed,
    /// Box around all of them, exact.
    pub exact: Aabb,
    pub begin: u32,
    pub end: u32,
}

impl Group {
    pub fn range(&self) -> std::ops::Range<usize> {
        self.begin as usize..self.end as usize
    }
}

impl Gathered {
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    fn clear(&mut self) {
        self.is_ordered = false;
        self.boxes.clear();
        self.names.clear();
        self.groups.clear();
    }

    fn push(&mut self, name: u32, placed: Placed) {
        self.names.push(name);
        self.boxes.push(placed);
    }

    fn end_group(&mut self) {
        let begin = self.groups.last().map_or(0, |group| group.end as usize);
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for placed in &self.boxes[begin..] {
            (min, max) = (min.min(placed.center - placed.half), max.max(placed.center + placed.half));
        }
        if begin < self.boxes.len() {
            let bounds = Placed { center: 0.5 * (min + max), half: 0.5 * (max - min) };
            let exact = Aabb::new(min, max);
            self.groups.push(Group { bounds, exact, begin: begin as u32, end: self.boxes.len() as u32 });
        }
    }

    /// Ends the gathering: enlarges groups for tests that are taken `farthest` metres from the
    /// origin.
    fn finish(&mut self, farthest: f64) {
        for group in &mut self.groups {
            group.bounds = with_room(group.bounds, farthest);
        }
    }

    /// Puts names in order when they are first needed.
    fn order(&mut self) {
        if self.is_ordered {
            return;
        }
        self.is_ordered = true;
        self.order.clear();
        self.ranks.clear();
        if self.names.is_sorted() {
            return;
        }
        self.order.extend(self.names.iter().zip(0..).map(|(&name, at)| (name, at)));
        self.order.sort_unstable();
        self.ranks.resize(self.names.len(), 0);
        for (&(_, at), rank) in self.order.iter().zip(0..) {
            self.ranks[at as usize] = rank;
        }
    }

    /// All boxes in the order of their names.
    pub fn in_order(&mut self) -> impl Iterator<Item = &Placed> {
        self.order();
        let is_ordered = self.order.is_empty();
        let ordered = self.boxes.iter().filter(move |_| is_ordered);
        ordered.chain(self.order.iter().map(|&(_, at)| &self.boxes[at as usize]))
    }

    /// Some boxes, by their places, in the order of their names.
    pub fn ordered(&mut self, places: &[u32]) -> impl Iterator<Item = &Placed> {
        self.order();
        self.ordered.clear();
        if self.order.is_empty() {
            self.ordered.extend_from_slice(places);
        } else {
            self.ordered.extend(places.iter().map(|&at| self.ranks[at as usize]));
            self.ordered.sort_unstable();
            self.ordered.iter_mut().for_each(|rank| *rank = self.order[*rank as usize].1);
        }
        self.ordered.iter().map(|&at| &self.boxes[at as usize])
    }

    /// Appends the names of some boxes, by their places, in rising order and each once.
    pub fn name(&mut self, places: &[u32], names: &mut Vec<u32>) {
        self.order();
        let begin = names.len();
        if self.order.is_empty() {
            names.extend(places.iter().map(|&at| self.names[at as usize]));
            debug_assert!(names[begin..].is_sorted(), "boxes stand in the order of their names");
        } else {
            self.marks.clear();
            self.marks.resize(self.order.len().div_ceil(64), 0);
            for &at in places {
                let rank = self.ranks[at as usize];
                self.marks[rank as usize / 64] |= 1 << (rank % 64);
            }
            for (word, &marks) in self.marks.iter().enumerate() {
                let mut left = marks;
                while left != 0 {
                    names.push(self.order[64 * word + left.trailing_zeros() as usize].0);
                    left &= left - 1;
                }
            }
        }
        // Casters that share a name are drawn as one.
        let mut kept = begin;
        for at in begin..names.len() {
            if kept == begin || names[kept - 1] != names[at] {
                names[kept] = names[at];
                kept += 1;
            }
        }
        names.truncate(kept);
    }
}
