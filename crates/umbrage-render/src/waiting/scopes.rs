//! What the device complains about while work is done.

/// Catches what the device complains about, on this thread.
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

    /// The first complaint. Memory comes first: the others follow from it.
    pub async fn close(self) -> Option<wgpu::Error> {
        // Scopes close in the reverse order.
        let validation = self.validation.pop().await;
        let internal = self.internal.pop().await;
        let memory = self.memory.pop().await;
        memory.or(internal).or(validation)
    }
}

/// Complaints of the device come later here: they surface as faults of a later call.
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
