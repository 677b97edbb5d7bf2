//! Lists of the casters that each pass over the maps draws: the casters of its splits and, of large
//! meshes, the clusters that reach the maps.

use std::ops::Range;

use glam::DVec3;
use umbrage::Aabb;
use umbrage_scene::{Object, Pose};
use umbrage_wgpu::{MapPass, ShadowMap};

use super::world::is_many;
use super::{Frame, Gathered, Renderer};
use crate::coarser::Coarser;
use crate::draw_list::{Parts, Run};
use crate::geometry::GpuPrimitive;
use crate::shadow_mesh::{Cluster, descend};

/// Fewest triangles that a draw of part of an object must spare. If it spares fewer, the object is
/// drawn whole, with others of its mesh in one draw; gaps between its parts that spare fewer are
/// drawn too.
const LEAST_SPARED: u32 = 40;

/// Most triangles that are tested together, except at the ends of the drawn ranges.
const BLOCK: u32 = 24;

/// Most triangles in a part whose box is given to the planner.
const PART: u32 = 128;

impl Renderer {
    /// Lists the casters of each pass over the maps; empty where shadows are off.
    pub(crate) fn caster_runs(&mut self, frame: &Frame<'_>, origin: DVec3, objects: &Gathered) -> Vec<Vec<Run>> {
        if !frame.shadows_on {
            return Vec::new();
        }
        let coarser = std::mem::take(&mut self.coarser);
        let runs = self.runs_of_maps(frame, origin, objects, &coarser);
        self.coarser = coarser;
        runs
    }

    fn runs_of_maps(
        &mut self,
        frame: &Frame<'_>,
        origin: DVec3,
        objects: &Gathered,
        coarser: &Coarser,
    ) -> Vec<Vec<Run>> {
        let pose = frame.pose;
        // Texels that name triangles name those of the shape that is seen.
        let names_casters = self.shadows.maps().edges().is_exact();
        // Of several lights or faces, objects are drawn whole.
        let is_one_light = self.shadows.maps().map_count() == self.shadows.maps().splits();
        let shown = self.shadows.frame();
        let passes = self.shadows.maps().passes();
        let mut all = vec![Vec::new(); shown.pass_count()];
        for map in shown.maps() {
            let copies = map.casters().map(|(caster, codes)| (objects.object(caster), codes));
            let shape = |object: &Object| match names_casters {
                true => object.mesh,
                false => coarser.shape(object, map.texel_m()),
            };
            let leads = passes.get(map.index()).is_some_and(MapPass::leads);
            if !is_one_light || map.splits().len() > 1 || leads {
                all[map.index()] = self.instances.grouped_as(pose, origin, leads, copies, shape);
                continue;
            }
            let (mut whole, mut in_part) = (Vec::new(), Vec::new());
            for (index, codes) in copies {
                let object = &pose.objects[index];
                let meshes = &self.scene.meshes;
                let parts = || parts_in(&map, object, &meshes[object.mesh]);
                match has_parts(object, meshes).then(parts).flatten() {
                    Some(parts) => in_part.push((index, codes, parts)),
                    None => whole.push((index, codes)),
                }
            }
            let mut runs = self.instances.grouped_as(pose, origin, false, whole.into_iter(), shape);
            for (index, codes, parts) in in_part {
                let own = self.instances.grouped(pose, origin, false, std::iter::once((index, codes)));
                runs.extend(own.into_iter().map(|run| Run { parts: Some(parts.clone()), ..run }));
            }
            all[map.index()] = runs;
        }
        all
    }

    /// Adds the boxes of the clusters of visible objects, for the planner; returns false if no
    /// caster may be drawn in part. With thousands of objects each is a cluster of its own, whose
    /// box the planner has already.
    pub(super) fn receiver_clusters(&self, pose: &Pose, visible: &[usize], parts: &mut Vec<Aabb>) -> bool {
        let (meshes, maps) = (&self.scene.meshes, self.shadows.maps());
        let may_be_in_part = |object: &Object| self.is_listed(pose, object) && has_parts(object, meshes);
        if maps.map_count() > maps.splits() || is_many(pose) || !pose.objects.iter().any(may_be_in_part) {
            return false;
        }
        for object in visible.iter().map(|&index| &pose.objects[index]) {
            if object.skinned.is_some() {
                parts.push(object.bounds);
                continue;
            }
            for primitive in &meshes[object.mesh] {
                descend(&primitive.clusters, |_, node| {
                    let goes_on = node.triangles() > PART && node.below > 0;
                    if !goes_on {
                        parts.push(node.bounds().transformed(&object.world_from_local));
                    }
                    goes_on
                });
            }
        }
        true
    }
}

/// Returns whether maps may draw parts of an object.
fn has_parts(object: &Object, meshes: &[Vec<GpuPrimitive>]) -> bool {
    object.skinned.is_none() && meshes[object.mesh].iter().any(|primitive| primitive.clusters.len() > 1)
}

/// Returns, for each primitive, the ranges of indices that reach a map; `None` if the object is
/// better drawn whole.
fn parts_in(map: &ShadowMap<'_>, object: &Object, primitives: &[GpuPrimitive]) -> Option<Parts> {
    let reaches = |node: &Cluster| map.casts_into(&node.bounds().transformed(&object.world_from_local));
    let mut spared = 0;
    let parts: Parts = primitives
        .iter()
        .map(|primitive| {
            let ranges = reaching(&primitive.clusters, reaches);
            let drawn: u32 = ranges.iter().map(|range| range.end - range.start).sum();
            spared += (primitive.shadow_indices.end - primitive.shadow_indices.start - drawn) / 3;
            ranges
        })
        .collect();
    let draws = parts.iter().map(Vec::len).sum::<usize>() as u32;
    (spared > 0 && spared >= LEAST_SPARED * draws).then_some(parts)
}

/// Returns the ranges of indices of a tree's leaves that reach a map, with the gaps between them in
/// the same block and narrow gaps elsewhere.
///
/// Blocks are tested first. Leaves are tested only in the first and in the last block of a row of
/// blocks, where they shorten the range.
fn reaching(tree: &[Cluster], reaches: impl Fn(&Cluster) -> bool) -> Vec<Range<u32>> {
    // Rows of blocks, the first and the last of each.
    let mut rows: Vec<[usize; 2]> = Vec::new();
    descend(tree, |at, node| {
        if !reaches(node) {
            return false;
        }
        if node.triangles() > BLOCK && node.below > 0 {
            return true;
        }
        match rows.last_mut() {
            Some([_, last]) if tree[*last].indices.end == node.indices.start => *last = at,
            _ => rows.push([at, at]),
        }
        false
    });
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for row in rows {
        let [first, last] = row.map(|at| &tree[at..=at + tree[at].below as usize]);
        let reaching_leaf = |node: &&Cluster| node.below == 0 && reaches(node);
        let begin = first.iter().find(reaching_leaf).map_or(first[0].indices.end, |leaf| leaf.indices.start);
        let end = last.iter().rev().find(reaching_leaf).map_or(last[0].indices.start, |leaf| leaf.indices.end);
        match ranges.last_mut() {
            _ if begin >= end => {}
            Some(last) if begin - last.end < 3 * LEAST_SPARED => last.end = end,
            _ => ranges.push(begin..end),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shadow_mesh::clusters;

    /// Triangles in a row along x, one a metre.
    fn row(triangles: u32) -> Vec<Cluster> {
        let corner = |i: u32| [(i / 3) as f32 + 0.4 * (i % 3) as f32, (i % 2) as f32, 0.0];
        let positions: Vec<[f32; 3]> = (0..3 * triangles).map(corner).collect();
        clusters(&positions, &(0..3 * triangles).collect::<Vec<_>>(), 300)
    }

    #[test]
    fn all_that_reaches_is_drawn_and_little_else() {
        for triangles in [128, 500, 777, 4096] {
            let tree = row(triangles);
            for (from, to) in [(0.0, 1e9), (100.5, 101.5), (3.0, 60.0), (90.0, 400.0), (-5.0, 0.5), (126.5, 1e9)] {
                let reaches = |node: &Cluster| node.bounds().max.x >= from && node.bounds().min.x <= to;
                let ranges = reaching(&tree, reaches);
                let leaves = || tree.iter().filter(|node| node.below == 0 && reaches(node));
                for leaf in leaves() {
                    let drawn = |range: &Range<u32>| range.start <= leaf.indices.start && leaf.indices.end <= range.end;
                    assert_eq!(ranges.iter().filter(|range| drawn(range)).count(), 1, "{leaf:?} in {ranges:?}");
                }
                // What reaches lies together here: nothing beside it is drawn.
                let wanted: u32 = leaves().map(Cluster::triangles).sum();
                let drawn: usize = ranges.iter().map(|range| range.len() / 3).sum();
                assert_eq!(drawn as u32, wanted, "{from}..{to} of {triangles}: {ranges:?}");
            }
        }
    }

    #[test]
    fn wide_gaps_are_left_out_and_narrow_ones_drawn() {
        let tree = row(1024);
        let between = |gap: f64| {
            let outside = move |node: &Cluster| node.bounds().min.x < 300.0 || node.bounds().max.x > 300.0 + gap;
            reaching(&tree, outside)
        };
        let one = between(20.0);
        assert!(one.len() == 1 && one[0] == (300..300 + 3 * 1024), "{one:?}");
        let two = between(300.0);
        assert_eq!(two.len(), 2);
        assert!((280..320).contains(&(two[1].start - two[0].end).div_euclid(3)), "{two:?}");
        assert!(reaching(&tree, |_| false).is_empty() && reaching(&[], |_| true).is_empty());
    }
}
