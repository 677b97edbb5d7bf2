//! Errors in making and preparing maps.

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Error in creating, preparing or drawing shadow maps. Every message names the field, the problem
/// and the remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The config is wrong, or the planner refused its input.
    #[error(transparent)]
    Config(#[from] umbrage::Error),
    /// The config needs other maps.
    #[error("setting {setting} cannot change on existing maps; create new ShadowMaps, or use Shadows::set_config")]
    NeedsNewMaps {
        /// Key of the setting, see [`umbrage::config::SETTINGS`].
        setting: &'static str,
    },
    /// The device ran out of memory.
    #[error("the graphics device ran out of memory while {during}; use smaller maps")]
    OutOfMemory {
        /// The operation that failed.
        during: &'static str,
    },
    /// The device is lost: its driver was reset or updated, its adapter was unplugged, or the
    /// application destroyed it. None of its resources works any more.
    #[error(
        "the graphics device is lost; request a new device, and create Shadows (or ShadowMaps) and all pipelines again on it"
    )]
    DeviceLost,
    /// The device refused a command.
    #[error("the graphics device failed while {during}: {message}")]
    Device {
        /// The operation that failed.
        during: &'static str,
        /// The device's message.
        message: String,
    },
    /// The device cannot load from depth textures, as a mask's pass does.
    #[error(
        "depth textures cannot be loaded on GL and WebGL2; compute visibility where surfaces are drawn instead of in a mask"
    )]
    MaskNeedsDepthLoads,
    /// The depth of an image cannot be read.
    #[error("what was seen cannot be read: {reason}")]
    SeenDepth {
        /// Problem and remedy.
        reason: String,
    },
    /// A mask was given normals for which it was not made, or none although it needs them.
    #[error("a mask with normals {normals:?} was {}; give a texture of normals with MaskNormals::Texture or TextureAsIs and with nothing else", if *.given { "given a texture of them" } else { "given none" })]
    MaskNormals {
        /// Source of normals for which the mask was made.
        normals: crate::MaskNormals,
        /// True if a texture was given.
        given: bool,
    },
    /// A mask in two draws was asked for with a depth target that stores no depth.
    #[error(
        "a mask's depth target was to have the format {format:?}, which stores no depth; give Depth16Unorm or another depth format"
    )]
    MaskDepth {
        /// The requested format.
        format: wgpu::TextureFormat,
    },
    /// The device has no texture as large as a map.
    #[error(
        "map_sizes[{split}] is {size}, but this device's textures are at most {limit} texels wide \
         (max_texture_dimension_2d); use a smaller map, or request the device with a higher limit"
    )]
    MapTooLarge {
        /// Index into `map_sizes`.
        split: usize,
        /// Requested edge in texels.
        size: u32,
        /// The device's limit, in texels.
        limit: u32,
    },
    /// The device has no texture as large as a kept map needs.
    #[error(
        "cache kept needs a texture of {kept} texels for map_sizes[{split}], which is {size}, but this device's textures are at \
         most {limit} texels wide (max_texture_dimension_2d); use a smaller map, or cache off"
    )]
    KeptMapTooLarge {
        /// Index into `map_sizes`.
        split: usize,
        /// Edge of the map in texels.
        size: u32,
        /// Edge of the kept texture in texels.
        kept: u32,
        /// The device's limit, in texels.
        limit: u32,
    },
    /// The device has no texture array with as many layers as there are maps.
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
        "filter {filter} stores moments in 32-bit floats, but this device was requested without FLOAT32_FILTERABLE and fallbacks \
         are forbidden; allow fallbacks, request the feature (optional_features), or use a filter that compares depth"
    )]
    NoFilterableFloats {
        /// The filter.
        filter: &'static str,
    },
    /// The device cannot load from depth textures, and so cannot convert depth to moments.
    #[error("filter {filter} loads from depth maps, which GL cannot; use a filter that compares depth, such as pcf5")]
    NoDepthLoads {
        /// The filter.
        filter: &'static str,
    },
    /// The device cannot load from depth maps, as exact edges do, and fallbacks are forbidden.
    #[error(
        "edges exact loads from depth maps, which GL cannot, and fallbacks are forbidden; allow fallbacks, or use edges sampled"
    )]
    NoExactEdges,
    /// A mask without triangles cannot decide exact edges.
    #[error(
        "edges exact asks which triangles texels name, and a mask's pass knows none; use ShadowMask::with_runs, or edges \
         sampled"
    )]
    MaskNeedsRuns,
    /// A pipeline for casters would leave the ids of casters behind it in the maps.
    #[error(
        "the fragment shader of {label} does not return the UmbrageTexel that exact edges want, and would leave the id of \
         what is behind it; return umbrage_caster_texel(at, 0u) at location 0"
    )]
    CasterWithoutId {
        /// Label of the pipeline.
        label: String,
    },
    /// A caster has more runs of triangles than there are free ids.
    #[error(
        "a caster of {runs} runs needs {needed} slots of ids, but {free} of {all} are free; remove casters from \
         Shadows::occluders, or draw some with the id 0"
    )]
    TooManyOccluders {
        /// Runs of the caster.
        runs: u32,
        /// Number of slots that the runs take, one after the other.
        needed: u32,
        /// Number of free slots.
        free: u32,
        /// Number of all slots.
        all: u32,
    },
    /// The slots of ids do not belong to a caster.
    #[error(
        "the slots {first} to {last} of ids are not those of a caster that is there; remove a caster once, from the \
         occluders that it was inserted into"
    )]
    UnknownOccluder {
        /// The first slot.
        first: u32,
        /// The last slot.
        last: u32,
    },
    /// The device has no texture that has room for all maps side by side.
    #[error(
        "storage atlas needs one texture that holds maps of {sizes:?} texels side by side, but this device's textures are at most \
         {limit} texels wide (max_texture_dimension_2d); use smaller map_sizes, or storage array"
    )]
    AtlasTooLarge {
        /// Requested sizes, nearest split first.
        sizes: Vec<u32>,
        /// The device's limit, in texels.
        limit: u32,
    },
    /// The device lacks a feature for the requested generation, and fallbacks are forbidden.
    #[error(
        "generation {generation} needs {feature}, which this device was not requested with, and fallbacks are forbidden; request the \
         feature (optional_features), allow fallbacks, or use generation per-split"
    )]
    MissingFeature {
        /// The requested generation.
        generation: &'static str,
        /// The feature that it needs.
        feature: &'static str,
    },
    /// There are more maps than textures that a shader can sample.
    #[error(
        "storage separate needs {count} sampled textures for the {maps} maps in map_sizes, but a shader of this device samples \
         {limit} at most (max_sampled_textures_per_shader_stage); use fewer splits, or storage array"
    )]
    TooManyTextures {
        /// Number of requested maps.
        maps: usize,
        /// Number of textures needed: one for each map, with exact edges two.
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
        /// Sizes of the plan's maps, nearest split first.
        plan: Vec<u32>,
        /// Sizes given at creation.
        maps: Vec<u32>,
    },
    /// A value of the plan cannot be used.
    #[error("split {split} of the plan: {field} is {value}, but it has to be {expected}")]
    InvalidSplit {
        /// Index of the split.
        split: usize,
        /// Field of [`umbrage::Split`].
        field: &'static str,
        /// The value as given.
        value: f64,
        /// Values that are allowed.
        expected: &'static str,
    },
    /// A value of the plan that belongs to no split cannot be used.
    #[error("the plan's {field} is {value}, but it has to be {expected}")]
    InvalidPlan {
        /// Field of [`umbrage::ShadowPlan`].
        field: &'static str,
        /// The value as given.
        value: f64,
        /// Values that are allowed.
        expected: &'static str,
    },
    /// A frame option is out of range.
    #[error("frame option {field} is {value}, but it has to be {expected}")]
    InvalidFrameOption {
        /// Field of [`crate::FrameOptions`].
        field: &'static str,
        /// The value as given.
        value: f64,
        /// Values that are allowed.
        expected: &'static str,
    },
    /// Casters or receivers of a frame were given as lists beside a set, where they would be
    /// ignored.
    #[error("the inputs have a caster set and {listed} boxes in lists; put the boxes into the set, or omit it")]
    SetAndLists {
        /// Number of casters and receivers in lists.
        listed: usize,
    },
    /// The radius of a filter exceeds even the widest map.
    #[error(
        "the filter is {width_m} m wide, half of which is more than the {map_m:.3} m of the widest map; give less, or no width"
    )]
    FilterTooWide {
        /// Full width of the filter in metres.
        width_m: f64,
        /// The longest edge of any of the light's maps, in metres.
        map_m: f64,
    },
    /// An input of culling on the GPU cannot be used.
    #[error("culling: {field}: {reason}")]
    Culling {
        /// The argument or its field.
        field: &'static str,
        /// Problem and remedy.
        reason: String,
    },
    /// The device has no buffer as large as culling needs.
    #[error(
        "{what} takes {bytes} bytes, but this device's storage buffers hold {limit} (max_storage_buffer_binding_size, \
         max_buffer_size); cull fewer instances, or request the device with higher limits"
    )]
    CullingTooLarge {
        /// Label of the buffer.
        what: &'static str,
        /// Size of the buffer in bytes.
        bytes: u64,
        /// The device's limit in bytes.
        limit: u64,
    },
    /// The device runs no compute shaders with the storage buffers that culling needs.
    #[error(
        "this device runs no compute shader with seven storage buffers; make the lists with InstanceCulling::cull_on_cpu, or \
         keep instances in an umbrage::CasterSet"
    )]
    CullingNeedsCompute,
    /// The plan has no test for culling on the GPU.
    #[error(
        "instances cannot be culled on the GPU: {what}; use one sun with generation per-split or multipass and cache off, or the \
         casters of ShadowMap::casters"
    )]
    CullingPlan {
        /// Reason.
        what: &'static str,
    },
    /// The number of plans is not that of the lights.
    #[error("got {plans} lights, but these maps were made for {lights}; give one plan or light for each")]
    LightCount {
        /// Number of plans.
        plans: usize,
        /// Number of lights for which the maps were made.
        lights: usize,
    },
    /// The plan was made by a choice for which the shaders of these maps were not made.
    #[error(
        "the plan has {setting} {given}, but these maps and their shaders were made for {setting} {made_for}; plan with the config \
         that the maps were made with"
    )]
    PlanOfOtherConfig {
        /// Key of the setting.
        setting: &'static str,
        /// Value for which the maps were made.
        made_for: String,
        /// Value of the plan.
        given: String,
    },
    /// The maps of a light were made for another kind of light.
    #[error(
        "light {light} is {given:?}, but its maps were made for LightKind::{made_for:?}; make maps for LightKind::{given:?} there"
    )]
    LightKind {
        /// Index into the lights.
        light: usize,
        /// Kind of the plan's light.
        given: umbrage::config::LightKind,
        /// Kind of light for which the maps were made.
        made_for: umbrage::config::LightKind,
    },
    /// The frames of all lights exceed a uniform buffer.
    #[error(
        "lights asks for {frames} frames (one for each light, 6 for a point light) of {bytes} bytes together, but this device's \
         uniform buffers hold {limit} (max_uniform_buffer_binding_size); use fewer lights"
    )]
    TooManyLights {
        /// Number of frames needed; 0 if there is no light at all.
        frames: usize,
        /// Size of these frames in bytes.
        bytes: u64,
        /// The device's limit in bytes.
        limit: u64,
    },
}
