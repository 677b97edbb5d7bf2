//! Where a plain map lies: tight, held or still.

use glam::{DVec2, DVec3};

use crate::rectangle::Rectangle;
use crate::region::{Fan, Region};
use crate::{DirectionalLight, Split};

/// The smallest rectangle around `target`, widened by `margin` texels.
pub(crate) fn fitted(mut split: Split, target: &Region, fan: &Fan, margin: f64) -> Split {
    let (u, v, lo, hi) = target.least_rectangle(fan);
    (split.u_axis, split.v_axis) = (u, v);
    let texels = f64::from(split.size) - 2.0 * margin;
    let longest = (hi - lo).max_element();
    // A target without width (a wall seen edge-on by the light) still gets texels of some size.
    let extent = (hi - lo).max(DVec2::splat(1e-3 * longest.max(1e-3)));
    split.texel_m = extent / texels;
    split.min_texel = 0.5 * (lo + hi) / split.texel_m - 0.5 * f64::from(split.size);
    split
}

/// A rectangle that is held, moved to whole texels of a grid that is fixed to the light.
pub(crate) fn stepped(
    mut split: Split,
    target: &Region,
    fan: &Fan,
    margin: f64,
    held: Rectangle,
    depth: (f64, f64),
) -> Split {
    (split.u_axis, split.v_axis) = fan.axes(held.direction);
    let size = f64::from(split.size);
    split.texel_m = held.extent / (size - 2.0 * margin - 1.0);
    split.min_texel = (held.center(target) / split.texel_m - 0.5 * size).round();
    (split.depth_near, split.depth_far) = depth;
    split
}

/// The square around a sphere, moved to whole texels of a grid that is fixed to the light.
pub(crate) fn snapped(mut split: Split, light: &DirectionalLight, center: DVec3, radius: f64, texel: f64) -> Split {
    let (u, v) = light.map_axes();
    (split.u_axis, split.v_axis) = (u, v);
    split.texel_m = DVec2::splat(texel);
    let half = 0.5 * f64::from(split.size);
    split.min_texel = (DVec2::new(u.dot(center), v.dot(center)) / texel - half).round();
    let depth = split.depth_axis.dot(center);
    (split.depth_near, split.depth_far) = (depth - radius, depth + radius);
    split
}
