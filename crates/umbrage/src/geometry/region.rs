//! The relevant part of a map's plane, as bounds along a fan of directions (a k-DOP).

use glam::{DVec2, DVec3};

use super::volume::Lies;
use crate::bounds::Placed;
use crate::maths;

/// Number of directions over half a turn. A map's rectangle may stand on any pair that is a quarter
/// turn apart, so the step between candidate rectangles is 180° / 32 = 5.6°, which costs at most 5
/// % of an edge against the smallest rectangle of all.
pub(crate) const DIRECTIONS: usize = 32;

/// Share of a coordinate by which rounding may move the bounds of a box, with room to spare.
const ROUNDING: f64 = 1e-13;

/// Number of directions in a quarter turn.
const QUARTER: usize = DIRECTIONS / 2;

/// World vectors in the light's plane, [`DIRECTIONS`] over half a turn, and the light's depth axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fan {
    pub directions: [DVec3; DIRECTIONS],
    pub depth: DVec3,
    /// The directions, axis by axis, for loops over all of them at once.
    axes: [[f64; DIRECTIONS]; 3],
}

/// Extent of a box along every direction of a fan: middles and half lengths.
type Spans = ([f64; DIRECTIONS], [f64; DIRECTIONS]);

impl Fan {
    /// A fan whose first direction is `first` (a unit vector of the light's plane). The others
    /// follow towards `first + 90°`.
    pub fn new(first: DVec3, depth: DVec3) -> Self {
        let second = depth.cross(first);
        let directions = std::array::from_fn(|i| {
            let (sin, cos) = maths::sin_cos(std::f64::consts::PI * i as f64 / DIRECTIONS as f64);
            cos * first + sin * second
        });
        let axes = [0, 1, 2].map(|axis| directions.map(|direction: DVec3| direction[axis]));
        Self { directions, depth, axes }
    }

    /// Position of a box's centre along every direction, and half the length of the box in that
    /// direction.
    fn spans(&self, center: DVec3, half: DVec3) -> Spans {
        let [x, y, z] = &self.axes;
        let (mut at, mut reach) = ([0.0; DIRECTIONS], [0.0; DIRECTIONS]);
        for k in 0..DIRECTIONS {
            at[k] = x[k] * center.x + y[k] * center.y + z[k] * center.z;
            reach[k] = x[k].abs() * half.x + y[k].abs() * half.y + z[k].abs() * half.z;
        }
        (at, reach)
    }

    /// Direction `u` (of the first half) and the one a quarter turn further: with depth a
    /// right-handed frame (u, v, depth).
    pub fn axes(&self, u: usize) -> (DVec3, DVec3) {
        (self.directions[u], self.directions[u + DIRECTIONS / 2])
    }
}

/// Bounds along every direction of a fan and along depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Region {
    pub lo: [f64; DIRECTIONS],
    pub hi: [f64; DIRECTIONS],
    pub depth: (f64, f64),
}

impl Region {
    pub const EMPTY: Self = Self {
        lo: [f64::INFINITY; DIRECTIONS],
        hi: [f64::NEG_INFINITY; DIRECTIONS],
        depth: (f64::INFINITY, f64::NEG_INFINITY),
    };

    pub fn is_empty(&self) -> bool {
        self.lo[0] > self.hi[0]
    }

    pub fn include_point(&mut self, fan: &Fan, point: DVec3) {
        for (k, direction) in fan.directions.iter().enumerate() {
            let at = direction.dot(point);
            self.lo[k] = self.lo[k].min(at);
            self.hi[k] = self.hi[k].max(at);
        }
        let depth = fan.depth.dot(point);
        self.depth = (self.depth.0.min(depth), self.depth.1.max(depth));
    }

    pub fn include_box(&mut self, fan: &Fan, center: DVec3, half: DVec3) {
        let (at, reach) = fan.spans(center, half);
        for k in 0..DIRECTIONS {
            self.lo[k] = self.lo[k].min(at[k] - reach[k]);
            self.hi[k] = self.hi[k].max(at[k] + reach[k]);
        }
        let (depth, reach) = (fan.depth.dot(center), fan.depth.abs().dot(half));
        self.depth = (self.depth.0.min(depth - reach), self.depth.1.max(depth + reach));
    }

    pub fn include_region(&mut self, other: &Self) {
        for k in 0..DIRECTIONS {
            self.lo[k] = self.lo[k].min(other.lo[k]);
            self.hi[k] = self.hi[k].max(other.hi[k]);
        }
        self.depth = (self.depth.0.min(other.depth.0), self.depth.1.max(other.depth.1));
    }

    /// This region with each bound clamped to `limits`; depth is unchanged.
    pub fn within(&self, limits: &Self) -> Self {
        let bound = |own: &[f64; DIRECTIONS]| std::array::from_fn(|k| own[k].clamp(limits.lo[k], limits.hi[k]));
        Self { lo: bound(&self.lo), hi: bound(&self.hi), depth: self.depth }
    }

    /// Returns whether the box lies inside in every direction and in depth, so that including any
    /// part of it changes nothing. A box that touches the bounds does not lie inside: rounding
    /// might carry a part of it over them.
    pub fn encloses_box(&self, fan: &Fan, center: DVec3, half: DVec3) -> bool {
        let room = ROUNDING * (center.abs() + half).element_sum();
        let (depth, reach) = (fan.depth.dot(center), fan.depth.abs().dot(half) + room);
        if !(depth - reach >= self.depth.0 && depth + reach <= self.depth.1) {
            return false;
        }
        let (at, reach) = fan.spans(center, half);
        let sticks_out = |k: usize| {
            let reach = reach[k] + room;
            (at[k] - reach < self.lo[k]) | (at[k] + reach > self.hi[k])
        };
        !(0..DIRECTIONS).fold(false, |any, k| any | sticks_out(k))
    }

    /// Returns whether a box comes within `margin` metres in the light's plane and does not lie
    /// behind all of the region.
    pub fn can_be_shadowed_by(&self, fan: &Fan, center: DVec3, half: DVec3, margin: f64) -> bool {
        if fan.depth.dot(center) - fan.depth.abs().dot(half) > self.depth.1 {
            return false;
        }
        let (at, reach) = fan.spans(center, half);
        let is_beside = |k: usize| {
            let reach = reach[k] + margin;
            (at[k] - reach > self.hi[k]) | (at[k] + reach < self.lo[k])
        };
        !(0..DIRECTIONS).fold(false, |any, k| any | is_beside(k))
    }

    /// Classifies all boxes inside a box by [`Region::can_be_shadowed_by`]: all pass, none passes,
    /// or it depends.
    pub fn shadowed_by_all(&self, fan: &Fan, Placed { center, half }: &Placed, margin: f64) -> Lies {
        let room = ROUNDING * (center.abs() + *half).element_sum();
        let (depth, reach) = (fan.depth.dot(*center), fan.depth.abs().dot(*half) + room);
        if depth - reach > self.depth.1 {
            return Lies::Outside;
        }
        let (at, reaches) = fan.spans(*center, *half);
        let (mut outside, mut across) = (false, depth + reach > self.depth.1);
        for k in 0..DIRECTIONS {
            let (reach, lo, hi) = (reaches[k] + room, self.lo[k] - margin, self.hi[k] + margin);
            outside |= (at[k] - reach > hi + room) | (at[k] + reach < lo - room);
            across |= (at[k] + reach > hi) | (at[k] - reach < lo);
        }
        match (outside, across) {
            (true, _) => Lies::Outside,
            (_, true) => Lies::Across,
            _ => Lies::Inside,
        }
    }

    /// Returns whether [`Region::include_box_within`] would leave the bounds across the light
    /// unchanged for this box and every box inside it.
    pub fn encloses_box_within(&self, fan: &Fan, Placed { center, half }: &Placed, within: &Self) -> bool {
        let room = ROUNDING * (center.abs() + *half).element_sum();
        let (at, reach) = fan.spans(*center, *half);
        let sticks_out = |k: usize| {
            let reach = reach[k] + room;
            (at[k] - reach < self.lo[k]) & (self.lo[k] > within.lo[k])
                | (at[k] + reach > self.hi[k]) & (self.hi[k] < within.hi[k])
        };
        !(0..DIRECTIONS).fold(false, |any, k| any | sticks_out(k))
    }

    /// Includes the part of a box that lies in `within`, direction by direction.
    pub fn include_box_within(&mut self, fan: &Fan, center: DVec3, half: DVec3, within: &Self) {
        let (at, reach) = fan.spans(center, half);
        for k in 0..DIRECTIONS {
            self.lo[k] = self.lo[k].min((at[k] - reach[k]).clamp(within.lo[k], within.hi[k]));
            self.hi[k] = self.hi[k].max((at[k] + reach[k]).clamp(within.lo[k], within.hi[k]));
        }
        let (depth, reach) = (fan.depth.dot(center), fan.depth.abs().dot(half));
        self.depth = (self.depth.0.min(depth - reach), self.depth.1.max(depth + reach));
    }

    pub fn contains(&self, fan: &Fan, point: DVec3) -> bool {
        fan.depth.dot(point) <= self.depth.1
            && fan.directions.iter().enumerate().all(|(k, direction)| {
                let at = direction.dot(point);
                self.lo[k] <= at && at <= self.hi[k]
            })
    }

    /// Bounds along direction `u` of the fan (in its first half) and along the direction a quarter
    /// turn further.
    pub fn bounds(&self, u: usize) -> (DVec2, DVec2) {
        let v = u + DIRECTIONS / 2;
        (DVec2::new(self.lo[u], self.lo[v]), DVec2::new(self.hi[u], self.hi[v]))
    }

    /// Largest extent in any direction, in metres.
    pub fn widest(&self) -> f64 {
        self.lo.iter().zip(&self.hi).map(|(lo, hi)| hi - lo).fold(0.0, f64::max)
    }

    /// Index of the first axis of the rectangle of least area among those along the fan's
    /// directions.
    pub fn least_direction(&self) -> usize {
        (1..QUARTER).fold(0, |best, k| if self.area(k) < self.area(best) { k } else { best })
    }

    /// Area in square metres of the rectangle along direction `u` of the fan (in its first half).
    pub fn area(&self, u: usize) -> f64 {
        (self.hi[u] - self.lo[u]) * (self.hi[u + QUARTER] - self.lo[u + QUARTER])
    }

    /// The rectangle of least area among those along the fan's directions, as (u axis, v axis, lo,
    /// hi) with u × v = depth.
    pub fn least_rectangle(&self, fan: &Fan) -> (DVec3, DVec3, DVec2, DVec2) {
        let best = self.least_direction();
        let (lo, hi) = self.bounds(best);
        let (u, v) = fan.axes(best);
        (u, v, lo, hi)
    }
}
