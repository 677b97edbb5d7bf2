//! `umbrage compare`: any techniques on any shots, judged by rays.

pub mod args;
mod job;

pub use args::CompareArgs;

use umbrage_lab::{compare, failure::Result};

/// Runs the subcommand.
pub fn run(args: &CompareArgs) -> Result<()> {
    compare::run(job::job(args)?)
}
