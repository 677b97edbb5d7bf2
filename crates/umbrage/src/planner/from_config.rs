//! A planner's settings from a [`ShadowConfig`].

use crate::{ShadowConfig, ShadowSettings};

/// What a planner reads of a config. `depth_clamp` is the device's to say and stays off; the picture's size is a frame's.
impl From<&ShadowConfig> for ShadowSettings {
    fn from(config: &ShadowConfig) -> Self {
        config.planner_settings(false, Self::default().image_size)
    }
}
