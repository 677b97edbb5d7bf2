//! glTF 2.0 as users have it: .glb, or .gltf with its files beside it.
//!
//! The JSON is parsed by the `gltf` crate's types. Everything that follows an index, a length or a URI is done here and
//! checked here: that crate's own accessors and its validation panic on files that lie (an accessor beyond its
//! buffer, a `POSITION` that does not exist, a .glb header shorter than itself).

mod animations;
mod budget;
mod buffers;
mod container;
mod decompose;
mod exact;
mod hierarchy;
mod images;
mod materials;
mod meshes;
mod nodes;
mod uri;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use budget::Used;
use exact::Exact;
use gltf::json;

use crate::error::read_file;
use crate::{Error, Result, Scene};

/// Extensions without which a file can be shown as intended, or nearly so: those read here and those that only shade.
const SUPPORTED_EXTENSIONS: [&str; 19] = [
    "EXT_mesh_gpu_instancing",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// Loads a .glb or .gltf file with the files it refers to, which have to lie in its folder or below.
///
/// Points, lines and morph targets are left out and noted in [`Scene::notes`]. Primitives without normals get flat ones.
///
/// # Errors
/// [`Error::Read`], [`Error::Malformed`], [`Error::Invalid`], [`Error::UnsupportedExtension`], [`Error::UnsafeUri`] or
/// [`Error::Image`], each naming the file and the element at fault.
pub fn load_gltf(path: &Path) -> Result<Scene> {
    let bytes = read_file(path)?;
    let file = path.display().to_string();
    load(&file, &bytes, &|element, uri| uri::read_external(&file, path.parent(), element, uri))
}

/// Loads a .glb or a self-contained .gltf from memory; `name` stands for the file in messages.
///
/// # Errors
/// As [`load_gltf`]; [`Error::UnsafeUri`] for any external file.
pub fn load_gltf_slice(name: &str, bytes: &[u8]) -> Result<Scene> {
    load(name, bytes, &|element, uri| {
        Err(Error::UnsafeUri {
            file: name.to_owned(),
            element: element.to_owned(),
            uri: uri::shortened(uri),
            reason: "leads to another file, and this glTF is read from memory",
        })
    })
}

/// Reads the bytes of an external file for an element of the document.
type External<'a> = &'a dyn Fn(&str, &str) -> Result<Vec<u8>>;

fn load(file: &str, bytes: &[u8], external: External<'_>) -> Result<Scene> {
    let malformed = |reason: String| Error::Malformed { file: file.to_owned(), reason };
    let chunks = container::split(bytes).map_err(malformed)?;
    let root =
        parse(chunks.json).map_err(|error| malformed(format!("its JSON is not a glTF 2.0 document: {error}")))?;
    if root.asset.version.split('.').next() != Some("2") {
        return Err(malformed(format!("is glTF {}; only version 2 is read", root.asset.version)));
    }
    if let Some(extension) = root.extensions_required.iter().find(|e| !SUPPORTED_EXTENSIONS.contains(&e.as_str())) {
        return Err(Error::UnsupportedExtension { file: file.to_owned(), extension: extension.clone() });
    }
    let (used, notes) = (Used::default(), Notes::default());
    let exact = Exact::of(chunks.json);
    let mut document = Document { file, root, exact, buffers: Vec::new(), external, used, notes };
    document.buffers = buffers::load(&document, chunks.binary)?;

    let (materials, textures, texture_coordinates) = materials::load(&mut document)?;
    let mut scene = Scene { name: file.to_owned(), materials, textures, ..Scene::default() };
    scene.meshes = meshes::load(&mut document, &mut scene.materials, &texture_coordinates)?;
    let places = nodes::load(&mut document, &mut scene)?;
    scene.animations = animations::load(&mut document, &places)?;
    scene.notes = document.notes.into_lines();
    scene.validate()?;
    Ok(scene)
}

/// Parses the JSON. Two things that glTF allows are put in terms that the `gltf` crate's types know: scenes without
/// nodes, and channels without a target node, which are to be ignored.
fn parse(bytes: &[u8]) -> Result<json::Root, json::Error> {
    let mut value: serde_json::Value = json::deserialize::from_slice(bytes)?;
    for scene in list(&mut value, "scenes").into_iter().flatten() {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| serde_json::Value::Array(Vec::new()));
        }
    }
    for animation in list(&mut value, "animations").into_iter().flatten() {
        if let Some(channels) = list(animation, "channels") {
            channels.retain(|channel| channel.get("target").is_none_or(|target| target.get("node").is_some()));
        }
    }
    json::deserialize::from_value(value)
}

/// A list in a JSON object.
fn list<'v>(object: &'v mut serde_json::Value, name: &str) -> Option<&'v mut Vec<serde_json::Value>> {
    object.get_mut(name).and_then(serde_json::Value::as_array_mut)
}

/// The file being read: its JSON, its bytes, and what there is to say about it.
struct Document<'a> {
    file: &'a str,
    root: json::Root,
    exact: Exact,
    buffers: Vec<Cow<'a, [u8]>>,
    external: External<'a>,
    used: Used,
    notes: Notes,
}

impl Document<'_> {
    fn invalid(&self, element: impl Into<String>, reason: impl Into<String>) -> Error {
        Error::Invalid { file: self.file.to_owned(), element: element.into(), reason: reason.into() }
    }

    /// Follows an index of the file: `list` is called `kind`, and `user` points at it.
    fn get<'t, T>(&self, list: &'t [T], index: usize, kind: &str, user: &str) -> Result<&'t T> {
        list.get(index).ok_or_else(|| {
            self.invalid(user, format!("refers to {kind}[{index}], but the file has {} of them", list.len()))
        })
    }

    /// Checks that numbers are finite.
    fn finite(&self, element: &str, field: &str, values: &[f32]) -> Result<()> {
        match values.iter().find(|v| !v.is_finite()) {
            Some(bad) => Err(self.invalid(element, format!("{field} holds {bad}; it has to hold finite numbers"))),
            None => Ok(()),
        }
    }
}

/// Remarks for the report, each once with the number of times it was made.
#[derive(Default)]
struct Notes(BTreeMap<String, usize>);

impl Notes {
    fn add(&mut self, remark: impl Into<String>) {
        *self.0.entry(remark.into()).or_default() += 1;
    }

    fn into_lines(self) -> Vec<String> {
        self.0.into_iter().map(|(remark, n)| if n == 1 { remark } else { format!("{remark} ({n} times)") }).collect()
    }
}
