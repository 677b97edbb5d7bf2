//! What shadows cost, the papers' Table 1, Figure 7 and Figure 10-9 for all techniques, measured in
//! turn.
//!
//! Every round draws each technique once, and after it the picture without shadows by shaders that
//! never heard of them, so that what slows the machine down slows all of them; a ratio is taken
//! within its round, and the median of those is reported. Counts beside the times do not depend on
//! the machine.

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
