//! The smallest sphere around a slice of the view, which turning does not change.

use glam::DVec3;

use crate::{Frustum, Projection};

/// A sphere in view space that contains a slice of the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre in view space, metres.
    pub center: DVec3,
    /// Radius in metres.
    pub radius: f64,
}

/// The smallest sphere around the slice of `frustum` between view depths `a` and `b`. It depends on
/// the camera's lens alone, never on the camera's position or direction.
///
/// For a symmetric perspective frustum with `k² = tan²(fov_x/2) + tan²(fov_y/2)`: if `k² ≥ (b −
/// a)/(b + a)` the far face's circle decides (centre depth b, radius b k); else all eight corners
/// lie on it (centre depth (a + b)(1 + k²)/2). Orthographic: the box's own sphere. Off-axis: the
/// smallest sphere of the eight corners, by trying every sphere that two, three or four of them
/// span.
#[must_use]
pub fn slice_sphere(frustum: &Frustum, a: f64, b: f64) -> Sphere {
    let symmetric = frustum.left == -frustum.right && frustum.bottom == -frustum.top;
    match (frustum.projection, symmetric) {
        (Projection::Perspective, true) => {
            let k2 = frustum.right * frustum.right + frustum.top * frustum.top;
            if k2 * (b + a) >= b - a {
                Sphere { center: DVec3::new(0.0, 0.0, -b), radius: b * k2.sqrt() }
            } else {
                let c = 0.5 * (a + b) * (1.0 + k2);
                Sphere { center: DVec3::new(0.0, 0.0, -c), radius: ((b - c) * (b - c) + b * b * k2).sqrt() }
            }
        }
        (Projection::Orthographic, _) => {
            let half = DVec3::new(frustum.right - frustum.left, frustum.top - frustum.bottom, b - a) * 0.5;
            let middle = DVec3::new(frustum.right + frustum.left, frustum.top + frustum.bottom, -(a + b)) * 0.5;
            Sphere { center: middle, radius: half.length() }
        }
        (Projection::Perspective, false) => {
            let (near, far) = (frustum.corners_at(a), frustum.corners_at(b));
            let corners: [DVec3; 8] = std::array::from_fn(|i| if i < 4 { near[i] } else { far[i - 4] });
            smallest_sphere(&corners)
        }
    }
}

/// The smallest sphere around a few points, by brute force over the spheres that two to four points
/// span.
fn smallest_sphere(points: &[DVec3; 8]) -> Sphere {
    let mut best = Sphere { center: DVec3::ZERO, radius: f64::INFINITY };
    let mut consider = |center: DVec3| {
        let radius = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        if radius < best.radius {
            best = Sphere { center, radius };
        }
    };
    // A sphere about any centre that reaches the farthest point contains all; only the best centre
    // is kept.
    for i in 0..8 {
        for j in i + 1..8 {
            consider(0.5 * (points[i] + points[j]));
            for k in j + 1..8 {
                if let Some(center) = circumcenter(points[i], points[j], points[k]) {
                    consider(center);
                }
                for l in k + 1..8 {
                    if let Some(center) = circumcenter4(points[i], points[j], points[k], points[l]) {
                        consider(center);
                    }
                }
            }
        }
    }
    best
}

fn circumcenter(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec3> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let area2 = normal.length_squared();
    (area2 > 0.0)
        .then(|| a + (ac.length_squared() * normal.cross(ab) - ab.length_squared() * normal.cross(ac)) / (2.0 * area2))
}

fn circumcenter4(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
    let (u, v, w) = (b - a, c - a, d - a);
    let det = 2.0 * u.dot(v.cross(w));
    let center =
        a + (u.length_squared() * v.cross(w) + v.length_squared() * w.cross(u) + w.length_squared() * u.cross(v)) / det;
    (det != 0.0 && center.is_finite()).then_some(center)
}

/// Metres per texel so that a map of `size` texels serves an edge of twice `radius` with `margin`
/// texels on each side, wherever rounding to whole texels puts it.
#[must_use]
pub fn stable_texel(radius: f64, size: u32, margin: f64) -> f64 {
    2.0 * radius / (f64::from(size) - 2.0 * margin - 1.0)
}
