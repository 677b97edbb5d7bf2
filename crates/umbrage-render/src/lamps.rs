//! The lights of a frame, and how the picture shades by them.
//!
//! A picture has no exposure and glTF's candela know no screen, so all lights are shown equally
//! bright: a sun as it is, a local light by a curve of distance over range, `(1 − (d/r)²)² / (1 +
//! (d / 0.3 r)²)`, which is 1 at the lamp and 0 at its range, and within a spot light's cone by a
//! smooth step from the outer to the inner angle. Their colours are the scene's.

use glam::{DVec3, Vec3};
use umbrage::{DirectionalLight, Light};

use crate::{Error, Result};

/// Largest number of lights in one frame.
pub const MOST_LAMPS: usize = 8;

/// A light as the picture shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// The light that casts shadows.
    pub light: Light,
    /// Colour in linear RGB, 1 at most.
    pub color: Vec3,
    /// Angle in radians around a spot light's axis within which it is as bright as on the axis;
    /// ignored for other lights.
    pub inner_angle: f64,
}

impl From<Light> for Lamp {
    /// Makes a white light. A spot light softens over its outer half.
    fn from(light: Light) -> Self {
        let inner_angle = if let Light::Spot(spot) = light { 0.5 * spot.outer_angle() } else { 0.0 };
        Self { light, color: Vec3::ONE, inner_angle }
    }
}

impl From<DirectionalLight> for Lamp {
    fn from(sun: DirectionalLight) -> Self {
        Light::from(sun).into()
    }
}

/// `Lamp` in `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct LampUniform {
    /// Position relative to the origin, in metres.
    pub position: [f32; 3],
    /// Range in metres; 0 for a sun.
    pub range: f32,
    /// Unit vector towards a sun, or against a spot light's axis.
    pub to_light: [f32; 3],
    /// Cosine of the outer angle of a spot light's cone; −2 without a cone.
    pub outer_cosine: f32,
    pub color: [f32; 3],
    pub inner_cosine: f32,
}

impl LampUniform {
    fn new(lamp: &Lamp, origin: DVec3) -> Self {
        let at = |position: DVec3| (position - origin).as_vec3().to_array();
        let towards = |travel: DVec3| (-travel).as_vec3().to_array();
        let shape = match lamp.light {
            Light::Directional(sun) => {
                Self { to_light: towards(sun.direction()), outer_cosine: -2.0, ..Self::default() }
            }
            Light::Point(point) => Self {
                position: at(point.position()),
                range: point.range() as f32,
                outer_cosine: -2.0,
                ..Self::default()
            },
            Light::Spot(spot) => {
                // A cone as sharp as can be still needs two different cosines to step between.
                let inner = lamp.inner_angle.min(0.999 * spot.outer_angle());
                Self {
                    position: at(spot.position()),
                    range: spot.range() as f32,
                    to_light: towards(spot.direction()),
                    outer_cosine: spot.outer_angle().cos() as f32,
                    inner_cosine: inner.cos() as f32,
                    ..Self::default()
                }
            }
        };
        Self { color: lamp.color.to_array(), ..shape }
    }

    /// Makes the uniforms of all lights of a frame.
    pub fn all(lamps: &[Lamp], origin: DVec3) -> Result<[Self; MOST_LAMPS]> {
        if lamps.len() > MOST_LAMPS {
            return Err(Error::LampCount { count: lamps.len(), most: MOST_LAMPS });
        }
        let mut all = [Self::default(); MOST_LAMPS];
        all.iter_mut().zip(lamps).for_each(|(uniform, lamp)| *uniform = Self::new(lamp, origin));
        Ok(all)
    }
}
