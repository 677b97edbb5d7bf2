//! Stage 5 of a sun's plan: the position of a plain map, tight or stabilised.

use glam::{DVec2, DVec3};

use super::block::Block;
use super::casters::{Listed, Scene};
use super::fit::MapSize;
use super::layout::SplitFrame;
use crate::config::Stability;
use crate::geometry::region::{Fan, Region};
use crate::held::rectangle::{HeldRectangle, Rectangle};
use crate::margin::{EDGE_TEXELS, FilterReach};
use crate::planes::scheme::blend_begin;
use crate::{DirectionalLight, Split};

/// The map of a split: its axes, and the size and position of its texels. Until the next stage its
/// depths are those of the shown region.
pub(super) fn placed(
    split: &SplitFrame<'_>,
    scene: &Scene,
    size: &MapSize,
    (listed, has_casters): (&Listed, bool),
    held: &mut HeldRectangle,
) -> Split {
    let SplitFrame { frame, sun, layout, index: i } = *split;
    let planes = layout.planes();
    let (block, stride) = (split.block(), split.stride());
    let split = Split {
        near: planes[i],
        far: planes[i + 1],
        blend_begin: blend_begin(planes, i, frame.config.blend()),
        coverage: (scene.ends.from, scene.ends.to),
        size: frame.config.map_sizes[i],
        u_axis: DVec3::ZERO,
        v_axis: DVec3::ZERO,
        depth_axis: sun.direction,
        texel_m: DVec2::ONE,
        min_texel: DVec2::ZERO,
        depth_near: listed.target.depth.0,
        depth_far: listed.target.depth.1,
        receiver_depths: listed.target.depth,
        filter_radius_texels: size.still_reach,
        warp: None,
        light_position: None,
        casters: 0..0,
    };
    match frame.config.stability {
        Stability::Tight { .. } => fitted(split, &listed.target, &sun.fan, size.reach),
        Stability::Exact => snapped(split, sun.light, &block, size.still_texel),
        Stability::Approximate { steps } => {
            let (target, whole) = (&listed.target, layout.whole_width);
            // A split without casters is lit, whatever its rectangle.
            let mut unheld = HeldRectangle::default();
            let rectangle = match stride {
                None if has_casters => held.hold(target, steps, whole),
                Some(stride) if has_casters => held.approach(target, (steps, whole), stride),
                // Nothing that is held changes while the camera moves.
                None => unheld.hold(target, steps, whole),
                Some(_) => {
                    held.rest();
                    unheld.hold(target, steps, whole)
                }
            };
            let radius = size.half.max_element();
            let depth = (block.center.z - radius, block.center.z + radius);
            stepped(split, &sun.fan, size.reach, rectangle, depth)
        }
    }
}

/// The smallest rectangle around `target`, widened by the filter's reach.
fn fitted(mut split: Split, target: &Region, fan: &Fan, reach: FilterReach) -> Split {
    let (u, v, lo, hi) = target.least_rectangle(fan);
    (split.u_axis, split.v_axis) = (u, v);
    let longest = (hi - lo).max_element();
    // A target without width (a wall seen edge-on by the light) still gets texels of some size.
    let extent = (hi - lo).max(DVec2::splat(1e-3 * longest.max(1e-3)));
    split.filter_radius_texels = reach.texels(extent.min_element(), split.size, 2.0 * EDGE_TEXELS);
    split.texel_m = extent / (f64::from(split.size) - 2.0 * (split.filter_radius_texels + EDGE_TEXELS));
    split.min_texel = 0.5 * (lo + hi) / split.texel_m - 0.5 * f64::from(split.size);
    split
}

/// A held rectangle, moved to whole texels of a grid that is fixed to the light.
fn stepped(mut split: Split, fan: &Fan, reach: FilterReach, held: Rectangle, depth: (f64, f64)) -> Split {
    (split.u_axis, split.v_axis) = fan.axes(held.direction);
    let size = f64::from(split.size);
    split.filter_radius_texels = reach.texels(held.extent.min_element(), split.size, 2.0 * EDGE_TEXELS + 1.0);
    split.texel_m = held.extent / (size - 2.0 * (split.filter_radius_texels + EDGE_TEXELS) - 1.0);
    split.min_texel = (held.center / split.texel_m - 0.5 * size).round();
    (split.depth_near, split.depth_far) = depth;
    split
}

/// A block, moved to whole texels of a grid that is fixed to the light.
fn snapped(mut split: Split, light: &DirectionalLight, block: &Block, texel_m: DVec2) -> Split {
    (split.u_axis, split.v_axis) = light.map_axes();
    split.texel_m = texel_m;
    split.min_texel = (block.center.truncate() / texel_m - 0.5 * f64::from(split.size)).round();
    (split.depth_near, split.depth_far) = (block.center.z - block.half.z, block.center.z + block.half.z);
    split
}
