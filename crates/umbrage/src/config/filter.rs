//! Filters of shadow maps, which decide how soft edges become.

use super::names::{Word, named};
use crate::margin::FilterReach;
use crate::maths;

/// Filter of a shadow map.
///
/// Widths are full widths across the light in metres, equal in every split; `None` leaves the width
/// to the filter, in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// One nearest texel, one comparison: visibility is 0 or 1.
    Hard,
    /// One bilinear comparison of 2×2 texels.
    Pcf2,
    /// A tent of three texels.
    Pcf3 {
        /// Full width in metres, of at most 3 texels of each split's map.
        width_m: Option<f64>,
    },
    /// A tent of five texels.
    Pcf5 {
        /// Full width in metres, of at most 5 texels of each split's map.
        width_m: Option<f64>,
    },
    /// A tent of seven texels.
    Pcf7 {
        /// Full width in metres, of at most 7 texels of each split's map.
        width_m: Option<f64>,
    },
    /// Castaño's kernel of 5×5 texels, 1, 3, 4, 3, 1 per axis, blended linearly between texels
    /// (\[Castano13\]), as in The Witness. Its width is five texels in every split.
    Castano5,
    /// A disc of 32 bilinear comparisons. Its radius is 3 texels if no width is given.
    Disc {
        /// Full width in metres, of at most 30 texels of each split's map.
        width_m: Option<f64>,
        /// Rotates the kernel per pixel: noise instead of banding.
        rotated: bool,
    },
    /// Percentage-closer soft shadows: a disc as wide as the sun's penumbra, whose width comes from
    /// a search of 32 texels for blockers.
    Pcss {
        /// Angular diameter of the sun in degrees, 0 to 90.
        sun_degrees: f64,
        /// Rotates the kernel per pixel: noise instead of banding.
        rotated: bool,
    },
    /// Moments of depth, blurred before the comparison.
    Moments(Moments),
}

/// A filter that stores moments of depth and blurs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Kind of the moments.
    pub kind: MomentKind,
    /// Full width of the blur across the light in metres, of at most 30 texels of each split's map;
    /// `None` for 8 texels of the finest map.
    pub width_m: Option<f64>,
    /// Depth samples per texel, 1 or 4.
    pub samples: u32,
    /// Share of light that counts as a leak and becomes shadow, 0 to 0.9. A larger share hides more
    /// leaks and widens shadows.
    pub bleeding: f64,
    /// Source of the derivatives that choose the mip level at split borders.
    pub derivatives: Derivatives,
}

impl Moments {
    /// A filter of this kind with all other values at their defaults.
    #[must_use]
    pub const fn new(kind: MomentKind) -> Self {
        Self { kind, width_m: None, samples: 1, bleeding: 0.2, derivatives: Derivatives::Analytic }
    }
}

named! {
    /// Moments of depth that a texel stores.
    pub enum MomentKind as "moment filter" {
        /// An exponential of depth: one moment
        Esm = "esm",
        /// Variance shadow maps: two moments of depth
        #[default]
        Vsm = "vsm",
        /// Variance of an exponential: two moments
        Evsm2 = "evsm2",
        /// Variance of two exponentials: four moments
        Evsm4 = "evsm4",
        /// Moment shadow maps: four moments of depth
        Msm = "msm",
    }
}

named! {
    /// Source of the derivatives by which a moment filter chooses the mip level where neighbouring
    /// pixels use different splits.
    #[non_exhaustive]
    pub enum Derivatives as "source of derivatives" {
        /// By the change of position from pixel to pixel, which no border interrupts
        #[default]
        Analytic = "analytic",
        /// One split for all four pixels of a quad, as in parallel-split variance shadow maps
        Quad = "quad",
    }
}

/// Angular diameter of the sun as seen from the earth, in degrees.
pub const SUN_DEGREES: f64 = 0.53;

/// Reach in texels of a disc without a given width: its radius of 3 and the reach of a tap.
const DISC_REACH: f64 = 4.0;

/// Metres from a surface within which casters give it the full penumbra of the sun; equal
/// to `MOST_BLOCKER_M` of `filter.wesl`.
const MOST_BLOCKER_M: f64 = 200.0;

impl Filter {
    /// Word and help of each filter.
    pub const WORDS: &'static [Word] = &[
        Word { word: "hard", help: "One nearest texel, one comparison" },
        Word { word: "pcf2", help: "One bilinear comparison of 2×2 texels" },
        Word { word: "pcf3", help: "A tent of 3×3 texels" },
        Word { word: "pcf5", help: "A tent of 5×5 texels" },
        Word { word: "pcf7", help: "A tent of 7×7 texels" },
        Word { word: "castano5", help: "Castaño's kernel of 5×5 texels, as in The Witness" },
        Word { word: "disc", help: "A disc of 32 taps" },
        Word { word: "pcss", help: "As wide as the sun's penumbra" },
        Word { word: "esm", help: "An exponential of depth, blurred" },
        Word { word: "vsm", help: "Two moments of depth, blurred" },
        Word { word: "evsm2", help: "Two moments of an exponential, blurred" },
        Word { word: "evsm4", help: "Four moments of two exponentials, blurred" },
        Word { word: "msm", help: "Four moments of depth, blurred" },
    ];

    /// Every filter with its data at the defaults, in the order of [`Filter::WORDS`].
    pub const ALL: [Self; 13] = [
        Self::Hard,
        Self::Pcf2,
        Self::Pcf3 { width_m: None },
        Self::Pcf5 { width_m: None },
        Self::Pcf7 { width_m: None },
        Self::Castano5,
        Self::Disc { width_m: None, rotated: false },
        Self::Pcss { sun_degrees: SUN_DEGREES, rotated: false },
        Self::Moments(Moments::new(MomentKind::Esm)),
        Self::Moments(Moments::new(MomentKind::Vsm)),
        Self::Moments(Moments::new(MomentKind::Evsm2)),
        Self::Moments(Moments::new(MomentKind::Evsm4)),
        Self::Moments(Moments::new(MomentKind::Msm)),
    ];

    /// The filter's word in config files and on the command line.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Hard => "hard",
            Self::Pcf2 => "pcf2",
            Self::Pcf3 { .. } => "pcf3",
            Self::Pcf5 { .. } => "pcf5",
            Self::Pcf7 { .. } => "pcf7",
            Self::Castano5 => "castano5",
            Self::Disc { .. } => "disc",
            Self::Pcss { .. } => "pcss",
            Self::Moments(moments) => moments.kind.word(),
        }
    }

    /// Reach of the filter in texels: the largest distance from the sample at which it reads. Every
    /// map keeps a margin of this size.
    #[must_use]
    pub const fn radius_texels(&self) -> f64 {
        match self {
            Self::Hard => 0.5,
            Self::Pcf2 => 1.0,
            Self::Pcf3 { .. } => 1.5,
            Self::Pcf5 { .. } | Self::Castano5 => 2.5,
            Self::Pcf7 { .. } => 3.5,
            Self::Disc { width_m: None, .. } => DISC_REACH,
            // The widest disc or blur, 15 texels, and the reach of a tap on its rim.
            Self::Disc { width_m: Some(_), .. } | Self::Pcss { .. } | Self::Moments(_) => 16.0,
        }
    }

    /// Half the width of the filter's kernel in metres, if it is known. Maps with large texels keep
    /// a margin of so many metres instead of [`Filter::radius_texels`].
    #[must_use]
    pub fn radius_m(&self) -> Option<f64> {
        match *self {
            Self::Disc { width_m, .. } => width_m.map(|width| 0.5 * width),
            Self::Pcss { sun_degrees, .. } => Some(maths::tan((0.5 * sun_degrees).to_radians()) * MOST_BLOCKER_M),
            _ => None,
        }
    }

    /// The full width in metres, if the filter's width can be chosen and is.
    #[must_use]
    pub const fn width_m(&self) -> Option<f64> {
        match *self {
            Self::Pcf3 { width_m } | Self::Pcf5 { width_m } | Self::Pcf7 { width_m } => width_m,
            Self::Disc { width_m, .. } => width_m,
            Self::Moments(moments) => moments.width_m,
            Self::Hard | Self::Pcf2 | Self::Castano5 | Self::Pcss { .. } => None,
        }
    }

    /// The most texels of a map that the filter's width may take, if the width can be chosen.
    const fn most_texels(&self) -> f64 {
        match self {
            Self::Disc { .. } | Self::Moments(_) => 30.0,
            _ => 2.0 * self.radius_texels(),
        }
    }

    /// The full width in metres that the filter has in a split's map: the chosen one, or as much of
    /// it as the filter reads along the shorter edge of a texel. `None` if no width is chosen.
    #[must_use]
    pub fn width_in(&self, split: &crate::Split) -> Option<f64> {
        self.width_m().map(|width| width.min(self.most_texels() * split.texel_m.min_element()))
    }

    /// Returns whether the filter's width can be chosen.
    #[must_use]
    pub const fn has_width(&self) -> bool {
        !matches!(self, Self::Hard | Self::Pcf2 | Self::Castano5 | Self::Pcss { .. })
    }

    /// The width for writing, if the filter's width can be chosen.
    pub(crate) fn width_mut(&mut self) -> Option<&mut Option<f64>> {
        match self {
            Self::Pcf3 { width_m } | Self::Pcf5 { width_m } | Self::Pcf7 { width_m } => Some(width_m),
            Self::Disc { width_m, .. } => Some(width_m),
            Self::Moments(moments) => Some(&mut moments.width_m),
            Self::Hard | Self::Pcf2 | Self::Castano5 | Self::Pcss { .. } => None,
        }
    }

    /// Number of texels of one map that a fragment reads; 1 for one filtered sample of moments. A
    /// pixel in a blend band reads two maps.
    #[must_use]
    pub const fn texels_read(&self) -> u32 {
        match self {
            Self::Hard | Self::Moments(_) => 1,
            Self::Pcf2 => 4,
            Self::Pcf3 { .. } => 16,
            Self::Pcf5 { .. } | Self::Castano5 => 36,
            Self::Pcf7 { .. } => 64,
            Self::Disc { .. } => 4 * 32,
            Self::Pcss { .. } => 4 * 32 + 32,
        }
    }

    /// Edge in texels of the smallest map in which the filter fits.
    #[must_use]
    pub const fn least_map_size(&self) -> u32 {
        match self {
            Self::Hard => 1,
            Self::Pcf2 => 3,
            Self::Pcf3 { .. } => 4,
            Self::Pcf5 { .. } | Self::Castano5 => 6,
            Self::Pcf7 { .. } => 8,
            Self::Disc { .. } | Self::Pcss { .. } | Self::Moments(_) => 33,
        }
    }

    /// Number of depth samples in a texel of the maps that casters are drawn into.
    #[must_use]
    pub const fn samples(&self) -> u32 {
        match self {
            Self::Moments(moments) => moments.samples,
            _ => 1,
        }
    }

    /// Returns whether maps are converted to moments after casters are drawn and before receivers
    /// are shaded.
    #[must_use]
    pub const fn is_prefiltered(&self) -> bool {
        matches!(self, Self::Moments(_))
    }
}

impl std::str::FromStr for Filter {
    type Err = String;

    /// The filter of this word with its data at the defaults.
    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|filter| filter.word() == text)
            .ok_or_else(|| super::names::unknown("filter", text, Self::WORDS))
    }
}

impl From<&Filter> for FilterReach {
    fn from(filter: &Filter) -> Self {
        Self { radius_texels: filter.radius_texels(), radius_m: filter.radius_m() }
    }
}
