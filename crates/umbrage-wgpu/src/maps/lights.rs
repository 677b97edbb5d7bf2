//! Several lights in one texture and one bind group.

use std::borrow::Borrow;

use umbrage::ShadowPlan;
use umbrage::config::{Filter, Layout};
use umbrage_shaders::layout;

use super::ShadowMaps;
use super::slot::Slot;
use crate::{FrameOptions, Result, device, uniforms};

impl ShadowMaps {
    /// [`ShadowMaps::prepare`] for several lights: one plan for each, all of them for one view.
    ///
    /// Split `i` of light `l`'s plan is drawn as map `first_map(l) + i`: see
    /// [`ShadowMaps::first_map`]. Shaders call `umbrage_shadow(query)` with a query whose `light`
    /// is `l`.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::prepare`]; [`crate::Error::LightCount`] if there is not one plan for
    /// each light, [`crate::Error::LightKind`] if a light's maps were made for another kind of
    /// light than its plan's. Nothing has been written then.
    pub fn prepare_lights(
        &mut self,
        queue: &wgpu::Queue,
        plans: &[impl Borrow<ShadowPlan>],
        options: &FrameOptions,
    ) -> Result<()> {
        let frames = uniforms::frames(plans, &self.config, &self.slots, &self.places, options)?;
        let device = self.device.clone();
        device::guarded(&device, "preparing a frame", || self.write(queue, plans, &frames))
    }

    fn write(
        &mut self,
        queue: &wgpu::Queue,
        plans: &[impl Borrow<ShadowPlan>],
        frames: &[layout::Frame],
    ) -> Result<()> {
        if let (Some(moments), [plan], Filter::Moments(filter)) = (&mut self.moments, plans, &self.config.filter) {
            moments.prepare(queue, plan.borrow(), filter)?;
        }
        self.receivers.write(queue, 0, frames)?;
        if self.layout == Layout::Reused {
            for split in 0..self.splits() {
                let slices: Vec<_> =
                    frames.iter().map(|&frame| layout::Frame { slice: split as u32, ..frame }).collect();
                self.receivers.write(queue, 1 + split, &slices)?;
            }
        }
        let of_light = |slot: &Slot| {
            let of_face = |face: usize| frames[slot.first_frame + face].splits.into_iter().take(slot.sizes.len());
            (0..slot.kind.faces()).flat_map(of_face).collect::<Vec<_>>()
        };
        let splits: Vec<layout::Split> = self.slots.iter().flat_map(of_light).collect();
        for (index, pass) in self.passes.iter().enumerate() {
            let here = pass.splits();
            if pass.is_alone() {
                self.casters.write(queue, index, &[splits[here.start]])?;
            } else {
                let uniform = layout::CasterPass {
                    first: here.start as u32,
                    end: here.end as u32,
                    views: pass.views() as u32,
                    splits: frames[0].splits,
                    ..layout::CasterPass::default()
                };
                self.casters.write(queue, index, &[uniform])?;
            }
        }
        Ok(())
    }

    /// Index of the map of a light's first split; the maps of its other splits follow, in the order
    /// of its plan.
    ///
    /// # Panics
    /// If there is no such light.
    #[must_use]
    pub fn first_map(&self, light: usize) -> usize {
        assert!(light < self.slots.len(), "there are {} lights, no {light}", self.slots.len());
        self.slots[light].first_map
    }

    /// Number of maps of all lights together; [`ShadowMaps::splits`] if there is one sun or spot
    /// light.
    #[must_use]
    pub fn map_count(&self) -> usize {
        self.slots.iter().map(Slot::map_count).sum()
    }

    /// Returns whether all maps belong to one light that has one face.
    pub(crate) fn is_of_one_light_and_face(&self) -> bool {
        self.map_count() == self.splits()
    }

    /// Edge of each split's map of a light in texels, nearest split first.
    ///
    /// # Panics
    /// If there is no such light.
    #[must_use]
    pub fn map_sizes(&self, light: usize) -> &[u32] {
        &self.slots[light].sizes
    }

    /// Edge of a map in texels.
    ///
    /// # Panics
    /// If there is no such map.
    #[must_use]
    pub fn map_size(&self, map: usize) -> u32 {
        let (light, split) = self.light_of_map(map);
        let sizes = &self.slots[light].sizes;
        sizes[split % sizes.len()]
    }

    /// Index of the light of a map, and of the split in that light's plan.
    ///
    /// # Panics
    /// If there is no such map.
    #[must_use]
    pub fn light_of_map(&self, map: usize) -> (usize, usize) {
        let light = self.slots.iter().rposition(|slot| slot.first_map <= map).unwrap_or(0);
        let split = map - self.slots[light].first_map;
        assert!(split < self.slots[light].map_count(), "there are {} maps, no {map}", self.map_count());
        (light, split)
    }
}
