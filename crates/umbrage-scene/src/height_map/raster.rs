//! Heights as a file has them, before anything says what they are in metres.

use glam::DVec2;

/// A grid of values, row 0 in the north.
#[derive(Debug, Default)]
pub(super) struct Raster {
    /// Posts from west to east.
    pub(super) width: usize,
    /// Posts from north to south.
    pub(super) height: usize,
    /// Row after row; NaN where the file has no data.
    pub(super) values: Vec<f32>,
    /// What a value is in metres; `None` if the file does not say.
    pub(super) metres: Option<Metres>,
    /// Metres between posts, in x and z; `None` if the file does not say.
    pub(super) cell: Option<DVec2>,
    /// What was taken for granted.
    pub(super) notes: Vec<String>,
}

/// Height in metres = value · unit + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Metres {
    pub(super) unit: f64,
    pub(super) offset: f64,
}

impl Metres {
    /// Values are metres.
    pub(super) const PLAIN: Self = Self { unit: 1.0, offset: 0.0 };

    /// The height of a value.
    pub(super) fn height(self, value: f32) -> f64 {
        f64::from(value) * self.unit + self.offset
    }
}

/// Most posts of a file of so many bytes; the error says what to do about more.
///
/// 67 million, 8192², are the most at all: their terrain takes some 3 GiB. A file has a million
/// whatever its size and four for each byte, twice what terrain packs into one, so that a small
/// file cannot fill the memory. Both are ours.
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
