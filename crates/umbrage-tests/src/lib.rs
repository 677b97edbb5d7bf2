//! Regression tests of pictures and scores, for development only: this crate is never published,
//! and nothing depends on it.
//!
//! [`compare`] compares two images within named tolerances; [`golden`] keeps the reference images
//! and shows differences; [`stage`] has the worlds, a device and the techniques; [`judge`] measures
//! techniques against the exact truth; [`room`] is a scene with lamps, [`closed`] are rooms without
//! any. `tests/comparators.rs` proves that every comparison can fail; `tests/regressions` holds the
//! references and the ceilings.

pub mod boxes;
pub mod closed;
pub mod compare;
pub mod golden;
pub mod judge;
pub mod room;
pub mod stage;
pub mod town;

/// The book's pages, so that `cargo test --doc` compiles and runs their code.
#[cfg(doctest)]
mod book {
    macro_rules! pages {
        ($($name:ident: $file:literal),*) => {
            $(#[doc = include_str!(concat!("../../../book/src/", $file))] mod $name {})*
        };
    }
    pages!(wgpu: "adopt-wgpu.md", engine: "adopt-engine.md", presets: "presets.md", interop: "interop.md");
}
