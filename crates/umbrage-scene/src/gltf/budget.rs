//! Limits on the memory and time that a file may cost: many parts can refer to the same few bytes,
//! or to none.
//!
//! Each limit is an amount that every file may have and an amount for each byte of the file and the
//! files it names. The numbers are ours: several times the amounts per byte of real files, and
//! small enough that a file of 1 MB loads in seconds and takes some hundred MiB.

use std::cell::Cell;

use super::Document;
use crate::Result;

/// Kind of data that is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Elements of accessors that are read; they cost time only.
    Element,
    /// Elements without bytes in the file (all zeros but for a sparse part).
    ZeroElement,
    /// Bytes of vertices, indices and morph targets that are kept.
    Geometry,
    /// Instances of EXT_mesh_gpu_instancing.
    Instance,
    /// Times and values of animation keys.
    Key,
    /// Pixels of pictures that are decoded.
    Pixel,
    /// Bytes of decompressed buffer views and primitives.
    Unpacked,
}

impl Part {
    const COUNT: usize = 7;

    /// Returns the amount that every file may have, and the amount for each of its bytes.
    const fn limit(self) -> (u64, f64) {
        match self {
            Self::Element => (1 << 26, 64.0),
            Self::ZeroElement => (1 << 20, 4.0),
            Self::Geometry => (48 << 20, 112.0),
            Self::Instance => (1 << 15, 0.25),
            Self::Key => (1 << 20, 4.0),
            Self::Pixel => (1 << 28, 64.0),
            Self::Unpacked => (16 << 20, 24.0),
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Element => "elements of accessors",
            Self::ZeroElement => "elements without any bytes",
            Self::Geometry => "bytes of vertices and indices",
            Self::Instance => "instances",
            Self::Key => "animated values",
            Self::Pixel => "pixels",
            Self::Unpacked => "bytes once decompressed",
        }
    }
}

/// Amounts used of each limit.
#[derive(Default)]
pub(super) struct Used {
    parts: [Cell<u64>; Part::COUNT],
    bytes: Cell<u64>,
}

impl Used {
    /// Starts counting for a file of `bytes` bytes.
    pub(super) fn new(bytes: usize) -> Self {
        Self { bytes: Cell::new(bytes as u64), ..Self::default() }
    }

    /// Adds the bytes of another file that the file names.
    pub(super) fn add_bytes(&self, bytes: usize) {
        self.bytes.set(self.bytes.get().saturating_add(bytes as u64));
    }

    /// Returns the amount of a part that the file may have.
    fn most(&self, part: Part) -> u64 {
        let (every_file, per_byte) = part.limit();
        every_file.saturating_add((per_byte * self.bytes.get() as f64) as u64)
    }
}

impl Document<'_> {
    /// Returns the amount of a part that the file may still have.
    pub(super) fn left(&self, part: Part) -> u64 {
        self.used.most(part).saturating_sub(self.used.parts[part as usize].get())
    }

    /// Counts `amount` more of a part on behalf of `user`. Beyond the limit it returns an error and
    /// does not count.
    pub(super) fn count(&self, part: Part, amount: u64, user: &str) -> Result<()> {
        let used = &self.used.parts[part as usize];
        let (most, sum) = (self.used.most(part), used.get().saturating_add(amount));
        if sum <= most {
            used.set(sum);
            return Ok(());
        }
        let reason =
            format!("takes this file over {most} {}, the most for its {} bytes", part.name(), self.used.bytes.get());
        Err(self.invalid(user, reason))
    }
}
