//! Options of a planner that the device and the engine dictate.

use crate::margin::FilterReach;
use crate::{Error, Result, ShadowConfig};

/// Options that the device and the engine dictate, set once per planner; a [`ShadowConfig`]
/// contains the free choices.
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
    /// True if depth is not clipped (`DEPTH_CLIP_CONTROL`): the hardware then clamps casters in
    /// front of the near plane to it, and the near plane may lie at the receivers. Otherwise the
    /// near plane lies in front of the first caster.
    pub depth_clamp: bool,
    /// Reach of an engine's own filter; `None` for the reach of [`ShadowConfig::filter`].
    pub filter_reach: Option<FilterReach>,
    /// Size of the image in pixels for [`crate::Planner::plan`]. Other calls take
    /// [`crate::PlanInputs::image_size`] from a frame's inputs.
    pub image_size: [u32; 2],
}

impl Default for PlannerOptions {
    /// Depth is clipped, the filter is the config's, the image has 800 × 600 pixels.
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

    /// Reach of the filter with this config and these options.
    pub(super) fn reach(&self, config: &ShadowConfig) -> FilterReach {
        self.filter_reach.unwrap_or_else(|| FilterReach::from(&config.filter))
    }
}

/// Checks that an image has pixels.
pub(super) fn check_image_size(image_size: [u32; 2]) -> Result<()> {
    if image_size.contains(&0) {
        return Err(Error::setting("image_size", "the image has no pixels; give a width and a height of 1 or more"));
    }
    Ok(())
}
