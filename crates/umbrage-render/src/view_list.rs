//! Objects and parts of large meshes that the view draws, near ones first.
//!
//! Depth is drawn before anything is shaded, so that a pixel is shaded once. Near parts go first
//! there: they spare the alpha tests of parts that they hide. In the passes that shade, the order
//! of draws is that of [`Instances::grouped`], reversed: where surfaces coincide exactly, the one
//! that was drawn first wins, as it would without a depth pass.

use std::ops::Range;

use umbrage::View;
use umbrage_scene::Pose;

use crate::cull;
use crate::draw_list::{Drawable, Piece, Run, Source};
use crate::geometry::GpuPrimitive;
use crate::shadow_mesh::descend;

/// Fewest triangles of a mesh that is divided. Smaller ones are drawn whole, together with others
/// of the same mesh.
const LEAST_TRIANGLES: u64 = 2048;

/// Most triangles of a part that is left out or drawn by itself. Lower values mean more draws,
/// higher ones more hidden triangles.
const PART: u32 = 1024;

/// Solid surfaces in a view.
#[derive(Default)]
pub(crate) struct ViewList {
    /// Pieces for the depth pass: near ones first, as far as their boxes tell.
    pub pieces: Vec<Piece>,
    /// Runs for passes that shade: the last one first.
    pub runs: Vec<Run>,
}

/// A part of an object that the view may show.
struct Part {
    /// View depth of the part's box: its distance from the eye along the line of sight, in metres.
    depth: f64,
    primitive: usize,
    indices: Range<u32>,
}

impl ViewList {
    /// Divides `grouped` runs into parts.
    pub fn new(drawable: &Drawable<'_>, pose: &Pose, view: &View, grouped: &[Run]) -> Self {
        let mut list = Self::default();
        let mut pieces: Vec<(f64, Piece)> = Vec::new();
        for run in grouped {
            let (_, primitives) = drawable.primitives(run.source);
            let piece = |instances: &Range<u32>, part: Part| {
                let Part { depth, primitive, indices } = part;
                let Run { source, mirrored, .. } = *run;
                (depth, Piece { source, mirrored, instances: instances.clone(), primitive, indices })
            };
            if !has_parts(run.source, primitives) {
                let near = nearest(view, &pose.objects[drawable.instances.object(run.instances.start)].bounds);
                let whole = |(primitive, of): (usize, &GpuPrimitive)| Part {
                    depth: near,
                    primitive,
                    indices: of.shadow_indices.clone(),
                };
                pieces.extend(primitives.iter().enumerate().map(whole).map(|part| piece(&run.instances, part)));
                list.runs.push(run.clone());
                continue;
            }
            for instance in run.instances.clone() {
                let own = instance..instance + 1;
                let parts = parts_in(view, pose, drawable.instances.object(instance), primitives);
                let mut seen = vec![Vec::new(); primitives.len()];
                for part in &parts {
                    add(&mut seen[part.primitive], part.indices.clone());
                }
                pieces.extend(parts.into_iter().map(|part| piece(&own, part)));
                list.runs.push(Run { instances: own, parts: Some(seen), ..run.clone() });
            }
        }
        // Stable: parts of one depth stay together.
        pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
        list.pieces = pieces.into_iter().map(|(_, piece)| piece).collect();
        list.runs.reverse();
        list
    }
}

/// Returns whether a mesh is divided.
fn has_parts(source: Source, primitives: &[GpuPrimitive]) -> bool {
    matches!(source, Source::Mesh(_))
        && primitives.iter().any(|primitive| primitive.clusters.len() > 1)
        && primitives.iter().map(GpuPrimitive::triangles).sum::<u64>() >= LEAST_TRIANGLES
}

/// Returns the parts of an object that the view may show.
fn parts_in(view: &View, pose: &Pose, object: usize, primitives: &[GpuPrimitive]) -> Vec<Part> {
    let object = &pose.objects[object];
    let mut parts = Vec::new();
    for (index, primitive) in primitives.iter().enumerate() {
        descend(&primitive.clusters, |_, node| {
            let bounds = node.bounds().transformed(&object.world_from_local);
            if !cull::may_be_seen(view, &bounds) {
                return false;
            }
            let goes_on = node.triangles() > PART && node.below > 0;
            if !goes_on {
                parts.push(Part { depth: nearest(view, &bounds), primitive: index, indices: node.indices.clone() });
            }
            goes_on
        });
        // Few triangles have no tree.
        if primitive.clusters.is_empty() {
            let depth = nearest(view, &object.bounds);
            parts.push(Part { depth, primitive: index, indices: primitive.shadow_indices.clone() });
        }
    }
    parts
}

/// Returns the view depth of the nearest corner of a box, in metres.
fn nearest(view: &View, bounds: &umbrage::Aabb) -> f64 {
    bounds.corners().into_iter().map(|corner| view.view_depth(corner)).fold(f64::INFINITY, f64::min)
}

/// Adds a range to a list, or extends the last range if the new one follows it.
fn add(ranges: &mut Vec<Range<u32>>, range: Range<u32>) {
    match ranges.last_mut() {
        Some(last) if last.end == range.start => last.end = range.end,
        _ => ranges.push(range),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_follow_each_other_are_one() {
        let mut ranges = Vec::new();
        for range in [0..3, 3..9, 12..15, 15..18, 30..33] {
            add(&mut ranges, range);
        }
        assert_eq!(ranges, [0..9, 12..18, 30..33]);
    }
}
