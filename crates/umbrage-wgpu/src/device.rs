//! Errors of the device, as errors of this crate.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use crate::{Error, Result};

/// Runs `work` and converts the device's errors about it to one of this crate. A browser reports
/// errors later: they go to the application's handler.
pub(crate) fn guarded<T>(device: &wgpu::Device, during: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // Scopes close in the reverse order. Memory comes first in the report: the other follows from
    // it.
    let validation = now(validation.pop());
    let memory = now(memory.pop());
    match (memory, validation) {
        (Some(_), _) => Err(Error::OutOfMemory { during }),
        (None, Some(error)) => Err(Error::Device { during, message: error.to_string() }),
        (None, None) => result,
    }
}

/// [`guarded`] for work that creates resources. Resources of a lost device are invalid, and `wgpu`
/// reports that only to the application's callback.
pub(crate) fn made<T>(device: &wgpu::Device, during: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let made = guarded(device, during, work);
    if is_lost(device) { Err(Error::DeviceLost) } else { made }
}

/// Writes `bytes` into `buffer`, from the next submission on.
///
/// # Errors
/// [`Error::DeviceLost`], which [`wgpu::Queue::write_buffer`] does not report. In a [`guarded`]
/// call another reason takes precedence. A browser does not report that a device is lost.
pub(crate) fn write(queue: &wgpu::Queue, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<()> {
    let Some(size) = wgpu::BufferSize::new(bytes.len() as u64) else { return Ok(()) };
    let mut view = queue.write_buffer_with(buffer, offset, size).ok_or(Error::DeviceLost)?;
    view.copy_from_slice(bytes);
    Ok(())
}

/// Returns whether a device is lost: its buffers can then not be mapped. A browser does not report
/// this.
fn is_lost(device: &wgpu::Device) -> bool {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("umbrage: is the device lost?"),
        size: wgpu::COPY_BUFFER_ALIGNMENT,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::MAP_WRITE,
        mapped_at_creation: true,
    });
    let is_mapped = buffer.get_mapped_range_mut(..).is_ok();
    now(memory.pop()).is_none() && !is_mapped
}

/// The answer, if it is already there.
fn now(answer: impl Future<Output = Option<wgpu::Error>>) -> Option<wgpu::Error> {
    match pin!(answer).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(error) => error,
        Poll::Pending => None,
    }
}
