//! Wide trees of boxes and their queries.
//!
//! Every query is one of three: the boxes that pass a test ([`each`]), the largest measure of any
//! box ([`most`]), and the boxes that come near a convex volume ([`near`]). A test or a measure has
//! to be *monotone*: if it holds for a box, it holds for any box around it. A query therefore
//! starts at the boxes of nodes, and skips all boxes below a node that fails.

use std::cell::Cell;

use glam::DVec3;

use crate::bounds::Placed;
use crate::geometry::volume::Plane;

/// Children of a node, and boxes of a leaf.
pub(crate) const WIDE: usize = 16;

/// Levels of nodes above the leaves, at most: 16^8 boxes and more.
const MOST_LEVELS: usize = 8;

/// Share of a coordinate by which rounding may change the box that a test or measure sees, with
/// room to spare.
const ROUNDING: f64 = 1e-13;

/// Cost of queries as counts, independent of the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Visited {
    /// Nodes that were tested or measured.
    pub nodes: u64,
    /// Boxes that were tested or measured.
    pub boxes: u64,
}

/// Counter that queries update through a shared reference.
pub(crate) type Counter = Cell<Visited>;

pub(crate) fn count(counter: &Counter, nodes: usize, boxes: usize) {
    let Visited { nodes: all_nodes, boxes: all_boxes } = counter.get();
    counter.set(Visited { nodes: all_nodes + nodes as u64, boxes: all_boxes + boxes as u64 });
}

/// A tree of nodes in groups of up to [`WIDE`]. Group `g` of level 0 has the leaves from `WIDE * g`
/// on, a group of a higher level the groups of the level below; the top level is one group.
pub(crate) trait Tree {
    /// Levels of groups; 0 if there is no box.
    fn levels(&self) -> usize;

    /// A node of a group, with a little room for rounding; `None` if it has no boxes that are
    /// queried.
    fn node(&self, level: usize, group: usize, lane: usize) -> Option<Placed>;

    /// A box around all boxes, with a little room for rounding, where one is kept.
    fn whole(&self) -> Option<Placed> {
        None
    }

    /// Calls `each` with the boxes of a leaf that are queried, by their places in the tree.
    fn leaf(&self, leaf: usize, each: &mut impl FnMut(usize, &Placed));

    /// Calls `each` with the lanes of a group that come within `margin` of those planes whose bits
    /// are set in `asked`, and with the planes that still have to be tested for boxes inside.
    fn near_lanes(&self, level: usize, group: usize, ask: &Near<'_>, asked: u32, each: &mut impl FnMut(usize, u32)) {
        for lane in 0..WIDE {
            if let Some(node) = self.node(level, group, lane)
                && let Some(left) = ask.left_of(&node, asked)
            {
                each(lane, left);
            }
        }
    }

    /// Hands `collector` those boxes of a leaf that are near. Only the planes of `asked` are
    /// tested. Returns the number of boxes tested.
    fn near_boxes(&self, leaf: usize, ask: &Near<'_>, asked: u32, collector: &mut impl Collect) -> usize {
        let mut tested = 0;
        self.leaf(leaf, &mut |place, placed| {
            tested += usize::from(asked != 0);
            if asked == 0 || ask.meets(placed) {
                collector.take(place, placed);
            }
        });
        tested
    }
}

/// Takes boxes leaf by leaf.
pub(crate) trait Collect {
    /// Takes a box, by its place in the tree.
    fn take(&mut self, place: usize, placed: &Placed);

    /// Takes boxes whose places follow each other.
    fn take_all(&mut self, first: usize, boxes: &[Placed]) {
        boxes.iter().zip(first..).for_each(|(placed, place)| self.take(place, placed));
    }

    /// Ends a leaf.
    fn end(&mut self);
}

/// A convex volume and a margin around it in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near<'a> {
    pub planes: &'a [Plane],
    pub margin: f64,
}

impl Near<'_> {
    /// Returns whether a box comes within the margin of all planes:
    /// [`crate::geometry::volume::SweptVolume::meets`].
    pub fn meets(&self, placed: &Placed) -> bool {
        self.planes.iter().all(|plane| plane.nearest(placed.center, placed.half) <= self.margin)
    }

    /// Planes of `asked` that still have to be tested for boxes inside a node; `None` if no box
    /// inside can be near.
    fn left_of(&self, node: &Placed, asked: u32) -> Option<u32> {
        let mut left = 0;
        for (bit, plane) in self.planes.iter().enumerate().filter(|(bit, _)| asked >> bit & 1 == 1) {
            let (distance, reach) = (plane.distance(node.center), plane.normal.abs().dot(node.half));
            if distance - reach > self.margin {
                return None;
            }
            left |= u32::from(distance + reach > self.margin) << bit;
        }
        Some(left)
    }
}

/// Calls `visit` with every box that passes `test`, which has to be monotone, by its place in the
/// tree.
pub(crate) fn each(
    tree: &impl Tree,
    counter: &Counter,
    test: &mut impl FnMut(&Placed) -> bool,
    visit: &mut impl FnMut(usize, &Placed),
) {
    let Some(top) = tree.levels().checked_sub(1) else { return };
    if let Some(whole) = tree.whole() {
        count(counter, 1, 0);
        if !test(&whole) {
            return;
        }
    }
    each_below(tree, counter, (top, 0), test, visit);
}

fn each_below(
    tree: &impl Tree,
    counter: &Counter,
    (level, group): (usize, usize),
    test: &mut impl FnMut(&Placed) -> bool,
    visit: &mut impl FnMut(usize, &Placed),
) {
    for lane in 0..WIDE {
        let Some(node) = tree.node(level, group, lane) else { continue };
        count(counter, 1, 0);
        if !test(&node) {
            continue;
        }
        let child = WIDE * group + lane;
        if level > 0 {
            each_below(tree, counter, (level - 1, child), test, visit);
            continue;
        }
        tree.leaf(child, &mut |place, placed| {
            count(counter, 0, 1);
            if test(placed) {
                visit(place, placed);
            }
        });
    }
}

/// The largest measure of any box and `best`. For a box, `bound` has to be at least the measure of
/// every box inside it, but for rounding.
pub(crate) fn most(
    tree: &impl Tree,
    counter: &Counter,
    best: f64,
    (bound, measure): (&impl Fn(&Placed) -> f64, &impl Fn(&Placed) -> f64),
) -> f64 {
    let Some(top) = tree.levels().checked_sub(1) else { return best };
    if let Some(whole) = tree.whole() {
        count(counter, 1, 0);
        if bound(&whole) <= best {
            return best;
        }
    }
    most_below(tree, counter, (top, 0), best, (bound, measure))
}

fn most_below(
    tree: &impl Tree,
    counter: &Counter,
    (level, group): (usize, usize),
    mut best: f64,
    (bound, measure): (&impl Fn(&Placed) -> f64, &impl Fn(&Placed) -> f64),
) -> f64 {
    // The most promising first.
    let (mut bounds, mut lanes, mut len) = ([0.0; WIDE], [0; WIDE], 0);
    for lane in 0..WIDE {
        let Some(node) = tree.node(level, group, lane) else { continue };
        count(counter, 1, 0);
        let value = bound(&node);
        if value <= best {
            continue;
        }
        let at = bounds[..len].iter().position(|&other| other < value).unwrap_or(len);
        bounds.copy_within(at..len, at + 1);
        lanes.copy_within(at..len, at + 1);
        (bounds[at], lanes[at], len) = (value, lane, len + 1);
    }
    for (&value, &lane) in bounds[..len].iter().zip(&lanes) {
        if value <= best {
            break;
        }
        let child = WIDE * group + lane;
        if level > 0 {
            best = most_below(tree, counter, (level - 1, child), best, (bound, measure));
        } else {
            tree.leaf(child, &mut |_, placed| {
                count(counter, 0, 1);
                best = best.max(measure(placed));
            });
        }
    }
    best
}

/// Hands `collector` the boxes that come near a volume, leaf by leaf.
pub(crate) fn near(tree: &impl Tree, counter: &Counter, ask: &Near<'_>, collector: &mut impl Collect) {
    let Some(top) = tree.levels().checked_sub(1) else { return };
    let mut asked = ((1u64 << ask.planes.len()) - 1) as u32;
    if let Some(whole) = tree.whole() {
        count(counter, 1, 0);
        let Some(left) = ask.left_of(&whole, asked) else { return };
        asked = left;
    }
    near_below(tree, counter, (top, 0), (ask, asked), collector);
}

fn near_below(
    tree: &impl Tree,
    counter: &Counter,
    (level, group): (usize, usize),
    (ask, asked): (&Near<'_>, u32),
    collector: &mut impl Collect,
) {
    debug_assert!(level < MOST_LEVELS, "sixteen to the eighth is more than there can be");
    count(counter, WIDE, 0);
    let (mut lanes, mut len) = ([(0, 0); WIDE], 0);
    tree.near_lanes(level, group, ask, asked, &mut |lane, left| {
        (lanes[len], len) = ((lane, left), len + 1);
    });
    for &(lane, left) in &lanes[..len] {
        let child = WIDE * group + lane;
        if level > 0 {
            near_below(tree, counter, (level - 1, child), (ask, left), collector);
            continue;
        }
        let tested = tree.near_boxes(child, ask, left, collector);
        count(counter, 0, tested);
        collector.end();
    }
}

/// The box enlarged by room for the rounding of tests and measures that are taken `farthest` metres
/// from the origin.
pub(crate) fn with_room(Placed { center, half }: Placed, farthest: f64) -> Placed {
    let room = ROUNDING * ((center.abs() + half).element_sum() + farthest);
    Placed { center, half: half + DVec3::splat(room) }
}

/// A tree over boxes in the order in which they are given; its quality is that of the order.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoxTree {
    boxes: Vec<Placed>,
    /// Nodes, starting with the level above the leaves. All levels but the last have more than
    /// [`WIDE`] nodes below.
    levels: Vec<Vec<Placed>>,
    /// Number of levels in use; the others keep their memory.
    height: usize,
    /// For each leaf a mask of the boxes without thickness, one bit each.
    flats: Vec<u16>,
}

impl BoxTree {
    /// Replaces all boxes.
    pub fn fill(&mut self, boxes: impl Iterator<Item = Placed>) {
        self.boxes.clear();
        self.boxes.extend(boxes);
        self.flats.clear();
        let flats =
            |leaf: &[Placed]| (0..).zip(leaf).fold(0, |flats, (lane, it)| flats | u16::from(it.is_flat()) << lane);
        self.flats.extend(self.boxes.chunks(WIDE).map(flats));
        self.refit();
    }

    /// The boxes without thickness and their places.
    pub fn flats(&self) -> impl Iterator<Item = (usize, &Placed)> + '_ {
        let leaves = self.flats.iter().enumerate().filter(|(_, flats)| **flats != 0);
        leaves.flat_map(|(leaf, flats)| {
            let places = (0..WIDE).filter(move |lane| flats >> lane & 1 == 1).map(move |lane| WIDE * leaf + lane);
            places.map(|at| (at, &self.boxes[at]))
        })
    }

    fn note_flat(&mut self, at: usize) {
        let is_flat = self.boxes.get(at).is_some_and(Placed::is_flat);
        let flats = &mut self.flats[at / WIDE];
        *flats = *flats & !(1 << (at % WIDE)) | u16::from(is_flat) << (at % WIDE);
    }

    /// Sum of the half extents of all leaves in metres: a measure of how much their boxes overlap.
    pub fn spread(&self) -> f64 {
        self.levels[..self.height.min(1)].iter().flatten().map(|node| node.half.element_sum()).sum()
    }

    /// Gives back memory that is not used.
    pub fn shrink(&mut self) {
        self.boxes.shrink_to_fit();
        self.flats.shrink_to_fit();
        self.levels.truncate(self.height);
        self.levels.iter_mut().for_each(Vec::shrink_to_fit);
    }

    pub fn bytes(&self) -> usize {
        let nodes = self.levels.iter().map(Vec::capacity).sum::<usize>() + self.boxes.capacity();
        2 * self.flats.capacity() + nodes * size_of::<Placed>() + self.levels.capacity() * size_of::<Vec<Placed>>()
    }

    /// Makes the nodes fit their boxes.
    pub fn refit(&mut self) {
        self.height = 0;
        let mut len = self.boxes.len();
        while len > 0 && (self.height == 0 || len > WIDE) {
            if self.levels.len() == self.height {
                self.levels.push(Vec::new());
            }
            let (below, at) = self.levels.split_at_mut(self.height);
            let children = below.last().map_or(&self.boxes[..], |nodes| &nodes[..]);
            at[0].clear();
            at[0].extend(children.chunks(WIDE).map(around));
            len = at[0].len();
            self.height += 1;
        }
    }

    /// Appends a box.
    pub fn push(&mut self, placed: Placed) {
        self.boxes.push(placed);
        self.flats.resize(self.boxes.len().div_ceil(WIDE), 0);
        self.note_flat(self.boxes.len() - 1);
        if self.boxes.len() % WIDE == 1 {
            self.refit_tail();
        } else {
            self.widen(self.boxes.len() - 1);
        }
    }

    /// Changes a box; nodes grow around it and do not shrink.
    pub fn set(&mut self, at: usize, placed: Placed) {
        self.boxes[at] = placed;
        self.note_flat(at);
        self.widen(at);
    }

    /// Removes a box, in whose place the last one moves.
    pub fn swap_remove(&mut self, at: usize) {
        self.boxes.swap_remove(at);
        self.note_flat(at);
        self.note_flat(self.boxes.len());
        self.flats.truncate(self.boxes.len().div_ceil(WIDE));
        if at < self.boxes.len() {
            self.widen(at);
        }
        if self.boxes.len().is_multiple_of(WIDE) {
            self.refit_tail();
        }
    }

    /// Grows the nodes above a box.
    fn widen(&mut self, at: usize) {
        let mut bounds = self.boxes[at];
        let mut index = at;
        for level in &mut self.levels[..self.height] {
            index /= WIDE;
            let node = &mut level[index];
            *node = around(&[*node, bounds]);
            bounds = *node;
        }
    }

    /// Adjusts the number of nodes on every level to the number of boxes, after a leaf was added or
    /// removed.
    fn refit_tail(&mut self) {
        self.height = 0;
        let mut len = self.boxes.len();
        while len > 0 && (self.height == 0 || len > WIDE) {
            if self.levels.len() == self.height {
                self.levels.push(Vec::new());
            }
            let (below, at) = self.levels.split_at_mut(self.height);
            let children = below.last().map_or(&self.boxes[..], |nodes| &nodes[..]);
            let nodes = &mut at[0];
            len = children.len().div_ceil(WIDE);
            // The last of those that were there may have lost or won a child; so may its neighbour
            // have.
            nodes.truncate(len.saturating_sub(2));
            let begin = nodes.len();
            nodes.extend(children[begin * WIDE..].chunks(WIDE).map(around));
            self.height += 1;
        }
    }
}

/// A box around boxes, with room for its own rounding.
fn around(boxes: &[Placed]) -> Placed {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for placed in boxes {
        (min, max) = (min.min(placed.center - placed.half), max.max(placed.center + placed.half));
    }
    with_room(Placed { center: 0.5 * (min + max), half: 0.5 * (max - min) }, 0.0)
}

/// A [`BoxTree`] with a query that is made `farthest` metres from the origin.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a, F> {
    pub tree: &'a BoxTree,
    pub farthest: f64,
    /// Tells whether a box is queried.
    pub is_for: F,
}

impl<F: Fn(usize) -> bool> Tree for Asked<'_, F> {
    fn levels(&self) -> usize {
        self.tree.height
    }

    fn node(&self, level: usize, group: usize, lane: usize) -> Option<Placed> {
        self.tree.levels[level].get(WIDE * group + lane).map(|&node| with_room(node, self.farthest))
    }

    fn leaf(&self, leaf: usize, each: &mut impl FnMut(usize, &Placed)) {
        let begin = WIDE * leaf;
        for (place, placed) in self.tree.boxes.iter().enumerate().skip(begin).take(WIDE) {
            if (self.is_for)(place) {
                each(place, placed);
            }
        }
    }
}
