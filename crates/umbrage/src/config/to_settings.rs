//! From a config to the settings that [`crate::Planner`] still reads. To be deleted when it reads the config.

use super::{Crop, ExtentSteps, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability};
use crate::{Bands, Fit, RangeFit, ShadowSettings, Stabilize};

impl ShadowConfig {
    /// Settings of the planner. `depth_clamp` says whether the hardware flattens casters before the
    /// near plane onto it, `image_size` is the picture's in pixels.
    #[must_use]
    pub fn planner_settings(&self, depth_clamp: bool, image_size: [u32; 2]) -> ShadowSettings {
        ShadowSettings {
            map_sizes: self.map_sizes.clone(),
            scheme: match &self.scheme {
                SplitScheme::Uniform => crate::SplitScheme::Uniform,
                SplitScheme::Logarithmic => crate::SplitScheme::Logarithmic,
                SplitScheme::Practical { lambda, delta } => {
                    crate::SplitScheme::Practical { lambda: *lambda, delta: delta.clone() }
                }
                SplitScheme::Manual { planes } => crate::SplitScheme::Manual(planes.clone()),
                SplitScheme::Optimal => crate::SplitScheme::Fitted,
            },
            range: match self.range {
                Range::Camera | Range::Visible => None,
                Range::Metres { near, far } => Some((near, far)),
            },
            range_fit: match self.range {
                Range::Visible => RangeFit::Visible,
                Range::Camera | Range::Metres { .. } => RangeFit::Camera,
            },
            fit: match self.crop {
                Crop::SceneDependent => Fit::Dependent,
                Crop::SceneIndependent => Fit::Independent,
            },
            selection: match self.selection {
                Selection::Interval(_) => crate::Selection::Depth,
                Selection::Map => crate::Selection::Map,
            },
            bands: match self.selection {
                Selection::Interval(SplitMetric::Distance) => Bands::Radial,
                Selection::Interval(SplitMetric::ViewDepth) | Selection::Map => Bands::Planar,
            },
            stabilize: match self.stability {
                Stability::Tight { .. } => Stabilize::None,
                Stability::Approximate { steps: ExtentSteps::PerDoubling(count) } => {
                    Stabilize::Approximate(crate::ExtentSteps::PerDoubling(count))
                }
                Stability::Approximate { steps: ExtentSteps::Levels(count) } => {
                    Stabilize::Approximate(crate::ExtentSteps::Levels(count))
                }
                Stability::Exact => Stabilize::Exact,
            },
            warps: match &self.stability {
                Stability::Tight { warps } => warps.clone(),
                Stability::Approximate { .. } | Stability::Exact => Vec::new(),
            },
            filter_radius: self.filter.radius_texels(),
            filter_half_width_m: self.filter.half_width_m(),
            blend: self.blend(),
            far_fade: self.far_fade,
            depth_clamp,
            image_size,
        }
    }
}
