//! E_log: the error rate E averaged over depth, so that no depth dominates.

use super::{Answers, Domain, MisShadowed};
use crate::Result;

/// Fewest pixels of Ω_f in a bin that counts.
pub const LEAST_PIXELS_IN_BIN: usize = 200;

const BINS: usize = 8;

/// Error rate between two depths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DepthBin {
    /// View depth in metres at which the bin begins.
    pub near: f64,
    /// View depth in metres at which the bin ends.
    pub far: f64,
    /// Decisions in the bin.
    pub score: MisShadowed,
}

/// Error rate in eight equal bins of ln z.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ByDepth {
    /// Bins from near to far.
    pub bins: [DepthBin; BINS],
}

impl ByDepth {
    /// Returns E_log in `[0, 1]`: the mean of E over the bins that count; `None` if none does.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        let full = self.bins.iter().filter(|bin| bin.score.pixels >= LEAST_PIXELS_IN_BIN);
        let (count, sum) = full.fold((0, 0.0), |(count, sum), bin| (count + 1, sum + bin.score.rate()));
        (count > 0).then(|| sum / f64::from(count))
    }
}

/// Counts the wrong decisions over Ω_f by depth.
///
/// # Errors
/// As [`super::mis_shadowed`].
pub fn by_depth(domain: &Domain, answers: &Answers) -> Result<ByDepth> {
    answers.check(domain)?;
    let (near, far) = domain.range();
    let octaves = (far / near).ln();
    let border = |i: usize| near * (octaves * i as f64 / BINS as f64).exp();
    let mut bins = std::array::from_fn(|i| DepthBin { near: border(i), far: border(i + 1), ..DepthBin::default() });
    for &pixel in domain.pixels() {
        let at = (domain.depth(pixel) / near).ln() / octaves * BINS as f64;
        bins[(at as usize).min(BINS - 1)].score.count(domain, answers, pixel);
    }
    Ok(ByDepth { bins })
}
