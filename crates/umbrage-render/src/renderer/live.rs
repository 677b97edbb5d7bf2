//! What may change while frames go on: the config, the picture's size, the view that maps are
//! planned for.

use std::sync::OnceLock;

use umbrage::config::{Layout, Rebuilds};
use umbrage::{ShadowConfig, View};
use umbrage_scene::{Pose, Scene};

use super::{Renderer, dithered_nodes, notes_of};
use crate::casters::Casters;
use crate::contact::Contact;
use crate::forward::Forward;
use crate::geometry::{Geometry, SkinnedGeometry};
use crate::names::Names;
use crate::timing::Timer;
use crate::{Error, Result};

impl Renderer {
    /// The config that is carried out.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        self.shadows.config()
    }

    /// What the casters of a plan are indices into: the objects of a pose that are drawn into maps,
    /// by index; all objects where something is kept of maps, or where they are thousands.
    #[must_use]
    pub fn casters_of(&self, pose: &Pose) -> Vec<usize> {
        self.caster_indices(pose).collect()
    }

    /// [`Renderer::casters_of`], one by one.
    pub(super) fn caster_indices(&self, pose: &Pose) -> impl Iterator<Item = usize> {
        (0..pose.objects.len()).filter(|&index| self.is_listed(pose, &pose.objects[index]))
    }

    /// Changes the config; `scene` is the one that the renderer was made with. The scene stays on
    /// the device, and what stabilised maps hold on to stays where the change does not concern it.
    /// Returns what was rebuilt at most.
    ///
    /// # Errors
    /// As [`Renderer::new`], and [`Error::SlicesOfAnotherView`]. The config is then the one of
    /// before.
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
                self.casters = Casters::new(&gpu, maps, materials, config.look.translucent);
                let named = self.names.entries(&self.scene, Names::BINDING);
                let with = (self.contact.as_ref(), &named[..]);
                self.forward = Forward::new(&gpu, maps, materials, samples, with, self.shading);
                self.probe = OnceLock::new();
                self.shadow_mask = None;
                self.dithered_nodes = dithered_nodes(scene, config);
            }
            self.notes = notes_of(&self.shadows, self.contact.as_ref(), &self.timer);
            Ok(rebuilds)
        })
    }

    /// Changes the picture's size in pixels. Maps, and what they hold on to, stay.
    ///
    /// # Errors
    /// [`Error::ImageSize`] or [`Error::OutOfMemory`]; the size is then the one of before.
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
        Ok(())
    }

    /// Plans the maps of all coming frames for this view, whatever view is drawn: its maps as
    /// another eye sees them. `None`: for the view that is drawn.
    ///
    /// # Errors
    /// [`Error::SlicesOfAnotherView`] where one map is used for slice after slice of the view.
    pub fn plan_for(&mut self, view: Option<View>) -> Result<()> {
        if view.is_some() && self.layout() == Layout::Reused {
            return Err(Error::SlicesOfAnotherView);
        }
        self.planned_for = view;
        Ok(())
    }
}
