//! Why maps could not be made or prepared.

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Every message names the field, what was wrong and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A pass that loads from depth textures, on a device that cannot.
    #[error(
        "depth textures cannot be loaded from on GL and WebGL2; ask for visibility where surfaces are drawn instead of in a mask"
    )]
    MaskNeedsDepthLoads,
    /// A mask was given normals that it did not ask for, or none where it did.
    #[error("a mask with normals {normals:?} was {}; give a texture of normals with MaskNormals::Texture and with nothing else", if *.given { "given a texture of them" } else { "given none" })]
    MaskNormals {
        /// As the mask was made.
        normals: crate::MaskNormals,
        /// Whether a texture was given.
        given: bool,
    },
    /// `map_sizes` is empty or too long.
    #[error("map_sizes has {count} entries; give one for each split, 1 to {most}")]
    SplitCount {
        /// How many there were.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A map has no texels, or fewer than its filter reads.
    #[error("map_sizes[{split}] is {size}; the filter {filter:?} needs maps of at least {least} texels")]
    MapTooSmall {
        /// Index into `map_sizes`.
        split: usize,
        /// The edge that was asked for, in texels.
        size: u32,
        /// The filter that would read it.
        filter: crate::Filter,
        /// The smallest edge it can work with, in texels.
        least: u32,
    },
    /// The device has no texture as large as a map.
    #[error(
        "map_sizes[{split}] is {size}, but this device's textures are at most {limit} texels wide \
         (max_texture_dimension_2d); use a smaller map, or request the device with a higher limit"
    )]
    MapTooLarge {
        /// Index into `map_sizes`.
        split: usize,
        /// The edge that was asked for, in texels.
        size: u32,
        /// The device's limit, in texels.
        limit: u32,
    },
    /// The device has no texture array as long as the list of maps.
    #[error(
        "lights and map_sizes ask for {count} layers, but this device's texture arrays have at most {limit} layers \
         (max_texture_array_layers); use fewer splits"
    )]
    TooManyLayers {
        /// Layers needed.
        count: u32,
        /// The device's limit.
        limit: u32,
    },
    /// The device cannot filter 32-bit floats and fallbacks are forbidden.
    #[error(
        "filter {filter:?} stores moments in 32-bit floats, but this device was requested without FLOAT32_FILTERABLE and fallbacks \
         is false; allow fallbacks, request the feature (optional_features), or use a filter that compares depth"
    )]
    NoFilterableFloats {
        /// The filter.
        filter: crate::Filter,
    },
    /// Depth cannot become moments where it cannot be loaded.
    #[error("filter {filter:?} loads from depth maps, which GL cannot; use a filter that compares depth, such as Pcf5")]
    NoDepthLoads {
        /// The filter.
        filter: crate::Filter,
    },
    /// Moments are layers of an array.
    #[error("storage {} and filter {filter:?} exclude each other: moments are kept as an array; use storage array, or a filter that compares depth", storage.name())]
    MomentsNeedArray {
        /// The storage.
        storage: crate::Storage,
        /// The filter.
        filter: crate::Filter,
    },
    /// Moments are kept for one light.
    #[error(
        "lights asks for {lights:?}, but filter {filter:?} serves one sun; use one light, or a filter that compares depth"
    )]
    MomentsNeedOneSun {
        /// The lights.
        lights: Vec<crate::LightSlot>,
        /// The filter.
        filter: crate::Filter,
    },
    /// Maps cannot have so many samples.
    #[error(
        "samples is {samples} with filter {filter:?}; give 1, or 4 for a filter of moments (Esm, Vsm, Evsm2, Evsm4, Msm)"
    )]
    Samples {
        /// What was asked for.
        samples: u32,
        /// The filter that would read them.
        filter: crate::Filter,
    },
    /// Moments want depth that is linear.
    #[error(
        "split {split} of the plan is warped, but filter {filter:?} needs depth that is linear along the light; use warp none, or a \
         filter that compares depth"
    )]
    WarpedMoments {
        /// Index of the split.
        split: usize,
        /// The filter.
        filter: crate::Filter,
    },
    /// The device has no texture that holds all maps side by side.
    #[error(
        "storage atlas needs one texture that holds maps of {sizes:?} texels side by side, but this device's textures are at most \
         {limit} texels wide (max_texture_dimension_2d); use smaller map_sizes, or storage array"
    )]
    AtlasTooLarge {
        /// The sizes asked for, nearest split first.
        sizes: Vec<u32>,
        /// The device's limit, in texels.
        limit: u32,
    },
    /// Two options that exclude each other.
    #[error("{first} and {second} exclude each other: {reason}")]
    ConflictingOptions {
        /// One of them, by name and value.
        first: String,
        /// The other.
        second: String,
        /// Why, and what to do.
        reason: &'static str,
    },
    /// The device lacks a feature that was asked for by name, and fallbacks are forbidden.
    #[error(
        "generation {generation} needs {feature}, which this device was not requested with, and fallbacks is false; request the \
         feature (optional_features), allow fallbacks, or use generation per-split"
    )]
    MissingFeature {
        /// The generation that was asked for.
        generation: &'static str,
        /// What it needs.
        feature: &'static str,
    },
    /// More maps than textures that a shader can sample.
    #[error(
        "storage separate needs a sampled texture for each of the {count} maps in map_sizes, but a shader of this device samples {limit} \
         at most (max_sampled_textures_per_shader_stage); use fewer splits, or storage array"
    )]
    TooManyTextures {
        /// Textures needed.
        count: usize,
        /// The device's limit.
        limit: u32,
    },
    /// The plan was made for other maps.
    #[error(
        "the plan has maps of {plan:?} texels, but these ShadowMaps were created with {maps:?}; \
         create the Planner and the ShadowMaps with the same map_sizes"
    )]
    PlanMismatch {
        /// The plan's sizes, nearest split first.
        plan: Vec<u32>,
        /// The sizes given at creation.
        maps: Vec<u32>,
    },
    /// A number of the plan cannot be used.
    #[error("split {split} of the plan: {field} is {value}, but it has to be {expected}")]
    InvalidSplit {
        /// Index of the split.
        split: usize,
        /// Field of [`umbrage::Split`].
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A number of the plan that belongs to no split cannot be used.
    #[error("the plan's {field} is {value}, but it has to be {expected}")]
    InvalidPlan {
        /// Field of [`umbrage::ShadowPlan`].
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A frame option is out of range.
    #[error("frame option {field} is {value}, but it has to be {expected}")]
    InvalidFrameOption {
        /// Field of [`crate::FrameOptions`].
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// A filter so wide that its radius exceeds even the widest map.
    #[error(
        "frame option width_m is {width_m}, half of which is more than the {map_m:.3} m of the widest map; give less, or leave it to the filter"
    )]
    FilterTooWide {
        /// [`crate::Softness::width_m`].
        width_m: f64,
        /// The longest edge of any of the light's maps, metres.
        map_m: f64,
    },
    /// More or fewer plans than lights.
    #[error("{plans} plans, but these ShadowMaps were created for {lights} lights; give one plan for each of `lights`")]
    LightCount {
        /// How many plans there were.
        plans: usize,
        /// Length of [`crate::ShadowMapsOptions::lights`].
        lights: usize,
    },
    /// The plan has more faces than its light's slot.
    #[error(
        "lights[{light}] is {slot:?}, but its plan is of another kind of light, with {faces} faces; create the ShadowMaps with \
         LightSlot::from(that light) there"
    )]
    LightSlot {
        /// Index into [`crate::ShadowMapsOptions::lights`].
        light: usize,
        /// Faces of the plan.
        faces: usize,
        /// What was made for it.
        slot: crate::LightSlot,
    },
    /// The filter knows suns only.
    #[error(
        "the filter {filter:?} goes by depths of parallel light, but lights[{light}] is a spot or point light; \
         use another filter, such as Pcf5"
    )]
    FilterNeedsSun {
        /// The filter.
        filter: crate::Filter,
        /// Index into [`crate::ShadowMapsOptions::lights`].
        light: usize,
    },
    /// The storage holds one light's maps only.
    #[error(
        "lights asks for {maps} maps ({splits} of map_sizes for each), but the storage {storage:?} holds those of one sun or \
         spot light; use Storage::Array, or one light"
    )]
    LightsNeedArray {
        /// Maps of all lights together.
        maps: usize,
        /// Length of `map_sizes`.
        splits: usize,
        /// The storage that was asked for.
        storage: crate::Storage,
    },
    /// The frames of all lights are more than a uniform buffer holds.
    #[error(
        "lights asks for {frames} frames (one for each light, 6 for a point light) of {bytes} bytes together, but this device's \
         uniform buffers hold {limit} (max_uniform_buffer_binding_size); use fewer lights"
    )]
    TooManyLights {
        /// Frames needed; 0 if there is no light at all.
        frames: usize,
        /// Their bytes.
        bytes: u64,
        /// The device's limit in bytes.
        limit: u64,
    },
}
