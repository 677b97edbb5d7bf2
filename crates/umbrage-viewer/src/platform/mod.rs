//! Differences between a program on a desktop and a page in a browser: one module for each, with
//! the same functions. The rest of the viewer is written once.
//!
//! | | desktop | browser |
//! |---|---|---|
//! | `spawn`, `pause`, `sleep`, `finish` | threads, which may block | tasks of the page, which must not |
//! | `SHARES_DEVICE` | the renderer has its own device | one device for all: WebGL2 has no other |
//! | `instance`, `attributes` | by `WGPU_BACKEND`; a window | WebGPU, else WebGL2; the page's canvas |
//! | `makes_pipelines_slowly` | no: they are made beside the window | on WebGPU: they are made ahead |
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

/// Callback, from any thread, for new results.
pub type Wake = std::sync::Arc<dyn Fn() + Send + Sync>;

/// Event from outside of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// Pasted text.
    Pasted(String),
    /// A dropped file.
    Dropped {
        /// Name of the file.
        name: String,
        /// Content of the file.
        bytes: Vec<u8>,
    },
    /// New fragment of the page's address, without `#`.
    Address(String),
    /// A message; `true` for errors.
    Said(bool, String),
    /// Loss of the canvas's graphics for good, with the browser's reason.
    Lost(String),
}
