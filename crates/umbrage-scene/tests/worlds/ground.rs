//! The ground as a height over the plane, read back from the very triangles that are drawn.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3, Vec3Swizzles as _};
use umbrage_scene::Scene;

use crate::is_ground;

/// Triangles of the ground, found by the squares of 16 m that they touch.
pub(crate) struct Ground {
    buckets: HashMap<(i64, i64), Vec<[DVec3; 3]>>,
}

const BUCKET_M: f64 = 16.0;

fn bucket(place: DVec2) -> (i64, i64) {
    let cell = (place / BUCKET_M).floor();
    (cell.x as i64, cell.y as i64)
}

impl Ground {
    pub(crate) fn of(scene: &Scene) -> Self {
        let mut buckets: HashMap<_, Vec<_>> = HashMap::new();
        for node in scene.nodes.iter().filter(|node| is_ground(&node.name)) {
            let world_from_node = node.local.to_affine();
            for primitive in node.mesh.iter().flat_map(|&mesh| &scene.meshes[mesh].primitives) {
                for triangle in primitive.indices.chunks_exact(3) {
                    let corners = [0, 1, 2].map(|k| {
                        let local: Vec3 = primitive.positions[triangle[k] as usize].into();
                        world_from_node.transform_point3(local.as_dvec3())
                    });
                    let low = corners[0].xz().min(corners[1].xz()).min(corners[2].xz());
                    let high = corners[0].xz().max(corners[1].xz()).max(corners[2].xz());
                    let ((x0, z0), (x1, z1)) = (bucket(low), bucket(high));
                    for x in x0..=x1 {
                        for z in z0..=z1 {
                            buckets.entry((x, z)).or_default().push(corners);
                        }
                    }
                }
            }
        }
        Self { buckets }
    }

    /// The ground's height at a place (x, z); `None` beyond its edge.
    pub(crate) fn height(&self, place: DVec2) -> Option<f64> {
        self.buckets.get(&bucket(place))?.iter().find_map(|[a, b, c]| {
            let (ab, ac, to) = (b.xz() - a.xz(), c.xz() - a.xz(), place - a.xz());
            let area = ab.perp_dot(ac);
            let (v, w) = (to.perp_dot(ac) / area, ab.perp_dot(to) / area);
            let inside = v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9;
            inside.then_some(a.y + v * (b.y - a.y) + w * (c.y - a.y))
        })
    }
}

#[test]
fn heights_are_those_of_the_triangles_and_end_with_them() {
    let (_, mine) = &crate::worlds()[3];
    let ground = Ground::of(mine);
    let tile = mine.nodes.iter().find(|node| is_ground(&node.name)).expect("ground");
    let mesh = &mine.meshes[tile.mesh.expect("a tile is a mesh")];
    let vertex = tile.local.translation + Vec3::from_array(mesh.primitives[0].positions[60]).as_dvec3();
    let height = ground.height(vertex.xz()).expect("on the ground");
    assert!((height - vertex.y).abs() < 1e-6, "{height} at {vertex}");
    assert_eq!(ground.height(DVec2::new(801.0, 0.0)), None);
}
