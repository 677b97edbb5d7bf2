//! Fit of each map's rectangle, and its stabilisation.

use super::names::named;
use crate::Warp;

named! {
    /// Region that a map is cropped to. Source: \[GG3-10\] section 10.3.
    ///
    /// A scene-independent map is cropped to the corners of its slice. Its near plane stays at the
    /// scene's, so that no caster in between is lost. A scene-dependent map is cropped to the part
    /// of the receivers in its slice that casters can cast a shadow on. Exactly stabilised maps
    /// have the same rectangle either way; only their depth range and list of casters depend on the
    /// scene.
    #[non_exhaustive]
    pub enum Crop as "crop" {
        /// The slice, its receivers and its casters: scene-dependent
        #[default]
        SceneDependent = "dependent",
        /// The slice alone: scene-independent
        SceneIndependent = "independent",
    }
}

/// Stability of shadows while the camera moves.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stability {
    /// The tightest map in every frame; edges crawl when the camera moves.
    Tight {
        /// Warps that spread the texels of maps: none, one for all maps, or one for each split. A
        /// split gets its plain map where a warp gains nothing: with the light along the view, or
        /// an orthographic camera.
        warps: Vec<Warp>,
    },
    /// The tight rectangle on axes that are fixed to the light, its extent rounded up to steps and
    /// moved in whole texels.
    ///
    /// Maps are sharper than exactly still ones. Static shadows change only in frames in which a
    /// step is taken. Source: \[PCSM\], "Approximated solution".
    Approximate {
        /// The steps of the extent.
        steps: ExtentSteps,
    },
    /// A rectangle that depends on the lens and the scene's bounds alone, moved in whole texels.
    /// Static shadows do not change at all.
    Exact,
}

impl Stability {
    /// Word and help of each kind of stability.
    pub const WORDS: &'static [super::Word] = &[
        super::Word { word: "exact", help: "Static shadows do not change at all" },
        super::Word { word: "approximate", help: "Static shadows change in rare steps; sharper" },
        super::Word { word: "none", help: "The tightest map in every frame; edges crawl" },
    ];

    /// Maps that are tight and not warped.
    #[must_use]
    pub const fn tight() -> Self {
        Self::Tight { warps: Vec::new() }
    }

    /// The kind's word in config files and on the command line.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Tight { .. } => "none",
            Self::Approximate { .. } => "approximate",
            Self::Exact => "exact",
        }
    }
}

/// The steps in which an approximately stabilised map changes its extent.
///
/// Serialised as `{"per_doubling": 24}` or `{"levels": 64}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum ExtentSteps {
    /// Geometric steps of the extent in metres, this many per doubling: 4 to 64. Not from a paper.
    ///
    /// 24 are steps of 2^(1/24), which is 2.9 %. A map is kept for one step of hysteresis, and may
    /// lie along any of 16 directions that are fixed to the light. Finer steps make maps sharper
    /// and are taken more often.
    PerDoubling(u32),
    /// This many equal steps of the unsplit light frustum: 8 to 4096. `s_q = 64 / ceil(64 / s)` for
    /// 64 of them, as in \[PCSM\], Listing 4.1.2, for comparison.
    ///
    /// A near split of a long range uses only the first few levels. The unsplit frustum has to
    /// stand still itself; the source does not say how. Here it is the sphere around the whole
    /// range.
    Levels(u32),
}

impl Default for ExtentSteps {
    fn default() -> Self {
        Self::PerDoubling(24)
    }
}

named! {
    /// Geometry that planes and maps are fitted to.
    #[non_exhaustive]
    pub enum FitTo as "what maps are fitted to" {
        /// The boxes of the receivers in view
        #[default]
        Boxes = "boxes",
        /// The depth of the last frames, if it is handed over; the last map serves the rest
        Depth = "depth",
    }
}
