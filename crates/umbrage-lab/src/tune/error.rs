//! Errors of a search without a result.

use std::path::PathBuf;

use umbrage::config::Budget;

use crate::failure::Failure;

/// Reason why a search ended without a result. All are bad input: the message names the option at
/// fault and says what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A key or value cannot be tried.
    #[error("--try {axis}: {reason}")]
    Axis {
        /// Axis as it was given.
        axis: String,
        /// Fault and remedy.
        reason: String,
    },
    /// The budget pays for no candidate's maps.
    #[error(
        "--budget {budget}: too small for every candidate; the least that is possible with these settings is {least}"
    )]
    BudgetTooSmall {
        /// Budget that was given.
        budget: Budget,
        /// Least budget that pays for a candidate.
        least: Budget,
    },
    /// Rules exclude every combination.
    #[error("--try: no combination is left, {count} are excluded: {reason}")]
    NothingToTry {
        /// Number of combinations.
        count: usize,
        /// Reason why the first one is excluded.
        reason: String,
    },
    /// No view has enough edges.
    #[error(
        "no view counts: none has {least_edges} edge pixels; give a larger --size, other shots, or a smaller --least-edges"
    )]
    NoView {
        /// Number of edge pixels that `--least-edges` asks for.
        least_edges: usize,
    },
    /// Every candidate flickers too much.
    #[error(
        "--most-flicker {most}: nothing flickers so little; the least found is {least:.3} % ({label}). Give that or more, \
         or try stiller settings, such as --try stabilize=exact/approximate"
    )]
    Flicker {
        /// Largest flicker that was asked for, in per cent.
        most: f64,
        /// Least flicker of a candidate, in per cent.
        least: f64,
        /// Label of that candidate.
        label: String,
    },
    /// Every candidate takes more than the budget on this device.
    #[error(
        "--budget {budget}: on this device the smallest candidate takes {least} bytes; give a budget of that or more"
    )]
    OverBudget {
        /// Budget as it was written.
        budget: String,
        /// Least size that was measured, in bytes.
        least: u64,
    },
    /// Two files belong to different runs.
    #[error(
        "--merge: {} and {} are of different runs, they differ in {difference}; merge shards of one run, with the \
         same options",
        .first.display(),
        .other.display()
    )]
    OtherRun {
        /// Path of the first file.
        first: PathBuf,
        /// Path of the file that differs.
        other: PathBuf,
        /// Name of the field in which the runs differ.
        difference: String,
    },
    /// A file lacks its first line.
    #[error("--merge: {} is empty; nothing of its shard was finished, run that again", .file.display())]
    Empty {
        /// Path of the file.
        file: PathBuf,
    },
    /// Two files contradict each other about one candidate.
    #[error(
        "--merge: {} gives other figures for candidate {candidate} ({label}) than a file before it; a run's figures do \
         not depend on its shards, so one of the files was changed or the device is faulty",
        .file.display()
    )]
    Contradiction {
        /// Path of the file.
        file: PathBuf,
        /// Number of the candidate.
        candidate: usize,
        /// Label of the candidate.
        label: String,
    },
    /// Some candidates are missing.
    #[error(
        "--merge: {missing} of {all} candidates are missing: {shards}; run those shards again, they go on from their files"
    )]
    Missing {
        /// Number of missing candidates.
        missing: usize,
        /// Number of all candidates.
        all: usize,
        /// Numbers of missing candidates by shard.
        shards: String,
    },
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Input(error.to_string())
    }
}
