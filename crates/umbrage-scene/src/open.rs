//! Whatever a user calls a scene.

use std::path::Path;

use crate::procedural::World;
use crate::{Error, HeightMapOptions, Result, Scene, load_gltf, load_height_map};

/// Opens a world by its name, or a file by its extension: .glb, .gltf, or .png for a height map.
///
/// # Errors
/// [`Error::UnknownScene`] if it is none of these; otherwise as [`load_gltf`] and [`load_height_map`].
pub fn open(spec: &str, height_map: &HeightMapOptions) -> Result<Scene> {
    if let Some(world) = World::from_name(spec) {
        return Ok(world.build());
    }
    let path = Path::new(spec);
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "glb" | "gltf" => load_gltf(path),
        "png" => load_height_map(path, height_map),
        _ => {
            let worlds: Vec<&str> = World::ALL.iter().map(|world| world.name()).collect();
            Err(Error::UnknownScene { spec: spec.to_owned(), worlds: worlds.join(", ") })
        }
    }
}
