//! Comparisons of techniques.

use crate::{Error, Result};

/// Comparison of one technique with another over the same views: the first one's score minus the
/// second one's, so that less than 0 is better.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Paired {
    /// Mean of the differences.
    pub mean_difference: f64,
    /// Standard error of the mean difference; `None` for one view.
    pub standard_error: Option<f64>,
    /// Number of views in which the first technique scores lower, and so is better.
    pub first_better: usize,
    /// Number of views in which the second technique is better.
    pub second_better: usize,
    /// Number of views in which both score the same.
    pub ties: usize,
}

impl Paired {
    /// Returns the number of views compared.
    #[must_use]
    pub fn views(&self) -> usize {
        self.first_better + self.second_better + self.ties
    }
}

/// Compares two techniques by their scores in the same views, view by view. Leave out views that do
/// not count ([`super::Domain::counts_as_view`]) beforehand.
///
/// # Errors
/// [`Error::SizeMismatch`] if the lists differ in length, [`Error::NothingToScore`] if they are
/// empty, and [`Error::InvalidSetting`] for a score that is not finite.
pub fn paired(first: &[f64], second: &[f64]) -> Result<Paired> {
    super::domain::check_size("the second technique's list of scores", [second.len(), 1], [first.len(), 1])?;
    if first.is_empty() {
        return Err(Error::NothingToScore("no view counts"));
    }
    if let Some(bad) = first.iter().chain(second).find(|score| !score.is_finite()) {
        return Err(Error::setting("scores", format!("{bad} is not a score; leave out the views that have none")));
    }
    let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    let n = differences.len();
    let mean = differences.iter().sum::<f64>() / n as f64;
    let variance = differences.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / (n as f64 - 1.0);
    let count = |wanted: fn(&&f64) -> bool| differences.iter().filter(wanted).count();
    Ok(Paired {
        mean_difference: mean,
        standard_error: (n > 1).then(|| (variance / n as f64).sqrt()),
        first_better: count(|d| **d < 0.0),
        second_better: count(|d| **d > 0.0),
        ties: count(|d| **d == 0.0),
    })
}

/// Memory that brings a technique's error down to a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MemoryAt {
    /// No more than the least memory that was measured.
    AtMost(f64),
    /// A value between two measurements.
    About(f64),
    /// More than the most memory that was measured.
    MoreThan(f64),
}

/// Returns the memory at which a technique's error first falls to `limit` (0.005, say) as memory
/// grows. `measured` holds pairs of memory (texels or bytes, more than 0) and error. Between two
/// measurements ln(memory) is linear in ln(error), as it is where error falls with a power of
/// memory; an error of 0 is taken as 1e-9 there.
///
/// # Errors
/// [`Error::NothingToScore`] for no measurement, [`Error::InvalidSetting`] for numbers out of
/// range.
pub fn memory_at(measured: &[(f64, f64)], limit: f64) -> Result<MemoryAt> {
    let valid = |&(memory, error): &(f64, f64)| memory > 0.0 && memory.is_finite() && error >= 0.0 && error.is_finite();
    if let Some(bad) = measured.iter().position(|pair| !valid(pair)) {
        let reason = format!("{:?}; give memory above 0 and an error of 0 or more", measured[bad]);
        return Err(Error::setting("measurements", reason));
    }
    if !(limit > 0.0 && limit.is_finite()) {
        return Err(Error::setting("limit", format!("{limit}; give an error above 0")));
    }
    let mut sorted = measured.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else {
        return Err(Error::NothingToScore("no measurement of memory and error"));
    };
    if first.1 <= limit {
        return Ok(MemoryAt::AtMost(first.0));
    }
    Ok(sorted.windows(2).find(|pair| pair[1].1 <= limit).map_or(MemoryAt::MoreThan(last.0), |pair| {
        let (from, to) = (pair[0].1.ln(), pair[1].1.max(1e-9).ln());
        let share = (limit.ln() - from) / (to - from);
        MemoryAt::About((pair[0].0.ln() * (1.0 - share) + pair[1].0.ln() * share).exp())
    }))
}
