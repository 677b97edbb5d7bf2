//! The part of a map's plane that matters, as bounds along a fan of directions (a k-DOP).

use glam::{DVec2, DVec3};

/// Directions over half a turn. A map's rectangle may stand on any pair that is a quarter turn apart, so the step between
/// candidate rectangles is 180° / 32 = 5.6°, which costs at most 5 % of an edge against the smallest rectangle of all.
pub(crate) const DIRECTIONS: usize = 32;

/// Directions to a quarter turn.
const QUARTER: usize = DIRECTIONS / 2;

/// World vectors in the light's plane, [`DIRECTIONS`] over half a turn, and the light's depth axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fan {
    pub directions: [DVec3; DIRECTIONS],
    pub depth: DVec3,
}

impl Fan {
    /// The first direction is `first` (a unit vector of the light's plane), the others follow towards `first + 90°`.
    pub fn new(first: DVec3, depth: DVec3) -> Self {
        let second = depth.cross(first);
        let directions = std::array::from_fn(|i| {
            let (sin, cos) = (std::f64::consts::PI * i as f64 / DIRECTIONS as f64).sin_cos();
            cos * first + sin * second
        });
        Self { directions, depth }
    }

    /// Direction `u` (of the first half) and the one a quarter turn further: with depth a right-handed frame (u, v, depth).
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
        for (k, direction) in fan.directions.iter().enumerate() {
            let (at, reach) = (direction.dot(center), direction.abs().dot(half));
            self.lo[k] = self.lo[k].min(at - reach);
            self.hi[k] = self.hi[k].max(at + reach);
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

    /// The same with each bound moved into `limits`, depth left as it is.
    pub fn within(&self, limits: &Self) -> Self {
        let bound = |own: &[f64; DIRECTIONS]| std::array::from_fn(|k| own[k].clamp(limits.lo[k], limits.hi[k]));
        Self { lo: bound(&self.lo), hi: bound(&self.hi), depth: self.depth }
    }

    /// Whether the box lies inside in every direction and in depth, so that including any part of it changes nothing.
    pub fn encloses_box(&self, fan: &Fan, center: DVec3, half: DVec3) -> bool {
        let (depth, reach) = (fan.depth.dot(center), fan.depth.abs().dot(half));
        depth - reach >= self.depth.0
            && depth + reach <= self.depth.1
            && fan.directions.iter().enumerate().all(|(k, direction)| {
                let (at, reach) = (direction.dot(center), direction.abs().dot(half));
                at - reach >= self.lo[k] && at + reach <= self.hi[k]
            })
    }

    /// Whether a box comes within `margin` metres in the light's plane and does not lie behind everything.
    pub fn can_be_shadowed_by(&self, fan: &Fan, center: DVec3, half: DVec3, margin: f64) -> bool {
        fan.depth.dot(center) - fan.depth.abs().dot(half) <= self.depth.1
            && fan.directions.iter().enumerate().all(|(k, direction)| {
                let (at, reach) = (direction.dot(center), direction.abs().dot(half) + margin);
                at - reach <= self.hi[k] && at + reach >= self.lo[k]
            })
    }

    /// Includes the part of a box that lies in `within`, direction by direction.
    pub fn include_box_within(&mut self, fan: &Fan, center: DVec3, half: DVec3, within: &Self) {
        for (k, direction) in fan.directions.iter().enumerate() {
            let (at, reach) = (direction.dot(center), direction.abs().dot(half));
            self.lo[k] = self.lo[k].min((at - reach).clamp(within.lo[k], within.hi[k]));
            self.hi[k] = self.hi[k].max((at + reach).clamp(within.lo[k], within.hi[k]));
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

    /// Bounds along direction `u` of the fan (of its first half) and along the one a quarter turn further.
    pub fn bounds(&self, u: usize) -> (DVec2, DVec2) {
        let v = u + DIRECTIONS / 2;
        (DVec2::new(self.lo[u], self.lo[v]), DVec2::new(self.hi[u], self.hi[v]))
    }

    /// Largest extent in any direction, in metres.
    pub fn widest(&self) -> f64 {
        self.lo.iter().zip(&self.hi).map(|(lo, hi)| hi - lo).fold(0.0, f64::max)
    }

    /// The first axis of the rectangle of least area among those that stand on the fan's directions.
    pub fn least_direction(&self) -> usize {
        (1..QUARTER).fold(0, |best, k| if self.area(k) < self.area(best) { k } else { best })
    }

    /// Area of the rectangle that stands on direction `u` of the fan (of its first half), square metres.
    pub fn area(&self, u: usize) -> f64 {
        (self.hi[u] - self.lo[u]) * (self.hi[u + QUARTER] - self.lo[u + QUARTER])
    }

    /// The rectangle of least area among those that stand on the fan's directions, as (u axis, v axis, lo, hi) with
    /// u × v = depth.
    pub fn least_rectangle(&self, fan: &Fan) -> (DVec3, DVec3, DVec2, DVec2) {
        let best = self.least_direction();
        let (lo, hi) = self.bounds(best);
        let (u, v) = fan.axes(best);
        (u, v, lo, hi)
    }
}
