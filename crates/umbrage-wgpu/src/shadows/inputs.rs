//! Inputs of a frame.

use glam::DVec3;
use umbrage::{Aabb, Boxes, CasterSet, Layers, Light, View};

use crate::{Error, Result};

/// Inputs of a frame. Positions are in world metres.
///
/// ```no_run
/// # use umbrage_wgpu::{Inputs, umbrage::{Aabb, Light, View}};
/// # fn example(view: &View, lights: &[Light], casters: &[Aabb]) {
/// let inputs = Inputs { casters, image_size: [1280, 720], ..Inputs::new(view, lights) };
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// The camera.
    pub view: &'a View,
    /// The lights, in the number and order for which the maps were made.
    pub lights: &'a [Light],
    /// World bounds of the casters. [`crate::ShadowMap::casters`] names them by index.
    pub casters: &'a [Aabb],
    /// World bounds of the receivers, which include most casters. If the list is empty, or nothing
    /// in it is in view, casters serve as receivers.
    pub receivers: &'a [Aabb],
    /// A set that replaces both lists, which are then empty: casters and receivers by the thousand,
    /// kept from frame to frame. [`crate::ShadowMap::casters`] names its casters by their keys.
    pub set: Option<&'a CasterSet>,
    /// Layers of the members of the set that take part.
    pub layers: Layers,
    /// World bounds that enclose all visible parts of the receivers more tightly than
    /// [`Inputs::receivers`]: [`umbrage::ShadowPlan::casts_into`] then rejects more parts of
    /// casters. `None` if not known.
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// World boxes that enclose everything that an earlier image showed
    /// ([`umbrage::PlanInputs::seen`]). `None` if not known.
    pub seen: Option<&'a [Aabb]>,
    /// World point in metres to which positions in the application's shaders are relative. Keep it
    /// within a kilometre or two of the camera and move it in whole steps: static shadows stand
    /// still between two steps.
    pub origin: DVec3,
    /// Width and height of the image in pixels.
    pub image_size: [u32; 2],
    /// Index of the view among several views; 0 if there is one.
    pub view_slot: u32,
    /// Most texels of kept maps that may be drawn in this frame; `None` for all that are missing. A
    /// split that has to wait is served by the next split, which is coarser.
    pub kept_texels: Option<u64>,
    /// True if kept maps are drawn again although they are valid, for comparison.
    pub redraws_kept: bool,
    /// True if there are shadows. Otherwise there is nothing to draw, every surface that faces a
    /// light is lit, and the held state of stabilised maps does not change.
    pub enabled: bool,
    /// True if `umbrage_shadow` returns a debug colour for each split.
    pub tint: bool,
}

impl<'a> Inputs<'a> {
    /// Inputs without casters and receivers, for an image of 1920 × 1080 pixels, relative to the
    /// world's origin.
    #[must_use]
    pub fn new(view: &'a View, lights: &'a [Light]) -> Self {
        Self {
            view,
            lights,
            casters: &[],
            receivers: &[],
            set: None,
            layers: Layers::ALL,
            receiver_clusters: None,
            seen: None,
            origin: DVec3::ZERO,
            image_size: [1920, 1080],
            view_slot: 0,
            kept_texels: None,
            redraws_kept: false,
            enabled: true,
            tint: false,
        }
    }

    /// Casters and receivers in the form that the planner takes.
    ///
    /// # Errors
    /// [`Error::SetAndLists`] for lists beside a set, because they would be ignored.
    pub(super) fn boxes(&self) -> Result<[Boxes<'a>; 2]> {
        let Some(set) = self.set else { return Ok([self.casters.into(), self.receivers.into()]) };
        match self.casters.len() + self.receivers.len() {
            0 => Ok([set.into(), set.into()]),
            listed => Err(Error::SetAndLists { listed }),
        }
    }
}
