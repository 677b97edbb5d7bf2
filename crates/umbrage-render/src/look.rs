//! How shadows look, beside where they fall.

use umbrage_wgpu::ReceiverBias;

/// How shadows look. Settled before the first frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How dark a shadow is, 0 (not at all) to 1 (no sun). Masks show it, too.
    pub strength: f32,
    /// What the sun's light is multiplied by in full shadow, linear red, green and blue. Pictures alone show it.
    pub colour: [f32; 3],
    /// How receivers are kept from shading themselves.
    pub bias: ReceiverBias,
}

impl Default for Look {
    fn default() -> Self {
        Self { strength: 1.0, colour: [0.0; 3], bias: ReceiverBias::default() }
    }
}
