//! The view frustum of a camera.

use glam::{DMat4, DVec3, DVec4};

use super::matrix::{Matrix, ROUNDING};
use crate::bounds::{LEAST_METRES, MOST_METRES};
use crate::config::named;
use crate::{Error, Result, maths};

/// The largest tangent between a perspective camera's axis and a side of its view.
const WIDEST: f64 = 1e6;

/// Requirement on projection matrices, for errors.
const RIGHT_HANDED: &str = "right-handed, looking down −Z; View::from_matrices takes left-handed ones";

/// The least width and height of a view, as tangents or in metres.
const NARROWEST: f64 = 1e-9;

named! {
    /// Depth range and axis directions of a graphics API. They are needed to read near and far from
    /// a camera's projection, and to hand maps to an engine
    /// ([`crate::Split::shadow_from_world_in`], [`crate::Split::texture_from_world`]).
    ///
    /// v is that of textures. A camera's depth may run either way (reversed or not).
    pub enum DepthConvention as "depth convention" {
        /// NDC y up, z 0 to 1; v down: wgpu, Direct3D, Metal, Vulkan of negative viewport height
        #[default]
        ZeroToOne = "zero-to-one",
        /// NDC y down, z 0 to 1; v down: Vulkan of positive viewport height
        ZeroToOneYDown = "zero-to-one-y-down",
        /// NDC y up, z −1 to 1; v up: OpenGL
        MinusOneToOne = "minus-one-to-one",
    }
}

impl DepthConvention {
    /// The least depth in NDC.
    pub(super) fn lowest(self) -> f64 {
        if self == Self::MinusOneToOne { -1.0 } else { 0.0 }
    }
}

/// Kind of projection: perspective or orthographic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Rays meet in the eye. Sides are tangents: half widths at view depth 1.
    Perspective,
    /// Rays run in parallel. Sides are metres, the same at every depth.
    Orthographic,
}

/// View frustum of a camera, in the camera's view space (right-handed, looks down −Z).
///
/// The four sides are `x/d` and `y/d` at view depth `d` for a perspective frustum and plain `x` and
/// `y` in metres for an orthographic one. They need not be symmetric. `near` and `far` are view
/// depths in metres; `far` may be infinite for a perspective frustum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the sides are described together above")]
pub struct Frustum {
    pub projection: Projection,
    pub left: f64,
    pub right: f64,
    pub bottom: f64,
    pub top: f64,
    pub near: f64,
    pub far: f64,
}

/// On which side of the eye a range lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RangeSide {
    /// The side to which a right-handed camera looks.
    Ahead,
    /// The side to which a left-handed camera looks.
    Behind,
    /// Both sides, which only orthographic cameras see.
    Both,
}

impl Frustum {
    /// A symmetric perspective frustum. `fov_y` is the full vertical angle in radians, `aspect`
    /// width over height.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] naming the parameter that is out of range.
    pub fn perspective(fov_y: f64, aspect: f64, near: f64, far: f64) -> Result<Self> {
        if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) {
            return Err(Error::camera("fov", fov_y, "an angle in radians, more than 0 and less than π"));
        }
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(Error::camera("aspect", aspect, "a positive width / height"));
        }
        let top = maths::tan(0.5 * fov_y);
        let right = top * aspect;
        Self { projection: Projection::Perspective, left: -right, right, bottom: -top, top, near, far }.validated()
    }

    /// A symmetric orthographic frustum, `width` × `height` metres.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] naming the parameter that is out of range.
    pub fn orthographic(width: f64, height: f64, near: f64, far: f64) -> Result<Self> {
        Self {
            projection: Projection::Orthographic,
            left: -0.5 * width,
            right: 0.5 * width,
            bottom: -0.5 * height,
            top: 0.5 * height,
            near,
            far,
        }
        .validated()
    }

    /// Reads a frustum back from a projection matrix: perspective or orthographic, reversed or not,
    /// with a finite or infinite far plane, symmetric or off-axis.
    ///
    /// Entries that are zero but for the rounding of `f32` are taken for zero.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if the matrix is singular, holds NaN, looks down +Z (left-handed;
    /// [`crate::View::from_matrices`] takes such cameras), or projects in some other way. An
    /// orthographic range on both sides of the eye is taken as one of a right-handed camera.
    pub fn from_projection_matrix(clip_from_view: impl Into<Matrix>, depth: DepthConvention) -> Result<Self> {
        let frustum = Self::read(clip_from_view.into(), depth)?;
        match frustum.range_side() {
            RangeSide::Behind => Err(Error::camera("projection matrix", frustum.far, RIGHT_HANDED)),
            RangeSide::Ahead | RangeSide::Both => Ok(frustum),
        }
    }

    /// The frustum of a projection matrix that looks down −Z, or an orthographic one that may look
    /// down +Z: its near and far are less than 0 then.
    pub(super) fn read(clip_from_view: Matrix, depth: DepthConvention) -> Result<Self> {
        let m = clip_from_view.without_rounding();
        if !m.is_finite() {
            return Err(Error::camera("projection matrix", f64::NAN, "finite numbers only"));
        }
        let row = |i: usize| m.row(i);
        let (x, y, z, w) = (row(0), row(1), row(2), row(3));
        let perspective = w.z != 0.0;
        let foreign = || Error::camera("projection matrix", w.z, "a plain perspective or orthographic projection");
        if x.y != 0.0 || y.x != 0.0 || z.x != 0.0 || z.y != 0.0 || w.x != 0.0 || w.y != 0.0 || x.x == 0.0 || y.y == 0.0
        {
            return Err(foreign());
        }
        // NDC depth of view depth d (z_view = -d): perspective (z.w - z.z d) / (w.w - w.z d).
        let ndc_low = depth.lowest();
        let depth_at = |ndc: f64| (z.w - ndc * w.w) / (z.z - ndc * w.z);
        if perspective {
            if w.z > 0.0 {
                return Err(Error::camera("projection matrix", w.z, RIGHT_HANDED));
            }
            if w.w != 0.0 || x.w != 0.0 || y.w != 0.0 {
                return Err(foreign());
            }
            // The w row is (0, 0, -s, 0); dividing by s leaves the usual form.
            let s = -w.z;
            let side = |r: DVec4, axis: f64, ndc: f64| (ndc * s + r.z) / axis;
            let (a, b) = (depth_at(ndc_low), depth_at(1.0));
            let (near, far) = match (a <= MOST_METRES && a > 0.0, b <= MOST_METRES && b > 0.0) {
                (true, true) => (a.min(b), a.max(b)),
                (true, false) => (a, f64::INFINITY),
                (false, true) => (b, f64::INFINITY),
                (false, false) => return Err(foreign()),
            };
            let (l, r) = (side(x, x.x, -1.0), side(x, x.x, 1.0));
            let (b, t) = (side(y, y.y, -1.0), side(y, y.y, 1.0));
            let projection = Projection::Perspective;
            return Self { projection, left: l.min(r), right: l.max(r), bottom: b.min(t), top: b.max(t), near, far }
                .validated();
        }
        if w.w == 0.0 || x.z != 0.0 || y.z != 0.0 || z.z == 0.0 {
            return Err(foreign());
        }
        let side = |r: DVec4, axis: f64, ndc: f64| (ndc * w.w - r.w) / axis;
        let (l, r) = (side(x, x.x, -1.0), side(x, x.x, 1.0));
        let (b, t) = (side(y, y.y, -1.0), side(y, y.y, 1.0));
        let (d0, d1) = (depth_at(ndc_low), depth_at(1.0));
        Self {
            projection: Projection::Orthographic,
            left: l.min(r),
            right: l.max(r),
            bottom: b.min(t),
            top: b.max(t),
            near: d0.min(d1),
            far: d0.max(d1),
        }
        .validated()
    }

    /// Checks that sides are in order and within 10^6 (tangents) or 10^12 (metres), that near is at
    /// least 10^-9 m (any finite view depth for an orthographic frustum) and far greater, at most
    /// 10^12 m or infinite (not for an orthographic one).
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] naming the first field that is wrong.
    pub fn validated(self) -> Result<Self> {
        let is_perspective = self.projection == Projection::Perspective;
        let (widest, expected) = match self.projection {
            Projection::Perspective => (WIDEST, "a tangent between −10^6 and 10^6"),
            Projection::Orthographic => (MOST_METRES, "metres between −10^12 and 10^12"),
        };
        for (name, value) in [("left", self.left), ("right", self.right), ("bottom", self.bottom), ("top", self.top)] {
            if !(-widest..=widest).contains(&value) {
                return Err(Error::camera(name, value, expected));
            }
        }
        for (name, extent) in [("width", self.right - self.left), ("height", self.top - self.bottom)] {
            if !(NARROWEST..).contains(&extent) {
                return Err(Error::camera(name, extent, "greater than 0 (at least 10^-9)"));
            }
        }
        if is_perspective && !(LEAST_METRES..=MOST_METRES).contains(&self.near) {
            return Err(Error::camera("near", self.near, "a distance of 10^-9 to 10^12 m"));
        }
        if !is_perspective && !(-MOST_METRES..=MOST_METRES).contains(&self.near) {
            return Err(Error::camera("near", self.near, "a view depth between −10^12 and 10^12 m"));
        }
        let is_endless = is_perspective && self.far == f64::INFINITY;
        if !(self.far > self.near && (self.far <= MOST_METRES || is_endless)) {
            let expected = "greater than near and at most 10^12 m (or infinite for a perspective camera)";
            return Err(Error::camera("far", self.far, expected));
        }
        Ok(self)
    }

    /// The side of the eye on which the range lies, but for rounding.
    pub(super) fn range_side(&self) -> RangeSide {
        let rounding = ROUNDING * (self.far - self.near);
        match (self.near >= -rounding, self.far <= rounding) {
            (true, _) => RangeSide::Ahead,
            (false, true) => RangeSide::Behind,
            (false, false) => RangeSide::Both,
        }
    }

    /// The frustum of a camera whose x axis is reversed.
    pub(super) fn mirrored(self) -> Self {
        Self { left: -self.right, right: -self.left, ..self }
    }

    /// Factor by which the frustum at view depth `d` is wider than `left`..`top`: `d` for a
    /// perspective frustum, 1 for an orthographic one.
    #[must_use]
    pub fn scale_at(&self, d: f64) -> f64 {
        match self.projection {
            Projection::Perspective => d,
            Projection::Orthographic => 1.0,
        }
    }

    /// The four corners in view space at view depth `d`: bottom-left, bottom-right, top-left,
    /// top-right.
    #[must_use]
    pub fn corners_at(&self, d: f64) -> [DVec3; 4] {
        let s = self.scale_at(d);
        [
            DVec3::new(self.left * s, self.bottom * s, -d),
            DVec3::new(self.right * s, self.bottom * s, -d),
            DVec3::new(self.left * s, self.top * s, -d),
            DVec3::new(self.right * s, self.top * s, -d),
        ]
    }

    /// Projection matrix for wgpu with reversed depth: 1 at near, 0 at far (or at infinity).
    #[must_use]
    pub fn clip_from_view(&self) -> DMat4 {
        let (l, r, b, t, n, f) = (self.left, self.right, self.bottom, self.top, self.near, self.far);
        let (sx, sy) = (2.0 / (r - l), 2.0 / (t - b));
        let (ox, oy) = ((r + l) / (r - l), (t + b) / (t - b));
        match self.projection {
            Projection::Perspective => {
                // ndc = (p d-independent) : z = (A·z + B) / d with A = n/(f−n), B = n f/(f−n); A →
                // 0, B → n at f = ∞.
                let (a, bz) = if f.is_finite() { (n / (f - n), n * f / (f - n)) } else { (0.0, n) };
                DMat4::from_cols(
                    DVec4::new(sx, 0.0, 0.0, 0.0),
                    DVec4::new(0.0, sy, 0.0, 0.0),
                    DVec4::new(ox, oy, a, -1.0),
                    DVec4::new(0.0, 0.0, bz, 0.0),
                )
            }
            Projection::Orthographic => DMat4::from_cols(
                DVec4::new(sx, 0.0, 0.0, 0.0),
                DVec4::new(0.0, sy, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 1.0 / (f - n), 0.0),
                DVec4::new(-ox, -oy, f / (f - n), 1.0),
            ),
        }
    }
}
