//! Whatever a user calls a scene.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::procedural::World;
use crate::{Error, GltfOptions, HeightMapOptions, Result, Scene, load_gltf, load_height_map};

/// How files are read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpenOptions {
    /// What a height map means in metres.
    pub height_map: HeightMapOptions,
    /// Of .glb, .gltf and whatever else is one.
    pub gltf: GltfOptions,
}

/// Opens a world by its name; a file that is a .glb whatever it is called; or a file by its
/// extension: .gltf, or .png, .webp, .tif or .asc for a height map.
///
/// # Errors
/// [`Error::UnknownScene`] if it is none of these; otherwise as [`load_gltf`] and
/// [`load_height_map`].
pub fn open(spec: &str, options: &OpenOptions) -> Result<Scene> {
    if let Some(world) = World::from_name(spec) {
        return Ok(world.build());
    }
    let path = Path::new(spec);
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "glb" | "gltf" => load_gltf(path, &options.gltf),
        _ if is_glb(path) => load_gltf(path, &options.gltf),
        "png" | "webp" | "tif" | "tiff" | "asc" => load_height_map(path, &options.height_map),
        _ => {
            let worlds: Vec<&str> = World::ALL.iter().map(|world| world.name()).collect();
            Err(Error::UnknownScene { spec: spec.to_owned(), worlds: worlds.join(", ") })
        }
    }
}

/// Whether a regular file begins as a .glb does; avatars (.vrm) are such files.
fn is_glb(path: &Path) -> bool {
    let mut start = [0; 4];
    path.is_file() && File::open(path).is_ok_and(|mut file| file.read_exact(&mut start).is_ok()) && start == *b"glTF"
}
