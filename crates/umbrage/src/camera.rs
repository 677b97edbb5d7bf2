//! The view: where the eye stands, which way it looks and what it sees.

use glam::{DMat3, DMat4, DVec3, DVec4};

use crate::{Error, Result};

/// What an engine's graphics interface takes for granted: needed to read near and far back from a camera's projection, and to hand
/// maps to the engine ([`crate::Split::shadow_from_world_in`], [`crate::Split::texture_from_world`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthConvention {
    /// NDC depth in [0,1], textures' v down: wgpu, Direct3D, Metal, Vulkan. A camera's depth may run either way (reversed or not).
    ZeroToOne,
    /// NDC depth in [−1,1], textures' v up: OpenGL.
    MinusOneToOne,
}

/// Whether rays meet in the eye or run in parallel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Sides are tangents: half widths at view depth 1.
    Perspective,
    /// Sides are metres, the same at every depth.
    Orthographic,
}

/// What a camera sees, in its own view space (right-handed, looks down −Z).
///
/// The four sides are `x/d` and `y/d` at view depth `d` for a perspective frustum and plain `x` and `y` in metres for an
/// orthographic one. They need not be symmetric. `near` and `far` are view depths in metres; `far` may be infinite
/// for a perspective frustum.
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

impl Frustum {
    /// A symmetric perspective frustum. `fov_y` is the full vertical angle in radians, `aspect` width over height.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] naming the parameter that is out of range.
    pub fn perspective(fov_y: f64, aspect: f64, near: f64, far: f64) -> Result<Self> {
        if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) {
            return Err(Error::camera("fov", fov_y, "an angle between 0 and 180 degrees, both excluded"));
        }
        if !(aspect > 0.0 && aspect.is_finite()) {
            return Err(Error::camera("aspect", aspect, "a positive width / height"));
        }
        let top = (0.5 * fov_y).tan();
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

    /// Reads a frustum back from a projection matrix: perspective or orthographic, reversed or not, with a finite or
    /// infinite far plane, symmetric or off-axis.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if the matrix is singular, holds NaN, or projects in some other way.
    pub fn from_projection_matrix(clip_from_view: DMat4, depth: DepthConvention) -> Result<Self> {
        let m = clip_from_view;
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
        let ndc_low = if depth == DepthConvention::ZeroToOne { 0.0 } else { -1.0 };
        let depth_at = |ndc: f64| (z.w - ndc * w.w) / (z.z - ndc * w.z);
        if perspective {
            if w.w != 0.0 || x.w != 0.0 || y.w != 0.0 || w.z > 0.0 {
                return Err(foreign());
            }
            // The w row is (0, 0, -s, 0); dividing by s leaves the usual form.
            let s = -w.z;
            let side = |r: DVec4, axis: f64, ndc: f64| (ndc * s + r.z) / axis;
            let (a, b) = (depth_at(ndc_low), depth_at(1.0));
            let (near, far) = match (a.is_finite() && a > 0.0, b.is_finite() && b > 0.0) {
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

    /// Checks that every field is a number, that the sides are in order and that 0 < near < far (near ≥ 0 and a finite
    /// far for an orthographic frustum).
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] naming the first field that is wrong.
    pub fn validated(self) -> Result<Self> {
        for (name, value) in [("left", self.left), ("right", self.right), ("bottom", self.bottom), ("top", self.top)] {
            if !value.is_finite() {
                return Err(Error::camera(name, value, "a finite number"));
            }
        }
        if self.left >= self.right {
            return Err(Error::camera("width", self.right - self.left, "greater than 0"));
        }
        if self.bottom >= self.top {
            return Err(Error::camera("height", self.top - self.bottom, "greater than 0"));
        }
        let near_ok = match self.projection {
            Projection::Perspective => self.near > 0.0,
            Projection::Orthographic => self.near.is_finite(),
        };
        if !near_ok || !self.near.is_finite() {
            return Err(Error::camera("near", self.near, "a finite distance greater than 0"));
        }
        let far_ok = self.far > self.near && (self.far.is_finite() || self.projection == Projection::Perspective);
        if !far_ok {
            return Err(Error::camera("far", self.far, "greater than near (and finite for an orthographic camera)"));
        }
        Ok(self)
    }

    /// How much wider the frustum is at view depth `d` than its `left`..`top` say: `d` or 1.
    #[must_use]
    pub fn scale_at(&self, d: f64) -> f64 {
        match self.projection {
            Projection::Perspective => d,
            Projection::Orthographic => 1.0,
        }
    }

    /// The four corners in view space at view depth `d`: bottom-left, bottom-right, top-left, top-right.
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

    /// The projection wgpu wants, with reversed depth: 1 at near, 0 at far (or at infinity).
    #[must_use]
    pub fn clip_from_view(&self) -> DMat4 {
        let (l, r, b, t, n, f) = (self.left, self.right, self.bottom, self.top, self.near, self.far);
        let (sx, sy) = (2.0 / (r - l), 2.0 / (t - b));
        let (ox, oy) = ((r + l) / (r - l), (t + b) / (t - b));
        match self.projection {
            Projection::Perspective => {
                // ndc = (p d-independent) : z = (A·z + B) / d with A = n/(f−n), B = n f/(f−n); A → 0, B → n at f = ∞.
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

/// An eye in the world: a position, an orientation and a [`Frustum`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    eye: DVec3,
    /// Columns are the camera's right, up and back in world space.
    world_from_view: DMat3,
    frustum: Frustum,
}

impl View {
    /// A view from `eye` towards `target`. `up` may not be parallel to the line of sight.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if eye and target coincide, a number is not finite, or `up` is along the line of sight.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, frustum: Frustum) -> Result<Self> {
        if !eye.is_finite() {
            return Err(Error::camera("eye", f64::NAN, "finite numbers"));
        }
        if !target.is_finite() {
            return Err(Error::camera("target", f64::NAN, "finite numbers"));
        }
        let forward = (target - eye)
            .try_normalize()
            .ok_or_else(|| Error::camera("target", eye.distance(target), "a point away from the eye"))?;
        let right = forward
            .cross(up)
            .try_normalize()
            .filter(|_| forward.cross(up.normalize_or_zero()).length() > 1e-9)
            .ok_or_else(|| Error::camera("up", 0.0, "a direction that is not along the line of sight"))?;
        let world_from_view = DMat3::from_cols(right, right.cross(forward), -forward);
        Ok(Self { eye, world_from_view, frustum: frustum.validated()? })
    }

    /// Like [`View::look_at`] with up = +Y, or −Z where the line of sight is along Y.
    ///
    /// # Errors
    /// As [`View::look_at`].
    pub fn look_at_upright(eye: DVec3, target: DVec3, frustum: Frustum) -> Result<Self> {
        let along_y = (target - eye).normalize_or_zero().y.abs() > 1.0 - 1e-9;
        Self::look_at(eye, target, if along_y { DVec3::NEG_Z } else { DVec3::Y }, frustum)
    }

    /// A view from the camera's transform; only rotation and translation are used (a camera has no scale).
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if the matrix is not finite or its axes are degenerate.
    pub fn from_world_from_view(world_from_view: DMat4, frustum: Frustum) -> Result<Self> {
        let bad = || Error::camera("transform", f64::NAN, "a rotation and a translation");
        if !world_from_view.is_finite() {
            return Err(bad());
        }
        let back = world_from_view.z_axis.truncate().try_normalize().ok_or_else(bad)?;
        let up = world_from_view.y_axis.truncate();
        let right = up.cross(back).try_normalize().ok_or_else(bad)?;
        let world_from_view_rotation = DMat3::from_cols(right, back.cross(right), back);
        let eye = world_from_view.w_axis.truncate();
        Ok(Self { eye, world_from_view: world_from_view_rotation, frustum: frustum.validated()? })
    }

    /// A view from the two matrices an engine has at hand.
    ///
    /// # Errors
    /// As [`View::from_world_from_view`] and [`Frustum::from_projection_matrix`].
    pub fn from_matrices(world_from_view: DMat4, clip_from_view: DMat4, depth: DepthConvention) -> Result<Self> {
        Self::from_world_from_view(world_from_view, Frustum::from_projection_matrix(clip_from_view, depth)?)
    }

    /// The eye's position in the world, in metres.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Where the camera looks, a unit vector in the world.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        -self.world_from_view.z_axis
    }

    /// Columns: the camera's right, up and back as unit vectors in the world.
    #[must_use]
    pub fn world_from_view_rotation(&self) -> DMat3 {
        self.world_from_view
    }

    /// What the camera sees.
    #[must_use]
    pub fn frustum(&self) -> &Frustum {
        &self.frustum
    }

    /// The same eye with another frustum.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if the frustum is not valid.
    pub fn with_frustum(self, frustum: Frustum) -> Result<Self> {
        Ok(Self { frustum: frustum.validated()?, ..self })
    }

    /// View depth of a world point: metres along [`View::forward`], negative behind the eye.
    #[must_use]
    pub fn view_depth(&self, point_in_world: DVec3) -> f64 {
        (point_in_world - self.eye).dot(self.forward())
    }

    /// A point of view space in the world.
    #[must_use]
    pub fn world_from_view_point(&self, point_in_view: DVec3) -> DVec3 {
        self.eye + self.world_from_view * point_in_view
    }

    /// A point of the world in view space.
    #[must_use]
    pub fn view_from_world_point(&self, point_in_world: DVec3) -> DVec3 {
        self.world_from_view.transpose() * (point_in_world - self.eye)
    }

    /// The eight corners of the slice between view depths `a` and `b`, in the world: first the four of
    /// [`Frustum::corners_at`] at `a`, then those at `b`.
    #[must_use]
    pub fn slice_corners(&self, a: f64, b: f64) -> [DVec3; 8] {
        let (near, far) = (self.frustum.corners_at(a), self.frustum.corners_at(b));
        std::array::from_fn(|i| self.world_from_view_point(if i < 4 { near[i] } else { far[i - 4] }))
    }

    /// `view_from_world` relative to `origin`: what the GPU gets when its positions are relative to that world point.
    #[must_use]
    pub fn view_from_relative(&self, origin: DVec3) -> DMat4 {
        let rotation = self.world_from_view.transpose();
        DMat4::from_mat3_translation(rotation, rotation * (origin - self.eye))
    }

    /// `clip_from_world` relative to `origin`, with reversed depth.
    #[must_use]
    pub fn clip_from_relative(&self, origin: DVec3) -> DMat4 {
        self.frustum.clip_from_view() * self.view_from_relative(origin)
    }

    /// A world-space ray through a point of the image: `x` and `y` in [0,1] from the upper left corner. Returns the
    /// ray's origin and its direction, scaled so that one unit is one metre of view depth. A perspective ray starts in the
    /// eye, an orthographic one on the plane through it.
    #[must_use]
    pub fn ray_through(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let f = &self.frustum;
        let (px, py) = (f.left + (f.right - f.left) * x, f.top + (f.bottom - f.top) * y);
        match f.projection {
            Projection::Perspective => (self.eye, self.world_from_view * DVec3::new(px, py, -1.0)),
            Projection::Orthographic => (self.world_from_view_point(DVec3::new(px, py, 0.0)), self.forward()),
        }
    }
}
