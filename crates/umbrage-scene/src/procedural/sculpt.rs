//! Conversion of solids to meshes: one primitive per material, normals by crease angle.

use std::collections::BTreeMap;

use glam::DVec3;

use super::maths::sin_cos;
use super::shapes::Solid;
use crate::{Mesh, Primitive};

/// A model under construction: coloured solids, and leaves that are cards with a picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Sculpture {
    primitives: BTreeMap<usize, Primitive>,
}

impl Sculpture {
    /// Adds a solid of one material. Edges sharper than `crease` degrees stay sharp, others are
    /// shaded smooth.
    pub(super) fn add(&mut self, material: usize, crease: f64, solid: &Solid) -> &mut Self {
        let primitive = self.primitives.entry(material).or_insert_with(|| Primitive { material, ..Default::default() });
        let corner_normals = corner_normals(solid, crease);
        // A corner is a vertex of its own where its normal differs from that of its neighbours at
        // the same point.
        let mut vertices: Vec<Vec<([f32; 3], u32)>> = vec![Vec::new(); solid.points.len()];
        for (face, normals) in solid.faces.iter().zip(corner_normals) {
            for (&point, normal) in face.iter().zip(normals) {
                let normal = normal.as_vec3().to_array();
                let known = &mut vertices[point as usize];
                let vertex = match known.iter().find(|(n, _)| *n == normal) {
                    Some(&(_, vertex)) => vertex,
                    None => {
                        let vertex = primitive.positions.len() as u32;
                        primitive.positions.push(solid.points[point as usize].as_vec3().to_array());
                        primitive.normals.push(normal);
                        known.push((normal, vertex));
                        vertex
                    }
                };
                primitive.indices.push(vertex);
            }
        }
        self
    }

    /// Adds an open sheet through rows of points, seen from the side on which rows run to the right
    /// and follow one another upwards. The whole sheet has one normal: the ground's, or for foliage
    /// the direction out of the crown, which looks softer than each leaf's own.
    pub(super) fn sheet(&mut self, material: usize, rows: &[Vec<DVec3>], normal: DVec3) -> &mut Self {
        let primitive = self.primitives.entry(material).or_insert_with(|| Primitive { material, ..Default::default() });
        let (across, first) = (rows[0].len() as u32, primitive.positions.len() as u32);
        for point in rows.iter().flatten() {
            primitive.positions.push(point.as_vec3().to_array());
            primitive.normals.push(normal.as_vec3().to_array());
        }
        for row in 0..rows.len() as u32 - 1 {
            for column in 0..across - 1 {
                let a = first + row * across + column;
                let (b, d) = (a + 1, a + across);
                primitive.indices.extend([a, b, d + 1, a, d + 1, d]);
            }
        }
        self
    }

    /// Adds a sheet that shows the whole picture of its material: the first row is the picture's
    /// bottom.
    pub(super) fn card(&mut self, material: usize, rows: &[Vec<DVec3>], normal: DVec3) -> &mut Self {
        self.sheet(material, rows, normal);
        if let Some(primitive) = self.primitives.get_mut(&material) {
            let share = |i: usize, count: usize| i as f32 / (count - 1) as f32;
            for (y, row) in rows.iter().enumerate() {
                primitive.uvs.extend((0..row.len()).map(|x| [share(x, row.len()), 1.0 - share(y, rows.len())]));
            }
        }
        self
    }

    /// Returns the mesh.
    pub(super) fn finish(self, name: &str) -> Mesh {
        Mesh { name: name.to_owned(), primitives: self.primitives.into_values().collect(), weights: Vec::new() }
    }
}

/// Returns one unit normal per corner of each face: the mean of the faces at the point that are
/// within `crease` degrees of the corner's own, weighted by their angles at the point.
fn corner_normals(solid: &Solid, crease: f64) -> Vec<[DVec3; 3]> {
    let at = |i: u32| solid.points[i as usize];
    let face_normals: Vec<DVec3> =
        solid.faces.iter().map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)).normalize()).collect();
    let mut faces_at: Vec<Vec<(usize, f64)>> = vec![Vec::new(); solid.points.len()];
    for (index, face) in solid.faces.iter().enumerate() {
        for k in 0..3 {
            let [here, left, right] = [0, 1, 2].map(|offset| at(face[(k + offset) % 3]));
            let (to_left, to_right) = ((left - here).normalize(), (right - here).normalize());
            faces_at[face[k] as usize].push((index, libm::acos(to_left.dot(to_right).clamp(-1.0, 1.0))));
        }
    }
    let least_cosine = sin_cos(crease).1;
    let normal = |face: usize, point: u32| {
        let near = faces_at[point as usize]
            .iter()
            .filter(|(other, _)| *other == face || face_normals[*other].dot(face_normals[face]) >= least_cosine);
        let sum: DVec3 = near.map(|&(other, angle)| angle * face_normals[other]).sum();
        sum.try_normalize().unwrap_or(face_normals[face])
    };
    solid.faces.iter().enumerate().map(|(index, face)| face.map(|point| normal(index, point))).collect()
}
