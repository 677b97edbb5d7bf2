//! Heights as a file has them, before they are converted to metres.

use glam::DVec2;

/// A grid of values, row 0 in the north.
#[derive(Debug, Default)]
pub(super) struct Raster {
    /// Number of posts from west to east.
    pub(super) width: usize,
    /// Number of posts from north to south.
    pub(super) height: usize,
    /// Values row after row; NaN where the file has no data.
    pub(super) values: Vec<f32>,
    /// Conversion of values to metres; `None` if the file does not give it.
    pub(super) metres: Option<Metres>,
    /// Metres between posts, in x and z; `None` if the file does not give them.
    pub(super) cell: Option<DVec2>,
    /// Assumptions that were made.
    pub(super) notes: Vec<String>,
}

/// Conversion to height in metres: value · unit + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Metres {
    pub(super) unit: f64,
    pub(super) offset: f64,
}

impl Metres {
    /// Conversion of values that are metres.
    pub(super) const PLAIN: Self = Self { unit: 1.0, offset: 0.0 };

    /// Returns the height of a value in metres.
    pub(super) fn height(self, value: f32) -> f64 {
        f64::from(value) * self.unit + self.offset
    }
}

/// Checks the number of posts of a file of `bytes` bytes. The error says what to do about too many.
///
/// The limit for all files is 67 million posts, 8192², whose terrain takes some 3 GiB. A file has a
/// million whatever its size and four for each byte, twice what terrain packs into one, so that a
/// small file cannot fill the memory. Both are ours.
pub(super) fn check_size(width: usize, height: usize, bytes: usize) -> Result<(), String> {
    const MOST: usize = 1 << 26;
    let most = (bytes.saturating_mul(4)).saturating_add(1 << 20).min(MOST);
    if width < 2 || height < 2 {
        return Err(format!("is {width}×{height} posts; terrain needs 2×2 or more"));
    }
    if width.checked_mul(height).is_none_or(|posts| posts > most) {
        return Err(format!(
            "is {width}×{height} posts; {most} are the most for its {bytes} bytes: crop it or scale it down"
        ));
    }
    Ok(())
}
