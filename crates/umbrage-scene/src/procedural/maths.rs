//! Arithmetic that gives the same bits on every machine: `libm` for the transcendental functions,
//! `f64` vectors (which `glam` computes without SIMD), and one small random generator.

use glam::{DMat3, DQuat, DVec3};

/// Returns sine and cosine of an angle in degrees.
pub(super) fn sin_cos(degrees: f64) -> (f64, f64) {
    libm::sincos(degrees.to_radians())
}

/// Returns a rotation by `degrees` about a unit `axis`, counter-clockwise seen from the axis' tip.
pub(super) fn turn(axis: DVec3, degrees: f64) -> DQuat {
    let (sin, cos) = sin_cos(0.5 * degrees);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}

/// Returns the rotation that brings −Z to `direction` (any length) and keeps +Y as far up as it
/// can, as cameras and lights use it.
pub(super) fn looking_along(direction: DVec3) -> DQuat {
    let back = -direction.normalize();
    let up = if back.y.abs() > 1.0 - 1e-9 { DVec3::NEG_Z } else { DVec3::Y };
    let right = up.cross(back).normalize();
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize()
}

/// Interpolates from 0 below `low` to 1 above `high`, by a cubic with level ends.
pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Interpolates from `a` at `t` = 0 to `b` at `t` = 1.
pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Hashes bits by the finaliser of SplitMix64: every input bit affects every output bit.
pub(super) fn scramble(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

/// Returns the top 53 bits as a number in [0, 1).
pub(super) fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// Random generator SplitMix64 (Steele, Lea, Flood 2014): a seeded stream of numbers, good enough
/// to scatter robots.
#[derive(Clone, Debug)]
pub(super) struct Random(u64);

impl Random {
    /// Starts a stream. Every seed gives another one.
    pub(super) fn new(seed: u64) -> Self {
        Self(scramble(seed ^ 0x5DEE_CE66_D6A5_7F3B))
    }

    /// Returns a number that is evenly distributed in [low, high).
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mix(low, high, unit(scramble(self.0)))
    }

    /// Returns an index below `count`.
    pub(super) fn index(&mut self, count: usize) -> usize {
        (self.between(0.0, count as f64) as usize).min(count - 1)
    }
}
