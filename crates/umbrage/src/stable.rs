//! Maps that stand still: a sphere around the slice, moved in whole texels.

use glam::{DVec2, DVec3};

use crate::{Frustum, Projection};

/// A sphere in view space that contains a slice of the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre in view space, metres.
    pub center: DVec3,
    /// Radius in metres.
    pub radius: f64,
}

/// The smallest sphere around the slice of `frustum` between view depths `a` and `b`. It depends on the camera's lens alone,
/// never on where the camera stands or looks.
///
/// For a symmetric perspective frustum with `k² = tan²(fov_x/2) + tan²(fov_y/2)`: if `k² ≥ (b − a)/(b + a)` the far face's circle
/// decides (centre depth b, radius b k); else all eight corners lie on it (centre depth (a + b)(1 + k²)/2). Orthographic: the
/// box's own sphere. Off-axis: the smallest sphere of the eight corners, by trying every sphere that two, three or
/// four of them span.
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

/// The smallest sphere around a few points, by brute force over the spheres that two to four of them span.
fn smallest_sphere(points: &[DVec3; 8]) -> Sphere {
    let mut best = Sphere { center: DVec3::ZERO, radius: f64::INFINITY };
    let mut consider = |center: DVec3| {
        let radius = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        if radius < best.radius {
            best = Sphere { center, radius };
        }
    };
    // A sphere about any centre that reaches the farthest point contains all; only the best centre is kept.
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

/// Rounds a size up to geometric steps, with one step of hysteresis, so that it changes rarely.
///
/// A size that has never changed is kept as it is; once it outgrows the held value or falls two steps below it, the next step above
/// the new size is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldSize {
    held: Option<f64>,
}

/// Steps per doubling of a held size: one step is 2^(1/8), 9 %.
const STEPS_PER_OCTAVE: f64 = 8.0;

/// Relative room for rounding, so that a size that comes round again by another way is the same.
const ROUNDING: f64 = 1e-13;

impl HeldSize {
    /// The held size for `size`, in steps of 2^(1/8).
    pub fn hold(&mut self, size: f64) -> f64 {
        self.hold_in_steps(size, STEPS_PER_OCTAVE)
    }

    /// The same with so many steps to a doubling.
    pub fn hold_in_steps(&mut self, size: f64, steps: f64) -> f64 {
        let step = |size: f64| 2f64.powf((size.log2() * steps).ceil() / steps).max(size);
        let lowest = |held: f64| held * 2f64.powf(-2.0 / steps);
        let value = match self.held {
            None => size,
            Some(held) if size <= held * (1.0 + ROUNDING) && size >= lowest(held) => held,
            Some(_) => step(size),
        };
        self.held = Some(value);
        value
    }
}

/// Steps per doubling of a held lens: one step is 2^(1/4), 19 %, so that maps follow a lens that narrows once it has by √2.
///
/// A step changes all texels of all maps at once. With steps of 9 % one of 600 frames of a slow zoom takes one, and flicker above what is
/// asked; what is given for it is sharpness that the zoom would have brought.
const LENS_STEPS_PER_OCTAVE: f64 = 4.0;

/// The lens that still maps are made for: the camera's own until it zooms, then held.
///
/// The lens is held so long, and not the maps' sizes, so that a camera that does not zoom pays nothing: sizes follow from the range as
/// well.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldLens {
    width: HeldSize,
}

impl HeldLens {
    /// `frustum`, or one around it that is wider by the same factor on all sides on which it may grow: one that lies beside the axis is not
    /// moved away from it.
    pub fn hold(&mut self, frustum: &Frustum) -> Frustum {
        let width = (frustum.right - frustum.left).hypot(frustum.top - frustum.bottom);
        let wider = (self.width.hold_in_steps(width, LENS_STEPS_PER_OCTAVE) / width).max(1.0);
        Frustum {
            left: frustum.left.min(frustum.left * wider),
            right: frustum.right.max(frustum.right * wider),
            bottom: frustum.bottom.min(frustum.bottom * wider),
            top: frustum.top.max(frustum.top * wider),
            ..*frustum
        }
    }
}

/// Half the edges of a still map, each held as a [`HeldSize`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldHalf {
    u: HeldSize,
    v: HeldSize,
}

impl HeldHalf {
    pub fn hold(&mut self, half: DVec2) -> DVec2 {
        DVec2::new(self.u.hold(half.x), self.v.hold(half.y))
    }
}

/// Metres per texel so that a map of `size` texels serves an edge of twice `radius` with `margin` texels on each side, wherever
/// rounding to whole texels puts it.
#[must_use]
pub fn stable_texel(radius: f64, size: u32, margin: f64) -> f64 {
    2.0 * radius / (f64::from(size) - 2.0 * margin - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_lens_contains_every_lens_it_is_held_for() {
        // In the middle, to one side of the axis, and beside it (the outer screens of a wall).
        for [left, right, bottom, top] in
            [[-1.0, 1.0, -0.6, 0.6], [-0.2, 1.0, -0.6, 0.1], [0.7, 1.4, -0.4, 0.4], [-2.0, -0.5, 0.1, 0.9]]
        {
            let frustum =
                Frustum { left, right, bottom, top, ..Frustum::perspective(1.0, 1.0, 0.1, 100.0).expect("valid") };
            let (mut held, mut steps, mut before) = (HeldLens::default(), 0, None);
            for k in 0..400 {
                let zoom = 1.0 + 0.9 * (0.03 * f64::from(k)).sin();
                let asked = Frustum {
                    left: left * zoom,
                    right: right * zoom,
                    bottom: bottom * zoom,
                    top: top * zoom,
                    ..frustum
                };
                let lens = held.hold(&asked);
                assert!(lens.left <= asked.left && lens.right >= asked.right, "{lens:?} for {asked:?}");
                assert!(lens.bottom <= asked.bottom && lens.top >= asked.top, "{lens:?} for {asked:?}");
                steps += i32::from(before.is_some_and(|before| before != held));
                before = Some(held);
            }
            assert!((4..60).contains(&steps), "{steps} steps");
        }
    }
}
