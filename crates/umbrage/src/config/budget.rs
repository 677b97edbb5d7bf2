//! Maps that a budget of memory or texels pays for.

use std::fmt;
use std::str::FromStr;

use super::{Filter, Preset, ShadowConfig};
use crate::margin::FilterReach;
use crate::{Error, Result};

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

    /// Edge in texels of the smallest map that [`Budget::edge`] gives and in which a filter works.
    #[must_use]
    pub fn least_edge(filter: &Filter, is_stabilised: bool) -> u32 {
        let margins = FilterReach::from(filter).least_map_size(is_stabilised);
        filter.least_map_size().max(margins).next_multiple_of(EDGE_STEP)
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

impl FromStr for Budget {
    type Err = Error;

    /// A number and its unit: `8MB`, `8 MiB`, `1.5Mtexel`.
    fn from_str(text: &str) -> Result<Self> {
        let refuse = |reason: String| Error::InvalidBudget { text: text.trim().to_owned(), reason };
        let end = text.trim().find(|c: char| c.is_alphabetic()).unwrap_or(text.trim().len());
        let (number, unit) = text.trim().split_at(end);
        let known = |units: &[(&str, u64)]| units.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor);
        let (factor, budget): (u64, fn(u64) -> Self) = match (known(&BYTES), known(&TEXELS)) {
            (Some(factor), _) => (factor, Self::Bytes),
            (None, Some(factor)) => (factor, Self::Texels),
            (None, None) => {
                let names = BYTES.iter().chain(&TEXELS).map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
                let reason =
                    if unit.is_empty() { "it has no unit".to_owned() } else { format!("{unit:?} is not a known unit") };
                return Err(refuse(format!("{reason}; give one of {names}, as in 8MiB")));
            }
        };
        let number: f64 = number
            .trim()
            .parse()
            .map_err(|_| refuse(format!("{:?} is not a number; write for example 8MiB", number.trim())))?;
        let amount = (number * factor as f64).floor();
        // Beyond 2^53 a float no longer counts.
        if !(1.0..=9_007_199_254_740_992.0).contains(&amount) {
            return Err(refuse("out of range; give at least 1 B or 1 texel, at most 8 PiB".to_owned()));
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
        Ok(budget(amount as u64))
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

/// Number of splits and filter from a number of texels on.
struct Rung {
    texels: u64,
    splits: usize,
    filter: Filter,
}

/// The best number of splits hardly depends on the budget (docs/notes/budget.md): four, and fewer
/// where maps of four would be narrower than 64 texels. Each rung begins where its maps take every
/// texel of the budget, so that no larger budget has fewer texels.
const RUNGS: [Rung; 3] = [
    Rung { texels: 0, splits: 1, filter: Filter::Pcf3 { width_m: None } },
    Rung { texels: 2 * 64 * 64, splits: 2, filter: Filter::Pcf3 { width_m: None } },
    Rung { texels: 4 * 64 * 64, splits: 4, filter: Filter::Pcf3 { width_m: None } },
];

impl ShadowConfig {
    /// [`Preset::Balanced`] within a budget, which decides the number of splits, the sizes of maps
    /// and the filter. Maps never take more than the budget; a larger budget never has fewer
    /// texels.
    ///
    /// ```
    /// use umbrage::config::{Budget, ShadowConfig};
    ///
    /// let config = ShadowConfig::for_budget("8MiB".parse()?)?;
    /// assert!(4 * config.texels() <= 8 << 20);
    /// # Ok::<(), umbrage::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::BudgetTooSmall`] if the budget does not pay for the map of a single split. The
    /// error contains the least budget that does.
    pub fn for_budget(budget: Budget) -> Result<Self> {
        let balanced = Preset::Balanced.config();
        let texel_bytes = balanced.depth_format.texel_bytes();
        let rung = RUNGS.iter().rev().find(|rung| budget.texels(texel_bytes) >= rung.texels).unwrap_or(&RUNGS[0]);
        let least = Budget::least_edge(&rung.filter, balanced.is_stabilised());
        let edge = budget.edge(rung.splits, texel_bytes);
        if edge < least {
            let least = budget.of_texels(u64::from(least) * u64::from(least), texel_bytes);
            return Err(Error::BudgetTooSmall { budget, least });
        }
        Ok(Self { map_sizes: vec![edge; rung.splits], filter: rung.filter, ..balanced })
    }
}
