//! Visible surfaces of earlier frames, which maps are fitted to with `fit-to depth`.

use std::collections::BTreeMap;

use glam::DVec3;
use umbrage::config::FitTo;
use umbrage::{Aabb, View};
use umbrage_wgpu::{MaskFrame, SeenDepth};

use super::{Frame, Outputs, Renderer};
use crate::{Result, waiting};

/// Visible surfaces, by view and by the sample count of the depth that they are read from.
#[derive(Default)]
pub(super) struct Sight {
    seen: BTreeMap<(u32, u32), SeenDepth>,
    /// Boxes around the surfaces that this frame's view showed last.
    boxes: Option<Vec<Aabb>>,
    /// Camera of the last extra frame of each view ([`Renderer::look_around`]). Another one from
    /// there would show nothing new.
    looked: BTreeMap<u32, View>,
}

impl Sight {
    pub fn boxes(&self) -> Option<&[Aabb]> {
        self.boxes.as_deref()
    }

    pub fn forget(&mut self) {
        self.boxes = None;
        self.looked.clear();
        self.seen.values_mut().for_each(SeenDepth::forget);
    }
}

impl Renderer {
    /// Returns whether maps are fitted to visible surfaces.
    pub(super) fn fits_to_depth(&self) -> bool {
        self.shadows.config().fit_to == FitTo::Depth
    }

    /// Takes the results of earlier frames of this view.
    pub(super) fn remember(&mut self, view: &View) -> Result<()> {
        self.sight.boxes = None;
        let slot = self.view_slot;
        for (_, seen) in self.sight.seen.range_mut((slot, 0)..=(slot, u32::MAX)) {
            if let Some(boxes) = seen.boxes(view)? {
                self.sight.boxes = Some(boxes.to_vec());
            }
        }
        Ok(())
    }

    /// Draws the frame that a camera at rest would have shown before, if nothing is known of the
    /// view. The requested frame then looks as the next ones will.
    pub(super) async fn look_around(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<()> {
        self.remember(frame.view)?;
        if !self.fits_to_depth() || self.sight.boxes.is_some() || !(outputs.picture || outputs.mask) {
            return Ok(());
        }
        // A view of the sky alone never shows anything.
        if self.sight.looked.insert(self.view_slot, *frame.view) == Some(*frame.view) {
            return Ok(());
        }
        self.render_unguarded(frame, Outputs { maps: false, edges: false, ..outputs }).await?;
        self.remember(frame.view)?;
        // Pictures are waited for here in any case.
        waiting::idle(&self.gpu).await?;
        // Nothing is held of maps that were fitted without it.
        self.shadows.restart_view(self.view_slot);
        self.remember(frame.view)
    }

    /// Records the reading of this frame's depth.
    pub(super) fn look(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        origin: DVec3,
        outputs: Outputs,
    ) -> Result<()> {
        if !self.fits_to_depth() {
            return Ok(());
        }
        let (depth, samples) = match (&self.mask, &self.picture) {
            (Some(mask), _) if outputs.mask => (&mask.depth, 1),
            (_, Some(picture)) if outputs.picture => (&picture.depth, self.samples.count()),
            _ => return Ok(()),
        };
        let seen = match self.sight.seen.entry((self.view_slot, samples)) {
            std::collections::btree_map::Entry::Occupied(entry) => entry.into_mut(),
            std::collections::btree_map::Entry::Vacant(entry) => {
                entry.insert(SeenDepth::new(&self.gpu.device, samples)?)
            }
        };
        seen.reduce(&self.gpu.queue, encoder, depth, &camera_of(view, origin))?;
        Ok(())
    }
}

/// Returns the camera that drew the depth of a view.
pub(super) fn camera_of(view: &View, origin: DVec3) -> MaskFrame {
    MaskFrame {
        clip_from_eye: view.clip_from_relative(view.eye()),
        eye: view.eye(),
        forward: view.forward(),
        origin,
        empty_depth: 0.0,
    }
}
