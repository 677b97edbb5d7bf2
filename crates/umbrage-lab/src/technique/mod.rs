//! Techniques of shadows: as requests ([`request`]), in files ([`mod@file`]), and by name
//! ([`text`]).

pub mod file;
pub mod request;
pub mod text;

pub use file::{ConfigFile, Drawn};
pub use request::{ShadowOptions, ShadowRequest, word};
pub use text::Technique;
