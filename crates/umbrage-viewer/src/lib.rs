//! umbrage's viewer: fly through a scene, drag the sun, change a number while looking, and see why
//! a shadow looks as it does.
//!
//! [`run`] opens the window. Behind it there are parts that know of no window:
//!
//! * [`session`] decides what is opened, drawn, judged and shown next;
//! * [`studio`] is the thread that draws, with a graphics device of its own, and [`judge`] the one
//!   that traces rays, so that no frame of the window waits for either;
//! * [`stage`] opens scenes beside the one that is shown;
//! * [`controls`] makes a row for each setting of [`umbrage::config::SETTINGS`], [`share`] carries
//!   configs away and back;
//! * [`camera`], [`path`], [`sun`] and [`lines`] are what their names say;
//! * [`app`] and [`panel`] are the controls, by `egui`, and [`window`] is the window, by `winit`
//!   and `wgpu`.

pub mod app;
pub mod camera;
pub mod controls;
mod error;
pub mod judge;
pub mod lines;
mod options;
pub mod panel;
pub mod path;
pub mod session;
pub mod share;
pub mod stage;
pub mod studio;
pub mod sun;
mod textures;
pub mod window;

pub use error::{Error, Result};
pub use options::{Options, ShowAtStart};
pub use window::run;
