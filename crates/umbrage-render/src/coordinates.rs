//! Where pictures and masks take their map coordinates from: both methods of Listing 4.1.4 of \[PCSM\].

use umbrage::{ShadowPlan, ShadowSettings, Warp};
use umbrage_wgpu::{Error, ShadowMaps};

use crate::Result;

/// Where map coordinates are made. Both are exact but for rounding: a sun's plain maps are affine in the position, and interpolation is
/// correct in perspective. Probes know the first alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coordinates {
    /// By each fragment, of its interpolated world position, for the one split that answers.
    #[default]
    World,
    /// By each vertex, for every split; fragments choose among the interpolated ones. One sun, no warps, at most
    /// [`Coordinates::MOST_SPLITS`] splits.
    Split,
}

impl Coordinates {
    /// The most splits of [`Coordinates::Split`].
    pub const MOST_SPLITS: usize = umbrage_wgpu::MAX_COORDINATES;

    /// # Errors
    /// [`Error::ConflictingOptions`] where maps are warped and their coordinates therefore not to be interpolated.
    pub(crate) fn check_settings(self, shadows: &ShadowSettings) -> Result<()> {
        match shadows.warps.iter().find(|warp| **warp != Warp::None) {
            Some(warp) if self == Self::Split => Err(Error::ConflictingOptions {
                first: "coordinates split".to_owned(),
                second: format!("warp {warp:?}").to_lowercase(),
                reason: "the places of a warped map are quotients, which cannot be interpolated; use coordinates world or no warp",
            }
            .into()),
            _ => Ok(()),
        }
    }

    /// # Errors
    /// [`Error::ConflictingOptions`] where the light is not a sun.
    pub(crate) fn check_plan(self, plan: &ShadowPlan) -> Result<()> {
        if self == Self::Split && plan.splits.iter().any(|split| split.warp.is_some()) {
            return Err(Error::ConflictingOptions {
                first: "coordinates split".to_owned(),
                second: "a spot or point light".to_owned(),
                reason: "the places of its map are quotients, which cannot be interpolated; use coordinates world or a sun",
            }
            .into());
        }
        Ok(())
    }

    /// The library's text for the bind group `group`.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::receiver_wgsl_with_coordinates`].
    pub(crate) fn receiver_wgsl(self, maps: &ShadowMaps, group: u32) -> Result<String> {
        Ok(match self {
            Self::World => maps.receiver_wgsl(group),
            Self::Split => maps.receiver_wgsl_with_coordinates(group)?,
        })
    }
}
