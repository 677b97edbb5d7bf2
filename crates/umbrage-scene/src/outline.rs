//! Outlines of meshes, to bound upright instances exactly and quickly.

use glam::{DAffine3, DVec2, DVec3};
use umbrage::Aabb;

use crate::Mesh;

/// The convex hull of a mesh seen from above, and its heights. With it, exact bounds of an instance
/// that is turned about Y take some twenty points instead of all vertices.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    hull: Vec<DVec2>,
    low: f64,
    high: f64,
}

impl Outline {
    /// Makes the outline of the vertices of primitives with triangles; `None` if there are none.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        let drawn = mesh.primitives.iter().filter(|primitive| !primitive.indices.is_empty());
        let points: Vec<DVec3> =
            drawn.flat_map(|primitive| &primitive.positions).map(|p| DVec3::from(p.map(f64::from))).collect();
        let bounds = Aabb::from_points(points.iter().copied());
        bounds.is_valid().then(|| Self {
            hull: convex_hull(points.iter().map(|p| DVec2::new(p.x, p.z)).collect()),
            low: bounds.min.y,
            high: bounds.max.y,
        })
    }

    /// Returns the world bounds under a transform that keeps Y upright; `None` for any other
    /// transform.
    pub fn bounds(&self, world_from_local: &DAffine3) -> Option<Aabb> {
        let m = world_from_local.matrix3;
        let is_upright = [m.y_axis.x, m.y_axis.z, m.x_axis.y, m.z_axis.y].iter().all(|&part| part == 0.0);
        is_upright.then(|| {
            let ends = [self.low, self.high];
            let corners = self.hull.iter().flat_map(|p| ends.map(|y| DVec3::new(p.x, y, p.y)));
            Aabb::from_points(corners.map(|corner| world_from_local.transform_point3(corner)))
        })
    }
}

/// Returns the convex hull of points of the plane (Andrew's monotone chain, 1979).
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut hull: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = hull[..]
                && (b - a).perp_dot(point - a) <= 0.0
            {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
        hull
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::Primitive;

    #[test]
    fn bounds_are_those_of_all_vertices() {
        let share = |i: u32, step: u32| (i.wrapping_mul(step) % 997) as f32 / 997.0;
        let positions: Vec<[f32; 3]> =
            (0..300).map(|i| [share(i, 31) - 0.3, 2.0 * share(i, 57), share(i, 83) - 0.9]).collect();
        let primitive = Primitive { indices: (0..300).collect(), positions: positions.clone(), ..Primitive::default() };
        let outline = Outline::of(&Mesh { primitives: vec![primitive], ..Mesh::default() }).expect("it has vertices");
        assert!(outline.hull.len() < 60, "{} of 300 points", outline.hull.len());
        for turn in 0..50 {
            let rotation = DQuat::from_rotation_y(f64::from(turn) * 0.37);
            let scale = DVec3::new(1.0, 0.7, 1.0) * (0.5 + f64::from(turn));
            let at = DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::new(1e3, 5.0, -2e4));
            let points = positions.iter().map(|p| at.transform_point3(DVec3::from(p.map(f64::from))));
            let (all, fast) = (Aabb::from_points(points), outline.bounds(&at).expect("it is upright"));
            assert!(all.min.distance(fast.min) < 1e-9 && all.max.distance(fast.max) < 1e-9, "{all:?} {fast:?}");
        }
        let tilted = DAffine3::from_rotation_x(0.1);
        assert!(outline.bounds(&tilted).is_none());
    }

    #[test]
    fn few_points_are_their_own_hull() {
        let line = [DVec2::ZERO, DVec2::X, 2.0 * DVec2::X];
        assert_eq!(convex_hull(line[..1].to_vec()), line[..1]);
        assert_eq!(convex_hull(line.to_vec()), [line[0], line[2]]);
        assert!(Outline::of(&Mesh::default()).is_none());
    }
}
