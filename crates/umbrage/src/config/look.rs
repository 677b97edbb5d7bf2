//! What a shadow looks like, beside where it falls.

use super::names::named;

/// What a shadow looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How dark a shadow is, 0 (not at all) to 1 (no light).
    pub strength: f64,
    /// Factor of the light in full shadow: linear red, green and blue, 0 to 1.
    pub colour: [f64; 3],
    /// How receivers are kept from shading themselves.
    pub bias: ReceiverBias,
    /// Whether translucent surfaces throw shadows.
    pub translucent: Translucent,
    /// Whether the picture's own depth is searched for casters too close for the maps.
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
    /// How a receiver is kept from shading itself. Both ways follow from texel, slope and filter
    /// width in metres and have no number to choose.
    pub enum ReceiverBias as "bias" {
        /// Each texel is compared with the surface's own plane
        #[default]
        Plane = "plane",
        /// All texels are compared with one depth: forgives inexact normals, loses contact
        Slope = "slope",
    }
}

named! {
    /// Whether translucent surfaces (glTF's alpha mode `BLEND`) throw shadows.
    pub enum Translucent as "rule for translucent surfaces" {
        /// They throw none
        #[default]
        None = "none",
        /// They cover as many texels of a map as their alpha says
        Dithered = "dithered",
    }
}

/// The words of a switch.
pub(crate) const SWITCH: &[super::Word] =
    &[super::Word { word: "on", help: "With" }, super::Word { word: "off", help: "Without" }];
