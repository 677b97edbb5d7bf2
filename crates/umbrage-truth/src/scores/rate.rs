//! E: the share of wrong decisions.

use super::{Answers, Domain};
use crate::Result;

/// Numbers of decisions and of wrong decisions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MisShadowed {
    /// Number of scored pixels, |Ω_f|.
    pub pixels: usize,
    /// Number of pixels that are lit in truth and dark in the answer: acne, shadows that are too
    /// wide.
    pub false_shadow: usize,
    /// Number of pixels that are dark in truth and lit in the answer: leaks, detached shadows.
    pub false_light: usize,
    /// Number of wrong decisions for lack of an answer.
    pub missing: usize,
}

impl MisShadowed {
    /// Returns E in `[0, 1]`, or 0 if Ω_f is empty.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.share(self.false_shadow + self.false_light)
    }

    /// Returns E_fs in `[0, 1]`.
    #[must_use]
    pub fn false_shadow_rate(&self) -> f64 {
        self.share(self.false_shadow)
    }

    /// Returns E_fl in `[0, 1]`.
    #[must_use]
    pub fn false_light_rate(&self) -> f64 {
        self.share(self.false_light)
    }

    pub(super) fn count(&mut self, domain: &Domain, answers: &Answers, pixel: usize) {
        let truth = domain.lit(pixel);
        self.pixels += 1;
        self.missing += usize::from(answers.visibility()[pixel].is_none());
        if answers.decision(domain, pixel) != truth {
            *(if truth { &mut self.false_shadow } else { &mut self.false_light }) += 1;
        }
    }

    fn share(&self, of: usize) -> f64 {
        if self.pixels == 0 { 0.0 } else { of as f64 / self.pixels as f64 }
    }
}

impl std::ops::AddAssign for MisShadowed {
    fn add_assign(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.false_shadow += other.false_shadow;
        self.false_light += other.false_light;
        self.missing += other.missing;
    }
}

/// Counts the wrong decisions over Ω_f.
///
/// # Errors
/// [`crate::Error::SizeMismatch`] if the answers have another size,
/// [`crate::Error::NothingToScore`] if Ω_f is empty.
pub fn mis_shadowed(domain: &Domain, answers: &Answers) -> Result<MisShadowed> {
    answers.check(domain)?;
    let mut count = MisShadowed::default();
    for &pixel in domain.pixels() {
        count.count(domain, answers, pixel);
    }
    Ok(count)
}
