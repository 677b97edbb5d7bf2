//! Static casters in 18 bytes each, sixteen to a leaf, and trees over them.
//!
//! A box lies on a lattice of [`STEP`] that spans the whole world: it is rounded outwards once, and
//! its kept form depends on nothing else. Its six coordinates are 24-bit numbers of steps from its
//! leaf's origin, so that the lattice is as fine 100 km from the world's origin as there.

pub(super) mod asked;

use glam::DVec3;

use super::kind::{Kinds, Layers};
use super::slots::MOST_LANES;
use super::tree::WIDE;
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
    /// Box around all nodes of the top level, and the layers of any caster.
    whole: Aabb,
    layers: u32,
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
            whole: Aabb::EMPTY,
            layers: 0,
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
        (self.whole, self.layers) = (Aabb::EMPTY, 0);
        for top in self.levels.iter().rev().take(1).flatten() {
            for lane in (0..WIDE).filter(|&lane| top.layers[lane] != 0) {
                self.whole = self.whole.union(top.bounds(lane));
                self.layers |= top.layers[lane];
            }
        }
    }

    /// The key and kind of a caster.
    pub fn about(&self, place: u32) -> (u32, u16) {
        let (leaf, lane) = split(place);
        (self.keys[leaf][lane], self.kind(leaf, lane))
    }

    /// The key of a caster.
    pub fn key(&self, place: usize) -> u32 {
        self.keys[place / WIDE][place % WIDE]
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
            let nodes = &mut level[index / WIDE];
            nodes.include(index % WIDE, bounds, layers.bits());
            if nodes.layers[index % WIDE] != 0 {
                self.whole = self.whole.union(nodes.bounds(index % WIDE));
            }
            index /= WIDE;
        }
        self.layers |= layers.bits();
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

    /// All boxes of a leaf; those of lanes without a caster mean nothing.
    fn read_all(&self, leaf: usize) -> [Placed; WIDE] {
        let (Boxes { low, high }, origin) = (&self.boxes[leaf], self.origin(leaf));
        let (mut center, mut half) = ([[0.0f64; WIDE]; 3], [[0.0f64; WIDE]; 3]);
        for axis in 0..3 {
            // Axis by axis, which processors do for several boxes at a time; through an i32 for the
            // same reason.
            let ends = [axis, axis + 3].map(|k| {
                let (low, high, mut steps) = (&low[k], &high[k], [0i32; WIDE]);
                for lane in 0..WIDE {
                    steps[lane] = i32::from(low[lane]) | i32::from(high[lane]) << 16;
                }
                let mut ends = [0.0f64; WIDE];
                for lane in 0..WIDE {
                    ends[lane] = origin[axis] + f64::from(steps[lane]) * STEP;
                }
                ends
            });
            // [`Aabb::center`] and [`Aabb::half_extent`].
            for lane in 0..WIDE {
                let (min, max) = (0.5 * ends[0][lane], 0.5 * ends[1][lane]);
                center[axis][lane] = min + max;
                half[axis][lane] = max - min;
            }
        }
        let mut boxes = [Placed { center: DVec3::ZERO, half: DVec3::ZERO }; WIDE];
        for (lane, placed) in boxes.iter_mut().enumerate() {
            placed.center = DVec3::new(center[0][lane], center[1][lane], center[2][lane]);
            placed.half = DVec3::new(half[0][lane], half[1][lane], half[2][lane]);
        }
        boxes
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

fn lanes(mut live: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (live != 0).then(|| live.trailing_zeros() as usize);
        live &= live.wrapping_sub(1);
        lane
    })
}
