//! What differs between a program on a desktop and a page in a browser: one module for each, with
//! the same functions. All else of the viewer is written once.
//!
//! | | desktop | browser |
//! |---|---|---|
//! | `spawn`, `pause`, `finish` | threads, which may block | tasks of the page, which must not |
//! | `SHARES_DEVICE` | what draws has a device of its own | one device for all: WebGL2 has no other |
//! | `instance`, `attributes` | by `WGPU_BACKEND`; a window | WebGPU, else WebGL2; the page's canvas |
//! | `mask` | on every core | a few rows at a time |
//! | `scene`, `shipped` | files | addresses of the page's own server |
//! | `save`, `link`, `take_copies` | the working folder, the desktop's clipboard | downloads, the page's address and clipboard |
//! | `Outside` | nothing | dropped files, pasted text, a new address, a hidden tab |

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;

#[cfg(target_arch = "wasm32")]
pub use browser::*;
#[cfg(not(target_arch = "wasm32"))]
pub use desktop::*;

/// Called, from any thread, when there is something new to show.
pub type Wake = std::sync::Arc<dyn Fn() + Send + Sync>;

/// What comes from outside of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// Text that was pasted.
    Pasted(String),
    /// A file that was dropped.
    Dropped {
        /// Its name.
        name: String,
        /// Its content.
        bytes: Vec<u8>,
    },
    /// What stands behind the `#` of the page's address now.
    Address(String),
    /// Something to say; `true` for errors.
    Said(bool, String),
    /// The browser took the canvas's graphics away, for good.
    Lost(String),
}
