//! umbrage's WGSL as plain strings, and the structs that it shares with Rust.
//!
//! This crate uses no GPU API: any renderer that takes WGSL can use it, given a depth texture
//! array, a comparison sampler and a uniform buffer. `umbrage-wgpu` is the Rust side for wgpu.
//!
//! * `shaders/lib` has functions without bindings, `shaders/pass` the roots with bindings,
//!   `shaders/maps` the maps' own bindings and the two functions that read them. `src/wgsl` has
//!   what they join to: ordinary WGSL, in which every name begins with `umbrage`, in one case or
//!   another.
//! * A root is text to put before one's own shader. It declares no entry point and no override, so
//!   it adds nothing to a pipeline's constants: an override would become a constant of the *app's*
//!   pipeline, to be repeated wherever it makes one.
//! * What varies (filter, selection, strength) is a value in the [`layout::Frame`] uniform, unless
//!   [`ReceiverText`] fixes it: a text is then made without the rest, which compiles faster and
//!   runs faster. Another choice is another text.
//! * The index of the bind group is the app's choice: [`caster`] and [`receiver`] declare it as a
//!   WGSL constant.
//!
//! | binding of [`receiver`] | what |
//! |---|---|
//! | 0 | uniform array of [`layout::Frame`]: one for each light, six for a point light |
//! | 1 | `texture_depth_2d_array` or `texture_depth_cube`, cleared to 1; [`layout::Split`] says where in it a map lies |
//! | 2 | `sampler_comparison` with `LessEqual`, clamped to the edge; nearest for [`layout::FilterKind::Hard`], else linear |
//! | 3 … | [`Bound::Separate`]: a `texture_depth_2d` for each split. [`Bound::Cube`]: its faces as layers, where loads are possible |
//!
//! With [`ReceiverText::exact`] the next binding is a `texture_2d_array<u32>`, cleared to 0: the id
//! of the run of triangles that each texel shows. With [`Bound::Separate`] it is a
//! `texture_2d<u32>` for each split.
//!
//! With [`Maps::r32f`] the textures are `f32` that need no filtering; there is no comparison
//! sampler then, but a cube has a plain one at 2.
//!
//! | binding of [`caster`] | what |
//! |---|---|
//! | 0 | uniform [`layout::Split`]; where several splits are drawn at once, [`layout::CasterPass`] |

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

/// How a receiver's maps are bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Bound {
    /// Layers of one texture, and tiles of layers.
    #[default]
    Array,
    /// Faces of a cube.
    Cube,
    /// As many textures, 1 to [`layout::MAX_SPLITS`].
    Separate(usize),
}

/// The passes from depth to moments, `shaders/pass/moments.wesl`: entry points `vs_all`,
/// `fs_convert`, `fs_blur_u`, `fs_blur_v` and `fs_halve`, constants `KIND`, `POSITIVE_EXPONENT` and
/// `NEGATIVE_EXPONENT`.
pub const MOMENT_PASSES: &str = text!("moment_passes");

/// WGSL of the passes from depth with four samples per texel to moments.
pub const MOMENT_PASSES_OF_SAMPLES: &str = text!("moment_passes_of_samples");

/// The pass that copies what is kept of a split into its map, `shaders/pass/kept.wesl`: entry
/// points `vs_all` and `fs_copy`; binding 0 is a uniform [`layout::KeptWindow`], 1 the kept
/// `texture_depth_2d`.
pub const KEPT_PASS: &str = text!("kept");

/// The compute pass that culls instances, `shaders/pass/cull.wesl`: entry point `cull`, a workgroup
/// of 64 for as many instances; binding 0 is a uniform [`layout::CullFrame`], 1 to 7 are storage
/// buffers: [`layout::CullSplit`], half spaces, masks' heights, [`layout::CullBox`],
/// [`layout::CullMesh`], and written [`layout::CullDraw`] and numbers of instances.
pub const CULL_PASS: &str = text!("cull");

/// How a receiver reads its maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Maps {
    /// How they are bound.
    pub bound: Bound,
    /// They are colours of one 32-bit float, not depth, and compared by hand.
    pub r32f: bool,
    /// Depth textures can be compared with but not loaded from (GL, WebGL2):
    /// [`layout::FilterKind::Pcss`] is an ordinary disc.
    pub without_loads: bool,
    /// Length of the array of frames.
    pub frames: u32,
    /// Most splits of any light, 1 to [`layout::MAX_SPLITS`].
    pub splits: u32,
    /// Maps hold moments of depth, of one light.
    pub moments: Option<MomentMaps>,
    /// Vertex shaders may make the shadow coordinates of every split:
    /// `umbrage_shadow_coordinates(position: vec3f)` returns an `UmbrageShadowCoordinates` of four
    /// members `first` to `fourth`, each a `vec3f` to be interpolated; fragments ask
    /// `umbrage_shadow_from_coordinates(query, coordinates)`. For one sun without warps and at most
    /// [`layout::MAX_COORDINATES`] splits. `umbrage_shadow(query)` makes those of the query's
    /// position.
    pub coordinates: bool,
}

impl Default for Maps {
    /// One light, read with everything that a device can have.
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

/// How moments are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MomentMaps {
    /// Bindings 1: `texture_2d_array<f32>`, 2: a linear and anisotropic sampler, 3: uniform
    /// [`layout::Moments`].
    Sampled,
    /// Read with a sampler that is linear only; the shader takes up to 16 samples where an
    /// anisotropic one would.
    Taps,
    /// Read without a sampler: the shader weighs texels itself.
    Manual,
}

/// How casters are instanced into the maps of several splits in one pass; neither: each pass draws
/// one split.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Casters {
    /// By multiview, into layers.
    pub views: bool,
    /// By instancing, into tiles that clip distances keep apart.
    pub tiles: bool,
    /// Beside depth, texels take the id of the run of triangles that they show, at colour target 0.
    pub ids: bool,
}

/// Text to put before a vertex shader that draws casters, and before everything else in its module.
/// The vertex shader takes an `UmbrageInstance` and returns the `UmbrageCast` that
/// `umbrage_cast(position: vec3f, instance: UmbrageInstance)` makes; `members` is WGSL for what
/// else it has to return, for example `"@location(0) uv: vec2f,"`.
///
/// A vertex shader that takes `@builtin(instance_index)` itself calls `umbrage_cast_at(position,
/// code: u32)`, which asks for no built-in; with [`Casters::views`] it is
/// `umbrage_cast_at(position, code, view: u32)`, and `view` is the shader's own
/// `@builtin(view_index)`.
///
/// With [`Casters::ids`] the struct has `@location(15) @interpolate(flat, first) id: u32`, which is
/// 0 until `umbrage_named(drawn: UmbrageCast, id: u32) -> UmbrageCast` sets it;
/// `umbrage_caster_id(first: u32, run: u32)` makes an id of a caster's first one. Both are there
/// without ids, too, and do nothing then. A fragment shader returns `UmbrageTexel`, which
/// `umbrage_caster_texel(position: vec4f, id: u32)` makes of its `@builtin(position)` and the id, 0
/// for a caster that cannot be asked.
#[must_use]
pub fn caster(group: u32, casters: Casters, members: &str) -> String {
    let Casters { views, tiles, ids } = casters;
    let enable = if tiles { "enable clip_distances;\n" } else { "" };
    let view = if views { "    @builtin(view_index) view: u32,\n" } else { "" };
    let distances = if tiles { "    @builtin(clip_distances) clip_distances: array<f32, 4>,\n" } else { "" };
    let (id, named, texel, of_texel) = match ids {
        true => ("    @location(15) @interpolate(flat, first) id: u32,\n", "result.id = id; ", "u32", "id"),
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

/// A compute shader, entry point `umbrage_seen`: from a picture's depth to the box of what each of
/// its tiles shows. `samples`: the depth has several samples, of which the first one counts.
#[must_use]
pub fn seen(samples: bool) -> &'static str {
    if samples { text!("seen_of_samples") } else { text!("seen") }
}

/// A whole pass to put behind a [`receiver`]: the entry points `umbrage_mask_vertex` and
/// `umbrage_mask_fragment` turn a picture's depth (and its normals, if there is a texture of them)
/// into a mask of what is lit. `footprint`: queries say what their pixel covers, for
/// [`ExactEdges`] of several positions.
#[must_use]
pub fn mask(group: u32, normals: bool, footprint: bool) -> String {
    let text = if normals { text!("mask_with_normals") } else { text!("mask") };
    format!("const UMBRAGE_MASK_GROUP = {group}u;\nconst UMBRAGE_MASK_FOOTPRINT = {footprint};\n{text}\n")
}

/// Text to put before a shader that asks for contact shadows: `fn
/// umbrage_contact_visibility(position: vec3f, normal: vec3f, to_light: vec3f, noise: f32) -> f32`.
/// Binding 0 is its uniform, 1 the picture's depth as `texture_depth_2d`. It may stand beside
/// [`receiver`] in one module.
#[must_use]
pub fn contact(group: u32) -> String {
    format!("const UMBRAGE_CONTACT_GROUP = {group}u;\n{}\n", text!("contact"))
}
