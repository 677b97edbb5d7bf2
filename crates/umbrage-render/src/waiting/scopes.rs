//! The device's errors while work is done.

/// Catches the device's errors on this thread.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) struct Scopes {
    memory: wgpu::ErrorScopeGuard,
    internal: wgpu::ErrorScopeGuard,
    validation: wgpu::ErrorScopeGuard,
}

#[cfg(not(target_arch = "wasm32"))]
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

/// Error scopes that catch nothing. In a browser the device's errors come later and surface as
/// faults of a later call.
#[cfg(target_arch = "wasm32")]
pub(crate) struct Scopes;

#[cfg(target_arch = "wasm32")]
impl Scopes {
    pub fn open(_: &wgpu::Device) -> Self {
        Self
    }

    #[expect(clippy::unused_async, reason = "as it is where complaints are caught")]
    pub async fn close(self) -> Option<wgpu::Error> {
        None
    }
}
