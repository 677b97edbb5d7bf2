//! The passes of a frame, in the order in which they are recorded: all maps and then the view.
//! Where one map is used for one split after the other, map and view alternate slice by slice.

use umbrage_wgpu::Slice;
use web_time::Instant;

use super::prepare::Prepared;
use super::{Outputs, Renderer};
use crate::capture::Capture;
use crate::draw_list::Drawn;
use crate::forward::Bindings;
use crate::targets::{MaskTarget, PictureTarget, Turn};
use crate::through_mask::ThroughMask;
use crate::timing::Timer;
use crate::{Gpu, Result, waiting};

/// A split's map that is being read back.
pub(crate) struct MapCapture {
    pub split: usize,
    /// Width of the map's layer in texels.
    pub row: u32,
    pub corner: [u32; 2],
    pub capture: Capture,
}

/// Passes and captures of a frame that were recorded.
#[derive(Default)]
pub(crate) struct Recorded {
    /// Each pass over maps: its index, what it drew, and its index among the frame's passes.
    pub map_passes: Vec<(usize, Drawn, usize)>,
    pub view: Drawn,
    pub maps: Vec<MapCapture>,
}

impl Renderer {
    /// Records all passes of a frame, in as many submissions as the clock needs.
    pub(crate) async fn record(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        clock: &mut Clock,
        prepared: &Prepared,
        outputs: Outputs,
    ) -> Result<(Recorded, wgpu::CommandEncoder)> {
        let mut recorded = Recorded::default();
        let (kept_mask, kept_picture, kept_counts) = (self.mask.take(), self.picture.take(), self.counts.take());
        let kept_through = self.through_mask.take();
        let mask = kept_mask.as_ref().filter(|_| outputs.mask);
        let counts = kept_counts.as_ref().filter(|_| outputs.edges);
        let picture = kept_picture.as_ref().filter(|_| outputs.picture);
        if prepared.slices.is_empty() {
            self.draw_maps(&mut encoder, 0..prepared.caster_runs.len(), prepared, &mut recorded);
            if outputs.maps && !prepared.caster_runs.is_empty() {
                for split in 0..self.shadows.frame().plan(0).splits.len() {
                    recorded.maps.push(self.capture(&mut encoder, split)?);
                }
            }
            encoder = clock.after_maps(encoder).await?;
            self.record_depth(&mut encoder, prepared, &mut recorded);
            let contact = self.contact.as_ref().map(|contact| &contact.bind_group);
            let bindings = Bindings { frame: self.forward.bind_group(0), maps: self.shadows.bind_group(), contact };
            if let Some(target) = mask {
                let slot = self.timer.next(1);
                let mut pass = target.begin(&mut encoder, Turn::ONLY, self.timer.timestamp_writes(slot));
                recorded.view += self.timer.counted(&mut pass, slot, |pass| {
                    self.forward.draw_mask(pass, bindings, &self.drawable(), &prepared.solid)
                });
            }
            if let Some(target) = counts {
                let mut pass = target.begin(&mut encoder, Turn::ONLY, None);
                self.forward.draw_counts(&mut pass, bindings, &self.drawable(), &prepared.solid);
            }
            if let Some(target) = picture {
                let through = kept_through.as_ref().filter(|_| prepared.is_through_mask);
                recorded.view += self.record_picture(&mut encoder, target, through, prepared);
            }
        } else {
            self.record_depth(&mut encoder, prepared, &mut recorded);
            let targets = (mask, picture, counts);
            encoder = self.record_slices(encoder, clock, prepared, outputs, targets, &mut recorded).await?;
        }
        (self.mask, self.picture, self.counts) = (kept_mask, kept_picture, kept_counts);
        self.through_mask = kept_through;
        Ok((recorded, encoder))
    }

    /// Records the picture, all of it.
    fn record_picture(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: &PictureTarget,
        through: Option<&ThroughMask>,
        prepared: &Prepared,
    ) -> Drawn {
        let mut all = Drawn::default();
        let turn = match through {
            Some(through) => {
                all += self.record_lit(encoder, through, target, &prepared.solid);
                Turn::OVER_DEPTH
            }
            None => Turn::ONLY,
        };
        let contact = self.contact.as_ref().map(|contact| &contact.bind_group);
        let bindings = Bindings { frame: self.forward.bind_group(0), maps: self.shadows.bind_group(), contact };
        let slot = self.timer.next(1);
        let mut pass = target.begin(encoder, turn, self.timer.timestamp_writes(slot));
        all += self.timer.counted(&mut pass, slot, |pass| {
            let drawable = self.drawable();
            let mut drawn = match through {
                Some(through) => through.draw_solid(pass, bindings, &drawable, &prepared.solid),
                None => self.forward.draw_solid(pass, bindings, &drawable, &prepared.solid),
            };
            self.forward.draw_sky(pass, bindings);
            drawn += self.forward.draw_translucent(pass, bindings, &drawable, &prepared.translucent);
            drawn
        });
        all
    }

    /// Records the picture's depth, for contact shadows.
    fn record_depth(&mut self, encoder: &mut wgpu::CommandEncoder, prepared: &Prepared, recorded: &mut Recorded) {
        if let Some(contact) = &self.contact {
            let slot = self.timer.next(1);
            let mut pass = contact.begin(encoder, self.timer.timestamp_writes(slot));
            recorded.view += self
                .timer
                .counted(&mut pass, slot, |pass| self.forward.draw_depth(pass, &self.drawable(), &prepared.solid));
        }
    }

    /// Records the passes over the maps. Maps of several lights or faces without a caster are
    /// skipped, because they are not read.
    pub(crate) fn draw_maps(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        passes: std::ops::Range<usize>,
        prepared: &Prepared,
        recorded: &mut Recorded,
    ) {
        if self.shadows.frame().is_kept() {
            let due: Vec<usize> = self.shadows.frame().maps().map(|map| map.index()).collect();
            due.into_iter().for_each(|pass| self.record_map(encoder, pass, prepared, recorded));
            return self.shadows.prefilter(encoder);
        }
        let all = prepared.every_map || self.shadows.maps().map_count() == self.shadows.maps().splits();
        for pass in passes.filter(|&pass| all || !prepared.caster_runs[pass].is_empty()) {
            self.record_map(encoder, pass, prepared, recorded);
        }
        if !prepared.caster_runs.is_empty() {
            self.shadows.prefilter(encoder);
        }
    }

    /// Records one pass over the maps.
    fn record_map(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        prepared: &Prepared,
        recorded: &mut Recorded,
    ) {
        let map = self.shadows.frame().map(index);
        let runs = &prepared.caster_runs[index];
        // As many regions as there may be are not timed: there are queries for maps alone.
        if map.is_region() {
            let mut pass = map.begin(encoder);
            let drawn = self.casters.draw(&mut pass, map.bind_group(), &self.drawable(), runs);
            recorded.map_passes.push((index, drawn, usize::MAX));
            return;
        }
        let slot = self.timer.next(self.shadows.maps().passes()[index].views());
        let mut pass = map.begin_timed(encoder, self.timer.timestamp_writes(slot));
        let drawn = self
            .timer
            .counted(&mut pass, slot, |pass| self.casters.draw(pass, map.bind_group(), &self.drawable(), runs));
        recorded.map_passes.push((index, drawn, slot.pass as usize));
    }

    /// Records the copy of a map that is read back.
    fn capture(&self, encoder: &mut wgpu::CommandEncoder, split: usize) -> Result<MapCapture> {
        let texture = self.shadows.maps().map_texture(split);
        // Depth is copied in whole layers only; a smaller map is cut out of its layer afterwards.
        let texels = [texture.width(), texture.height()];
        let (layer, corner) = self.shadows.maps().map_place(split);
        let capture = Capture::record(&self.gpu, encoder, texture, layer, texels)?;
        Ok(MapCapture { split, row: texels[0], corner, capture })
    }

    /// Records multipass: each slice's map and then the objects of the view in that slice, front to
    /// back. Translucent surfaces come afterwards, back to front, and need the maps once more.
    async fn record_slices(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
        clock: &mut Clock,
        prepared: &Prepared,
        outputs: Outputs,
        (mask, picture, counts): (Option<&MaskTarget>, Option<&PictureTarget>, Option<&MaskTarget>),
        recorded: &mut Recorded,
    ) -> Result<wgpu::CommandEncoder> {
        let slices = &prepared.slices;
        let translucent = picture.is_some() && slices.iter().any(|slice| !slice.translucent.is_empty());
        for (i, part) in slices.iter().enumerate() {
            self.record_map(&mut encoder, part.slice.split, prepared, recorded);
            if outputs.maps {
                recorded.maps.push(self.capture(&mut encoder, part.slice.split)?);
            }
            encoder = clock.after_maps(encoder).await?;
            let (first, last) = (i == 0, i + 1 == slices.len());
            if let Some(target) = mask {
                let slot = self.timer.next(1);
                let mut pass = target.begin(
                    &mut encoder,
                    Turn { first, last, has_depth: false },
                    self.timer.timestamp_writes(slot),
                );
                self.set_slice(&mut pass, &part.slice);
                recorded.view += self.timer.counted(&mut pass, slot, |pass| {
                    self.forward.draw_mask(pass, self.bindings(&part.slice), &self.drawable(), &part.solid)
                });
            }
            if let Some(target) = counts {
                let mut pass = target.begin(&mut encoder, Turn { first, last, has_depth: false }, None);
                self.set_slice(&mut pass, &part.slice);
                self.forward.draw_counts(&mut pass, self.bindings(&part.slice), &self.drawable(), &part.solid);
            }
            if let Some(target) = picture {
                let slot = self.timer.next(1);
                let turn = Turn { first, last: last && !translucent, has_depth: false };
                let mut pass = target.begin(&mut encoder, turn, self.timer.timestamp_writes(slot));
                self.set_slice(&mut pass, &part.slice);
                recorded.view += self.timer.counted(&mut pass, slot, |pass| {
                    let drawn =
                        self.forward.draw_solid(pass, self.bindings(&part.slice), &self.drawable(), &part.solid);
                    if last {
                        let [width, height] = self.size.map(|pixels| pixels as f32);
                        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
                        self.forward.draw_sky(pass, self.bindings(&part.slice));
                    }
                    drawn
                });
            }
            encoder = clock.after_view(encoder).await?;
        }
        let (Some(target), true) = (picture, translucent) else { return Ok(encoder) };
        for (i, part) in slices.iter().enumerate().rev() {
            // The farthest slice's map is still there.
            if i + 1 < slices.len() {
                self.record_map(&mut encoder, part.slice.split, prepared, recorded);
                encoder = clock.after_maps(encoder).await?;
            }
            let slot = self.timer.next(1);
            let turn = Turn { first: false, last: i == 0, has_depth: false };
            let mut pass = target.begin(&mut encoder, turn, self.timer.timestamp_writes(slot));
            self.set_slice(&mut pass, &part.slice);
            recorded.view += self.timer.counted(&mut pass, slot, |pass| {
                self.forward.draw_translucent(pass, self.bindings(&part.slice), &self.drawable(), &part.translucent)
            });
            drop(pass);
            encoder = clock.after_view(encoder).await?;
        }
        Ok(encoder)
    }

    fn set_slice(&self, pass: &mut wgpu::RenderPass<'_>, slice: &Slice) {
        let [width, height] = self.size.map(|pixels| pixels as f32);
        let [least, most] = slice.depth_range;
        pass.set_viewport(0.0, 0.0, width, height, least, most);
    }

    fn bindings(&self, slice: &Slice) -> Bindings<'_> {
        Bindings {
            frame: self.forward.bind_group(1 + slice.split),
            maps: self.shadows.maps().slice_bind_group(slice.split),
            contact: self.contact.as_ref().map(|contact| &contact.bind_group),
        }
    }
}

pub(crate) fn new_encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("Renderer::encoder") })
}

/// Submits a frame. The submission is one if the GPU takes the times, or if a wait would take
/// longer than the work; else maps and view are submitted apart with a wait after each.
pub(crate) struct Clock {
    gpu: Gpu,
    by_cpu: bool,
    begun: Instant,
    /// Milliseconds from the beginning to the end of the last submission.
    done_ms: f64,
    shadow_ms: f64,
}

impl Clock {
    pub fn start(gpu: &Gpu, timer: &Timer) -> Self {
        let by_cpu = waiting::BLOCKS && !timer.has_timestamps();
        Self { gpu: gpu.clone(), by_cpu, begun: Instant::now(), done_ms: 0.0, shadow_ms: 0.0 }
    }

    /// Submits commands, waits, and returns the milliseconds since the last time.
    async fn lap(&mut self, encoder: wgpu::CommandEncoder) -> Result<f64> {
        self.gpu.queue.submit([encoder.finish()]);
        waiting::idle(&self.gpu).await?;
        let now = self.begun.elapsed().as_secs_f64() * 1e3;
        Ok(now - std::mem::replace(&mut self.done_ms, now))
    }

    /// Ends the measurement of commands that drew maps.
    pub async fn after_maps(&mut self, encoder: wgpu::CommandEncoder) -> Result<wgpu::CommandEncoder> {
        if !self.by_cpu {
            return Ok(encoder);
        }
        self.shadow_ms += self.lap(encoder).await?;
        Ok(new_encoder(&self.gpu))
    }

    /// Ends the measurement of commands that drew the view, if more maps follow.
    pub async fn after_view(&mut self, encoder: wgpu::CommandEncoder) -> Result<wgpu::CommandEncoder> {
        if !self.by_cpu {
            return Ok(encoder);
        }
        self.lap(encoder).await?;
        Ok(new_encoder(&self.gpu))
    }

    /// Returns the milliseconds of the maps and of the frame, if the CPU measures.
    pub async fn after_all(mut self, encoder: wgpu::CommandEncoder) -> Result<Option<(f64, f64)>> {
        if self.by_cpu {
            self.lap(encoder).await?;
            return Ok(Some((self.shadow_ms, self.done_ms)));
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(None)
    }
}
