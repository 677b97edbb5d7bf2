//! Scenes by name: a world, or a file whose loader its extension or content chooses.

use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::procedural::{Watch, World, WorldOptions};
use crate::{Error, GltfOptions, HeightMapOptions, Result, Scene, load_gltf, load_height_map};

/// How files are read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpenOptions {
    /// What a height map means in metres.
    pub height_map: HeightMapOptions,
    /// How glTF files are read.
    pub gltf: GltfOptions,
    /// How many objects worlds have.
    pub world: WorldOptions,
}

/// Extensions of the files that [`open`] reads, in small letters and without the dot. Displayed,
/// they are a list for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extensions {
    /// Of glTF files.
    pub gltf: &'static [&'static str],
    /// Of height maps.
    pub height_map: &'static [&'static str],
}

/// All extensions that [`open`] reads.
pub const EXTENSIONS: Extensions =
    Extensions { gltf: &["glb", "gltf", "vrm"], height_map: &["png", "webp", "tif", "tiff", "asc"] };

impl fmt::Display for Extensions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |extensions: &[&str]| extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(", ");
        write!(f, "{}, a height map ({})", list(self.gltf), list(self.height_map))
    }
}

/// Opens a world by its name; a file that is a .glb whatever it is called; or a file by its
/// extension, one of [`EXTENSIONS`].
///
/// # Errors
/// [`Error::UnknownScene`] if it is none of these, [`Error::WorldOption`] for a number of objects
/// that the scene does not have; otherwise as [`load_gltf`] and
/// [`load_height_map`].
pub fn open(spec: &str, options: &OpenOptions) -> Result<Scene> {
    open_watched(spec, options, &|_| ())
}

/// [`open`] that says how far it is, where that takes long.
///
/// # Errors
/// As [`open`].
pub fn open_watched(spec: &str, options: &OpenOptions, watch: Watch<'_>) -> Result<Scene> {
    options.world.check(spec)?;
    if let Some(world) = World::from_name(spec) {
        return world.build_with(&options.world, watch);
    }
    let path = Path::new(spec);
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let is_of = |extensions: &[&str]| extensions.contains(&extension.as_str());
    if is_of(EXTENSIONS.gltf) || is_glb(path) {
        load_gltf(path, &options.gltf)
    } else if is_of(EXTENSIONS.height_map) {
        load_height_map(path, &options.height_map)
    } else {
        let worlds: Vec<&str> = World::ALL.iter().map(|world| world.name()).collect();
        Err(Error::UnknownScene { spec: spec.to_owned(), worlds: worlds.join(", ") })
    }
}

/// Whether a regular file begins as a .glb does; avatars (.vrm) are such files.
fn is_glb(path: &Path) -> bool {
    let mut start = [0; 4];
    path.is_file() && File::open(path).is_ok_and(|mut file| file.read_exact(&mut start).is_ok()) && start == *b"glTF"
}
