//! All choices about shadows as one value.
//!
//! [`ShadowConfig`] is plain data. Choices that exclude each other inside one field cannot be
//! written; the exclusions that are left between fields are [`RULES`]. Each choice also has a
//! *setting*: a key and words, listed by [`SETTINGS`], which config files, the command line and
//! reports share.

mod apply;
mod budget;
mod choice;
mod conflict;
mod edges;
mod filter;
mod fit;
mod given;
mod layout;
mod light_kind;
mod look;
mod names;
mod presets;
mod renamed;
mod rules;
#[cfg(feature = "serde")]
mod serialize;
mod set;
mod setting;
mod settings;
mod splits;
mod text;
mod words;

pub use budget::Budget;
pub use conflict::{Choice, Conflict, Rule};
pub use edges::Edges;
pub use filter::{Derivatives, Filter, MomentKind, Moments, SUN_DEGREES};
pub use fit::{Crop, ExtentSteps, FitTo, Stability};
pub use given::Given;
pub use layout::{Cache, Coordinates, DepthFormat, Fallbacks, Generation, Layout, Storage};
pub use light_kind::LightKind;
pub use look::{Look, ReceiverBias, Translucent};
pub use names::Word;
pub(crate) use names::{named, unknown};
pub use presets::Preset;
pub use renamed::{RENAMED, Renamed};
pub use rules::RULES;
pub use setting::{Kind, Rebuilds, Setting, Value};
pub use settings::SETTINGS;
pub(crate) use splits::check_range;
pub use splits::{Range, Selection, SplitMetric, SplitScheme, Transition};

use crate::bounds::MOST_METRES;
use crate::margin::FilterReach;
use crate::{Error, MAX_SPLITS, Result, Warp};

/// All choices about shadows.
///
/// The default is [`Preset::Balanced`]. Lengths are in metres and angles in degrees (elsewhere in
/// this crate in radians).
///
/// ```
/// use umbrage::config::{Filter, ShadowConfig};
///
/// let config = ShadowConfig { filter: Filter::Pcf5 { width_m: None }, ..ShadowConfig::default() };
/// assert!(config.validate().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowConfig {
    /// Edge of each split's map in texels, nearest split first: 1 to [`MAX_SPLITS`] entries.
    pub map_sizes: Vec<u32>,
    /// Scheme that places the planes between splits.
    pub scheme: SplitScheme,
    /// The view depths that shadows cover.
    pub range: Range,
    /// Rule by which a point selects its split.
    pub selection: Selection,
    /// Transition between neighbouring splits.
    pub transition: Transition,
    /// Share of the shadowed range, 0 to 1, over which shadows fade to lit at its far end. There is
    /// no fade if nothing is visible beyond the range, for example if the planner ends it with the
    /// receivers ([`Range::Camera`], [`Range::Visible`]).
    pub far_fade: f64,
    /// Region that each map is cropped to.
    pub crop: Crop,
    /// Geometry that planes and maps are fitted to. With [`FitTo::Depth`] and
    /// [`crate::PlanInputs::seen`], all maps but the last serve only the depth that was seen:
    /// geometry hidden by a wall before the camera then takes no texels from visible geometry. A
    /// rule excludes spot and point lights, and exactly stabilised maps, which show whole slices.
    pub fit_to: FitTo,
    /// Stability of shadows while the camera moves.
    pub stability: Stability,
    /// True if the maps of a sun omit casters whose whole shadow is smaller than half a texel along
    /// both axes of the map, split by split. Such a caster covers one texel of the map or none, and
    /// the texel changes with every step of the map. A warped map beside plain ones contains
    /// all casters. A rule excludes spot and point lights, and configs whose maps are all warped.
    pub drop_small_casters: bool,
    /// Filter of the maps.
    pub filter: Filter,
    /// Method that decides where a shadow's edge lies.
    pub edges: Edges,
    /// Format of the maps' texels.
    pub depth_format: DepthFormat,
    /// Storage of maps and the passes that draw them.
    pub layout: Layout,
    /// Cache mode for static casters. Kept maps take about twice the memory and need a
    /// [`crate::CasterSet`], which marks casters as static; those of lists are drawn every frame.
    pub cache: Cache,
    /// Rule for unsupported features.
    pub fallbacks: Fallbacks,
    /// Source of the coordinates at which receivers look up a map.
    pub coordinates: Coordinates,
    /// Look of the shadows.
    pub look: Look,
}

impl Default for ShadowConfig {
    fn default() -> Self {
        Preset::Balanced.config()
    }
}

impl ShadowConfig {
    /// Number of splits.
    #[must_use]
    pub fn splits(&self) -> usize {
        self.map_sizes.len()
    }

    /// Number of texels of all maps of one sun or spot light.
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.map_sizes.iter().map(|&edge| u64::from(edge) * u64::from(edge)).sum()
    }

    /// Bytes of one texel: its depth, and with [`Edges::Exact`] an id of 4 bytes. The depth buffer
    /// beside a colour texture is not counted.
    #[must_use]
    pub const fn texel_bytes(&self) -> u64 {
        let id = match self.edges {
            Edges::Exact { .. } => 4,
            Edges::Sampled => 0,
        };
        self.depth_format.texel_bytes() + id
    }

    /// The warp of split `index`; [`Warp::None`] for stabilised maps.
    #[must_use]
    pub fn warp(&self, index: usize) -> Warp {
        match &self.stability {
            Stability::Tight { warps } => match warps[..] {
                [for_all] => for_all,
                _ => warps.get(index).copied().unwrap_or_default(),
            },
            Stability::Approximate { .. } | Stability::Exact => Warp::None,
        }
    }

    /// The first warp that is not [`Warp::None`].
    #[must_use]
    pub fn first_warp(&self) -> Option<Warp> {
        (0..self.splits()).map(|index| self.warp(index)).find(|warp| *warp != Warp::None)
    }

    /// Returns whether maps keep their texels while the camera moves, exactly or approximately.
    #[must_use]
    pub fn is_stabilised(&self) -> bool {
        !matches!(self.stability, Stability::Tight { .. })
    }

    /// Share of each split over which it blends into the next; 0 for hard borders.
    #[must_use]
    pub fn blend(&self) -> f64 {
        if self.splits() > 1 { self.transition.share() } else { 0.0 }
    }

    /// Checks every field and every rule, for one directional light.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the first setting that is out of range,
    /// [`Error::Conflict`] naming two that exclude each other.
    pub fn validate(&self) -> Result<()> {
        self.validate_for(&[LightKind::Directional])
    }

    /// Checks every field and every rule, for these lights.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the first setting that is out of range,
    /// [`Error::Conflict`] naming two that exclude each other.
    pub fn validate_for(&self, lights: &[LightKind]) -> Result<()> {
        self.check_sizes()?;
        self.check_splits()?;
        self.check_fit()?;
        self.check_filter()?;
        self.check_look()?;
        match self.conflict(lights) {
            Some(conflict) => Err(Error::Conflict(Box::new(conflict))),
            None => Ok(()),
        }
    }

    /// The first rule of [`RULES`] that the config breaks for these lights.
    #[must_use]
    pub fn conflict(&self, lights: &[LightKind]) -> Option<Conflict> {
        RULES.iter().find(|rule| rule.is_broken_by(self, lights)).map(|rule| rule.conflict(self))
    }

    /// The first rule that a plan for this kind of light would break by its own choices.
    pub(crate) fn conflict_of_plan(&self, kind: LightKind) -> Option<Conflict> {
        Rule::of_plans().find(|rule| rule.is_broken_by(self, &[kind])).map(|rule| rule.conflict(self))
    }

    /// Returns whether plans equal those of the other config, but for the reach of filters.
    pub(crate) fn plans_like(&self, other: &Self) -> bool {
        // All fields are named, so that a new one is asked whether plans depend on it.
        let Self {
            map_sizes,
            scheme,
            range,
            selection,
            transition: _,
            far_fade,
            crop,
            fit_to,
            stability,
            drop_small_casters,
            filter: _,
            edges: _,
            depth_format: _,
            layout: _,
            cache,
            fallbacks: _,
            coordinates: _,
            look: _,
        } = self;
        *map_sizes == other.map_sizes
            && *scheme == other.scheme
            && (*range, *selection, *crop) == (other.range, other.selection, other.crop)
            && *fit_to == other.fit_to
            && (self.blend(), *far_fade) == (other.blend(), other.far_fade)
            && (stability, *drop_small_casters) == (&other.stability, other.drop_small_casters)
            && *cache == other.cache
    }

    /// The config for lights of these kinds: settings that exclude such a light are reset. The
    /// second value names them.
    #[must_use]
    pub fn for_lights(&self, lights: &[LightKind]) -> (Self, Vec<String>) {
        let (mut config, mut notes) = (self.clone(), Vec::new());
        for rule in RULES.iter().filter(|rule| rule.is_about_lights()) {
            if rule.is_broken_by(&config, lights) {
                let said = rule.first.say(&config);
                if rule.first.relax(&mut config) {
                    notes.push(format!("{said} is ignored: {}", rule.reason));
                }
            }
        }
        (config, notes)
    }

    /// The config for one light among several. A choice that each light's plan makes by itself, and
    /// that excludes this kind of light, is replaced by the usual one. The second value names the
    /// replaced choices that differ from the default's: the others were made by nobody.
    #[must_use]
    pub fn for_light(&self, kind: LightKind) -> (Self, Vec<String>) {
        let (mut config, mut notes, default) = (self.clone(), Vec::new(), Self::default());
        for rule in Rule::of_plans() {
            if rule.is_broken_by(&config, &[kind]) {
                let said = rule.first.say(&config);
                if rule.first.relax(&mut config) && said != rule.first.say(&default) {
                    notes.push(format!("{said} is ignored for a spot or point light: {}", rule.reason));
                }
            }
        }
        (config, notes)
    }

    /// The config with other maps. Values given for each split or each plane that no longer fit the
    /// number of maps are replaced by the usual choice. The second value names the replaced values.
    #[must_use]
    pub fn with_map_sizes(&self, map_sizes: &[u32]) -> (Self, Vec<String>) {
        let (mut config, mut notes) = (Self { map_sizes: map_sizes.to_vec(), ..self.clone() }, Vec::new());
        let (splits, inner) = (map_sizes.len(), map_sizes.len().saturating_sub(1));
        let mut ignored = |what| notes.push(format!("{what} ignored: given for another number of splits"));
        match &mut config.scheme {
            SplitScheme::Manual { planes } if planes.len() != inner => {
                config.scheme = SplitScheme::practical();
                ignored("planes are");
            }
            SplitScheme::Practical { delta, .. } if delta.len() > 1 && delta.len() != inner => {
                delta.clear();
                ignored("delta is");
            }
            _ => {}
        }
        match &mut config.stability {
            Stability::Tight { warps } if warps.len() > 1 && warps.len() != splits => {
                warps.clear();
                ignored("warps are");
            }
            _ => {}
        }
        (config, notes)
    }

    /// Checks every field, and every rule but those that [`ShadowConfig::for_light`] settles.
    ///
    /// # Errors
    /// Those of [`ShadowConfig::validate_for`].
    pub fn validate_shared(&self, lights: &[LightKind]) -> Result<()> {
        self.validate()?;
        let local = lights.iter().copied().find(|light| light.is_local());
        local.map_or_else(|| self.clone(), |kind| self.for_light(kind).0).validate_for(lights)
    }

    /// The most that a change from this config to another rebuilds, and the setting that requires
    /// it; `None` between equal configs.
    #[must_use]
    pub fn rebuilds(&self, other: &Self) -> Option<(Rebuilds, &'static str)> {
        let changed = SETTINGS.iter().filter(|setting| setting.get(self) != setting.get(other));
        // Of several settings the first in the list is the most telling.
        changed.map(|setting| (setting.rebuilds, setting.key)).rev().max_by_key(|(rebuilds, _)| *rebuilds)
    }

    fn check_sizes(&self) -> Result<()> {
        let splits = self.splits();
        if !(1..=MAX_SPLITS).contains(&splits) {
            return Err(Error::setting("splits", format!("{splits} splits are not possible; give 1 to {MAX_SPLITS}")));
        }
        let margins = FilterReach::from(&self.filter).least_map_size(self.is_stabilised());
        let least = self.filter.least_map_size().max(margins);
        for (split, &size) in self.map_sizes.iter().enumerate() {
            if !(least..=1 << 16).contains(&size) {
                let filter = self.filter.word();
                return Err(Error::setting(
                    "map-size",
                    format!("map {split} is {size} texels wide; give {least} to 65536 with the filter {filter}"),
                ));
            }
        }
        Ok(())
    }

    fn check_splits(&self) -> Result<()> {
        share("blend", self.transition.share(), 1.0)?;
        share("far-fade", self.far_fade, 1.0)?;
        if let Range::Metres { near, far } = self.range {
            check_range(near, far)?;
        }
        let inner = self.splits() - 1;
        match &self.scheme {
            SplitScheme::Uniform | SplitScheme::Logarithmic | SplitScheme::Optimal => Ok(()),
            SplitScheme::Practical { lambda, delta } => {
                share("lambda", *lambda, 1.0)?;
                if !(delta.len() <= 1 || delta.len() == inner) {
                    let count = delta.len();
                    let reason = format!("{count} offsets for {inner} inner planes; give one, or one for each");
                    return Err(Error::setting("delta", reason));
                }
                match delta.iter().find(|offset| !(-MOST_METRES..=MOST_METRES).contains(*offset)) {
                    Some(bad) => Err(Error::setting("delta", format!("{bad} m; give metres within ±10^12"))),
                    None => Ok(()),
                }
            }
            SplitScheme::Manual { planes } if planes.len() != inner => {
                let (count, splits) = (planes.len(), self.splits());
                Err(Error::setting("planes", format!("{count} inner planes for {splits} splits; give {inner}")))
            }
            SplitScheme::Manual { planes } => {
                let rise = planes.iter().all(|plane| plane.is_finite()) && planes.windows(2).all(|p| p[0] < p[1]);
                if rise {
                    return Ok(());
                }
                Err(Error::setting(
                    "planes",
                    format!("{planes:?} are not in ascending order; list the planes from near to far"),
                ))
            }
        }
    }

    fn check_fit(&self) -> Result<()> {
        match &self.stability {
            Stability::Exact => Ok(()),
            Stability::Approximate { steps: ExtentSteps::PerDoubling(count) } => {
                whole("extent-steps", *count, 4, 64, "steps per doubling")
            }
            Stability::Approximate { steps: ExtentSteps::Levels(count) } => {
                whole("extent-levels", *count, 8, 4096, "levels")
            }
            Stability::Tight { warps } => {
                let (count, splits) = (warps.len(), self.splits());
                if !(count <= 1 || count == splits) {
                    let reason = format!("{count} warps for {splits} splits; give none, one for all, or one for each");
                    return Err(Error::setting("warp", reason));
                }
                let focus = warps.iter().find_map(|warp| match *warp {
                    Warp::Tsm { focus } if !(focus > 0.0 && focus < 1.0) => Some(focus),
                    _ => None,
                });
                match focus {
                    Some(focus) => Err(Error::setting(
                        "tsm-focus",
                        format!("{focus} is out of range; give more than 0 and less than 1"),
                    )),
                    None => Ok(()),
                }
            }
        }
    }

    fn check_filter(&self) -> Result<()> {
        if let Some(samples) = self.edges.samples().filter(|samples| !matches!(samples, 1 | 4 | 8)) {
            return Err(Error::setting("edge-samples", format!("{samples} samples are not supported; give 1, 4 or 8")));
        }
        if let Some(width) = self.filter.width_m()
            && !(width > 0.0 && width <= 1e6)
        {
            return Err(Error::setting("filter-width", format!("{width} m; give a width above 0, up to 1000 km")));
        }
        match self.filter {
            Filter::Pcss { sun_degrees, .. } => {
                if (0.0..=90.0).contains(&sun_degrees) {
                    return Ok(());
                }
                Err(Error::setting("sun-angle", format!("{sun_degrees}°; give 0 to 90 degrees")))
            }
            Filter::Moments(Moments { samples, bleeding, .. }) => {
                share("bleeding", bleeding, 0.9)?;
                if matches!(samples, 1 | 4) {
                    return Ok(());
                }
                Err(Error::setting(
                    "msaa",
                    format!("{samples} samples are not supported; give 1 or 4, which every device has"),
                ))
            }
            _ => Ok(()),
        }
    }

    fn check_look(&self) -> Result<()> {
        share("shadow-strength", self.look.strength, 1.0)?;
        self.look.colour.iter().try_for_each(|&part| share("shadow-colour", part, 1.0))
    }
}

/// Checks that a share lies between 0 and `most`.
fn share(key: &'static str, value: f64, most: f64) -> Result<()> {
    if (0.0..=most).contains(&value) {
        Ok(())
    } else {
        Err(Error::setting(key, format!("{value} is out of range; give 0 to {most}")))
    }
}

/// Checks that a count lies within its bounds.
fn whole(key: &'static str, value: u32, least: u32, most: u32, what: &str) -> Result<()> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(Error::setting(key, format!("{value} {what}; give {least} to {most}")))
}
