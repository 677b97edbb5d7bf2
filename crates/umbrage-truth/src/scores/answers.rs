//! V̂: the visibilities that a technique computes.

use image::GrayAlphaImage;

use super::Domain;
use super::domain::check_size;
use crate::{Error, Result};

/// A technique's visibility per pixel of a frame, in `[0, 1]`; `None` where it has no answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answers {
    size: [usize; 2],
    visibility: Vec<Option<f32>>,
}

impl Answers {
    /// Reads a mask as `umbrage render --visibility` writes it: grey / 255, and no answer where
    /// alpha is 0.
    #[must_use]
    pub fn from_mask(image: &GrayAlphaImage) -> Self {
        let visibility = image.pixels().map(|p| (p.0[1] > 0).then(|| f32::from(p.0[0]) / 255.0)).collect();
        Self { size: [image.width() as usize, image.height() as usize], visibility }
    }

    /// Makes answers from one visibility for each pixel of Ω_f, in the order of [`Domain::pixels`]:
    /// those of `umbrage probe` at [`Domain::points`].
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] if their number differs, [`Error::NotAVisibility`] for one outside
    /// `[0, 1]`.
    pub fn from_points(domain: &Domain, answers: &[f32]) -> Result<Self> {
        check_size("the list of answers", [answers.len(), 1], [domain.pixels().len(), 1])?;
        check_visibilities("answer", answers.iter().copied().enumerate())?;
        let mut visibility = vec![None; domain.size()[0] * domain.size()[1]];
        for (&pixel, &answer) in domain.pixels().iter().zip(answers) {
            visibility[pixel] = Some(answer);
        }
        Ok(Self { size: domain.size(), visibility })
    }

    /// Makes answers from one visibility for each pixel of an image.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] if their number differs from the number of pixels,
    /// [`Error::NotAVisibility`] for one outside `[0, 1]`.
    pub fn from_pixels(size: [usize; 2], visibility: Vec<Option<f32>>) -> Result<Self> {
        check_size("the list of answers", [visibility.len(), 1], [size[0] * size[1], 1])?;
        check_visibilities("pixel", visibility.iter().enumerate().filter_map(|(i, v)| v.map(|v| (i, v))))?;
        Ok(Self { size, visibility })
    }

    /// Returns width and height of the image in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns V̂ of each pixel of the image.
    #[must_use]
    pub fn visibility(&self) -> &[Option<f32>] {
        &self.visibility
    }

    /// Returns the hard decision at a pixel, V̂ ≥ ½, and the wrong decision where there is no
    /// answer.
    pub(super) fn decision(&self, domain: &Domain, pixel: usize) -> bool {
        self.visibility[pixel].map_or(!domain.lit(pixel), is_lit)
    }

    pub(super) fn check(&self, domain: &Domain) -> Result<()> {
        check_size("the technique's image", self.size, domain.size())?;
        domain.not_empty()
    }
}

/// Returns the hard decision for a visibility.
pub(super) fn is_lit(visibility: f32) -> bool {
    visibility >= 0.5
}

pub(super) fn check_visibilities(what: &'static str, mut values: impl Iterator<Item = (usize, f32)>) -> Result<()> {
    match values.find(|(_, value)| !(0.0..=1.0).contains(value)) {
        Some((index, value)) => Err(Error::NotAVisibility { what, index, value }),
        None => Ok(()),
    }
}
