//! Inputs of a frame's plan. The lists are reused, so that steady frames allocate nothing.

use umbrage::{Aabb, Layers, Light, View};
use umbrage_scene::Pose;

use super::{Frame, Renderer};
use crate::cull;
use crate::lamps::Lamp;
use crate::{Error, Result};

/// Inputs of a frame's plan.
#[derive(Default)]
pub(crate) struct Gathered {
    /// Objects that a plan may name as casters, as indices into the pose; empty if the objects are
    /// in a set, which names casters by these indices.
    casters: Vec<usize>,
    /// True if the objects are in a set.
    is_set: bool,
    /// Objects that the view may show, by the view depth of their centres, near ones first.
    pub visible: Vec<usize>,
    pub lamps: Vec<Lamp>,
    pub lights: Vec<Light>,
    /// Boxes of `casters`; empty if the objects are in a set.
    pub caster_boxes: Vec<Aabb>,
    /// Boxes of all objects; empty if the objects are in a set.
    pub receiver_boxes: Vec<Aabb>,
    /// Boxes of the clusters of visible objects.
    clusters: Option<Vec<Aabb>>,
    /// Spare list for `clusters` while it is `None`.
    spare: Vec<Aabb>,
    depths: Vec<(f64, usize)>,
}

impl Gathered {
    /// Returns the object of a caster of a plan.
    pub fn object(&self, caster: u32) -> usize {
        if self.is_set { caster as usize } else { self.casters[caster as usize] }
    }

    pub fn clusters(&self) -> Option<&[Aabb]> {
        self.clusters.as_deref()
    }

    /// Gathers the inputs of a frame's plan. Set `asks_surfaces` if nothing but drawn surfaces
    /// reads the maps, so that parts of objects may be told apart.
    ///
    /// # Errors
    /// [`Error::LampSlots`]; and as `Renderer::follow`.
    pub fn gather(&mut self, renderer: &mut Renderer, frame: &Frame<'_>, asks_surfaces: bool) -> Result<()> {
        let pose = frame.pose;
        renderer.follow(frame)?;
        self.casters.clear();
        self.is_set = renderer.uses_set(pose);
        if !self.is_set {
            self.casters.extend(renderer.caster_indices(pose));
        }
        self.sort_near_to_far(renderer, pose, frame.view);
        self.gather_lamps(frame, renderer.shadows.lights().len())?;
        let mut clusters = self.clusters.take().unwrap_or_else(|| std::mem::take(&mut self.spare));
        clusters.clear();
        if asks_surfaces && renderer.receiver_clusters(pose, &self.visible, &mut clusters) {
            self.clusters = Some(clusters);
        } else {
            self.spare = clusters;
        }
        self.caster_boxes.clear();
        self.receiver_boxes.clear();
        if self.is_set {
            return Ok(());
        }
        self.caster_boxes.extend(self.casters.iter().map(|&object| pose.objects[object].bounds));
        self.receiver_boxes.extend(pose.objects.iter().map(|object| object.bounds));
        Ok(())
    }

    fn gather_lamps(&mut self, frame: &Frame<'_>, made_for: usize) -> Result<()> {
        self.lamps.clear();
        self.lamps.extend([frame.light].into_iter().chain(frame.more_lights.iter().copied()));
        if self.lamps.len() != made_for {
            return Err(Error::LampSlots { frame: self.lamps.len(), renderer: made_for });
        }
        self.lights.clear();
        self.lights.extend(self.lamps.iter().map(|lamp| lamp.light));
        Ok(())
    }

    fn sort_near_to_far(&mut self, renderer: &Renderer, pose: &Pose, view: &View) {
        let Self { depths, is_set, .. } = self;
        depths.clear();
        let mut add = |index: usize| {
            let bounds = &pose.objects[index].bounds;
            if cull::may_be_seen(view, bounds) {
                depths.push((view.view_depth(bounds.center()), index));
            }
        };
        if *is_set {
            let test = |bounds: &Aabb| cull::may_be_seen(view, bounds);
            renderer.world.set.each_receiver(Layers::ALL, test, |key, _| add(key as usize));
        } else {
            (0..pose.objects.len()).for_each(add);
        }
        self.depths.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.visible.clear();
        self.visible.extend(self.depths.iter().map(|&(_, index)| index));
    }
}

#[cfg(test)]
mod tests {
    use umbrage::config::{Cache, Preset, ShadowConfig};
    use umbrage::{DirectionalLight, Frustum, View};
    use umbrage_scene::procedural::World;

    use super::*;
    use crate::{RenderSettings, gpu};

    #[test]
    fn steady_frames_allocate_nothing() {
        let Some(gpu) = gpu::of_tests() else { return };
        let scene = World::MiningTerrain.build();
        let pose = scene.pose(0.0).expect("a pose");
        let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.5, 200.0).expect("a frustum");
        let sun = DirectionalLight::new(glam::DVec3::new(0.3, -1.0, 0.2)).expect("a sun");
        let eye = pose.bounds.expect("a box").center() + glam::DVec3::Y * 20.0;
        let view = View::look_at_upright(eye, eye + glam::DVec3::X, frustum).expect("a view");
        let kept = ShadowConfig { cache: Cache::Kept, ..Preset::Papers.config() };
        for config in [ShadowConfig::default(), kept] {
            let cache = config.cache;
            let settings = RenderSettings { size: [64, 48], config, ..RenderSettings::default() };
            let mut renderer = Renderer::new(&gpu, &scene, &settings).expect("a renderer");
            let frame = Frame {
                pose: &pose,
                moved: None,
                view: &view,
                light: Lamp::from(sun),
                more_lights: &[],
                shadows_on: true,
                tint: false,
            };
            let mut gathered = Gathered::default();
            let mut gather = || gathered.gather(&mut renderer, &frame, true).expect("a frame");
            let first = allocation_counter::measure(&mut gather);
            assert!(first.count_total > 0, "the counter counts");
            let again = allocation_counter::measure(gather);
            assert_eq!(again.count_total, 0, "{cache:?} allocated {again:?}");
            assert!(gathered.clusters().is_some_and(|parts| !parts.is_empty()), "parts are told apart");
        }
    }
}
