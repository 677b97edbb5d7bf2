//! Configs by name.

use super::names::named;
use super::{
    Coordinates, Crop, DepthFormat, Fallbacks, Filter, Layout, Look, Range, Selection, ShadowConfig, SplitScheme,
    Stability, Transition,
};

named! {
    /// A config by name, and what it trades.
    pub enum Preset as "preset" {
        /// Fewest texels and samples: 3 maps of 1024² and 2×2 texels a look-up
        Fast = "fast",
        /// The default: sharp near the eye and almost still
        #[default]
        Balanced = "balanced",
        /// The tightest maps in every frame; edges crawl while the camera moves
        Sharp = "sharp",
        /// Static shadows do not change at all, at coarser texels
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
            selection: Selection::default(),
            transition: Transition::Blend { share: 0.1 },
            far_fade: 0.1,
            crop: Crop::SceneDependent,
            stability: Stability::Exact,
            filter: Filter::Pcf3 { width_m: None },
            depth_format: DepthFormat::D32Float,
            layout: Layout::Array,
            fallbacks: Fallbacks::Allow,
            coordinates: Coordinates::World,
            look: Look::default(),
        };
        match self {
            Self::Papers => papers,
            // The next step makes these differ from the papers' settings.
            Self::Balanced | Self::Still => papers,
            Self::Fast => ShadowConfig { map_sizes: vec![1024; 3], filter: Filter::Pcf2, ..papers },
            Self::Sharp => ShadowConfig {
                scheme: SplitScheme::Optimal,
                range: Range::Visible,
                selection: Selection::Map,
                stability: Stability::tight(),
                ..papers
            },
        }
    }
}
