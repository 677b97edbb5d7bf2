//! One interface to the casters or receivers of a planner, a list or a set.

use glam::DVec3;

use super::gathered::{Gathered, Most};
use super::kind::{Ask, Layers, Role};
use super::ordered_list::OrderedList;
use super::packed::asked::AskedRun;
use super::set::CasterSet;
use super::tree::{self, Asked, Collect, Counter, Near};
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
    List(&'a OrderedList),
    Set { set: &'a CasterSet, ask: Ask, all: bool },
}

impl<'a> Crowd<'a> {
    /// The boxes of a list, named by their places in it. Tests are taken as seen from `eye`.
    pub fn of_list(list: &'a OrderedList, eye: DVec3, counter: &'a Counter) -> Self {
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
                tree::each(&self.list(list), self.counter, &mut test, &mut |at, placed| visit(list.names[at], placed));
            }
            Boxes::Set { set, ask, .. } => {
                let (runs, loose, kinds) = set.parts();
                for run in runs.iter().flatten() {
                    let name = |lane: usize| run.key(lane);
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
            let name = |lane: usize| run.key(lane);
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
            Boxes::List(list) => list.tree.flats().for_each(|(at, placed)| visit(list.names[at], placed)),
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
        match self.boxes {
            Boxes::List(list) => {
                let collector = &mut Naming { out, name: |at: usize| list.names[at] };
                tree::near(&self.list(list), self.counter, ask, collector);
            }
            Boxes::Set { set, ask: asked_for, .. } => {
                let (runs, loose, kinds) = set.parts();
                for run in runs.iter().flatten() {
                    let collector = &mut Naming { out, name: |place: usize| run.key(place) };
                    tree::near(&self.run(run, kinds), self.counter, ask, collector);
                }
                let collector = &mut Naming { out, name: |at: usize| loose.entries[at].key };
                tree::near(&loose.asked(asked_for, kinds, self.farthest), self.counter, ask, collector);
            }
        }
        out.finish(self.farthest);
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

    fn list(&self, list: &'a OrderedList) -> Asked<'a, impl Fn(usize) -> bool + use<'a>> {
        Asked { tree: &list.tree, farthest: self.farthest, is_for: |_| true }
    }

    fn run<'b>(&self, run: &'b super::packed::Run, kinds: &'b super::kind::Kinds) -> AskedRun<'b> {
        let (ask, all) = match self.boxes {
            Boxes::List(_) => (Ask { layers: Layers::ALL, role: Role::Caster }, true),
            Boxes::Set { ask, all, .. } => (ask, all),
        };
        AskedRun { run, farthest: self.farthest, ask, kinds: (!all).then_some(kinds) }
    }
}

/// Gathers boxes under names, by their places in a tree.
struct Naming<'a, F> {
    out: &'a mut Gathered,
    name: F,
}

impl<F: Fn(usize) -> u32> Collect for Naming<'_, F> {
    fn take(&mut self, place: usize, placed: &Placed) {
        self.out.push((self.name)(place), *placed);
    }

    fn take_all(&mut self, first: usize, boxes: &[Placed]) {
        self.out.names.extend((first..first + boxes.len()).map(&self.name));
        self.out.boxes.extend_from_slice(boxes);
    }

    fn end(&mut self) {
        self.out.end_group();
    }
}

impl Most for Crowd<'_> {
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64 {
        self.most_within(&measure, &measure)
    }
}
