//! Choices that exclude others: whether a config makes them, their words, and how to reset them.

use super::{
    Cache, Choice, Coordinates, Crop, DepthFormat, Edges, ExtentSteps, Filter, FitTo, Generation, Layout, LightKind,
    Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Storage, Transition,
};
use crate::Warp;

impl Choice {
    /// Returns whether a config for these lights makes this choice.
    #[must_use]
    pub fn holds(self, config: &ShadowConfig, lights: &[LightKind]) -> bool {
        match self {
            Self::Warp => config.first_warp().is_some(),
            Self::AllWarped => (0..config.splits()).all(|index| config.warp(index) != Warp::None),
            Self::SmallCasters => config.drop_small_casters,
            Self::MapSelection => config.selection == Selection::Map,
            Self::DistanceMetric => config.selection == Selection::Interval(SplitMetric::Distance),
            Self::VisibleRange => config.range == Range::Visible,
            Self::OptimalScheme => config.scheme == SplitScheme::Optimal,
            Self::Band => config.blend() > 0.0,
            Self::MomentFilter => config.filter.is_prefiltered(),
            Self::SunFilter => config.filter.is_prefiltered() || matches!(config.filter, Filter::Pcss { .. }),
            Self::OtherThanPcf3 => !matches!(config.filter, Filter::Pcf3 { .. }),
            Self::ExactEdges => config.edges.is_exact(),
            Self::SeveralSamples => config.filter.samples() > 1,
            Self::ColourMaps => config.depth_format.is_colour(),
            Self::TiledLayers => config.layout == Layout::MixedArray,
            Self::OneMap => config.layout == Layout::Reused,
            Self::NotLayers => config.layout.storage() != Storage::Array,
            Self::NotPerSplit => config.layout.generation() != Generation::PerSplit,
            Self::CubeFaces => config.layout.storage() == Storage::Cube,
            Self::MoreThanSixSplits => config.splits() > 6,
            Self::UnequalSizes => config.map_sizes.windows(2).any(|pair| pair[0] != pair[1]),
            Self::NotStill => config.stability != Stability::Exact,
            Self::ExactlyStill => config.stability == Stability::Exact,
            Self::OtherDepth => config.depth_format != DepthFormat::D32Float,
            Self::KeptMaps => config.cache == Cache::Kept,
            Self::DeferredCoordinates => config.coordinates == Coordinates::Deferred,
            Self::VertexCoordinates => config.coordinates == Coordinates::Vertex,
            Self::MoreThanFourSplits => config.splits() > 4,
            Self::FitToDepth => config.fit_to == FitTo::Depth,
            Self::IntervalSelection => config.selection != Selection::Map,
            Self::SliceCrop => config.crop == Crop::SceneIndependent,
            Self::LocalLight => lights.iter().any(|light| *light != LightKind::Directional),
            Self::SeveralFaces => lights.iter().map(|light| light.faces()).sum::<usize>() > 1,
        }
    }

    /// Settings that make this choice, the most characteristic one first.
    #[must_use]
    pub const fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Warp | Self::AllWarped => &["warp", "technique", "tsm-focus"],
            Self::SmallCasters => &["drop-small-casters"],
            Self::MapSelection => &["selection"],
            Self::DistanceMetric => &["bands"],
            Self::VisibleRange => &["range-fit"],
            Self::OptimalScheme => &["scheme"],
            Self::Band => &["blend", "transition"],
            Self::MomentFilter | Self::SunFilter => &["filter", "msaa", "bleeding", "derivatives"],
            Self::OtherThanPcf3 => &["filter", "sun-angle", "rotate-kernel", "msaa", "bleeding", "derivatives"],
            Self::ExactEdges => &["edges", "edge-samples"],
            Self::SeveralSamples => &["msaa"],
            Self::ColourMaps | Self::OtherDepth => &["depth-format"],
            Self::OneMap | Self::NotLayers | Self::CubeFaces => &["storage", "generation"],
            Self::NotPerSplit | Self::TiledLayers => &["generation", "storage"],
            Self::MoreThanSixSplits | Self::MoreThanFourSplits => &["splits", "map-size", "planes"],
            Self::UnequalSizes => &["map-size"],
            Self::NotStill => &["stabilize", "extent-steps", "extent-levels", "warp", "tsm-focus"],
            Self::ExactlyStill => &["stabilize"],
            Self::KeptMaps => &["cache"],
            Self::DeferredCoordinates | Self::VertexCoordinates => &["coordinates"],
            Self::LocalLight | Self::SeveralFaces => &["light"],
            Self::FitToDepth => &["fit-to"],
            Self::IntervalSelection => &["selection", "bands"],
            Self::SliceCrop => &["fit"],
        }
    }

    /// The choice as `key value`, in the words of a config that makes it.
    #[must_use]
    pub fn say(self, config: &ShadowConfig) -> String {
        match self {
            Self::LocalLight => "light spot or point".to_owned(),
            Self::SeveralFaces => "several lights or faces".to_owned(),
            Self::OneMap => "storage reused (generation multipass)".to_owned(),
            Self::Warp | Self::AllWarped => format!("warp {}", config.first_warp().map_or("none", Warp::word)),
            // Named by what was chosen: splits of the eye's distance are intervals, too.
            Self::IntervalSelection if Self::DistanceMetric.holds(config, &[]) => Self::DistanceMetric.say(config),
            _ => {
                let key = self.keys()[0];
                match super::settings::find(key).and_then(|setting| setting.get(config)) {
                    Some(value) => format!("{key} {value}"),
                    None => key.to_owned(),
                }
            }
        }
    }

    /// Returns whether the choice is made by each light's plan by itself, and not by all maps
    /// together.
    #[must_use]
    pub const fn is_per_light(self) -> bool {
        matches!(
            self,
            Self::Warp
                | Self::MapSelection
                | Self::DistanceMetric
                | Self::OptimalScheme
                | Self::FitToDepth
                | Self::SmallCasters
        )
    }

    /// Resets the choice to a value that excludes nothing. Returns false if there is no such value.
    pub fn relax(self, config: &mut ShadowConfig) -> bool {
        match self {
            Self::Warp | Self::AllWarped => config.stability = Stability::tight(),
            Self::SmallCasters => config.drop_small_casters = false,
            Self::MapSelection | Self::DistanceMetric => config.selection = Selection::VIEW_DEPTH,
            Self::VisibleRange => config.range = Range::Camera,
            Self::OptimalScheme => config.scheme = SplitScheme::practical(),
            Self::Band => config.transition = Transition::Hard,
            Self::MomentFilter | Self::SunFilter | Self::OtherThanPcf3 => {
                config.filter = Filter::Pcf3 { width_m: None };
            }
            Self::ExactEdges => config.edges = Edges::Sampled,
            Self::SeveralSamples => {
                if let Filter::Moments(moments) = &mut config.filter {
                    moments.samples = 1;
                }
            }
            Self::ColourMaps | Self::OtherDepth => config.depth_format = DepthFormat::default(),
            Self::NotStill => config.stability = Stability::Exact,
            Self::ExactlyStill => config.stability = Stability::Approximate { steps: ExtentSteps::default() },
            Self::KeptMaps => config.cache = Cache::Off,
            Self::FitToDepth => config.fit_to = FitTo::Boxes,
            Self::IntervalSelection => config.selection = Selection::Map,
            Self::SliceCrop => config.crop = Crop::SceneDependent,
            Self::OneMap | Self::NotLayers | Self::NotPerSplit | Self::CubeFaces | Self::TiledLayers => {
                config.layout = Layout::Array;
            }
            Self::DeferredCoordinates | Self::VertexCoordinates => config.coordinates = Coordinates::World,
            Self::MoreThanSixSplits
            | Self::UnequalSizes
            | Self::MoreThanFourSplits
            | Self::LocalLight
            | Self::SeveralFaces => return false,
        }
        true
    }
}
