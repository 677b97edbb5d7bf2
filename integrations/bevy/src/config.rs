//! What Bevy takes of a config.

use bevy_light::CascadeShadowConfigBuilder;
use umbrage::ShadowConfig;
use umbrage::config::{Cache, Edges, FitTo, Range, Selection, SplitMetric, Stability, Transition};

use crate::Error;

/// Cascades of a light that Bevy's shaders have room for.
const MOST_CASCADES: usize = 4;

/// A setting that Bevy has no place for, and what happens instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ignored {
    /// The setting's key, as in `umbrage::config::SETTINGS`.
    pub setting: &'static str,
    /// What Bevy does instead.
    pub instead: &'static str,
}

/// The most cascades of a light: 4, or 1 where Bevy was built for WebGL2.
#[must_use]
pub fn most_cascades() -> usize {
    // Bevy's limit is a private constant, but its default follows it.
    if CascadeShadowConfigBuilder::default().num_cascades == 1 { 1 } else { MOST_CASCADES }
}

/// A config as Bevy can draw it, with maps of `map_size`² texels, and the settings that were given
/// and have no effect.
///
/// A setting counts as given if it differs from that of [`ShadowConfig::default`].
///
/// ```
/// use umbrage::{ShadowConfig, config::Filter};
///
/// let config = ShadowConfig { filter: Filter::Pcf5 { width_m: None }, ..ShadowConfig::default() };
/// let (_, ignored) = umbrage_bevy::for_bevy(&config, 2048)?;
/// assert_eq!(ignored[0].setting, "filter");
/// # Ok::<(), umbrage_bevy::Error>(())
/// ```
///
/// # Errors
/// [`Error::TooManySplits`]; [`Error::Planner`] for a config that is wrong in itself.
pub fn for_bevy(config: &ShadowConfig, map_size: u32) -> Result<(ShadowConfig, Vec<Ignored>), Error> {
    let (given, most) = (config.splits(), most_cascades());
    if given > most {
        return Err(Error::TooManySplits { given, most });
    }
    config.validate()?;
    let usual = ShadowConfig::default();
    let taken = ShadowConfig {
        map_sizes: vec![map_size; given],
        selection: Selection::Interval(SplitMetric::ViewDepth),
        transition: match config.transition {
            Transition::Dither { share } => Transition::Blend { share },
            other => other,
        },
        fit_to: FitTo::Boxes,
        stability: match config.stability {
            Stability::Tight { .. } => Stability::tight(),
            ref other => other.clone(),
        },
        edges: Edges::Sampled,
        cache: Cache::Off,
        filter: usual.filter,
        depth_format: usual.depth_format,
        layout: usual.layout,
        fallbacks: usual.fallbacks,
        coordinates: usual.coordinates,
        look: usual.look,
        ..config.clone()
    };
    taken.validate()?;
    Ok((taken, ignored(config, map_size)))
}

/// What of a config has no effect.
fn ignored(config: &ShadowConfig, map_size: u32) -> Vec<Ignored> {
    let usual = ShadowConfig::default();
    let is_sized = config.map_sizes.iter().any(|&size| size != map_size && size != usual.map_sizes[0]);
    let is_chosen =
        config.selection != usual.selection && config.selection != Selection::Interval(SplitMetric::ViewDepth);
    let is_dithered = matches!(config.transition, Transition::Dither { .. });
    let is_faded = config.far_fade != usual.far_fade && matches!(config.range, Range::Metres { .. });
    let rows = [
        (is_sized, "map-size", "all maps have the size of the resource DirectionalLightShadowMap"),
        (is_chosen, "selection", "Bevy chooses a cascade by view depth"),
        (is_dithered, "transition", "Bevy blends between cascades"),
        (is_faded, "far-fade", "Bevy's shadows end without a fade"),
        (config.fit_to != usual.fit_to, "fit-to", "cascades are fitted to boxes"),
        (config.first_warp().is_some(), "warp", "Bevy's bias expects maps that are not warped"),
        (config.edges != usual.edges, "edges", "Bevy's maps hold depth alone"),
        (config.cache != usual.cache, "cache", "Bevy draws its maps in every frame"),
        (config.filter != usual.filter, "filter", "the camera's ShadowFilteringMethod decides"),
        (config.depth_format != usual.depth_format, "depth-format", "Bevy's maps are 32-bit floats"),
        (config.layout != usual.layout, "storage", "Bevy keeps its maps in an array"),
        (config.coordinates != usual.coordinates, "coordinates", "Bevy transforms each pixel"),
        (config.look != usual.look, "bias", "the light's shadow_depth_bias and shadow_normal_bias decide"),
    ];
    let given = rows.into_iter().filter(|(is_given, ..)| *is_given);
    given.map(|(_, setting, instead)| Ignored { setting, instead }).collect()
}

#[cfg(test)]
mod tests {
    use umbrage::Warp;
    use umbrage::config::{Preset, SETTINGS};

    use super::*;

    #[test]
    fn the_default_and_what_bevy_can_do_are_taken_without_a_note() {
        for preset in [Preset::Balanced, Preset::Still, Preset::Sharp, Preset::Papers] {
            let (taken, ignored) = for_bevy(&preset.config(), 2048).expect("it is valid");
            assert_eq!(ignored, [], "{preset:?}");
            assert_eq!(taken.map_sizes, [2048; 4]);
            assert_eq!(taken.selection, Selection::Interval(SplitMetric::ViewDepth));
        }
    }

    #[test]
    fn what_bevy_cannot_do_is_named_by_its_key() {
        let usual = ShadowConfig::default();
        let papers = Preset::Papers.config();
        let warps = vec![Warp::Lispsm];
        let cases = [
            ("map-size", ShadowConfig { map_sizes: vec![512, 1024], ..usual.clone() }),
            ("transition", ShadowConfig { transition: Transition::Dither { share: 0.1 }, ..usual.clone() }),
            ("filter", Preset::Fast.config()),
            ("edges", Preset::Exact.config()),
            ("cache", ShadowConfig { cache: Cache::Kept, ..papers.clone() }),
            ("warp", ShadowConfig { stability: Stability::Tight { warps }, ..papers.clone() }),
            ("selection", ShadowConfig { selection: Selection::Interval(SplitMetric::Distance), ..papers }),
        ];
        for (key, config) in cases {
            let (_, ignored) = for_bevy(&config, 1024).unwrap_or_else(|error| panic!("{key}: {error}"));
            assert!(ignored.iter().any(|ignored| ignored.setting == key), "{key}: {ignored:?}");
            for Ignored { setting, .. } in ignored {
                assert!(SETTINGS.iter().any(|row| row.key == setting), "{setting} is no setting");
            }
        }
    }

    #[test]
    fn more_splits_than_cascades_are_refused() {
        let config = ShadowConfig { map_sizes: vec![1024; 5], ..ShadowConfig::default() };
        assert_eq!(for_bevy(&config, 1024), Err(Error::TooManySplits { given: 5, most: 4 }));
        let config = ShadowConfig { far_fade: 7.0, ..ShadowConfig::default() };
        assert!(matches!(for_bevy(&config, 1024), Err(Error::Planner(_))));
    }
}
