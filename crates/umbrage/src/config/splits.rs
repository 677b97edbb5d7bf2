//! The shadowed range, the planes that divide it, and the rule by which a point selects its split.

use super::names::named;
use crate::bounds::{LEAST_METRES, MOST_METRES};
use crate::{Error, Result};

/// Scheme that places the planes between splits.
///
/// `n` and `f` are the ends of the shadowed range, `m` is the number of splits. Source: \[PSSM06\]
/// section 3.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SplitScheme {
    /// `C_i = n + (f − n) i/m`: slices of equal depth.
    Uniform,
    /// `C_i = n (f/n)^(i/m)`: slices of equal ratio.
    Logarithmic,
    /// `λ C_i^log + (1 − λ) C_i^uni + δ_i`.
    Practical {
        /// Share of the logarithmic scheme, 0 to 1.
        lambda: f64,
        /// Metres added to the inner planes `C_1 .. C_{m−1}`: none, one for all, or one for each.
        /// The source adds δ to all planes, which would move near and far; here it moves the inner
        /// ones.
        delta: Vec<f64>,
    },
    /// Inner planes `C_1 .. C_{m−1}` as view depths in metres, strictly rising.
    Manual {
        /// The planes: one fewer than there are splits.
        planes: Vec<f64>,
    },
    /// The planes of least predicted error, among some forty depths of the view.
    ///
    /// The prediction uses the boxes of casters and receivers, the map sizes and the crop; it
    /// treats warped maps as plain ones. Stabilised maps keep their planes until a set of planes
    /// with an error a third smaller is found; then all planes move in one frame. Needs a
    /// directional light and a scene: [`crate::split_planes`] alone cannot place them. Not from a
    /// paper.
    Optimal,
}

impl SplitScheme {
    /// Word and help of each scheme.
    pub const WORDS: &'static [super::Word] = &[
        super::Word { word: "uniform", help: "Slices of equal depth" },
        super::Word { word: "log", help: "Slices of equal ratio" },
        super::Word { word: "practical", help: "A mix of both, by lambda" },
        super::Word { word: "manual", help: "The planes that are given" },
        super::Word { word: "optimal", help: "The planes of least predicted error" },
    ];

    /// The scheme's word in config files and on the command line.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Logarithmic => "log",
            Self::Practical { .. } => "practical",
            Self::Manual { .. } => "manual",
            Self::Optimal => "optimal",
        }
    }

    /// The practical scheme with the usual mix, λ = 0.5.
    #[must_use]
    pub const fn practical() -> Self {
        Self::Practical { lambda: 0.5, delta: Vec::new() }
    }
}

/// Range of view depths that shadows cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// The camera's near and far planes; far is capped by the receivers and by 1.5 times the depth
    /// of the deepest shadow.
    ///
    /// The near plane of an orthographic camera moves up to the scene. Receivers far beyond all
    /// others are ignored if they together fill less than 0.01 % of the image: they are lit.
    ///
    /// With [`super::Stability::Exact`] far is capped by distance instead of depth, so that turning
    /// does not change it, and rounded up in steps of 9 % that move the last plane only. The inner
    /// planes follow once a view needs √2 times the depth that they were placed for; the range ends
    /// at √2 times that depth at most. While the camera stands still, both return to the choice of
    /// a new planner.
    Camera,
    /// The view depths between which the view shows receivers, by their boxes clipped to the
    /// frustum.
    ///
    /// With [`Range::Camera`], an empty foreground or a tiny near distance would waste splits.
    /// Exactly and approximately stabilised maps move both ends in geometric steps of 19 %, with
    /// hysteresis, and keep them in between. Best with the logarithmic and the optimal scheme
    /// (`docs/notes/fitted-planes.md`).
    Visible,
    /// View depths in metres. Receivers nearer than the first use split 0; receivers beyond the
    /// second are lit.
    Metres {
        /// Begin of the first split.
        near: f64,
        /// End of the last split.
        far: f64,
    },
}

/// Rule by which a point selects its split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Selection {
    /// Interval-based: the split between whose planes the point lies, as in the papers.
    Interval(SplitMetric),
    /// Map-based: the first (finest) split whose map contains the point.
    ///
    /// Shadows are sharper where maps extend beyond their slices, most of all where view and light
    /// are nearly parallel. The list of a map has all casters that can shade a point which the map
    /// covers and no earlier map does. Source: \[PCSM\], "Non-optimized split selection".
    /// Deviations: the test includes the filter's margin and the depth range, and the blend band
    /// lies along the edge of the map.
    Map,
}

impl Selection {
    /// Selection by the planes between splits, which measure view depth.
    pub const VIEW_DEPTH: Self = Self::Interval(SplitMetric::ViewDepth);

    /// Measure of the planes between splits; view depth for [`Selection::Map`].
    #[must_use]
    pub const fn metric(self) -> SplitMetric {
        match self {
            Self::Interval(metric) => metric,
            Self::Map => SplitMetric::ViewDepth,
        }
    }
}

named! {
    /// Measure of the planes between splits.
    ///
    /// By distance, a camera that only turns changes no point's split. All depths of the config and
    /// the plan that are otherwise view depths are then distances, except for
    /// [`crate::Split::coverage`]. Maps grow by the ratio of distance to view depth in the corners
    /// of the view. Distance needs a perspective camera.
    pub enum SplitMetric as "split metric" {
        /// View depth: planes across the line of sight
        #[default]
        ViewDepth = "planar",
        /// Distance from the eye: spheres, which a turning camera leaves alone
        Distance = "radial",
    }
}

/// Transition between neighbouring splits.
///
/// The share refers to the split's depth, or with [`Selection::Map`] to the map's half edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transition {
    /// No band: each point uses one split.
    Hard,
    /// Both splits are sampled in a band and mixed.
    Blend {
        /// Width of the band as a share, above 0 and at most 1.
        share: f64,
    },
    /// Each pixel of a band samples only one of the two splits, chosen by noise: half the samples.
    Dither {
        /// Width of the band as a share, above 0 and at most 1.
        share: f64,
    },
}

impl Transition {
    /// Width of the band as a share; 0 for [`Transition::Hard`].
    #[must_use]
    pub const fn share(self) -> f64 {
        match self {
            Self::Hard => 0.0,
            Self::Blend { share } | Self::Dither { share } => share,
        }
    }
}

/// Checks the two view depths of a range in metres.
pub(crate) fn check_range(near: f64, far: f64) -> Result<()> {
    if !(LEAST_METRES..=MOST_METRES).contains(&near) {
        return Err(Error::setting(
            "shadow-range",
            format!("near is {near}; give a view depth of 10^-9 to 10^12 m, above 0"),
        ));
    }
    if !(far > near && far <= MOST_METRES) {
        return Err(Error::setting(
            "shadow-range",
            format!("far is {far}; give a view depth greater than near ({near}) and at most 10^12 m"),
        ));
    }
    Ok(())
}
