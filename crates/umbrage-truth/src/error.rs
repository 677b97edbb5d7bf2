//! What can be wrong with a scene, a sun, or a pair of images that are to be compared.

use std::path::PathBuf;

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why the judge refused its input. Every message names what was wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene or the pose contradicts itself, or holds numbers that no ray can meet.
    #[error("scene {scene}: {node}: object {object}, primitive {primitive}: {reason}")]
    InvalidGeometry {
        /// The scene's name.
        scene: String,
        /// The node that shows it, as `nodes[3] (wheel)`.
        node: String,
        /// Index into the pose's objects.
        object: usize,
        /// Index into the mesh's primitives.
        primitive: usize,
        /// What was wrong and what to do.
        reason: String,
    },
    /// More triangles than a 32-bit number counts.
    #[error("the scene has {triangles} triangles once its instances are spread out; the judge counts to {most}")]
    TooManyTriangles {
        /// How many there would be.
        triangles: u64,
        /// How many there may be.
        most: u64,
    },
    /// A setting is out of range.
    #[error("{field}: {reason}")]
    InvalidSetting {
        /// The parameter at fault.
        field: &'static str,
        /// What was wrong and what to do.
        reason: String,
    },
    /// Two things that are compared pixel by pixel have different sizes.
    #[error("{what} is {got:?}, but the truth it is compared with is {expected:?}; render both at one size")]
    SizeMismatch {
        /// What has the wrong size.
        what: &'static str,
        /// Its width and height (or its length and 1).
        got: [usize; 2],
        /// What the truth has.
        expected: [usize; 2],
    },
    /// An answer is not a visibility.
    #[error("{what} {index} is {value}; a visibility lies in [0,1]")]
    NotAVisibility {
        /// Which list.
        what: &'static str,
        /// Index into it.
        index: usize,
        /// What it holds.
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
        /// Why not.
        source: image::ImageError,
    },
    /// An image metric from another crate failed.
    #[error("image metric {metric}: {reason}")]
    Metric {
        /// Which.
        metric: &'static str,
        /// What it said.
        reason: String,
    },
}

impl Error {
    pub(crate) fn setting(field: &'static str, reason: impl Into<String>) -> Self {
        Self::InvalidSetting { field, reason: reason.into() }
    }
}
