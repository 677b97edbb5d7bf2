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

/// Catches the device's errors on this thread.
pub(crate) struct Scopes {
    memory: wgpu::ErrorScopeGuard,
    internal: wgpu::ErrorScopeGuard,
    validation: wgpu::ErrorScopeGuard,
}

impl Scopes {
    pub fn open(device: &wgpu::Device) -> Self {
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        Self { memory, internal, validation }
    }

    /// Returns the first error. Errors of memory come first, because the others follow from them.
    pub async fn close(self) -> Option<wgpu::Error> {
        // Scopes close in the reverse order.
        let validation = self.validation.pop().await;
        let internal = self.internal.pop().await;
        let memory = self.memory.pop().await;
        memory.or(internal).or(validation)
    }
}
