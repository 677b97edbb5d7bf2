//! The view that all plots of the theory share: the defaults of the command line.

use glam::DVec3;
use umbrage::{Aabb, Frustum, View};

use super::Result;

/// A view and the sizes of its picture and maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Near distance in metres, `C_0`.
    pub near: f64,
    /// Far distance in metres, `C_m`.
    pub far: f64,
    /// Full vertical angle in degrees.
    pub fov: f64,
    /// Width and height of the picture in pixels.
    pub image_size: [u32; 2],
    /// Edge of each split's map in texels.
    pub map_size: u32,
}

impl Default for Setting {
    fn default() -> Self {
        Self { near: 1.0, far: 800.0, fov: 60.0, image_size: [800, 600], map_size: 512 }
    }
}

impl Setting {
    /// Makes a level view from the origin along −Z.
    ///
    /// # Errors
    /// If near, far or fov make no frustum.
    pub fn view(&self) -> Result<View> {
        let aspect = f64::from(self.image_size[0]) / f64::from(self.image_size[1]);
        let frustum = Frustum::perspective(self.fov.to_radians(), aspect, self.near, self.far)?;
        Ok(View::look_at_upright(DVec3::ZERO, DVec3::NEG_Z, frustum)?)
    }

    /// Returns a box around everything in sight, as caster and receiver.
    #[must_use]
    pub fn surroundings(&self) -> Aabb {
        let reach = DVec3::splat(4.0 * self.far);
        Aabb::new(-reach, reach)
    }

    /// Describes the setting in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let [width, height] = self.image_size;
        format!("{} to {} m, {}° upright, {width} × {height} pixels", self.near, self.far, self.fov)
    }
}
