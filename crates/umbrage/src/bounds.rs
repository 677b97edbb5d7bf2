//! Axis-aligned boxes in world space.

use glam::DVec3;

use crate::Matrix;

/// The largest coordinate and distance that is accepted, metres: a thousand million kilometres.
pub(crate) const MOST_METRES: f64 = 1e12;

/// The least distance that is accepted, metres.
pub(crate) const LEAST_METRES: f64 = 1e-9;

/// Share of a scene's extent by which a caster may rise above the lowest receiver and still count
/// as lying below all of them: rounding in the bounds, not a length that could be seen (1.2 mm in
/// 1.2 km).
const BELOW_ALL: f64 = 1e-6;

/// Upper limit of [`BELOW_ALL`] in metres. A ground of a thousand kilometres does cast its shadow
/// on receivers a metre below.
const MOST_BELOW: f64 = 2e-3;

/// Metres by which rounding may move the bounds of an object in a box of this extent.
pub(crate) fn rounding(extent: DVec3) -> f64 {
    (BELOW_ALL * extent.max_element()).min(MOST_BELOW)
}

/// An axis-aligned box in world space, in metres.
///
/// The bounds of a caster or a receiver. A box may be flat (a plane) or a single point; it may not
/// be inverted, infinite or NaN when it is handed to the planner, which answers such a box with an
/// error that names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box that contains nothing: the identity of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// A box from its two extreme corners.
    #[must_use]
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The smallest box around `points`; [`Aabb::EMPTY`] if there are none.
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| bounds.including(point))
    }

    /// The smallest box around this one and `point`.
    #[must_use]
    pub fn including(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns whether the box contains no point.
    #[must_use]
    pub fn is_empty(self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns whether every coordinate is finite and the corners are in order.
    #[must_use]
    pub fn is_valid(self) -> bool {
        self.min.is_finite() && self.max.is_finite() && !self.is_empty()
    }

    /// Returns whether the planner accepts the box: [`Aabb::is_valid`], and no coordinate beyond
    /// ±10^12 m.
    #[must_use]
    pub fn is_accepted(self) -> bool {
        self.is_valid() && self.min.abs().max(self.max.abs()).max_element() <= MOST_METRES
    }

    /// The middle of the box.
    #[must_use]
    pub fn center(self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the extent along each axis.
    #[must_use]
    pub fn half_extent(self) -> DVec3 {
        0.5 * self.max - 0.5 * self.min
    }

    /// The eight corners; bit 0 of the index chooses x, bit 1 y, bit 2 z (set: the maximum).
    #[must_use]
    pub fn corners(self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }

    /// The smallest axis-aligned box around this one after a transform: the bounds of an instance
    /// from those of its mesh.
    ///
    /// The matrix is affine, either a `glam` matrix or an array of columns.
    ///
    /// ```
    /// # use umbrage::Aabb;
    /// let mesh = Aabb::from([[-0.5_f32; 3], [0.5; 3]]);
    /// let world_from_mesh = [[2.0_f32, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [7.0, 0.0, 0.0, 1.0]];
    /// assert_eq!(mesh.transformed(world_from_mesh), Aabb::from([[6.0_f32, -0.5, -0.5], [8.0, 0.5, 0.5]]));
    /// ```
    #[must_use]
    pub fn transformed(self, target_from_source: impl Into<Matrix>) -> Self {
        let matrix = target_from_source.into().0;
        Self::from_points(self.corners().map(|corner| matrix.transform_point3(corner)))
    }
}

impl From<[[f64; 3]; 2]> for Aabb {
    fn from([min, max]: [[f64; 3]; 2]) -> Self {
        Self::new(min.into(), max.into())
    }
}

impl From<[[f32; 3]; 2]> for Aabb {
    fn from(corners: [[f32; 3]; 2]) -> Self {
        corners.map(|corner| corner.map(f64::from)).into()
    }
}

/// A box as centre and half extent, the form that tests against planes need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    pub center: DVec3,
    pub half: DVec3,
}

impl Placed {
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.center - self.half, self.center + self.half)
    }

    /// Returns whether the box has no thickness along some axis, but for rounding.
    pub fn is_flat(&self) -> bool {
        2.0 * self.half.min_element() <= rounding(self.half)
    }

    /// Metres from a point to the nearest point of the box; 0 inside.
    pub fn distance_to(&self, point: DVec3) -> f64 {
        ((point - self.center).abs() - self.half).max(DVec3::ZERO).length()
    }
}

impl From<Aabb> for Placed {
    fn from(bounds: Aabb) -> Self {
        Self { center: bounds.center(), half: bounds.half_extent() }
    }
}
