//! Scenes for umbrage: what a renderer draws and a ray meets.

mod model;

pub use model::*;
