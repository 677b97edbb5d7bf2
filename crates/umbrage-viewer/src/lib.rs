//! umbrage's viewer: fly through a scene, drag the sun, change a number while looking, and see why
//! a shadow looks as it does.
//!
//! [`run`] opens the window. The modules behind it do not depend on a window:
//!
//! * [`session`] decides what is opened, drawn, judged and shown next;
//! * [`studio`] draws and [`judge`] traces rays beside the window, so that no frame of it waits for
//!   either;
//! * [`stage`] opens scenes in the background;
//! * [`controls`] makes a row for each setting of [`umbrage::config::SETTINGS`], [`share`] converts
//!   configs to text and back, [`link`] the scene and the view too;
//! * [`camera`] moves the eye, [`path`] records and follows camera paths, [`sun`] places the sun,
//!   [`lines`] makes the lines of frusta and boxes;
//! * [`app`] and [`panel`] are the controls, made with `egui`, and [`window`] is the window, made
//!   with `winit` and `wgpu`;
//! * `platform` holds the differences between a desktop and a browser, where `page` opens the
//!   viewer.

pub mod app;
pub mod camera;
pub mod controls;
mod error;
pub mod judge;
pub mod lines;
pub mod link;
mod options;
#[cfg(target_arch = "wasm32")]
pub mod page;
pub mod path;
mod platform;
pub mod session;
pub mod share;
pub mod stage;
pub mod studio;
pub mod sun;
mod textures;
pub mod window;

pub use app::panel;
pub use error::{Error, Result};
pub use options::{Options, ShowAtStart};
pub use window::run;
