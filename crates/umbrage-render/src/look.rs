//! How shadows look, beside where they fall.

use umbrage_wgpu::{ContactOptions, ReceiverBias};

/// Whether translucent surfaces (glTF's alpha mode `BLEND`) throw shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Translucent {
    /// They throw none, as the judge has it.
    #[default]
    None,
    /// They cover as many texels of a map as their alpha says, in a pattern that stands still in the light's plane; soft filters make a
    /// lighter shadow of it.
    Dithered,
}

/// How shadows look. Settled before the first frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How dark a shadow is, 0 (not at all) to 1 (no sun). Masks show it, too.
    pub strength: f32,
    /// What the sun's light is multiplied by in full shadow, linear red, green and blue. Pictures alone show it.
    pub colour: [f32; 3],
    /// How receivers are kept from shading themselves.
    pub bias: ReceiverBias,
    /// Whether translucent surfaces throw shadows.
    pub translucent: Translucent,
    /// Contact shadows from the picture's own depth, in pictures and masks; probes know the maps alone. None on GL.
    pub contact: Option<ContactOptions>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            strength: 1.0,
            colour: [0.0; 3],
            bias: ReceiverBias::default(),
            translucent: Translucent::None,
            contact: None,
        }
    }
}
