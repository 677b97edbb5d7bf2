//! Huge triangles are cut before they are uploaded.
//!
//! A device places the vertices of a triangle in `f32`, and interpolates the fragments between
//! them: in the middle of a ground of two triangles of 1,000 km, a fragment is off by 3 cm, several
//! texels of a map (`docs/notes/coordinates.md`). Vertices of smaller triangles are placed as
//! exactly as they are near the eye.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::{Vec3, Vec4};
use umbrage_scene::{Node, Primitive, Scene};

/// Longest edge that is left, in metres. Vertices 16 km away are placed to a millimetre.
const LONGEST: f64 = 16_384.0;

/// Most pieces along the longest edge of a primitive. A primitive that spans a planet is left
/// coarser.
const MOST_PIECES: f64 = 64.0;

/// Most triangles with a long edge that a primitive may have to be cut. One that has more is fine
/// enough already.
const MOST_LONG: usize = 64;

/// Returns the meshes of a scene, with huge triangles cut. Meshes that skins or morph targets move
/// stay unchanged.
pub(crate) fn meshes(scene: &Scene) -> Vec<Cow<'_, [Primitive]>> {
    let scales = scales(scene);
    let cut = |(index, mesh): (usize, &'_ umbrage_scene::Mesh)| -> Option<Vec<Primitive>> {
        let scale = scales[index]?;
        let cut: Vec<Option<Primitive>> = mesh.primitives.iter().map(|primitive| cut(primitive, scale)).collect();
        cut.iter().any(Option::is_some).then(|| {
            let whole = mesh.primitives.iter().zip(cut);
            whole.map(|(primitive, cut)| cut.unwrap_or_else(|| primitive.clone())).collect()
        })
    };
    let mesh = |(index, mesh)| match cut((index, mesh)) {
        Some(primitives) => Cow::Owned(primitives),
        None => Cow::Borrowed(mesh.primitives.as_slice()),
    };
    scene.meshes.iter().enumerate().map(mesh).collect()
}

/// Largest factor by which nodes enlarge each mesh; `None` for a mesh that skins or morph targets
/// move.
fn scales(scene: &Scene) -> Vec<Option<f64>> {
    let mut of_meshes: Vec<Option<f64>> = scene.meshes.iter().map(|mesh| (!mesh.is_morphed()).then_some(0.0)).collect();
    let mut of_nodes: Vec<f64> = Vec::with_capacity(scene.nodes.len());
    for Node { parent, local, mesh, skin, instances, .. } in &scene.nodes {
        let scale = parent.map_or(1.0, |parent| of_nodes[parent]) * local.scale.abs().max_element();
        of_nodes.push(scale);
        let Some(of_mesh) = mesh.and_then(|mesh| of_meshes.get_mut(mesh)) else { continue };
        let instances = instances.iter().map(|instance| instance.scale.abs().max_element()).reduce(f64::max);
        let scale = scale * instances.unwrap_or(1.0);
        *of_mesh = of_mesh.filter(|_| skin.is_none()).map(|before| before.max(scale));
    }
    of_meshes
}

/// Cuts a primitive until no edge is too long; `None` if none is, or if more than [`MOST_LONG`]
/// triangles have one.
fn cut(primitive: &Primitive, scale: f64) -> Option<Primitive> {
    let length = |a: u32, b: u32| {
        let [a, b] = [a, b].map(|index| Vec3::from(primitive.positions[index as usize]).as_dvec3());
        scale * a.distance(b)
    };
    let longest = |t: &[u32]| length(t[0], t[1]).max(length(t[1], t[2])).max(length(t[2], t[0]));
    let long: Vec<f64> = primitive.indices.chunks_exact(3).map(longest).filter(|&edge| edge > LONGEST).collect();
    if long.is_empty() || long.len() > MOST_LONG {
        return None;
    }
    let most = long.iter().copied().fold(0.0, f64::max);
    let mut cutter = Cutter {
        primitive: primitive.clone(),
        longest: LONGEST.max(most / MOST_PIECES) / scale,
        middles: HashMap::new(),
    };
    let mut indices = Vec::new();
    for triangle in primitive.indices.chunks_exact(3) {
        cutter.cut([triangle[0], triangle[1], triangle[2]], &mut indices);
    }
    cutter.primitive.indices = indices;
    Some(cutter.primitive)
}

/// Cuts triangles at the middles of edges, the longest first. An edge that two triangles share is
/// cut in the same places in both, so that no gap opens.
struct Cutter {
    primitive: Primitive,
    /// Longest edge that is left, in the primitive's own units.
    longest: f64,
    middles: HashMap<(u32, u32), u32>,
}

impl Cutter {
    fn cut(&mut self, triangle: [u32; 3], into: &mut Vec<u32>) {
        let mut left = vec![triangle];
        while let Some([a, b, c]) = left.pop() {
            let edges = [[a, b, c], [b, c, a], [c, a, b]];
            let lengths = edges.map(|[from, to, _]| self.length(from, to));
            let longest = (1..3).fold(0, |best, edge| if lengths[edge] > lengths[best] { edge } else { best });
            if lengths[longest] <= self.longest {
                into.extend([a, b, c]);
                continue;
            }
            let [from, to, opposite] = edges[longest];
            let middle = self.middle(from, to);
            left.extend([[from, middle, opposite], [middle, to, opposite]]);
        }
    }

    fn at(&self, index: u32) -> Vec3 {
        self.primitive.positions[index as usize].into()
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        self.at(a).as_dvec3().distance(self.at(b).as_dvec3())
    }

    /// Returns the vertex in the middle of an edge.
    fn middle(&mut self, a: u32, b: u32) -> u32 {
        let edge = (a.min(b), a.max(b));
        if let Some(&middle) = self.middles.get(&edge) {
            return middle;
        }
        let middle = self.primitive.positions.len() as u32;
        let position = 0.5 * (self.at(edge.0).as_dvec3() + self.at(edge.1).as_dvec3());
        let Primitive { positions, normals, uvs, colors, .. } = &mut self.primitive;
        positions.push(position.as_vec3().to_array());
        let [i, j] = [edge.0, edge.1].map(|index| index as usize);
        if let (Some(&a), Some(&b)) = (normals.get(i), normals.get(j)) {
            let (a, b) = (Vec3::from(a), Vec3::from(b));
            normals.push((a + b).try_normalize().unwrap_or(a).to_array());
        }
        if let (Some(a), Some(b)) = (uvs.get(i), uvs.get(j)) {
            uvs.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        }
        if let (Some(&a), Some(&b)) = (colors.get(i), colors.get(j)) {
            colors.push((0.5 * (Vec4::from(a) + Vec4::from(b))).to_array());
        }
        self.middles.insert(edge, middle);
        middle
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::DVec3;
    use umbrage_scene::{Mesh, Trs};

    use super::*;

    fn ground(half: f32) -> Primitive {
        Primitive {
            positions: vec![[-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half], [-half, 0.0, -half]],
            normals: vec![[0.0, 1.0, 0.0]; 4],
            uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Primitive::default()
        }
    }

    fn area(primitive: &Primitive) -> f64 {
        let at = |index: u32| Vec3::from(primitive.positions[index as usize]).as_dvec3();
        let double = |t: &[u32]| (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).dot(DVec3::Y);
        primitive.indices.chunks_exact(3).map(double).sum::<f64>() / 2.0
    }

    #[test]
    fn a_huge_ground_is_cut_without_gaps() {
        for (half, longest) in [(500_000.0, 24_000.0), (1e9, 5e7)] {
            let whole = ground(half);
            let cut = cut(&whole, 1.0).expect("its edges are long");
            assert!((area(&cut) / area(&whole) - 1.0).abs() < 1e-12, "{} of {}", area(&cut), area(&whole));
            // Each edge inside belongs to two triangles, and each at the border to one.
            let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
            for t in cut.indices.chunks_exact(3) {
                for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]] {
                    *edges.entry((a.min(b), a.max(b))).or_default() += 1;
                    let [p, q] = [a, b].map(|index| Vec3::from(cut.positions[index as usize]));
                    assert!(p.distance(q) <= longest, "an edge of {} m is left", p.distance(q));
                    let is_border = (p.x == q.x && p.x.abs() == half) || (p.z == q.z && p.z.abs() == half);
                    edges.entry((a.min(b), a.max(b))).and_modify(|count| *count += u32::from(is_border) << 8);
                }
            }
            assert!(edges.values().all(|&count| count == 2 || count == 0x101), "a gap");
            assert!(cut.indices.len() < 3 * 40_000, "{} triangles", cut.indices.len() / 3);
            let ends = cut.positions.len();
            assert_eq!((cut.normals.len(), cut.uvs.len()), (ends, ends));
        }
    }

    #[test]
    fn ordinary_and_fine_meshes_stay_as_they_are() {
        assert!(cut(&ground(5000.0), 1.0).is_none());
        let mut fine = ground(500_000.0);
        fine.indices = fine.indices.repeat(MOST_LONG);
        assert!(cut(&fine, 1.0).is_none());
    }

    #[test]
    fn what_nodes_enlarge_is_cut() {
        let local = Trs { scale: DVec3::splat(1e6), ..Trs::IDENTITY };
        let scene = Scene {
            meshes: vec![Mesh { primitives: vec![ground(0.5)], ..Mesh::default() }],
            nodes: vec![Node { local, ..Node::default() }, Node { parent: Some(0), mesh: Some(0), ..Node::default() }],
            ..Scene::default()
        };
        assert!(meshes(&scene)[0][0].indices.len() > 1000);
    }
}
