//! Waiting for the device. A thread of a program blocks; a page in a browser must not, and is
//! called back. The rest of this crate is written once, as `async` functions that a program runs to
//! their end with `block_on`.

#[cfg(not(target_arch = "wasm32"))]
mod native;
mod scopes;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(not(target_arch = "wasm32"))]
pub(crate) use native::{BLOCKS, idle, mapped};
#[cfg(target_arch = "wasm32")]
pub(crate) use web::{BLOCKS, idle, mapped};

pub(crate) use scopes::Scopes;

/// Name of the operation "reading results back", for messages.
pub(crate) const READING: &str = "reading results back";
