//! Look of a shadow: everything but its shape.

use super::names::named;

/// Look of a shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Darkness of a shadow, 0 (none) to 1 (no light).
    pub strength: f64,
    /// Factor of the light in full shadow: linear red, green and blue, 0 to 1.
    pub colour: [f64; 3],
    /// Method that keeps receivers from shading themselves.
    pub bias: ReceiverBias,
    /// Rule for shadows of translucent surfaces.
    pub translucent: Translucent,
    /// True for screen-space contact shadows: detail too small for the maps, from the image's own
    /// depth.
    pub contact: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            strength: 1.0,
            colour: [0.0; 3],
            bias: ReceiverBias::default(),
            translucent: Translucent::default(),
            contact: false,
        }
    }
}

named! {
    /// Method that keeps a receiver from shading itself. Both follow from texel, slope and filter
    /// width in metres and have no parameter.
    pub enum ReceiverBias as "bias" {
        /// Each texel is compared with the surface's own plane
        #[default]
        Plane = "plane",
        /// All texels are compared with one depth: forgives inexact normals, loses contact
        Slope = "slope",
    }
}

named! {
    /// Rule for shadows of translucent surfaces (glTF's alpha mode `BLEND`).
    pub enum Translucent as "rule for translucent surfaces" {
        /// They cast none
        #[default]
        None = "none",
        /// They cover a share of a map's texels equal to their alpha
        Dithered = "dithered",
    }
}
