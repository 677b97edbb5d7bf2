//! Morph targets: shapes that weights blend into a base shape. Source: glTF 2.0 specification,
//! section 3.7.2.2.

use glam::DVec3;

use crate::{Mesh, Primitive, SkinnedMesh};

/// Returns the vertices of a mesh under weights of its morph targets, in the mesh's own space.
/// Weights beyond the targets are ignored; targets beyond the weights have weight 0.
pub(crate) fn morphed(mesh: &Mesh, weights: &[f64]) -> SkinnedMesh {
    let (positions, normals) = mesh.primitives.iter().map(|primitive| morphed_primitive(primitive, weights)).unzip();
    SkinnedMesh { origin: DVec3::ZERO, positions, normals }
}

fn morphed_primitive(primitive: &Primitive, weights: &[f64]) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let applied = || primitive.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
    let moving = applied().map(|(target, weight)| (target.positions.as_slice(), *weight));
    let positions = blended(&primitive.positions, moving.filter(|(list, _)| !list.is_empty()).collect());
    if primitive.flat && applied().next().is_some() {
        let normals = flat_normals(&positions, primitive);
        return (positions, normals);
    }
    let turning = applied().map(|(target, weight)| (target.normals.as_slice(), *weight));
    let turning: Vec<_> = turning.filter(|(list, _)| !list.is_empty()).collect();
    if turning.is_empty() {
        return (positions, primitive.normals.clone());
    }
    let mut normals = blended(&primitive.normals, turning);
    for (normal, base) in normals.iter_mut().zip(&primitive.normals) {
        let unit = DVec3::from(normal.map(f64::from)).try_normalize();
        *normal = unit.map_or(*base, |unit| unit.as_vec3().to_array());
    }
    (positions, normals)
}

/// Computes `base` + Σ weight · difference, summed in `f64`.
fn blended(base: &[[f32; 3]], differences: Vec<(&[[f32; 3]], f64)>) -> Vec<[f32; 3]> {
    if differences.is_empty() {
        return base.to_vec();
    }
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let vertex = |(i, v): (usize, &[f32; 3])| {
        let moved = differences.iter().fold(vector(*v), |sum, (list, weight)| sum + vector(list[i]) * *weight);
        moved.as_vec3().to_array()
    };
    base.iter().enumerate().map(vertex).collect()
}

/// Returns the normals of triangles that share no vertices. A triangle without area keeps its own.
fn flat_normals(positions: &[[f32; 3]], primitive: &Primitive) -> Vec<[f32; 3]> {
    let mut normals = primitive.normals.clone();
    for triangle in primitive.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| DVec3::from(positions[triangle[i] as usize].map(f64::from)));
        if let Some(normal) = (b - a).cross(c - a).try_normalize() {
            triangle.iter().for_each(|&corner| normals[corner as usize] = normal.as_vec3().to_array());
        }
    }
    normals
}
