//! Loader of glTF 2.0: .glb, or .gltf with the files beside it.
//!
//! The JSON is parsed by the `gltf` crate's types. Every index, length and URI is followed and
//! checked here, because that crate's own accessors and its validation panic on inconsistent files
//! (an accessor beyond its buffer, a `POSITION` that does not exist, a .glb header shorter than
//! itself).
//!
//! Elements that no shape depends on never stop a file: an unreadable texture, animation, camera or
//! light is left out, with a note in [`Scene::notes`].

mod accessors;
mod animations;
mod basis;
mod budget;
mod buffers;
mod cameras;
mod container;
mod decompose;
mod draco;
mod exact;
mod extensions;
mod hierarchy;
mod images;
mod lights;
mod materials;
mod meshes;
mod meshopt;
mod nodes;
mod notes;
mod shape;
mod targets;
mod text;
mod textures;
mod uri;

use std::path::Path;

use budget::Used;
use buffers::Buffers;
use exact::Exact;
use gltf::json;
use notes::Notes;

use crate::error::read_file;
use crate::{Error, Result, Scene};

/// Default limit on the bytes of textures: 512 MiB.
const TEXTURE_BYTES: u64 = 512 << 20;

/// Options of reading glTF files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GltfOptions {
    /// Largest number of bytes of all textures of a scene together, at four bytes per pixel and
    /// without mip levels; 512 MiB by default. Pictures that need more are scaled down, with a
    /// note.
    pub texture_bytes: u64,
    /// True if relative URIs may lead out of the file's folder, as `../textures/bark.png` does;
    /// false by default.
    pub parent_folders: bool,
}

impl Default for GltfOptions {
    fn default() -> Self {
        Self { texture_bytes: TEXTURE_BYTES, parent_folders: false }
    }
}

/// Loads a .glb or .gltf file with the files that it refers to. These have to lie in its folder or
/// below unless [`GltfOptions::parent_folders`] is set.
///
/// Points and lines are left out, as are textures, animations, cameras and lights that cannot be
/// read; [`Scene::notes`] names them. Primitives without normals get flat ones.
///
/// # Errors
/// [`Error::Read`], [`Error::NotAFile`], [`Error::External`], [`Error::Malformed`],
/// [`Error::Invalid`], [`Error::UnsupportedExtension`], [`Error::UnsafeUri`], or [`Error::Image`]
/// for a texture that an alpha mask depends on, each naming the file and the element at fault.
pub fn load_gltf(path: &Path, options: &GltfOptions) -> Result<Scene> {
    let bytes = read_file(path)?;
    let file = path.display().to_string();
    let external = |element: &str, uri: &str| uri::read_external(&file, path.parent(), element, uri, options);
    load(&file, &bytes, options, &external)
}

/// Loads a .glb or a self-contained .gltf from memory. `name` stands for the file in messages.
///
/// # Errors
/// As [`load_gltf`]; [`Error::UnsafeUri`] for any external file that a shape depends on.
pub fn load_gltf_slice(name: &str, bytes: &[u8], options: &GltfOptions) -> Result<Scene> {
    load(name, bytes, options, &|element, uri| {
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

fn load(file: &str, bytes: &[u8], options: &GltfOptions, external: External<'_>) -> Result<Scene> {
    let malformed = |reason: String| Error::Malformed { file: file.to_owned(), reason };
    let chunks = container::split(bytes).map_err(malformed)?;
    let notes = Notes::default();
    let (root, broken) = text::parse(file, chunks.json, &notes)?;
    for extension in root.extensions_required.iter().filter(|name| !extensions::is_read(name)) {
        if !extensions::is_harmless(extension) {
            return Err(Error::UnsupportedExtension { file: file.to_owned(), extension: extension.clone() });
        }
        notes.add("extensionsRequired", format!("{extension} is not read; it changes no shape"));
    }
    let buffers = Buffers::new(&root, chunks.binary);
    let used = Used::new(bytes.len());
    let exact = Exact::of(chunks.json);
    let document = Document { file, root, exact, broken, options, buffers, external, used, notes };

    let (materials, textures, texture_coordinates) = materials::load(&document)?;
    let mut scene = Scene { name: file.to_owned(), materials, textures, ..Scene::default() };
    scene.meshes = meshes::load(&document, &mut scene.materials, &texture_coordinates)?;
    let places = nodes::load(&document, &mut scene)?;
    scene.animations = animations::load(&document, &places);
    scene.notes = document.notes.into_lines();
    scene.validate()?;
    Ok(scene)
}

/// The file being read: its JSON, its bytes, and the notes about it.
struct Document<'a> {
    file: &'a str,
    root: json::Root,
    exact: Exact,
    broken: text::Broken,
    options: &'a GltfOptions,
    buffers: Buffers<'a>,
    external: External<'a>,
    used: Used,
    notes: Notes,
}

impl Document<'_> {
    fn invalid(&self, element: impl Into<String>, reason: impl Into<String>) -> Error {
        Error::Invalid { file: self.file.to_owned(), element: element.into(), reason: reason.into() }
    }

    /// Looks up an index of the file: `list` is called `kind`, and `user` points at it.
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

    /// Leaves an element out, for the reason that an error gives.
    fn leave_out(&self, element: &str, error: &Error) {
        let reason = self.said(error);
        let reason =
            reason.strip_prefix(element).map_or(reason.as_str(), |rest| rest.trim_start_matches([':', '.', ' ']));
        self.notes.add(element, format!("left out: {reason}"));
    }

    /// Returns an error's message without the file's name, which all notes share.
    fn said(&self, error: &Error) -> String {
        let message = error.to_string();
        match message.strip_prefix(self.file).and_then(|rest| rest.strip_prefix(": ")) {
            Some(rest) => rest.to_owned(),
            None => message,
        }
    }
}
