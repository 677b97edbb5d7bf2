//! A shot with all that is shown of it.

use image::{DynamicImage, GrayAlphaImage, RgbaImage};

use super::scenes::Shot;
use crate::report::Report;

/// A shot that was drawn.
pub(super) struct Drawn {
    pub shot: &'static Shot,
    pub command: String,
    pub picture: RgbaImage,
    /// The picture coloured by split.
    pub tint: RgbaImage,
    pub mask: GrayAlphaImage,
    /// Each split's map, nearest first.
    pub maps: Vec<DynamicImage>,
    pub report: Report,
}
