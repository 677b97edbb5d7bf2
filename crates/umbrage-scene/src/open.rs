//! Opening scenes by name: a world, or a file whose loader its extension or content chooses.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::procedural::{Watch, World, WorldOptions};
use crate::{
    EXTENSIONS, Error, GltfOptions, HeightMapOptions, Result, Scene, load_gltf, load_gltf_slice, load_height_map,
    load_height_map_slice,
};

/// Options of reading files and building worlds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpenOptions {
    /// Scale and encoding of height maps.
    pub height_map: HeightMapOptions,
    /// Options of glTF files.
    pub gltf: GltfOptions,
    /// Numbers of objects of worlds.
    pub world: WorldOptions,
}

/// Opens a world by its name, a .glb file under any name, or a file by its extension, one of
/// [`EXTENSIONS`].
///
/// # Errors
/// [`Error::UnknownScene`] if it is none of these, [`Error::WorldOption`] for a number of objects
/// that the scene cannot have; otherwise as [`load_gltf`] and [`load_height_map`].
pub fn open(spec: &str, options: &OpenOptions) -> Result<Scene> {
    open_watched(spec, options, &|_| ())
}

/// Opens a scene as [`open`] does, and reports progress where that takes long.
///
/// # Errors
/// As [`open`].
pub fn open_watched(spec: &str, options: &OpenOptions, watch: Watch<'_>) -> Result<Scene> {
    options.world.check(spec)?;
    if let Some(world) = World::from_name(spec) {
        return world.build_with(&options.world, watch);
    }
    let path = Path::new(spec);
    match kind(spec, || is_glb(path))? {
        Kind::Gltf => load_gltf(path, &options.gltf),
        Kind::HeightMap => load_height_map(path, &options.height_map),
    }
}

/// Opens a file whose content is in memory, such as one dropped on a page: a .glb under any name,
/// or a file by its extension, one of [`EXTENSIONS`]. `name` stands for the file.
///
/// # Errors
/// As [`open`], [`load_gltf_slice`] and [`load_height_map_slice`].
pub fn open_slice(name: &str, bytes: &[u8], options: &OpenOptions) -> Result<Scene> {
    match kind(name, || bytes.starts_with(GLB))? {
        Kind::Gltf => load_gltf_slice(name, bytes, &options.gltf),
        Kind::HeightMap => load_height_map_slice(name, bytes, &options.height_map),
    }
}

/// Kind of a file.
enum Kind {
    Gltf,
    HeightMap,
}

fn kind(spec: &str, is_glb: impl Fn() -> bool) -> Result<Kind> {
    let extension = Path::new(spec).extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let is_of = |extensions: &[&str]| extensions.contains(&extension.as_str());
    if is_of(EXTENSIONS.gltf) || is_glb() {
        Ok(Kind::Gltf)
    } else if is_of(EXTENSIONS.height_map) {
        Ok(Kind::HeightMap)
    } else {
        let worlds: Vec<&str> = World::ALL.iter().map(|world| world.name()).collect();
        Err(Error::UnknownScene { spec: spec.to_owned(), worlds: worlds.join(", ") })
    }
}

/// First bytes of a .glb.
const GLB: &[u8; 4] = b"glTF";

/// Returns whether a regular file begins as a .glb does. Avatars (.vrm) are such files.
fn is_glb(path: &Path) -> bool {
    let mut start = [0; 4];
    path.is_file() && File::open(path).is_ok_and(|mut file| file.read_exact(&mut start).is_ok()) && start == *GLB
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export_glb;

    #[test]
    fn content_in_memory_is_opened_as_a_file_of_that_name() {
        let options = OpenOptions::default();
        let world = open("chessboard", &options).expect("a world");
        let glb = export_glb(&world).expect("a file");
        for name in ["board.glb", "board", "board.png.download"] {
            let scene = open_slice(name, &glb, &options).expect(name);
            assert_eq!(scene.meshes.len(), world.meshes.len(), "{name}");
        }
        let map = b"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n4 5 6\n7 8 9\n";
        assert_eq!(open_slice("hills.asc", map, &options).expect("a map").name, "hills.asc");
        for (name, bytes, why) in [
            ("board.txt", &glb[4..], "board.txt"),
            ("board.glb", &glb[..40], "board.glb"),
            ("hills.asc", b"ncols", "hills.asc"),
        ] {
            let error = open_slice(name, bytes, &options).expect_err(name).to_string();
            assert!(error.contains(why), "{error}");
        }
    }
}
