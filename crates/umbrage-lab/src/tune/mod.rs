//! The best config for a budget, searched against the judge.
//!
//! [`candidates`] are all combinations of some settings' values, with maps as large as the budget
//! allows, and the presets. [`run()`] has the truth traced once and every candidate draw and answer
//! the same views; each one's [`record::Outcome`] is a line of a [`crate::journal`], so that a run
//! can be cut off, spread over machines and merged ([`merge`]). [`choice`] says which is best,
//! [`output`] writes it, the plot and the page.

pub mod candidates;
pub mod choice;
mod error;
mod judged;
mod merge;
pub mod output;
mod page;
pub mod record;
mod run;
mod settings;

pub use candidates::{Axis, axis};
pub use error::Error;
pub use merge::merge;
pub use output::Outputs;
pub use record::{Shard, shard};
pub use run::{Job, run};
pub use settings::Settings;

/// The option that names a file of results, and what its lines are of.
pub(crate) const RESULTS: crate::journal::Kind = crate::journal::Kind { option: "--results", run: "tune run" };
