//! The shadow options as clap types: what was typed, shared by `umbrage render` and the text of techniques.
//!
//! [`super::job`] says what the options mean.

use clap::ValueEnum;
use glam::DVec3;

use crate::parse;

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
    #[arg(long, value_name = "TEXELS,…", default_value = "1024", value_parser = map_sizes_list, allow_hyphen_values = true)]
    pub map_size: MapSizes,
    /// Where the planes between splits stand [default: practical, or manual where --planes is given]
    #[arg(long, value_enum)]
    pub scheme: Option<Scheme>,
    /// Share of the logarithmic scheme in the practical one, 0 to 1 [default: 0.5]
    #[arg(long, value_name = "SHARE", value_parser = parse::share, allow_hyphen_values = true)]
    pub lambda: Option<f64>,
    /// Metres added to the inner planes of the practical scheme: one for all, or one for each
    #[arg(long, value_name = "M,…", value_parser = number_list, allow_hyphen_values = true)]
    pub delta: Option<Numbers>,
    /// The inner planes of the manual scheme: view depths in metres, rising
    #[arg(long, value_name = "M,…", value_parser = plane_list, allow_hyphen_values = true)]
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
    #[arg(long, value_name = "WARP,…", value_parser = warp_list)]
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
    pub generation: Generation,
    /// Where maps are kept
    #[arg(long, value_enum, default_value_t)]
    pub storage: Storage,
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

/// `--shadows`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// With
    #[default]
    On,
    /// Without
    Off,
}

/// `--generation`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Generation {
    /// What goes with the storage
    #[default]
    Auto,
    /// Map and picture slice by slice, one map for all
    Multipass,
    /// One pass for each split
    PerSplit,
    /// As many splits at once as the device has views, by multiview
    Layered,
    /// All splits at once, by instancing into tiles
    Instanced,
    /// All splits at once, by both: tiles in layers
    Mixed,
}

/// `--storage`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Storage {
    /// What goes with the generation
    #[default]
    Auto,
    /// Layers of one texture
    Array,
    /// Tiles of one texture
    Atlas,
    /// A texture for each map
    Separate,
    /// Faces of a cube: six maps of one size at most
    Cube,
    /// One map, used for one split after the other
    Reused,
}

fn number_list(text: &str) -> Result<Numbers, String> {
    parse::numbers(text).map(Numbers)
}

fn plane_list(text: &str) -> Result<Numbers, String> {
    parse::planes(text).map(Numbers)
}

fn map_sizes_list(text: &str) -> Result<MapSizes, String> {
    parse::map_sizes(text).map(MapSizes)
}

fn warp_list(text: &str) -> Result<Warps, String> {
    let warp = |name: &str| {
        Warp::from_str(name.trim(), false).map_err(|_| format!("{name:?} is no warp; there are none, psm, lispsm, tsm"))
    };
    text.split(',').map(warp).collect::<Result<_, _>>().map(Warps)
}

/// The config's filter, with its data at the defaults.
#[must_use]
pub fn config_filter(filter: Filter) -> umbrage::config::Filter {
    of_word(filter)
}

/// The config's value of the same word.
///
/// # Panics
/// If the config has no such word.
#[must_use]
pub fn of_word<T: std::str::FromStr<Err = String>>(value: impl ValueEnum) -> T {
    typed_name(value).parse().expect("options and config have the same words")
}

/// The name of an option's value as it is typed.
#[must_use]
pub fn typed_name(value: impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_one_of_the_config() {
        fn all<A: ValueEnum, T: std::str::FromStr<Err = String>>() {
            A::value_variants().iter().for_each(|value| drop(of_word::<T>(value.clone())));
        }
        use umbrage::config as to;
        all::<Filter, to::Filter>();
        all::<DepthFormat, to::DepthFormat>();
        all::<Derivatives, to::Derivatives>();
        all::<Fallbacks, to::Fallbacks>();
        all::<Bias, to::ReceiverBias>();
        all::<Translucent, to::Translucent>();
        all::<Coordinates, to::Coordinates>();
        all::<Fit, to::Crop>();
    }

    #[test]
    fn warps_are_one_or_one_for_each_split() {
        assert_eq!(warp_list("tsm, none"), Ok(Warps(vec![Warp::Tsm, Warp::None])));
        for bad in ["", "tsm,", "TSM", "warp"] {
            assert!(warp_list(bad).is_err(), "{bad}");
        }
    }
}
