//! Preparation of a frame: from a scene at one moment to the plan and the lists of objects to draw.

use glam::DVec3;
use umbrage::View;
use umbrage_scene::{AlphaMode, Pose};
use umbrage_wgpu::{Inputs, Slice};
use web_time::Instant;

use super::world::is_many;
use super::{Frame, Gathered, Renderer};
use crate::draw_list::{Run, once};
use crate::forward::FrameUniform;
use crate::geometry::check_object;
use crate::lamps::Lamp;
use crate::names::Names;
use crate::view_list::ViewList;
use crate::{Error, Result};

/// Step of the frame's origin in metres. Positions near the eye are exact to a tenth of a
/// millimetre in `f32` and yet stay the same from frame to frame, which keeps stabilised maps
/// still.
const ORIGIN_STEP: f64 = 1024.0;

/// Number of objects in the batch that is drawn first, if there are many. Lower values mean more
/// draws, higher ones more shaded pixels that are hidden later.
const NEAREST_BATCH: usize = 32;

/// A frame that is planned and uploaded, and is ready to be recorded.
pub(crate) struct Prepared {
    pub origin: DVec3,
    pub plan_ms: f64,
    /// Casters that each pass over the maps draws; empty where shadows are off.
    pub caster_runs: Vec<Vec<Run>>,
    pub solid: ViewList,
    pub translucent: Vec<Run>,
    /// Slices of the view, where it is drawn slice by slice.
    pub slices: Vec<SliceRuns>,
    pub objects_in_view: usize,
    /// True if maps without casters are cleared too. Nothing reads those of several lights or
    /// faces, but they may be shown as pictures.
    pub every_map: bool,
    /// Whether the picture takes the first light's shadows from a mask.
    pub is_through_mask: bool,
}

/// Objects in one slice of the view.
pub(crate) struct SliceRuns {
    pub slice: Slice,
    pub solid: ViewList,
    pub translucent: Vec<Run>,
}

impl Renderer {
    /// Plans a frame, uploads moved objects, and sorts the objects to draw. `surfaces_alone` says
    /// that nothing but drawn surfaces reads the maps.
    pub(crate) fn prepare(&mut self, frame: &Frame<'_>, surfaces_alone: bool) -> Result<Prepared> {
        let mut gathered = std::mem::take(&mut self.gathered);
        let prepared = self.prepare_from(&mut gathered, frame, surfaces_alone);
        self.gathered = gathered;
        prepared
    }

    fn prepare_from(&mut self, gathered: &mut Gathered, frame: &Frame<'_>, surfaces_alone: bool) -> Result<Prepared> {
        let pose = frame.pose;
        for index in self.new_objects(frame).iter() {
            let object = pose.objects.get(index).ok_or_else(|| Error::Scene {
                what: "moved object",
                index,
                reason: format!("the pose has {} objects", pose.objects.len()),
            })?;
            check_object(index, object, self.scene.meshes.len())?;
        }
        let view = frame.view;
        let origin = (view.eye() / ORIGIN_STEP).round() * ORIGIN_STEP;
        let plan_ms = self.plan(frame, origin, gathered, surfaces_alone)?;
        let Gathered { visible, lamps, .. } = &*gathered;
        self.skinned.update(&self.gpu, &self.scene_meshes, pose)?;
        let slices = self.write_cameras(view, lamps, origin)?;
        self.timer.restart();

        let occluders = self.shadows.occluders();
        let (first_ids, is_moved) = self.names.update(&self.gpu, occluders, &self.scene, pose, origin)?;
        if is_moved {
            self.forward.bind(&self.gpu, &self.names.entries(&self.scene, Names::BINDING));
        }
        self.instances.clear(first_ids);
        let caster_runs = self.caster_runs(frame, origin, gathered);
        let grouped = self.grouped_near_to_far(pose, origin, visible);
        let solid = ViewList::new(&self.drawable(), pose, view, &grouped);
        let far_to_near = self.with_translucent_parts(pose, visible.iter().rev().copied());
        let translucent = self.instances.ordered(pose, origin, far_to_near.iter().copied());
        let slices = self.slice_runs(slices, frame, origin, (visible, &far_to_near));
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
            is_through_mask: false,
        })
    }

    /// Gathers a frame and plans its maps. Returns the milliseconds that planning took.
    fn plan(&mut self, frame: &Frame<'_>, origin: DVec3, gathered: &mut Gathered, surfaces_alone: bool) -> Result<f64> {
        let asks_surfaces =
            surfaces_alone && frame.shadows_on && frame.more_lights.is_empty() && self.planned_for.is_none();
        gathered.gather(self, frame, asks_surfaces)?;
        let planned_for = self.planned_for.unwrap_or(*frame.view);
        let begun = Instant::now();
        let inputs = Inputs {
            casters: &gathered.caster_boxes,
            receivers: &gathered.receiver_boxes,
            set: self.uses_set(frame.pose).then_some(&self.world.set),
            kept_texels: self.kept.texels,
            redraws_kept: self.kept.redraws,
            receiver_clusters: gathered.clusters(),
            seen: self.sight.boxes(),
            origin,
            image_size: self.size,
            view_slot: self.view_slot,
            enabled: frame.shadows_on,
            tint: frame.tint,
            ..Inputs::new(&planned_for, &gathered.lights)
        };
        self.shadows.prepare(&self.gpu.queue, &inputs)?;
        Ok(begun.elapsed().as_secs_f64() * 1e3)
    }

    /// Writes the cameras of the view and of its slices, and returns the slices.
    fn write_cameras(&mut self, view: &View, lamps: &[Lamp], origin: DVec3) -> Result<Vec<Slice>> {
        let colour = DVec3::from_array(self.shadows.config().look.colour);
        self.forward.prepare(&self.gpu, 0, &FrameUniform::new(view, lamps, colour, origin, None)?);
        if let Some(contact) = &self.contact {
            contact.prepare(&self.gpu, view, origin)?;
        }
        let slices = self.shadows.frame().slices(view);
        for slice in &slices {
            let uniform = FrameUniform::new(view, lamps, colour, origin, Some(slice))?;
            self.forward.prepare(&self.gpu, 1 + slice.split, &uniform);
        }
        Ok(slices)
    }

    /// Groups the objects in view by mesh. Many objects are drawn in batches of doubling size, near
    /// ones first, so that surfaces that they hide need not be shaded.
    fn grouped_near_to_far(&mut self, pose: &Pose, origin: DVec3, visible: &[usize]) -> Vec<Run> {
        let (mut runs, mut rest) = (Vec::new(), visible);
        let mut batch = if is_many(pose) { NEAREST_BATCH } else { visible.len() };
        while !rest.is_empty() {
            let (near, far) = rest.split_at(batch.min(rest.len()));
            runs.extend(self.instances.grouped(pose, origin, false, near.iter().copied().map(once)));
            (rest, batch) = (far, 2 * batch);
        }
        runs
    }

    /// Lists the objects in each slice of the view. `objects` are the objects in view, near ones
    /// first, and those with translucent parts, far ones first.
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
