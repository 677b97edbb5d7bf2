//! Why there is no best config.

use std::path::PathBuf;

use umbrage::config::Budget;

use crate::failure::Failure;

/// Why a search ended without a result. Each is bad input: the message names the option at fault
/// and what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A key or value that cannot be tried.
    #[error("--try {axis}: {reason}")]
    Axis {
        /// The axis as given.
        axis: String,
        /// What was wrong and what to do.
        reason: String,
    },
    /// The budget pays for no candidate's maps.
    #[error(
        "--budget {budget}: too small for every candidate; the least that is possible with these settings is {least}"
    )]
    BudgetTooSmall {
        /// The budget.
        budget: Budget,
        /// The least that pays for a candidate.
        least: Budget,
    },
    /// Rules exclude every combination.
    #[error("--try: no combination is left, {count} are excluded: {reason}")]
    NothingToTry {
        /// How many there were.
        count: usize,
        /// Why, of the first.
        reason: String,
    },
    /// No view has enough edges.
    #[error(
        "no view counts: none has {least_edges} edge pixels; give a larger --size, other shots, or a smaller --least-edges"
    )]
    NoView {
        /// What `--least-edges` asks for.
        least_edges: usize,
    },
    /// Every candidate flickers too much.
    #[error(
        "--most-flicker {most}: nothing flickers so little; the least found is {least:.3} % ({label}). Give that or more, \
         or try stiller settings, such as --try stabilize=exact/approximate"
    )]
    Flicker {
        /// What was asked for, per cent.
        most: f64,
        /// The least found, per cent.
        least: f64,
        /// Which candidate that is.
        label: String,
    },
    /// Every candidate takes more than the budget on this device.
    #[error(
        "--budget {budget}: on this device the smallest candidate takes {least} bytes; give a budget of that or more"
    )]
    OverBudget {
        /// The budget as written.
        budget: String,
        /// The least that was measured.
        least: u64,
    },
    /// Two files of different runs.
    #[error(
        "--merge: {} and {} are of different runs, they differ in {difference}; merge shards of one run, with the \
         same options",
        .first.display(),
        .other.display()
    )]
    OtherRun {
        /// The first file.
        first: PathBuf,
        /// The file that differs.
        other: PathBuf,
        /// What they differ in.
        difference: String,
    },
    /// A file without a first line.
    #[error("--merge: {} is empty; nothing of its shard was finished, run that again", .file.display())]
    Empty {
        /// The file.
        file: PathBuf,
    },
    /// Two files say different things about one candidate.
    #[error(
        "--merge: {} gives other figures for candidate {candidate} ({label}) than a file before it; a run's figures do \
         not depend on its shards, so one of the files was changed or the device is faulty",
        .file.display()
    )]
    Contradiction {
        /// The file.
        file: PathBuf,
        /// The candidate's number.
        candidate: usize,
        /// Its label.
        label: String,
    },
    /// Not all candidates are there.
    #[error(
        "--merge: {missing} of {all} candidates are missing: {shards}; run those shards again, they go on from their files"
    )]
    Missing {
        /// How many.
        missing: usize,
        /// Of how many.
        all: usize,
        /// How many of which shards.
        shards: String,
    },
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Input(error.to_string())
    }
}
