//! Extensions of scene files. An error lists them, so this file needs none.

use std::fmt;

/// Extensions of the files that [`crate::open`] reads, in lower case and without the dot. `Display`
/// writes them as a list for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extensions {
    /// Extensions of glTF files.
    pub gltf: &'static [&'static str],
    /// Extensions of height maps.
    pub height_map: &'static [&'static str],
}

/// All extensions that [`crate::open`] reads.
pub const EXTENSIONS: Extensions =
    Extensions { gltf: &["glb", "gltf", "vrm"], height_map: &["png", "webp", "tif", "tiff", "asc"] };

impl fmt::Display for Extensions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |extensions: &[&str]| extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(", ");
        write!(f, "{}, a height map ({})", list(self.gltf), list(self.height_map))
    }
}
