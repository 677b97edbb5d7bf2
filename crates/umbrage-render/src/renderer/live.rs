//! Changes between frames: the config, the picture's size, and the view that maps are planned for.

use std::sync::OnceLock;

use umbrage::config::{Layout, Rebuilds};
use umbrage::{ShadowConfig, View};
use umbrage_scene::{Pose, Scene};

use super::{Renderer, dithered_nodes, notes_of};
use crate::casters::Casters;
use crate::contact::Contact;
use crate::forward::{Forward, Shading};
use crate::geometry::{Geometry, SkinnedGeometry};
use crate::names::Names;
use crate::timing::Timer;
use crate::{Error, Result};

impl Renderer {
    /// Returns the config in use.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        self.shadows.config()
    }

    /// Lists the objects that a plan's caster indices refer to, as indices into the pose: the
    /// objects that are drawn into maps, or all objects if maps are kept or the objects are
    /// thousands.
    #[must_use]
    pub fn casters_of(&self, pose: &Pose) -> Vec<usize> {
        self.caster_indices(pose).collect()
    }

    /// Iterates over the objects of [`Renderer::casters_of`].
    pub(super) fn caster_indices(&self, pose: &Pose) -> impl Iterator<Item = usize> {
        (0..pose.objects.len()).filter(|&index| self.is_listed(pose, &pose.objects[index]))
    }

    /// Changes the config. `scene` is the scene that the renderer was made with: it stays on the
    /// device. State of stabilised maps stays where the change does not concern it. Returns the
    /// most expensive rebuild that took place.
    ///
    /// # Errors
    /// As [`Renderer::new`], and [`Error::SlicesOfAnotherView`]. The config is then unchanged.
    pub fn set_config(&mut self, scene: &Scene, config: &ShadowConfig) -> Result<Rebuilds> {
        let gpu = self.gpu.clone();
        let before = self.shadows.config().clone();
        let Some((rebuilds, _)) = before.rebuilds(config) else { return Ok(Rebuilds::Nothing) };
        if self.planned_for.is_some() && config.layout == Layout::Reused {
            return Err(Error::SlicesOfAnotherView);
        }
        let before_edges = self.shadows.maps().edges();
        gpu.guarded("changing the config", || {
            self.shadows.set_config(config)?;
            let (maps, size) = (self.shadows.maps(), self.size);
            if maps.edges().is_exact() != before_edges.is_exact() {
                self.scene = Geometry::of_scene(&gpu, scene, maps.edges())?;
                self.skinned = SkinnedGeometry::of(&gpu, maps.edges())?;
            }
            if rebuilds > Rebuilds::Nothing {
                self.timer = Timer::new(&gpu, maps.map_count());
            }
            if before.look.contact != config.look.contact {
                self.contact = Contact::wanted(&gpu, config, size);
            }
            if rebuilds == Rebuilds::Pipelines {
                let (materials, samples) = (&self.materials, self.samples);
                if !self.casters.suits(maps, config.look.translucent) {
                    self.casters = Casters::new(&gpu, maps, materials, config.look.translucent);
                }
                if !(self.has_any_filter && differ_in_depth_filter(&before, config)) {
                    let named = self.names.entries(&self.scene, Names::BINDING);
                    let with = (self.contact.as_ref(), &named[..]);
                    self.forward = Forward::new(&gpu, maps, materials, samples, with, self.shading, false);
                    self.has_any_filter = false;
                }
                self.probe = OnceLock::new();
                self.shadow_mask = None;
                self.through_mask = None;
                self.dithered_nodes = dithered_nodes(scene, config);
            }
            self.notes = notes_of(&self.shadows, self.contact.as_ref(), &self.timer);
            Ok(rebuilds)
        })
    }

    /// Makes the pipelines of pictures anew for every filter that compares depth, so that no later
    /// change among these filters has to make pipelines. They take longer to make and to run.
    /// Returns whether there is anything to make: with a filter of moments, or with exact edges,
    /// there is not.
    ///
    /// # Errors
    /// [`Error::Device`] or [`Error::OutOfMemory`] if the device fails.
    pub fn make_any_filter(&mut self) -> Result<bool> {
        let maps = self.shadows.maps();
        let is_made = self.has_any_filter || self.shading == Shading::WithoutShadows;
        if is_made || maps.any_filter_receiver_wgsl(2).is_none() {
            return Ok(false);
        }
        let named = self.names.entries(&self.scene, Names::BINDING);
        let with = (self.contact.as_ref(), &named[..]);
        self.forward = self.gpu.guarded("making pipelines", || {
            Ok(Forward::new(&self.gpu, maps, &self.materials, self.samples, with, self.shading, true))
        })?;
        self.has_any_filter = true;
        Ok(true)
    }

    /// Changes the picture's size in pixels. Maps and their stabilisation state stay.
    ///
    /// # Errors
    /// [`Error::ImageSize`] or [`Error::OutOfMemory`]; the size is then unchanged.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        if size == self.size {
            return Ok(());
        }
        let limit = self.gpu.max_texture_edge();
        let [width, height] = size;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::ImageSize { width, height, limit });
        }
        let gpu = self.gpu.clone();
        let config = self.shadows.config();
        self.contact = gpu.guarded("resizing the picture", || Ok(Contact::wanted(&gpu, config, size)))?;
        // Targets are made when a frame wants them.
        (self.picture, self.mask, self.counts, self.size) = (None, None, None, size);
        if let Some(through) = &mut self.through_mask {
            through.forget_picture();
        }
        Ok(())
    }

    /// Plans the maps of all coming frames for this view, whichever view is drawn: the picture then
    /// shows the maps of another eye. `None` plans for the view that is drawn.
    ///
    /// # Errors
    /// [`Error::SlicesOfAnotherView`] if one map is used for one slice of the view after the other.
    pub fn plan_for(&mut self, view: Option<View>) -> Result<()> {
        if view.is_some() && self.layout() == Layout::Reused {
            return Err(Error::SlicesOfAnotherView);
        }
        self.planned_for = view;
        Ok(())
    }
}

/// Returns whether two configs differ in a filter that compares depth, and in nothing else.
fn differ_in_depth_filter(a: &ShadowConfig, b: &ShadowConfig) -> bool {
    let compares = |config: &ShadowConfig| !config.filter.is_prefiltered();
    compares(a) && compares(b) && ShadowConfig { filter: a.filter, ..b.clone() } == *a
}

#[cfg(test)]
mod tests {
    use umbrage::config::{Filter, MomentKind, Moments};

    use super::*;

    #[test]
    fn only_filters_that_compare_depth_share_pipelines() {
        let with = |filter| ShadowConfig { filter, ..ShadowConfig::default() };
        let (hard, tent) = (with(Filter::Hard), with(Filter::Pcf7 { width_m: None }));
        assert!(differ_in_depth_filter(&hard, &tent) && differ_in_depth_filter(&tent, &tent));
        assert!(!differ_in_depth_filter(&hard, &ShadowConfig { far_fade: 0.3, ..tent.clone() }));
        let moments = with(Filter::Moments(Moments::new(MomentKind::Vsm)));
        assert!(!differ_in_depth_filter(&hard, &moments) && !differ_in_depth_filter(&moments, &hard));
    }
}
