//! What filters of moments leave to choose, and what is to be said of them.

use umbrage_wgpu::{Derivatives, Filter, MomentStorage};

/// What filters of moments leave to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MomentSettings {
    /// Samples of depth in a texel: 1 or 4.
    pub samples: u32,
    /// Whether they may fall back to what the device has.
    pub fallbacks: bool,
    /// How they know what a pixel covers.
    pub derivatives: Derivatives,
}

impl Default for MomentSettings {
    fn default() -> Self {
        Self { samples: 1, fallbacks: true, derivatives: Derivatives::default() }
    }
}

/// What to say of a device that keeps moments otherwise than in 32-bit floats with the hardware's filter.
pub(crate) fn note(storage: MomentStorage, filter: Filter) -> Option<String> {
    match storage {
        MomentStorage::Floats => None,
        MomentStorage::Halves => Some(format!(
            "no filterable 32-bit floats: {filter:?} is kept in 16-bit floats, with smaller exponents, and leaks more"
        )),
        MomentStorage::FloatsByHand => {
            Some(format!("no filterable 32-bit floats: the shader filters the moments of {filter:?} itself"))
        }
    }
}
