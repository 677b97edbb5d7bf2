//! Errors between a scene and its picture.

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why there is no picture. Every message names the culprit and says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No GPU driver, not even a software one.
    #[error(
        "no graphics adapter was found ({reason}); install a Vulkan driver, for example Mesa's software one \
         (Debian, Ubuntu: apt-get install mesa-vulkan-drivers), or check WGPU_BACKEND and WGPU_ADAPTER_NAME"
    )]
    NoAdapter {
        /// Message of the driver loader, or of the search by name.
        reason: String,
    },
    /// The adapter could not open a device.
    #[error("graphics adapter {adapter:?} opens no device: {reason}; try another with WGPU_ADAPTER_NAME")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// Message of the adapter.
        reason: String,
    },
    /// The picture has no pixels, or more than the device can draw.
    #[error("size {width}x{height}: give 1 to {limit} pixels in each direction")]
    ImageSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Edge of the device's largest texture, in pixels.
        limit: u32,
    },
    /// Maps with several samples per texel cannot be shown as pictures.
    #[error("maps have {samples} samples per texel and cannot be written; use one sample, or do not write maps")]
    MapsOfSamples {
        /// Samples of depth per texel.
        samples: u32,
    },
    /// A map that is used for one slice after the other has to be planned for the view that is
    /// sliced.
    #[error(
        "the maps are planned for another view than the one that is drawn, which one map that is used for slice after \
         slice of the view cannot be; use another storage, or plan for the view itself"
    )]
    SlicesOfAnotherView,
    /// The frame has more lights than the shader of the picture takes.
    #[error("{count} lights; a frame has at most {most}")]
    LampCount {
        /// Number of lights in the frame.
        count: usize,
        /// Largest number of lights.
        most: usize,
    },
    /// The frame's lights do not match those that the renderer was made for.
    #[error(
        "the frame has {frame} lights, but the renderer was made for {renderer}; make it with one slot for each light"
    )]
    LampSlots {
        /// Number of lights in the frame.
        frame: usize,
        /// Length of `RenderSettings::lights`.
        renderer: usize,
    },
    /// A texture of the scene is larger than the device allows.
    #[error("texture {index} is {width}x{height} pixels, more than the {limit} this device allows; scale it down")]
    TextureSize {
        /// Index into the scene's textures.
        index: usize,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Edge of the device's largest texture, in pixels.
        limit: u32,
    },
    /// The data of one buffer exceed the device's largest buffer.
    #[error("{what} need {needed} bytes, but this device holds at most {limit} in one buffer; use a smaller scene")]
    BufferSize {
        /// Kind of data.
        what: &'static str,
        /// Size of the data in bytes.
        needed: u64,
        /// Size of the device's largest buffer in bytes.
        limit: u64,
    },
    /// The scene contradicts itself. Loaders make no such scene.
    #[error("scene: {what} {index}: {reason}")]
    Scene {
        /// Kind of the part at fault.
        what: &'static str,
        /// Index of the part at fault.
        index: usize,
        /// Fault and remedy.
        reason: String,
    },
    /// A probe point or its normal is unusable.
    #[error("probe point {index}: {reason}")]
    Probe {
        /// Index into the points given.
        index: usize,
        /// Fault and remedy.
        reason: &'static str,
    },
    /// The device ran out of memory.
    #[error("the graphics device ran out of memory while {during}; use smaller maps, a smaller picture or scene")]
    OutOfMemory {
        /// Operation that failed.
        during: &'static str,
    },
    /// The device refused a command, which is a defect of this program or of the driver.
    #[error("the graphics device failed while {during}: {message}")]
    Device {
        /// Operation that failed.
        during: &'static str,
        /// Message of the device.
        message: String,
    },
    /// The planner refused the camera, the settings or the bounds.
    #[error(transparent)]
    Plan(#[from] umbrage::Error),
    /// The shadow maps refused the config or the plan.
    #[error(transparent)]
    Shadows(umbrage_wgpu::Error),
}

impl From<umbrage_wgpu::Error> for Error {
    fn from(error: umbrage_wgpu::Error) -> Self {
        match error {
            umbrage_wgpu::Error::Config(error) => Self::Plan(error),
            umbrage_wgpu::Error::OutOfMemory { during } => Self::OutOfMemory { during },
            umbrage_wgpu::Error::Device { during, message } => Self::Device { during, message },
            other => Self::Shadows(other),
        }
    }
}
