//! Image metrics, printed for information. No test depends on them.

use image::RgbImage;
use image_compare::Algorithm;

use super::domain::check_size;
use crate::{Error, Result};

/// Similarity of two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Similarity {
    /// Mean ꟻLIP error in `[0, 1]`, 0 for equal pictures (Andersson et al., "FLIP: A Difference
    /// Evaluator for Alternating Images", 2020), at its authors' default of 67 pixels per degree.
    /// `None` if the feature `flip` is off.
    pub flip: Option<f64>,
    /// Mean structural similarity, 1 for equal pictures (Wang et al., 2004), the least of the three
    /// channels.
    pub ssim: f64,
}

/// Compares a picture with its reference.
///
/// # Errors
/// [`Error::SizeMismatch`] if the sizes differ, [`Error::NothingToScore`] for pictures without
/// pixels, [`Error::Metric`] if a metric fails.
pub fn similarity(reference: &RgbImage, picture: &RgbImage) -> Result<Similarity> {
    let size = |image: &RgbImage| [image.width() as usize, image.height() as usize];
    check_size("the picture", size(picture), size(reference))?;
    if size(reference).contains(&0) {
        return Err(Error::NothingToScore("the pictures have no pixels"));
    }
    let ssim = image_compare::rgb_similarity_structure(&Algorithm::MSSIMSimple, reference, picture)
        .map_err(|error| Error::Metric { metric: "SSIM", reason: error.to_string() })?
        .score;
    Ok(Similarity { flip: flip(reference, picture), ssim })
}

#[cfg(feature = "flip")]
fn flip(reference: &RgbImage, picture: &RgbImage) -> Option<f64> {
    let upload = |image: &RgbImage| nv_flip::FlipImageRgb8::with_data(image.width(), image.height(), image.as_raw());
    let map = nv_flip::flip(upload(reference), upload(picture), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    let errors = map.to_vec();
    Some(errors.iter().map(|&error| f64::from(error)).sum::<f64>() / errors.len() as f64)
}

#[cfg(not(feature = "flip"))]
fn flip(_reference: &RgbImage, _picture: &RgbImage) -> Option<f64> {
    None
}
