//! The judge: exact visibility by rays.
//!
//! It shares the camera and the scene with the renderer it judges, and nothing else: no fit, no selection, no shader.

mod alpha;
mod bvh;
mod error;
mod mask;
pub mod scores;
mod soft;
mod trace;
mod triangles;
mod truth;

pub use error::{Error, Result};
pub use mask::{TruthMask, read_mask};
pub use soft::{SoftTruth, SunDisc};
pub use truth::{Hit, Truth};

#[cfg(test)]
mod tests;
