//! The graphics device of this crate, opened without a window.

use std::sync::{Arc, Mutex, PoisonError};

use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::formats::{ANSWERS_FORMAT, DEPTH_FORMAT, MASK_FORMAT, PICTURE_FORMAT, POINTS_FORMAT};
use crate::waiting::Scopes;
use crate::{Error, Result};

/// Options of opening a device.
#[derive(Clone, Copy, Debug, Default)]
pub struct GpuOptions {
    /// Features that are not requested although the adapter has them, to test or compare the
    /// fallbacks.
    pub withhold: wgpu::Features,
}

/// An open device and its queue. Cheap to clone; clones share the device.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Name, driver and kind of the adapter, for reports.
    pub adapter_info: wgpu::AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// The device's queue.
    pub queue: wgpu::Queue,
    faults: Faults,
}

/// The first error that no scope caught, kept until it is asked for. Later errors are mostly its
/// consequences.
#[derive(Clone, Debug, Default)]
struct Faults(Arc<Mutex<Option<Fault>>>);

#[derive(Debug)]
enum Fault {
    OutOfMemory,
    Other(String),
}

impl From<wgpu::Error> for Fault {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::OutOfMemory,
            wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
                Self::Other(description)
            }
        }
    }
}

impl Fault {
    fn into_error(self, during: &'static str) -> Error {
        match self {
            Self::OutOfMemory => Error::OutOfMemory { during },
            Self::Other(message) => Error::Device { during, message },
        }
    }
}

impl Gpu {
    /// Describes the adapter for reports: its name, its interface and its driver.
    #[must_use]
    pub fn description(&self) -> String {
        let info = &self.adapter_info;
        let driver = [info.driver.as_str(), info.driver_info.as_str()];
        let driver: Vec<&str> = driver.into_iter().filter(|part| !part.is_empty()).collect();
        // Browsers name no adapter of WebGPU's.
        let name = if info.name.is_empty() { "adapter without a name" } else { &info.name };
        if driver.is_empty() {
            format!("{name} ({})", info.backend)
        } else {
            format!("{name} ({}, {})", info.backend, driver.join(" "))
        }
    }

    /// Returns whether shaders can load from depth textures. On GL they cannot: every depth texture
    /// is for comparisons only there.
    pub(crate) fn depth_loads(&self) -> bool {
        self.adapter_info.backend != wgpu::Backend::Gl
    }

    /// Opens the best adapter, or the one that `WGPU_BACKEND`, `WGPU_ADAPTER_NAME` and
    /// `WGPU_POWER_PREF` ask for, with the adapter's own limits and all features that shadows or
    /// timing can use.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] or [`Error::NoDevice`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new(options: &GpuOptions) -> Result<Self> {
        pollster::block_on(Self::open(options))
    }

    /// Opens an adapter as [`Gpu::new`] does, for callers that may not block, such as a page in a
    /// browser.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] or [`Error::NoDevice`].
    pub async fn open(options: &GpuOptions) -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = choose_adapter(&instance).await?;
        let info = adapter.get_info();
        let described = device_descriptor(&adapter);
        let required_features = described.required_features.difference(options.withhold);
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor { required_features, ..described })
            .await
            .map_err(|error| Error::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        Ok(Self::from_parts(info, device, queue))
    }

    /// Takes over a device that somebody else opened, for example with a window. Its uncaptured
    /// errors become this crate's errors from then on.
    #[must_use]
    pub fn from_parts(adapter_info: wgpu::AdapterInfo, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Faults::default();
        let sink = faults.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| sink.keep(error.into())));
        Self { adapter_info, device, queue, faults }
    }

    /// Returns the device's first error that no call of this crate has reported yet.
    ///
    /// # Errors
    /// That error, with `during` as the operation that failed.
    pub fn check(&self, during: &'static str) -> Result<()> {
        self.faults.check(during)
    }

    /// Runs `work` and turns the device's errors into this crate's. In a browser errors come later
    /// and surface in a later call instead.
    pub(crate) fn guarded<T>(&self, during: &'static str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        // Nothing is awaited, so that it is done when it is polled first.
        pollster::block_on(self.guarded_async(during, async || work()))
    }

    /// Runs `work` as [`Gpu::guarded`] does, for work that waits for the device.
    pub(crate) async fn guarded_async<T>(
        &self,
        during: &'static str,
        work: impl AsyncFnOnce() -> Result<T>,
    ) -> Result<T> {
        let scopes = Scopes::open(&self.device);
        let result = work().await;
        if let Some(error) = scopes.close().await {
            return Err(Fault::from(error).into_error(during));
        }
        self.faults.check(during)?;
        result
    }

    /// Returns [`Error::BufferSize`] unless `bytes` fit into one buffer of this device.
    pub(crate) fn check_buffer(&self, what: &'static str, bytes: u64) -> Result<()> {
        let limit = self.device.limits().max_buffer_size;
        if bytes > limit { Err(Error::BufferSize { what, needed: bytes, limit }) } else { Ok(()) }
    }

    /// Returns [`Error::BufferSize`] unless `bytes` fit into one buffer that shaders of this device
    /// can read.
    pub(crate) fn check_storage(&self, what: &'static str, bytes: u64) -> Result<()> {
        let limit = self.device.limits().max_storage_buffer_binding_size;
        if bytes > limit {
            Err(Error::BufferSize { what, needed: bytes, limit })
        } else {
            self.check_buffer(what, bytes)
        }
    }

    /// Makes a buffer with these bytes, or with a few zeroes if there are none.
    pub(crate) fn filled_buffer(&self, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some(label),
            contents: if bytes.is_empty() { &[0; 64] } else { bytes },
            usage: usage | wgpu::BufferUsages::COPY_DST,
        })
    }

    /// Returns the largest edge of a texture in pixels.
    pub(crate) fn max_texture_edge(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}

impl Faults {
    fn keep(&self, fault: Fault) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(fault);
    }

    fn check(&self, during: &'static str) -> Result<()> {
        let fault = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        fault.map_or(Ok(()), |fault| Err(fault.into_error(during)))
    }
}

/// Describes the device of an adapter, for [`Gpu::from_parts`]: the adapter's own limits, and all
/// features that shadows or timing can use.
#[must_use]
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("Gpu::device"),
        required_features: adapter.features() & wanted_features(),
        required_limits: adapter.limits(),
        ..Default::default()
    }
}

/// Features that are requested where the adapter has them.
fn wanted_features() -> wgpu::Features {
    umbrage_wgpu::optional_features()
        | wgpu::Features::TIMESTAMP_QUERY
        | wgpu::Features::PIPELINE_STATISTICS_QUERY
        | wgpu::Features::FLOAT32_FILTERABLE
}

/// Texture formats and usages that an adapter must support to be chosen without a name.
const TEXTURES: [(wgpu::TextureFormat, wgpu::TextureUsages); 6] = [
    (PICTURE_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
    (MASK_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
    (DEPTH_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
    (DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING),
    (POINTS_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING),
    (ANSWERS_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
];

/// Describes the first required texture usage that an adapter lacks; `None` if it lacks none.
fn lacking(usages: impl Fn(wgpu::TextureFormat) -> wgpu::TextureUsages) -> Option<String> {
    let missing = TEXTURES.into_iter().find(|(format, usage)| !usages(*format).contains(*usage));
    missing.map(|(format, usage)| match usage {
        wgpu::TextureUsages::RENDER_ATTACHMENT => format!("cannot draw into {format:?} textures"),
        _ => format!("cannot read {format:?} textures"),
    })
}

/// Chooses the adapter that is asked for by name, or else the best one that can draw everything. An
/// adapter that cannot is passed over: a system without a Vulkan driver often has one for OpenGL
/// that draws into too few formats.
async fn choose_adapter(instance: &wgpu::Instance) -> Result<wgpu::Adapter> {
    #[cfg(not(target_arch = "wasm32"))]
    if let Ok(wanted) = std::env::var("WGPU_ADAPTER_NAME")
        && !wanted.is_empty()
    {
        let wanted = wanted.to_lowercase();
        let adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        let names: Vec<String> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
        return adapters
            .into_iter()
            .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
            .ok_or_else(|| Error::NoAdapter {
                reason: format!("WGPU_ADAPTER_NAME is {wanted:?}, but there are only {names:?}"),
            });
    }
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::from_env().unwrap_or(wgpu::PowerPreference::HighPerformance),
        ..Default::default()
    };
    let best = instance.request_adapter(&options).await;
    let best = best.map_err(|error| Error::NoAdapter { reason: error.to_string() })?;
    let lacking =
        |adapter: &wgpu::Adapter| lacking(|format| adapter.get_texture_format_features(format).allowed_usages);
    let Some(reason) = lacking(&best) else { return Ok(best) };
    #[cfg(not(target_arch = "wasm32"))]
    {
        let others = instance.enumerate_adapters(wgpu::Backends::all()).await;
        // A graphics card before a processor.
        let is_slow = |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        if let Some(other) = others.into_iter().filter(|other| lacking(other).is_none()).min_by_key(is_slow) {
            return Ok(other);
        }
    }
    let info = best.get_info();
    Err(Error::NoAdapter { reason: format!("{} ({}) {reason}", info.name, info.backend) })
}

/// Returns the device of unit tests, or `None` with a warning where there is no adapter.
/// `UMBRAGE_REQUIRE_GPU=1` turns the lack of an adapter into a failure.
#[cfg(test)]
pub(crate) fn of_tests() -> Option<Gpu> {
    use std::io::Write;
    match Gpu::new(&GpuOptions::default()) {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|value| value == "1") => {
            panic!("UMBRAGE_REQUIRE_GPU is 1, but {error}")
        }
        Err(error) => {
            writeln!(std::io::stderr(), "SKIPPED: no adapter: {error}").expect("it can be written to");
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_adapter_that_cannot_draw_is_told_from_one_that_can() {
        assert_eq!(lacking(|_| wgpu::TextureUsages::all()), None);
        let as_opengl_without_extensions = |format| match format {
            ANSWERS_FORMAT => wgpu::TextureUsages::TEXTURE_BINDING,
            _ => wgpu::TextureUsages::all(),
        };
        assert_eq!(lacking(as_opengl_without_extensions).as_deref(), Some("cannot draw into Rg32Float textures"));
        assert_eq!(
            lacking(|_| wgpu::TextureUsages::RENDER_ATTACHMENT).as_deref(),
            Some("cannot read Depth32Float textures")
        );
    }
}
