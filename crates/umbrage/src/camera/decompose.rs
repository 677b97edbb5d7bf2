//! Cameras read back from view-projection matrices.

use glam::{DMat3, DVec3, DVec4};

use super::frustum::{DepthConvention, Frustum, Projection};
use super::matrix::{Matrix, ROUNDING};
use crate::bounds::MOST_METRES;
use crate::{Error, Result};

/// The largest cosine between two axes of a camera that counts as a right angle, for matrices in
/// `f32`.
const SKEW: f64 = 1e-3;

/// Largest share by which a depth row may deviate from the line of sight.
const ASIDE: f64 = 1e-3;

/// Share of an orthographic range's length by which the eye is put before near.
const STANDOFF: f64 = 0.01;

/// The eye, the camera's right, up and back, and the frustum from a view-projection matrix.
/// `forward` says which way an orthographic camera looks, which its matrix does not.
pub(super) fn camera(
    matrix: Matrix,
    forward: Option<DVec3>,
    depth: DepthConvention,
) -> Result<(DVec3, DMat3, Frustum)> {
    let rows = [0, 1, 2, 3].map(|i| matrix.0.row(i));
    let foreign = || {
        let expected = "a perspective or orthographic projection of a rotated and moved camera";
        Error::camera("view-projection matrix", matrix.0.determinant(), expected)
    };
    if !matrix.0.is_finite() {
        return Err(Error::camera("view-projection matrix", f64::NAN, "finite numbers only"));
    }
    let along = rows[3].truncate().length();
    let is_perspective = along > ROUNDING * rows[0].truncate().length();
    let scale = if is_perspective { along } else { rows[3].w };
    if scale == 0.0 {
        return Err(foreign());
    }
    let [x, y, z, w] = rows.map(|row| row / scale);
    if is_perspective {
        return perspective(x, y, z, w, depth).ok_or_else(foreign);
    }
    let sight = z.truncate().try_normalize().ok_or_else(foreign)?;
    let along = sight.dot(forward.ok_or(Error::OrthographicDirection)?.normalize_or_zero());
    if along.is_nan() || along.abs() <= SKEW {
        return Err(Error::camera("forward", along, "a finite vector that is not across the line of sight"));
    }
    orthographic(x, y, z, sight * along.signum(), depth).ok_or_else(foreign)
}

/// The camera's axes for a direction of sight. The flag is true if the frustum's own x runs the
/// other way.
fn axes(x: DVec3, y: DVec3, forward: DVec3) -> Option<(DMat3, bool)> {
    let (right, up) = (x.try_normalize()?, y.try_normalize()?);
    if right.dot(up).abs() > SKEW || right.dot(forward).abs() > SKEW || up.dot(forward).abs() > SKEW {
        return None;
    }
    let own_right = forward.cross(up).try_normalize()?;
    let axes = DMat3::from_cols(own_right, own_right.cross(forward), -forward);
    Some((axes, own_right.dot(right) < 0.0))
}

/// The camera from rows that are scaled so that w is the view depth.
fn perspective(x: DVec4, y: DVec4, z: DVec4, w: DVec4, depth: DepthConvention) -> Option<(DVec3, DMat3, Frustum)> {
    let forward = w.truncate();
    // NDC x is `scale · tangent + offset`; y alike.
    let (x_offset, y_offset) = (x.truncate().dot(forward), y.truncate().dot(forward));
    let (x_across, y_across) = (x.truncate() - x_offset * forward, y.truncate() - y_offset * forward);
    let (axes, is_mirrored) = axes(x_across, y_across, forward)?;
    let side = |across: DVec3, offset: f64, ndc: f64| (ndc - offset) / across.length();
    // NDC depth is `a + b / view depth`.
    let a = z.truncate().dot(forward);
    if (z.truncate() - a * forward).length() > ASIDE * (a.abs() + z.w.abs().min(1.0)) {
        return None;
    }
    let b = z.w - a * w.w;
    let at = |ndc: f64| Some(b / (ndc - a)).filter(|depth| *depth > 0.0 && *depth <= MOST_METRES);
    let (near, far) = match (at(depth.lowest()), at(1.0)) {
        (Some(one), Some(other)) => (one.min(other), one.max(other)),
        (Some(near), None) | (None, Some(near)) => (near, f64::INFINITY),
        (None, None) => return None,
    };
    // x, y and w are all 0 at the eye.
    let rows = DMat3::from_cols(x.truncate(), y.truncate(), forward).transpose();
    let eye = rows.inverse() * -DVec3::new(x.w, y.w, w.w);
    let frustum = Frustum {
        projection: Projection::Perspective,
        left: side(x_across, x_offset, -1.0),
        right: side(x_across, x_offset, 1.0),
        bottom: side(y_across, y_offset, -1.0),
        top: side(y_across, y_offset, 1.0),
        near,
        far,
    };
    Some((eye, axes, if is_mirrored { frustum.mirrored() } else { frustum }))
}

/// The camera from rows that are scaled so that w is 1, and the line of sight. The eye lies in the
/// middle, so that a mirrored camera has the sides of one that is not.
fn orthographic(x: DVec4, y: DVec4, z: DVec4, sight: DVec3, depth: DepthConvention) -> Option<(DVec3, DMat3, Frustum)> {
    let (axes, _) = axes(x.truncate(), y.truncate(), sight)?;
    let forward = -axes.z_axis;
    let a = z.truncate().dot(forward);
    if a == 0.0 || (z.truncate() - a * forward).length() > ASIDE * a.abs() {
        return None;
    }
    // Metres along the line of sight from the world's origin.
    let (one, other) = ((depth.lowest() - z.w) / a, (1.0 - z.w) / a);
    let (begin, end) = (one.min(other), one.max(other));
    let standoff = STANDOFF * (end - begin);
    let center = |row: DVec4| row.truncate() * (-row.w / row.truncate().length_squared());
    let eye = center(x) + center(y) + forward * (begin - standoff);
    let (right, top) = (1.0 / x.truncate().length(), 1.0 / y.truncate().length());
    let projection = Projection::Orthographic;
    let (near, far) = (standoff, standoff + end - begin);
    Some((eye, axes, Frustum { projection, left: -right, right, bottom: -top, top, near, far }))
}
