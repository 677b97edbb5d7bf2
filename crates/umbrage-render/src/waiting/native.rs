//! Waiting by blocking the thread. Every future here is ready when it is first polled.

use std::time::Duration;

use super::READING;
use crate::{Error, Gpu, Result};

/// True if a wait costs nothing but its own time. A frame may then be submitted in pieces whose
/// times are taken.
pub(crate) const BLOCKS: bool = true;

/// Longest delay of a callback after the device has finished all work. Only a lost device takes
/// that long.
const CALLBACK_PATIENCE: Duration = Duration::from_secs(60);

/// Waits until everything submitted has run.
pub(crate) async fn idle(gpu: &Gpu) -> Result<()> {
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .map(|_| ())
        .map_err(|error| Error::Device { during: "waiting for the device", message: error.to_string() })
}

/// Waits until everything submitted has run and a buffer can be read.
pub(crate) async fn mapped(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<()> {
    let failed = |message: String| Error::Device { during: READING, message };
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver lives until the end of this function; if it is gone nobody wants to know.
        let _ = sender.send(result);
    });
    idle(gpu).await?;
    // Another thread that waits for the same device may have taken this buffer's callback and be
    // about to call it.
    receiver
        .recv_timeout(CALLBACK_PATIENCE)
        .map_err(|_| failed("the buffer was never mapped".to_owned()))?
        .map_err(|error| failed(error.to_string()))
}
