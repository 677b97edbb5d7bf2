//! Bias from the texel and the slope, for renderers that do not use umbrage's WGSL.

use glam::{DVec2, DVec3};

use crate::Split;

/// How a receiver's sample has to move so that its own surface does not shade it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// Metres to move the sample along the receiver's normal.
    pub normal_m: f64,
    /// Metres of depth per texel along u and v on the receiver's plane: subtract `slope · (sample − tap)` for each tap.
    pub depth_per_texel: DVec2,
    /// Metres to move the sample towards the light, whatever the slope.
    pub constant_m: f64,
}

/// Steepest slope (tangent of the angle between light and normal) that the receiver's plane is followed to. Beyond it the plane
/// tells little about what one texel holds: a texel's width of a wall that the light grazes is many metres of depth.
pub const STEEPEST: f64 = 10.0;

impl Split {
    /// The bias of a receiver with unit `normal` (turned towards the light) under a filter that reaches `filter_radius` texels.
    ///
    /// On the receiver's plane depth changes by `−(n·u)/(n·d)` metres per metre along u, and likewise along v: following it makes
    /// the comparison exact for flat surfaces at any filter width. What is left is the corner between two surfaces, for which the
    /// sample moves along the normal by the texel's half diagonal plus the filter's reach, scaled by the slope's sine.
    ///
    /// In a warped map this holds in the middle of its receivers; elsewhere ask [`Split::bias_at`].
    #[must_use]
    pub fn bias(&self, normal: DVec3, filter_radius: f64) -> Bias {
        let facing = -normal.dot(self.depth_axis);
        let texel = self.texel_m.max_element();
        let sine = (1.0 - facing * facing).max(0.0).sqrt();
        let slope = DVec2::new(normal.dot(self.u_axis), normal.dot(self.v_axis)) / facing.max(1e-6);
        let steep = slope.length();
        let slope = if steep > STEEPEST { slope * (STEEPEST / steep) } else { slope };
        Bias {
            normal_m: texel * (0.5 + 0.5 * filter_radius) * sine,
            depth_per_texel: slope * self.texel_m,
            constant_m: 0.1 * texel,
        }
    }

    /// The same for a receiver at a world point, in plain and warped maps: a warped map's texels differ from place to place.
    /// Depths are metres along the light, whatever the map stores.
    #[must_use]
    pub fn bias_at(&self, point: DVec3, normal: DVec3, filter_radius: f64) -> Bias {
        let Some(_) = self.warp else { return self.bias(normal, filter_radius) };
        let facing = -normal.dot(self.depth_axis);
        let [u, v] = self.texel_steps(point);
        let texel = u.length().max(v.length());
        let sine = (1.0 - facing * facing).max(0.0).sqrt();
        Bias {
            normal_m: texel * (0.5 + 0.5 * filter_radius) * sine,
            depth_per_texel: DVec2::new(normal.dot(u), normal.dot(v)) / facing.max(sine / STEEPEST).max(1e-6),
            constant_m: 0.1 * texel,
        }
    }
}
