//! Static casters in 18 bytes each, sixteen to a leaf, and trees over them.
//!
//! A box lies on a lattice of [`STEP`] that spans the whole world: it is rounded outwards once, and
//! its kept form depends on nothing else. Its six coordinates are 24-bit numbers of steps from its
//! leaf's origin, so that the lattice is as fine 100 km from the world's origin as there.

use glam::DVec3;

use super::kind::{Ask, Kinds, Layers};
use super::slots::MOST_LANES;
use super::tree::{Near, Tree, WIDE, with_room};
use crate::Aabb;
use crate::bounds::Placed;

/// Step of the lattice in metres: 2^-14.
pub(super) const STEP: f64 = 1.0 / 16_384.0;

/// Extent of a leaf in metres: 2^24 steps.
const SPAN: f64 = STEP * 16_777_216.0;

/// Origins of leaves are whole multiples of so many metres.
const ORIGIN_STEP: f64 = 16.0;

/// The longest edge of a box that is packed, metres: a leaf has room for several.
const LONGEST: f64 = SPAN / 4.0;

/// The largest coordinate of a box that is packed, metres: origins are 32-bit numbers.
const FARTHEST: f64 = ORIGIN_STEP * (1u64 << 30) as f64;

/// Casters of a run, at most. A run is built as a whole: in some ten milliseconds.
pub(super) const RUN: usize = 16_384;

/// The box on the lattice around a box. `None` if the box is kept as it is: large, very far away,
/// or flat, as the position of a flat box along its axis decides whether it lies below another.
pub(super) fn on_lattice(bounds: Aabb) -> Option<Aabb> {
    let is_flat = |bounds: Aabb| Placed::from(bounds).is_flat();
    let kept = Aabb::new((bounds.min / STEP).floor() * STEP, (bounds.max / STEP).ceil() * STEP);
    let is_small =
        (kept.max - kept.min).max_element() <= LONGEST && kept.min.abs().max(kept.max.abs()).max_element() <= FARTHEST;
    (is_small && !is_flat(bounds) && !is_flat(kept)).then_some(kept)
}

/// A caster on its way into a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    pub code: u64,
    /// Bounds on the lattice.
    pub bounds: Aabb,
    pub key: u32,
    pub kind: u16,
    pub slot: u32,
}

/// Sixteen boxes, or fewer: for each of the six coordinates the lower two bytes of all, and the
/// upper one.
#[derive(Clone, Copy, Debug)]
struct Boxes {
    low: [[u16; WIDE]; 6],
    high: [[u8; WIDE]; 6],
}

/// Kinds of a run, at most: a byte names one.
const MOST_KINDS: usize = 256;

/// Sixteen nodes.
#[derive(Clone, Copy, Debug)]
struct Nodes {
    min: [[f32; WIDE]; 3],
    max: [[f32; WIDE]; 3],
    /// Layers of any caster below; 0 where there is none.
    layers: [u32; WIDE],
}

const NO_NODES: Nodes = Nodes { min: [[0.0; WIDE]; 3], max: [[0.0; WIDE]; 3], layers: [0; WIDE] };

impl Nodes {
    /// Includes a box. A box on no layer is never asked for.
    fn include(&mut self, lane: usize, bounds: Aabb, layers: u32) {
        if layers == 0 {
            return;
        }
        let is_new = self.layers[lane] == 0;
        for axis in 0..3 {
            let (lo, hi) = (rounded_down(bounds.min[axis]), -rounded_down(-bounds.max[axis]));
            let (min, max) = (&mut self.min[axis][lane], &mut self.max[axis][lane]);
            (*min, *max) = if is_new { (lo, hi) } else { (min.min(lo), max.max(hi)) };
        }
        self.layers[lane] |= layers;
    }

    fn bounds(&self, lane: usize) -> Aabb {
        let corner = |of: &[[f32; WIDE]; 3]| DVec3::from(std::array::from_fn::<f64, 3, _>(|k| f64::from(of[k][lane])));
        Aabb::new(corner(&self.min), corner(&self.max))
    }
}

/// The greatest `f32` that is not greater.
fn rounded_down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) > value { near.next_down() } else { near }
}

/// Up to [`RUN`] casters and the tree over them.
#[derive(Clone, Debug)]
pub(super) struct Run {
    boxes: Vec<Boxes>,
    /// Origins of leaves, in steps of [`ORIGIN_STEP`].
    origins: Vec<[i32; 3]>,
    /// For each leaf the lanes that hold a caster.
    live_lanes: Vec<u16>,
    keys: Vec<[u32; WIDE]>,
    kinds: Vec<[u8; WIDE]>,
    /// The numbers of the run's kinds.
    palette: Vec<u16>,
    levels: Vec<Vec<Nodes>>,
    /// Upper bound of the sum of the three coordinates' magnitudes, in metres.
    farthest: f64,
    /// Number of casters: those left, and those that the run was built with.
    pub live: usize,
    pub built: usize,
}

impl Run {
    /// A run of casters in the order of their codes, and the place of each. `None` if they lie so
    /// far apart, or are of so many kinds, that there is not room for all; half as many then fit.
    pub fn new(casters: &[Packing], kinds: &Kinds) -> Option<(Self, Vec<u32>)> {
        let leaves = casters.len().div_ceil(WIDE);
        let mut run = Self {
            boxes: Vec::with_capacity(leaves),
            origins: Vec::with_capacity(leaves),
            live_lanes: Vec::with_capacity(leaves),
            palette: Vec::new(),
            keys: Vec::with_capacity(leaves),
            kinds: Vec::with_capacity(leaves),
            levels: Vec::new(),
            farthest: 0.0,
            live: casters.len(),
            built: casters.len(),
        };
        let mut places = Vec::with_capacity(casters.len());
        let mut begin = 0;
        while begin < casters.len() {
            let mut bounds = casters[begin].bounds;
            let mut end = begin + 1;
            while end < casters.len() && end - begin < WIDE && spans(bounds.union(casters[end].bounds)) {
                bounds = bounds.union(casters[end].bounds);
                end += 1;
            }
            let leaf = run.boxes.len();
            if leaf * WIDE >= MOST_LANES || !run.add_leaf(bounds, &casters[begin..end]) {
                return None;
            }
            places.extend((0..end - begin).map(|lane| (leaf * WIDE + lane) as u32));
            begin = end;
        }
        run.shrink();
        run.refit(kinds);
        Some((run, places))
    }

    /// Appends a leaf, unless its casters are of too many kinds.
    fn add_leaf(&mut self, bounds: Aabb, casters: &[Packing]) -> bool {
        // Wherever a leaf's casters move, they stay within its span.
        self.farthest = self.farthest.max(bounds.min.abs().element_sum() + 4.0 * SPAN);
        let origin = (bounds.min / ORIGIN_STEP).floor().to_array().map(|at| at as i32);
        self.live_lanes.push(u16::MAX >> (WIDE - casters.len()));
        self.origins.push(origin);
        self.boxes.push(Boxes { low: [[0; WIDE]; 6], high: [[0; WIDE]; 6] });
        let (mut keys, mut kinds) = ([0; WIDE], [0; WIDE]);
        let leaf = self.boxes.len() - 1;
        for (lane, caster) in casters.iter().enumerate() {
            let number = self.palette.iter().position(|&kind| kind == caster.kind).unwrap_or(self.palette.len());
            if number == MOST_KINDS {
                return false;
            }
            if number == self.palette.len() {
                self.palette.push(caster.kind);
            }
            (keys[lane], kinds[lane]) = (caster.key, number as u8);
            self.write(leaf, lane, caster.bounds);
        }
        self.keys.push(keys);
        self.kinds.push(kinds);
        true
    }

    fn origin(&self, leaf: usize) -> DVec3 {
        DVec3::from(self.origins[leaf].map(f64::from)) * ORIGIN_STEP
    }

    /// The number of a caster's kind.
    fn kind(&self, leaf: usize, lane: usize) -> u16 {
        self.palette[usize::from(self.kinds[leaf][lane])]
    }

    fn shrink(&mut self) {
        self.boxes.shrink_to_fit();
        self.origins.shrink_to_fit();
        self.live_lanes.shrink_to_fit();
        self.keys.shrink_to_fit();
        self.kinds.shrink_to_fit();
    }

    /// Makes the nodes fit their boxes.
    fn refit(&mut self, kinds: &Kinds) {
        self.levels.clear();
        let mut nodes = vec![NO_NODES; self.boxes.len().div_ceil(WIDE)];
        for leaf in 0..self.boxes.len() {
            for lane in lanes(self.live_lanes[leaf]) {
                let layers = kinds.get(self.kind(leaf, lane)).layers.bits();
                nodes[leaf / WIDE].include(leaf % WIDE, self.read(leaf, lane), layers);
            }
        }
        loop {
            let is_top = nodes.len() <= 1;
            self.levels.push(nodes);
            if is_top {
                break;
            }
            let below = &self.levels[self.levels.len() - 1];
            nodes = vec![NO_NODES; below.len().div_ceil(WIDE)];
            for (group, of) in below.iter().enumerate() {
                for lane in (0..WIDE).filter(|&lane| of.layers[lane] != 0) {
                    nodes[group / WIDE].include(group % WIDE, of.bounds(lane), of.layers[lane]);
                }
            }
        }
    }

    /// The key and kind of a caster.
    pub fn about(&self, place: u32) -> (u32, u16) {
        let (leaf, lane) = split(place);
        (self.keys[leaf][lane], self.kind(leaf, lane))
    }

    /// The box of a caster.
    pub fn bounds(&self, place: u32) -> Aabb {
        let (leaf, lane) = split(place);
        self.read(leaf, lane)
    }

    /// Removes a caster.
    pub fn remove(&mut self, place: u32) {
        let (leaf, lane) = split(place);
        self.live_lanes[leaf] &= !(1 << lane);
        self.live -= 1;
    }

    /// Changes the box of a caster, if its leaf reaches there: nodes grow around it. Returns
    /// whether it did.
    pub fn set(&mut self, place: u32, bounds: Aabb, layers: Layers) -> bool {
        let (leaf, lane) = split(place);
        let origin = self.origin(leaf);
        if !(bounds.min.cmpge(origin).all() && (bounds.max - origin).max_element() < SPAN) {
            return false;
        }
        self.write(leaf, lane, bounds);
        let mut index = leaf;
        for level in &mut self.levels {
            level[index / WIDE].include(index % WIDE, bounds, layers.bits());
            index /= WIDE;
        }
        true
    }

    /// Places of all casters.
    pub fn places(&self) -> impl Iterator<Item = u32> + '_ {
        let of = |(leaf, live): (usize, &u16)| lanes(*live).map(move |lane| (WIDE * leaf + lane) as u32);
        self.live_lanes.iter().enumerate().flat_map(of)
    }

    fn write(&mut self, leaf: usize, lane: usize, bounds: Aabb) {
        let origin = self.origin(leaf);
        let corners = [(bounds.min - origin) / STEP, (bounds.max - origin) / STEP];
        for (k, corner) in corners.into_iter().enumerate() {
            for axis in 0..3 {
                let steps = corner[axis] as u32;
                self.boxes[leaf].low[3 * k + axis][lane] = steps as u16;
                self.boxes[leaf].high[3 * k + axis][lane] = (steps >> 16) as u8;
            }
        }
    }

    fn read(&self, leaf: usize, lane: usize) -> Aabb {
        let boxes = &self.boxes[leaf];
        let steps = |k: usize| f64::from(u32::from(boxes.low[k][lane]) | u32::from(boxes.high[k][lane]) << 16);
        let origin = self.origin(leaf);
        let corner = |k: usize| origin + DVec3::new(steps(k), steps(k + 1), steps(k + 2)) * STEP;
        Aabb::new(corner(0), corner(3))
    }

    pub fn bytes(&self) -> usize {
        self.boxes.capacity() * size_of::<Boxes>()
            + self.origins.capacity() * size_of::<[i32; 3]>()
            + self.live_lanes.capacity() * size_of::<u16>()
            + self.keys.capacity() * size_of::<[u32; WIDE]>()
            + self.kinds.capacity() * size_of::<[u8; WIDE]>()
            + self.palette.capacity() * size_of::<u16>()
            + self.levels.iter().map(|level| level.capacity() * size_of::<Nodes>()).sum::<usize>()
            + self.levels.capacity() * size_of::<Vec<Nodes>>()
    }
}

fn split(place: u32) -> (usize, usize) {
    (place as usize / WIDE, place as usize % WIDE)
}

/// Returns whether one leaf can hold boxes with these bounds.
fn spans(bounds: Aabb) -> bool {
    let origin = (bounds.min / ORIGIN_STEP).floor() * ORIGIN_STEP;
    (bounds.max - origin).max_element() < SPAN
}

fn lanes(live: u16) -> impl Iterator<Item = usize> {
    (0..WIDE).filter(move |lane| live >> lane & 1 == 1)
}

/// A run with a query.
#[derive(Clone, Copy)]
pub(super) struct AskedRun<'a> {
    pub run: &'a Run,
    /// Metres from the world's origin at which tests are taken.
    pub farthest: f64,
    pub ask: Ask,
    /// The kinds to look up, unless all are queried.
    pub kinds: Option<&'a Kinds>,
}

impl AskedRun<'_> {
    /// The lanes of a leaf that are queried.
    fn asked_lanes(&self, leaf: usize) -> u16 {
        let live = self.run.live_lanes[leaf];
        let Some(kinds) = self.kinds else { return live };
        lanes(live)
            .filter(|&lane| self.ask.is_for(kinds.get(self.run.kind(leaf, lane))))
            .fold(0, |mask, lane| mask | 1 << lane)
    }
}

impl Tree for AskedRun<'_> {
    fn levels(&self) -> usize {
        self.run.levels.len()
    }

    fn node(&self, level: usize, group: usize, lane: usize) -> Option<Placed> {
        let nodes = &self.run.levels[level][group];
        let is_asked = nodes.layers[lane] & self.ask.layers.bits() != 0;
        is_asked.then(|| with_room(nodes.bounds(lane).into(), self.farthest))
    }

    fn leaf(&self, leaf: usize, each: &mut dyn FnMut(usize, &Placed)) {
        for lane in lanes(self.asked_lanes(leaf)) {
            each(WIDE * leaf + lane, &self.run.read(leaf, lane).into());
        }
    }

    fn near_lanes(&self, level: usize, group: usize, ask: &Near<'_>, asked: u32, each: &mut dyn FnMut(usize, u32)) {
        let nodes = &self.run.levels[level][group];
        let (mut is_in, mut left) = ([true; WIDE], [0u32; WIDE]);
        for (bit, plane) in ask.planes.iter().enumerate().filter(|(bit, _)| asked >> bit & 1 == 1) {
            // Each axis is nearest at one end of the box and farthest at the other.
            let ends = |axis: usize| match plane.normal[axis] >= 0.0 {
                true => (&nodes.min[axis], &nodes.max[axis]),
                false => (&nodes.max[axis], &nodes.min[axis]),
            };
            let ([(x0, x1), (y0, y1), (z0, z1)], [nx, ny, nz]) = ([ends(0), ends(1), ends(2)], plane.normal.to_array());
            let bound = plane.offset + ask.margin;
            // A run lies within a few times this of the origin.
            let room = 1e-12 * (bound.abs() + self.run.farthest);
            for lane in 0..WIDE {
                let at = |x: &[f32; WIDE], y: &[f32; WIDE], z: &[f32; WIDE]| {
                    nx * f64::from(x[lane]) + ny * f64::from(y[lane]) + nz * f64::from(z[lane]) - bound
                };
                is_in[lane] &= at(x0, y0, z0) <= room;
                left[lane] |= u32::from(at(x1, y1, z1) > -room) << bit;
            }
        }
        for lane in 0..WIDE {
            if is_in[lane] && nodes.layers[lane] & self.ask.layers.bits() != 0 {
                each(lane, left[lane]);
            }
        }
    }

    fn near_boxes(&self, leaf: usize, ask: &Near<'_>, asked: u32, each: &mut dyn FnMut(usize, &Placed)) -> usize {
        let mut lanes_in = self.asked_lanes(leaf);
        let tested = if asked == 0 { 0 } else { lanes_in.count_ones() as usize };
        let mut unsure = 0;
        if asked != 0 {
            (lanes_in, unsure) = self.run.sieve(leaf, ask, asked, lanes_in);
        }
        for lane in lanes(lanes_in) {
            let placed = self.run.read(leaf, lane).into();
            if unsure >> lane & 1 == 0 || ask.meets(&placed) {
                each(WIDE * leaf + lane, &placed);
            }
        }
        tested
    }
}

impl Run {
    /// The boxes of a leaf, among `asked`, that may come near the planes, and those of them for
    /// which `f32` leaves this undecided.
    fn sieve(&self, leaf: usize, ask: &Near<'_>, planes: u32, asked: u16) -> (u16, u16) {
        let boxes = &self.boxes[leaf];
        let mut ends = [[0.0f32; WIDE]; 6];
        for (k, ends) in ends.iter_mut().enumerate() {
            for (end, (&low, &high)) in ends.iter_mut().zip(boxes.low[k].iter().zip(&boxes.high[k])) {
                *end = (u32::from(low) | u32::from(high) << 16) as i32 as f32 * STEP as f32;
            }
        }
        let origin = self.origin(leaf);
        let (mut out, mut unsure) = ([false; WIDE], [false; WIDE]);
        for plane in ask.planes.iter().enumerate().filter(|(bit, _)| planes >> bit & 1 == 1).map(|(_, plane)| plane) {
            let bound = plane.offset + ask.margin - plane.normal.dot(origin);
            let nearest = |axis: usize| &ends[if plane.normal[axis] >= 0.0 { axis } else { axis + 3 }];
            let ([x, y, z], [nx, ny, nz]) = ([nearest(0), nearest(1), nearest(2)], plane.normal.as_vec3().to_array());
            // What f32 can be off by, and f64 for the origin.
            let room =
                (1e-6 * (3.0 * SPAN + bound.abs()) + 1e-12 * (plane.offset.abs() + origin.abs().element_sum())) as f32;
            let bound = bound as f32;
            for lane in 0..WIDE {
                let at = nx * x[lane] + ny * y[lane] + nz * z[lane] - bound;
                out[lane] |= at > room;
                unsure[lane] |= at > -room;
            }
        }
        let mask = |of: [bool; WIDE]| (0..WIDE).fold(0u16, |mask, lane| mask | u16::from(of[lane]) << lane);
        let lanes_in = asked & !mask(out);
        (lanes_in, lanes_in & mask(unsure))
    }
}
