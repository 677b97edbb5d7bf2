//! What the options of shadows mean: everything that can be checked before a file is read.

use glam::DVec3;
use umbrage::config::{self, LightKind, SUN_DEGREES, ShadowConfig};
use umbrage::{ExtentSteps, MAX_SPLITS, ShadowSettings, SplitScheme, Warp};
use umbrage_render::{LightMaps, RenderSettings, Samples};

use super::{
    args::{self, Scheme, ShadowArgs, Technique, config_filter, of_word, typed_name},
    paths,
};
use crate::failure::{Failure, Result};

/// `--tsm-focus` where nothing else says one.
pub const DEFAULT_TSM_FOCUS: f64 = 0.3;

/// How shadows are made: [`ShadowArgs`], checked.
#[derive(Debug, PartialEq)]
pub struct ShadowJob {
    /// `--technique`.
    pub technique: Technique,
    /// For the planner. Its filter radius, depth clamp and image size are set by whoever knows them.
    pub settings: ShadowSettings,
    /// `--filter`.
    pub filter: args::Filter,
    /// `--filter-width`, metres.
    pub filter_width: Option<f64>,
    /// `--bleeding`.
    pub bleeding: Option<f64>,
    /// `--msaa`.
    pub msaa: u32,
    /// `--derivatives`.
    pub derivatives: args::Derivatives,
    /// `--fallbacks`.
    pub fallbacks: args::Fallbacks,
    /// `--transition`.
    pub transition: args::Transition,
    /// `--bias`.
    pub bias: args::Bias,
    /// `--shadow-strength`.
    pub shadow_strength: f64,
    /// `--translucent`.
    pub translucent: args::Translucent,
    /// `--contact-shadows`.
    pub contact_shadows: bool,
    /// `--shadow-colour`.
    pub shadow_colour: DVec3,
    /// `--coordinates`.
    pub coordinates: args::Coordinates,
    /// `--depth-format`.
    pub depth_format: args::DepthFormat,
    /// `--generation` and `--storage`.
    pub layout: config::Layout,
    /// Defaults invented.
    pub notes: Vec<String>,
    /// `--tint`.
    pub tint: bool,
    /// `--shadows`.
    pub shadows_on: bool,
    /// `--fit`, as typed.
    pub fit: args::Fit,
    /// `--bands`, as typed.
    pub bands: args::Bands,
    /// `--scheme`, as typed or as `--planes` implies.
    pub scheme: Scheme,
    /// As typed, or the default that goes with the maps.
    pub stabilize: args::Stabilize,
    /// `--warp`, or the technique's: one for all splits, or one for each.
    pub warps: Vec<args::Warp>,
}

impl ShadowJob {
    /// # Errors
    /// [`Failure::Input`] naming the options that do not go together.
    pub fn new(args: &ShadowArgs, image_size: [u32; 2]) -> Result<Self> {
        if args.shadow_range.is_some() && args.range_fit == args::RangeFit::Visible {
            return Err(Failure::input(
                "--shadow-range and --range-fit visible both choose the shadowed range; give one of them",
            ));
        }
        let map_sizes = map_sizes(args)?;
        let warps = warps(args, map_sizes.len())?;
        let stabilize = stabilize(args, &warps)?;
        if args.selection == args::Selection::Map
            && let Some(warp) = warps.iter().find(|warp| **warp != args::Warp::None)
        {
            return Err(Failure::input(format!(
                "--selection map and a {} map exclude each other: the first map that contains a point need not be the finest \
                 there; leave one of them away",
                typed_name(*warp)
            )));
        }
        if args.bands == args::Bands::Radial {
            let excludes = |option: &str, reason: &str| {
                Err(Failure::input(format!(
                    "--bands radial and {option} exclude each other: {reason}; leave one of them away"
                )))
            };
            if args.selection == args::Selection::Map {
                return excludes("--selection map", "maps that are chosen by what they contain have no bands");
            }
            if args.range_fit == args::RangeFit::Visible {
                return excludes(
                    "--range-fit visible",
                    "what is visible changes as the camera turns, and the bands with it",
                );
            }
        }
        let layout = paths::layout(args, &map_sizes)?;
        let (blend, note) = paths::blend(args, layout, map_sizes.len())?;
        let settings = ShadowSettings {
            scheme: scheme(args, map_sizes.len())?,
            map_sizes,
            range: args.shadow_range,
            range_fit: match args.range_fit {
                args::RangeFit::Camera => umbrage::RangeFit::Camera,
                args::RangeFit::Visible => umbrage::RangeFit::Visible,
            },
            fit: match args.fit {
                args::Fit::Dependent => umbrage::Fit::Dependent,
                args::Fit::Independent => umbrage::Fit::Independent,
            },
            selection: match args.selection {
                args::Selection::Depth => umbrage::Selection::Depth,
                args::Selection::Map => umbrage::Selection::Map,
            },
            bands: match args.bands {
                args::Bands::Planar => umbrage::Bands::Planar,
                args::Bands::Radial => umbrage::Bands::Radial,
            },
            stabilize: match stabilize {
                args::Stabilize::Exact => umbrage::Stabilize::Exact,
                args::Stabilize::Approximate => umbrage::Stabilize::Approximate(extent_steps(args)),
                args::Stabilize::None => umbrage::Stabilize::None,
            },
            warps: warps.iter().map(|&warp| planner_warp(warp, args.tsm_focus)).collect(),
            filter_radius: config_filter(args.filter).radius_texels(),
            filter_half_width_m: None,
            blend,
            far_fade: args.far_fade,
            depth_clamp: false,
            image_size,
        };
        settings.validate()?;
        check_moments(args, &warps)?;
        paths::check_coordinates(args, settings.map_sizes.len(), &warps)?;
        if args.filter_width.is_some() && !config_filter(args.filter).has_width() {
            return Err(Failure::input(format!(
                "--filter-width: --filter {} has no width to choose; leave it away, or use pcf3, pcf5, pcf7, disc, esm, vsm, evsm2, evsm4 or msm",
                typed_name(args.filter)
            )));
        }
        Ok(Self {
            technique: args.technique,
            settings,
            filter: args.filter,
            filter_width: args.filter_width,
            bleeding: args.bleeding,
            msaa: args.msaa.unwrap_or(1),
            derivatives: args.derivatives.unwrap_or_default(),
            fallbacks: args.fallbacks,
            transition: args.transition,
            bias: args.bias,
            shadow_strength: args.shadow_strength,
            translucent: args.translucent,
            contact_shadows: args.contact_shadows == args::Switch::On,
            shadow_colour: args.shadow_colour,
            coordinates: args.coordinates,
            depth_format: args.depth_format,
            layout,
            notes: note.into_iter().collect(),
            tint: args.tint,
            shadows_on: args.shadows == args::Switch::On,
            fit: args.fit,
            bands: args.bands,
            scheme: scheme_name(args),
            stabilize,
            warps,
        })
    }

    /// Everything that can be chosen about shadows, as one value, under a sun of this angle in degrees.
    #[must_use]
    pub fn config(&self, sun_angle: Option<f64>) -> ShadowConfig {
        let settings = &self.settings;
        ShadowConfig {
            map_sizes: settings.map_sizes.clone(),
            scheme: match &settings.scheme {
                SplitScheme::Uniform => config::SplitScheme::Uniform,
                SplitScheme::Logarithmic => config::SplitScheme::Logarithmic,
                SplitScheme::Practical { lambda, delta } => {
                    config::SplitScheme::Practical { lambda: *lambda, delta: delta.clone() }
                }
                SplitScheme::Manual(planes) => config::SplitScheme::Manual { planes: planes.clone() },
                SplitScheme::Fitted => config::SplitScheme::Optimal,
            },
            range: match (settings.range, settings.range_fit) {
                (Some((near, far)), _) => config::Range::Metres { near, far },
                (None, umbrage::RangeFit::Camera) => config::Range::Camera,
                (None, umbrage::RangeFit::Visible) => config::Range::Visible,
            },
            selection: match (settings.selection, settings.bands) {
                (umbrage::Selection::Map, _) => config::Selection::Map,
                (_, umbrage::Bands::Planar) => config::Selection::Interval(config::SplitMetric::ViewDepth),
                (_, umbrage::Bands::Radial) => config::Selection::Interval(config::SplitMetric::Distance),
            },
            transition: self.transition(),
            far_fade: settings.far_fade,
            crop: of_word(self.fit),
            stability: match settings.stabilize {
                umbrage::Stabilize::None => config::Stability::Tight { warps: settings.warps.clone() },
                umbrage::Stabilize::Exact => config::Stability::Exact,
                umbrage::Stabilize::Approximate(ExtentSteps::PerDoubling(count)) => {
                    config::Stability::Approximate { steps: config::ExtentSteps::PerDoubling(count) }
                }
                umbrage::Stabilize::Approximate(ExtentSteps::Levels(count)) => {
                    config::Stability::Approximate { steps: config::ExtentSteps::Levels(count) }
                }
            },
            filter: self.filter(sun_angle),
            depth_format: of_word(self.depth_format),
            layout: self.layout,
            fallbacks: of_word(self.fallbacks),
            coordinates: of_word(self.coordinates),
            look: config::Look {
                strength: self.shadow_strength,
                colour: self.shadow_colour.to_array(),
                bias: of_word(self.bias),
                translucent: of_word(self.translucent),
                contact: self.contact_shadows,
            },
        }
    }

    /// Everything that the renderer is told: pictures of `size` under `lights` and a sun of this angle in degrees.
    #[must_use]
    pub fn render_settings(
        &self,
        size: [u32; 2],
        samples: Samples,
        sun_angle: Option<f64>,
        lights: Vec<LightKind>,
    ) -> RenderSettings {
        let lights = lights.into_iter().map(LightMaps::from).collect();
        RenderSettings { size, samples, config: self.config(sun_angle), lights }
    }

    fn filter(&self, sun_angle: Option<f64>) -> config::Filter {
        let mut filter = config_filter(self.filter);
        match &mut filter {
            config::Filter::Pcf3 { width_m } | config::Filter::Pcf5 { width_m } | config::Filter::Pcf7 { width_m } => {
                *width_m = self.filter_width;
            }
            config::Filter::Disc { width_m, .. } => *width_m = self.filter_width,
            config::Filter::Pcss { sun_degrees, .. } => *sun_degrees = sun_angle.unwrap_or(SUN_DEGREES),
            config::Filter::Moments(moments) => {
                moments.width_m = self.filter_width;
                moments.samples = self.msaa;
                moments.bleeding = self.bleeding.unwrap_or(moments.bleeding);
                moments.derivatives = of_word(self.derivatives);
            }
            config::Filter::Hard | config::Filter::Pcf2 => {}
        }
        filter
    }

    /// How splits meet.
    #[must_use]
    pub fn transition(&self) -> config::Transition {
        let share = self.settings.blend;
        match self.transition {
            _ if share == 0.0 => config::Transition::Hard,
            args::Transition::Blend => config::Transition::Blend { share },
            args::Transition::Dither => config::Transition::Dither { share },
            args::Transition::Hard => config::Transition::Hard,
        }
    }
}

/// One edge per split.
fn map_sizes(args: &ShadowArgs) -> Result<Vec<u32>> {
    let typed = &args.map_size.0;
    let splits = match args.splits.map(|splits| splits as usize) {
        Some(splits) if !(1..=MAX_SPLITS).contains(&splits) => {
            return Err(Failure::input(format!("--splits {splits}: there may be 1 to {MAX_SPLITS}")));
        }
        Some(splits) if args.technique.single_map().is_some() && splits != 1 => {
            return Err(Failure::input(format!(
                "--splits {splits}: --technique {} is one map over the whole range; leave --splits away, or use pssm",
                typed_name(args.technique)
            )));
        }
        Some(splits) => splits,
        None if args.technique.single_map().is_some() => 1,
        None if typed.len() > 1 => typed.len(),
        None => args.planes.as_ref().map_or(4, |planes| planes.0.len() + 1),
    };
    if splits > MAX_SPLITS {
        return Err(Failure::input(format!(
            "--map-size or --planes asks for {splits} splits; there may be 1 to {MAX_SPLITS}"
        )));
    }
    match typed[..] {
        [edge] => Ok(vec![edge; splits]),
        _ if typed.len() == splits => Ok(typed.clone()),
        _ => Err(Failure::input(format!(
            "--map-size lists {} maps, but there {}; give one size, or one for each split",
            typed.len(),
            if splits == 1 { "is 1 split".into() } else { format!("are {splits} splits") },
        ))),
    }
}

/// What only filters of moments take, and what they do not.
fn check_moments(args: &ShadowArgs, warps: &[args::Warp]) -> Result<()> {
    let name = typed_name(args.filter);
    if config_filter(args.filter).is_prefiltered() {
        let storage = typed_name(args.storage);
        if !["auto", "array"].contains(&storage.as_str()) {
            return Err(Failure::input(format!(
                "--storage {storage} and --filter {name} exclude each other: moments are kept as an array; use --storage array, or a \
                 filter that compares depth, such as pcf5"
            )));
        }
        return match warps.iter().find(|warp| **warp != args::Warp::None) {
            Some(warp) => Err(Failure::input(format!(
                "--filter {name} needs depth that is linear along the light, which a map warped by {} has not; use a filter that \
                 compares depth, such as pcf5, or no warp",
                typed_name(*warp)
            ))),
            None if !matches!(args.msaa, None | Some(1 | 4)) => Err(Failure::input(format!(
                "--msaa {}: a texel has 1 sample or 4, as on every device; give one of these",
                args.msaa.unwrap_or_default()
            ))),
            None => Ok(()),
        };
    }
    let given = [
        ("--msaa", args.msaa.is_some()),
        ("--bleeding", args.bleeding.is_some()),
        ("--derivatives", args.derivatives.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::input(format!(
            "{option} belongs to the filters of moments, but --filter is {name}; leave it away, or use esm, vsm, evsm2, evsm4 or msm"
        ))),
        None => Ok(()),
    }
}

/// One warp for all splits, or one for each.
fn warps(args: &ShadowArgs, splits: usize) -> Result<Vec<args::Warp>> {
    let warps = match (args.technique.single_map(), &args.warp) {
        (Some(own), Some(typed)) if typed.0 != [own] => {
            let typed: Vec<String> = typed.0.iter().map(|&warp| typed_name(warp)).collect();
            return Err(Failure::input(format!(
                "--warp {}: --technique {} says how its one map is warped; leave --warp away, or use pssm with --splits 1",
                typed.join(","),
                typed_name(args.technique)
            )));
        }
        (Some(own), _) => vec![own],
        (None, Some(typed)) => typed.0.clone(),
        (None, None) => vec![args::Warp::None],
    };
    if warps.len() != 1 && warps.len() != splits {
        return Err(Failure::input(format!(
            "--warp lists {} warps, but the number of splits is {splits}; give one warp, or one for each split",
            warps.len()
        )));
    }
    if args.tsm_focus.is_some() && !warps.contains(&args::Warp::Tsm) {
        return Err(Failure::input("--tsm-focus belongs to --technique tsm and --warp tsm; leave it away"));
    }
    Ok(warps)
}

/// What was typed, or what goes with the maps: a warp follows the camera and cannot stand still.
fn stabilize(args: &ShadowArgs, warps: &[args::Warp]) -> Result<args::Stabilize> {
    for (option, typed) in [("--extent-steps", args.extent_steps), ("--extent-levels", args.extent_levels)] {
        if typed.is_some() && args.stabilize != Some(args::Stabilize::Approximate) {
            return Err(Failure::input(format!("{option} belongs to --stabilize approximate; leave one of them away")));
        }
    }
    if args.extent_steps.is_some() && args.extent_levels.is_some() {
        return Err(Failure::input("--extent-steps and --extent-levels both choose the steps; give one of them"));
    }
    let Some(warp) = warps.iter().find(|warp| **warp != args::Warp::None) else {
        return Ok(args.stabilize.unwrap_or_default());
    };
    if let Some(typed) = args.stabilize
        && typed != args::Stabilize::None
    {
        let culprit = match args.technique.single_map() {
            Some(_) => format!("--technique {}", typed_name(args.technique)),
            None => format!("--warp {}", typed_name(*warp)),
        };
        return Err(Failure::input(format!(
            "{culprit} and --stabilize {} exclude each other: a warped map follows the camera; leave one of them away",
            typed_name(typed)
        )));
    }
    Ok(args::Stabilize::None)
}

/// `--extent-steps` or `--extent-levels`; checked with all other settings.
fn extent_steps(args: &ShadowArgs) -> ExtentSteps {
    match (args.extent_steps, args.extent_levels) {
        (_, Some(levels)) => ExtentSteps::Levels(levels),
        (Some(steps), None) => ExtentSteps::PerDoubling(steps),
        (None, None) => ExtentSteps::default(),
    }
}

fn planner_warp(warp: args::Warp, focus: Option<f64>) -> Warp {
    match warp {
        args::Warp::None => Warp::None,
        args::Warp::Psm => Warp::Psm,
        args::Warp::Lispsm => Warp::Lispsm,
        args::Warp::Tsm => Warp::Tsm { focus: focus.unwrap_or(DEFAULT_TSM_FOCUS) },
    }
}

fn scheme_name(args: &ShadowArgs) -> Scheme {
    args.scheme.unwrap_or(if args.planes.is_some() { Scheme::Manual } else { Scheme::Practical })
}

fn scheme(args: &ShadowArgs, splits: usize) -> Result<SplitScheme> {
    let scheme = scheme_name(args);
    let name = typed_name(scheme);
    let only_for = |option: &str, owner: &str| {
        Err(Failure::input(format!(
            "{option} belongs to --scheme {owner}, but the scheme is {name}; leave one of them away"
        )))
    };
    if scheme != Scheme::Practical && args.lambda.is_some() {
        return only_for("--lambda", "practical");
    }
    if scheme != Scheme::Practical && args.delta.is_some() {
        return only_for("--delta", "practical");
    }
    if scheme != Scheme::Manual && args.planes.is_some() {
        return only_for("--planes", "manual");
    }
    Ok(match scheme {
        Scheme::Uniform => SplitScheme::Uniform,
        Scheme::Log => SplitScheme::Logarithmic,
        Scheme::Fitted => SplitScheme::Fitted,
        Scheme::Practical => SplitScheme::Practical {
            lambda: args.lambda.unwrap_or(0.5),
            delta: args.delta.as_ref().map(|delta| delta.0.clone()).unwrap_or_default(),
        },
        Scheme::Manual => match &args.planes {
            Some(planes) => SplitScheme::Manual(planes.0.clone()),
            None if splits == 1 => SplitScheme::Manual(Vec::new()),
            None => {
                return Err(Failure::input(format!(
                    "--scheme manual needs --planes with the {} inner planes of {splits} splits",
                    splits - 1
                )));
            }
        },
    })
}
