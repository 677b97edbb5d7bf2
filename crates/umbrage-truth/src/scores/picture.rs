//! False-colour images of wrong decisions, drawn over the ground truth in grey.

use image::{Rgb, RgbImage};

use super::domain::check_size;
use super::{Answers, Domain};
use crate::{Result, SoftTruth, TruthMask};

/// Colour of false light, a leak.
const LEAK: [f32; 3] = [230.0, 30.0, 20.0];
/// Colour of false shadow, acne.
const ACNE: [f32; 3] = [20.0, 80.0, 240.0];
/// Grey of true shadow and of true light.
const GREY: (f32, f32) = (60.0, 190.0);
/// Factor by which pixels that are not scored are dimmed.
const NOT_SCORED: f32 = 0.5;

/// Draws the truth in grey (bright where lit, dimmed outside Ω_f, black where nothing was hit) and
/// wrong decisions in full colour: leaks red, acne blue.
///
/// # Errors
/// [`crate::Error::SizeMismatch`] unless all three have one size.
pub fn false_colour(mask: &TruthMask, domain: &Domain, answers: &Answers) -> Result<RgbImage> {
    check_size("the mask", mask.size(), domain.size())?;
    check_size("the technique's image", answers.size(), domain.size())?;
    Ok(paint(domain, |pixel| {
        let truth = f32::from(u8::from(mask.hits()[pixel]?.lit));
        let answer = if domain.contains(pixel) { f32::from(u8::from(answers.decision(domain, pixel))) } else { truth };
        Some((truth, answer))
    }))
}

/// Draws the errors of soft shadows in false colour. The colour is as strong as the difference.
///
/// # Errors
/// As [`false_colour`].
pub fn false_colour_soft(truth: &SoftTruth, domain: &Domain, answers: &Answers) -> Result<RgbImage> {
    check_size("the soft truth", truth.size(), domain.size())?;
    check_size("the technique's image", answers.size(), domain.size())?;
    Ok(paint(domain, |pixel| {
        let expected = truth.visibility()[pixel]?;
        let wrong = if expected >= 0.5 { 0.0 } else { 1.0 };
        let answer = if domain.contains(pixel) { answers.visibility()[pixel].unwrap_or(wrong) } else { expected };
        Some((expected, answer))
    }))
}

/// Paints pairs of truth and answer.
fn paint(domain: &Domain, pair: impl Fn(usize) -> Option<(f32, f32)>) -> RgbImage {
    let [width, height] = domain.size().map(|n| n as u32);
    RgbImage::from_fn(width, height, |x, y| {
        let pixel = (y * width + x) as usize;
        let Some((truth, answer)) = pair(pixel) else { return Rgb([0; 3]) };
        let grey = GREY.0 + (GREY.1 - GREY.0) * truth;
        let strength = (answer - truth).abs();
        let colour = if answer > truth { LEAK } else { ACNE };
        let dim = if domain.contains(pixel) { 1.0 } else { NOT_SCORED };
        Rgb(colour.map(|channel| (dim * (grey + (channel - grey) * strength)).round() as u8))
    })
}
