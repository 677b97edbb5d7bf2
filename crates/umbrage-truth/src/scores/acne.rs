//! Acne and leaks: wrong decisions that no true edge explains.

use glam::DVec3;
use umbrage::View;

use super::domain::check_size;
use super::edges::squared_distances;
use super::footprint::pixels_per_texel;
use super::{Answers, Domain, TexelGradient};
use crate::{Result, TruthMask};

/// Distance in pixels from a true edge, with [`EDGE_TEXELS`] added, within which a wrong decision
/// may be the edge's.
pub const EDGE_PIXELS: f64 = 2.0;
/// Distance in texels that is added to [`EDGE_PIXELS`]: its factor is m, the number of pixels that
/// a texel covers there.
pub const EDGE_TEXELS: f64 = 1.5;

/// Wrong decisions farther from every true edge than the map's resolution explains.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct AcneAndLeak {
    /// Number of scored pixels, |Ω_f|.
    pub pixels: usize,
    /// Number of scored pixels farther than `2 + 1.5 m` pixels from B*.
    pub beyond: usize,
    /// Number of pixels beyond that distance that are lit in truth and dark in the answer.
    pub acne: usize,
    /// Number of pixels beyond that distance that are dark in truth and lit in the answer.
    pub leak: usize,
    /// Pixels of acne and leaks, as indices into the image, rising.
    pub wrong: Vec<usize>,
}

impl AcneAndLeak {
    /// Returns acne as a share of Ω_f, or 0 if Ω_f is empty.
    #[must_use]
    pub fn acne_rate(&self) -> f64 {
        share(self.acne, self.pixels)
    }

    /// Returns leaks as a share of Ω_f, or 0 if Ω_f is empty.
    #[must_use]
    pub fn leak_rate(&self) -> f64 {
        share(self.leak, self.pixels)
    }

    /// Returns acne as a share of the pixels beyond the edges' reach, or 0 if there are none. This
    /// count is the stricter one.
    #[must_use]
    pub fn acne_rate_beyond(&self) -> f64 {
        share(self.acne, self.beyond)
    }

    /// Returns leaks as a share of the pixels beyond the edges' reach, or 0 if there are none.
    #[must_use]
    pub fn leak_rate_beyond(&self) -> f64 {
        share(self.leak, self.beyond)
    }

    /// Returns the share of Ω_f that lies beyond the edges' reach. Where maps are coarse this share
    /// is small, and small rates of acne then mean little.
    #[must_use]
    pub fn beyond_rate(&self) -> f64 {
        share(self.beyond, self.pixels)
    }
}

fn share(of: usize, pixels: usize) -> f64 {
    if pixels == 0 { 0.0 } else { of as f64 / pixels as f64 }
}

/// Counts acne and leaks. `gradient` returns, for a world point and its view depth, the texel
/// gradient of the map that covers it; where no map does, m is 0.
///
/// # Errors
/// As [`super::mis_shadowed`], and [`crate::Error::SizeMismatch`] if the mask belongs to another
/// frame.
pub fn acne_and_leak(
    view: &View,
    mask: &TruthMask,
    domain: &Domain,
    answers: &Answers,
    gradient: impl Fn(DVec3, f64) -> Option<TexelGradient>,
) -> Result<AcneAndLeak> {
    answers.check(domain)?;
    check_size("the mask", mask.size(), domain.size())?;
    let [width, height] = domain.size();
    let from_edge = squared_distances(width, height, domain.edges());
    let mut count = AcneAndLeak { pixels: domain.pixels().len(), ..AcneAndLeak::default() };
    for &pixel in domain.pixels() {
        // Close to an edge whatever m is: most pixels that are wrong.
        if from_edge[pixel] <= EDGE_PIXELS * EDGE_PIXELS {
            continue;
        }
        let Some(hit) = mask.hits()[pixel] else { continue };
        let m = gradient(hit.position, hit.depth)
            .map_or(0.0, |map| pixels_per_texel(view, domain.size(), pixel, &hit, &map));
        if from_edge[pixel].sqrt() <= EDGE_PIXELS + EDGE_TEXELS * m {
            continue;
        }
        count.beyond += 1;
        if answers.decision(domain, pixel) != domain.lit(pixel) {
            *(if domain.lit(pixel) { &mut count.acne } else { &mut count.leak }) += 1;
            count.wrong.push(pixel);
        }
    }
    Ok(count)
}
