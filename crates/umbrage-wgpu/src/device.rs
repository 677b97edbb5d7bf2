//! What the device has to complain about, as errors.

use std::pin::pin;
use std::task::{Context, Poll, Waker};

use crate::{Error, Result};

/// Runs `work` and turns the device's complaints about it into an error. A browser answers later than
/// that: its complaints go where the application has them go.
pub(crate) fn guarded<T>(device: &wgpu::Device, during: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    // Scopes close in the reverse order. Memory comes first in the report: the other follows from it.
    let validation = now(validation.pop());
    let memory = now(memory.pop());
    match (memory, validation) {
        (Some(_), _) => Err(Error::OutOfMemory { during }),
        (None, Some(error)) => Err(Error::Device { during, message: error.to_string() }),
        (None, None) => result,
    }
}

/// The answer, if it is there already.
fn now(answer: impl Future<Output = Option<wgpu::Error>>) -> Option<wgpu::Error> {
    match pin!(answer).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(error) => error,
        Poll::Pending => None,
    }
}
