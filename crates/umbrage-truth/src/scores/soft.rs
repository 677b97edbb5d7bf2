//! E_soft and E_pen: the errors of soft shadows.

use super::domain::check_size;
use super::{Answers, Domain};
use crate::{Result, SoftTruth};

/// Least share of the sun that is hidden, and least share that is visible, in a penumbra.
const PENUMBRA: f32 = 0.02;

/// Mean differences of visibility, in `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SoftError {
    /// Mean difference over Ω_f, E_soft.
    pub whole: f64,
    /// Mean difference over the penumbra, E_pen; `None` if there is none.
    pub penumbra: Option<f64>,
    /// Number of scored pixels, |Ω_f|.
    pub pixels: usize,
    /// Number of scored pixels in the penumbra.
    pub penumbra_pixels: usize,
}

/// Computes the mean difference of the answers from V*_A. A pixel without an answer differs by 1.
/// The noise floor is the score of the truth with another set of directions: `soft_error(&domain,
/// &soft, &Answers::from_pixels(soft.size(), other.visibility().to_vec())?)`.
///
/// # Errors
/// As [`super::mis_shadowed`].
pub fn soft_error(domain: &Domain, truth: &SoftTruth, answers: &Answers) -> Result<SoftError> {
    answers.check(domain)?;
    check_size("the soft truth", truth.size(), domain.size())?;
    let (mut sum, mut penumbra_sum, mut penumbra_pixels) = (0.0, 0.0, 0);
    for &pixel in domain.pixels() {
        let expected = truth.visibility()[pixel].unwrap_or(0.0);
        let off = f64::from(answers.visibility()[pixel].map_or(1.0, |answer| (answer - expected).abs()));
        sum += off;
        if expected > PENUMBRA && expected < 1.0 - PENUMBRA {
            penumbra_sum += off;
            penumbra_pixels += 1;
        }
    }
    let pixels = domain.pixels().len();
    Ok(SoftError {
        whole: sum / pixels as f64,
        penumbra: (penumbra_pixels > 0).then(|| penumbra_sum / f64::from(penumbra_pixels)),
        pixels,
        penumbra_pixels: penumbra_pixels as usize,
    })
}
