//! What a frame's plan is made from.

use super::options::check_image_size;
use crate::bounds::Placed;
use crate::{Aabb, Error, Light, Result, View};

/// What the planner is told each frame.
///
/// ```
/// # use umbrage::{Aabb, DirectionalLight, Frustum, PlanInputs, View};
/// # use umbrage::glam::DVec3;
/// # let view = View::look_at_upright(DVec3::Y, DVec3::X, Frustum::perspective(1.0, 1.5, 0.1, 100.0)?)?;
/// # let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
/// # let boxes = [Aabb::new(DVec3::ZERO, DVec3::ONE)];
/// let inputs = PlanInputs { image_size: [1280, 720], ..PlanInputs::new(&view, sun, &boxes, &boxes) };
/// # Ok::<(), umbrage::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PlanInputs<'a> {
    /// The camera.
    pub view: &'a View,
    /// The light.
    pub light: Light,
    /// World boxes of what throws shadows. A plan's caster indices refer to this list.
    pub casters: &'a [Aabb],
    /// World boxes of what shows shadows; most objects are in both lists. Casters serve as receivers where this list is
    /// empty or none of it is in view.
    pub receivers: &'a [Aabb],
    /// World boxes that hold all that is drawn of the receivers in view and leave less air than the receivers' own:
    /// [`crate::ShadowPlan::casts_into`] then rejects parts of casters that have none of them behind. `None`: not known.
    /// For [`crate::config::Crop::SceneDependent`].
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// Pixels across the picture: a split is widened by one 2×2 pixel quad at its near side.
    pub image_size: [u32; 2],
}

impl<'a> PlanInputs<'a> {
    /// Inputs for a picture of 1920 × 1080 pixels, without receiver clusters.
    #[must_use]
    pub fn new(view: &'a View, light: impl Into<Light>, casters: &'a [Aabb], receivers: &'a [Aabb]) -> Self {
        Self { view, light: light.into(), casters, receivers, receiver_clusters: None, image_size: [1920, 1080] }
    }

    /// Checks what can be wrong with lists and sizes.
    pub(super) fn check(&self) -> Result<()> {
        check_image_size(self.image_size)?;
        check_boxes(self.receiver_clusters.unwrap_or_default(), "receiver_clusters")
    }
}

/// Copies boxes as centres and half extents.
pub(super) fn place(boxes: &[Aabb], list: &'static str, placed: &mut Vec<Placed>) -> Result<()> {
    check_boxes(boxes, list)?;
    placed.clear();
    placed.extend(boxes.iter().map(|&bounds| Placed::from(bounds)));
    Ok(())
}

fn check_boxes(boxes: &[Aabb], list: &'static str) -> Result<()> {
    match boxes.iter().enumerate().find(|(_, bounds)| !bounds.is_accepted()) {
        Some((index, bounds)) => Err(Error::InvalidBounds { list, index, min: bounds.min, max: bounds.max }),
        None => Ok(()),
    }
}
