//! The gallery: every world and a city from near, middle and far, with masks, maps and figures, as
//! one page.

#[cfg(feature = "judge")]
mod drawn;
#[cfg(feature = "judge")]
mod page;
#[cfg(feature = "judge")]
mod run;
pub mod scenes;

#[cfg(feature = "judge")]
pub use run::{Job, run};
pub use scenes::{SCENES, Scene};
