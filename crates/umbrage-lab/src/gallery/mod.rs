//! The gallery: every world and a city from near, middle and far, with masks, maps and figures, as
//! one page.

mod drawn;
mod page;
mod run;
pub mod scenes;

pub use run::{Job, run};
pub use scenes::{SCENES, Scene};
