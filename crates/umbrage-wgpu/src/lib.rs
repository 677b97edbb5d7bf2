//! Parallel-split (cascaded) shadow maps for any wgpu application.
//!
//! [`Shadows`] plans the maps, owns their textures and uniforms, and supplies the WGSL function
//! `umbrage_visibility`. It creates no device and no window and needs no meshes: the application
//! draws its casters with its own vertex formats.
//!
//! # Adopting it
//!
//! 1. Request the device with [`device_descriptor`], and make [`Shadows::new`] once.
//! 2. **Cast.** [`Shadows::caster_pipeline`] makes a pipeline from your vertex buffers.
//! 3. **Receive.** Put [`Shadows::receiver_wgsl`] before your shader, multiply the sun's light by
//!    `umbrage_visibility(position, normal)`, and put [`Shadows::bind_group_layout`] into your
//!    pipeline's layout.
//! 4. **Each frame:** [`Shadows::prepare`] with the camera, the light and bounding boxes; draw the
//!    casters of every map of [`ShadowFrame::maps`]; [`Shadows::prefilter`]; then your own pass
//!    with [`Shadows::bind_group`].
//!
//! `examples/hello_shadows` is a whole program. [`ShadowConfig`] contains all settings; [`Shadows`]
//! lists the cost of a change. [`ShadowMaps`] and [`umbrage::Planner`] are the low-level API, for
//! engines that plan or draw in another way.
//!
//! Positions in both shaders are in metres relative to [`Inputs::origin`]. The normal is the
//! geometric normal, not an interpolated or mapped one, turned towards the camera, because the bias
//! follows from it. A fragment shader without a normal uses `normalize(cross(dpdy(position),
//! dpdx(position)))`.
//!
//! # Casters with their own shaders
//!
//! Return `umbrage_cast(position, instance)` from the vertex shader, with the position relative to
//! the origin and the parameter `instance: UmbrageInstance`. How you compute it is up to you:
//!
//! **Instanced**, with matrices as attributes of an instance buffer that has one row for each
//! caster; [`ShadowMap::rows`] gives the rows to draw:
//!
#![doc = concat!("```wgsl\n", include_str!("../examples/casters/instance_buffer.wgsl"), "```")]
//!
//! **Instanced**, with matrices in a storage buffer in group 1:
//!
#![doc = concat!("```wgsl\n", include_str!("../examples/casters/instanced.wgsl"), "```")]
//!
//! **Skinned**, with joints in a storage buffer in group 1:
//!
#![doc = concat!("```wgsl\n", include_str!("../examples/casters/skinned.wgsl"), "```")]
//!
//! **Alpha-tested**, with [`CasterPipeline::members`] `"@location(0) uv: vec2f,"` and
//! [`CasterPipeline::discards`]:
//!
#![doc = concat!("```wgsl\n", include_str!("../examples/casters/alpha_tested.wgsl"), "```")]
//!
//! # Exact edges
//!
//! With [`umbrage::config::Edges::Exact`] a texel stores the id of the run of eight triangles that
//! it shows, and points near an edge are tested against these triangles. The library still sees no
//! mesh:
//!
//! 1. [`Shadows::occluders`] hands out ids, one for each run of a caster.
//! 2. **Cast.** The vertex shader returns `umbrage_named(umbrage_cast(position, instance), id)`,
//!    where `id` is `umbrage_caster_id(first, run)` of the caster's first id and the run of the
//!    triangle's first vertex. A caster whose shader does not is drawn with the id 0; its triangles
//!    cannot be tested, and its edges are the contour of the filter.
//! 3. **Receive.** [`stored_runs_wgsl`] beside [`Shadows::receiver_wgsl`], with four storage
//!    buffers of the application ([`stored_runs_layout`], [`stored_runs`]), or two functions of
//!    your own.
//!
//! Exact edges work for all lights and storages. With `samples` of 4 or 8 so many positions of a
//! pixel are decided, and edges are smooth; the query then has to contain its pixel
//! (`umbrage_fragment_query`). Deferred masks use [`ShadowMask::with_runs`].
//! [`ShadowMaps::counting_receiver_wgsl`] counts the tests, for debug views.
//!
//! A run is passed by a flat vertex attribute, so that no feature of the device is needed. Each
//! triangle's first vertex has to belong to one run alone; rotating the order of corners achieves
//! that, with a second copy of a vertex now and then. If a device has `PRIMITIVE_INDEX`, a fragment
//! shader may compute the run from `@builtin(primitive_index)` instead, which counts from 0 in each
//! draw.
//!
//! # WGSL functions
//!
//! | function | result |
//! |---|---|
//! | `umbrage_cast(position: vec3f, instance: UmbrageInstance) -> UmbrageCast` | the return value of a caster's vertex shader |
//! | `umbrage_cast_at(position: vec3f, code: u32) -> UmbrageCast` | the same for a shader that takes `@builtin(instance_index)` itself; drawn into several layers at once it also takes `view: u32` |
//! | `umbrage_caster_depth(position: vec4f) -> f32` | the return value of a caster's fragment shader, if maps are colour textures |
//! | `umbrage_caster_texel(position: vec4f, id: u32) -> UmbrageTexel` | the return value of a caster's fragment shader in any config: the id with exact edges, otherwise the depth |
//! | `umbrage_named(drawn: UmbrageCast, id: u32) -> UmbrageCast` | with exact edges, the return value of a caster's vertex shader with an id; otherwise `drawn` |
//! | `umbrage_in_slice(position) -> bool` | whether a fragment belongs to the slice that is drawn, if one map is reused |
//! | `umbrage_visibility(position: vec3f, normal: vec3f) -> f32` | visibility of the first light: 1 lit, 0 in shadow or turned away |
//! | `umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow` | of any light: `visibility: f32`, `split: i32` (−1: none), `tint: vec3f` and `light: vec3f`, the factor of the light ([`umbrage::config::Look::colour`]) |
//! | `umbrage_shadow_from_coordinates(query, coordinates) -> UmbrageShadow` | the same from coordinates that vertex shaders computed ([`umbrage::config::Coordinates::Vertex`]) |
//!
//! A query is a struct that one of two functions fills:
//!
//! ```wgsl
//! var query = umbrage_query(position, normal);                                  // in any stage
//! var query = umbrage_fragment_query(position, normal, dpdx(position), dpdy(position), pixel.xy);
//! query.light = 1u;   // another of several lights
//! query.split = 2;    // one split alone, for points off screen
//! ```
//!
//! Call `umbrage_fragment_query` in uniform control flow only. It passes on the pixel, which
//! dithered transitions and rotated kernels need, and the pixel's footprint, from which moment
//! filters ([`Filter::is_prefiltered`]) choose a mip level and exact edges the positions to decide.
//! Without it moment filters read the finest level, which shimmers in the distance, and exact edges
//! decide the position alone. All other functions work in any control flow and any stage.
//!
//! Put caster WGSL and receiver WGSL into separate shader modules: both declare the shared types.

mod caster_pipeline;
mod contact;
mod culling;
mod device;
mod error;
mod local;
mod maps;
mod mask;
mod moments;
mod occluders;
mod options;
mod seen;
mod shadows;
mod uniforms;

pub use caster_pipeline::CasterPipeline;
pub use contact::{ContactFrame, ContactOptions, ContactShadows, contact_wgsl};
pub use culling::{CullInputs, CullMesh, CulledDraw, InstanceCulling};
pub use error::{Error, Result};
pub use maps::{MapPass, ShadowMaps, Slice, device_descriptor, optional_features};
pub use mask::{MaskFrame, MaskNormals, MaskRuns, ShadowMask};
pub use moments::MomentStorage;
pub use occluders::{Occluder, Occluders, stored_runs, stored_runs_layout, stored_runs_wgsl};
pub use options::{FrameOptions, LightMaps, texture_format};
pub use seen::SeenDepth;
pub use shadows::{Inputs, ShadowFrame, ShadowMap, Shadows, ShapeDraw};
pub use umbrage;
pub use umbrage::config::{Filter, LightKind, ShadowConfig};
pub use umbrage_shaders::layout::{CullBox, CullDraw, MAX_COORDINATES, RUN_TRIANGLES, StoredRun, StoredSlot};
pub use wgpu;
