//! Structs that WGSL and Rust share, member by member as in `shaders/lib/layout.wesl`.
//!
//! The enums are numbers that the shaders compare, and say which code a text of receivers needs.
//! They are no second config: they have no data, no words and no default. The choices of an
//! application are `umbrage::config`, which this crate does not depend on, so that other renderers
//! can use the WGSL without the planner. Only `options.rs` of `umbrage-wgpu` turns one into the
//! other.

use bytemuck::{Pod, Zeroable};

/// Most splits of a [`Frame`].
pub const MAX_SPLITS: usize = 8;

/// Most splits whose shadow coordinates vertex shaders pass on: four `vec3f` beside a shader's
/// other outputs, of the 15 that every device has.
pub const MAX_COORDINATES: usize = 4;

/// Kind of filter, in [`Frame::filter_kind`]. Kernels of fixed taps are numbered from 0, discs from
/// 8 and moments from 16: the shaders compare numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum FilterKind {
    /// One nearest texel, one comparison.
    Hard = 0,
    /// One linear comparison: the hardware's 2×2.
    Pcf2 = 1,
    /// A tent of three texels in four hardware taps.
    Pcf3 = 2,
    /// A tent of five texels in nine hardware taps.
    Pcf5 = 3,
    /// A tent of seven texels in sixteen hardware taps.
    Pcf7 = 4,
    /// Castaño's kernel of five texels in nine hardware taps.
    Castano5 = 5,
    /// A disc of 32 hardware taps.
    Disc = 8,
    /// A disc as wide as the penumbra of a sun with a size; without depth loads the same as
    /// [`FilterKind::Disc`].
    Pcss = 9,
    /// The mean of an exponential of depth.
    Esm = 16,
    /// Two moments of depth.
    Vsm = 17,
    /// Two moments of an exponential of depth.
    Evsm2 = 18,
    /// Two moments of a rising exponential of depth and two of a falling one.
    Evsm4 = 19,
    /// Four moments of depth.
    Msm = 20,
}

impl FilterKind {
    /// Every kind.
    pub const ALL: [Self; 13] = [
        Self::Hard,
        Self::Pcf2,
        Self::Pcf3,
        Self::Pcf5,
        Self::Pcf7,
        Self::Castano5,
        Self::Disc,
        Self::Pcss,
        Self::Esm,
        Self::Vsm,
        Self::Evsm2,
        Self::Evsm4,
        Self::Msm,
    ];

    /// Returns whether maps are converted to moments before they are sampled.
    #[must_use]
    pub const fn is_of_moments(self) -> bool {
        self as u32 >= Self::Esm as u32
    }

    /// The `@if` conditions of `shaders/lib` that enclose the code of this kind. A condition that
    /// no kind names does not concern filters.
    pub(crate) const fn parts(self) -> &'static [&'static str] {
        match self {
            Self::Hard => &["hard"],
            Self::Pcf2 => &["pcf2", "square", "texels"],
            Self::Pcf3 | Self::Pcf5 | Self::Pcf7 => &["tent", "square", "texels"],
            Self::Castano5 => &["castano5", "square", "texels"],
            Self::Disc => &["disc", "texels"],
            Self::Pcss => &["pcss", "disc", "texels"],
            Self::Vsm => &["vsm"],
            Self::Msm => &["msm"],
            Self::Esm | Self::Evsm2 | Self::Evsm4 => &[],
        }
    }
}

/// Measure by which splits are chosen, in [`Frame::is_radial`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum MetricKind {
    /// View depth.
    ViewDepth = 0,
    /// Distance from the camera.
    Distance = 1,
}

/// Rule by which a point selects its map, in [`Frame::selection`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum SelectionKind {
    /// The map of the slice that contains its view depth.
    Depth = 0,
    /// The first map that contains it.
    Map = 1,
}

/// Transition between neighbouring splits, in [`Frame::transition`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum TransitionKind {
    /// A mix of both splits over the band.
    Blend = 0,
    /// One of the two splits for each pixel of the band, by noise.
    Dither = 1,
    /// No band.
    Hard = 2,
}

/// Method that keeps receivers from shading themselves, in [`Frame::bias_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum BiasKind {
    /// Every texel is compared with the receiver's plane at the texel's centre.
    Plane = 0,
    /// All texels are compared with one depth, which is nearer by the slope over the filter's
    /// reach.
    Slope = 1,
}

/// One split: the position of its map and the view depths that it serves.
///
/// The rows apply to positions in metres relative to the frame's origin (with 1 as the fourth
/// coordinate). In a warped map and in that of a local light, the results of the first three rows
/// have to be divided by that of the fourth, which is positive at every receiver. A local light's
/// depth is `depth_offset − B/w`: its depth row is `(0, 0, 0, −B)` and w the metres along the axis.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Split {
    /// Position along the map's u (right) on the light's plane: `xyz` in texels per metre, `w` in
    /// texels, in `[0, 1)`.
    pub u_row: [f32; 4],
    /// Position along the map's v (down) on the light's plane: `xyz` in texels per metre, `w` in
    /// texels, in `[0, 1)`.
    pub v_row: [f32; 4],
    /// Depth in the map: `xyz` per metre, `w` without unit; 0 nearest the light, 1 farthest.
    pub depth_row: [f32; 4],
    /// Divisor w of a warped map or a local light's; all 0 in a plain map.
    pub w_row: [f32; 4],
    /// Offset from the two positions above to texels of the map, `[0, size]²`. Whole numbers.
    pub texel_offset: [f32; 2],
    /// Metres per texel along u and v; in a warped map in the middle of its receivers.
    pub texel_m: [f32; 2],
    /// Edge of the map in texels.
    pub size: f32,
    /// Far end of the slice: view depth in metres.
    pub far: f32,
    /// Begin of the blend into the next split: view depth in metres, `far` if there is none.
    pub blend_begin: f32,
    /// Metres between depth 0 and depth 1. In a warped map this holds where `w_row` gives 1;
    /// elsewhere it is multiplied by w. 1 for local lights, for which no single number holds.
    pub depth_range_m: f32,
    /// Step in metres by which the texture's format rounds depth; 0 if it is no coarser than `f32`.
    /// Scales like `depth_range_m`.
    pub depth_step_m: f32,
    /// 1 if nothing casts a shadow here: the map is not read and everything is lit.
    pub is_empty: u32,
    /// Edge in texels of the square that clip space covers: at least `size`, larger by a power of
    /// two if there is room. The scissor cuts at the map's edge, exactly; the clipper would round
    /// where triangles cross the edge.
    pub viewport_texels: f32,
    /// Texels from the left and upper edge of the viewport's square to the map's.
    pub guard_texels: f32,
    /// Upper left corner of the map in its layer, in texels; 0 unless the layer contains several
    /// maps as tiles.
    pub corner: [f32; 2],
    /// Width and height of the map's layer in texels.
    pub layer_texels: [f32; 2],
    /// Index of the layer of the texture, of the face of the cube or of the texture that contains
    /// the map.
    pub layer: u32,
    /// Offset added to the depth from the rows: 0, except for a local light's A, which is greater
    /// than 0.
    pub depth_offset: f32,
    /// 1 if a local light's map stores depth that grows linearly with the metres along its axis, 0
    /// at its near plane and 1 at its far one, instead of `A − B/w`.
    pub is_linear: u32,
    /// Texels around a sample that the filter may read.
    pub filter_radius_texels: f32,
}

/// Uniform of a pass that draws several splits at once.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterPass {
    /// Index of the first split that the pass draws.
    pub first: u32,
    /// Index one past the last split.
    pub end: u32,
    /// Number of layers drawn at once. Split `first + t · views + v` is tile `t` of layer `v`.
    pub views: u32,
    /// Padding to the alignment of 16 bytes.
    pub _padding: u32,
    /// All splits of the frame.
    pub splits: [Split; MAX_SPLITS],
}

/// Value of [`Frame::slice`] if all maps exist.
pub const EVERY_SLICE: u32 = u32::MAX;

/// Uniform of a receiver for one light and one view; for a point light, for one face of its cube.
/// Receivers bind an array of frames: those of all lights, six for a point light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Frame {
    /// View depth in metres of a position relative to the frame's origin.
    pub view_depth_plane: [f32; 4],
    /// Unit vector in the world towards a sun; for a spot light, the reverse of its axis.
    pub to_light: [f32; 3],
    /// Darkness of a shadow: 0 none, 1 black.
    pub strength: f32,
    /// Position of a local light relative to the frame's origin, in metres.
    pub light_position: [f32; 3],
    /// Range of a local light in metres; 0 for a sun.
    pub light_range_m: f32,
    /// View depth in metres at which the fade to lit begins; the last split's `far` if there is
    /// none.
    pub fade_begin: f32,
    /// Number of splits in use.
    pub split_count: u32,
    /// A [`FilterKind`].
    pub filter_kind: u32,
    /// 0 if shadows are disabled: every surface that faces the light is lit.
    pub enabled: u32,
    /// 1 if results contain their split's debug colour.
    pub tint: u32,
    /// Full width of the filter across the light in metres, in every split; 0 for the width in
    /// texels of its kind.
    pub filter_width_m: f32,
    /// tan(a/2) of the sun's angular diameter a.
    pub sun_tangent: f32,
    /// Largest rotation of the disc's pattern from pixel to pixel in radians: 0 for none, 2π for
    /// any.
    pub turn_per_pixel: f32,
    /// A [`TransitionKind`].
    pub transition: u32,
    /// Cosine of a spot light's outer angle; −2 for lights without a cone.
    pub cone_cosine: f32,
    /// Index of the first frame of the light whose index is that of this frame.
    pub first_frame: u32,
    /// Number of frames of this frame's light: 1, or 6 for a point light.
    pub face_count: u32,
    /// Factor of the light in full shadow: linear red, green and blue, 0 to 1.
    pub shadow_colour: [f32; 3],
    /// A [`BiasKind`].
    pub bias_kind: u32,
    /// Position of the camera relative to the frame's origin, in metres.
    pub eye: [f32; 3],
    /// A [`MetricKind`]: with [`MetricKind::Distance`] all view depths of the frame are distances.
    pub is_radial: u32,
    /// A [`SelectionKind`].
    pub selection: u32,
    /// With [`SelectionKind::Map`]: share of a map's half edge over which the map blends into the
    /// next one that contains the point.
    pub map_blend: f32,
    /// Index of the only split whose map exists, if one map is reused; [`EVERY_SLICE`] if all maps
    /// exist.
    pub slice: u32,
    /// Padding to the alignment of 16 bytes.
    pub _padding: [u32; 1],
    /// The splits, nearest first; those past `split_count` are not read.
    pub splits: [Split; MAX_SPLITS],
}

/// Parameters of the passes and the sampling of one split's moments.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MomentSplit {
    /// Scale and offset from stored depth to the z of moments, −1 at the nearest and 1 at the
    /// farthest shaded point: `z = depth[0] · stored + depth[1]`.
    pub depth: [f32; 2],
    /// Half width in texels along u and v, at least 1, of the tent that blur and linear sampling
    /// make of an edge.
    pub radius: [f32; 2],
    /// 1 if all pixels of a quad use one split. The same in all splits; it is here and not beside
    /// them because Mesa's software driver (22.3) crashes over control flow that depends on a
    /// constant location in a second uniform buffer.
    pub quads: u32,
    /// Padding to the alignment of 16 bytes.
    pub _padding: [u32; 3],
}

/// Uniform of the passes that make a split's moments.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MomentPass {
    /// Parameters of the split.
    pub split: MomentSplit,
    /// Edge of the split's map in texels.
    pub size: f32,
    /// Padding to the alignment of 8 bytes.
    pub _padding: u32,
}

/// Uniform of a receiver that reads moments, beside its [`Frame`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Moments {
    /// Exponents of the rising and of the falling exponential, for exponential kinds.
    pub exponents: [f32; 2],
    /// Share of light that counts as a leak: from 0, for none, to less than 1.
    pub bleeding: f32,
    /// Padding to the alignment of 16 bytes.
    pub _padding: u32,
    /// The splits, nearest first.
    pub splits: [MomentSplit; MAX_SPLITS],
}

/// Position of a map in the kept texture of its split.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct KeptWindow {
    /// Position of the map's upper left texel in the kept texture.
    pub begin: [i32; 2],
    /// Upper left corner of the map in its layer, in texels.
    pub corner: [i32; 2],
    /// Edge of the kept texture in texels; texels past it continue at the opposite edge.
    pub edge: i32,
    /// Padding to the alignment of 8 bytes.
    pub _padding: i32,
}

/// Number of bits of an id that count runs within a slot: `id = 1 + (slot << RUN_BITS | run)`. A
/// slot has 4,096 runs of 8 triangles; a larger caster takes several slots. With fewer bits large
/// casters take many slots; with more there are fewer casters, of which there can be 2^20 − 1.
pub const RUN_BITS: u32 = 12;

/// Number of triangles of a run. With fewer, casters whose triangles are smaller than a texel are
/// missed; with more, points are tested against more triangles (`docs/notes/exact-edges.md`).
pub const RUN_TRIANGLES: u32 = 8;

/// A slot of ids in a buffer of [`crate::stored_runs`]: the position of a caster, and its runs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct StoredSlot {
    /// First row of the affine transform from metres relative to the frame's origin to the space of
    /// the stored positions.
    pub row_x: [f32; 4],
    /// Second row of the transform.
    pub row_y: [f32; 4],
    /// Third row of the transform.
    pub row_z: [f32; 4],
    /// Index of the slot's first run among the stored ones.
    pub first_run: u32,
    /// Padding to the alignment of 16 bytes.
    pub _padding: [u32; 3],
}

/// A run of consecutive triangles in a buffer of [`crate::stored_runs`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct StoredRun {
    /// Least corner of a box around the triangles, in the space of the stored positions.
    pub min: [f32; 3],
    /// Number of triangles.
    pub triangles: u32,
    /// Greatest corner of the box around the triangles.
    pub max: [f32; 3],
    /// Offset of the run's first index.
    pub first_index: u32,
}

/// Uniform of culling: `shaders/pass/cull.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullFrame {
    /// Number of instances.
    pub instances: u32,
    /// Number of splits.
    pub splits: u32,
    /// Number of meshes.
    pub meshes: u32,
    /// Number of places for instance numbers in each split.
    pub room: u32,
}

/// The test of a split's casters, [`umbrage::CasterTest`](https://docs.rs/umbrage).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CullSplit {
    /// Direction in which light travels.
    pub direction: [f32; 3],
    /// Index of the test's first half space.
    pub first_plane: u32,
    /// Least corner of the receivers' box.
    pub receivers_min: [f32; 3],
    /// Number of the test's half spaces.
    pub plane_count: u32,
    /// Greatest corner of the receivers' box.
    pub receivers_max: [f32; 3],
    /// 1 if the receivers' box is known, otherwise 0.
    pub has_receivers: u32,
    /// Metres by which a flat box may rise above the receivers' lowest point and still be rejected.
    pub slack: f32,
    /// Metres by which any other box has to lie below the receivers' lowest point to be rejected.
    pub margin: f32,
    /// World axis of a mask's heights; 3 without a mask.
    pub mask_axis: u32,
    /// Sign of heights, 1 or −1: height is the coordinate times this.
    pub mask_sign: f32,
    /// Least corner of the mask's grid, in metres.
    pub mask_begin: [f32; 2],
    /// Size of the mask's cells in metres.
    pub mask_cell: [f32; 2],
    /// Metres that a ray of light moves along the grid's axes per metre of height.
    pub mask_slope: [f32; 2],
    /// Padding to the alignment of 16 bytes.
    pub _padding: [u32; 2],
}

/// An instance for culling: its box in metres, relative to an origin that the application chooses.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CullBox {
    /// Centre of the box.
    pub center: [f32; 3],
    /// Index of the instance's mesh.
    pub mesh: u32,
    /// Half extent of the box along each axis; 0 or more.
    pub half: [f32; 3],
    /// 0, or any other value for an instance that casts no shadow.
    pub skip: u32,
}

/// Range of places in which the instances of a mesh are listed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullMesh {
    /// First place of the mesh in each split.
    pub first: u32,
    /// Number of places of the mesh.
    pub room: u32,
}

/// Arguments of an indexed indirect draw.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullDraw {
    /// Number of indices of the mesh.
    pub index_count: u32,
    /// Number of instances drawn.
    pub instance_count: u32,
    /// Offset of the mesh's first index.
    pub first_index: u32,
    /// Value added to each index.
    pub base_vertex: i32,
    /// Always 0: instance numbers begin at the offset of a vertex buffer.
    pub first_instance: u32,
}
