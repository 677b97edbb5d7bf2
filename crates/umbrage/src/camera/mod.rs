//! The view: position, orientation and frustum of the camera.

mod decompose;
mod frustum;
mod matrix;

use glam::{DMat3, DMat4, DVec3, DVec4};

use crate::bounds::MOST_METRES;
use crate::{Error, Result};
use frustum::RangeSide;
pub use frustum::{DepthConvention, Frustum, Projection};
pub use matrix::Matrix;

/// A camera in the world: a position, an orientation and a [`Frustum`].
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
    /// [`Error::InvalidCamera`] if eye and target coincide, a number is not finite, or `up` is
    /// along the line of sight.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, frustum: Frustum) -> Result<Self> {
        check_eye(eye)?;
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

    /// A view from the camera's transform. Only rotation and translation are used, as a camera has
    /// no scale. A transform that mirrors makes a mirrored camera: the frustum's left and right are
    /// measured along the camera's own x.
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
        let is_mirrored = right.dot(world_from_view.x_axis.truncate()) < 0.0;
        let frustum = if is_mirrored { frustum.mirrored() } else { frustum };
        let world_from_view_rotation = DMat3::from_cols(right, back.cross(right), back);
        let eye = check_eye(world_from_view.w_axis.truncate())?;
        Ok(Self { eye, world_from_view: world_from_view_rotation, frustum: frustum.validated()? })
    }

    /// A view from the two matrices that engines have. Left-handed and mirrored cameras are
    /// accepted. An orthographic camera looks to the side of its eye on which its range lies.
    ///
    /// # Errors
    /// As [`View::from_world_from_view`] and [`Frustum::from_projection_matrix`];
    /// [`Error::OrthographicDirection`] for an orthographic camera whose range lies on both sides
    /// of its eye: a left-handed one has the matrices of a reversed one then.
    pub fn from_matrices(
        world_from_view: impl Into<Matrix>,
        clip_from_view: impl Into<Matrix>,
        depth: DepthConvention,
    ) -> Result<Self> {
        let (world_from_view, clip_from_view) = (world_from_view.into(), clip_from_view.into());
        // w grows along +Z: the camera looks down +Z.
        if clip_from_view.without_rounding().row(3).z > 0.0 {
            return Self::from_clip_from_world(clip_from_view.0 * world_from_view.0.inverse(), depth);
        }
        let frustum = Frustum::read(clip_from_view, depth)?;
        match frustum.range_side() {
            RangeSide::Ahead => Self::from_world_from_view(world_from_view.0, frustum),
            RangeSide::Behind => {
                let turned = DMat4::from_diagonal(DVec4::new(1.0, 1.0, -1.0, 1.0));
                let frustum = Frustum::read(Matrix(clip_from_view.0 * turned), depth)?;
                Self::from_world_from_view(world_from_view.0 * turned, frustum)
            }
            RangeSide::Both => Err(Error::OrthographicDirection),
        }
    }

    /// A view from the view-projection matrix of a perspective camera alone: right- or left-handed,
    /// reversed or not, with a finite or infinite far plane, symmetric or off-axis, mirrored or
    /// not.
    ///
    /// # Errors
    /// [`Error::InvalidCamera`] if the matrix is singular, holds NaN, or is no projection of a
    /// rotated camera; [`Error::OrthographicDirection`] for an orthographic one, which
    /// [`View::from_orthographic`] takes.
    pub fn from_clip_from_world(clip_from_world: impl Into<Matrix>, depth: DepthConvention) -> Result<Self> {
        Self::from_matrix(clip_from_world.into(), None, depth)
    }

    /// A view from the view-projection matrix of an orthographic camera: right- or left-handed,
    /// reversed or not, symmetric or off-axis, mirrored or not. The matrix alone does not say which
    /// way the camera looks: `forward` does, any world vector within a right angle of it.
    ///
    /// The eye is not in the matrix either: it is put a hundredth of the range's length before
    /// near.
    ///
    /// # Errors
    /// As [`View::from_clip_from_world`], and [`Error::InvalidCamera`] for a `forward` that is
    /// across the line of sight or not finite. A perspective matrix has a direction, and `forward`
    /// is not asked for.
    pub fn from_orthographic(
        clip_from_world: impl Into<Matrix>,
        forward: DVec3,
        depth: DepthConvention,
    ) -> Result<Self> {
        Self::from_matrix(clip_from_world.into(), Some(forward), depth)
    }

    fn from_matrix(clip_from_world: Matrix, forward: Option<DVec3>, depth: DepthConvention) -> Result<Self> {
        let (eye, axes, frustum) = decompose::camera(clip_from_world, forward, depth)?;
        Ok(Self { eye: check_eye(eye)?, world_from_view: axes, frustum: frustum.validated()? })
    }

    /// The eye's position in the world, in metres.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Viewing direction, a unit vector in the world.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        -self.world_from_view.z_axis
    }

    /// Columns: the camera's right, up and back as unit vectors in the world.
    #[must_use]
    pub fn world_from_view_rotation(&self) -> DMat3 {
        self.world_from_view
    }

    /// View frustum of the camera.
    #[must_use]
    pub fn frustum(&self) -> &Frustum {
        &self.frustum
    }

    /// The camera with another frustum.
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

    /// Transforms a point from view space to the world.
    #[must_use]
    pub fn world_from_view_point(&self, point_in_view: DVec3) -> DVec3 {
        self.eye + self.world_from_view * point_in_view
    }

    /// Transforms a point from the world to view space.
    #[must_use]
    pub fn view_from_world_point(&self, point_in_world: DVec3) -> DVec3 {
        self.world_from_view.transpose() * (point_in_world - self.eye)
    }

    /// The eight corners of the slice between view depths `a` and `b`, in the world: first the four
    /// of [`Frustum::corners_at`] at `a`, then those at `b`.
    #[must_use]
    pub fn slice_corners(&self, a: f64, b: f64) -> [DVec3; 8] {
        let (near, far) = (self.frustum.corners_at(a), self.frustum.corners_at(b));
        std::array::from_fn(|i| self.world_from_view_point(if i < 4 { near[i] } else { far[i - 4] }))
    }

    /// Matrix to view space from positions relative to the world point `origin`, for a GPU whose
    /// positions are relative to that point.
    #[must_use]
    pub fn view_from_relative(&self, origin: DVec3) -> DMat4 {
        let rotation = self.world_from_view.transpose();
        DMat4::from_mat3_translation(rotation, rotation * (origin - self.eye))
    }

    /// Matrix to clip space from positions relative to `origin`, with reversed depth.
    #[must_use]
    pub fn clip_from_relative(&self, origin: DVec3) -> DMat4 {
        self.frustum.clip_from_view() * self.view_from_relative(origin)
    }

    /// A world-space ray through a point of the image: `x` and `y` in \[0,1\] from the upper left
    /// corner. Returns the ray's origin and its direction, scaled so that one unit is one metre of
    /// view depth. A perspective ray starts in the eye, an orthographic one on the plane through
    /// it.
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

/// Checks the position of a camera.
fn check_eye(eye: DVec3) -> Result<DVec3> {
    if eye.abs().cmple(DVec3::splat(MOST_METRES)).all() {
        return Ok(eye);
    }
    let farthest = if eye.is_nan() { f64::NAN } else { eye.abs().max_element() };
    Err(Error::camera("eye", farthest, "three numbers within ±10^12 m"))
}
