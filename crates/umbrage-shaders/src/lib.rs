//! umbrage's WGSL as plain strings, and the structs that it shares with Rust.
//!
//! This crate knows no GPU interface: any renderer that takes WGSL can use it, given a depth texture array, a comparison
//! sampler and a uniform buffer. `umbrage-wgpu` is that renderer's half for wgpu.
//!
//! * `shaders/lib` has functions without bindings, `shaders/pass` the roots with bindings, `shaders/maps` the maps' own bindings
//!   and the two functions that read them. `wesl` joins them when this crate is built; what comes out is ordinary WGSL, and
//!   every name in it begins with `umbrage`, in one case or another.
//! * A root is text to put before one's own shader. It declares no entry point and no override, so it adds nothing to a
//!   pipeline's constants. What varies (filter, number of splits, strength) is a value in the [`layout::Frame`] uniform:
//!   an override would become a constant of the *app's* pipeline, to be repeated wherever it makes one, and one text per
//!   filter would make the filter part of every pipeline's key. A branch on a uniform value costs next to nothing.
//! * The index of the bind group is the app's choice: [`caster`] and [`receiver`] declare it as a WGSL constant.
//!
//! | binding of [`receiver`] | what |
//! |---|---|
//! | 0 | uniform array of [`layout::Frame`]: one for each light, six for a point light |
//! | 1 | `texture_depth_2d_array`, cleared to 1; [`layout::Split`] says where in it a map lies |
//! | 2 | `sampler_comparison` with `LessEqual`, clamped to the edge; nearest for [`layout::FilterKind::Hard`], else linear |
//!
//! | binding of [`caster`] | what |
//! |---|---|
//! | 0 | uniform [`layout::Split`] |

pub mod layout;
pub mod twin;

/// The root `shaders/pass/caster.wesl`, all but the constant `UMBRAGE_CASTER_GROUP`.
pub const CASTER: &str = include_str!(concat!(env!("OUT_DIR"), "/caster.wgsl"));

const CONTACT: &str = include_str!(concat!(env!("OUT_DIR"), "/contact.wgsl"));
const RECEIVER: &str = include_str!(concat!(env!("OUT_DIR"), "/receiver.wgsl"));
const RECEIVER_WITHOUT_LOADS: &str = include_str!(concat!(env!("OUT_DIR"), "/receiver_without_loads.wgsl"));
const RECEIVER_OF_MOMENTS: &str = include_str!(concat!(env!("OUT_DIR"), "/receiver_of_moments.wgsl"));
const ARRAY: &str = include_str!(concat!(env!("OUT_DIR"), "/array.wgsl"));
const ARRAY_WITHOUT_LOADS: &str = include_str!(concat!(env!("OUT_DIR"), "/array_without_loads.wgsl"));

const MOMENTS: &str = include_str!(concat!(env!("OUT_DIR"), "/moments.wgsl"));
const MOMENTS_BY_TAPS: &str = include_str!(concat!(env!("OUT_DIR"), "/moments_by_taps.wgsl"));
const MOMENTS_BY_HAND: &str = include_str!(concat!(env!("OUT_DIR"), "/moments_by_hand.wgsl"));

/// The passes from depth to moments, `shaders/pass/moments.wesl`: entry points `vs_all`, `fs_convert`, `fs_blur_u`, `fs_blur_v` and
/// `fs_halve`, constants `KIND`, `POSITIVE_EXPONENT` and `NEGATIVE_EXPONENT`.
pub const MOMENT_PASSES: &str = include_str!(concat!(env!("OUT_DIR"), "/moment_passes.wgsl"));

/// The same from depth with four samples a texel.
pub const MOMENT_PASSES_OF_SAMPLES: &str = include_str!(concat!(env!("OUT_DIR"), "/moment_passes_of_samples.wgsl"));

/// How a receiver reads its maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Maps {
    /// Depth textures can be compared with but not loaded from (GL, WebGL2): [`layout::FilterKind::Pcss`] is an ordinary disc.
    pub without_loads: bool,
    /// Length of the array of frames.
    pub frames: u32,
    /// Maps hold moments of depth, of one light.
    pub moments: Option<MomentMaps>,
}

impl Default for Maps {
    /// One light, read with everything that a device can have.
    fn default() -> Self {
        Self { without_loads: false, frames: 1, moments: None }
    }
}

/// How moments are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MomentMaps {
    /// Bindings 1: `texture_2d_array<f32>`, 2: a linear and anisotropic sampler, 3: uniform [`layout::Moments`].
    Sampled,
    /// The same with a sampler that is linear only; the shader takes up to 16 samples where an anisotropic one would.
    Taps,
    /// The same without a sampler.
    ByHand,
}

/// Text to put before a vertex shader that draws casters: `fn umbrage_caster_position(position: vec3f) -> vec4f`.
#[must_use]
pub fn caster(group: u32) -> String {
    format!("const UMBRAGE_CASTER_GROUP = {group}u;\n{CASTER}\n")
}

/// Text to put before a shader that asks for contact shadows:
/// `fn umbrage_contact_visibility(position: vec3f, normal: vec3f, noise: f32) -> f32`. Binding 0 is its uniform, 1 the picture's depth as
/// `texture_depth_2d`. It may stand beside [`receiver`] in one module.
#[must_use]
pub fn contact(group: u32) -> String {
    format!("const UMBRAGE_CONTACT_GROUP = {group}u;\n{CONTACT}\n")
}

/// Text to put before a shader that asks what is lit: `fn umbrage_visibility(position: vec3f, normal: vec3f) -> f32`,
/// `umbrage_shadow` and `umbrage_visibility_in_split`, and the same of one of several lights: `umbrage_visibility_of(light: u32, …)`.
#[must_use]
pub fn receiver(group: u32, maps: Maps) -> String {
    let frames = maps.frames.max(1);
    let (receiver, maps) = match (maps.moments, maps.without_loads) {
        (Some(MomentMaps::Sampled), _) => (RECEIVER_OF_MOMENTS, MOMENTS),
        (Some(MomentMaps::Taps), _) => (RECEIVER_OF_MOMENTS, MOMENTS_BY_TAPS),
        (Some(MomentMaps::ByHand), _) => (RECEIVER_OF_MOMENTS, MOMENTS_BY_HAND),
        (None, true) => (RECEIVER_WITHOUT_LOADS, ARRAY_WITHOUT_LOADS),
        (None, false) => (RECEIVER, ARRAY),
    };
    format!("const UMBRAGE_RECEIVER_GROUP = {group}u;\nconst UMBRAGE_FRAMES = {frames}u;\n{maps}\n{receiver}\n")
}
