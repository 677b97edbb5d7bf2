//! Intersection of rays with triangles in `f64`.
//!
//! The test is the watertight one of Woop, Benthin and Wald (JCGT 2013): a ray through an edge or a
//! corner that two triangles share meets at least one of them, because both compute the very same
//! edge function. All of it is in `f64`; the paper's fallback to higher precision where an edge
//! function is 0 is replaced by counting such a point as inside. Edges of two objects share no
//! corner bit for bit, so a point counts as inside too, where an edge function is 0 within its
//! rounding.

use glam::DVec3;

use crate::bvh::BoxRay;
use crate::triangles::EDGE_ERROR;

/// A ray with the values that its tests share. `t` is in units of the direction's length.
pub(crate) struct Ray {
    /// The ray as the tests of boxes use it.
    pub boxes: BoxRay,
    pub t_min: f64,
    pub t_max: f64,
    origin: DVec3,
    /// Axes x, y, z of the sheared space. z is the axis along which the direction is longest.
    axes: [usize; 3],
    shear: [f64; 3],
    /// Largest coordinate of the origin.
    reach: f64,
}

/// Intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub t: f64,
    /// Barycentric coordinates of the intersection; they sum to 1.
    pub weights: [f64; 3],
}

impl Ray {
    /// Makes a ray from `origin` for `t` in `[t_min, t_max]`. `direction` is finite and not zero.
    pub(crate) fn new(origin: DVec3, direction: DVec3, t_min: f64, t_max: f64) -> Self {
        let size = direction.abs();
        let z = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let along = direction[z];
        Self {
            boxes: BoxRay::new(origin, direction, t_min),
            t_min,
            t_max,
            origin,
            axes: [x, y, z],
            shear: [direction[x] / along, direction[y] / along, 1.0 / along],
            reach: origin.abs().max_element(),
        }
    }

    /// Intersects the ray with a triangle for `t_min <= t <= t_max`, from either side. A triangle
    /// seen exactly edge-on is not met.
    #[inline(always)]
    pub(crate) fn meets(&self, corners: &[DVec3; 3], t_max: f64) -> Option<Crossing> {
        let [x, y, z] = self.axes;
        let [sx, sy, sz] = self.shear;
        let sheared = |corner: DVec3| {
            let relative = (corner - self.origin).to_array();
            (relative[x] - sx * relative[z], relative[y] - sy * relative[z], sz * relative[z])
        };
        let (a, b, c) = (sheared(corners[0]), sheared(corners[1]), sheared(corners[2]));
        let u = c.0 * b.1 - c.1 * b.0;
        let v = a.0 * c.1 - a.1 * c.0;
        let w = b.0 * a.1 - b.1 * a.0;
        let determinant = u + v + w;
        let (least, most) = (u.min(v).min(w), u.max(v).max(w));
        if least < 0.0 && most > 0.0 {
            let aside = [a.0, a.1, b.0, b.1, c.0, c.1].into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let ahead = a.2.abs().max(b.2.abs()).max(c.2.abs()) / sz.abs();
            let tolerance = EDGE_ERROR * (aside + ahead + self.reach);
            // An edge is at most √8 times as long as its corners are aside, and its function is its
            // length times its distance.
            let error = 3.0 * tolerance * aside;
            // A triangle that is no larger than its rounding has no edges to speak of.
            if determinant.abs() <= 8.0 * error || (least < -error && most > error) {
                return None;
            }
            return self.meets_edge([a, b, c], tolerance, t_max);
        }
        if determinant == 0.0 {
            return None;
        }
        let weights = [u / determinant, v / determinant, w / determinant];
        let t = weights[0] * a.2 + weights[1] * b.2 + weights[2] * c.2;
        (t >= self.t_min && t <= t_max).then_some(Crossing { t, weights })
    }

    /// Returns the first crossing of the ray with an edge of a triangle, within `tolerance`.
    /// Corners are sheared, so that the ray is their third axis. The edge does not depend on
    /// `t_max`, which a tree lowers to the nearest hit so far.
    #[cold]
    fn meets_edge(&self, corners: [(f64, f64, f64); 3], tolerance: f64, t_max: f64) -> Option<Crossing> {
        let passed = |first: usize| {
            let second = (first + 1) % 3;
            let (p, q) = (corners[first], corners[second]);
            let (dx, dy) = (q.0 - p.0, q.1 - p.1);
            let squared = dx * dx + dy * dy;
            let share = if squared > 0.0 { (-(p.0 * dx + p.1 * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let t = p.2 + share * (q.2 - p.2);
            let mut weights = [0.0; 3];
            (weights[first], weights[second]) = (1.0 - share, share);
            let is_near = (p.0 + share * dx).hypot(p.1 + share * dy) <= tolerance;
            (is_near && t >= self.t_min).then_some(Crossing { t, weights })
        };
        let nearest = (0..3).filter_map(passed).min_by(|a, b| a.t.total_cmp(&b.t));
        nearest.filter(|crossing| crossing.t <= t_max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_edges_and_corners_are_closed() {
        // A fan around a corner, seen along every axis: rays through the corner and along the
        // shared edges always meet it.
        let rim: Vec<DVec3> =
            (0..7).map(|i| DVec3::from_angle_on_floor(f64::from(i) * std::f64::consts::TAU / 7.0)).collect();
        for axis in 0..3 {
            let turn = |p: DVec3| DVec3::new(p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]);
            for i in 0..7 {
                for share in [0.0, 0.1, 0.5, 0.9] {
                    let at = rim[i] * share;
                    let eye = turn(at + DVec3::new(0.3, 5.0, 0.7));
                    let ray = Ray::new(eye, turn(at) - eye, 0.0, f64::INFINITY);
                    let met = (0..7).any(|k| {
                        let corners = [DVec3::ZERO, rim[k], rim[(k + 1) % 7]].map(turn);
                        ray.meets(&corners, f64::INFINITY).is_some()
                    });
                    assert!(met, "axis {axis}, edge {i}, share {share}");
                }
            }
        }
    }

    #[test]
    fn edges_that_agree_up_to_rounding_are_closed() {
        // Two walls that meet along z = 1 at y = 1, one ulp apart; rays through the edge from all
        // over.
        let edge = 1.0_f64;
        let above = edge.next_up();
        let roof = [DVec3::new(-1.0, above, -1.0), DVec3::new(1.0, above, -1.0), DVec3::new(0.0, above, above)];
        let wall = [DVec3::new(-1.0, edge, edge), DVec3::new(1.0, edge, edge), DVec3::new(0.0, -1.0, edge)];
        for i in 0..200 {
            let from = DVec3::new(0.0, f64::from(i) * 0.009 - 0.9, -0.7);
            let ray = Ray::new(from, DVec3::new(0.0, edge, edge) - from, 0.0, f64::INFINITY);
            assert!([roof, wall].iter().any(|corners| ray.meets(corners, f64::INFINITY).is_some()), "from {from}");
            let beside = Ray::new(from, DVec3::new(0.0, 1.0 + 1e-12, 1.0) - from, 0.0, f64::INFINITY);
            assert!(beside.meets(&wall, f64::INFINITY).is_none(), "1e-12 above the wall, from {from}");
        }
    }

    trait OnFloor {
        fn from_angle_on_floor(angle: f64) -> DVec3;
    }
    impl OnFloor for DVec3 {
        fn from_angle_on_floor(angle: f64) -> DVec3 {
            DVec3::new(angle.cos(), 0.0, angle.sin())
        }
    }

    #[test]
    fn edge_on_and_degenerate_triangles_are_not_met() {
        let ray = Ray::new(DVec3::ZERO, DVec3::X, 0.0, f64::INFINITY);
        let edge_on = [DVec3::new(1.0, 0.0, -1.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(3.0, 0.0, -1.0)];
        let point = [DVec3::X; 3];
        let line = [DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 2.0, 0.0)];
        for corners in [edge_on, point, line] {
            assert!(ray.meets(&corners, f64::INFINITY).is_none(), "{corners:?}");
        }
    }

    #[test]
    fn distance_and_weights_are_those_of_the_point() {
        let corners = [DVec3::new(0.0, 2.0, 0.0), DVec3::new(3.0, 2.0, 0.0), DVec3::new(0.0, 2.0, 3.0)];
        let ray = Ray::new(DVec3::new(1.0, 10.0, 0.5), DVec3::new(0.0, -2.0, 0.0), 0.0, f64::INFINITY);
        let crossing = ray.meets(&corners, f64::INFINITY).expect("straight down onto it");
        assert!((crossing.t - 4.0).abs() < 1e-12);
        let at: DVec3 = corners.iter().zip(crossing.weights).map(|(&c, w)| c * w).sum();
        assert!(at.distance(DVec3::new(1.0, 2.0, 0.5)) < 1e-12);
        assert!(ray.meets(&corners, 3.9).is_none());
    }
}
