//! Techniques: how shadows are made ([`request`]), what a file says of them ([`mod@file`]), and
//! under a name ([`text`]).

pub mod file;
pub mod request;
pub mod text;

pub use file::{ConfigFile, Drawn};
pub use request::{ShadowOptions, ShadowRequest, word};
pub use text::Technique;
