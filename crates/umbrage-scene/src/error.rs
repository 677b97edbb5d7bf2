//! What can be wrong with a scene and the files it comes from.

use std::fs::FileType;
use std::path::{Path, PathBuf};

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a scene could not be read, posed, framed or written. Every message names the file and the
/// element at fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file is missing or cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Something that has a name like a file, but may never end or never begin.
    #[error("{}: is {kind}, not a regular file; give a file", path.display())]
    NotAFile {
        /// Its name.
        path: PathBuf,
        /// What it is, as `a pipe`.
        kind: &'static str,
    },
    /// A file that another file needs is missing or cannot be read.
    #[error("{file}: {element}: its file {} cannot be read: {reason}", path.display())]
    External {
        /// The file that needs it.
        file: String,
        /// The buffer or image that names it.
        element: String,
        /// The file that is needed.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// Neither the name of a world nor a file of a known kind.
    #[error("{spec} is not a scene; give a {}, or one of the worlds {worlds}", crate::EXTENSIONS)]
    UnknownScene {
        /// What was asked for.
        spec: String,
        /// The worlds there are.
        worlds: String,
    },
    /// A number of objects that a world cannot have.
    #[error("{option}: {reason}")]
    WorldOption {
        /// The option of [`crate::procedural::WorldOptions`].
        option: &'static str,
        /// What is wrong with it, and what to do.
        reason: String,
    },
    /// The file as a whole is not what it claims to be, or it is cut short.
    #[error("{file}: {reason}")]
    Malformed {
        /// The file.
        file: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A part of a file contradicts the format or the rest of the file.
    #[error("{file}: {element}: {reason}")]
    Invalid {
        /// The file.
        file: String,
        /// The part at fault, as `accessors[3]` or `points[7]`.
        element: String,
        /// What is wrong with it and what it has to be.
        reason: String,
    },
    /// The file says that it cannot be shown without an extension which is not supported here.
    #[error(
        "{file}: extensionsRequired: the glTF extension {extension} is not supported and may change shapes; export the \
         file without it"
    )]
    UnsupportedExtension {
        /// The file.
        file: String,
        /// The extension's name.
        extension: String,
    },
    /// A URI that may not be followed: absolute, with a scheme, or leading out of the file's
    /// folder.
    #[error("{file}: {element}: the URI \"{uri}\" {reason}; external files have to lie in the folder of the glTF file")]
    UnsafeUri {
        /// The file.
        file: String,
        /// The buffer or image that has the URI.
        element: String,
        /// The URI.
        uri: String,
        /// Why it is not followed.
        reason: &'static str,
    },
    /// A picture cannot be decoded, or is larger than is reasonable.
    #[error("{file}: {element}: {reason}")]
    Image {
        /// The file.
        file: String,
        /// Which picture.
        element: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A height map or its side file is not usable.
    #[error("{}: height map: {reason}", path.display())]
    HeightMap {
        /// The picture or the side file.
        path: PathBuf,
        /// What is wrong and what to give.
        reason: String,
    },
    /// A [`crate::Scene`] contradicts itself: an index points nowhere, or lengths differ.
    #[error("scene {scene}: {element}: {reason}")]
    InvalidScene {
        /// The scene's name.
        scene: String,
        /// The part at fault, as `nodes[3] (wheel)`.
        element: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A node cannot be placed at the given time.
    #[error("scene {scene}: {element}: {reason}")]
    Pose {
        /// The scene's name.
        scene: String,
        /// The node or the time at fault.
        element: String,
        /// What is wrong.
        reason: String,
    },
    /// A camera or light, or a frame of a path, that is not there.
    #[error("there is no {kind} {index}; there are {count}, counted from 0")]
    NoSuchElement {
        /// `camera`, `light` or `frame`.
        kind: &'static str,
        /// What was asked for.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A light that has no direction was asked for one.
    #[error("scene {scene}: {light}: {reason}")]
    Light {
        /// The scene's name.
        scene: String,
        /// Index and name of the light.
        light: String,
        /// What is wrong and what to do.
        reason: String,
    },
    /// A camera path is not usable.
    #[error("{file}: camera path: {element}: {reason}")]
    CameraPath {
        /// The file.
        file: String,
        /// The part at fault.
        element: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The node of a camera places it in a way that no view can have.
    #[error("scene {scene}: {camera}: {reason}")]
    Camera {
        /// The scene's name.
        scene: String,
        /// Index and name of the camera.
        camera: String,
        /// What is wrong and what to do.
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
        /// What is wrong with it.
        reason: String,
    },
}

/// Reads a whole regular file, naming it if that fails.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>> {
    let failed = |source| Error::Read { path: path.to_owned(), source };
    match irregular(&std::fs::metadata(path).map_err(failed)?.file_type()) {
        Some(kind) => Err(Error::NotAFile { path: path.to_owned(), kind }),
        None => std::fs::read(path).map_err(failed),
    }
}

/// What a thing is that is not a regular file.
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

/// `kind[index]`, with the name behind it if there is one.
pub(crate) fn element(kind: &str, index: usize, name: &str) -> String {
    if name.is_empty() { format!("{kind}[{index}]") } else { format!("{kind}[{index}] ({name})") }
}
