//! Search for the best config within a budget, by the scores of the judge.
//!
//! [`candidates`] are all combinations of some settings' values, with maps as large as the budget
//! allows, and the presets. [`run()`] traces the truth once and scores every candidate in the same
//! views. Each one's [`record::Outcome`] is a line of a [`crate::journal`], so that a run can be
//! cut off, spread over machines and merged ([`merge`]). [`choice`] chooses the best; [`output`]
//! writes its config, the plot and the page.

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

/// Kind of the result files of a search.
pub(crate) const RESULTS: crate::journal::Kind = crate::journal::Kind { option: "--results", run: "tune run" };
