//! Scenes as .glb files. Source: glTF 2.0 specification.

mod binary;
mod parts;

use serde_json::{Map, Value, json};

use crate::{Error, Node, Result, Scene, Trs};
use binary::Binary;

/// Writes a scene as .glb: meshes once however often they are placed, cameras, lights
/// (KHR_lights_punctual), materials with PNG textures, instances (EXT_mesh_gpu_instancing), skins,
/// animations and `extras.castShadow`.
///
/// Transforms become `f32`, as glTF has no other numbers: a node far from its parent moves by up to
/// 2⁻²⁴ of the distance. Primitives without triangles are left out.
///
/// # Errors
/// [`Error::InvalidScene`] as [`Scene::validate`]; [`Error::Export`] if a number does not fit into
/// `f32`, or the file would be larger than the 4 GiB that a .glb can have.
pub fn export_glb(scene: &Scene) -> Result<Vec<u8>> {
    scene.validate()?;
    let mut binary = Binary::default();
    let mut extensions_used = Vec::new();
    let mut document = Map::new();
    document.insert("asset".into(), json!({ "version": "2.0", "generator": "umbrage" }));

    let (meshes, mesh_of) = parts::meshes(scene, &mut binary)?;
    let textures = parts::textures(scene, &mut binary)?;
    let nodes = nodes(scene, &mesh_of, &mut binary, &mut extensions_used)?;
    let roots: Vec<usize> = (0..scene.nodes.len()).filter(|&i| scene.nodes[i].parent.is_none()).collect();
    document.insert("scene".into(), json!(0));
    document.insert("scenes".into(), json!([if roots.is_empty() { json!({}) } else { json!({ "nodes": roots }) }]));

    let lights = parts::lights(scene)?;
    if !lights.is_empty() {
        extensions_used.push("KHR_lights_punctual");
        document.insert("extensions".into(), json!({ "KHR_lights_punctual": { "lights": lights } }));
    }
    let lists = [
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", parts::materials(scene, &mut extensions_used)?),
        ("textures", textures.textures),
        ("samplers", textures.samplers),
        ("images", textures.images),
        ("cameras", parts::cameras(scene)?),
        ("skins", parts::skins(scene, &mut binary)?),
        ("animations", parts::animations(scene, &mut binary)?),
    ];
    // glTF has no empty lists.
    for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        document.insert(name.into(), Value::Array(list));
    }
    if !extensions_used.is_empty() {
        document.insert("extensionsUsed".into(), json!(extensions_used));
    }
    binary.finish(document)
}

fn nodes(
    scene: &Scene,
    mesh_of: &[Option<usize>],
    binary: &mut Binary,
    extensions_used: &mut Vec<&'static str>,
) -> Result<Vec<Value>> {
    let mut nodes = Vec::with_capacity(scene.nodes.len());
    let mut children = vec![Vec::new(); scene.nodes.len()];
    for (index, node) in scene.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            children[parent].push(index);
        }
        let mut json = self::node(scene, index, node)?;
        if let Some(mesh) = node.mesh.and_then(|mesh| mesh_of[mesh]) {
            json.insert("mesh".into(), json!(mesh));
            if let Some(skin) = node.skin {
                json.insert("skin".into(), json!(skin));
            }
            if !node.weights.is_empty() {
                json.insert("weights".into(), numbers(&node.weights));
            }
            if !node.instances.is_empty() {
                let extension = instances(scene, index, &node.instances, binary)?;
                extension_of(&mut json, "EXT_mesh_gpu_instancing", extension);
                if !extensions_used.contains(&"EXT_mesh_gpu_instancing") {
                    extensions_used.push("EXT_mesh_gpu_instancing");
                }
            }
        }
        nodes.push(json);
    }

    // A glTF node has one camera and one light at most; more of them get children of their own.
    for (camera, place) in scene.cameras.iter().enumerate() {
        let index = place_for(&mut nodes, &mut children, place.node, |node| !node.contains_key("camera"));
        nodes[index].insert("camera".into(), json!(camera));
    }
    let has_light = |node: &Map<String, Value>| {
        node.get("extensions").is_some_and(|extensions| extensions.get("KHR_lights_punctual").is_some())
    };
    for (light, place) in scene.lights.iter().enumerate() {
        let index = place_for(&mut nodes, &mut children, place.node, |node| !has_light(node));
        extension_of(&mut nodes[index], "KHR_lights_punctual", json!({ "light": light }));
    }
    for (node, children) in nodes.iter_mut().zip(children).filter(|(_, children)| !children.is_empty()) {
        node.insert("children".into(), json!(children));
    }
    Ok(nodes.into_iter().map(Value::Object).collect())
}

/// Returns the node itself if it `is_free`, else a new child of it.
fn place_for(
    nodes: &mut Vec<Map<String, Value>>,
    children: &mut Vec<Vec<usize>>,
    node: usize,
    is_free: impl Fn(&Map<String, Value>) -> bool,
) -> usize {
    if is_free(&nodes[node]) {
        return node;
    }
    nodes.push(Map::new());
    children.push(Vec::new());
    children[node].push(nodes.len() - 1);
    nodes.len() - 1
}

fn extension_of(node: &mut Map<String, Value>, name: &str, extension: Value) {
    let extensions = node.entry("extensions").or_insert_with(|| json!({}));
    if let Some(extensions) = extensions.as_object_mut() {
        extensions.insert(name.into(), extension);
    }
}

/// Writes a node's name, transform and shadow flag.
fn node(scene: &Scene, index: usize, node: &Node) -> Result<Map<String, Value>> {
    let at = || scene.node_element(index);
    let mut json = named(&node.name);
    let (translation, rotation, scale) = single(&node.local, at)?;
    if translation != [0.0; 3] {
        json.insert("translation".into(), numbers(&translation));
    }
    if rotation != [0.0, 0.0, 0.0, 1.0] {
        json.insert("rotation".into(), numbers(&rotation));
    }
    if scale != [1.0; 3] {
        json.insert("scale".into(), numbers(&scale));
    }
    if !node.cast_shadow {
        json.insert("extras".into(), json!({ "castShadow": false }));
    }
    Ok(json)
}

fn instances(scene: &Scene, index: usize, instances: &[Trs], binary: &mut Binary) -> Result<Value> {
    let (mut translations, mut rotations, mut scales) = (Vec::new(), Vec::new(), Vec::new());
    for (i, instance) in instances.iter().enumerate() {
        let (translation, rotation, scale) =
            single(instance, || format!("instance {i} of {}", scene.node_element(index)))?;
        translations.push(translation);
        rotations.push(rotation);
        scales.push(scale);
    }
    Ok(json!({ "attributes": {
        "TRANSLATION": binary.vectors(&translations),
        "ROTATION": binary.vectors(&rotations),
        "SCALE": binary.vectors(&scales),
    } }))
}

/// Converts a transform to single precision.
fn single(trs: &Trs, at: impl Fn() -> String) -> Result<([f32; 3], [f32; 4], [f32; 3])> {
    let (translation, scale) = (trs.translation.as_vec3(), trs.scale.as_vec3());
    let rotation = trs.rotation.normalize().as_quat();
    if !(translation.is_finite() && rotation.is_finite() && scale.is_finite()) {
        let reason = format!("its transform does not fit into single precision: {trs:?}");
        return Err(Error::Export { element: at(), reason });
    }
    Ok((translation.to_array(), rotation.to_array(), scale.to_array()))
}

/// Makes a JSON object with a name, unless the name is empty.
fn named(name: &str) -> Map<String, Value> {
    let mut json = Map::new();
    if !name.is_empty() {
        json.insert("name".into(), json!(name));
    }
    json
}

/// Writes single-precision numbers, exact to the last bit.
fn numbers(values: &[f32]) -> Value {
    values.iter().map(|&value| json!(f64::from(value))).collect()
}

/// Writes a number in single precision, as glTF readers will take it.
fn number(value: f64, at: &str, field: &str) -> Result<Value> {
    if (value as f32).is_finite() {
        return Ok(json!(f64::from(value as f32)));
    }
    Err(Error::Export { element: at.to_owned(), reason: format!("{field} is {value}, which glTF cannot hold") })
}
