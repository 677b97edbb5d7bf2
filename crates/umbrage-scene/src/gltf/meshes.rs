//! Meshes: every primitive becomes an indexed triangle list with normals.

use gltf::json::mesh::{Mode, Primitive as JsonPrimitive, Semantic};
use gltf::json::validation::Checked;

use super::accessors::{self, Integers, Packed, Wanted};
use super::budget::Part;
use super::materials::TextureCoordinates;
use super::shape::{flat_normals, repair_normals, triangles, unshared, used_vertices};
use super::{Document, draco, targets};
use crate::error::element;
use crate::{Material, Mesh, Primitive, Result};

/// Largest deviation of the sum of weights from 1 that is left as it is. Ours: several times the
/// rounding to 16 bits.
const WEIGHT_TOLERANCE: f32 = 1e-4;

/// Loads all meshes. Adds a default material if a primitive has none.
pub(super) fn load(
    document: &Document<'_>,
    materials: &mut Vec<Material>,
    coordinates: &[Option<TextureCoordinates>],
) -> Result<Vec<Mesh>> {
    let mut default_material = None;
    let mut meshes = Vec::with_capacity(document.root.meshes.len());
    for (index, json) in document.root.meshes.iter().enumerate() {
        let name = json.name.clone().unwrap_or_default();
        let user = element("meshes", index, &name);
        let weights = json.weights.clone().unwrap_or_default();
        document.finite(&user, "weights", &weights)?;
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
            if let Some(mut primitive) = load_primitive(document, json, &user, coordinates)? {
                primitive.material = material;
                primitives.push(primitive);
            }
        }
        meshes.push(Mesh { name, primitives, weights });
    }
    Ok(meshes)
}

/// Source of a primitive's attributes.
struct Attributes<'p, 'd> {
    document: &'p Document<'d>,
    json: &'p JsonPrimitive,
    user: &'p str,
    draco: Option<&'p draco::Decoded>,
    /// Number of vertices in the file.
    vertices: usize,
    wanted: Wanted<'p>,
}

impl Attributes<'_, '_> {
    fn accessor(&self, semantic: Semantic) -> Option<usize> {
        self.json.attributes.get(&Checked::Valid(semantic)).map(|index| index.value())
    }

    /// Returns the name of an attribute for messages.
    fn purpose(&self, semantic: &Semantic) -> String {
        format!("{} {}", self.user, semantic.to_string())
    }

    /// Returns the chosen elements of an attribute, which must have one for each vertex.
    fn packed(&self, semantic: Semantic, components: usize) -> Result<Option<Packed>> {
        let Some(accessor) = self.accessor(semantic.clone()) else { return Ok(None) };
        let purpose = self.purpose(&semantic);
        if let Some(decoded) = self.draco
            && let Some(packed) =
                decoded.packed(self.document, &semantic, accessor, components, &purpose, self.wanted)?
        {
            return Ok(Some(packed));
        }
        let count = accessors::count(self.document, accessor, &purpose)?;
        if count != self.vertices as u64 {
            let reason = format!("has {} positions, but {count} of {}", self.vertices, semantic.to_string());
            return Err(self.document.invalid(self.user, reason));
        }
        let ty = [accessors::type_of::<2>(), accessors::type_of::<3>(), accessors::type_of::<4>()][components - 2];
        accessors::packed(self.document, accessor, &purpose, &[ty], self.wanted).map(Some)
    }

    fn floats<const N: usize>(&self, semantic: Semantic, meaning: Integers) -> Result<Option<Vec<[f32; N]>>> {
        let purpose = self.purpose(&semantic);
        self.packed(semantic, N)?.map(|packed| packed.floats(self.document, &purpose, meaning)).transpose()
    }

    /// Reads vertex colours. Alpha is 1 where there are three components.
    fn colors(&self) -> Result<Option<Vec<[f32; 4]>>> {
        let semantic = Semantic::Colors(0);
        let Some(accessor) = self.accessor(semantic.clone()) else { return Ok(None) };
        let three_or_four = [accessors::type_of::<3>(), accessors::type_of::<4>()];
        let (ty, _) = accessors::types(self.document, accessor, &self.purpose(&semantic), &three_or_four)?;
        if ty.multiplicity() == 4 {
            return self.floats::<4>(semantic, Integers::Normalized);
        }
        let rgb = self.floats::<3>(semantic, Integers::Normalized)?;
        Ok(rgb.map(|list| list.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect()))
    }
}

/// Loads one primitive; `None` if it has nothing to draw.
fn load_primitive(
    document: &Document<'_>,
    json: &JsonPrimitive,
    user: &str,
    coordinates: Option<TextureCoordinates>,
) -> Result<Option<Primitive>> {
    let mode = match json.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
        Checked::Valid(_) => {
            document.notes.add(user, "points or lines are left out");
            return Ok(None);
        }
        Checked::Invalid => return Err(document.invalid(user, "has an unknown mode")),
    };
    let semantic = Checked::Valid(Semantic::Positions);
    let Some(positions) = json.attributes.get(&semantic).map(|index| index.value()) else {
        document.notes.add(user, "a primitive without positions is left out");
        return Ok(None);
    };
    let draco = draco::decode(document, json, user)?;
    let mode = if draco.is_some() { Mode::Triangles } else { mode };
    let count = match &draco {
        Some(decoded) => decoded.vertices(),
        None => accessors::count(document, positions, user)?,
    };
    let vertices = u32::try_from(count)
        .map_err(|_| document.invalid(format!("accessors[{positions}]"), "has more elements than indices can name"))?;

    let stored = match (&draco, json.indices) {
        (Some(decoded), _) => Some(decoded.indices()),
        (None, Some(index)) => Some(accessors::indices(document, index.value(), &format!("{user} indices"))?),
        (None, None) => None,
    };
    let corners = match stored {
        Some(corners) => {
            if let Some(at) = corners.iter().position(|&corner| corner >= vertices) {
                let reason = format!("has index {} at {at}, but {vertices} vertices", corners[at]);
                return Err(document.invalid(user, reason));
            }
            Some(corners)
        }
        None => None,
    };
    let corner_count = corners.as_ref().map_or(count, |corners| corners.len() as u64);
    document.count(Part::Geometry, size_of::<u32>() as u64 * corner_count, user)?;
    let corners = corners.unwrap_or_else(|| (0..vertices).collect());
    let mut indices = triangles(mode, corners);
    if let rest @ 1.. = indices.len() % 3 {
        document.notes.add(user, "has corners beyond its last whole triangle; they are left out");
        indices.truncate(indices.len() - rest);
    }
    if indices.is_empty() {
        return Ok(None);
    }
    let used = used_vertices(&mut indices, vertices);
    let wanted = used.as_deref().map_or(Wanted::All, Wanted::Only);
    let draco = draco.as_ref();
    let from = Attributes { document, json, user, draco, vertices: vertices as usize, wanted };
    let kept = used.as_ref().map_or(from.vertices, Vec::len);
    let attribute_bytes = |primitive: &Primitive| {
        let (uvs, colors) = (8 * primitive.uvs.len(), 16 * primitive.colors.len());
        (24 * primitive.positions.len() + uvs + colors + 24 * primitive.joints.len()) as u64
    };

    let mut primitive = Primitive { indices, ..Primitive::default() };
    primitive.positions = from.floats::<3>(Semantic::Positions, Integers::AsMarked)?.unwrap_or_default();
    primitive.normals = from.floats::<3>(Semantic::Normals, Integers::AsMarked)?.unwrap_or_default();
    if let Some(coordinates) = coordinates {
        let uvs = from.floats::<2>(Semantic::TexCoords(coordinates.set), Integers::AsMarked)?;
        primitive.uvs = match uvs {
            Some(uvs) => uvs.into_iter().map(|uv| coordinates.apply(uv)).collect(),
            None => {
                document.notes.add(user, "textured without texture coordinates; it takes the texel at (0, 0)");
                vec![coordinates.apply([0.0; 2]); kept]
            }
        };
    }
    primitive.colors = from.colors()?.unwrap_or_default();
    load_influences(&from, &mut primitive)?;
    if let Some(list) = &json.targets {
        primitive.targets = targets::load(document, list, user, from.vertices, from.wanted)?;
    }

    primitive.flat = primitive.normals.is_empty();
    if primitive.flat && !primitive.targets.is_empty() {
        // What lies in one plane now may be bent apart.
        let grown = (primitive.indices.len() / primitive.positions.len().max(1)) as u64;
        let target_bytes: usize = primitive.targets.iter().map(|t| 12 * (t.positions.len() + t.normals.len())).sum();
        document.count(Part::Geometry, target_bytes as u64 * grown, user)?;
        unshared(&mut primitive);
    }
    if primitive.flat {
        flat_normals(&mut primitive);
    } else if repair_normals(&mut primitive) {
        document.notes.add(user, "has normals of no length; they are taken from its triangles");
    }
    document.count(Part::Geometry, attribute_bytes(&primitive), user)?;
    Ok(Some(primitive))
}

/// Loads joints and weights: the four strongest of any number of sets, scaled to the sum 1.
fn load_influences(from: &Attributes<'_, '_>, primitive: &mut Primitive) -> Result<()> {
    let (document, user) = (from.document, from.user);
    let mut all: Vec<Vec<(u16, f32)>> = Vec::new();
    for set in 0.. {
        let joints = from.packed(Semantic::Joints(set), 4)?.map(|packed| packed.joints(document)).transpose()?;
        let (joints, weights) = match (joints, from.floats::<4>(Semantic::Weights(set), Integers::Normalized)?) {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => return Err(document.invalid(user, format!("has only one of JOINTS_{set} and WEIGHTS_{set}"))),
        };
        if let Some(at) = weights.iter().position(|w| w.iter().any(|&w| w < 0.0)) {
            return Err(document.invalid(user, format!("has a negative weight at vertex {at}")));
        }
        if set == 0 {
            (primitive.joints, primitive.weights) = (joints, weights);
            continue;
        }
        if all.is_empty() {
            all = primitive.joints.iter().zip(&primitive.weights).map(|(j, w)| pairs(*j, *w).collect()).collect();
            document.notes.add(user, "vertices with more than four joints keep the four with the most weight");
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
            document.notes.add(user, "a vertex without weights follows its first joint");
            *weights = [1.0, 0.0, 0.0, 0.0];
        } else if (sum - 1.0).abs() > WEIGHT_TOLERANCE {
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
