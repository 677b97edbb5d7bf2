//! The picture's first light through a mask, where that suits.

use super::sight::camera_of;
use super::{Frame, Renderer};
use crate::Result;
use crate::draw_list::Drawn;
use crate::targets::PictureTarget;
use crate::through_mask::{ThroughMask, suits};
use crate::view_list::ViewList;
use glam::DVec3;

impl Renderer {
    /// Makes a mask ready for a picture whose target is there. Returns whether the picture is drawn
    /// through it: a mask does not know which split answered, which tints tell.
    pub(super) fn prepare_lit(&mut self, frame: &Frame<'_>, origin: DVec3) -> Result<bool> {
        let Some(picture) = &self.picture else { return Ok(false) };
        if frame.tint
            || !self.may_mask
            || !suits(&self.gpu, &self.shadows, (self.samples, self.contact.as_ref(), self.shading))
        {
            return Ok(false);
        }
        let through = match &mut self.through_mask {
            Some(through) => through,
            none => none.insert(ThroughMask::new(&self.gpu, &self.shadows, &self.forward, &self.materials)?),
        };
        through.prepare(&self.gpu, &camera_of(frame.view, origin), self.size, picture)?;
        Ok(true)
    }

    /// Records depth and normals of the picture, and the mask that is made of them.
    pub(super) fn record_lit(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        through: &ThroughMask,
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
}
