//! Shapes of triangles: lists of strips and fans, the vertices in use, and flat or repaired
//! normals.

use glam::DVec3;
use gltf::json::mesh::Mode;

use crate::Primitive;

/// Largest deviation of a normal's squared length from 1 that is left as it is. Ours: several times
/// the rounding to 16 bits, and invisible.
const UNIT_TOLERANCE: f32 = 1e-4;

/// Index that stands for no vertex.
const NONE: u32 = u32::MAX;

/// Converts the corners of a list, strip or fan to a list. Source: glTF 2.0 specification, section
/// 3.7.2.1.
pub(super) fn triangles(mode: Mode, corners: Vec<u32>) -> Vec<u32> {
    if mode == Mode::Triangles {
        return corners;
    }
    let count = corners.len().saturating_sub(2);
    let triangle = |i: usize| match mode {
        Mode::TriangleStrip if i.is_multiple_of(2) => [corners[i], corners[i + 1], corners[i + 2]],
        Mode::TriangleStrip => [corners[i], corners[i + 2], corners[i + 1]],
        _ => [corners[i + 1], corners[i + 2], corners[0]],
    };
    // Triangles with a corner twice are the stitches of strips.
    let is_stitch = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    (0..count).map(triangle).filter(|t| !is_stitch(t)).flatten().collect()
}

/// Returns the vertices that triangles use, in order, and renumbers the indices to count in them;
/// `None` if all are used. Unused vertices are left out so that bounds are those of the visible
/// surface, and so that buffers shared by many primitives are not stored many times.
pub(super) fn used_vertices(indices: &mut [u32], vertices: u32) -> Option<Vec<u32>> {
    // A few triangles of a large buffer: their number decides the time, not that of the vertices.
    if indices.len() < vertices as usize / 16 {
        let mut used = indices.to_vec();
        used.sort_unstable();
        used.dedup();
        for index in indices {
            *index = used.partition_point(|&vertex| vertex < *index) as u32;
        }
        return Some(used);
    }
    let mut new_index = vec![NONE; vertices as usize];
    indices.iter().for_each(|&index| new_index[index as usize] = 0);
    if !new_index.contains(&NONE) {
        return None;
    }
    let mut used = Vec::new();
    for (vertex, new) in (0..).zip(&mut new_index) {
        if *new != NONE {
            *new = used.len() as u32;
            used.push(vertex);
        }
    }
    for index in indices {
        *index = new_index[*index as usize];
    }
    Some(used)
}

/// Keeps only `vertices` (indices of the old ones), in that order.
fn select_vertices(primitive: &mut Primitive, vertices: &[u32]) {
    fn select<T: Copy>(list: &mut Vec<T>, vertices: &[u32]) {
        if !list.is_empty() {
            *list = vertices.iter().map(|&v| list[v as usize]).collect();
        }
    }
    select(&mut primitive.positions, vertices);
    select(&mut primitive.normals, vertices);
    select(&mut primitive.uvs, vertices);
    select(&mut primitive.colors, vertices);
    select(&mut primitive.joints, vertices);
    select(&mut primitive.weights, vertices);
    for target in &mut primitive.targets {
        select(&mut target.positions, vertices);
        select(&mut target.normals, vertices);
    }
}

/// Gives each triangle vertices of its own.
pub(super) fn unshared(primitive: &mut Primitive) {
    let corners = std::mem::take(&mut primitive.indices);
    select_vertices(primitive, &corners);
    primitive.indices = (0..corners.len() as u32).collect();
}

/// Returns the normal of a triangle; up if it has no area.
fn face_normal(primitive: &Primitive, triangle: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| DVec3::from(primitive.positions[triangle[i] as usize].map(f64::from)));
    (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y)
}

/// Computes flat normals, as glTF asks for where the file has none. Vertices are shared only by
/// triangles of the same plane.
pub(super) fn flat_normals(primitive: &mut Primitive) {
    let mut kept: Vec<u32> = Vec::new();
    let mut normals: Vec<[f32; 3]> = Vec::new();
    // Per old vertex the last new one made of it, per new one that before: short lists, as few
    // planes meet in a vertex.
    let mut last = vec![NONE; primitive.positions.len()];
    let mut before: Vec<u32> = Vec::new();
    let mut indices = Vec::with_capacity(primitive.indices.len());
    for triangle in primitive.indices.chunks_exact(3) {
        // Adding 0 makes −0 equal to it.
        let normal = face_normal(primitive, triangle).as_vec3().to_array().map(|c| c + 0.0);
        for &corner in triangle {
            let first = last[corner as usize];
            let mut at = first;
            while at != NONE && normals[at as usize] != normal {
                at = before[at as usize];
            }
            if at == NONE {
                at = kept.len() as u32;
                kept.push(corner);
                normals.push(normal);
                before.push(first);
                last[corner as usize] = at;
            }
            indices.push(at);
        }
    }
    select_vertices(primitive, &kept);
    (primitive.normals, primitive.indices) = (normals, indices);
}

/// Makes normals unit vectors. Normals without length become the mean of their triangles' normals.
/// Returns whether there were any.
pub(super) fn repair_normals(primitive: &mut Primitive) -> bool {
    let mut lost = false;
    for normal in &mut primitive.normals {
        let squared: f32 = normal.iter().map(|c| c * c).sum();
        if (squared - 1.0).abs() > UNIT_TOLERANCE {
            let unit = DVec3::from(normal.map(f64::from)).try_normalize();
            lost |= unit.is_none();
            *normal = unit.unwrap_or(DVec3::ZERO).as_vec3().to_array();
        }
    }
    if lost {
        let mut sums = vec![DVec3::ZERO; primitive.positions.len()];
        for triangle in primitive.indices.chunks_exact(3) {
            let normal = face_normal(primitive, triangle);
            triangle.iter().for_each(|&corner| sums[corner as usize] += normal);
        }
        for (normal, sum) in primitive.normals.iter_mut().zip(sums) {
            if *normal == [0.0; 3] {
                *normal = sum.try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
            }
        }
    }
    lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1, 2, 3, 4]), [0, 1, 2, 1, 3, 2, 2, 3, 4]);
        assert_eq!(triangles(Mode::TriangleFan, vec![9, 1, 2, 3]), [1, 2, 9, 2, 3, 9]);
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1, 2, 2, 3, 3, 4, 5]), [0, 1, 2, 3, 5, 4]);
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1]), [0_u32; 0]);
        assert_eq!(triangles(Mode::TriangleFan, vec![]), [0_u32; 0]);
    }

    #[test]
    fn flat_normals_split_edges_but_not_planes() {
        // A unit square of two triangles and a wall on its edge 0-1.
        let mut primitive = Primitive {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3, 0, 4, 1],
            ..Primitive::default()
        };
        flat_normals(&mut primitive);
        assert_eq!(primitive.positions.len(), 7);
        assert_eq!(primitive.normals[primitive.indices[0] as usize], [0.0, 1.0, 0.0]);
        assert_eq!(primitive.indices[0], primitive.indices[3]);
        assert_eq!(primitive.normals[primitive.indices[6] as usize], [0.0, 0.0, 1.0]);
    }

    #[test]
    fn unused_vertices_go() {
        for vertices in [6, 600] {
            let mut indices = [5, 1, 3];
            assert_eq!(used_vertices(&mut indices, vertices), Some(vec![1, 3, 5]));
            assert_eq!(indices, [2, 0, 1]);
        }
        assert_eq!(used_vertices(&mut [0, 1, 2], 3), None);
    }
}
