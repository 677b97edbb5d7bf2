//! Several lights in one texture and one bind group.

use umbrage::ShadowPlan;
use umbrage_shaders::layout;

use super::ShadowMaps;
use crate::{Error, FrameOptions, Result, ShadowMapsOptions, Storage, uniforms};

/// The edges of all maps: those of `map_sizes` for every face of every light.
pub(super) fn map_sizes(options: &ShadowMapsOptions, limits: &wgpu::Limits) -> Result<Vec<u32>> {
    let (frames, bytes) = (frame_count(options), frame_bytes(options));
    let limit = limits.max_uniform_buffer_binding_size;
    if frames == 0 || bytes > limit {
        return Err(Error::TooManyLights { frames, bytes, limit });
    }
    let splits = options.map_sizes.len();
    if frames > 1 && !matches!(options.storage, Storage::Auto | Storage::Array) {
        return Err(Error::LightsNeedArray { maps: frames * splits, splits, storage: options.storage });
    }
    Ok((0..frames).flat_map(|_| options.map_sizes.iter().copied()).collect())
}

/// How many frames receivers bind: one for each face of each light.
pub(super) fn frame_count(options: &ShadowMapsOptions) -> usize {
    options.lights.iter().map(|slot| slot.faces()).sum()
}

/// Bytes of the frames of all lights.
pub(super) fn frame_bytes(options: &ShadowMapsOptions) -> u64 {
    (frame_count(options) * size_of::<layout::Frame>()) as u64
}

impl ShadowMaps {
    /// As [`ShadowMaps::prepare`], for several lights: a plan for each of [`ShadowMapsOptions::lights`]. All of them are for one view.
    ///
    /// Split `i` of light `l`'s plan is drawn as map `first_map(l) + i`: see [`ShadowMaps::first_map`]. Shaders ask with
    /// `umbrage_visibility_of(l, …)`.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::prepare`]; [`Error::LightCount`] if there is not one plan for each light, [`Error::LightSlot`] if a
    /// point light's plan is in the place of another kind, [`Error::FilterNeedsSun`]. Nothing has been written then.
    pub fn prepare_lights(&mut self, queue: &wgpu::Queue, plans: &[&ShadowPlan], options: &FrameOptions) -> Result<()> {
        let frames = uniforms::frames(plans, &self.options, &self.places, options)?;
        if let (Some(moments), [plan]) = (&mut self.moments, plans) {
            moments.prepare(queue, plan, options)?;
        }
        queue.write_buffer(&self.frame_buffer, 0, bytemuck::cast_slice(&frames));
        let splits = frames.iter().flat_map(|frame| &frame.splits[..self.splits()]);
        for (split, offset) in splits.zip((0..).step_by(self.caster_stride as usize)) {
            queue.write_buffer(&self.caster_buffer, offset, bytemuck::bytes_of(split));
        }
        Ok(())
    }

    /// The map of a light's first split; those of its other splits follow, in the order of its plan.
    ///
    /// # Panics
    /// If there is no such light.
    #[must_use]
    pub fn first_map(&self, light: usize) -> usize {
        assert!(light < self.options.lights.len(), "there are {} lights, no {light}", self.options.lights.len());
        self.splits() * self.options.lights[..light].iter().map(|slot| slot.faces()).sum::<usize>()
    }

    /// The number of maps of all lights together; [`ShadowMaps::splits`] where there is one sun or spot light.
    #[must_use]
    pub fn map_count(&self) -> usize {
        self.splits() * frame_count(&self.options)
    }
}
