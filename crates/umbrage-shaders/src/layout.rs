//! The structs that WGSL and Rust share, member by member as `shaders/lib/layout.wesl` has them.
//!
//! The enums are numbers that the shaders compare, and which code a text of receivers needs. They
//! are no second config: they have no data, no words and no default. The choices of an application
//! are `umbrage::config`, which this crate does not depend on, so that other renderers can use the
//! WGSL without the planner. `umbrage-wgpu` turns one into the other, in `options.rs` alone.

use bytemuck::{Pod, Zeroable};

/// The most splits a [`Frame`] holds.
pub const MAX_SPLITS: usize = 8;

/// The most splits whose shadow coordinates vertex shaders pass on: four `vec3f` beside what a
/// shader passes on anyway, of the 15 that every device has.
pub const MAX_COORDINATES: usize = 4;

/// How one map answers, in [`Frame::filter_kind`]. Kernels of fixed taps are numbered from 0, discs
/// from 8 and moments from 16: the shaders compare numbers.
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
    /// A disc as wide as the penumbra of a sun with a size; without depth loads as
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

    /// Whether maps are turned into moments before they are sampled.
    #[must_use]
    pub const fn is_of_moments(self) -> bool {
        self as u32 >= Self::Esm as u32
    }

    /// The `@if` conditions of `shaders/lib` behind which the code of this kind is. A condition
    /// that no kind names does not concern filters.
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

/// What splits are chosen by, in [`Frame::is_radial`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum MetricKind {
    /// View depth.
    ViewDepth = 0,
    /// Distance from the eye.
    Distance = 1,
}

/// Which map a point uses, in [`Frame::selection`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum SelectionKind {
    /// That of the slice in which its view depth lies.
    Depth = 0,
    /// The first that contains it.
    Map = 1,
}

/// How neighbouring splits are joined, in [`Frame::transition`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum TransitionKind {
    /// A mix of both over the band.
    Blend = 0,
    /// One of both for each pixel of the band, by noise.
    Dither = 1,
    /// No band.
    Hard = 2,
}

/// How a receiver is kept from shading itself, in [`Frame::bias_kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum BiasKind {
    /// Every texel is compared with the receiver's plane at its centre.
    Plane = 0,
    /// All texels are compared with one depth, nearer by what the slope makes of the filter's
    /// reach.
    Slope = 1,
}

/// One split: where its map lies and which view depths it serves.
///
/// The rows take positions in metres relative to the frame's origin (with 1 as the fourth
/// coordinate). In a warped map and in that of a local light what the first three give is to be
/// divided by what the fourth gives, which is positive at every receiver. A local light's depth is
/// `depth_offset − B/w`: its depth row is `(0, 0, 0, −B)` and w the metres along the axis.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Split {
    /// Place along the map's u (right) on the light's plane: `xyz` in texels per metre, `w` in
    /// texels, in `[0, 1)`.
    pub u_row: [f32; 4],
    /// Place along the map's v (down) on the light's plane: `xyz` in texels per metre, `w` in
    /// texels, in `[0, 1)`.
    pub v_row: [f32; 4],
    /// Depth in the map: `xyz` per metre, `w` without unit; 0 nearest the light, 1 farthest.
    pub depth_row: [f32; 4],
    /// What a warped map, or a local light's, divides by; all 0 in a plain map.
    pub w_row: [f32; 4],
    /// Added to the two places above it gives texels of the map, `[0, size]²`. Whole numbers.
    pub texel_offset: [f32; 2],
    /// Metres per texel along u and v; in a warped map in the middle of its receivers.
    pub texel_m: [f32; 2],
    /// Edge of the map in texels.
    pub size: f32,
    /// Where the slice ends: view depth in metres.
    pub far: f32,
    /// Where its blend into the next split begins: view depth in metres, `far` if there is none.
    pub blend_begin: f32,
    /// Metres between depth 0 and depth 1; in a warped map where `w_row` gives 1, elsewhere as many
    /// times as many. 1 for local lights, where no one number says it.
    pub depth_range_m: f32,
    /// The step in metres by which the texture's format rounds depth, 0 if it is no coarser than
    /// `f32`. Scales as `depth_range_m` does.
    pub depth_step_m: f32,
    /// 1 if nothing casts a shadow here: the map is not read and everything is lit.
    pub is_empty: u32,
    /// Edge in texels of the square that clip space covers: at least `size`, by a power of two
    /// where there is room. What lies outside the map is cut by the scissor, exactly, and not by
    /// the clipper, which would round where triangles cross the edge.
    pub viewport_texels: f32,
    /// Texels from the left and upper edge of that square to the map's.
    pub guard_texels: f32,
    /// Upper left corner of the map in its layer, in texels; 0 unless the layer holds several maps
    /// as tiles.
    pub corner: [f32; 2],
    /// Width and height of its layer in texels.
    pub layer_texels: [f32; 2],
    /// The layer of the texture, the face of the cube or the number of the texture that holds the
    /// map.
    pub layer: u32,
    /// Added to the depth that the rows give: 0, but for a local light's A, which is greater
    /// than 0.
    pub depth_offset: f32,
    /// 1 if a local light's map stores depth that grows evenly with the metres along its axis, 0 at
    /// its near plane and 1 at its far one, instead of `A − B/w`.
    pub is_linear: u32,
    /// Texels around a sample that the filter may read.
    pub filter_radius_texels: f32,
}

/// What a pass needs that draws several splits at once.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterPass {
    /// The first split that it draws.
    pub first: u32,
    /// One past the last.
    pub end: u32,
    /// Layers that are drawn at once. Split `first + t · views + v` is tile `t` of layer `v`.
    pub views: u32,
    /// Up to the alignment of 16 bytes.
    pub _padding: u32,
    /// All splits of the frame.
    pub splits: [Split; MAX_SPLITS],
}

/// [`Frame::slice`] where every map is there.
pub const EVERY_SLICE: u32 = u32::MAX;

/// All that a receiver needs for one light and one view; for a point light, for one face of its
/// cube. What receivers bind is an array of frames: of every light's, six for a point light.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Frame {
    /// View depth in metres of a position relative to the frame's origin.
    pub view_depth_plane: [f32; 4],
    /// Unit vector in the world from anywhere towards a sun; of a spot light that against its axis.
    pub to_light: [f32; 3],
    /// How dark a shadow is: 0 not at all, 1 black.
    pub strength: f32,
    /// Where a local light stands, relative to the frame's origin, metres.
    pub light_position: [f32; 3],
    /// How far a local light shines, metres; 0 for a sun.
    pub light_range_m: f32,
    /// View depth in metres at which the fade to lit begins; the last split's `far` if there is
    /// none.
    pub fade_begin: f32,
    /// Splits in use.
    pub split_count: u32,
    /// A [`FilterKind`].
    pub filter_kind: u32,
    /// 0: everything that faces the light is lit.
    pub enabled: u32,
    /// 1: answers carry their split's debug colour.
    pub tint: u32,
    /// Full width of the filter across the light in metres, in every split; 0: as many texels as
    /// its kind says.
    pub filter_width_m: f32,
    /// tan(a/2) of the sun's angle a across.
    pub sun_tangent: f32,
    /// How far the disc's pattern turns from pixel to pixel at most: 0 not at all, 2π all the way.
    /// Radians.
    pub turn_per_pixel: f32,
    /// A [`TransitionKind`].
    pub transition: u32,
    /// Cosine of a spot light's outer angle; −2 for lights without a cone.
    pub cone_cosine: f32,
    /// Of the light that has this frame's number: its first frame.
    pub first_frame: u32,
    /// How many frames this frame's light uses: 1, or 6 for a point light.
    pub face_count: u32,
    /// What the light of a place in full shadow is multiplied by: linear red, green and blue,
    /// 0 to 1.
    pub shadow_colour: [f32; 3],
    /// A [`BiasKind`].
    pub bias_kind: u32,
    /// Where the eye stands, relative to the frame's origin, metres; read with `is_radial`.
    pub eye: [f32; 3],
    /// A [`MetricKind`]: with [`MetricKind::Distance`] all view depths of the frame are distances.
    pub is_radial: u32,
    /// A [`SelectionKind`].
    pub selection: u32,
    /// With [`SelectionKind::Map`]: share of a map's half edge over which it blends into the next
    /// that contains the point.
    pub map_blend: f32,
    /// The only split whose map there is, where one map is used again and again; [`EVERY_SLICE`]
    /// where all are there.
    pub slice: u32,
    /// Up to the alignment of 16 bytes.
    pub _padding: [u32; 1],
    /// The splits, nearest first; those past `split_count` are not read.
    pub splits: [Split; MAX_SPLITS],
}

/// How one split's moments are made and read.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MomentSplit {
    /// From stored depth to the z of moments, -1 at the first and 1 at the last place that is seen:
    /// `z = depth[0] · stored + depth[1]`.
    pub depth: [f32; 2],
    /// Half width in texels along u and v, 1 or more, of the tent that blur and linear sampling
    /// make of an edge.
    pub radius: [f32; 2],
    /// 1: all pixels of a quad use one split. The same in all splits; here and not beside them
    /// because Mesa's software driver (22.3) crashes over control flow that hangs on a constant
    /// place in a second uniform buffer.
    pub quads: u32,
    /// Up to the alignment of 16 bytes.
    pub _padding: [u32; 3],
}

/// What the passes that make a split's moments need.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MomentPass {
    /// The split.
    pub split: MomentSplit,
    /// Edge of its map in texels.
    pub size: f32,
    /// Up to the alignment of 8 bytes.
    pub _padding: u32,
}

/// What a receiver needs of moments beside its [`Frame`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Moments {
    /// Exponents of exponential kinds, of the rising and of the falling one.
    pub exponents: [f32; 2],
    /// Share of light that is taken for a leak: 0 none, less than 1.
    pub bleeding: f32,
    /// Up to the alignment of 16 bytes.
    pub _padding: u32,
    /// The splits, nearest first.
    pub splits: [MomentSplit; MAX_SPLITS],
}

/// Where a map lies in the texture that is kept of its split.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct KeptWindow {
    /// The place of the map's upper left texel in the kept texture.
    pub begin: [i32; 2],
    /// Upper left corner of the map in its layer, in texels.
    pub corner: [i32; 2],
    /// Edge of the kept texture in texels: what lies past it is at its other end.
    pub edge: i32,
    /// Up to the alignment of 8 bytes.
    pub _padding: i32,
}

/// Bits of an id that count runs within a slot: `id = 1 + (slot << RUN_BITS | run)`. 4,096 runs of
/// 8 triangles; a larger caster takes several slots. Fewer: large casters take many. More: fewer
/// casters, of which there are 2^20 − 1.
pub const RUN_BITS: u32 = 12;

/// Triangles of a run that texels name. Fewer: casters whose triangles are smaller than a texel are
/// missed. More: points are tested against more triangles (`docs/notes/exact-edges.md`).
pub const RUN_TRIANGLES: u32 = 8;

/// A slot of ids in a buffer of [`crate::stored_runs`]: where a caster stands, and its runs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct StoredSlot {
    /// Row of the affine transform from metres relative to the frame's origin to the space of the
    /// stored positions: its first coordinate.
    pub row_x: [f32; 4],
    /// The second coordinate.
    pub row_y: [f32; 4],
    /// The third coordinate.
    pub row_z: [f32; 4],
    /// The slot's first run among the stored ones.
    pub first_run: u32,
    /// Up to the alignment of 16 bytes.
    pub _padding: [u32; 3],
}

/// A run of consecutive triangles in a buffer of [`crate::stored_runs`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct StoredRun {
    /// Least corner of a box around the triangles, in the space of the stored positions.
    pub min: [f32; 3],
    /// How many triangles there are.
    pub triangles: u32,
    /// Greatest corner of that box.
    pub max: [f32; 3],
    /// The first of their indices.
    pub first_index: u32,
}

/// What is culled: `shaders/pass/cull.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullFrame {
    /// How many instances there are.
    pub instances: u32,
    /// How many splits.
    pub splits: u32,
    /// How many meshes.
    pub meshes: u32,
    /// Places for numbers of instances in each split.
    pub room: u32,
}

/// The test of a split's casters, [`umbrage::CasterTest`](https://docs.rs/umbrage).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CullSplit {
    /// The way light travels.
    pub direction: [f32; 3],
    /// The first of its half spaces.
    pub first_plane: u32,
    /// Least corner of the receivers' box.
    pub receivers_min: [f32; 3],
    /// How many half spaces it has.
    pub plane_count: u32,
    /// Greatest corner of the receivers' box.
    pub receivers_max: [f32; 3],
    /// Whether that box is known.
    pub has_receivers: u32,
    /// Metres that a flat box may rise above the receivers' lowest point.
    pub slack: f32,
    /// Metres that any other box has to lie below it.
    pub margin: f32,
    /// The world axis of a mask's heights; 3 without a mask.
    pub mask_axis: u32,
    /// 1 or −1: height is so many times the coordinate.
    pub mask_sign: f32,
    /// Where the mask begins.
    pub mask_begin: [f32; 2],
    /// Metres of its cells.
    pub mask_cell: [f32; 2],
    /// How far a ray of light moves along its axes per metre of height.
    pub mask_slope: [f32; 2],
    /// Up to the alignment of 16 bytes.
    pub _padding: [u32; 2],
}

/// An instance as culling sees it: its box in metres, relative to an origin of the application's.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CullBox {
    /// The middle.
    pub center: [f32; 3],
    /// Number of the mesh that it shows.
    pub mesh: u32,
    /// Half of what it measures along each axis; 0 or more.
    pub half: [f32; 3],
    /// 0; anything else for an instance that casts no shadow.
    pub skip: u32,
}

/// Where the instances of a mesh are listed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullMesh {
    /// The first place of the mesh in each split.
    pub first: u32,
    /// How many places it has.
    pub room: u32,
}

/// Arguments of an indexed indirect draw.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CullDraw {
    /// Indices of the mesh.
    pub index_count: u32,
    /// Instances that are drawn.
    pub instance_count: u32,
    /// The mesh's first index.
    pub first_index: u32,
    /// Added to each index.
    pub base_vertex: i32,
    /// 0: where numbers of instances begin is the offset of a vertex buffer.
    pub first_instance: u32,
}
