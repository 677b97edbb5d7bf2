//! What can go wrong between a scene and its picture.

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why there is no picture. Every message names the culprit and says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No GPU driver, not even a software one.
    #[error(
        "no graphics adapter was found ({reason}); install a Vulkan driver, for example Mesa's software one \
         (Debian, Ubuntu: apt-get install mesa-vulkan-drivers), or check WGPU_BACKEND and WGPU_ADAPTER_NAME"
    )]
    NoAdapter {
        /// What the driver loader or the search by name said.
        reason: String,
    },
    /// The adapter would not open a device.
    #[error("graphics adapter {adapter:?} opens no device: {reason}; try another with WGPU_ADAPTER_NAME")]
    NoDevice {
        /// The adapter's name.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// The picture has no pixels or more than the device can draw.
    #[error("size {width}x{height}: give 1 to {limit} pixels in each direction")]
    ImageSize {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The device's largest texture.
        limit: u32,
    },
    /// Maps of several samples per texel have no picture.
    #[error("maps have {samples} samples per texel and cannot be written; use one sample, or do not write maps")]
    MapsOfSamples {
        /// Samples of depth in a texel.
        samples: u32,
    },
    /// A map that is used for one slice after the other is planned for the view that is sliced.
    #[error(
        "the maps are planned for another view than the one that is drawn, which one map that is used for slice after \
         slice of the view cannot be; use another storage, or plan for the view itself"
    )]
    SlicesOfAnotherView,
    /// More lights than a picture is shaded by.
    #[error("{count} lights; a frame has at most {most}")]
    LampCount {
        /// How many there were.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// The frame's lights are not those that the renderer was made for.
    #[error(
        "the frame has {frame} lights, but the renderer was made for {renderer}; make it with one slot for each light"
    )]
    LampSlots {
        /// Lights of the frame.
        frame: usize,
        /// Length of `RenderSettings::lights`.
        renderer: usize,
    },
    /// A texture of the scene is larger than the device allows.
    #[error("texture {index} is {width}x{height} pixels, more than the {limit} this device allows; scale it down")]
    TextureSize {
        /// Index into the scene's textures.
        index: usize,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The device's largest texture.
        limit: u32,
    },
    /// The data of one buffer exceed what the device can hold in one.
    #[error("{what} need {needed} bytes, but this device holds at most {limit} in one buffer; use a smaller scene")]
    BufferSize {
        /// Which data.
        what: &'static str,
        /// Their size.
        needed: u64,
        /// The device's largest buffer.
        limit: u64,
    },
    /// The scene contradicts itself. Loaders make no such scene.
    #[error("scene: {what} {index}: {reason}")]
    Scene {
        /// The kind of thing at fault.
        what: &'static str,
        /// Its index.
        index: usize,
        /// What was wrong and what to do.
        reason: String,
    },
    /// A probe point or its normal cannot be used.
    #[error("probe point {index}: {reason}")]
    Probe {
        /// Index into the points given.
        index: usize,
        /// What was wrong and what to do.
        reason: &'static str,
    },
    /// The device ran out of memory.
    #[error("the graphics device ran out of memory while {during}; use smaller maps, a smaller picture or scene")]
    OutOfMemory {
        /// What was being done.
        during: &'static str,
    },
    /// The device refused a command, which is a defect of this program or of the driver.
    #[error("the graphics device failed while {during}: {message}")]
    Device {
        /// What was being done.
        during: &'static str,
        /// What the device said.
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
