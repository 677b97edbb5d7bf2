//! A planner's settings from a [`ShadowConfig`].

use crate::config::SplitScheme as Scheme;
use crate::config::{Crop, ExtentSteps as Steps, Range, Selection as Choice, ShadowConfig, SplitMetric, Stability};
use crate::{Bands, ExtentSteps, Fit, RangeFit, Selection, ShadowSettings, SplitScheme, Stabilize};

/// What a planner reads of a config. `depth_clamp` is the device's to say and stays off; the picture's size is a frame's.
impl From<&ShadowConfig> for ShadowSettings {
    fn from(config: &ShadowConfig) -> Self {
        let (range, range_fit) = match config.range {
            Range::Camera => (None, RangeFit::Camera),
            Range::Visible => (None, RangeFit::Visible),
            Range::Metres { near, far } => (Some((near, far)), RangeFit::Camera),
        };
        let (selection, bands) = match config.selection {
            Choice::Interval(SplitMetric::ViewDepth) => (Selection::Depth, Bands::Planar),
            Choice::Interval(SplitMetric::Distance) => (Selection::Depth, Bands::Radial),
            Choice::Map => (Selection::Map, Bands::Planar),
        };
        let (stabilize, warps) = match &config.stability {
            Stability::Tight { warps } => (Stabilize::None, warps.clone()),
            Stability::Approximate { steps } => (Stabilize::Approximate(steps_of(*steps)), Vec::new()),
            Stability::Exact => (Stabilize::Exact, Vec::new()),
        };
        Self {
            map_sizes: config.map_sizes.clone(),
            scheme: scheme_of(&config.scheme),
            range,
            range_fit,
            fit: match config.crop {
                Crop::SceneDependent => Fit::Dependent,
                Crop::SceneIndependent => Fit::Independent,
            },
            selection,
            bands,
            stabilize,
            warps,
            filter_radius: config.filter.radius_texels(),
            filter_half_width_m: config.filter.half_width_m(),
            blend: config.blend(),
            far_fade: config.far_fade,
            ..Self::default()
        }
    }
}

fn steps_of(steps: Steps) -> ExtentSteps {
    match steps {
        Steps::PerDoubling(count) => ExtentSteps::PerDoubling(count),
        Steps::Levels(count) => ExtentSteps::Levels(count),
    }
}

fn scheme_of(scheme: &Scheme) -> SplitScheme {
    match scheme {
        Scheme::Uniform => SplitScheme::Uniform,
        Scheme::Logarithmic => SplitScheme::Logarithmic,
        Scheme::Practical { lambda, delta } => SplitScheme::Practical { lambda: *lambda, delta: delta.clone() },
        Scheme::Manual { planes } => SplitScheme::Manual(planes.clone()),
        Scheme::Optimal => SplitScheme::Fitted,
    }
}
