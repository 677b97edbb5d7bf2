//! Errors of the judge: unusable scenes, suns, or pairs of images.

use std::path::PathBuf;

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why the judge refused its input. Every message names what was wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene or the pose contradicts itself, or holds numbers that no ray can meet.
    #[error("scene {scene}: {node}: object {object}, primitive {primitive}: {reason}")]
    InvalidGeometry {
        /// The scene's name.
        scene: String,
        /// Name of the node that shows the object, as `nodes[3] (wheel)`.
        node: String,
        /// Index into the pose's objects.
        object: usize,
        /// Index into the mesh's primitives.
        primitive: usize,
        /// Fault and remedy.
        reason: String,
    },
    /// The scene has more triangles than a 32-bit number counts.
    #[error("the scene has {triangles} triangles once its instances are spread out; the judge counts to {most}")]
    TooManyTriangles {
        /// Number of triangles in the scene.
        triangles: u64,
        /// Largest number of triangles.
        most: u64,
    },
    /// A setting is out of range.
    #[error("{field}: {reason}")]
    InvalidSetting {
        /// The parameter at fault.
        field: &'static str,
        /// Fault and remedy.
        reason: String,
    },
    /// Two images or lists that are compared element by element have different sizes.
    #[error("{what} is {got:?}, but the truth it is compared with is {expected:?}; render both at one size")]
    SizeMismatch {
        /// Name of the input with the wrong size.
        what: &'static str,
        /// Width and height of the input (or its length and 1).
        got: [usize; 2],
        /// Width and height of the ground truth.
        expected: [usize; 2],
    },
    /// An answer is not a visibility.
    #[error("{what} {index} is {value}; a visibility lies in [0,1]")]
    NotAVisibility {
        /// Name of the list.
        what: &'static str,
        /// Index of the answer in the list.
        index: usize,
        /// Value of the answer.
        value: f32,
    },
    /// There is nothing to score.
    #[error("{0}; a score needs something to count")]
    NothingToScore(&'static str),
    /// An image cannot be read.
    #[error("cannot read the image {path}: {source}; give a PNG that exists", path = path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// Reason given by the image decoder.
        source: image::ImageError,
    },
    /// An image metric from another crate failed.
    #[error("image metric {metric}: {reason}")]
    Metric {
        /// Name of the metric.
        metric: &'static str,
        /// Message of the metric.
        reason: String,
    },
}

impl Error {
    pub(crate) fn setting(field: &'static str, reason: impl Into<String>) -> Self {
        Self::InvalidSetting { field, reason: reason.into() }
    }
}
