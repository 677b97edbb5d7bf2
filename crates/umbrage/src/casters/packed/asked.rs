//! Queries of a run.

use super::{Placed, Run, SPAN, STEP, lanes};
use crate::casters::kind::{Ask, Kinds};
use crate::casters::tree::{Collect, Near, Tree, WIDE, with_room};

/// A run with a query.
#[derive(Clone, Copy)]
pub(in crate::casters) struct AskedRun<'a> {
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

    fn whole(&self) -> Option<Placed> {
        let is_asked = self.run.layers & self.ask.layers.bits() != 0;
        is_asked.then(|| with_room(self.run.whole.into(), self.farthest))
    }

    fn leaf(&self, leaf: usize, each: &mut impl FnMut(usize, &Placed)) {
        for lane in lanes(self.asked_lanes(leaf)) {
            each(WIDE * leaf + lane, &self.run.read(leaf, lane).into());
        }
    }

    fn near_lanes(&self, level: usize, group: usize, ask: &Near<'_>, asked: u32, each: &mut impl FnMut(usize, u32)) {
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

    fn near_boxes(&self, leaf: usize, ask: &Near<'_>, asked: u32, collector: &mut impl Collect) -> usize {
        let mut lanes_in = self.asked_lanes(leaf);
        let tested = if asked == 0 { 0 } else { lanes_in.count_ones() as usize };
        let mut unsure = 0;
        if asked != 0 {
            (lanes_in, unsure) = self.run.sieve(leaf, ask, asked, lanes_in);
        }
        if lanes_in == 0 {
            return tested;
        }
        let boxes = self.run.read_all(leaf);
        if lanes_in == u16::MAX && unsure == 0 {
            collector.take_all(WIDE * leaf, &boxes);
            return tested;
        }
        for lane in lanes(lanes_in) {
            let placed = &boxes[lane];
            if unsure >> lane & 1 == 0 || ask.meets(placed) {
                collector.take(WIDE * leaf + lane, placed);
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
