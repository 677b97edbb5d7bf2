//! Scores of techniques in the worlds, against exact visibility by rays.

use std::fmt;

use image::GrayAlphaImage;
use umbrage::View;
use umbrage_truth::scores::{Answers, Domain, MisShadowed, mis_shadowed};
use umbrage_truth::{Hit, Truth, TruthMask};

use crate::stage::Stage;

/// A view and its ground truth.
#[derive(Debug)]
pub struct Judged {
    /// The camera.
    pub view: View,
    /// Ground truth of the view.
    pub truth: TruthMask,
    /// Pixels that are scored.
    pub domain: Domain,
}

impl Judged {
    /// Traces the views of some of a world's cameras.
    ///
    /// # Panics
    /// If the judge refuses the world.
    #[must_use]
    pub fn views(stage: &Stage, cameras: &[&str], size: [u32; 2]) -> Vec<Self> {
        let views: Vec<View> = cameras.iter().map(|camera| stage.view(camera, size)).collect();
        let near_point = views.first().map_or_else(Default::default, View::eye);
        let truth = Truth::build(&stage.scene, &stage.pose, near_point).expect("rays can meet a world");
        let judged = |view: View| {
            let truth = truth.mask(&view, stage.sun.direction(), size, &|_| {}).expect("a mask");
            let domain = Domain::new(&truth, stage.world.near_far()).expect("a world's range is a range");
            Self { view, truth, domain }
        };
        views.into_iter().map(judged).collect()
    }

    /// Returns the score of a mask, whose rate is E.
    ///
    /// # Panics
    /// If the mask has another size or nothing faces the light.
    #[must_use]
    pub fn score(&self, mask: &GrayAlphaImage) -> MisShadowed {
        mis_shadowed(&self.domain, &Answers::from_mask(mask)).expect("a mask of this view, which faces the light")
    }
}

/// Adds up the decisions of several views.
#[must_use]
pub fn pooled(scores: impl IntoIterator<Item = MisShadowed>) -> MisShadowed {
    scores.into_iter().fold(MisShadowed::default(), |sum, score| MisShadowed {
        pixels: sum.pixels + score.pixels,
        false_shadow: sum.false_shadow + score.false_shadow,
        false_light: sum.false_light + score.false_light,
        missing: sum.missing + score.missing,
    })
}

/// A score that must not rise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceiling {
    /// Score measured when the ceiling was set, a share in 0..=1.
    pub measured: f64,
    /// Largest score that passes.
    pub ceiling: f64,
}

/// A score above its ceiling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exceeded {
    /// Score that is measured now.
    pub now: f64,
    /// Ceiling that it exceeds.
    pub ceiling: Ceiling,
}

impl Ceiling {
    /// Ratio of a ceiling to the measurement: room for drivers that round differently. On one
    /// driver scores do not change at all, and masks of PSSM(4;512²) that are shifted by a pixel
    /// have four to twelve times its error.
    pub const ROOM: f64 = 1.15;

    /// Makes a ceiling above a measured score.
    #[must_use]
    pub const fn above(measured: f64) -> Self {
        Self { measured, ceiling: measured * Self::ROOM }
    }

    /// Checks that a score is not above the ceiling. A score without pixels, or NaN, fails.
    ///
    /// # Errors
    /// [`Exceeded`].
    pub fn check(self, score: &MisShadowed) -> Result<(), Exceeded> {
        let now = if score.pixels == 0 { f64::NAN } else { score.rate() };
        if now <= self.ceiling { Ok(()) } else { Err(Exceeded { now, ceiling: self }) }
    }
}

impl fmt::Display for Exceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Ceiling { measured, ceiling } = self.ceiling;
        write!(f, "E is {:.5}, above its ceiling of {ceiling:.5}; it was {measured:.5}", self.now)
    }
}

/// Returns the mean of `|mask - truth|` over the pixels whose hit `counts`, and their number. A
/// pixel that the mask leaves transparent differs by 1. `None` if no pixel counts or the mask has
/// another size.
#[must_use]
pub fn mean_difference(
    truth: &TruthMask,
    mask: &GrayAlphaImage,
    counts: impl Fn(&Hit) -> bool,
) -> Option<(f64, usize)> {
    if truth.size() != [mask.width() as usize, mask.height() as usize] {
        return None;
    }
    let (mut sum, mut pixels) = (0.0, 0_usize);
    for (hit, pixel) in truth.hits().iter().zip(mask.pixels()) {
        let Some(hit) = hit.as_ref().filter(|hit| counts(hit)) else { continue };
        let [grey, alpha] = pixel.0;
        let expected = f64::from(u8::from(hit.lit));
        sum += if alpha == 0 { 1.0 } else { (f64::from(grey) / 255.0 - expected).abs() };
        pixels += 1;
    }
    (pixels > 0).then(|| (sum / pixels as f64, pixels))
}
