//! Bias from the texel and the slope, for renderers that do not use umbrage's WGSL: the same rule
//! and the same constants.

use glam::{DVec2, DVec3};

use crate::Split;

/// Depth bias of a receiver: the change of its depth before the comparison, so that its own surface
/// does not shade it.
///
/// A tap that lies `offset` texels from the sample is compared with `depth + min(depth_per_texel ·
/// offset − |corner_per_texel ∘ offset|, 0) − constant_m`, in metres along the light.
///
/// umbrage's WGSL has one more test. If a texel is nearer than that, or nearer than the receiver
/// but far behind the receiver's plane, it continues the texel's own surface to the receiver
/// (`meets_receiver` in `bias.wesl`).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bias {
    /// Metres of depth per texel along u and v on the receiver's plane.
    pub depth_per_texel: DVec2,
    /// Metres per texel of offset along u and v (∘: axis by axis) by which a tap has to be nearer
    /// to count as a caster and not as the other side of a corner or a fold.
    pub corner_per_texel: DVec2,
    /// Metres by which the sample moves towards the light, whatever the slope.
    pub constant_m: f64,
}

/// Steepest slope (tangent of the angle between light and normal) to which the receiver's plane is
/// followed: n·l = 0.02. Measured with the WGSL's constants (`docs/notes/bias.md`). With a lower
/// n·l, surfaces that the light grazes show stripes.
pub const STEEPEST: f64 = 50.0;

/// Size of [`Bias::constant_m`] in longer texel edges, bounds of [`Bias::corner_per_texel`] in
/// shorter texel edges, and the angle in radians by which ground may bend within the filter's
/// reach. umbrage's WGSL has the same constants and says for each what breaks otherwise.
const CONSTANT: f64 = 0.25;
const CORNER: (f64, f64) = (0.5, 12.0);
const FOLD: f64 = 0.03;

impl Bias {
    /// The bias without the receiver's plane, for normals that give the steepness of a surface but
    /// not the direction that it faces. All taps up to `reach` texels from the sample along u and v
    /// are compared with one depth, which is nearer by the slope over that reach in whichever
    /// direction.
    #[must_use]
    pub fn without_plane(self, reach: DVec2) -> Self {
        let aside = self.depth_per_texel.abs().dot(reach);
        Self { depth_per_texel: DVec2::ZERO, corner_per_texel: DVec2::ZERO, constant_m: self.constant_m + aside }
    }
}

impl Split {
    /// The bias of a receiver with unit `normal`, turned towards the light.
    ///
    /// On the receiver's plane depth changes by `−(n·u)/(n·d)` metres per metre along u, and
    /// likewise along v: following it makes the comparison exact for flat surfaces at any filter
    /// width. What is left is the corner between two surfaces.
    ///
    /// In a warped map this holds in the middle of its receivers; elsewhere use [`Split::bias_at`].
    #[must_use]
    pub fn bias(&self, normal: DVec3) -> Bias {
        bias(normal, self.depth_axis, self.u_axis * self.texel_m.x, self.v_axis * self.texel_m.y)
    }

    /// The bias of a receiver at a world point, in any map. The texels of warped maps and of local
    /// lights differ from point to point. Depths are metres along the light, not the map's stored
    /// values.
    #[must_use]
    pub fn bias_at(&self, point: DVec3, normal: DVec3) -> Bias {
        if self.warp.is_none() {
            return self.bias(normal);
        }
        let [u, v] = self.texel_axes_m(point);
        bias(normal, self.light_direction_at(point), u, v)
    }
}

/// The bias from the world steps of one texel along u and v.
fn bias(normal: DVec3, depth_axis: DVec3, u: DVec3, v: DVec3) -> Bias {
    let facing = -normal.dot(depth_axis);
    let sine = (1.0 - facing * facing).max(0.0).sqrt();
    let cosine = facing.max(sine / STEEPEST).max(1e-6);
    let slope = sine / cosine;
    let [shorter, longer] = [u.length().min(v.length()), u.length().max(v.length())];
    Bias {
        depth_per_texel: DVec2::new(normal.dot(u), normal.dot(v)) / cosine,
        corner_per_texel: DVec2::splat(shorter) * (FOLD * (1.0 + slope * slope)).clamp(CORNER.0, CORNER.1),
        constant_m: CONSTANT * longer,
    }
}
