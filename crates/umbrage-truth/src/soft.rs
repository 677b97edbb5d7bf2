//! Exact soft shadows of a sun with an angular size: the mean of many hard visibilities.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use image::GrayAlphaImage;
use rayon::prelude::*;

use crate::mask::mask_image;
use crate::truth::Seen;
use crate::{Error, Result, Truth, TruthMask};

/// Fewest and most directions of a set.
const SAMPLES: std::ops::RangeInclusive<u32> = 1..=1 << 20;

/// A sun of a given size, and the directions towards it that are sampled. They are the same for
/// every point.
///
/// The directions are Vogel's spiral (H. Vogel, "A better way to construct the sunflower head",
/// Mathematical Biosciences 44, 1979): direction i of N stands at radius √((i + ½)/N) and angle
/// i·π(3 − √5) on the disc, so that every direction stands for the same area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunDisc {
    /// Angle across the disc in radians; more than 0, at most π/2. The real sun has 0.0093 (0.53°).
    pub angular_diameter: f64,
    /// Number of directions: 256 for quick tests, 1,024 for tables.
    pub samples: u32,
    /// Rotation of the spiral in radians. Sets with different rotations are different sets. The
    /// difference of their results is the noise floor.
    pub turn: f64,
}

impl SunDisc {
    /// Makes a disc with an unturned spiral.
    #[must_use]
    pub const fn new(angular_diameter: f64, samples: u32) -> Self {
        Self { angular_diameter, samples, turn: 0.0 }
    }

    /// Returns the disc with another set of directions, to measure the noise floor.
    #[must_use]
    pub const fn other_set(self) -> Self {
        Self { turn: self.turn + 1.0, ..self }
    }

    /// Returns unit vectors towards the disc around `to_light`.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the field that is out of range.
    pub fn directions(&self, to_light: DVec3) -> Result<Vec<DVec3>> {
        if !(self.angular_diameter > 0.0 && self.angular_diameter <= 0.5 * PI) {
            let reason = format!("{} rad; give more than 0 and at most a right angle", self.angular_diameter);
            return Err(Error::setting("angular_diameter", reason));
        }
        if !SAMPLES.contains(&self.samples) {
            let reason = format!("{}; give {} to {}", self.samples, SAMPLES.start(), SAMPLES.end());
            return Err(Error::setting("samples", reason));
        }
        if !self.turn.is_finite() {
            return Err(Error::setting("turn", format!("{} is not an angle; give radians", self.turn)));
        }
        let to_light = to_light
            .try_normalize()
            .ok_or_else(|| Error::setting("sun", format!("{to_light} is not a direction; give one that is not 0")))?;
        let (u, v) = to_light.any_orthonormal_pair();
        let rim = (0.5 * self.angular_diameter).tan();
        let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
        Ok((0..self.samples)
            .map(|i| {
                let radius = rim * ((f64::from(i) + 0.5) / f64::from(self.samples)).sqrt();
                let angle = (f64::from(i) * golden_angle + self.turn) % TAU;
                (to_light + radius * (angle.cos() * u + angle.sin() * v)).normalize()
            })
            .collect())
    }
}

/// Ground truth of soft shadows, V*_A: the share of the sun's disc that each pixel sees.
#[derive(Clone, Debug)]
pub struct SoftTruth {
    size: [usize; 2],
    visibility: Vec<Option<f32>>,
}

impl Truth {
    /// Traces rays from every hit of a hard mask in all directions of the disc. Directions below
    /// the surface's own horizon (n·l' ≤ 0) count as shadow. `progress` as in [`Truth::mask`].
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming the field of the disc that is out of range, or that the
    /// mask's light is no sun.
    pub fn soft(&self, mask: &TruthMask, disc: &SunDisc, progress: &(dyn Fn(f32) + Sync)) -> Result<SoftTruth> {
        if mask.light().position().is_some() {
            let reason = "a lamp has no angle across; give it with a directional light";
            return Err(Error::setting("angular_diameter", reason));
        }
        let directions = disc.directions(mask.light().to_light(DVec3::ZERO))?;
        let [width, height] = mask.size();
        let mut visibility = vec![None; width * height];
        let rows = AtomicUsize::new(0);
        visibility.par_chunks_mut(width).enumerate().for_each_init(Vec::new, |stack, (y, answers)| {
            for (x, answer) in answers.iter_mut().enumerate() {
                let pixel = y * width + x;
                *answer = mask.hits()[pixel]
                    .map(|hit| self.visible_share(&mask.seen(self, pixel, &hit), hit.normal, &directions, stack));
            }
            progress((rows.fetch_add(1, Ordering::Relaxed) + 1) as f32 / height as f32);
        });
        Ok(SoftTruth { size: [width, height], visibility })
    }

    /// Returns V*_A of world points with their normals. No triangle is known as a point's own; see
    /// [`Truth::visibility_at`].
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the light has no direction, the disc is out of range or a point
    /// is not finite.
    pub fn soft_visibility_at(
        &self,
        points: &[(DVec3, DVec3)],
        light_travel: DVec3,
        disc: &SunDisc,
    ) -> Result<Vec<f32>> {
        let directions = disc.directions(-light_travel)?;
        if let Some(bad) = points.iter().position(|(point, normal)| !(point.is_finite() && normal.is_finite())) {
            return Err(Error::setting("points", format!("point {bad} is not finite; give numbers in metres")));
        }
        Ok(points
            .par_iter()
            .map_init(Vec::new, |stack, &(point, normal)| {
                self.visible_share(&self.probed(point, normal), normal, &directions, stack)
            })
            .collect())
    }

    fn visible_share(&self, point: &Seen, normal: DVec3, directions: &[DVec3], stack: &mut Vec<u32>) -> f32 {
        let seen = directions
            .iter()
            .filter(|&&to_light| normal.dot(to_light) > 0.0 && self.sees_light(point, to_light, f64::INFINITY, stack))
            .count();
        seen as f32 / directions.len() as f32
    }
}

impl SoftTruth {
    /// Makes a soft truth from given values, for tests.
    #[cfg(test)]
    pub(crate) fn from_values(size: [usize; 2], visibility: Vec<Option<f32>>) -> Self {
        assert_eq!(visibility.len(), size[0] * size[1]);
        Self { size, visibility }
    }

    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns one share per pixel, row by row from the upper left, in `[0, 1]`; `None` where the
    /// ray meets nothing.
    #[must_use]
    pub fn visibility(&self) -> &[Option<f32>] {
        &self.visibility
    }

    /// Draws a mask image: 255 where the whole sun is visible, 0 where none of it is; alpha 0 where
    /// nothing was hit.
    #[must_use]
    pub fn to_image(&self) -> GrayAlphaImage {
        mask_image(self.size, self.visibility.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_fill_the_disc_evenly() {
        let axis = DVec3::new(0.3, 0.8, -0.5).normalize();
        let disc = SunDisc::new(0.1, 1024);
        for disc in [disc, disc.other_set()] {
            let directions = disc.directions(axis).unwrap();
            assert_eq!(directions.len(), 1024);
            let widest = directions.iter().map(|d| d.angle_between(axis)).fold(0.0, f64::max);
            assert!(widest < 0.05 && widest > 0.0499, "{widest}");
            // The mean is the axis, and half of the disc lies on either side of any plane through
            // the axis.
            let mean = directions.iter().sum::<DVec3>() / 1024.0;
            assert!(mean.normalize().angle_between(axis) < 1e-4);
            for side in [axis.any_orthonormal_pair().0, axis.any_orthonormal_pair().1] {
                let half = directions.iter().filter(|d| d.dot(side) > 0.0).count();
                assert!(half.abs_diff(512) <= 6, "{half}");
            }
        }
        assert_ne!(disc.directions(axis).unwrap()[0], disc.other_set().directions(axis).unwrap()[0]);
    }

    #[test]
    fn settings_out_of_range_are_named() {
        let good = SunDisc::new(0.01, 16);
        for (bad, field) in [
            (SunDisc { angular_diameter: 0.0, ..good }, "angular_diameter"),
            (SunDisc { angular_diameter: f64::NAN, ..good }, "angular_diameter"),
            (SunDisc { angular_diameter: 2.0, ..good }, "angular_diameter"),
            (SunDisc { samples: 0, ..good }, "samples"),
            (SunDisc { turn: f64::INFINITY, ..good }, "turn"),
        ] {
            let error = bad.directions(DVec3::Y).unwrap_err().to_string();
            assert!(error.starts_with(field), "{error}");
        }
        assert!(good.directions(DVec3::ZERO).unwrap_err().to_string().starts_with("sun"));
    }
}
