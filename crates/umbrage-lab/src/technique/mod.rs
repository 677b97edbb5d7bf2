//! Techniques: how shadows are made ([`request`]), and under a name ([`text`]).

pub mod request;
pub mod text;

pub use request::{ShadowOptions, ShadowRequest, word};
pub use text::Technique;
