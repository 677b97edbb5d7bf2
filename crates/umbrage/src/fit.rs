//! Where a plain map lies: tight, held or still.

use glam::{DVec2, DVec3};

use crate::margin::{EDGE_TEXELS, Reach};
use crate::planner::Placed;
use crate::rectangle::Rectangle;
use crate::region::{Fan, Region};
use crate::{DirectionalLight, Split};

/// The smallest rectangle around `target`, widened by the filter's reach.
pub(crate) fn fitted(mut split: Split, target: &Region, fan: &Fan, reach: Reach) -> Split {
    let (u, v, lo, hi) = target.least_rectangle(fan);
    (split.u_axis, split.v_axis) = (u, v);
    let longest = (hi - lo).max_element();
    // A target without width (a wall seen edge-on by the light) still gets texels of some size.
    let extent = (hi - lo).max(DVec2::splat(1e-3 * longest.max(1e-3)));
    split.filter_reach = reach.texels(extent.min_element(), split.size, 2.0 * EDGE_TEXELS);
    split.texel_m = extent / (f64::from(split.size) - 2.0 * (split.filter_reach + EDGE_TEXELS));
    split.min_texel = 0.5 * (lo + hi) / split.texel_m - 0.5 * f64::from(split.size);
    split
}

/// A rectangle that is held, moved to whole texels of a grid that is fixed to the light.
pub(crate) fn stepped(
    mut split: Split,
    target: &Region,
    fan: &Fan,
    reach: Reach,
    held: Rectangle,
    depth: (f64, f64),
) -> Split {
    (split.u_axis, split.v_axis) = fan.axes(held.direction);
    let size = f64::from(split.size);
    split.filter_reach = reach.texels(held.extent.min_element(), split.size, 2.0 * EDGE_TEXELS + 1.0);
    split.texel_m = held.extent / (size - 2.0 * (split.filter_reach + EDGE_TEXELS) - 1.0);
    split.min_texel = (held.center(target) / split.texel_m - 0.5 * size).round();
    (split.depth_near, split.depth_far) = depth;
    split
}

/// A block on the light's own axes: along the map's two and along the light, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    pub center: DVec3,
    pub half: DVec3,
}

impl Block {
    /// Around a sphere of the world.
    pub fn around_sphere(center: DVec3, radius: f64, light: &DirectionalLight) -> Self {
        Self { center: axes(light).map(|axis| axis.dot(center)).into(), half: DVec3::splat(radius) }
    }

    /// Around boxes; `None` of none, and of such without any extent.
    pub fn around(boxes: &[Placed], light: &DirectionalLight) -> Option<Self> {
        let axes = axes(light);
        let (lo, hi) = boxes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), placed| {
            let at = DVec3::from(axes.map(|axis| axis.dot(placed.center)));
            let reach = DVec3::from(axes.map(|axis| axis.abs().dot(placed.half)));
            (lo.min(at - reach), hi.max(at + reach))
        });
        let half = 0.5 * (hi - lo);
        // What has no width (a wall seen edge-on by the light) still gets texels of some size.
        let half = half.max(DVec3::splat(1e-3 * half.max_element()));
        (half.max_element() > 0.0).then(|| Self { center: 0.5 * (lo + hi), half })
    }

    /// The same, but along each axis no longer than `other`, whose place it takes there.
    pub fn no_longer_than(self, other: &Self) -> Self {
        let longer = self.half.cmpge(other.half);
        Self {
            center: DVec3::select(longer, other.center, self.center),
            half: DVec3::select(longer, other.half, self.half),
        }
    }
}

fn axes(light: &DirectionalLight) -> [DVec3; 3] {
    let (u, v) = light.map_axes();
    [u, v, light.direction()]
}

/// A block, moved to whole texels of a grid that is fixed to the light.
pub(crate) fn snapped(mut split: Split, light: &DirectionalLight, block: &Block, texel_m: DVec2) -> Split {
    (split.u_axis, split.v_axis) = light.map_axes();
    split.texel_m = texel_m;
    split.min_texel = (block.center.truncate() / texel_m - 0.5 * f64::from(split.size)).round();
    (split.depth_near, split.depth_far) = (block.center.z - block.half.z, block.center.z + block.half.z);
    split
}
