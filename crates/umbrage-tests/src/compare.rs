//! Comparison of two images, with tolerances.
//!
//! The references are drawn by Mesa's software Vulkan. Another driver, or another version of it,
//! rounds differently: a pixel whose centre lies within a rounding error of a shadow's or an
//! object's edge may fall to the other side. The tolerances leave room for this and for nothing
//! more.

use std::fmt;

use image::{GrayAlphaImage, Rgb, RgbImage};

/// Largest share of a mask's pixels with another decision (lit, dark, or no surface).
///
/// 160 × 120 pixels are 19,200, so 0.002 lets 38 of them flip. The masks kept here have 1,100 to
/// 2,000 pixels beside an edge: one in forty of those may fall to the other side, while a mask that
/// moves by one pixel flips half of them.
pub const MASK_DECISIONS: f64 = 0.002;

/// Largest mean of `|visibility - reference|` over the pixels that show a surface in either mask,
/// with visibility from 0 to 1.
///
/// 0.002 is one pixel of 500 wholly wrong, or every pixel wrong by half a step of the mask's 255.
/// This limit detects changes that decisions miss: a penumbra that became wider or softer keeps its
/// middle where it was.
pub const MASK_VISIBILITY: f64 = 0.002;

/// Largest mean of `|value - reference|` over a picture's pixels and channels, in linear light from
/// 0 to 1.
///
/// Around sRGB 128 one step is 0.0036 of linear light, so 0.002 is a mid-grey picture of which a
/// little more than half is one step off; or one pixel of 50 that lost a light of 0.1, as sand does
/// that falls into shadow.
pub const PICTURE_MEAN: f64 = 0.002;

/// Least difference of a channel, in linear light from 0 to 1, that makes a pixel of a picture an
/// outlier.
///
/// 0.02 is six steps of sRGB around 128: less than the change from lit to shadowed, more than
/// rounding.
pub const PICTURE_OUTLIER: f64 = 0.02;

/// Largest share of a picture's pixels that may be outliers.
///
/// 96 × 72 pixels are 6,912, so 0.01 lets 69 of them differ, as along a silhouette of 280 pixels at
/// every fourth of which one of the four samples falls to the other side.
pub const PICTURE_OUTLIERS: f64 = 0.01;

/// A reference image, or an image to compare with one.
#[derive(Clone, Debug, PartialEq)]
pub enum Golden {
    /// A visibility mask: grey from 255 (lit) to 0 (dark); alpha 0 where no surface is.
    Mask(GrayAlphaImage),
    /// A shaded picture, sRGB.
    Picture(RgbImage),
}

impl Golden {
    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Mask(mask) => mask.dimensions().into(),
            Self::Picture(picture) => picture.dimensions().into(),
        }
    }

    fn kind(&self) -> &'static str {
        match self {
            Self::Mask(_) => "mask",
            Self::Picture(_) => "picture",
        }
    }
}

/// A measured difference and its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Name of the difference, for messages.
    pub what: &'static str,
    /// Measured value; 0 for equal images.
    pub value: f64,
    /// Largest value that counts as the same.
    pub limit: f64,
}

/// Result of a comparison. [`Verdict::is_same`] decides by it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Verdict {
    /// Number of pixels compared.
    pub pixels: usize,
    /// Measured differences.
    pub measured: [Measured; 2],
}

impl Verdict {
    /// Returns whether pixels were compared and no difference is beyond its limit.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.pixels > 0 && self.measured.iter().all(|measured| measured.value <= measured.limit)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "of {} pixels", self.pixels)?;
        for Measured { what, value, limit } in &self.measured {
            let (sign, mark) = if value <= limit { ("<=", "") } else { (">", " (!)") };
            write!(f, "; {what} {value:.5} {sign} {limit}{mark}")?;
        }
        Ok(())
    }
}

/// Reason why two images cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Incomparable {
    /// The sizes differ.
    #[error("the reference is {expected:?} pixels and the image {actual:?}")]
    Size {
        /// Width and height of the reference.
        expected: [u32; 2],
        /// Width and height of the image.
        actual: [u32; 2],
    },
    /// One is a mask, the other a picture.
    #[error("the reference is a {expected} and the image a {actual}")]
    Kind {
        /// Kind of the reference.
        expected: &'static str,
        /// Kind of the image.
        actual: &'static str,
    },
}

/// Compares an image with its reference.
///
/// # Errors
/// [`Incomparable`] if they differ in size or kind.
pub fn compare(expected: &Golden, actual: &Golden) -> Result<Verdict, Incomparable> {
    if expected.kind() != actual.kind() {
        return Err(Incomparable::Kind { expected: expected.kind(), actual: actual.kind() });
    }
    if expected.size() != actual.size() {
        return Err(Incomparable::Size { expected: expected.size(), actual: actual.size() });
    }
    Ok(match (expected, actual) {
        (Golden::Mask(expected), Golden::Mask(actual)) => compare_masks(expected, actual),
        (Golden::Picture(expected), Golden::Picture(actual)) => compare_pictures(expected, actual),
        _ => unreachable!("the kinds were compared above"),
    })
}

/// Decision of a mask at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Decision {
    Nothing,
    Dark,
    Lit,
}

fn decision([grey, alpha]: [u8; 2]) -> Decision {
    match (alpha, grey) {
        (0, _) => Decision::Nothing,
        // V >= 1/2, as everywhere.
        (_, 128..) => Decision::Lit,
        _ => Decision::Dark,
    }
}

fn compare_masks(expected: &GrayAlphaImage, actual: &GrayAlphaImage) -> Verdict {
    let (mut pixels, mut flipped, mut surfaces, mut apart) = (0_usize, 0_usize, 0_usize, 0.0);
    for (expected, actual) in expected.pixels().zip(actual.pixels()) {
        pixels += 1;
        flipped += usize::from(decision(expected.0) != decision(actual.0));
        if expected.0[1] > 0 || actual.0[1] > 0 {
            surfaces += 1;
            apart += f64::from(expected.0[0].abs_diff(actual.0[0])) / 255.0;
        }
    }
    let decisions = flipped as f64 / pixels.max(1) as f64;
    let visibility = apart / surfaces.max(1) as f64;
    Verdict {
        pixels,
        measured: [
            Measured { what: "share that decides otherwise", value: decisions, limit: MASK_DECISIONS },
            Measured { what: "mean difference of visibility", value: visibility, limit: MASK_VISIBILITY },
        ],
    }
}

fn compare_pictures(expected: &RgbImage, actual: &RgbImage) -> Verdict {
    let (mut pixels, mut outliers, mut sum) = (0_usize, 0_usize, 0.0);
    for (&Rgb(expected), &Rgb(actual)) in expected.pixels().zip(actual.pixels()) {
        let apart = [0, 1, 2].map(|c| (linear(expected[c]) - linear(actual[c])).abs());
        pixels += 1;
        sum += apart.iter().sum::<f64>();
        outliers += usize::from(apart.iter().any(|&apart| apart > PICTURE_OUTLIER));
    }
    let count = pixels.max(1) as f64;
    Verdict {
        pixels,
        measured: [
            Measured { what: "mean difference in linear light", value: sum / (3.0 * count), limit: PICTURE_MEAN },
            Measured { what: "share of outliers", value: outliers as f64 / count, limit: PICTURE_OUTLIERS },
        ],
    }
}

/// Converts an sRGB value to linear light (IEC 61966-2-1).
#[must_use]
pub fn linear(srgb: u8) -> f64 {
    let value = f64::from(srgb) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Draws the differences of two images of one size and kind; `None` if [`compare`] cannot compare
/// them. Masks: the reference in dim grey, red where the image is brighter, blue where it is
/// darker, yellow where only one has a surface. Pictures: four times the difference of each
/// channel.
#[must_use]
pub fn difference(expected: &Golden, actual: &Golden) -> Option<RgbImage> {
    if expected.size() != actual.size() {
        return None;
    }
    let [width, height] = expected.size();
    match (expected, actual) {
        (Golden::Mask(expected), Golden::Mask(actual)) => Some(RgbImage::from_fn(width, height, |x, y| {
            let [e, a] = [expected.get_pixel(x, y).0, actual.get_pixel(x, y).0];
            if (e[1] > 0) != (a[1] > 0) {
                return Rgb([255, 220, 0]);
            }
            let base = if e[1] > 0 { 24 + e[0] / 4 } else { 0 };
            let apart = e[0].abs_diff(a[0]);
            let strong = base.max(apart);
            match a[0].cmp(&e[0]) {
                std::cmp::Ordering::Equal => Rgb([base; 3]),
                std::cmp::Ordering::Greater => Rgb([strong, base.min(255 - apart), base.min(255 - apart)]),
                std::cmp::Ordering::Less => Rgb([base.min(255 - apart), base.min(255 - apart), strong]),
            }
        })),
        (Golden::Picture(expected), Golden::Picture(actual)) => Some(RgbImage::from_fn(width, height, |x, y| {
            let (e, a) = (expected.get_pixel(x, y).0, actual.get_pixel(x, y).0);
            Rgb([0, 1, 2].map(|c| e[c].abs_diff(a[c]).saturating_mul(4)))
        })),
        _ => None,
    }
}
