//! Costs of shadows for all techniques, measured in turn, as in the papers' Table 1, Figure 7 and
//! Figure 10-9.
//!
//! Every round draws each technique once, and after it the picture without shadows, by shaders that
//! contain no shadow code. A load on the machine then slows all of them alike. A ratio is taken
//! within its round, and the median of these ratios is reported. Counts beside the times do not
//! depend on the machine.

mod crowd;
mod job;
mod measure;
mod page;
mod papers;
mod report;
mod run;
pub mod scale;
mod summary;

pub use job::{Job, filter_techniques};
pub use run::run;
