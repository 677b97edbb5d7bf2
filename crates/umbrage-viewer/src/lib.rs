//! umbrage's viewer: fly through a scene, drag the sun, change a number while looking, and see why
//! a shadow looks as it does.
//!
//! [`run`] opens the window. Behind it there are parts that know of no window:
//!
//! * [`session`] decides what is opened, drawn, judged and shown next;
//! * [`studio`] draws and [`judge`] traces rays beside the window, so that no frame of it waits for
//!   either;
//! * [`stage`] opens scenes beside the one that is shown;
//! * [`controls`] makes a row for each setting of [`umbrage::config::SETTINGS`], [`share`] carries
//!   configs away and back, [`link`] all that is shown;
//! * [`camera`], [`path`], [`sun`] and [`lines`] are what their names say;
//! * [`app`] and [`panel`] are the controls, by `egui`, and [`window`] is the window, by `winit`
//!   and `wgpu`;
//! * `platform` is what differs between a desktop and a browser, where `page` opens the viewer.

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
