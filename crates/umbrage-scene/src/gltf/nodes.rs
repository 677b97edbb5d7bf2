//! Nodes with their meshes, instances, skins, cameras and lights.

use glam::{DAffine3, DMat3, DQuat, DVec3, Mat4};
use gltf::json;

use super::accessors::{self, Integers};
use super::budget::Part;
use super::decompose::decompose;
use super::exact::{ExactNode, or_rounded};
use super::hierarchy::{self, Hierarchy, node_name};
use super::{Document, cameras, lights};
use crate::error::element;
use crate::{Node, Result, Scene, Skin, Trs};

/// Largest deviation of the last row of a matrix from 0 0 0 1. Ours: a hundred times the rounding
/// of products in single precision.
const AFFINE_TOLERANCE: f64 = 1e-4;

/// Nodes of the scene that the nodes of the file became.
pub(super) struct Places {
    /// Node of the scene for each node of the file: it has the transform, mesh and children.
    pub(super) of_file_node: Vec<usize>,
}

/// Adds nodes, skins, cameras and lights to a scene that has its meshes. Invalid cameras and lights
/// are left out.
pub(super) fn load(document: &Document<'_>, scene: &mut Scene) -> Result<Places> {
    let hierarchy = hierarchy::sort(document)?;
    let mut places = Places { of_file_node: vec![usize::MAX; document.root.nodes.len()] };
    for &index in &hierarchy.order {
        add_node(document, scene, &hierarchy, index, &mut places)?;
    }
    add_skins(document, scene, &places)?;
    let (mut cameras, mut lights) = (Vec::new(), Vec::new());
    for &index in hierarchy.order.iter().filter(|&&index| hierarchy.shown[index]) {
        let json = &document.root.nodes[index];
        let (user, node) = (node_name(document, index), places.of_file_node[index]);
        match cameras::load(document, json, &user, node) {
            Ok(camera) => cameras.extend(camera),
            Err(error) => document.leave_out(&format!("camera of {user}"), &error),
        }
        if hierarchy.visible[index] {
            match lights::load(document, json, &user, node) {
                Ok(light) => lights.extend(light),
                Err(error) => document.leave_out(&format!("light of {user}"), &error),
            }
        }
        check_skin(document, scene, node, &user)?;
    }
    // In the order of the file's own lists, so that an index means what it means in the file.
    cameras.sort_by_key(|(index, _)| *index);
    lights.sort_by_key(|(index, _)| *index);
    scene.cameras = cameras.into_iter().map(|(_, camera)| camera).collect();
    scene.lights = lights.into_iter().map(|(_, light)| light).collect();
    Ok(places)
}

fn add_node(
    document: &Document<'_>,
    scene: &mut Scene,
    hierarchy: &Hierarchy,
    index: usize,
    places: &mut Places,
) -> Result<()> {
    let json = &document.root.nodes[index];
    let user = node_name(document, index);
    let (local, inner) = transform(document, json, document.exact.node(index), &user)?;
    let parent = hierarchy.parent[index].map(|parent| places.of_file_node[parent]);
    let mut node = Node { name: json.name.clone().unwrap_or_default(), parent, local, ..Node::default() };
    if let Some(inner) = inner {
        let outer = Node { name: format!("{} (outer part of its matrix)", node.name), ..node.clone() };
        scene.nodes.push(outer);
        node = Node { parent: Some(scene.nodes.len() - 1), local: inner, ..node };
        document.notes.add(&user, "its matrix shears; it became two nodes");
    }

    if let Some(mesh) = json.mesh {
        document.get(&document.root.meshes, mesh.value(), "meshes", &user)?;
        node.mesh = (hierarchy.shown[index] && hierarchy.visible[index]).then_some(mesh.value());
    }
    if let Some(weights) = &json.weights {
        document.finite(&user, "weights", weights)?;
        node.weights.clone_from(weights);
    }
    if let Some(skin) = json.skin {
        document.get(&document.root.skins, skin.value(), "skins", &user)?;
        node.skin = Some(skin.value());
    }
    if let Some(extras) = &json.extras {
        let extras: serde_json::Value = serde_json::from_str(extras.get())
            .map_err(|error| document.invalid(user.as_str(), format!("extras: {error}")))?;
        node.cast_shadow = extras.get("castShadow").and_then(serde_json::Value::as_bool) != Some(false);
    }
    let extension = json.extensions.as_ref().and_then(|e| e.others.get("EXT_mesh_gpu_instancing"));
    if let (Some(extension), Some(_)) = (extension, node.mesh) {
        node.instances = instances(document, extension, &user)?;
        if node.instances.is_empty() {
            document.notes.add(&user, "has no instances of its mesh");
            node.mesh = None;
        } else if node.skin.is_some() {
            document.notes.add(&user, "is skinned and has instances; it is shown once");
            node.instances = Vec::new();
        }
    }
    scene.nodes.push(node);
    places.of_file_node[index] = scene.nodes.len() - 1;
    Ok(())
}

/// Returns the local transform of a node, in two parts if its matrix shears.
fn transform(document: &Document<'_>, json: &json::Node, exact: ExactNode, user: &str) -> Result<(Trs, Option<Trs>)> {
    if let Some(m) = json.matrix {
        document.finite(user, "matrix", &m)?;
        let m = affine(&or_rounded(exact.matrix, m)).ok_or_else(|| {
            document.invalid(user, "has a matrix whose last row is not 0 0 0 1; only affine transforms place a node")
        })?;
        let column = |i: usize| DVec3::new(m[i], m[i + 1], m[i + 2]);
        let matrix = DMat3::from_cols(column(0), column(4), column(8));
        return Ok(decompose(DAffine3 { matrix3: matrix, translation: column(12) }));
    }
    let (translation, scale) = (json.translation.unwrap_or_default(), json.scale.unwrap_or([1.0; 3]));
    document.finite(user, "translation", &translation)?;
    document.finite(user, "scale", &scale)?;
    let rotation = json.rotation.unwrap_or_default().0;
    document.finite(user, "rotation", &rotation)?;
    let local = Trs {
        translation: or_rounded(exact.translation, translation).into(),
        rotation: rotation_or_none(document, or_rounded(exact.rotation, rotation), user),
        scale: or_rounded(exact.scale, scale).into(),
    };
    Ok((local, None))
}

/// Returns a matrix whose last row is 0 0 0 1 but for rounding, after the homogeneous scale is
/// taken out.
fn affine(m: &[f64; 16]) -> Option<[f64; 16]> {
    let scaled = m.map(|x| x / m[15]);
    let is_affine = m[15] > 0.0 && [3, 7, 11].into_iter().all(|i| scaled[i].abs() <= AFFINE_TOLERANCE);
    (is_affine && scaled.iter().all(|x| x.is_finite())).then_some(scaled)
}

/// Returns a rotation. A quaternion without length gives no rotation and a note.
fn rotation_or_none(document: &Document<'_>, xyzw: [f64; 4], user: &str) -> DQuat {
    unit_quaternion(xyzw).unwrap_or_else(|| {
        document.notes.add(user, "has a rotation of length 0; it is not rotated");
        DQuat::IDENTITY
    })
}

fn unit_quaternion(xyzw: [f64; 4]) -> Option<DQuat> {
    let q = DQuat::from_array(xyzw);
    (q.length() > 0.0 && q.length().is_finite()).then(|| q.normalize())
}

/// Reads the instances of EXT_mesh_gpu_instancing.
fn instances(document: &Document<'_>, extension: &serde_json::Value, user: &str) -> Result<Vec<Trs>> {
    let user = format!("{user} EXT_mesh_gpu_instancing");
    let attributes = extension
        .get("attributes")
        .and_then(serde_json::Value::as_object)
        .ok_or_else(|| document.invalid(user.as_str(), "has no attributes"))?;
    let mut count = None;
    for (name, accessor) in attributes {
        let index = accessor_index(accessor)
            .ok_or_else(|| document.invalid(user.as_str(), format!("{name} has to be the index of an accessor")))?;
        let this = accessors::count(document, index, &user)?;
        if *count.get_or_insert(this) != this {
            return Err(document.invalid(user, format!("{name} has {this} elements, another attribute has not")));
        }
    }
    document.count(Part::Instance, count.unwrap_or_default(), &user)?;
    let index = |name: &str| attributes.get(name).and_then(accessor_index);
    let read = |name: &str| {
        let purpose = format!("{user} {name}");
        index(name).map(|index| accessors::floats::<3>(document, index, &purpose, Integers::AsMarked)).transpose()
    };
    let (translations, scales) = (read("TRANSLATION")?, read("SCALE")?);
    let rotations = index("ROTATION")
        .map(|index| accessors::floats::<4>(document, index, &format!("{user} ROTATION"), Integers::Normalized))
        .transpose()?;
    if translations.is_none() && scales.is_none() && rotations.is_none() {
        let reason = "has none of TRANSLATION, ROTATION and SCALE, so its instances coincide";
        return Err(document.invalid(user, reason));
    }
    let vector = |list: &Option<Vec<[f32; 3]>>, i: usize| {
        list.as_ref().and_then(|list| list.get(i)).map(|v| DVec3::from(v.map(f64::from)))
    };
    let instance = |i: usize| Trs {
        translation: vector(&translations, i).unwrap_or(DVec3::ZERO),
        rotation: match rotations.as_ref().and_then(|list| list.get(i)) {
            Some(&q) => rotation_or_none(document, q.map(f64::from), &user),
            None => DQuat::IDENTITY,
        },
        scale: vector(&scales, i).unwrap_or(DVec3::ONE),
    };
    Ok((0..count.unwrap_or_default() as usize).map(instance).collect())
}

fn accessor_index(value: &serde_json::Value) -> Option<usize> {
    value.as_u64().and_then(|index| usize::try_from(index).ok())
}

fn add_skins(document: &Document<'_>, scene: &mut Scene, places: &Places) -> Result<()> {
    for (index, json) in document.root.skins.iter().enumerate() {
        let user = element("skins", index, json.name.as_deref().unwrap_or_default());
        let joint = |joint: &json::Index<json::Node>| {
            document.get(&places.of_file_node, joint.value(), "nodes", &user).copied()
        };
        let joints = json.joints.iter().map(joint).collect::<Result<Vec<_>>>()?;
        let inverse_bind = match json.inverse_bind_matrices {
            Some(accessor) => {
                let purpose = format!("{user} inverseBindMatrices");
                let matrices = accessors::floats::<16>(document, accessor.value(), &purpose, Integers::AsMarked)?;
                matrices.iter().map(Mat4::from_cols_array).collect()
            }
            None => vec![Mat4::IDENTITY; joints.len()],
        };
        if inverse_bind.len() < joints.len() {
            let reason = format!("has {} joints, but {} inverse bind matrices", joints.len(), inverse_bind.len());
            return Err(document.invalid(user, reason));
        }
        let inverse_bind = inverse_bind[..joints.len()].to_vec();
        scene.skins.push(Skin { joints, inverse_bind });
    }
    Ok(())
}

/// Checks that a skinned node's mesh has joints and that the skin has as many.
fn check_skin(document: &Document<'_>, scene: &Scene, node: usize, user: &str) -> Result<()> {
    let (Some(mesh), Some(skin)) = (scene.nodes[node].mesh, scene.nodes[node].skin) else { return Ok(()) };
    let joints = scene.skins[skin].joints.len();
    for (index, primitive) in scene.meshes[mesh].primitives.iter().enumerate() {
        let part = format!("primitives[{index}] of meshes[{mesh}]");
        if primitive.joints.is_empty() {
            return Err(document.invalid(user, format!("has a skin, but {part} has no JOINTS_0")));
        }
        let highest = primitive.joints.iter().flatten().copied().max().unwrap_or_default();
        if usize::from(highest) >= joints {
            let reason = format!("{part} uses joint {highest}, but skins[{skin}] has {joints} joints");
            return Err(document.invalid(user, reason));
        }
    }
    Ok(())
}
