//! The relevant part of a map's plane, as bounds along a fan of directions (a k-DOP).

use glam::{DVec2, DVec3};

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

/// Bounds of a region, such as those on which it depends whether a box lies inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Undecided {
    /// Directions of the fan, a bit each.
    pub directions: u32,
    pub depth: bool,
}

impl Undecided {
    pub const ALL: Self = Self { directions: u32::MAX, depth: true };

    pub fn is_nothing(self) -> bool {
        self == Self::default()
    }
}

/// A bit for each direction.
const BITS: [u32; DIRECTIONS] = {
    let (mut bits, mut k) = ([0; DIRECTIONS], 0);
    while k < DIRECTIONS {
        (bits[k], k) = (1 << k, k + 1);
    }
    bits
};

/// The lesser of two numbers; neither is NaN, so that it is one instruction.
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater of two numbers.
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The bit of a direction if a condition holds. From a table, because loops of shifts by different
/// numbers are not made into loops over several at once.
fn bit_if(holds: bool, k: usize) -> u32 {
    BITS[k] & 0u32.wrapping_sub(u32::from(holds))
}

/// The numbers of the bits that are set.
pub(crate) fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        bit
    })
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

    /// [`Fan::spans`] along one direction.
    fn span(&self, k: usize, center: DVec3, half: DVec3) -> (f64, f64) {
        let [x, y, z] = self.axes.each_ref().map(|axis| axis[k]);
        (x * center.x + y * center.y + z * center.z, x.abs() * half.x + y.abs() * half.y + z.abs() * half.z)
    }

    /// Bounds of a box along one direction: those of [`Region::include_box`].
    pub fn ends(&self, k: usize, Placed { center, half }: &Placed) -> (f64, f64) {
        let (at, reach) = self.span(k, *center, *half);
        (at - reach, at + reach)
    }

    /// [`Fan::ends`] of several boxes, given axis by axis.
    pub fn ends_of_all<const N: usize>(
        &self,
        k: usize,
        center: &[[f64; N]; 3],
        half: &[[f64; N]; 3],
        (lo, hi): &mut ([f64; N], [f64; N]),
    ) {
        let [x, y, z] = self.axes.each_ref().map(|axis| axis[k]);
        for i in 0..N {
            let at = x * center[0][i] + y * center[1][i] + z * center[2][i];
            let reach = x.abs() * half[0][i] + y.abs() * half[1][i] + z.abs() * half[2][i];
            (lo[i], hi[i]) = (at - reach, at + reach);
        }
    }

    /// Depths along the light between which a box lies.
    pub fn depths(&self, Placed { center, half }: &Placed) -> (f64, f64) {
        let (at, reach) = (self.depth.dot(*center), self.depth.abs().dot(*half));
        (at - reach, at + reach)
    }

    /// Direction `u` (of the first half) and the one a quarter turn further: with depth a
    /// right-handed frame (u, v, depth).
    pub fn axes(&self, u: usize) -> (DVec3, DVec3) {
        (self.directions[u], self.directions[u + DIRECTIONS / 2])
    }
}

/// Bounds of a box with room for rounding: every box inside it has its own within them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull {
    pub region: Region,
    room: f64,
}

impl Hull {
    pub fn new(fan: &Fan, Placed { center, half }: &Placed) -> Self {
        let room = ROUNDING * (center.abs() + *half).element_sum();
        let (depth, reach) = (fan.depth.dot(*center), fan.depth.abs().dot(*half) + room);
        let (at, reaches) = fan.spans(*center, *half);
        let (mut lo, mut hi) = ([0.0; DIRECTIONS], [0.0; DIRECTIONS]);
        for k in 0..DIRECTIONS {
            let reach = reaches[k] + room;
            (lo[k], hi[k]) = (at[k] - reach, at[k] + reach);
        }
        Self { region: Region { lo, hi, depth: (depth - reach, depth + reach) }, room }
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
        let [x, y, z] = &fan.axes;
        for k in 0..DIRECTIONS {
            let at = x[k] * point.x + y[k] * point.y + z[k] * point.z;
            self.lo[k] = lesser(self.lo[k], at);
            self.hi[k] = greater(self.hi[k], at);
        }
        let depth = fan.depth.dot(point);
        self.depth = (self.depth.0.min(depth), self.depth.1.max(depth));
    }

    pub fn include_region(&mut self, other: &Self) {
        for k in 0..DIRECTIONS {
            self.lo[k] = lesser(self.lo[k], other.lo[k]);
            self.hi[k] = greater(self.hi[k], other.hi[k]);
        }
        self.depth = (self.depth.0.min(other.depth.0), self.depth.1.max(other.depth.1));
    }

    /// Extents along all directions.
    pub fn widths(&self) -> Widths {
        Widths(std::array::from_fn(|k| self.hi[k] - self.lo[k]))
    }

    /// Extents of [`Region::within`].
    pub fn widths_within(&self, limits: &Self) -> Widths {
        let within = |at: f64, k: usize| lesser(greater(at, limits.lo[k]), limits.hi[k]);
        Widths(std::array::from_fn(|k| within(self.hi[k], k) - within(self.lo[k], k)))
    }

    /// This region with each bound clamped to `limits`; depth is unchanged.
    pub fn within(&self, limits: &Self) -> Self {
        let bound = |own: &[f64; DIRECTIONS]| std::array::from_fn(|k| own[k].clamp(limits.lo[k], limits.hi[k]));
        Self { lo: bound(&self.lo), hi: bound(&self.hi), depth: self.depth }
    }

    /// The bounds that including any part of a box, or of boxes inside it, may change. A box that
    /// touches a bound may change it: rounding might carry a part of it over.
    pub fn widened_by(&self, Hull { region: hull, .. }: &Hull) -> Undecided {
        let sticks_out = |k: usize| (hull.lo[k] < self.lo[k]) | (hull.hi[k] > self.hi[k]);
        let directions = (0..DIRECTIONS).fold(0, |directions, k| directions | bit_if(sticks_out(k), k));
        Undecided { directions, depth: !(hull.depth.0 >= self.depth.0 && hull.depth.1 <= self.depth.1) }
    }

    /// Includes boxes in those bounds that they may change.
    pub fn include_boxes<'a>(
        &mut self,
        fan: &Fan,
        boxes: impl Iterator<Item = &'a Placed> + Clone,
        Undecided { directions, depth }: Undecided,
    ) {
        for k in bits(directions) {
            for placed in boxes.clone() {
                let (lo, hi) = fan.ends(k, placed);
                self.lo[k] = lesser(self.lo[k], lo);
                self.hi[k] = greater(self.hi[k], hi);
            }
        }
        for (lo, hi) in boxes.filter(|_| depth).map(|placed| fan.depths(placed)) {
            self.depth = (self.depth.0.min(lo), self.depth.1.max(hi));
        }
    }

    /// Includes a point in those bounds that it may change.
    pub fn include_point_in(&mut self, fan: &Fan, point: DVec3, Undecided { directions, depth }: Undecided) {
        if directions.count_ones() as usize > DIRECTIONS / 4 {
            // All at once is quicker than some.
            return self.include_point(fan, point);
        }
        for k in bits(directions) {
            let at = fan.directions[k].dot(point);
            self.lo[k] = self.lo[k].min(at);
            self.hi[k] = self.hi[k].max(at);
        }
        if depth {
            let at = fan.depth.dot(point);
            self.depth = (self.depth.0.min(at), self.depth.1.max(at));
        }
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

    /// Bounds to ask about for boxes inside a hull to answer [`Region::can_be_shadowed_by`]; `None`
    /// if no such box can be shadowed.
    pub fn undecided_in(&self, &Hull { region: ref hull, room }: &Hull, margin: f64) -> Option<Undecided> {
        if hull.depth.0 > self.depth.1 {
            return None;
        }
        let (mut outside, mut directions) = (false, 0);
        for k in 0..DIRECTIONS {
            let (lo, hi) = (self.lo[k] - margin, self.hi[k] + margin);
            outside |= (hull.lo[k] > hi + room) | (hull.hi[k] < lo - room);
            directions |= bit_if((hull.hi[k] > hi) | (hull.lo[k] < lo), k);
        }
        (!outside).then_some(Undecided { directions, depth: hull.depth.1 > self.depth.1 })
    }

    /// [`Region::can_be_shadowed_by`] for a box inside one for which only this is undecided.
    pub fn can_be_shadowed_along(
        &self,
        fan: &Fan,
        Placed { center, half }: &Placed,
        margin: f64,
        left: Undecided,
    ) -> bool {
        if left.depth && fan.depth.dot(*center) - fan.depth.abs().dot(*half) > self.depth.1 {
            return false;
        }
        bits(left.directions).all(|k| {
            let (at, reach) = fan.span(k, *center, *half);
            let reach = reach + margin;
            !((at - reach > self.hi[k]) | (at + reach < self.lo[k]))
        })
    }

    /// The directions along which [`Region::include_boxes_within`] may change the bounds for boxes
    /// inside a hull: a bit each.
    pub fn widened_within(&self, Hull { region: hull, .. }: &Hull, within: &Self) -> u32 {
        let sticks_out = |k: usize| {
            (hull.lo[k] < self.lo[k]) & (self.lo[k] > within.lo[k])
                | (hull.hi[k] > self.hi[k]) & (self.hi[k] < within.hi[k])
        };
        (0..DIRECTIONS).fold(0, |directions, k| directions | bit_if(sticks_out(k), k))
    }

    /// Includes the parts of boxes that lie in `within`, along some directions across the light.
    pub fn include_boxes_within<'a>(
        &mut self,
        fan: &Fan,
        boxes: impl Iterator<Item = &'a Placed> + Clone,
        directions: u32,
        within: &Self,
    ) {
        for k in bits(directions) {
            let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
            for placed in boxes.clone() {
                let ends = fan.ends(k, placed);
                (lo, hi) = (lesser(lo, ends.0), greater(hi, ends.1));
            }
            self.lo[k] = self.lo[k].min(lo.clamp(within.lo[k], within.hi[k]));
            self.hi[k] = self.hi[k].max(hi.clamp(within.lo[k], within.hi[k]));
        }
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
        self.widths().least_direction()
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

/// Extents along the directions of a fan, in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Widths([f64; DIRECTIONS]);

impl Widths {
    /// Index of the first axis of the rectangle of least area.
    fn least_direction(&self) -> usize {
        let areas: [f64; QUARTER] = std::array::from_fn(|k| self.0[k] * self.0[k + QUARTER]);
        (1..QUARTER).fold(0, |best, k| if areas[k] < areas[best] { k } else { best })
    }

    /// Extents of the rectangle of least area.
    pub fn least_rectangle(&self) -> DVec2 {
        let best = self.least_direction();
        DVec2::new(self.0[best], self.0[best + QUARTER])
    }
}
