//! How much a file may make of what it has: many parts can refer to the same few bytes, or to none.

use std::cell::Cell;

use super::Document;
use crate::Result;

/// What is counted. The limits are ours: far above what can be shown at all, and low enough that no file of a few
/// kilobytes takes all memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Elements of accessors decoded; costs time only.
    Element,
    /// Elements that have no bytes in the file (all zeros but for a sparse part).
    ZeroElement,
    /// Vertices kept.
    Vertex,
    /// Corners of triangles kept.
    Corner,
    /// Instances of EXT_mesh_gpu_instancing.
    Instance,
    /// Values of animation keys.
    Key,
}

impl Part {
    const COUNT: usize = 6;

    /// The most of it that one file may have.
    const fn most(self) -> u64 {
        match self {
            Self::Element => 1 << 31,
            Self::ZeroElement => 1 << 24,
            Self::Vertex | Self::Key => 1 << 26,
            Self::Corner => 1 << 28,
            Self::Instance => 1 << 22,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Element => "elements of accessors",
            Self::ZeroElement => "elements without any bytes",
            Self::Vertex => "vertices",
            Self::Corner => "corners of triangles",
            Self::Instance => "instances",
            Self::Key => "animated values",
        }
    }
}

/// What has been used of each limit.
#[derive(Default)]
pub(super) struct Used([Cell<u64>; Part::COUNT]);

impl Document<'_> {
    /// Counts `amount` more of a part on behalf of `user`; an error beyond the limit.
    pub(super) fn count(&self, part: Part, amount: u64, user: &str) -> Result<()> {
        let used = &self.used.0[part as usize];
        used.set(used.get().saturating_add(amount));
        if used.get() <= part.most() {
            return Ok(());
        }
        Err(self.invalid(user, format!("takes this file over {} {}", part.most(), part.name())))
    }
}
