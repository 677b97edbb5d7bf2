//! Parallel-split shadow maps for any wgpu application.
//!
//! [`ShadowMaps`] owns the depth maps, their uniforms and bind groups. It creates no device, owns no window and knows no
//! mesh: the app draws its own casters, with its own pipelines and vertex formats, and calls one WGSL function where it shades.
//!
//! # Adopting it, in five steps
//!
//! 1. Request the device with `adapter.features() & umbrage_wgpu::optional_features()`, then make the maps once:
//!    `ShadowMaps::new(&device, &ShadowMapsOptions::default())`, and a planner that knows them:
//!    `Planner::new(ShadowSettings { image_size, ..maps.matching_settings() })`.
//! 2. **Cast.** Put [`ShadowMaps::caster_wgsl`] before everything else in your vertex shader's module; it takes an `UmbrageInstance` and
//!    returns `umbrage_cast(position, instance)`. The pipeline has [`ShadowMaps::caster_layout`] in that group,
//!    [`ShadowMaps::caster_depth_stencil`], [`ShadowMaps::caster_primitive`], [`ShadowMaps::caster_multiview_mask`] and the colour
//!    targets of [`ShadowMaps::caster_targets`]: none, and a fragment shader only if it discards, but where maps are colours.
//! 3. **Receive.** Put [`ShadowMaps::receiver_wgsl`] before your shading and multiply the sun's light by
//!    `umbrage_visibility(position, normal)`. The pipeline has [`ShadowMaps::receiver_layout`] in that group.
//! 4. **Each frame:** `planner.plan(…)`, [`ShadowMaps::prepare`], and every one of [`ShadowMaps::passes`] from
//!    [`ShadowMaps::begin_pass`], in which you bind [`ShadowMaps::caster_bind_group`] and draw [`MapPass::casters`], each with the
//!    instances that it comes with.
//! 5. Draw your picture with [`ShadowMaps::receiver_bind_group`] bound.
//!
//! All of that is the same whichever [`Generation`] and [`Storage`] you choose, but for [`Storage::Reused`], where steps 4 and 5 take turns
//! for each [`Slice`] of the view. A device that lacks what a generation needs gets another ([`ShadowMaps::notes`]).
//!
//! Positions in both shaders are metres relative to [`FrameOptions::origin`]. The normal is that of the surface itself, not an
//! interpolated or mapped one, turned towards the eye: the bias comes from it. In a fragment shader
//! `normalize(cross(dpdy(position), dpdx(position)))` will do where there is none in the vertices.
//! `examples/empty_app.rs` has all of it in 150 lines.
//!
//! # What the WGSL offers
//!
//! | function | answer |
//! |---|---|
//! | `umbrage_cast(position: vec3f, instance: UmbrageInstance) -> UmbrageCast` | what a caster's vertex shader returns |
//! | `umbrage_cast_at(position: vec3f, code: u32) -> UmbrageCast` | the same for a shader that takes `@builtin(instance_index)` itself; drawn into several layers at once it also takes `view: u32` |
//! | `umbrage_caster_depth(position: vec4f) -> f32` | what a caster's fragment shader returns where maps are colours |
//! | `umbrage_in_slice(position) -> bool` | whether a fragment belongs to the slice that is drawn, where one map is reused |
//! | `umbrage_visibility(position: vec3f, normal: vec3f) -> f32` | of the first light: 1 lit, 0 in shadow or turned away |
//! | `umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow` | of any light: `visibility: f32`, `split: i32` (−1: none), `tint: vec3f` and `light: vec3f`, what to multiply the light by ([`FrameOptions::shadow_colour`]) |
//! | `umbrage_shadow_from_coordinates(query, coordinates) -> UmbrageShadow` | the same from coordinates that vertices made ([`ShadowMaps::receiver_wgsl_with_coordinates`]) |
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
//! `umbrage_fragment_query` belongs in uniform control flow. It knows the fragment's pixel, which dithered borders and turned discs need,
//! and what the pixel covers, which filters of moments want ([`Filter::is_prefiltered`], with [`ShadowMaps::filter`] between steps 4 and
//! 5); without it they look at their finest level, which shimmers far away. Everything else works in any control flow and in every stage.
//!
//! Casters' and receivers' texts belong into two shader modules: both declare what they share.

mod contact;
mod error;
mod local;
mod maps;
mod mask;
mod moments;
mod options;
mod uniforms;

pub use contact::{ContactFrame, ContactOptions, ContactShadows, contact_wgsl};
pub use error::{Error, Result};
pub use maps::{MapPass, ShadowMaps, Slice, optional_features};
pub use mask::{MaskFrame, MaskNormals, ShadowMask};
pub use moments::MomentStorage;
pub use options::{
    DepthFormat, Derivatives, Filter, Fixed, FrameOptions, Generation, LightSlot, ReceiverBias, ShadowMapsOptions,
    Softness, Storage, Transition,
};
pub use umbrage_shaders::layout::MAX_COORDINATES;
