//! Nodes with what hangs on them: meshes, instances, skins, cameras, lights.

use glam::{DAffine3, DMat3, DQuat, DVec3, Mat4};
use gltf::json;
use gltf::json::camera::Type as CameraType;
use gltf::json::extensions::scene::khr_lights_punctual::{Light as JsonLight, Type as LightType};
use gltf::json::validation::Checked;

use super::budget::Part;
use super::buffers::{self, Integers};
use super::decompose::decompose;
use super::exact::{ExactNode, or_rounded};
use super::hierarchy::{self, Hierarchy, node_name};
use super::{Document, Notes};
use crate::error::element;
use crate::{Lens, LightKind, Node, Result, Scene, SceneCamera, SceneLight, Skin, Trs};

/// Where the nodes of the file have gone.
pub(super) struct Places {
    /// Per node of the file, the node of the scene that has its transform, mesh and children.
    pub(super) of_file_node: Vec<usize>,
}

/// Adds nodes, skins, cameras and lights to a scene that has its meshes.
pub(super) fn load(document: &mut Document<'_>, scene: &mut Scene) -> Result<Places> {
    let hierarchy = hierarchy::sort(document)?;
    let mut notes = std::mem::take(&mut document.notes);
    let mut places = Places { of_file_node: vec![usize::MAX; document.root.nodes.len()] };
    for &index in &hierarchy.order {
        add_node(document, &mut notes, scene, &hierarchy, index, &mut places)?;
    }
    add_skins(document, scene, &places)?;
    let (mut cameras, mut lights) = (Vec::new(), Vec::new());
    for &index in &hierarchy.order {
        if hierarchy.shown[index] {
            let json = &document.root.nodes[index];
            let (user, node) = (node_name(document, index), places.of_file_node[index]);
            cameras.extend(camera(document, json, &user, node)?);
            lights.extend(light(document, json, &user, node)?);
            check_skin(document, scene, node, &user)?;
        }
    }
    // In the order of the file's own lists, so that an index means what it means in the file.
    cameras.sort_by_key(|(index, _)| *index);
    lights.sort_by_key(|(index, _)| *index);
    scene.cameras = cameras.into_iter().map(|(_, camera)| camera).collect();
    scene.lights = lights.into_iter().map(|(_, light)| light).collect();
    document.notes = notes;
    Ok(places)
}

fn add_node(
    document: &Document<'_>,
    notes: &mut Notes,
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
        notes.add("the matrix of a node shears; it became two nodes");
    }

    if let Some(mesh) = json.mesh {
        document.get(&document.root.meshes, mesh.value(), "meshes", &user)?;
        node.mesh = hierarchy.shown[index].then_some(mesh.value());
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
            notes.add("a node has no instances of its mesh");
            node.mesh = None;
        } else if node.skin.is_some() {
            notes.add("a skinned node has instances; it is shown once");
            node.instances = Vec::new();
        }
    }
    scene.nodes.push(node);
    places.of_file_node[index] = scene.nodes.len() - 1;
    Ok(())
}

/// The local transform of a node, in two parts if its matrix shears.
fn transform(document: &Document<'_>, json: &json::Node, exact: ExactNode, user: &str) -> Result<(Trs, Option<Trs>)> {
    if let Some(m) = json.matrix {
        document.finite(user, "matrix", &m)?;
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return Err(document.invalid(user, "has a matrix whose last row is not 0 0 0 1"));
        }
        let m = or_rounded(exact.matrix, m);
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
        rotation: unit_quaternion(or_rounded(exact.rotation, rotation))
            .ok_or_else(|| document.invalid(user, "has a rotation of length 0"))?,
        scale: or_rounded(exact.scale, scale).into(),
    };
    Ok((local, None))
}

fn unit_quaternion(xyzw: [f64; 4]) -> Option<DQuat> {
    let q = DQuat::from_array(xyzw);
    (q.length() > 0.0 && q.length().is_finite()).then(|| q.normalize())
}

/// EXT_mesh_gpu_instancing.
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
        let this = buffers::count(document, index, &user)?;
        if *count.get_or_insert(this) != this {
            return Err(document.invalid(user, format!("{name} has {this} elements, another attribute has not")));
        }
    }
    document.count(Part::Instance, count.unwrap_or_default(), &user)?;
    let index = |name: &str| attributes.get(name).and_then(accessor_index);
    let read = |name: &str| {
        let purpose = format!("{user} {name}");
        index(name).map(|index| buffers::floats::<3>(document, index, &purpose, Integers::AsMarked)).transpose()
    };
    let (translations, scales) = (read("TRANSLATION")?, read("SCALE")?);
    let rotations = index("ROTATION")
        .map(|index| buffers::floats::<4>(document, index, &format!("{user} ROTATION"), Integers::Normalized))
        .transpose()?;
    if translations.is_none() && scales.is_none() && rotations.is_none() {
        let reason = "has none of TRANSLATION, ROTATION and SCALE, so its instances coincide";
        return Err(document.invalid(user, reason));
    }
    let vector = |list: &Option<Vec<[f32; 3]>>, i: usize| {
        list.as_ref().and_then(|list| list.get(i)).map(|v| DVec3::from(v.map(f64::from)))
    };
    (0..count.unwrap_or_default() as usize)
        .map(|i| {
            let rotation = match rotations.as_ref().and_then(|list| list.get(i)) {
                Some(&q) => unit_quaternion(q.map(f64::from)).ok_or_else(|| {
                    document.invalid(user.as_str(), format!("instance {i} has a rotation of length 0"))
                })?,
                None => DQuat::IDENTITY,
            };
            let translation = vector(&translations, i).unwrap_or(DVec3::ZERO);
            Ok(Trs { translation, rotation, scale: vector(&scales, i).unwrap_or(DVec3::ONE) })
        })
        .collect()
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
                let matrices = buffers::floats::<16>(document, accessor.value(), &purpose, Integers::AsMarked)?;
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

/// The camera on a node, with its index in the file.
fn camera(document: &Document<'_>, json: &json::Node, user: &str, node: usize) -> Result<Option<(usize, SceneCamera)>> {
    let Some(index) = json.camera else { return Ok(None) };
    let camera = document.get(&document.root.cameras, index.value(), "cameras", user)?;
    let name = camera.name.clone().or_else(|| json.name.clone()).unwrap_or_default();
    let user = element("cameras", index.value(), &name);
    let need = |is_true: bool, field: &str, value: f32, expected: &str| {
        if is_true {
            Ok(())
        } else {
            Err(document.invalid(&user, format!("{field} is {value}; it has to be {expected}")))
        }
    };
    let lens = match (&camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(CameraType::Perspective), Some(p), _) => {
            need(p.yfov > 0.0 && p.yfov < std::f32::consts::PI, "yfov", p.yfov, "between 0 and π")?;
            need(p.znear > 0.0 && p.znear.is_finite(), "znear", p.znear, "a finite number above 0")?;
            if let Some(zfar) = p.zfar {
                need(zfar > p.znear && zfar.is_finite(), "zfar", zfar, "above znear")?;
            }
            if let Some(aspect) = p.aspect_ratio {
                need(aspect > 0.0 && aspect.is_finite(), "aspectRatio", aspect, "a finite number above 0")?;
            }
            Lens::Perspective {
                yfov: p.yfov.into(),
                aspect: p.aspect_ratio.map(f64::from),
                znear: p.znear.into(),
                zfar: p.zfar.map(f64::from),
            }
        }
        (Checked::Valid(CameraType::Orthographic), _, Some(o)) => {
            // A negative magnification mirrors the picture; the specification advises against it and nobody needs it.
            need(o.xmag.abs() > 0.0 && o.xmag.is_finite(), "xmag", o.xmag, "a finite number other than 0")?;
            need(o.ymag.abs() > 0.0 && o.ymag.is_finite(), "ymag", o.ymag, "a finite number other than 0")?;
            need(o.znear >= 0.0 && o.znear.is_finite(), "znear", o.znear, "a finite number of 0 or more")?;
            need(o.zfar > o.znear && o.zfar.is_finite(), "zfar", o.zfar, "above znear")?;
            Lens::Orthographic {
                xmag: o.xmag.abs().into(),
                ymag: o.ymag.abs().into(),
                znear: o.znear.into(),
                zfar: o.zfar.into(),
            }
        }
        _ => return Err(document.invalid(user, "has no parameters for its type of projection")),
    };
    Ok(Some((index.value(), SceneCamera { name, node, lens })))
}

/// The light on a node, with its index in the file.
fn light(document: &Document<'_>, json: &json::Node, user: &str, node: usize) -> Result<Option<(usize, SceneLight)>> {
    let extension = json.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    let Some(extension) = extension else { return Ok(None) };
    let lights: &[JsonLight] = document.root.as_ref();
    let index = extension.light.value();
    let light = document.get(lights, index, "lights", user)?;
    let name = light.name.clone().or_else(|| json.name.clone()).unwrap_or_default();
    let user = element("lights", index, &name);
    document.finite(&user, "color", &light.color)?;
    document.finite(&user, "intensity", &[light.intensity])?;
    let kind = match light.type_ {
        Checked::Valid(LightType::Directional) => LightKind::Directional,
        Checked::Valid(LightType::Point) => LightKind::Point,
        Checked::Valid(LightType::Spot) => {
            let spot = light.spot.clone().unwrap_or(json::extensions::scene::khr_lights_punctual::Spot {
                inner_cone_angle: 0.0,
                outer_cone_angle: std::f32::consts::FRAC_PI_4,
            });
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            // A little more than a right angle is what rounding makes of π/2.
            if !(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= std::f32::consts::FRAC_PI_2 * 1.000_001) {
                let reason = format!("has cone angles {inner} and {outer}; 0 ≤ inner ≤ outer ≤ π/2 has to hold");
                return Err(document.invalid(user, reason));
            }
            LightKind::Spot { inner: inner.into(), outer: outer.into() }
        }
        Checked::Invalid => return Err(document.invalid(user, "has an unknown type")),
    };
    if let Some(range) = light.range.filter(|range| range.is_nan() || *range <= 0.0) {
        return Err(document.invalid(user, format!("range is {range}; it has to be above 0")));
    }
    let range = light.range.filter(|range| range.is_finite()).map(f64::from);
    let light = SceneLight { name, node, kind, color: light.color, intensity: light.intensity, range };
    Ok(Some((index, light)))
}
