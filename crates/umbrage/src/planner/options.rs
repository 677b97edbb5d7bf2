//! What a planner is given beside a config: what the device and the engine dictate.

use crate::margin::FilterReach;
use crate::{Error, Result, ShadowConfig};

/// What the device and the engine dictate, set once per planner; a [`ShadowConfig`] holds what is a
/// matter of choice.
///
/// ```
/// use umbrage::{FilterReach, Planner, PlannerOptions, ShadowConfig};
///
/// // An engine with a filter of its own, which reads texels up to 2 away from the sample.
/// let reach = FilterReach { radius_texels: 2.0, radius_m: None };
/// let options = PlannerOptions { filter_reach: Some(reach), ..PlannerOptions::default() };
/// let planner = Planner::with_options(&ShadowConfig::default(), options)?;
/// # Ok::<(), umbrage::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannerOptions {
    /// Whether depth is not clipped (`DEPTH_CLIP_CONTROL`): the hardware then clamps casters in
    /// front of the near plane to it, and the near plane may lie at the receivers. Otherwise it
    /// lies in front of the first caster.
    pub depth_clamp: bool,
    /// How far an engine's own filter reaches. `None`: as far as [`ShadowConfig::filter`].
    pub filter_reach: Option<FilterReach>,
    /// Pixels across the picture for [`crate::Planner::plan`]. [`crate::PlanInputs::image_size`] is
    /// a frame's own.
    pub image_size: [u32; 2],
}

impl Default for PlannerOptions {
    /// Depth is clipped, the filter is the config's, the picture has 800 × 600 pixels.
    fn default() -> Self {
        Self { depth_clamp: false, filter_reach: None, image_size: [800, 600] }
    }
}

impl PlannerOptions {
    /// Checks a config and these options for it.
    pub(super) fn check(&self, config: &ShadowConfig) -> Result<()> {
        config.validate()?;
        check_image_size(self.image_size)?;
        self.filter_reach.map_or(Ok(()), |reach| reach.check(&config.map_sizes, config.is_stabilised()))
    }

    /// How far the filter of a config reaches with these options.
    pub(super) fn reach(&self, config: &ShadowConfig) -> FilterReach {
        self.filter_reach.unwrap_or_else(|| FilterReach::from(&config.filter))
    }
}

/// Checks that a picture has pixels.
pub(super) fn check_image_size(image_size: [u32; 2]) -> Result<()> {
    if image_size.contains(&0) {
        return Err(Error::setting("image_size", "the image has no pixels; give a width and a height of 1 or more"));
    }
    Ok(())
}
