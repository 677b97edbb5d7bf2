//! Parsing of budgets.

use std::str::FromStr;

use super::{BYTES, Budget, TEXELS};
use crate::{Error, Result};

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
