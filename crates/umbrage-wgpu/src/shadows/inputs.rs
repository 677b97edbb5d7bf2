//! What a frame is prepared from.

use glam::DVec3;
use umbrage::{Aabb, Boxes, CasterSet, Layers, Light, View};

use crate::{Error, Result};

/// What a frame is prepared from. Positions are world metres.
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
    /// One light for each that the maps were made for, in that order.
    pub lights: &'a [Light],
    /// Bounds of what casts shadows. [`crate::ShadowMap::casters`] refers to them by index.
    pub casters: &'a [Aabb],
    /// Bounds of what shows shadows, most casters among them. Where the list is empty, or holds
    /// nothing that is in view, casters serve as receivers.
    pub receivers: &'a [Aabb],
    /// A set that takes the place of both lists, which stay empty then: casters and receivers by
    /// the thousand, kept from frame to frame. [`crate::ShadowMap::casters`] speaks of its casters
    /// by their keys.
    pub set: Option<&'a CasterSet>,
    /// Which members of the set take part: those that are on one of these layers.
    pub layers: Layers,
    /// Bounds that hold all that is drawn of the receivers in view and leave less air than
    /// [`Inputs::receivers`]: [`umbrage::ShadowPlan::casts_into`] then rejects more parts of
    /// casters. `None`: not known.
    pub receiver_clusters: Option<&'a [Aabb]>,
    /// Boxes that hold all that an earlier picture showed ([`umbrage::PlanInputs::seen`]). `None`:
    /// not known.
    pub seen: Option<&'a [Aabb]>,
    /// World point that positions in the application's shaders are relative to. Keep it within a
    /// kilometre or two of the eye and move it in whole steps: static shadows stand still between
    /// two steps.
    pub origin: DVec3,
    /// Pixels of the picture, across and down.
    pub image_size: [u32; 2],
    /// Which of several views this is; 0 where there is one.
    pub view_slot: u32,
    /// Texels of kept maps that may be drawn in this frame; `None`: as many as are missing. A split
    /// that waits for its texels is answered for by the next one, which is coarser.
    pub kept_texels: Option<u64>,
    /// Whether kept maps are drawn anew though they are there: to compare with.
    pub redraws_kept: bool,
    /// Whether there are shadows. Without them there is nothing to draw, every surface that faces a
    /// light is lit, and what stabilised maps hold stays as it was.
    pub enabled: bool,
    /// Whether `umbrage_shadow` returns a debug colour for each split.
    pub tint: bool,
}

impl<'a> Inputs<'a> {
    /// A frame without casters and receivers, of 1920 × 1080 pixels, relative to the world's
    /// origin.
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

    /// Casters and receivers as the planner takes them.
    ///
    /// # Errors
    /// [`Error::SetAndLists`] for lists beside a set: they would be ignored.
    pub(super) fn boxes(&self) -> Result<[Boxes<'a>; 2]> {
        let Some(set) = self.set else { return Ok([self.casters.into(), self.receivers.into()]) };
        match self.casters.len() + self.receivers.len() {
            0 => Ok([set.into(), set.into()]),
            listed => Err(Error::SetAndLists { listed }),
        }
    }
}
