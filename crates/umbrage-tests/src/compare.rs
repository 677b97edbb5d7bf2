//! Whether two images are the same, and by how much they are not.
//!
//! The references are drawn by Mesa's software Vulkan. Another driver, or another version of it,
//! rounds elsewhere: a pixel whose centre lies within a rounding error of a shadow's or an object's
//! edge may fall to the other side. That, and nothing more, is what the tolerances leave room for.

use std::fmt;

use image::{GrayAlphaImage, Rgb, RgbImage};

/// The share of a mask's pixels that may decide otherwise (lit, dark, or nothing there).
///
/// 160 × 120 pixels are 19,200, so 0.002 lets 38 of them flip. The masks kept here have 1,100 to
/// 2,000 pixels beside an edge: one in forty of those may fall to the other side, while a mask that
/// moves by one pixel flips half of them.
pub const MASK_DECISIONS: f64 = 0.002;

/// The mean of `|visibility - reference|` over the pixels that show a surface in either mask,
/// visibility from 0 to 1.
///
/// 0.002 is one pixel of 500 wholly wrong, or every pixel wrong by half a step of the mask's 255.
/// It sees what decisions do not: a penumbra that became wider or softer keeps its middle where it
/// was.
pub const MASK_VISIBILITY: f64 = 0.002;

/// The mean of `|value - reference|` over a picture's pixels and channels, in linear light from 0
/// to 1.
///
/// Around sRGB 128 one step is 0.0036 of linear light, so 0.002 is a mid-grey picture of which a
/// little more than half is one step off; or one pixel of 50 that lost a light of 0.1, as sand does
/// that falls into shadow.
pub const PICTURE_MEAN: f64 = 0.002;

/// A pixel of a picture is an outlier if a channel differs by more than this, in linear light from
/// 0 to 1.
///
/// 0.02 is six steps of sRGB around 128: less than shadows change anything that is lit, more than
/// rounding does.
pub const PICTURE_OUTLIER: f64 = 0.02;

/// The share of a picture's pixels that may be outliers.
///
/// 96 × 72 pixels are 6,912, so 0.01 lets 69 of them differ, as along a silhouette of 280 pixels at
/// every fourth of which one of the four samples falls to the other side.
pub const PICTURE_OUTLIERS: f64 = 0.01;

/// What a reference image is.
#[derive(Clone, Debug, PartialEq)]
pub enum Golden {
    /// Bare visibility: grey 255 lit to 0 dark; alpha 0 where nothing is.
    Mask(GrayAlphaImage),
    /// A shaded picture, sRGB.
    Picture(RgbImage),
}

impl Golden {
    /// Pixels across and down.
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

/// One number and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// For messages.
    pub what: &'static str,
    /// 0 for equal images.
    pub value: f64,
    /// The largest value that counts as the same.
    pub limit: f64,
}

/// What a comparison found. It decides nothing by itself: ask [`Verdict::is_same`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Verdict {
    /// How many pixels were compared.
    pub pixels: usize,
    /// Everything that was measured.
    pub measured: [Measured; 2],
}

impl Verdict {
    /// Whether something was compared and no number is beyond its limit.
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

/// Why two images cannot even be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Incomparable {
    /// One is larger.
    #[error("the reference is {expected:?} pixels and the image {actual:?}")]
    Size {
        /// Of the reference.
        expected: [u32; 2],
        /// Of the image.
        actual: [u32; 2],
    },
    /// A mask is no picture.
    #[error("the reference is a {expected} and the image a {actual}")]
    Kind {
        /// Of the reference.
        expected: &'static str,
        /// Of the image.
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

/// What a mask says of a pixel.
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

/// Linear light of an sRGB value (IEC 61966-2-1).
#[must_use]
pub fn linear(srgb: u8) -> f64 {
    let value = f64::from(srgb) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Where two images of one size and kind differ. Masks: the reference in dim grey, red where the
/// image is brighter, blue where it is darker, yellow where one has a surface and the other
/// nothing. Pictures: four times the difference of each channel. `None` where [`compare`] has no
/// verdict either.
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
