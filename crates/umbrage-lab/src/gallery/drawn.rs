//! A drawn shot with all its pictures.

use image::{DynamicImage, GrayAlphaImage, RgbaImage};

use super::scenes::Shot;
use crate::report::Report;

/// A drawn shot.
pub(super) struct Drawn {
    pub shot: &'static Shot,
    pub command: String,
    pub picture: RgbaImage,
    /// Picture with each split in its own colour.
    pub tint: RgbaImage,
    pub mask: GrayAlphaImage,
    /// Map of each split, nearest first.
    pub maps: Vec<DynamicImage>,
    pub report: Report,
}
