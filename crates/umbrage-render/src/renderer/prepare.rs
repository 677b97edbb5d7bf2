//! From a scene at one moment to what is recorded: the plan, and who is drawn where.

use glam::DVec3;
use umbrage::{Aabb, Light, View};
use umbrage_scene::{AlphaMode, Pose};
use umbrage_wgpu::{Inputs, Slice};
use web_time::Instant;

use super::{Frame, Renderer};
use crate::draw_list::{Run, once};
use crate::forward::FrameUniform;
use crate::geometry::check_object;
use crate::lamps::Lamp;
use crate::names::Names;
use crate::view_list::ViewList;
use crate::{Error, Result, cull};

/// The frame's origin moves in steps of this many metres, so that positions near the eye are exact
/// to a tenth of a millimetre in `f32` and yet stay the same from frame to frame, which is what
/// keeps stabilised maps still.
const ORIGIN_STEP: f64 = 1024.0;

/// A frame that is planned and uploaded, ready to be recorded.
pub(crate) struct Prepared {
    pub origin: DVec3,
    pub plan_ms: f64,
    /// What each pass over the maps draws; none where shadows are off.
    pub caster_runs: Vec<Vec<Run>>,
    pub solid: ViewList,
    pub translucent: Vec<Run>,
    /// The view's slices, where it is drawn slice by slice.
    pub slices: Vec<SliceRuns>,
    pub objects_in_view: usize,
    /// Whether maps without casters are cleared too: nobody reads those of several lights or
    /// faces, but they may be wanted as pictures.
    pub every_map: bool,
}

/// What lies in one slice of the view.
pub(crate) struct SliceRuns {
    pub slice: Slice,
    pub solid: ViewList,
    pub translucent: Vec<Run>,
}

impl Renderer {
    /// Plans, uploads what moves, and sorts what is to be drawn. With `surfaces_alone` nothing but
    /// what is drawn asks the maps.
    pub(crate) fn prepare(&mut self, frame: &Frame<'_>, surfaces_alone: bool) -> Result<Prepared> {
        let pose = frame.pose;
        for (index, object) in pose.objects.iter().enumerate() {
            check_object(index, object, self.scene.meshes.len())?;
        }
        let view = frame.view;
        let origin = (view.eye() / ORIGIN_STEP).round() * ORIGIN_STEP;
        let caster_objects = self.casters_of(pose);
        let visible = near_to_far(pose, view);
        let asks_surfaces =
            surfaces_alone && frame.shadows_on && frame.more_lights.is_empty() && self.planned_for.is_none();
        let clusters = if asks_surfaces { self.receiver_clusters(pose, &caster_objects, &visible) } else { None };
        let lamps: Vec<Lamp> = [frame.light].into_iter().chain(frame.more_lights.iter().copied()).collect();

        let plan_ms = self.plan(frame, origin, (&caster_objects, clusters.as_deref()), &lamps)?;
        self.skinned.update(&self.gpu, &self.scene_meshes, pose)?;
        let slices = self.write_cameras(view, &lamps, origin)?;
        self.timer.restart();

        let occluders = self.shadows.occluders();
        let (first_ids, is_moved) = self.names.update(&self.gpu, occluders, &self.scene, pose, origin)?;
        if is_moved {
            self.forward.bind(&self.gpu, &self.names.entries(&self.scene, Names::BINDING));
        }
        self.instances.clear(first_ids);
        let caster_runs = self.caster_runs(frame, origin, &caster_objects);
        let grouped = self.instances.grouped(pose, origin, false, visible.iter().copied().map(once));
        let solid = ViewList::new(&self.drawable(), pose, view, &grouped);
        let far_to_near = self.with_translucent_parts(pose, visible.iter().rev().copied());
        let translucent = self.instances.ordered(pose, origin, far_to_near.iter().copied());
        let slices = self.slice_runs(slices, frame, origin, (&visible, &far_to_near));
        self.instances.upload(&self.gpu)?;
        Ok(Prepared {
            origin,
            plan_ms,
            caster_runs,
            solid,
            translucent,
            slices,
            objects_in_view: visible.len(),
            every_map: false,
        })
    }

    /// Plans the maps of a frame. `casting` is the objects that are drawn into maps, and the boxes
    /// of what may ask them, where that is known. Milliseconds that it took.
    fn plan(
        &mut self,
        frame: &Frame<'_>,
        origin: DVec3,
        casting: (&[usize], Option<&[Aabb]>),
        lamps: &[Lamp],
    ) -> Result<f64> {
        let (caster_objects, receiver_clusters) = casting;
        let made_for = self.shadows.lights().len();
        if lamps.len() != made_for {
            return Err(Error::LampSlots { frame: lamps.len(), renderer: made_for });
        }
        let [casters, receivers] = self.listed_boxes(frame.pose, caster_objects)?;
        let lights: Vec<Light> = lamps.iter().map(|lamp| lamp.light).collect();
        let planned_for = self.planned_for.unwrap_or(*frame.view);
        let begun = Instant::now();
        let inputs = Inputs {
            casters: &casters,
            receivers: &receivers,
            set: self.keeps_maps().then_some(&self.world.set),
            kept_texels: self.kept.texels,
            redraws_kept: self.kept.redraws,
            receiver_clusters,
            origin,
            image_size: self.size,
            view_slot: self.view_slot,
            enabled: frame.shadows_on,
            tint: frame.tint,
            ..Inputs::new(&planned_for, &lights)
        };
        self.shadows.prepare(&self.gpu.queue, &inputs)?;
        Ok(begun.elapsed().as_secs_f64() * 1e3)
    }

    /// Writes the cameras of the view and of its slices, which are returned.
    fn write_cameras(&mut self, view: &View, lamps: &[Lamp], origin: DVec3) -> Result<Vec<Slice>> {
        self.forward.prepare(&self.gpu, 0, &FrameUniform::new(view, lamps, origin, None)?);
        if let Some(contact) = &self.contact {
            contact.prepare(&self.gpu, view, origin)?;
        }
        let slices = self.shadows.frame().slices(view);
        for slice in &slices {
            let uniform = FrameUniform::new(view, lamps, origin, Some(slice))?;
            self.forward.prepare(&self.gpu, 1 + slice.split, &uniform);
        }
        Ok(slices)
    }

    /// What lies in each slice of the view. `objects` is those in view, near ones first, and those
    /// of them with translucent parts, far ones first.
    fn slice_runs(
        &mut self,
        slices: Vec<Slice>,
        frame: &Frame<'_>,
        origin: DVec3,
        objects: (&[usize], &[usize]),
    ) -> Vec<SliceRuns> {
        let (pose, view) = (frame.pose, frame.view);
        let (visible, far_to_near) = objects;
        let splits = &self.shadows.frame().plan(0).splits;
        let last = splits.len() - 1;
        // What is nearer than the first split or farther than the last one is drawn with them.
        let ends: Vec<(f64, f64)> = slices
            .iter()
            .map(|slice| {
                let near = if slice.split == 0 { f64::NEG_INFINITY } else { splits[slice.split].near };
                let far = if slice.split == last { f64::INFINITY } else { splits[slice.split].far };
                (near, far)
            })
            .collect();
        let mut runs = Vec::with_capacity(slices.len());
        for (slice, (near, far)) in slices.into_iter().zip(ends) {
            let lies_in = |object: &usize| {
                let depths = pose.objects[*object].bounds.corners().map(|corner| view.view_depth(corner));
                depths.iter().any(|&depth| depth >= near) && depths.iter().any(|&depth| depth <= far)
            };
            let solid = visible.iter().copied().filter(lies_in).map(once);
            let grouped = self.instances.grouped(pose, origin, false, solid);
            let solid = ViewList::new(&self.drawable(), pose, view, &grouped);
            let translucent = self.instances.ordered(pose, origin, far_to_near.iter().copied().filter(lies_in));
            runs.push(SliceRuns { slice, solid, translucent });
        }
        runs
    }

    fn with_translucent_parts(&self, pose: &Pose, objects: impl Iterator<Item = usize>) -> Vec<usize> {
        let drawable = self.drawable();
        let translucent = |i: &usize| drawable.has(&pose.objects[*i], |material| material.alpha == AlphaMode::Blend);
        objects.filter(translucent).collect()
    }
}

/// Objects that the view may show, by the depth of their centres, near ones first.
fn near_to_far(pose: &Pose, view: &View) -> Vec<usize> {
    let mut objects: Vec<(f64, usize)> = (0..pose.objects.len())
        .filter(|&i| cull::may_be_seen(view, &pose.objects[i].bounds))
        .map(|i| (view.view_depth(pose.objects[i].bounds.center()), i))
        .collect();
    objects.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    objects.into_iter().map(|(_, i)| i).collect()
}
