//! The frustum of a local light, and the part of it that a map has to show.

use glam::{DMat4, DVec2, DVec3};

use super::volume::{Plane, Slice};
use crate::bounds::Placed;
use crate::light::map_axes;
use crate::{Aabb, PointLight, SpotLight, maths};

/// Least ratio of a map's shorter edge to its longer one, for receivers that the light sees
/// edge-on.
const LEAST_EDGE: f64 = 1e-3;

/// Frustum of a spot light, or of one face of a point light: a square pyramid, from `near` to
/// `range` along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightFrustum {
    pub position: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub axis: DVec3,
    pub near: f64,
    pub range: f64,
    /// Tangent between the axis and the middle of a side.
    pub slope: f64,
    pub volume: Slice,
}

/// The part of a light's frustum that a map has to show: bounds in its post-perspective space, and
/// in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    pub lo: DVec2,
    pub hi: DVec2,
    pub near: f64,
    pub far: f64,
    pub bounds: Aabb,
}

impl LightFrustum {
    /// The frustum of a spot light.
    pub fn of_spot(light: &SpotLight) -> Self {
        let slope = maths::tan(light.outer_angle());
        Self::new(light.position(), light.direction(), slope, (light.near(), light.range()))
    }

    /// The frustum of a point light around one of [`Light::FACE_AXES`].
    pub fn of_face(light: &PointLight, axis: DVec3) -> Self {
        Self::new(light.position(), axis, 1.0, (light.near(), light.range()))
    }

    fn new(position: DVec3, axis: DVec3, slope: f64, (near, range): (f64, f64)) -> Self {
        let (u, v) = map_axes(axis);
        let corner = |i: usize| {
            let depth = if i < 4 { near } else { range };
            let (x, y) = (if i & 1 == 0 { -slope } else { slope }, if i & 2 == 0 { slope } else { -slope });
            position + depth * (axis + x * u + y * v)
        };
        let volume = Slice::from_corners(std::array::from_fn(corner), axis);
        Self { position, u, v, axis, near, range, slope, volume }
    }

    pub fn depth(&self, point: DVec3) -> f64 {
        self.axis.dot(point - self.position)
    }

    pub fn nearest_depth(&self, placed: &Placed) -> f64 {
        self.depth(placed.center) - self.axis.abs().dot(placed.half)
    }

    /// Returns whether any part of a box may lie in the frustum, widened by `margin` metres and
    /// extended to the light's position.
    pub fn may_meet(&self, placed: &Placed, margin: f64) -> bool {
        let nearest = self.position.clamp(placed.center - placed.half, placed.center + placed.half);
        nearest.distance(self.position) <= self.range + margin
            && self.volume.planes[1..].iter().all(|side| side.nearest(placed.center, placed.half) <= margin)
            && self.depth(placed.center) + self.axis.abs().dot(placed.half) >= 0.0
    }

    /// Projects a point in front of the light to tangents along u and v.
    fn project(&self, point: DVec3) -> DVec2 {
        let from_light = point - self.position;
        DVec2::new(self.u.dot(from_light), self.v.dot(from_light)) / self.axis.dot(from_light)
    }

    /// Extent of a caster in a map: its bounds within those of `part`, and the depth of its nearest
    /// point. A caster that comes nearer than `near` gets all of `part`.
    pub fn seen(&self, caster: &Placed, part: &Part) -> (DVec2, DVec2, f64) {
        let first = self.nearest_depth(caster);
        if first < self.near {
            return (part.lo, part.hi, self.near);
        }
        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in caster.bounds().corners() {
            let at = self.project(corner);
            (lo, hi) = (lo.min(at), hi.max(at));
        }
        (lo.clamp(part.lo, part.hi), hi.clamp(part.lo, part.hi), first)
    }

    /// The whole frustum, for splits in which nothing is seen.
    pub fn whole(&self) -> Part {
        Part {
            lo: DVec2::splat(-self.slope),
            hi: DVec2::splat(self.slope),
            near: self.near,
            far: self.range,
            bounds: Aabb::EMPTY,
        }
    }

    /// Matrix to shadow NDC, with w the depth along the axis in metres and `z/w = far/(far − near)
    /// − near far/((far − near) w)`.
    pub fn shadow_from_world(&self, texel: DVec2, min_texel: DVec2, size: u32, (near, far): (f64, f64)) -> DMat4 {
        let half = 0.5 * f64::from(size);
        let row = |axis: DVec3, constant: f64| axis.extend(constant - axis.dot(self.position));
        let middle = (min_texel + half) * texel;
        let rows = [
            row((self.u - middle.x * self.axis) / (half * texel.x), 0.0),
            row((middle.y * self.axis - self.v) / (half * texel.y), 0.0),
            row(self.axis * (far / (far - near)), -near * far / (far - near)),
            row(self.axis, 0.0),
        ];
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }
}

impl Part {
    pub const EMPTY: Self = Self {
        lo: DVec2::INFINITY,
        hi: DVec2::NEG_INFINITY,
        near: f64::INFINITY,
        far: f64::NEG_INFINITY,
        bounds: Aabb::EMPTY,
    };

    pub fn is_empty(&self) -> bool {
        self.far < self.near
    }

    /// Includes a point of the light's frustum.
    pub fn include(&mut self, frustum: &LightFrustum, point: DVec3) {
        // Clipping rounds; the frustum itself ends at `near`.
        let depth = frustum.depth(point).max(0.5 * frustum.near);
        let at = frustum.project(point);
        (self.lo, self.hi) = (self.lo.min(at), self.hi.max(at));
        (self.near, self.far) = (self.near.min(depth), self.far.max(depth));
        self.bounds = self.bounds.including(point);
    }

    /// Width and height in units of the tangent; never zero.
    pub fn extent(&self) -> DVec2 {
        let extent = (self.hi - self.lo).max(DVec2::ZERO);
        extent.max(DVec2::splat(LEAST_EDGE * extent.max_element().max(LEAST_EDGE)))
    }

    /// Planes through the light and the four edges of the rectangle.
    pub fn sides(&self, frustum: &LightFrustum) -> [Plane; 4] {
        let side = |normal: DVec3| {
            let normal = normal.normalize();
            Plane { normal, offset: normal.dot(frustum.position) }
        };
        let LightFrustum { u, v, axis, .. } = *frustum;
        [side(self.lo.x * axis - u), side(u - self.hi.x * axis), side(self.lo.y * axis - v), side(v - self.hi.y * axis)]
    }
}
