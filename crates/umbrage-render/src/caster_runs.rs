//! What each pass over the maps draws: the casters of its splits, and of large meshes the clusters that reach them.

use std::ops::Range;

use glam::DVec3;
use umbrage::{Aabb, Planner, ShadowPlan};
use umbrage_scene::{Object, Pose};

use crate::Result;
use crate::draw_list::{Parts, Run, once};
use crate::geometry::GpuPrimitive;
use crate::renderer::{Frame, Renderer};
use crate::shadow_mesh::descend;

/// Triangles that each draw of an object in parts has to spare, or it is drawn whole: with others of its mesh in one draw. Gaps between
/// its parts that spare less are drawn, too.
const LEAST_SPARED: u32 = 40;

/// Triangles of the parts that the planner is told of, at most.
const PART: u32 = 128;

impl Renderer {
    /// What each pass over the maps draws; nothing where shadows are off. `visible` are the objects whose surfaces alone ask the maps, if
    /// that is so.
    pub(crate) fn caster_runs(
        &mut self,
        frame: &Frame<'_>,
        origin: DVec3,
        objects: &[usize],
        plans: &[ShadowPlan],
        visible: Option<&[usize]>,
    ) -> Result<Vec<Vec<Run>>> {
        if !frame.shadows_on {
            return Ok(Vec::new());
        }
        let pose = frame.pose;
        let [plan] = plans else {
            let mut runs = vec![Vec::new(); self.maps.map_count()];
            for (light, plan) in plans.iter().enumerate() {
                self.light_runs(frame, origin, objects, light, plan, &mut runs);
            }
            return Ok(runs);
        };
        if self.maps.map_count() > self.maps.splits() {
            let mut runs = vec![Vec::new(); self.maps.map_count()];
            self.light_runs(frame, origin, objects, 0, plan, &mut runs);
            return Ok(runs);
        }
        if let Some(visible) = visible {
            self.tell_parts(pose, objects, plan, visible)?;
        }
        let mut all = Vec::new();
        for pass in self.maps.passes() {
            let copies = pass.casters(plan).map(|(caster, codes)| (objects[caster as usize], codes));
            if pass.splits().len() > 1 || pass.leads() {
                all.push(self.instances.grouped(pose, origin, pass.leads(), copies));
                continue;
            }
            let (planner, split) = (&self.planners.now[0], pass.splits().start);
            let (mut whole, mut in_part) = (Vec::new(), Vec::new());
            for (index, codes) in copies {
                let object = &pose.objects[index];
                let meshes = &self.scene.meshes;
                let parts = || parts_in(planner, split, object, &meshes[object.mesh]);
                match has_parts(object, meshes).then(parts).flatten() {
                    Some(parts) => in_part.push((index, codes, parts)),
                    None => whole.push((index, codes)),
                }
            }
            let mut runs = self.instances.grouped(pose, origin, false, whole.into_iter());
            for (index, codes, parts) in in_part {
                let own = self.instances.grouped(pose, origin, false, std::iter::once((index, codes)));
                runs.extend(own.into_iter().map(|run| Run { parts: Some(parts.clone()), ..run }));
            }
            all.push(runs);
        }
        Ok(all)
    }

    /// Tells the planner what visible objects are made of, if some caster may be drawn in part.
    fn tell_parts(&mut self, pose: &Pose, objects: &[usize], plan: &ShadowPlan, visible: &[usize]) -> Result<()> {
        let meshes = &self.scene.meshes;
        if !plan.caster_indices.iter().any(|&caster| has_parts(&pose.objects[objects[caster as usize]], meshes)) {
            return Ok(());
        }
        let mut parts: Vec<Aabb> = Vec::new();
        for object in visible.iter().map(|&index| &pose.objects[index]) {
            if object.skinned.is_some() {
                parts.push(object.bounds);
                continue;
            }
            for primitive in &meshes[object.mesh] {
                descend(&primitive.clusters, |node| {
                    let goes_on = node.triangles() > PART && node.below > 0;
                    if !goes_on {
                        parts.push(node.bounds().transformed(&object.world_from_local));
                    }
                    goes_on
                });
            }
        }
        Ok(self.planners.now[0].tell_parts(&parts)?)
    }

    /// What one of several lights draws into its maps.
    fn light_runs(
        &mut self,
        frame: &Frame<'_>,
        origin: DVec3,
        objects: &[usize],
        light: usize,
        plan: &ShadowPlan,
        runs: &mut [Vec<Run>],
    ) {
        for (i, runs) in runs[self.maps.first_map(light)..][..plan.splits.len()].iter_mut().enumerate() {
            let casters = plan.casters(i).iter().map(|&caster| once(objects[caster as usize]));
            *runs = self.instances.grouped(frame.pose, origin, false, casters);
        }
    }
}

/// Whether maps may leave out some of an object.
fn has_parts(object: &Object, meshes: &[Vec<GpuPrimitive>]) -> bool {
    object.skinned.is_none() && meshes[object.mesh].iter().any(|primitive| primitive.clusters.len() > 1)
}

/// For each primitive the ranges of indices that reach a split; `None` if the object is better drawn whole.
fn parts_in(planner: &Planner, split: usize, object: &Object, primitives: &[GpuPrimitive]) -> Option<Parts> {
    let mut spared = 0;
    let parts: Parts = primitives
        .iter()
        .map(|primitive| {
            let mut ranges: Vec<Range<u32>> = Vec::new();
            descend(&primitive.clusters, |node| {
                let reaches = planner.reaches(split, &node.bounds().transformed(&object.world_from_local));
                if reaches && node.below == 0 {
                    match ranges.last_mut() {
                        Some(last) if node.indices.start - last.end < 3 * LEAST_SPARED => last.end = node.indices.end,
                        _ => ranges.push(node.indices.clone()),
                    }
                }
                reaches
            });
            let drawn: u32 = ranges.iter().map(|range| range.end - range.start).sum();
            spared += (primitive.shadow_indices.end - primitive.shadow_indices.start - drawn) / 3;
            ranges
        })
        .collect();
    let draws = parts.iter().map(Vec::len).sum::<usize>() as u32;
    (spared > 0 && spared >= LEAST_SPARED * draws).then_some(parts)
}
