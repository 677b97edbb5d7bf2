//! The seam score: whether shadows are worse at the border between two splits.

use super::domain::same_surface;
use super::edges::squared_distances;
use super::{Answers, Domain, MisShadowed};
use crate::{Error, Result};

/// Largest distance in pixels of the seam's pixels from a border.
pub const SEAM_PX: f64 = 2.0;
/// Least and largest distance in pixels of the pixels beside the seam, on either side.
pub const BESIDE_PX: [f64; 2] = [3.0, 12.0];
/// Largest ratio of the seam's error to that of the worse side at which no seam shows.
pub const MOST_RATIO: f64 = 1.1;
/// Fewest pixels of a seam that are enough to judge it.
pub const LEAST_SEAM_PIXELS: usize = 2000;

/// Decisions on and beside the borders of splits, pooled over borders and frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seams {
    /// Decisions within [`SEAM_PX`] of a border.
    pub seam: MisShadowed,
    /// Decisions at [`BESIDE_PX`] on the near side.
    pub nearer: MisShadowed,
    /// Decisions at [`BESIDE_PX`] on the far side.
    pub farther: MisShadowed,
}

impl Seams {
    /// Returns E of the seam over the larger E of its sides: 1 or less is no seam. Infinite if only
    /// the seam has errors, `None` if there are none at all.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let beside = self.nearer.rate().max(self.farther.rate());
        match (self.seam.rate(), beside) {
            (0.0, 0.0) => None,
            (_, 0.0) => Some(f64::INFINITY),
            (seam, beside) => Some(seam / beside),
        }
    }

    /// Returns whether seam and sides have enough pixels to be judged.
    #[must_use]
    pub fn counts(&self) -> bool {
        [self.seam, self.nearer, self.farther].iter().all(|count| count.pixels >= LEAST_SEAM_PIXELS)
    }

    /// Returns whether no seam shows: [`Seams::ratio`] is at most [`MOST_RATIO`]. `None` if there
    /// are too few pixels.
    #[must_use]
    pub fn are_hidden(&self) -> Option<bool> {
        self.counts().then(|| self.ratio().is_none_or(|ratio| ratio <= MOST_RATIO))
    }
}

impl std::ops::AddAssign for Seams {
    fn add_assign(&mut self, other: Self) {
        self.seam += other.seam;
        self.nearer += other.nearer;
        self.farther += other.farther;
    }
}

/// Counts decisions around the given borders. Each border is a value of `measure`: of a pixel's
/// view depth ([`Domain::depth`]), or of its distance from the eye where bands are radial. A pixel
/// that is near two borders counts for the nearer one.
///
/// # Errors
/// As [`super::mis_shadowed`], and [`Error::InvalidSetting`] for borders that do not rise.
pub fn seams(domain: &Domain, answers: &Answers, borders: &[f64], measure: impl Fn(usize) -> f64) -> Result<Seams> {
    answers.check(domain)?;
    if !(borders.iter().all(|border| border.is_finite()) && borders.windows(2).all(|pair| pair[0] < pair[1])) {
        return Err(Error::setting("borders of splits", format!("{borders:?}; give finite numbers that rise")));
    }
    let [width, height] = domain.size();
    let mut nearest = vec![(f64::INFINITY, f64::NAN); width * height];
    for &border in borders {
        let seeds = crossings(domain, |pixel| measure(pixel) < border);
        let squared = squared_distances(width, height, &seeds);
        for &pixel in domain.pixels() {
            if squared[pixel] < nearest[pixel].0 {
                nearest[pixel] = (squared[pixel], border);
            }
        }
    }
    let mut seams = Seams::default();
    for &pixel in domain.pixels() {
        let (squared, border) = nearest[pixel];
        // The border runs between the pixels that it was found at.
        let distance = squared.sqrt() + 0.5;
        if distance <= SEAM_PX {
            seams.seam.count(domain, answers, pixel);
        } else if (BESIDE_PX[0]..=BESIDE_PX[1]).contains(&distance) {
            let side = if measure(pixel) < border { &mut seams.nearer } else { &mut seams.farther };
            side.count(domain, answers, pixel);
        }
    }
    Ok(seams)
}

/// Returns the pixels of Ω_f with a neighbour of the same surface on the other side, both of each
/// pair.
fn crossings(domain: &Domain, is_nearer: impl Fn(usize) -> bool) -> Vec<usize> {
    let [width, height] = domain.size();
    let mut found = Vec::new();
    for &pixel in domain.pixels() {
        let right = (pixel % width + 1 < width).then_some(pixel + 1);
        let below = (pixel / width + 1 < height).then_some(pixel + width);
        for other in [right, below].into_iter().flatten() {
            if same_surface(domain, pixel, other) && is_nearer(pixel) != is_nearer(other) {
                found.extend([pixel, other]);
            }
        }
    }
    found
}
