//! The picture's first light through a mask, where that suits.

use super::sight::camera_of;
use super::{Frame, Renderer};
use crate::Result;
use crate::draw_list::Drawn;
use crate::targets::PictureTarget;
use crate::through_mask::{GBuffer, PerPixel, ThroughMask, suits};
use crate::view_list::ViewList;
use glam::DVec3;

impl Renderer {
    /// Makes a mask ready for a picture whose target is there. Returns whether the picture is drawn
    /// through it: a mask does not know which split answered, which tints tell.
    pub(super) fn prepare_lit(&mut self, frame: &Frame<'_>, origin: DVec3) -> Result<bool> {
        let Some(picture) = &self.picture else { return Ok(false) };
        if frame.tint
            || !self.may_mask
            || !suits(&self.gpu, &self.shadows, self.size, (self.samples, self.contact.as_ref(), self.shading))
        {
            return Ok(false);
        }
        let through = match &mut self.through_mask {
            Some(through) => through,
            none => {
                let of = (&self.forward, &self.materials);
                none.insert(ThroughMask::new(&self.gpu, &self.shadows, of, self.samples)?)
            }
        };
        through.prepare(&self.gpu, &camera_of(frame.view, origin), self.size, picture)?;
        Ok(true)
    }

    /// Records the passes of a picture through a mask that come before the picture's own.
    pub(super) fn record_lit(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        through: &ThroughMask,
        picture: &PictureTarget,
        solid: &ViewList,
    ) -> Drawn {
        match through {
            ThroughMask::PerPixel(through) => self.record_per_pixel(encoder, through, picture, solid),
            ThroughMask::GBuffer(through) => self.record_g_buffer(encoder, through, picture, solid),
        }
    }

    /// Records depth and normals of the picture, and the mask that is made of them.
    fn record_per_pixel(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        through: &PerPixel,
        picture: &PictureTarget,
        solid: &ViewList,
    ) -> Drawn {
        let slot = self.timer.next(1);
        let mut pass = through.begin_facing(encoder, picture, self.timer.timestamp_writes(slot));
        let frame = self.forward.bind_group(0);
        let drawn =
            self.timer.counted(&mut pass, slot, |pass| through.draw_facing(pass, frame, &self.drawable(), solid));
        drop(pass);
        let slot = self.timer.next(1);
        let mut pass = through.begin_mask(encoder, self.timer.timestamp_writes(slot));
        self.timer.counted(&mut pass, slot, |pass| through.draw_mask(pass, &self.shadows));
        drawn
    }

    /// Records surfaces without shadows, and a mask for each sample of a pixel.
    fn record_g_buffer(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        through: &GBuffer,
        picture: &PictureTarget,
        solid: &ViewList,
    ) -> Drawn {
        let frame = self.forward.bind_group(0);
        let slot = self.timer.next(1);
        let mut pass = through.begin_surfaces(encoder, picture, self.timer.timestamp_writes(slot));
        let drawn =
            self.timer.counted(&mut pass, slot, |pass| through.draw_surfaces(pass, frame, &self.drawable(), solid));
        drop(pass);
        for sample in 0..self.samples.count() {
            let slot = self.timer.next(1);
            let mut pass = through.begin_asked(encoder, self.timer.timestamp_writes(slot));
            self.timer.counted(&mut pass, slot, |pass| through.draw_asked(pass, frame, sample));
            drop(pass);
            let slot = self.timer.next(1);
            let mut pass = through.begin_mask(encoder, sample, self.timer.timestamp_writes(slot));
            self.timer.counted(&mut pass, slot, |pass| through.draw_mask(pass, frame, &self.shadows, sample));
        }
        drawn
    }
}
