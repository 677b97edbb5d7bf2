//! Configs by name.

use super::names::named;
use super::{
    Cache, Coordinates, Crop, DepthFormat, Edges, ExtentSteps, Fallbacks, Filter, FitTo, Layout, Look, Range,
    Selection, ShadowConfig, SplitScheme, Stability, Transition,
};

named! {
    /// Preset configs by name, each with its trade-off.
    #[non_exhaustive]
    pub enum Preset as "preset" {
        /// Fewest texels and samples: 3 maps of 1024² and 2×2 texels per lookup
        Fast = "fast",
        /// The default: sharp near the eye and almost still
        #[default]
        Balanced = "balanced",
        /// Edges decided by triangles: the memory of balanced, half the texels, half the error
        Exact = "exact",
        /// The tightest maps in every frame; edges crawl while the camera moves
        Sharp = "sharp",
        /// Exactly still maps, which change in rare steps of the range; coarser than balanced
        Still = "still",
        /// The settings of the papers: λ = 0.5, exactly still, chosen by view depth
        Papers = "papers",
    }
}

impl Preset {
    /// The preset's config.
    #[must_use]
    pub fn config(self) -> ShadowConfig {
        let papers = ShadowConfig {
            map_sizes: vec![1024; 4],
            scheme: SplitScheme::practical(),
            range: Range::Camera,
            selection: Selection::VIEW_DEPTH,
            transition: Transition::Blend { share: 0.1 },
            far_fade: 0.1,
            crop: Crop::SceneDependent,
            fit_to: FitTo::Boxes,
            stability: Stability::Exact,
            drop_small_casters: false,
            filter: Filter::Pcf3 { width_m: None },
            edges: Edges::Sampled,
            depth_format: DepthFormat::D32Float,
            layout: Layout::Array,
            cache: Cache::Off,
            fallbacks: Fallbacks::Allow,
            coordinates: Coordinates::World,
            look: Look::default(),
        };
        // Planes of least predicted error over the depths that are seen, and the finest map that
        // contains a point: the same texels where there is something to see
        // (docs/notes/default.md).
        let balanced = ShadowConfig {
            scheme: SplitScheme::Optimal,
            range: Range::Visible,
            selection: Selection::Map,
            stability: Stability::Approximate { steps: ExtentSteps::PerDoubling(12) },
            ..papers.clone()
        };
        match self {
            Self::Papers => papers,
            Self::Balanced => balanced,
            Self::Fast => ShadowConfig { map_sizes: vec![1024; 3], filter: Filter::Pcf2, ..balanced },
            // Depth and id of 720² texels are the bytes of 1,018² depths.
            Self::Exact => ShadowConfig { map_sizes: vec![720; 4], edges: Edges::exact(), ..balanced },
            Self::Sharp => ShadowConfig { stability: Stability::tight(), ..balanced },
            // A range that follows the view would move its maps with it.
            Self::Still => ShadowConfig { stability: Stability::Exact, range: Range::Camera, ..balanced },
        }
    }
}
