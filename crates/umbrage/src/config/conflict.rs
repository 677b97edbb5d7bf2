//! Types of choices that exclude each other. Errors carry them, so this file needs none.

use std::fmt;

/// A choice that excludes others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Choice {
    /// A map that spreads its texels unevenly.
    Warp,
    /// No map that spreads its texels evenly.
    AllWarped,
    /// Maps omit small casters.
    SmallCasters,
    /// A point uses the first map that contains it.
    MapSelection,
    /// Split planes measure the distance from the eye.
    DistanceMetric,
    /// The range follows the receivers in view.
    VisibleRange,
    /// The planes of least predicted error.
    OptimalScheme,
    /// Neighbouring splits are joined in a band.
    Band,
    /// A filter that blurs moments of depth.
    MomentFilter,
    /// A filter that needs depth in metres along parallel light.
    SunFilter,
    /// A filter that is not a tent of three texels.
    OtherThanPcf3,
    /// Triangles that texels name decide where a shadow ends.
    ExactEdges,
    /// Maps have several samples of depth in a texel.
    SeveralSamples,
    /// Maps are colours and not depth.
    ColourMaps,
    /// Layers that hold several maps.
    TiledLayers,
    /// One map is used for one split after the other.
    OneMap,
    /// Maps are not plain layers of one texture.
    NotLayers,
    /// Maps are not drawn one by one.
    NotPerSplit,
    /// Maps are faces of a cube.
    CubeFaces,
    /// More splits than a cube has faces.
    MoreThanSixSplits,
    /// Maps of different sizes.
    UnequalSizes,
    /// Maps that do not stand exactly still.
    NotStill,
    /// Maps that stand exactly still.
    ExactlyStill,
    /// Maps of another format than 32-bit depth.
    OtherDepth,
    /// Maps keep the depth drawn by static casters.
    KeptMaps,
    /// Pixels compute the coordinates of maps from the image's depth.
    DeferredCoordinates,
    /// Vertex shaders compute the coordinates of maps.
    VertexCoordinates,
    /// More splits than vertex shaders pass coordinates for.
    MoreThanFourSplits,
    /// A spot or point light.
    LocalLight,
    /// Several lights, or a light of several faces.
    SeveralFaces,
    /// Maps are fitted to what an earlier frame's depth showed.
    FitToDepth,
    /// A point uses the split of its depth.
    IntervalSelection,
    /// Maps are cropped to slices of the view.
    SliceCrop,
}

impl Choice {
    /// All choices that a rule may name.
    pub const ALL: [Self; 33] = [
        Self::Warp,
        Self::AllWarped,
        Self::SmallCasters,
        Self::MapSelection,
        Self::DistanceMetric,
        Self::VisibleRange,
        Self::OptimalScheme,
        Self::Band,
        Self::MomentFilter,
        Self::SunFilter,
        Self::OtherThanPcf3,
        Self::ExactEdges,
        Self::SeveralSamples,
        Self::ColourMaps,
        Self::TiledLayers,
        Self::OneMap,
        Self::NotLayers,
        Self::NotPerSplit,
        Self::CubeFaces,
        Self::MoreThanSixSplits,
        Self::UnequalSizes,
        Self::NotStill,
        Self::ExactlyStill,
        Self::OtherDepth,
        Self::KeptMaps,
        Self::DeferredCoordinates,
        Self::VertexCoordinates,
        Self::MoreThanFourSplits,
        Self::LocalLight,
        Self::SeveralFaces,
        Self::FitToDepth,
        Self::IntervalSelection,
        Self::SliceCrop,
    ];
}

/// Two choices that exclude each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Rule {
    /// The choice that is reset if neither was given.
    pub first: Choice,
    /// The other choice.
    pub second: Choice,
    /// Reason why they exclude each other.
    pub reason: &'static str,
    /// Remedy.
    pub remedy: &'static str,
}

/// Two settings that exclude each other.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Conflict {
    /// The rule that is broken.
    pub rule: Rule,
    /// The first choice as `key value`.
    pub first: String,
    /// The second choice as `key value`.
    pub second: String,
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rule, first, second } = self;
        write!(f, "{first} and {second} exclude each other: {}; {}", rule.reason, rule.remedy)
    }
}
