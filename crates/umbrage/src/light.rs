//! Lights, and the space in which their maps lie.

use glam::DVec3;

use crate::{Error, Result};

/// A sun: light that travels in one direction everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    direction: DVec3,
}

impl DirectionalLight {
    /// `direction` is the way the light travels (from the sun to the ground); it need not be normalised.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] if the vector is zero or not finite.
    pub fn new(direction: DVec3) -> Result<Self> {
        let length = direction.length();
        if length == 0.0 || !length.is_finite() {
            return Err(Error::InvalidLight {
                field: "direction",
                reason: format!(
                    "{direction} has no direction; give the way the light travels as three finite numbers, not all zero"
                ),
            });
        }
        Ok(Self { direction: direction / length })
    }

    /// The way the light travels, a unit vector in the world.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// The light's own basis, fixed to the light and never to the camera: unit vectors along a map's u (right) and
    /// v (down). Together with [`DirectionalLight::direction`] (depth) they are a right-handed frame (u, v, depth).
    #[must_use]
    pub fn map_axes(&self) -> (DVec3, DVec3) {
        // −Z is "up" for a light that comes straight down, so a map then has north on top.
        let up = if self.direction.y.abs() > 1.0 - 1e-6 { DVec3::NEG_Z } else { DVec3::Y };
        let u = self.direction.cross(up).normalize();
        (u, self.direction.cross(u))
    }
}
