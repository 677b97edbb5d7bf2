//! Pairs of choices that exclude each other, as data: messages, the documented table and the test
//! of all pairs come from this list.

use super::{Choice, Conflict, LightKind, Rule, ShadowConfig};

/// All pairs of choices that exclude each other.
pub const RULES: &[Rule] = &[
    rule(
        Choice::Warp,
        Choice::MapSelection,
        "the first map that contains a point need not be the finest there if maps are warped",
        "use selection depth, or no warp",
    ),
    rule(
        Choice::VisibleRange,
        Choice::DistanceMetric,
        "radial bands do not change while the camera turns, but a visible range does",
        "use range-fit camera, or bands planar",
    ),
    rule(
        Choice::Band,
        Choice::OneMap,
        "there is one map at a time and none to blend with",
        "use transition hard (or blend 0), or another storage",
    ),
    rule(
        Choice::MapSelection,
        Choice::OneMap,
        "there is one map at a time and none to choose from",
        "use selection depth, or another storage",
    ),
    rule(
        Choice::DistanceMetric,
        Choice::OneMap,
        "the picture is drawn in slices of view depth",
        "use bands planar, or another storage",
    ),
    rule(
        Choice::DeferredCoordinates,
        Choice::OneMap,
        "there is one map at a time, and the picture's depth is complete only after the last",
        "use coordinates world, or another storage",
    ),
    rule(
        Choice::NotLayers,
        Choice::MomentFilter,
        "moments are kept as layers of one texture",
        "use storage array, or a filter that compares depth, such as pcf5",
    ),
    rule(
        Choice::Warp,
        Choice::MomentFilter,
        "moments need depth that is linear along the light, which a warped map does not store",
        "use no warp, or a filter that compares depth, such as pcf5",
    ),
    rule(
        Choice::ColourMaps,
        Choice::MomentFilter,
        "moments are made of depth",
        "use depth-format d32f or d16, or a filter that compares depth, such as pcf5",
    ),
    rule(
        Choice::TiledLayers,
        Choice::MomentFilter,
        "moments need a layer for each split",
        "use generation per-split or layered, or a filter that compares depth, such as pcf5",
    ),
    rule(
        Choice::FitToDepth,
        Choice::IntervalSelection,
        "what was not seen has to find the last map, whatever its depth",
        "use selection map, or fit-to boxes",
    ),
    rule(
        Choice::FitToDepth,
        Choice::SliceCrop,
        "maps that hold whole slices of the view have no use for what was seen",
        "use fit dependent, or fit-to boxes",
    ),
    rule(
        Choice::FitToDepth,
        Choice::ExactlyStill,
        "maps that stand exactly still show whole slices of the view, whatever was seen",
        "use stabilize approximate, or fit-to boxes",
    ),
    rule(
        Choice::SmallCasters,
        Choice::AllWarped,
        "texels of a warped map have no one size that a shadow could be smaller than",
        "use no warp, or drop-small-casters off",
    ),
    rule(
        Choice::OtherThanPcf3,
        Choice::ExactEdges,
        "exact edges look at three texels by three, and ask a filter of that size where casters have no name",
        "use filter pcf3, or edges sampled",
    ),
    rule(
        Choice::ColourMaps,
        Choice::ExactEdges,
        "the names of triangles take the place of a map's colour",
        "use depth-format d32f or d16, or edges sampled",
    ),
    rule(
        Choice::SeveralSamples,
        Choice::NotPerSplit,
        "layers of several samples cannot be drawn at once",
        "use msaa 1, or generation per-split",
    ),
    rule(
        Choice::CubeFaces,
        Choice::MoreThanSixSplits,
        "a cube has six faces",
        "use 6 splits at most, or storage array",
    ),
    rule(
        Choice::CubeFaces,
        Choice::UnequalSizes,
        "the faces of a cube have one size",
        "give one size for all maps, or use storage atlas",
    ),
    rule(
        Choice::VertexCoordinates,
        Choice::Warp,
        "coordinates in a warped map need a division per pixel and cannot be interpolated",
        "use coordinates world, or no warp",
    ),
    rule(
        Choice::VertexCoordinates,
        Choice::MoreThanFourSplits,
        "vertex shaders pass on the coordinates of at most 4 splits",
        "use fewer splits, or coordinates world",
    ),
    rule(
        Choice::NotStill,
        Choice::KeptMaps,
        "what is kept needs the fixed grid of exactly stabilised maps",
        "use stabilize exact, or cache off",
    ),
    rule(
        Choice::MapSelection,
        Choice::KeptMaps,
        "a map that is not filled yet passes its slice of view depths on to the next one",
        "use selection depth, or cache off",
    ),
    rule(
        Choice::VisibleRange,
        Choice::KeptMaps,
        "a range that follows the receivers in view changes all maps as the camera turns",
        "use range-fit camera, or cache off",
    ),
    rule(
        Choice::OtherDepth,
        Choice::KeptMaps,
        "16-bit depth needs a range that moves with the view, and colours cannot be copied as depth",
        "use depth-format d32f, or cache off",
    ),
    rule(
        Choice::SeveralSamples,
        Choice::KeptMaps,
        "texels of several samples cannot be copied into a map",
        "use msaa 1, or cache off",
    ),
    rule(
        Choice::NotPerSplit,
        Choice::KeptMaps,
        "each map has regions of its own to draw",
        "use generation per-split, or cache off",
    ),
    rule(
        Choice::KeptMaps,
        Choice::LocalLight,
        "maps of a spot or point light have no grid that outlasts the light's frame",
        "use cache off, or a directional light",
    ),
    rule(
        Choice::KeptMaps,
        Choice::ExactEdges,
        "names of triangles are not kept with the maps",
        "use cache off, or edges sampled",
    ),
    rule(Choice::KeptMaps, Choice::SeveralFaces, "maps are kept for one sun", "use cache off, or one sun"),
    rule(
        Choice::FitToDepth,
        Choice::LocalLight,
        "maps of a local light are fitted to all receivers that it reaches",
        "use fit-to boxes, or a directional light",
    ),
    rule(
        Choice::SmallCasters,
        Choice::LocalLight,
        "texels of a local light grow with the distance, and with them what is small",
        "use drop-small-casters off, or a directional light",
    ),
    rule(
        Choice::Warp,
        Choice::LocalLight,
        "a warp needs light that is parallel in the world",
        "use no warp, or a directional light",
    ),
    rule(
        Choice::MapSelection,
        Choice::LocalLight,
        "maps of a local light lie in its perspective and are chosen by view depth",
        "use selection depth, or a directional light",
    ),
    rule(
        Choice::DistanceMetric,
        Choice::LocalLight,
        "splits of a local light are chosen by view depth",
        "use bands planar, or a directional light",
    ),
    rule(
        Choice::OptimalScheme,
        Choice::LocalLight,
        "optimal planes are chosen for light that is parallel in the world",
        "use scheme log or practical, or a directional light",
    ),
    rule(
        Choice::SunFilter,
        Choice::LocalLight,
        "the filter needs depth that is linear in metres, which only a directional light has",
        "use another filter, such as disc, or a directional light",
    ),
    rule(
        Choice::VertexCoordinates,
        Choice::LocalLight,
        "coordinates in the map of a local light need a division per pixel and cannot be interpolated",
        "use coordinates world, or a directional light",
    ),
    rule(
        Choice::VertexCoordinates,
        Choice::SeveralFaces,
        "vertex shaders pass on the coordinates of one sun only",
        "use coordinates world, or one sun",
    ),
    rule(
        Choice::MomentFilter,
        Choice::SeveralFaces,
        "moments are kept for one sun",
        "use a filter that compares depth, such as pcf5, or one sun",
    ),
    rule(
        Choice::NotLayers,
        Choice::SeveralFaces,
        "several lights and point lights share the layers of one texture",
        "use storage array, or one sun or spot light",
    ),
    rule(
        Choice::NotPerSplit,
        Choice::SeveralFaces,
        "several lights and point lights are drawn one map at a time",
        "use generation per-split, or one sun or spot light",
    ),
];

const fn rule(first: Choice, second: Choice, reason: &'static str, remedy: &'static str) -> Rule {
    Rule { first, second, reason, remedy }
}

impl Rule {
    /// Returns whether a config for these lights makes both choices.
    #[must_use]
    pub fn is_broken_by(&self, config: &ShadowConfig, lights: &[LightKind]) -> bool {
        self.first.holds(config, lights) && self.second.holds(config, lights)
    }

    /// Returns whether the second choice is about lights, which are not part of a config.
    #[must_use]
    pub const fn is_about_lights(&self) -> bool {
        matches!(self.second, Choice::LocalLight | Choice::SeveralFaces)
    }

    /// The rules between kinds of light and choices that each light's plan makes by itself.
    pub(super) fn of_plans() -> impl Iterator<Item = &'static Self> {
        RULES.iter().filter(|rule| rule.is_about_lights() && rule.first.is_per_light())
    }

    /// The conflict in the words of a config that breaks the rule.
    #[must_use]
    pub fn conflict(&self, config: &ShadowConfig) -> Conflict {
        Conflict { rule: *self, first: self.first.say(config), second: self.second.say(config) }
    }
}
