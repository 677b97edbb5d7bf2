//! Meshes: every primitive becomes an indexed triangle list with normals.

use std::collections::HashMap;

use glam::DVec3;
use gltf::json::mesh::{Mode, Primitive as JsonPrimitive, Semantic};
use gltf::json::validation::Checked;

use super::budget::Part;
use super::buffers::{self, Integers};
use super::materials::TextureCoordinates;
use super::{Document, Notes};
use crate::error::element;
use crate::{Material, Mesh, Primitive, Result};

/// How far the squared length of a normal or the sum of weights may be from 1 before it is put right. Ours: several
/// times what rounding to 16 bits does to them, and nothing that can be seen.
const UNIT_TOLERANCE: f32 = 1e-4;

/// Loads all meshes. Adds a default material if a primitive has none.
pub(super) fn load(
    document: &mut Document<'_>,
    materials: &mut Vec<Material>,
    coordinates: &[Option<TextureCoordinates>],
) -> Result<Vec<Mesh>> {
    let mut default_material = None;
    let mut meshes = Vec::with_capacity(document.root.meshes.len());
    let mut notes = std::mem::take(&mut document.notes);
    for (index, json) in document.root.meshes.iter().enumerate() {
        let name = json.name.clone().unwrap_or_default();
        let user = element("meshes", index, &name);
        let mut primitives = Vec::with_capacity(json.primitives.len());
        for (index, json) in json.primitives.iter().enumerate() {
            let user = format!("{user}.primitives[{index}]");
            let material = match json.material {
                Some(index) => {
                    document.get(&document.root.materials, index.value(), "materials", &user)?;
                    index.value()
                }
                None => *default_material.get_or_insert_with(|| {
                    materials.push(Material::default());
                    materials.len() - 1
                }),
            };
            let coordinates = coordinates.get(material).copied().flatten();
            if let Some(mut primitive) = load_primitive(document, &mut notes, json, &user, coordinates)? {
                primitive.material = material;
                primitives.push(primitive);
            }
        }
        meshes.push(Mesh { name, primitives });
    }
    document.notes = notes;
    Ok(meshes)
}

/// One primitive; `None` if there is nothing of it to draw.
fn load_primitive(
    document: &Document<'_>,
    notes: &mut Notes,
    json: &JsonPrimitive,
    user: &str,
    coordinates: Option<TextureCoordinates>,
) -> Result<Option<Primitive>> {
    let mode = match json.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(_) => {
            notes.add("a primitive of points or lines is left out");
            return Ok(None);
        }
        Checked::Invalid => return Err(document.invalid(user, "has an unknown mode")),
    };
    if json.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
        notes.add("morph targets are left out; the primitive has its base shape");
    }
    let attribute = |semantic: Semantic| json.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
    let Some(positions) = attribute(Semantic::Positions) else {
        notes.add("a primitive without positions is left out");
        return Ok(None);
    };
    let positions = buffers::floats::<3>(document, positions, &format!("{user} POSITION"), Integers::AsMarked)?;
    let vertices = positions.len();
    let same_count = |name: &str, count: usize| {
        if count == vertices {
            return Ok(());
        }
        Err(document.invalid(user, format!("has {vertices} positions, but {count} of {name}")))
    };

    let corners = match json.indices {
        Some(index) => {
            let corners = buffers::indices(document, index.value(), &format!("{user} indices"))?;
            if let Some(at) = corners.iter().position(|&corner| corner as usize >= vertices) {
                let reason = format!("has index {} at {at}, but {vertices} vertices", corners[at]);
                return Err(document.invalid(user, reason));
            }
            corners
        }
        None => {
            let count = u32::try_from(vertices)
                .map_err(|_| document.invalid(user, format!("has {vertices} vertices, more than indices can name")))?;
            (0..count).collect()
        }
    };
    let indices = triangles(mode, corners).map_err(|reason| document.invalid(user, reason))?;
    if indices.is_empty() {
        return Ok(None);
    }

    let mut primitive = Primitive { positions, indices, ..Primitive::default() };
    if let Some(index) = attribute(Semantic::Normals) {
        primitive.normals = buffers::floats::<3>(document, index, &format!("{user} NORMAL"), Integers::AsMarked)?;
        same_count("NORMAL", primitive.normals.len())?;
    }
    if let Some(coordinates) = coordinates {
        let set = coordinates.set;
        match attribute(Semantic::TexCoords(set)) {
            Some(index) => {
                let uvs = buffers::floats::<2>(document, index, &format!("{user} TEXCOORD_{set}"), Integers::AsMarked)?;
                same_count(&format!("TEXCOORD_{set}"), uvs.len())?;
                primitive.uvs = uvs.into_iter().map(|uv| coordinates.apply(uv)).collect();
            }
            None => {
                notes.add("a textured primitive has no texture coordinates; it takes the texel at (0, 0)");
                primitive.uvs = vec![coordinates.apply([0.0; 2]); vertices];
            }
        }
    }
    if let Some(index) = attribute(Semantic::Colors(0)) {
        primitive.colors = colors(document, index, &format!("{user} COLOR_0"))?;
        same_count("COLOR_0", primitive.colors.len())?;
    }
    load_influences(document, notes, json, user, &mut primitive)?;
    same_count("JOINTS_0", if primitive.joints.is_empty() { vertices } else { primitive.joints.len() })?;

    drop_unused_vertices(&mut primitive);
    document.count(Part::Corner, primitive.indices.len() as u64, user)?;
    if primitive.normals.is_empty() {
        give_flat_normals(&mut primitive);
    } else if repair_normals(&mut primitive) {
        notes.add("a primitive has normals of no length; they are taken from its triangles");
    }
    document.count(Part::Vertex, primitive.positions.len() as u64, user)?;
    Ok(Some(primitive))
}

/// Vertex colours; alpha is 1 where there are three components.
fn colors(document: &Document<'_>, index: usize, user: &str) -> Result<Vec<[f32; 4]>> {
    if buffers::components(document, index, user)? == 4 {
        return buffers::floats::<4>(document, index, user, Integers::Normalized);
    }
    let rgb = buffers::floats::<3>(document, index, user, Integers::Normalized)?;
    Ok(rgb.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
}

/// Joints and weights: the four strongest of however many sets there are, with sum 1.
fn load_influences(
    document: &Document<'_>,
    notes: &mut Notes,
    json: &JsonPrimitive,
    user: &str,
    primitive: &mut Primitive,
) -> Result<()> {
    let vertices = primitive.positions.len();
    let mut all: Vec<Vec<(u16, f32)>> = Vec::new();
    for set in 0.. {
        let attribute = |semantic: Semantic| json.attributes.get(&Checked::Valid(semantic)).map(|index| index.value());
        let (joints, weights) = match (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set))) {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => return Err(document.invalid(user, format!("has only one of JOINTS_{set} and WEIGHTS_{set}"))),
        };
        let joints = buffers::joints(document, joints, &format!("{user} JOINTS_{set}"))?;
        let weights = buffers::floats::<4>(document, weights, &format!("{user} WEIGHTS_{set}"), Integers::Normalized)?;
        if joints.len() != vertices || weights.len() != vertices {
            let (j, w) = (joints.len(), weights.len());
            let reason = format!("has {vertices} positions, but {j} of JOINTS_{set} and {w} of WEIGHTS_{set}");
            return Err(document.invalid(user, reason));
        }
        if let Some(at) = weights.iter().position(|w| w.iter().any(|&w| w < 0.0)) {
            return Err(document.invalid(user, format!("has a negative weight at vertex {at}")));
        }
        if set == 0 {
            (primitive.joints, primitive.weights) = (joints, weights);
            continue;
        }
        if all.is_empty() {
            all = primitive.joints.iter().zip(&primitive.weights).map(|(j, w)| pairs(*j, *w).collect()).collect();
            notes.add("vertices with more than four joints keep the four with the most weight");
        }
        for (list, (j, w)) in all.iter_mut().zip(joints.iter().zip(&weights)) {
            list.extend(pairs(*j, *w));
        }
    }
    for (vertex, mut list) in all.into_iter().enumerate() {
        list.sort_by(|a, b| b.1.total_cmp(&a.1));
        primitive.joints[vertex] = std::array::from_fn(|i| list[i].0);
        primitive.weights[vertex] = std::array::from_fn(|i| list[i].1);
    }
    for (joints, weights) in primitive.joints.iter_mut().zip(&mut primitive.weights) {
        let sum: f32 = weights.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            notes.add("a vertex without weights follows its first joint");
            *weights = [1.0, 0.0, 0.0, 0.0];
        } else if (sum - 1.0).abs() > UNIT_TOLERANCE {
            *weights = weights.map(|w| w / sum);
        }
        // A joint without weight may be anything in the file; here it is one that is there.
        for (joint, weight) in joints.iter_mut().zip(weights) {
            if *weight == 0.0 {
                *joint = 0;
            }
        }
    }
    Ok(())
}

fn pairs(joints: [u16; 4], weights: [f32; 4]) -> impl Iterator<Item = (u16, f32)> {
    joints.into_iter().zip(weights)
}

/// Corners of a list, strip or fan as a list. Source: glTF 2.0 specification, section 3.7.2.1.
fn triangles(mode: Mode, corners: Vec<u32>) -> Result<Vec<u32>, String> {
    if mode == Mode::Triangles {
        return if corners.len().is_multiple_of(3) {
            Ok(corners)
        } else {
            Err(format!("has {} corners, which is no whole number of triangles", corners.len()))
        };
    }
    let count = corners.len().saturating_sub(2);
    let triangle = |i: usize| match mode {
        Mode::TriangleStrip if i.is_multiple_of(2) => [corners[i], corners[i + 1], corners[i + 2]],
        Mode::TriangleStrip => [corners[i], corners[i + 2], corners[i + 1]],
        _ => [corners[i + 1], corners[i + 2], corners[0]],
    };
    // Triangles with a corner twice are the stitches of strips.
    let is_stitch = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    Ok((0..count).map(triangle).filter(|t| !is_stitch(t)).flatten().collect())
}

/// Leaves out vertices that no triangle uses, so that bounds are those of what is seen and buffers shared by many
/// primitives are not stored many times.
fn drop_unused_vertices(primitive: &mut Primitive) {
    const UNUSED: u32 = u32::MAX;
    let mut new_index = vec![UNUSED; primitive.positions.len()];
    for &index in &primitive.indices {
        new_index[index as usize] = 0;
    }
    if !new_index.contains(&UNUSED) {
        return;
    }
    let mut kept = Vec::new();
    for (old, new) in new_index.iter_mut().enumerate() {
        if *new != UNUSED {
            *new = kept.len() as u32;
            kept.push(old);
        }
    }
    select_vertices(primitive, &kept);
    for index in &mut primitive.indices {
        *index = new_index[*index as usize];
    }
}

/// Makes `vertices` (of the old ones) the new ones, in that order.
fn select_vertices(primitive: &mut Primitive, vertices: &[usize]) {
    fn select<T: Copy>(list: &mut Vec<T>, vertices: &[usize]) {
        if !list.is_empty() {
            *list = vertices.iter().map(|&v| list[v]).collect();
        }
    }
    select(&mut primitive.positions, vertices);
    select(&mut primitive.normals, vertices);
    select(&mut primitive.uvs, vertices);
    select(&mut primitive.colors, vertices);
    select(&mut primitive.joints, vertices);
    select(&mut primitive.weights, vertices);
}

/// The normal of a triangle; up if it has no area.
fn face_normal(primitive: &Primitive, triangle: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| DVec3::from(primitive.positions[triangle[i] as usize].map(f64::from)));
    (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y)
}

/// Flat normals, as glTF wants where the file has none. Vertices are shared only by triangles of the same plane.
fn give_flat_normals(primitive: &mut Primitive) {
    let mut kept: Vec<usize> = Vec::new();
    let mut normals: Vec<[f32; 3]> = Vec::new();
    // By the bits of the normal, with −0 made 0 by adding it.
    let mut known: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let mut indices = Vec::with_capacity(primitive.indices.len());
    for triangle in primitive.indices.chunks_exact(3) {
        let normal = face_normal(primitive, triangle).as_vec3().to_array();
        for &corner in triangle {
            let index = *known.entry((corner, normal.map(|c| (c + 0.0).to_bits()))).or_insert_with(|| {
                kept.push(corner as usize);
                normals.push(normal);
                kept.len() as u32 - 1
            });
            indices.push(index);
        }
    }
    select_vertices(primitive, &kept);
    (primitive.normals, primitive.indices) = (normals, indices);
}

/// Makes normals unit vectors. Those without length take the mean of their triangles; returns whether there were any.
fn repair_normals(primitive: &mut Primitive) -> bool {
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
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1, 2, 3, 4]), Ok(vec![0, 1, 2, 1, 3, 2, 2, 3, 4]));
        assert_eq!(triangles(Mode::TriangleFan, vec![9, 1, 2, 3]), Ok(vec![1, 2, 9, 2, 3, 9]));
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1, 2, 2, 3, 3, 4, 5]), Ok(vec![0, 1, 2, 3, 5, 4]));
        assert_eq!(triangles(Mode::TriangleStrip, vec![0, 1]), Ok(vec![]));
        assert_eq!(triangles(Mode::TriangleFan, vec![]), Ok(vec![]));
        assert!(triangles(Mode::Triangles, vec![0, 1, 2, 3]).is_err());
    }

    #[test]
    fn flat_normals_split_edges_but_not_planes() {
        // A unit square of two triangles and a wall on its edge 0-1.
        let mut primitive = Primitive {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]],
            indices: vec![0, 1, 2, 0, 2, 3, 0, 4, 1],
            ..Primitive::default()
        };
        give_flat_normals(&mut primitive);
        assert_eq!(primitive.positions.len(), 7);
        assert_eq!(primitive.normals[primitive.indices[0] as usize], [0.0, 1.0, 0.0]);
        assert_eq!(primitive.indices[0], primitive.indices[3]);
        assert_eq!(primitive.normals[primitive.indices[6] as usize], [0.0, 0.0, 1.0]);
    }

    #[test]
    fn unused_vertices_go() {
        let mut primitive = Primitive {
            positions: (0..6).map(|i| [i as f32, 0.0, 0.0]).collect(),
            uvs: (0..6).map(|i| [i as f32, 0.0]).collect(),
            indices: vec![5, 1, 3],
            ..Primitive::default()
        };
        drop_unused_vertices(&mut primitive);
        assert_eq!(primitive.positions, [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
        assert_eq!(primitive.uvs, [[1.0, 0.0], [3.0, 0.0], [5.0, 0.0]]);
        assert_eq!(primitive.indices, [2, 0, 1]);
    }
}
