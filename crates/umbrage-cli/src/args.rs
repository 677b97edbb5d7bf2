//! What was typed. What it means is worked out in [`crate::scene_job`] and [`crate::shadow_job`].
//!
//! One set of scene, camera, light and time options serves every subcommand; what a subcommand does not need it accepts
//! and ignores, so one argument list serves `render`, `probe` and `truth`.

use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};
use glam::DVec3;

use crate::parse;

/// Sunlight and its shadows over large worlds: pictures, visibility masks, probes, and the exact truth to compare with.
#[derive(Debug, Parser)]
#[command(name = "umbrage", version, max_term_width = 110)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the scene: a picture, its visibility mask, its shadow maps, a report
    Render(Box<RenderArgs>),
    /// Answer the visibility of given points, from the very maps that `render` uses
    Probe(Box<ProbeArgs>),
    /// Work out the visibility mask exactly, by rays
    Truth(Box<TruthArgs>),
    /// Say how shadows would be made, without a GPU: planes, matrices and casters of each split, as JSON
    Plan(Box<PlanArgs>),
    /// Draw the papers' theory: split schemes and aliasing, areas, fits, frusta
    Theory {
        /// Write the page here (HTML, one file)
        #[arg(short = 'o', long = "output", value_name = "HTML")]
        output: PathBuf,
    },
    /// Judge techniques beside each other: contact sheets, scores, one page
    Compare(Box<crate::compare::args::CompareArgs>),
    /// Measure what shadows cost: times and counts of techniques in turn, ratios to the first, one page
    Bench(Box<crate::bench::args::BenchArgs>),
    /// The procedural worlds
    Worlds {
        /// What to do with them.
        #[command(subcommand)]
        command: WorldsCommand,
    },
    /// Say which graphics adapter would be used, or fail if there is none
    #[command(hide = true)]
    Adapter,
}

/// `umbrage render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Write the picture here (PNG)
    #[arg(short = 'o', long = "output", value_name = "PICTURE", help_heading = "Output")]
    pub picture: Option<PathBuf>,
    /// Write the visibility mask here (PNG, grey and alpha: 255 lit, 0 shadowed, alpha 0 where nothing was hit)
    #[arg(long, value_name = "MASK", help_heading = "Output")]
    pub visibility: Option<PathBuf>,
    /// Write each split's map into this folder, as pictures
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub maps: Option<PathBuf>,
    /// Write two pictures of each split into this folder: the scene between the split's planes (planned as a view of its own), and as the
    /// light sees it through the split's map
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub split_views: Option<PathBuf>,
    /// Write what was done and what it cost here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// `umbrage probe`.
#[derive(Debug, clap::Args)]
pub struct ProbeArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Records of six little-endian f64: a world position and a geometric normal
    #[arg(long, value_name = "IN")]
    pub points: PathBuf,
    /// Write one little-endian f32 of visibility per record here
    #[arg(long, value_name = "OUT", help_heading = "Output")]
    pub out: PathBuf,
    /// Write what was done and what it cost here, with the split of each point (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// `umbrage truth`.
#[derive(Debug, clap::Args)]
pub struct TruthArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Accepted and ignored: rays need none of it.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Write the exact visibility mask here (PNG, grey and alpha); soft with --sun-angle, by 256 directions
    #[arg(short = 'o', long = "output", value_name = "MASK", help_heading = "Output")]
    pub mask: PathBuf,
    /// Write scene, camera, sun and times here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// `umbrage plan`.
#[derive(Debug, clap::Args)]
pub struct PlanArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Depth of the matrices' normalised device coordinates
    #[arg(long, value_enum, default_value_t, help_heading = "Output")]
    pub depth_convention: DepthConvention,
    /// Write the plan here (JSON) instead of printing it; with --frames, NAME.json becomes NAME.0000.json and so on
    #[arg(short = 'o', long = "output", value_name = "JSON", help_heading = "Output")]
    pub output: Option<PathBuf>,
}

/// `umbrage worlds`.
#[derive(Debug, Subcommand)]
pub enum WorldsCommand {
    /// Name them, with their cameras
    List,
    /// Write one as binary glTF
    Export {
        /// A world's name, see `umbrage worlds list`
        #[arg(value_name = "NAME")]
        name: String,
        /// Write it here (.glb)
        #[arg(short = 'o', long = "output", value_name = "FILE")]
        output: PathBuf,
    },
}

/// `--texture-memory` where nothing says otherwise, MiB.
pub const TEXTURE_MIB: u32 = 512;

/// Scene, picture size, camera, light and time.
#[derive(Debug, clap::Args)]
pub struct SceneArgs {
    /// A .glb, .gltf or .vrm; a height map (.png, .tif or .asc, with a .json beside it or the --metres options where it has
    /// no scale of its own); or a world: robot-war, chessboard, knights, mining-terrain
    #[arg(value_name = "SCENE")]
    pub scene: String,
    /// Height map: metres between posts
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_post: Option<f64>,
    /// Height map: metres per unit of a pixel's value
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_unit: Option<f64>,
    /// Height map: metres added to every height
    #[arg(long, value_name = "M", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub height_offset: Option<f64>,
    /// Height map: how a picture holds heights, where its values do not tell
    #[arg(long, value_enum, default_value_t, help_heading = "Scene")]
    pub height_encoding: HeightEncoding,
    /// glTF: most memory for textures, in MiB; larger ones are scaled down, with a note
    #[arg(long, value_name = "MIB", default_value_t = TEXTURE_MIB, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Scene")]
    pub texture_memory: u32,
    /// glTF: let its files lie outside of its folder, as ../textures/bark.png does
    #[arg(long, help_heading = "Scene")]
    pub parent_folders: bool,
    /// Move the scene with its cameras and lights by this many metres, as if it lay far from the world's origin; --eye, --target and --path
    /// are places of the world
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Scene")]
    pub move_scene: Option<DVec3>,
    /// Seconds into the scene's animations
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub time: f64,

    /// Pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse::size, allow_hyphen_values = true, help_heading = "Camera")]
    pub size: [u32; 2],
    /// One of the scene's cameras; several between commas are shown side by side by render and truth, each as large as --size
    #[arg(long, value_name = "NAME|INDEX,…", help_heading = "Camera")]
    pub camera: Option<String>,
    /// Where the eye stands, in metres
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Camera")]
    pub eye: Option<DVec3>,
    /// The point it looks at; up is +Y, or −Z when looking along Y
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Camera")]
    pub target: Option<DVec3>,
    /// Vertical field of view in degrees [default: 60, or the camera's]
    #[arg(long, value_name = "DEGREES", value_parser = parse::field_of_view, allow_hyphen_values = true, help_heading = "Camera")]
    pub fov: Option<f64>,
    /// Near plane in metres [default: 1, or the camera's]
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Camera")]
    pub near: Option<f64>,
    /// Far plane in metres, or inf [default: 800, or the camera's]
    #[arg(long, value_name = "M", value_parser = parse::positive_or_infinite, allow_hyphen_values = true, help_heading = "Camera")]
    pub far: Option<f64>,
    /// Move the camera along an author's path (JSON)
    #[arg(long, value_name = "FILE", help_heading = "Camera")]
    pub path: Option<PathBuf>,
    /// With --path or --sun-to: this many frames; NAME.png becomes NAME.0000.png and so on
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Camera")]
    pub frames: Option<u32>,
    /// With --path: metres from the path up to the eye
    #[arg(long, value_name = "M", default_value = "2", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Camera")]
    pub eye_height: f64,

    /// Lights of the scene, directional, spot or point: one, several between commas, or all (at most 8). Pictures show all of
    /// them with their shadows; masks, probes, truth and plans are of the first [default: the first directional one]
    #[arg(long, value_name = "NAME|INDEX,…", help_heading = "Light")]
    pub light: Option<String>,
    /// The way light travels; any length
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true, help_heading = "Light")]
    pub sun: Option<DVec3>,
    /// The way light travels in the last of --frames: the sun moves there at an even pace
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_to: Option<DVec3>,
    /// With --sun-to: shadows follow in steps of this many degrees and stand still in between [default: they move every frame]
    #[arg(long, value_name = "DEGREES", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_step: Option<f64>,
    /// With --sun-step: frames over which a step is faded; 0 is sudden [default: 8]
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true, help_heading = "Light")]
    pub sun_fade: Option<u32>,
    /// Angle across the sun in degrees: what --filter pcss and the exact soft mask of `umbrage truth` go by
    /// [default: 0.53 for pcss; the exact mask is hard]
    #[arg(long, value_name = "DEGREES", value_parser = parse::sun_angle, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_angle: Option<f64>,
}

/// How shadows are made.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Shadows")]
pub struct ShadowArgs {
    /// How the shadow maps share the view
    #[arg(long, value_enum, default_value_t)]
    pub technique: Technique,
    /// Number of splits, 1 to 8 [default: 4, or as many as --map-size or --planes ask for]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub splits: Option<u32>,
    /// Edge of each map in texels: one size, or one per split
    #[arg(long, value_name = "TEXELS,…", default_value = "1024", value_parser = parse::map_sizes_list, allow_hyphen_values = true)]
    pub map_size: MapSizes,
    /// Where the planes between splits stand [default: practical, or manual where --planes is given]
    #[arg(long, value_enum)]
    pub scheme: Option<Scheme>,
    /// Share of the logarithmic scheme in the practical one, 0 to 1 [default: 0.5]
    #[arg(long, value_name = "SHARE", value_parser = parse::share, allow_hyphen_values = true)]
    pub lambda: Option<f64>,
    /// Metres added to the inner planes of the practical scheme: one for all, or one for each
    #[arg(long, value_name = "M,…", value_parser = parse::number_list, allow_hyphen_values = true)]
    pub delta: Option<Numbers>,
    /// The inner planes of the manual scheme: view depths in metres, rising
    #[arg(long, value_name = "M,…", value_parser = parse::plane_list, allow_hyphen_values = true)]
    pub planes: Option<Numbers>,
    /// View depths in metres that shadows cover [default: the camera's near and far, far capped by the scene]
    #[arg(long, value_name = "N..F", value_parser = parse::range, allow_hyphen_values = true)]
    pub shadow_range: Option<(f64, f64)>,
    /// What the shadowed range is fitted to where --shadow-range does not say it: the camera's near and far, or the visible
    /// objects
    #[arg(long, value_enum, default_value_t)]
    pub range_fit: RangeFit,
    /// What each map is fitted to: the slice alone, or its receivers and casters too
    #[arg(long, value_enum, default_value_t)]
    pub fit: Fit,
    /// Which map a pixel uses: that of its view depth, or the first (finest) that contains it
    #[arg(long, value_enum, default_value_t)]
    pub selection: Selection,
    /// What a split's borders measure: view depth, or distance from the eye, which a turning camera leaves alone
    #[arg(long, value_enum, default_value_t)]
    pub bands: Bands,
    /// Whether shadows stand still while the camera moves [default: exact, or none where a map is warped]
    #[arg(long, value_enum)]
    pub stabilize: Option<Stabilize>,
    /// With --stabilize approximate: steps to a doubling of a map's extent, 4 to 64; 24 are steps of 2.9 %, 8 of 9 % [default: 24]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub extent_steps: Option<u32>,
    /// With --stabilize approximate: instead, equal steps of so many to the whole shadowed range, 8 to 4096 (Practical Cascaded Shadow Maps has 64)
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub extent_levels: Option<u32>,
    /// How each split's map spreads its texels: none, psm, lispsm or tsm; one, or one per split [default: none]
    #[arg(long, value_name = "WARP,…", value_parser = parse::warp_list)]
    pub warp: Option<Warps>,
    /// Share of the depth range that trapezoidal maps give four fifths of their texels [default: 0.3]
    #[arg(long, value_name = "SHARE", value_parser = parse::focus, allow_hyphen_values = true)]
    pub tsm_focus: Option<f64>,
    /// How a map is looked up
    #[arg(long, value_enum, default_value_t)]
    pub filter: Filter,
    /// Full width of the filter in metres, the same in every split: for pcf3, pcf5, pcf7, disc and the filters of moments
    /// [default: in texels; for esm to msm 8 texels of the finest map]
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true)]
    pub filter_width: Option<f64>,
    /// Samples of depth in a texel, for esm to msm: 1 or 4 [default: 1]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub msaa: Option<u32>,
    /// Share of light that esm to msm take for a leak, 0 to 0.9 [default: 0.2]
    #[arg(long, value_name = "SHARE", value_parser = parse::share, allow_hyphen_values = true)]
    pub bleeding: Option<f64>,
    /// How esm to msm know what a pixel covers where splits meet [default: analytic]
    #[arg(long, value_enum)]
    pub derivatives: Option<Derivatives>,
    /// Whether what the device lacks may be replaced: filterable 32-bit floats for esm to msm, what --generation needs
    #[arg(long, value_enum, default_value_t)]
    pub fallbacks: Fallbacks,
    /// How one split goes over into the next
    #[arg(long, value_enum, default_value_t)]
    pub transition: Transition,
    /// Share of each split over which it blends into the next; 0 is off [default: 0.1, or 0 where one map is reused]
    #[arg(long, value_name = "SHARE", value_parser = parse::share, allow_hyphen_values = true)]
    pub blend: Option<f64>,
    /// Share of the shadowed range over which shadows fade out at its far end; 0 is off, as where nothing is seen beyond
    #[arg(long, value_name = "SHARE", default_value = "0.1", value_parser = parse::share, allow_hyphen_values = true)]
    pub far_fade: f64,
    /// Where the visibility mask takes map coordinates from; split serves one sun, up to 4 splits and no warp, and pictures too
    #[arg(long, value_enum, default_value_t)]
    pub coordinates: Coordinates,
    /// What a map stores
    #[arg(long, value_enum, default_value_t)]
    pub depth_format: DepthFormat,
    /// How maps are drawn; multipass goes with reused, layered with array or cube, instanced with atlas, mixed with array
    #[arg(long, value_enum, default_value_t)]
    pub generation: crate::paths::Generation,
    /// Where maps are kept
    #[arg(long, value_enum, default_value_t)]
    pub storage: crate::paths::Storage,
    /// How surfaces are kept from shading themselves; both go by texel, slope and filter width and need no number
    #[arg(long, value_enum, default_value_t)]
    pub bias: Bias,
    /// How dark shadows are, 0 (not at all) to 1 (no sun)
    #[arg(long, value_name = "SHARE", default_value = "1", value_parser = parse::share, allow_hyphen_values = true)]
    pub shadow_strength: f64,
    /// What the sun's light is multiplied by in full shadow: linear red, green, blue, 0 to 1 each
    #[arg(long, value_name = "R,G,B", default_value = "0,0,0", value_parser = parse::colour, allow_hyphen_values = true)]
    pub shadow_colour: DVec3,
    /// Whether translucent surfaces throw shadows; `umbrage truth` knows none of them
    #[arg(long, value_enum, default_value_t)]
    pub translucent: Translucent,
    /// Look for what shades a surface from close by in the picture's own depth, too: feet and gaps that maps are too coarse for. Such
    /// shadows move with the camera
    #[arg(long, value_name = "SWITCH", num_args = 0..=1, require_equals = true, default_value = "off", default_missing_value = "on")]
    pub contact_shadows: Switch,
    /// Colour the picture by split
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_value_t = false, default_missing_value = "true", action = clap::ArgAction::Set)]
    pub tint: bool,
    /// Draw with shadows or without
    #[arg(long, value_enum, default_value_t)]
    pub shadows: Switch,
}

/// A list as one value, so that clap does not take it for a repeated option.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers(pub Vec<f64>);

/// Edges of maps in texels, as one value.
#[derive(Clone, Debug, PartialEq)]
pub struct MapSizes(pub Vec<u32>);

/// `--warp`, as one value.
#[derive(Clone, Debug, PartialEq)]
pub struct Warps(pub Vec<Warp>);

/// One entry of `--warp`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Warp {
    /// Evenly
    #[default]
    None,
    /// As a perspective shadow map
    Psm,
    /// As a light space perspective shadow map
    Lispsm,
    /// As a trapezoidal shadow map
    Tsm,
}

/// `--technique`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Technique {
    /// Parallel-split shadow maps
    #[default]
    Pssm,
    /// One map over the whole range, with the same fit, culling and bias
    Ssm,
    /// One perspective shadow map
    Psm,
    /// One light space perspective shadow map
    Lispsm,
    /// One trapezoidal shadow map
    Tsm,
}

impl Technique {
    /// The warp of techniques that are one map; `None` for those that are split.
    #[must_use]
    pub fn single_map(self) -> Option<Warp> {
        match self {
            Self::Pssm => None,
            Self::Ssm => Some(Warp::None),
            Self::Psm => Some(Warp::Psm),
            Self::Lispsm => Some(Warp::Lispsm),
            Self::Tsm => Some(Warp::Tsm),
        }
    }
}

/// `--height-encoding`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum HeightEncoding {
    /// Whichever fits its values
    #[default]
    Auto,
    /// Grey
    Grey,
    /// Metres in colours: red · 256 + green + blue / 256 − 32768
    Terrarium,
    /// Metres in colours: (red · 65536 + green · 256 + blue) / 10 − 10000
    Mapbox,
}

/// `--scheme`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Scheme {
    /// Equal slices
    Uniform,
    /// Equal ratios
    Log,
    /// A mix of both, by --lambda
    #[default]
    Practical,
    /// By --planes
    Manual,
    /// Where the boxes of casters and receivers in view promise the least error
    Fitted,
}

/// `--range-fit`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum RangeFit {
    /// The camera's near and far, far capped by the scene
    #[default]
    Camera,
    /// The nearest and the farthest thing in view
    Visible,
}

/// `--fit`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Fit {
    /// Receivers and casters tighten the map
    #[default]
    Dependent,
    /// The slice alone
    Independent,
}

/// `--selection`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Selection {
    /// By view depth
    #[default]
    Depth,
    /// The first map that contains it
    Map,
}

/// `--bands`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Bands {
    /// Planes across the line of sight
    #[default]
    Planar,
    /// Spheres around the eye
    Radial,
}

/// `--stabilize`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Stabilize {
    /// A sphere around the slice, moved in whole texels
    #[default]
    Exact,
    /// A tight map on the light's own axes that changes its extent in steps, moved in whole texels
    Approximate,
    /// The tightest map for every frame
    None,
}

/// `--filter`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// One nearest texel, one comparison
    Hard,
    /// One bilinear comparison (2×2 texels)
    Pcf2,
    /// 3×3
    #[default]
    Pcf3,
    /// 5×5
    Pcf5,
    /// 7×7
    Pcf7,
    /// A disc of 32 taps
    Disc,
    /// As wide as the penumbra of a sun of --sun-angle
    Pcss,
    /// An exponential of depth, blurred
    Esm,
    /// Two moments of depth, blurred
    Vsm,
    /// Two moments of an exponential
    Evsm2,
    /// Four moments of two exponentials
    Evsm4,
    /// Four moments of depth
    Msm,
}

/// `--derivatives`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Derivatives {
    /// Those of the position, which no border interrupts
    #[default]
    Analytic,
    /// One split for all four pixels of a quad
    Quad,
}

/// `--fallbacks`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Fallbacks {
    /// They may, and the report says so
    #[default]
    Allow,
    /// It is an error
    Forbid,
}

/// `--translucent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Translucent {
    /// They throw none
    #[default]
    None,
    /// They cover as many texels of a map as their alpha says
    Dithered,
}

/// `--bias`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Bias {
    /// Every texel is compared with the surface's own plane
    #[default]
    Plane,
    /// All texels with one depth, moved by the slope times the filter's reach: forgives inexact normals, loses contact
    Slope,
}

/// `--transition`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Transition {
    /// Both are mixed over the band of --blend
    #[default]
    Blend,
    /// Each pixel of the band takes one of both, by noise
    Dither,
    /// No band
    Hard,
}

/// `--coordinates`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Coordinates {
    /// Interpolated world positions, from which each pixel makes its own
    #[default]
    World,
    /// Made by each vertex for every split and interpolated
    Split,
    /// Positions rebuilt from the picture's depth in a pass of its own, with normals from neighbouring pixels
    Deferred,
}

/// `--depth-format`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum DepthFormat {
    /// 32-bit float
    #[default]
    D32f,
    /// 16-bit
    D16,
    /// 32-bit float in a colour texture, compared by hand
    R32f,
}

/// `--depth-convention`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum DepthConvention {
    /// wgpu, Direct3D, Metal, Vulkan: NDC z in [0,1], v down
    #[default]
    ZeroToOne,
    /// OpenGL: NDC z in [−1,1], v up
    MinusOneToOne,
}

/// `--shadows`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// With
    #[default]
    On,
    /// Without
    Off,
}
