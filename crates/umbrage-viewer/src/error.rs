//! Errors that prevent or close the window.

use std::path::PathBuf;

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why the viewer ended before it did what it was asked for.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is no screen.
    #[error("there is no window system ({0}); start it on a desktop, or under Xvfb as `xvfb-run umbrage view …`")]
    NoScreen(String),
    /// The window system cannot open a window.
    #[error("the window does not open: {0}")]
    NoWindow(String),
    /// No graphics adapter can draw into the window.
    #[error(
        "no graphics adapter draws into the window ({0}); install a Vulkan driver, for example Mesa's software one \
         (Debian, Ubuntu: apt-get install mesa-vulkan-drivers), or check WGPU_BACKEND"
    )]
    NoAdapter(String),
    /// The browser has neither WebGPU nor WebGL2.
    #[error(
        "This page draws with WebGPU or WebGL2, and this browser offers neither ({0}). Try a current Chrome, Edge, \
         Firefox or Safari, and switch hardware acceleration on in its settings."
    )]
    NoInterface(String),
    /// The program has a defect.
    #[error("The viewer has stopped because of a defect. Please report it: {0}")]
    Defect(String),
    /// The window's device was lost, and no other one can be opened.
    #[error(
        "The window's graphics device was lost and does not come back ({why}). {} shows the same again: {again}",
        if cfg!(target_arch = "wasm32") { "Reloading this page" } else { "This command" }
    )]
    Lost {
        /// Reason of the loss, or why no device can be opened.
        why: String,
        /// Command that shows the scene, view and settings again.
        again: String,
    },
    /// The scene of a screenshot could not be shown.
    #[error("{0}")]
    NotShown(String),
    /// A screenshot could not be written.
    #[error("--screenshot {}: {reason}; choose a place you have the right to use", path.display())]
    Screenshot {
        /// Path of the file.
        path: PathBuf,
        /// Reason why it could not be written.
        reason: String,
    },
}
