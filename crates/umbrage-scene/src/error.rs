//! Errors of scenes and of the files that they come from.

use std::fs::FileType;
use std::path::{Path, PathBuf};

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why a scene could not be read, posed, framed or written. Every message names the file and
/// the element at fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file is missing or cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// The path names something that is not a regular file and may never end or never begin.
    #[error("{}: is {kind}, not a regular file; give a file", path.display())]
    NotAFile {
        /// Path of the thing.
        path: PathBuf,
        /// Kind of the thing, as `a pipe`.
        kind: &'static str,
    },
    /// A file that another file needs is missing or cannot be read.
    #[error("{file}: {element}: its file {} cannot be read: {reason}", path.display())]
    External {
        /// Name of the file that refers to another.
        file: String,
        /// Buffer or image that names the other file.
        element: String,
        /// Path of the file that is needed.
        path: PathBuf,
        /// Message of the operating system.
        reason: String,
    },
    /// The scene is neither the name of a world nor a file of a known kind.
    #[error("{spec} is not a scene; give a {}, or one of the worlds {worlds}", crate::EXTENSIONS)]
    UnknownScene {
        /// Scene that was asked for.
        spec: String,
        /// Names of all worlds.
        worlds: String,
    },
    /// A world cannot have this number of objects.
    #[error("{option}: {reason}")]
    WorldOption {
        /// Name of the option of [`crate::procedural::WorldOptions`].
        option: &'static str,
        /// Fault and remedy.
        reason: String,
    },
    /// The file as a whole is malformed or cut short.
    #[error("{file}: {reason}")]
    Malformed {
        /// The file.
        file: String,
        /// Fault of the file.
        reason: String,
    },
    /// A part of a file contradicts the format or the rest of the file.
    #[error("{file}: {element}: {reason}")]
    Invalid {
        /// The file.
        file: String,
        /// The part at fault, as `accessors[3]` or `points[7]`.
        element: String,
        /// Fault of the part, and what it has to be.
        reason: String,
    },
    /// The file requires an extension that is not supported here.
    #[error(
        "{file}: extensionsRequired: the glTF extension {extension} is not supported and may change shapes; export the \
         file without it"
    )]
    UnsupportedExtension {
        /// The file.
        file: String,
        /// Name of the extension.
        extension: String,
    },
    /// A URI may not be followed: it is absolute, has a scheme, or leads out of the file's folder.
    #[error("{file}: {element}: the URI \"{uri}\" {reason}; external files have to lie in the folder of the glTF file")]
    UnsafeUri {
        /// The file.
        file: String,
        /// The buffer or image that has the URI.
        element: String,
        /// The URI.
        uri: String,
        /// Reason why the URI is not followed.
        reason: &'static str,
    },
    /// A picture cannot be decoded, or is unreasonably large.
    #[error("{file}: {element}: {reason}")]
    Image {
        /// The file.
        file: String,
        /// Element that holds the picture.
        element: String,
        /// Fault of the picture.
        reason: String,
    },
    /// A height map or its side file is unusable.
    #[error("{}: height map: {reason}", path.display())]
    HeightMap {
        /// Path of the picture or the side file.
        path: PathBuf,
        /// Fault and remedy.
        reason: String,
    },
    /// A [`crate::Scene`] contradicts itself: an index points nowhere, or lengths differ.
    #[error("scene {scene}: {element}: {reason}")]
    InvalidScene {
        /// The scene's name.
        scene: String,
        /// The part at fault, as `nodes[3] (wheel)`.
        element: String,
        /// Fault of the part.
        reason: String,
    },
    /// A node cannot be placed at the given time.
    #[error("scene {scene}: {element}: {reason}")]
    Pose {
        /// The scene's name.
        scene: String,
        /// The node or the time at fault.
        element: String,
        /// Fault of the node or the time.
        reason: String,
    },
    /// The scene or path has no camera, light or frame with this index.
    #[error("there is no {kind} {index}; there are {count}, counted from 0")]
    NoSuchElement {
        /// Kind of the element: `camera`, `light` or `frame`.
        kind: &'static str,
        /// Index that was asked for.
        index: usize,
        /// Number of elements.
        count: usize,
    },
    /// A light without a direction was asked for one.
    #[error("scene {scene}: {light}: {reason}")]
    Light {
        /// The scene's name.
        scene: String,
        /// Index and name of the light.
        light: String,
        /// Fault and remedy.
        reason: String,
    },
    /// A camera path is unusable.
    #[error("{file}: camera path: {element}: {reason}")]
    CameraPath {
        /// The file.
        file: String,
        /// The part at fault.
        element: String,
        /// Fault of the part.
        reason: String,
    },
    /// The node of a camera places it in a way that no view allows.
    #[error("scene {scene}: {camera}: {reason}")]
    Camera {
        /// The scene's name.
        scene: String,
        /// Index and name of the camera.
        camera: String,
        /// Fault and remedy.
        reason: String,
    },
    /// A view cannot be made of a camera.
    #[error(transparent)]
    View(#[from] umbrage::Error),
    /// A scene cannot be written as .glb.
    #[error("cannot write {element} as glTF: {reason}")]
    Export {
        /// The part at fault.
        element: String,
        /// Fault of the part.
        reason: String,
    },
}

/// Reads a whole regular file. The error names it.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    match irregular(&std::fs::metadata(path).map_err(failed)?.file_type()) {
        Some(kind) => Err(Error::NotAFile { path: path.to_owned(), kind }),
        None => std::fs::read(path).map_err(failed),
    }
}

/// Returns the kind of a thing that is not a regular file.
fn irregular(kind: &FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    match (kind.is_dir(), kind.is_file()) {
        (true, _) => Some("a folder"),
        (_, true) => None,
        _ => Some("something else"),
    }
}

/// Formats `kind[index]`, followed by the name if there is one.
pub(crate) fn element(kind: &str, index: usize, name: &str) -> String {
    if name.is_empty() { format!("{kind}[{index}]") } else { format!("{kind}[{index}] ({name})") }
}
