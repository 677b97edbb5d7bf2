//! Gradient noise (Perlin 2002) over hashed lattices, and sums of its octaves.

use glam::{DVec2, DVec3};

use super::maths::{mix, scramble, sin_cos, unit};

fn lattice(seed: u64, x: f64, y: f64, z: f64) -> u64 {
    // Coordinates are small whole numbers, so the casts are exact.
    let mut bits = scramble(seed.wrapping_add(x as i64 as u64));
    bits = scramble(bits.wrapping_add(y as i64 as u64));
    scramble(bits.wrapping_add(z as i64 as u64))
}

fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Returns smooth noise of the plane, about −0.7 to 0.7, one bump per unit; 0 at whole coordinates.
pub(super) fn plane(seed: u64, at: DVec2) -> f64 {
    let cell = at.floor();
    let f = at - cell;
    let corner = |dx: f64, dy: f64| {
        let (sin, cos) = sin_cos(360.0 * unit(lattice(seed, cell.x + dx, cell.y + dy, 0.0)));
        cos * (f.x - dx) + sin * (f.y - dy)
    };
    let south = mix(corner(0.0, 0.0), corner(1.0, 0.0), fade(f.x));
    let north = mix(corner(0.0, 1.0), corner(1.0, 1.0), fade(f.x));
    mix(south, north, fade(f.y))
}

/// Returns smooth noise of space, about −0.9 to 0.9, one bump per unit; 0 at whole coordinates.
pub(super) fn space(seed: u64, at: DVec3) -> f64 {
    let cell = at.floor();
    let f = at - cell;
    let corner = |dx: f64, dy: f64, dz: f64| {
        let bits = lattice(seed, cell.x + dx, cell.y + dy, cell.z + dz);
        // A point of the sphere from two of its coordinates: height and angle.
        let height = mix(-1.0, 1.0, unit(bits));
        let (sin, cos) = sin_cos(360.0 * unit(scramble(bits)));
        let around = (1.0 - height * height).max(0.0).sqrt();
        DVec3::new(around * cos, height, around * sin).dot(f - DVec3::new(dx, dy, dz))
    };
    let edge = |dy, dz| mix(corner(0.0, dy, dz), corner(1.0, dy, dz), fade(f.x));
    let face = |dz| mix(edge(0.0, dz), edge(1.0, dz), fade(f.y));
    mix(face(0.0), face(1.0), fade(f.z))
}

/// Sums octaves of [`plane`]. Each has twice the frequency and `gain` times the height of the one
/// before.
pub(super) fn plane_octaves(seed: u64, at: DVec2, octaves: u32, gain: f64) -> f64 {
    octave_sum(octaves, gain, |octave, frequency| plane(seed + u64::from(octave), at * frequency))
}

/// Sums octaves of [`space`]. Each has twice the frequency and `gain` times the height of the one
/// before.
pub(super) fn space_octaves(seed: u64, at: DVec3, octaves: u32, gain: f64) -> f64 {
    octave_sum(octaves, gain, |octave, frequency| space(seed + u64::from(octave), at * frequency))
}

fn octave_sum(octaves: u32, gain: f64, noise: impl Fn(u32, f64) -> f64) -> f64 {
    let (mut sum, mut amplitude, mut frequency) = (0.0, 1.0, 1.0);
    for octave in 0..octaves {
        sum += amplitude * noise(octave, frequency);
        amplitude *= gain;
        frequency *= 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_zero_on_the_lattice_and_continuous_across_it() {
        for x in -3..3 {
            for y in -3..3 {
                let at = DVec2::new(f64::from(x), f64::from(y));
                assert_eq!(plane(7, at), 0.0, "at {at}");
                let step = DVec2::splat(1e-9);
                assert!((plane(7, at - step) - plane(7, at + step)).abs() < 1e-8, "at {at}");
                let solid = at.extend(2.0);
                assert_eq!(space(7, solid), 0.0, "at {solid}");
            }
        }
    }

    #[test]
    fn noise_differs_between_seeds_and_stays_small() {
        let mut differences = 0;
        for i in 0..1000 {
            let at = DVec2::new(f64::from(i) * 0.37, f64::from(i) * -0.73);
            assert!(plane(1, at).abs() <= 1.0 && space(1, at.extend(0.4)).abs() <= 1.0, "at {at}");
            differences += usize::from((plane(1, at) - plane(2, at)).abs() > 1e-3);
        }
        assert!(differences > 900, "{differences} of 1000 samples differ");
    }
}
