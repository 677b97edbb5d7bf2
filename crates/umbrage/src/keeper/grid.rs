//! Grid of a kept map: all that its texels depend on except its casters.

use glam::{DVec2, DVec3};

use super::area::Area;
use crate::bounds::Placed;
use crate::{Layers, Split};

/// The grid of which a kept map is a window. Where two maps of one grid overlap, their texels are
/// equal bit for bit, if they are drawn at the same places of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    axes: [DVec3; 3],
    texel_m: DVec2,
    depths: [f64; 2],
    /// Origin of the frame; vertices are rounded relative to it.
    origin: DVec3,
    /// Layers whose casters are drawn.
    layers: Layers,
    drops_small: bool,
}

/// Margin around a caster's box that its rasterised shadow may touch: in texels, and as a share of
/// the box's distance from the frame's origin, because vertices are `f32`.
const MARGIN: f64 = 2.0;
const ROUNDING: f64 = 1.0 / (1u32 << 21) as f64;

impl Grid {
    /// The grid of a plain split.
    pub fn of(split: &Split, origin: DVec3, layers: Layers, drops_small: bool) -> Self {
        let axes = [split.u_axis, split.v_axis, split.depth_axis];
        Self { axes, texel_m: split.texel_m, depths: [split.depth_near, split.depth_far], origin, layers, drops_small }
    }

    /// The texels that a box may be drawn into. It is monotone: a box around this one has an area
    /// around this one's.
    pub fn footprint(&self, placed: &Placed) -> Area {
        let away = ((placed.center - self.origin).abs() + placed.half).element_sum();
        let end = |axis: usize, sign: f64| {
            let along = self.axes[axis] / self.texel_m[axis];
            let margin = MARGIN + ROUNDING * away / self.texel_m[axis];
            along.dot(placed.center) + sign * (along.abs().dot(placed.half) + margin)
        };
        Area {
            min: [0, 1].map(|axis| end(axis, -1.0).floor() as i64),
            max: [0, 1].map(|axis| end(axis, 1.0).ceil() as i64),
        }
    }

    /// Returns whether a box is dropped because its whole shadow is small.
    pub fn drops(&self, placed: &Placed) -> bool {
        let across = |axis: usize| self.axes[axis] / self.texel_m[axis];
        self.drops_small && crate::planner::is_small(placed, [across(0), across(1)])
    }
}

/// The window of the grid that a split's map shows, in texels.
pub(super) fn window(split: &Split) -> Area {
    Area::square([split.min_texel.x as i64, split.min_texel.y as i64], i64::from(split.size))
}
