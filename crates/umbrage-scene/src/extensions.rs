//! Extensions of files that are scenes.

use std::fmt;

/// Extensions of the files that [`crate::open`] reads, in small letters and without the dot.
/// Displayed, they are a list for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extensions {
    /// Of glTF files.
    pub gltf: &'static [&'static str],
    /// Of height maps.
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
