//! Techniques: how shadows are made, as options ([`args`]), as settings ([`job`]) and under a name ([`text`]).

pub mod args;
pub mod job;
mod paths;
pub mod text;

pub use args::{Filter, ShadowArgs, typed_name};
pub use job::ShadowJob;
pub use text::Technique;
