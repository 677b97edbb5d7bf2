//! The order in which neighbours in space are neighbours in memory.

use glam::DVec3;

use crate::Aabb;

/// Bits of a coordinate in a code.
const BITS: u32 = 21;

/// Codes of places along a curve through a box that visits what is near before what is far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve {
    origin: DVec3,
    cells_per_metre: f64,
}

impl Curve {
    /// Through a box; its cells are cubes.
    pub fn through(bounds: Aabb) -> Self {
        let extent = (bounds.max - bounds.min).max_element();
        let cells = f64::from((1u32 << BITS) - 1);
        let cells_per_metre = if extent > 0.0 { cells / extent } else { 0.0 };
        Self { origin: bounds.min, cells_per_metre }
    }

    /// The place of a point of the box.
    pub fn code(&self, point: DVec3) -> u64 {
        let cell = (point - self.origin) * self.cells_per_metre;
        cell.to_array().into_iter().enumerate().map(|(axis, at)| spread(at as u64) << axis).sum()
    }
}

/// The bits of a coordinate, each followed by two zeros.
fn spread(cell: u64) -> u64 {
    let mut bits = cell.min((1 << BITS) - 1);
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_interleaved() {
        for cell in [0u64, 1, 2, 0b1011, (1 << BITS) - 1] {
            let expected = (0..BITS).map(|bit| (cell >> bit & 1) << (3 * bit)).sum::<u64>();
            assert_eq!(spread(cell), expected);
        }
    }

    #[test]
    fn a_point_has_one_place_and_no_extent_is_no_harm() {
        let curve = Curve::through(Aabb::new(DVec3::ZERO, DVec3::splat(8.0)));
        assert!(curve.code(DVec3::ZERO) < curve.code(DVec3::splat(1.0)));
        assert!(curve.code(DVec3::new(3.0, 3.0, 3.0)) < curve.code(DVec3::new(5.0, 0.0, 0.0)));
        let point = Curve::through(Aabb::new(DVec3::ONE, DVec3::ONE));
        assert_eq!(point.code(DVec3::ONE), 0);
    }
}
