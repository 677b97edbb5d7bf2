//! What a shadow looks like, beside where it falls.

use super::names::named;

/// What a shadow looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How dark a shadow is, 0 (not at all) to 1 (no light).
    pub strength: f64,
    /// Factor of the light in full shadow: linear red, green and blue, 0 to 1.
    pub colour: [f64; 3],
    /// How receivers are prevented from shading themselves.
    pub bias: ReceiverBias,
    /// Whether translucent surfaces cast shadows.
    pub translucent: Translucent,
    /// Screen-space contact shadows: detail too small for the maps, from the picture's own depth.
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
    /// How a receiver is prevented from shading itself. Both ways follow from texel, slope and
    /// filter width in metres and have no number to choose.
    pub enum ReceiverBias as "bias" {
        /// Each texel is compared with the surface's own plane
        #[default]
        Plane = "plane",
        /// All texels are compared with one depth: forgives inexact normals, loses contact
        Slope = "slope",
    }
}

named! {
    /// Whether translucent surfaces (glTF's alpha mode `BLEND`) cast shadows.
    pub enum Translucent as "rule for translucent surfaces" {
        /// They cast none
        #[default]
        None = "none",
        /// They cover a share of a map's texels equal to their alpha
        Dithered = "dithered",
    }
}
