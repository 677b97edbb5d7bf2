//! Maps that a budget of memory or texels pays for.

mod config;
mod parse;

use std::fmt;

/// Edges of maps are multiples of so many texels. Devices keep textures in tiles of 8² and larger,
/// and the rest of a tile would take memory without being used.
const EDGE_STEP: u32 = 8;

/// The widest map in texels: the widest texture that every WebGPU device has.
const WIDEST: u32 = 8192;

/// Multiples of bytes by name, those of 1024 before those of 1000.
const BYTES: [(&str, u64); 7] = [
    ("GiB", 1 << 30),
    ("MiB", 1 << 20),
    ("KiB", 1 << 10),
    ("GB", 1_000_000_000),
    ("MB", 1_000_000),
    ("kB", 1000),
    ("B", 1),
];

/// Multiples of texels by name.
const TEXELS: [(&str, u64); 3] = [("Mtexel", 1 << 20), ("Ktexel", 1 << 10), ("texel", 1)];

/// Budget of shadow maps: bytes, or texels of all maps together.
///
/// ```
/// use umbrage::config::Budget;
///
/// assert_eq!("8MiB".parse(), Ok(Budget::Bytes(8 << 20)));
/// assert_eq!("2Mtexel".parse(), Ok(Budget::Texels(2 << 20)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Budget {
    /// Memory of all maps of one sun, in bytes.
    Bytes(u64),
    /// Number of texels of all maps of one sun.
    Texels(u64),
}

impl Budget {
    /// Number of texels that the budget pays for at `texel_bytes` bytes each.
    #[must_use]
    pub const fn texels(self, texel_bytes: u64) -> u64 {
        match self {
            Self::Bytes(bytes) => match texel_bytes {
                0 => u64::MAX,
                _ => bytes / texel_bytes,
            },
            Self::Texels(texels) => texels,
        }
    }

    /// Edge in texels of the largest square maps of which the budget pays for `maps`: a multiple of
    /// 8 up to 8192, the widest texture that every WebGPU device has. 0 if the budget pays for
    /// none.
    #[must_use]
    pub const fn edge(self, maps: usize, texel_bytes: u64) -> u32 {
        if maps == 0 {
            return 0;
        }
        let edge = (self.texels(texel_bytes) / maps as u64).isqrt();
        let edge = if edge < WIDEST as u64 { edge as u32 } else { WIDEST };
        edge - edge % EDGE_STEP
    }

    /// The budget that `texels` texels take, in the unit of this one.
    #[must_use]
    pub const fn of_texels(self, texels: u64, texel_bytes: u64) -> Self {
        match self {
            Self::Bytes(_) => Self::Bytes(texels * texel_bytes),
            Self::Texels(_) => Self::Texels(texels),
        }
    }

    /// A share of the budget, from 0 to 1, rounded down.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share in 0..=1 of a whole number")]
    pub fn share(self, share: f64) -> Self {
        let of = |amount: u64| (amount as f64 * share.clamp(0.0, 1.0)) as u64;
        match self {
            Self::Bytes(bytes) => Self::Bytes(of(bytes)),
            Self::Texels(texels) => Self::Texels(of(texels)),
        }
    }
}

impl fmt::Display for Budget {
    /// In the largest unit that divides it, multiples of 1024 before those of 1000.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (amount, units) = match *self {
            Self::Bytes(bytes) => (bytes, &BYTES[..]),
            Self::Texels(texels) => (texels, &TEXELS[..]),
        };
        let unit = units.iter().find(|(_, factor)| amount >= *factor && amount.is_multiple_of(*factor));
        let (name, factor) = unit.copied().unwrap_or(units[units.len() - 1]);
        write!(f, "{} {name}", amount / factor)
    }
}
