//! Several lights in one texture and one bind group.

use umbrage::ShadowPlan;
use umbrage::config::{Filter, Layout, LightKind, ShadowConfig};
use umbrage_shaders::layout;

use super::ShadowMaps;
use crate::{Error, FrameOptions, LightMaps, Result, device, uniforms};

/// Where one light's maps and frames stand among those of all lights.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Slot {
    pub kind: LightKind,
    /// Edge of each split's map in texels.
    pub sizes: Vec<u32>,
    /// The map of its first split.
    pub first_map: usize,
    /// The frame of its first face.
    pub first_frame: usize,
}

impl Slot {
    /// Those of all lights, after every rule that they share has been checked.
    pub fn all(config: &ShadowConfig, lights: &[LightMaps], limits: &wgpu::Limits) -> Result<Vec<Self>> {
        let kinds: Vec<LightKind> = lights.iter().map(|light| light.kind).collect();
        let (mut slots, mut first_map, mut first_frame) = (Vec::new(), 0, 0);
        for light in lights {
            let sizes = light.map_sizes.as_ref().unwrap_or(&config.map_sizes);
            config.with_map_sizes(sizes).0.validate_shared(&kinds)?;
            slots.push(Self { kind: light.kind, sizes: sizes.clone(), first_map, first_frame });
            first_map += light.kind.faces() * sizes.len();
            first_frame += light.kind.faces();
        }
        let bytes = (first_frame * size_of::<layout::Frame>()) as u64;
        let limit = limits.max_uniform_buffer_binding_size;
        if first_frame == 0 || bytes > limit {
            return Err(Error::TooManyLights { frames: first_frame, bytes, limit });
        }
        Ok(slots)
    }

    /// The edges of its maps, face after face.
    pub fn map_sizes(&self) -> impl Iterator<Item = u32> {
        (0..self.kind.faces()).flat_map(|_| self.sizes.iter().copied())
    }

    /// Number of its maps.
    pub fn map_count(&self) -> usize {
        self.kind.faces() * self.sizes.len()
    }
}

impl ShadowMaps {
    /// [`ShadowMaps::prepare`] for several lights: one plan for each, all of them for one view.
    ///
    /// Split `i` of light `l`'s plan is drawn as map `first_map(l) + i`: see
    /// [`ShadowMaps::first_map`]. Shaders ask with `umbrage_shadow(query)` of a query whose `light`
    /// is `l`.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::prepare`]; [`Error::LightCount`] if there is not one plan for each
    /// light, [`Error::LightKind`] if a light's maps do not serve its plan. Nothing has been
    /// written then.
    pub fn prepare_lights(&mut self, queue: &wgpu::Queue, plans: &[&ShadowPlan], options: &FrameOptions) -> Result<()> {
        let frames = uniforms::frames(plans, &self.config, &self.slots, &self.places, options)?;
        let device = self.device.clone();
        device::guarded(&device, "preparing a frame", || self.write(queue, plans, &frames))
    }

    fn write(&mut self, queue: &wgpu::Queue, plans: &[&ShadowPlan], frames: &[layout::Frame]) -> Result<()> {
        if let (Some(moments), [plan], Filter::Moments(filter)) = (&mut self.moments, plans, &self.config.filter) {
            moments.prepare(queue, plan, filter)?;
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

    /// The map of a light's first split; those of its other splits follow, in the order of its
    /// plan.
    ///
    /// # Panics
    /// If there is no such light.
    #[must_use]
    pub fn first_map(&self, light: usize) -> usize {
        assert!(light < self.slots.len(), "there are {} lights, no {light}", self.slots.len());
        self.slots[light].first_map
    }

    /// The number of maps of all lights together; [`ShadowMaps::splits`] where there is one sun or
    /// spot light.
    #[must_use]
    pub fn map_count(&self) -> usize {
        self.slots.iter().map(Slot::map_count).sum()
    }

    /// Whether all maps are of one light that has one face.
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

    /// The light that a map is of, and the split of that light's plan.
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
