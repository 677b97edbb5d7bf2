//! umbrage's WGSL as strings, and the structs that it shares with Rust.
//!
//! This crate uses no GPU API: any renderer that takes WGSL can use it, given a depth texture
//! array, a comparison sampler and a uniform buffer. `umbrage-wgpu` is the Rust side for wgpu.
//!
//! * `shaders/lib` has functions without bindings, `shaders/pass` the roots with bindings,
//!   `shaders/maps` the maps' own bindings and the two functions that read them. `src/wgsl` has the
//!   texts into which they are joined: ordinary WGSL, in which every name begins with `umbrage`, in
//!   upper or lower case.
//! * A root is text to put before the application's own shader. It declares no entry point and no
//!   override, so it adds nothing to a pipeline's constants: an override would become a constant of
//!   the *application's* pipeline, to be repeated wherever it makes one.
//! * Choices (filter, selection, strength) are values in the [`layout::Frame`] uniform, unless
//!   [`ReceiverText`] fixes them: the text is then made without the alternatives, and compiles and
//!   runs faster. Another choice is another text.
//! * The application chooses the index of the bind group: [`caster`] and [`receiver`] declare it as
//!   a WGSL constant.
//!
//! | binding of [`receiver`] | resource |
//! |---|---|
//! | 0 | uniform array of [`layout::Frame`]: one for each light, six for a point light |
//! | 1 | `texture_depth_2d_array` or `texture_depth_cube`, cleared to 1; [`layout::Split`] has the position of each map |
//! | 2 | `sampler_comparison` with `LessEqual`, clamped to the edge; nearest for [`layout::FilterKind::Hard`], otherwise linear |
//! | 3 … | [`Bound::Separate`]: a `texture_depth_2d` for each split. [`Bound::Cube`]: its faces as layers, if depth can be loaded |
//!
//! With [`ReceiverText::exact`] the next binding is a `texture_2d_array<u32>`, cleared to 0: the id
//! of the run of triangles that each texel shows. With [`Bound::Separate`] it is a
//! `texture_2d<u32>` for each split.
//!
//! With [`Maps::r32f`] the textures are `f32` without filtering, and there is no comparison
//! sampler; a cube has a plain sampler at 2.
//!
//! | binding of [`caster`] | resource |
//! |---|---|
//! | 0 | uniform [`layout::Split`]; if several splits are drawn at once, [`layout::CasterPass`] |

macro_rules! text {
    ($file:literal) => {
        include_str!(concat!("wgsl/", $file, ".wgsl"))
    };
}

pub mod layout;
mod receiver;
pub mod twin;
mod variant;

pub use receiver::{ExactEdges, Lights, Projection, ReceiverText, receiver, stored_runs};

/// Binding of a receiver's maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Bound {
    /// Layers of one texture, and tiles of layers.
    #[default]
    Array,
    /// Faces of a cube.
    Cube,
    /// One texture for each map, 1 to [`layout::MAX_SPLITS`].
    Separate(usize),
}

/// WGSL of the passes from depth to moments, `shaders/pass/moments.wesl`: entry points `vs_all`,
/// `fs_convert`, `fs_blur_u`, `fs_blur_v` and `fs_halve`, constants `KIND`, `POSITIVE_EXPONENT` and
/// `NEGATIVE_EXPONENT`.
pub const MOMENT_PASSES: &str = text!("moment_passes");

/// WGSL of the passes from depth with four samples per texel to moments.
pub const MOMENT_PASSES_OF_SAMPLES: &str = text!("moment_passes_of_samples");

/// WGSL of the pass that copies a split's kept texture into its map, `shaders/pass/kept.wesl`:
/// entry points `vs_all` and `fs_copy`; binding 0 is a uniform [`layout::KeptWindow`], 1 the kept
/// `texture_depth_2d`.
pub const KEPT_PASS: &str = text!("kept");

/// WGSL of the compute pass that culls instances, `shaders/pass/cull.wesl`: entry point `cull`,
/// with a workgroup of 64 for as many instances. Binding 0 is a uniform [`layout::CullFrame`], 1 to
/// 7 are storage buffers: [`layout::CullSplit`], half spaces, masks' heights, [`layout::CullBox`],
/// [`layout::CullMesh`], and for writing [`layout::CullDraw`] and instance numbers.
pub const CULL_PASS: &str = text!("cull");

/// The maps of a receiver, and the way in which it reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Maps {
    /// Binding of the maps.
    pub bound: Bound,
    /// True if maps are colour textures of one 32-bit float, not depth textures, and the shader
    /// compares depth itself.
    pub r32f: bool,
    /// True if depth textures can be compared with but not loaded from (GL, WebGL2):
    /// [`layout::FilterKind::Pcss`] is then an ordinary disc.
    pub without_loads: bool,
    /// Length of the array of frames.
    pub frames: u32,
    /// Most splits of any light, 1 to [`layout::MAX_SPLITS`].
    pub splits: u32,
    /// Way in which moments are read, if maps contain moments of depth, of one light.
    pub moments: Option<MomentMaps>,
    /// True if vertex shaders may compute the shadow coordinates of every split:
    /// `umbrage_shadow_coordinates(position: vec3f)` returns an `UmbrageShadowCoordinates` of four
    /// members `first` to `fourth`, each a `vec3f` to be interpolated; fragment shaders call
    /// `umbrage_shadow_from_coordinates(query, coordinates)`. For one sun without warps and at most
    /// [`layout::MAX_COORDINATES`] splits. `umbrage_shadow(query)` computes the coordinates of the
    /// query's position.
    pub coordinates: bool,
}

impl Default for Maps {
    /// One light, and a device that supports everything.
    fn default() -> Self {
        Self {
            bound: Bound::Array,
            r32f: false,
            without_loads: false,
            frames: 1,
            splits: layout::MAX_SPLITS as u32,
            moments: None,
            coordinates: false,
        }
    }
}

/// Way in which moments are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MomentMaps {
    /// By a linear and anisotropic sampler. Bindings 1: `texture_2d_array<f32>`, 2: the sampler, 3:
    /// uniform [`layout::Moments`].
    Sampled,
    /// By a sampler that is linear only; the shader takes up to 16 samples in place of an
    /// anisotropic one.
    Taps,
    /// Without a sampler: the shader weights texels itself.
    Manual,
}

/// Instancing of casters into the maps of several splits in one pass. With neither, each pass draws
/// one split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Casters {
    /// True to draw into layers by multiview.
    pub views: bool,
    /// True to draw into tiles by instancing; clip distances keep the tiles apart.
    pub tiles: bool,
    /// True if texels also store the id of the run of triangles that they show, at colour target 0.
    pub ids: bool,
}

/// WGSL to put before a vertex shader that draws casters; it has to come first in its module. The
/// vertex shader takes an `UmbrageInstance` and returns the `UmbrageCast` from
/// `umbrage_cast(position: vec3f, instance: UmbrageInstance)`; `members` is WGSL for its other
/// outputs, for example `"@location(0) uv: vec2f,"`.
///
/// A vertex shader that takes `@builtin(instance_index)` itself calls `umbrage_cast_at(position,
/// code: u32)`, which needs no built-in. With [`Casters::views`] it is `umbrage_cast_at(position,
/// code, view: u32)`, and `view` is the shader's own `@builtin(view_index)`.
///
/// With [`Casters::ids`] the struct has `@location(14) @interpolate(flat, first) id: u32`, the last
/// location that weak devices have, which is 0 until `umbrage_named(drawn: UmbrageCast, id: u32) ->
/// UmbrageCast` sets it; `umbrage_caster_id(first: u32, run: u32)` computes an id from a caster's
/// first one. Without ids both functions exist, too, and do nothing. A fragment shader returns
/// `UmbrageTexel`, which `umbrage_caster_texel(position: vec4f, id: u32)` computes from its
/// `@builtin(position)` and the id, 0 for a caster whose triangles cannot be tested.
#[must_use]
pub fn caster(group: u32, casters: Casters, members: &str) -> String {
    let Casters { views, tiles, ids } = casters;
    let enable = if tiles { "enable clip_distances;\n" } else { "" };
    let view = if views { "    @builtin(view_index) view: u32,\n" } else { "" };
    let distances = if tiles { "    @builtin(clip_distances) clip_distances: array<f32, 4>,\n" } else { "" };
    let (id, named, texel, of_texel) = match ids {
        true => ("    @location(14) @interpolate(flat, first) id: u32,\n", "result.id = id; ", "u32", "id"),
        false => ("", "", "f32", "umbrage_caster_depth(position)"),
    };
    let root = match (views, tiles) {
        (false, false) => text!("caster"),
        (true, false) => text!("casters_views"),
        (false, true) => text!("casters_tiles"),
        (true, true) => text!("casters_views_tiles"),
    };
    format!(
        "{enable}const UMBRAGE_CASTER_GROUP = {group}u;\n\
         struct UmbrageInstance {{\n    @builtin(instance_index) code: u32,\n{view}}}\n\
         struct UmbrageCast {{\n    @builtin(position) position: vec4f,\n{distances}{id}    {members}\n}}\n\
         alias UmbrageTexel = {texel};\n\
         fn umbrage_named(drawn: UmbrageCast, id: u32) -> UmbrageCast {{ var result = drawn; {named}return result; }}\n\
         fn umbrage_caster_id(first: u32, run: u32) -> u32 {{ return select(0u, first + run, first != 0u); }}\n\
         fn umbrage_caster_texel(position: vec4f, id: u32) -> UmbrageTexel {{ return {of_texel}; }}\n{root}\n"
    )
}

/// WGSL of a compute shader, entry point `umbrage_seen`, that computes from an image's depth the
/// box around the geometry in each of its tiles. `samples` is true if the depth has several
/// samples, of which the first counts.
#[must_use]
pub fn seen(samples: bool) -> &'static str {
    if samples { text!("seen_of_samples") } else { text!("seen") }
}

/// Choices of a mask's pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MaskText {
    /// True if there is a texture of normals beside the depth.
    pub normals: bool,
    /// True if normals of the texture are turned towards the camera.
    pub turns: bool,
    /// True if queries contain their pixel's footprint, for [`ExactEdges`] of several positions.
    pub footprint: bool,
    /// True if pixels that bounds do not decide are discarded, for a second draw; the receiver's
    /// text is then one of [`ReceiverText::bounds`].
    pub bounds: bool,
}

/// WGSL of a whole pass to put after a [`receiver`]: the entry points `umbrage_mask_vertex` and
/// `umbrage_mask_fragment` convert an image's depth, and its normals where there are some, to a
/// mask of visibility. The uniform of binding 0 is read by vertices alone, what else there is by
/// fragments.
#[must_use]
pub fn mask(group: u32, choices: MaskText) -> String {
    let MaskText { normals, turns, footprint, bounds } = choices;
    let text = variant::resolved(if normals { text!("mask_with_normals") } else { text!("mask") }, |_| bounds);
    let turned = if normals { format!("const UMBRAGE_MASK_TURNS = {turns};\n") } else { String::new() };
    format!("const UMBRAGE_MASK_GROUP = {group}u;\nconst UMBRAGE_MASK_FOOTPRINT = {footprint};\n{turned}{text}\n")
}

/// WGSL to put before a shader that computes contact shadows: `fn
/// umbrage_contact_visibility(position: vec3f, normal: vec3f, to_light: vec3f, noise: f32) -> f32`.
/// Binding 0 is its uniform, 1 the image's depth as `texture_depth_2d`. It may be in one module
/// with [`receiver`].
#[must_use]
pub fn contact(group: u32) -> String {
    format!("const UMBRAGE_CONTACT_GROUP = {group}u;\n{}\n", text!("contact"))
}
