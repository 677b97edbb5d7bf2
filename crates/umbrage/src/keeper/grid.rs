//! What the texels of a kept map depend on beside its casters.

use glam::{DVec2, DVec3};

use super::area::Area;
use crate::bounds::Placed;
use crate::{Layers, Split};

/// The grid that a kept map is a window of. Two maps of one grid hold the same texels where they
/// overlap, bit for bit, if they are drawn in the same places of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    axes: [DVec3; 3],
    texel_m: DVec2,
    depths: [f64; 2],
    /// The frame's origin: vertices are rounded relative to it.
    origin: DVec3,
    /// Whose casters are drawn.
    layers: Layers,
    drops_small: bool,
}

/// Texels around a caster's box in which it may still leave something, and of a share of its
/// distance from the frame's origin: vertices are `f32`.
const MARGIN: f64 = 2.0;
const ROUNDING: f64 = 1.0 / (1u32 << 21) as f64;

impl Grid {
    /// That of a plain split.
    pub fn of(split: &Split, origin: DVec3, layers: Layers, drops_small: bool) -> Self {
        let axes = [split.u_axis, split.v_axis, split.depth_axis];
        Self { axes, texel_m: split.texel_m, depths: [split.depth_near, split.depth_far], origin, layers, drops_small }
    }

    /// The texels that a box may be drawn into. A box around it has an area around this one.
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

    /// Whether a box is dropped because its whole shadow is small.
    pub fn drops(&self, placed: &Placed) -> bool {
        let across = |axis: usize| self.axes[axis] / self.texel_m[axis];
        self.drops_small && crate::planner::is_small(placed, [across(0), across(1)])
    }
}

/// The window that a split's map is of its grid, in texels.
pub(super) fn window(split: &Split) -> Area {
    Area::square([split.min_texel.x as i64, split.min_texel.y as i64], i64::from(split.size))
}
