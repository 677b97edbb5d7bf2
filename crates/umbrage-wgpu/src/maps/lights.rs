//! Several lights in one texture and one bind group.

use umbrage::{Selection, ShadowPlan};
use umbrage_shaders::layout;

use super::ShadowMaps;
use crate::{Error, FrameOptions, Generation, Result, ShadowMapsOptions, Storage, Transition, uniforms};

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
    if frames > 1 && options.generation != Generation::PerSplit {
        return Err(Error::ConflictingOptions {
            first: format!("{frames} lights or faces"),
            second: format!("generation {}", options.generation.name()),
            reason: "several lights and point lights are drawn one map at a time; use generation per-split",
        });
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
    /// `umbrage_shadow(query)` of a query whose `light` is `l`.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::prepare`]; [`Error::LightCount`] if there is not one plan for each light, [`Error::LightSlot`] if a
    /// point light's plan is in the place of another kind, [`Error::FilterNeedsSun`]. Nothing has been written then.
    pub fn prepare_lights(&mut self, queue: &wgpu::Queue, plans: &[&ShadowPlan], options: &FrameOptions) -> Result<()> {
        let frames = uniforms::frames(plans, &self.options, &self.places, options)?;
        if self.options.storage == Storage::Reused {
            self.check_alone(plans, options)?;
        }
        if let (Some(moments), [plan]) = (&mut self.moments, plans) {
            moments.prepare(queue, plan, options)?;
        }
        self.receivers.write(queue, 0, &frames);
        if self.options.storage == Storage::Reused {
            for split in 0..self.splits() {
                let slices: Vec<_> =
                    frames.iter().map(|&frame| layout::Frame { slice: split as u32, ..frame }).collect();
                self.receivers.write(queue, 1 + split, &slices);
            }
        }
        let splits: Vec<&layout::Split> = frames.iter().flat_map(|frame| &frame.splits[..self.splits()]).collect();
        for (index, pass) in self.passes.iter().enumerate() {
            let here = pass.splits();
            if pass.is_alone() {
                self.casters.write(queue, index, &[*splits[here.start]]);
            } else {
                let uniform = layout::CasterPass {
                    first: here.start as u32,
                    end: here.end as u32,
                    views: pass.views() as u32,
                    splits: frames[0].splits,
                    ..layout::CasterPass::default()
                };
                self.casters.write(queue, index, &[uniform]);
            }
        }
        Ok(())
    }

    /// One map at a time has nothing to blend with and nothing to choose from.
    fn check_alone(&self, plans: &[&ShadowPlan], options: &FrameOptions) -> Result<()> {
        let blends = |split: &umbrage::Split| split.blend_begin < split.far;
        let inner = |plan: &ShadowPlan| plan.splits.split_last().is_some_and(|(_, inner)| inner.iter().any(blends));
        if plans.iter().any(|plan| plan.selection == Selection::Map) {
            return Err(Error::ConflictingOptions {
                first: "storage reused".to_owned(),
                second: "selection map".to_owned(),
                reason: "there is one map at a time and none to choose from; use umbrage::Selection::Depth or storage array",
            });
        }
        if plans.iter().any(|plan| plan.radial_eye.is_some()) {
            return Err(Error::ConflictingOptions {
                first: "storage reused".to_owned(),
                second: "radial bands".to_owned(),
                reason: "the picture is drawn in slices of view depth; use umbrage::Bands::Planar or storage array",
            });
        }
        if options.transition == Transition::Hard || !plans.iter().any(|plan| inner(plan)) {
            return Ok(());
        }
        Err(Error::ConflictingOptions {
            first: "storage reused".to_owned(),
            second: "a blend band between splits".to_owned(),
            reason: "there is one map at a time and none to blend with; set umbrage::ShadowSettings::blend to 0, or use \
                     Transition::Hard or storage array",
        })
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
