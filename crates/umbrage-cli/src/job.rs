//! What the options mean: everything that can be checked before a file is read. The scene comes in [`crate::stage`].

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use glam::DVec3;
use umbrage::{ExtentSteps, MAX_SPLITS, ShadowSettings, SplitScheme, SteppedSun, Warp};

use crate::{
    args::{self, SceneArgs, Scheme, ShadowArgs, Technique},
    failure::{Failure, Result},
    paths,
};

/// `--fov` where nothing else says one, degrees.
pub const DEFAULT_FOV: f64 = 60.0;
/// `--near` where nothing else says one, metres.
pub const DEFAULT_NEAR: f64 = 1.0;
/// `--far` where nothing else says one, metres.
pub const DEFAULT_FAR: f64 = 800.0;
/// `--sun-fade` where nothing else says one, frames.
pub const DEFAULT_SUN_FADE: u32 = 8;
/// `--tsm-focus` where nothing else says one.
pub const DEFAULT_TSM_FOCUS: f64 = 0.3;

/// What is looked at, from where, under which sun: [`SceneArgs`], checked.
#[derive(Debug, PartialEq)]
pub struct SceneJob {
    /// A world's name or a file.
    pub scene: String,
    /// `--metres-per-post`.
    pub metres_per_post: Option<f64>,
    /// `--metres-per-unit`.
    pub metres_per_unit: Option<f64>,
    /// `--height-offset`.
    pub height_offset: Option<f64>,
    /// `--move-scene`, metres.
    pub move_scene: Option<DVec3>,
    /// Seconds into the animations.
    pub time_s: f64,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The eye.
    pub camera: CameraChoice,
    /// `--fov` as typed, degrees.
    pub fov: Option<f64>,
    /// `--near` as typed, metres.
    pub near: Option<f64>,
    /// `--far` as typed, metres.
    pub far: Option<f64>,
    /// The light.
    pub sun: SunChoice,
    /// `--sun-to` and what goes with it.
    pub sun_travel: Option<SunTravel>,
    /// `--sun-angle`, degrees across the sun.
    pub sun_angle: Option<f64>,
}

/// How the eye was chosen.
#[derive(Debug, PartialEq)]
pub enum CameraChoice {
    /// Not at all: the scene's first camera, or an invented one.
    Default,
    /// `--camera`.
    Named(String),
    /// `--eye` and `--target`.
    LookAt {
        /// Position.
        eye: DVec3,
        /// Another point.
        target: DVec3,
    },
    /// `--path`.
    Path {
        /// The path's file.
        file: PathBuf,
        /// `--frames`; without it the path's first point is one frame without a number.
        frames: Option<u32>,
        /// Metres from the path up to the eye.
        eye_height: f64,
    },
}

/// How the light was chosen.
#[derive(Debug, PartialEq)]
pub enum SunChoice {
    /// Not at all: the path's, else the scene's first directional light, else an invented one.
    Default,
    /// `--light`.
    Named(String),
    /// `--sun`: the way light travels.
    Given(DVec3),
}

/// How the sun moves over the frames.
#[derive(Debug, PartialEq)]
pub struct SunTravel {
    /// The way light travels in the last frame.
    pub to: DVec3,
    /// How many frames there are.
    pub frames: u32,
    /// Shadows follow in steps; every frame without.
    pub steps: Option<SteppedSun>,
}

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
    /// Whether `--coordinates` are `deferred`.
    pub deferred: bool,
    /// Where everything else takes map coordinates from.
    pub coordinates: umbrage_render::Coordinates,
    /// `--depth-format`.
    pub depth_format: args::DepthFormat,
    /// `--generation`.
    pub generation: umbrage_wgpu::Generation,
    /// `--storage`.
    pub storage: umbrage_wgpu::Storage,
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
    /// As typed, or the default that goes with the maps.
    pub stabilize: args::Stabilize,
    /// `--warp`, or the technique's: one for all splits, or one for each.
    pub warps: Vec<args::Warp>,
}

impl SceneJob {
    /// # Errors
    /// [`Failure::Input`] naming the options that do not go together.
    pub fn new(args: &SceneArgs) -> Result<Self> {
        let camera = camera_choice(args)?;
        let sun = match (&args.light, args.sun) {
            (Some(_), Some(_)) => {
                return Err(Failure::input("--light and --sun both choose the light; give one of them"));
            }
            (Some(name), None) => SunChoice::Named(name.clone()),
            (None, Some(direction)) => SunChoice::Given(direction),
            (None, None) => SunChoice::Default,
        };
        let own_lens = matches!(camera, CameraChoice::Default | CameraChoice::Named(_));
        let near = args.near.or((!own_lens).then_some(DEFAULT_NEAR));
        let far = args.far.or((!own_lens).then_some(DEFAULT_FAR));
        if let (Some(near), Some(far)) = (near, far)
            && near >= far
        {
            return Err(Failure::input(format!(
                "--near {near} is not less than --far {far}; give a nearer near or a farther far"
            )));
        }
        Ok(Self {
            scene: args.scene.clone(),
            metres_per_post: args.metres_per_post,
            metres_per_unit: args.metres_per_unit,
            height_offset: args.height_offset,
            move_scene: args.move_scene,
            time_s: args.time,
            size: args.size,
            camera,
            fov: args.fov,
            near,
            far,
            sun,
            sun_travel: sun_travel(args)?,
            sun_angle: args.sun_angle,
        })
    }

    /// Width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// The files that the job reads by name, so that no output replaces one.
    #[must_use]
    pub fn inputs(&self) -> Vec<&Path> {
        let scene = Path::new(&self.scene);
        match &self.camera {
            CameraChoice::Path { file, .. } => vec![scene, file],
            _ => vec![scene],
        }
    }
}

fn sun_travel(args: &SceneArgs) -> Result<Option<SunTravel>> {
    let Some(to) = args.sun_to else {
        return match (args.sun_step, args.sun_fade) {
            (Some(_), _) => Err(Failure::input("--sun-step needs a sun that moves; give --sun-to X,Y,Z")),
            (None, Some(_)) => {
                Err(Failure::input("--sun-fade needs steps to fade; give --sun-to X,Y,Z and --sun-step DEGREES"))
            }
            (None, None) => Ok(None),
        };
    };
    let frames = args.frames.unwrap_or(1);
    if frames < 2 {
        return Err(Failure::input("--sun-to moves the sun over frames; give --frames 2 or more"));
    }
    let steps = match (args.sun_step, args.sun_fade) {
        (Some(step), fade) => {
            let fade = f64::from(fade.unwrap_or(DEFAULT_SUN_FADE));
            Some(
                SteppedSun::new(step.to_radians(), fade)
                    .map_err(|error| Failure::input(format!("--sun-step: {error}")))?,
            )
        }
        (None, Some(_)) => return Err(Failure::input("--sun-fade needs steps to fade; give --sun-step DEGREES")),
        (None, None) => None,
    };
    Ok(Some(SunTravel { to, frames, steps }))
}

fn camera_choice(args: &SceneArgs) -> Result<CameraChoice> {
    let looks = args.eye.is_some() || args.target.is_some();
    let clash = |a: &str, b: &str| Err(Failure::input(format!("{a} and {b} both choose the camera; give one of them")));
    match (&args.camera, &args.path) {
        (Some(_), Some(_)) => return clash("--camera", "--path"),
        (Some(_), None) if looks => return clash("--camera", "--eye/--target"),
        (None, Some(_)) if looks => return clash("--path", "--eye/--target"),
        _ => {}
    }
    if args.path.is_none() && args.sun_to.is_none() && args.frames.is_some() {
        return Err(Failure::input("--frames goes along a path or a moving sun; give --path FILE or --sun-to X,Y,Z"));
    }
    if args.frames == Some(0) {
        return Err(Failure::input("--frames 0 asks for no frame; give 1 or more"));
    }
    match (args.eye, args.target) {
        (Some(eye), Some(target)) if eye == target => Err(Failure::input(format!(
            "--eye and --target are the same point, {},{},{}; give a target to look at",
            eye.x, eye.y, eye.z
        ))),
        (Some(eye), Some(target)) => Ok(CameraChoice::LookAt { eye, target }),
        (Some(_), None) => Err(Failure::input("--eye without --target: give the point to look at")),
        (None, Some(_)) => Err(Failure::input("--target without --eye: give the point to look from")),
        (None, None) => Ok(match (&args.camera, &args.path) {
            (Some(name), _) => CameraChoice::Named(name.clone()),
            (None, Some(file)) => {
                CameraChoice::Path { file: file.clone(), frames: args.frames, eye_height: args.eye_height }
            }
            (None, None) => CameraChoice::Default,
        }),
    }
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
        let (blend, note) = paths::blend(args, &map_sizes)?;
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
            filter_radius: wgpu_filter(args.filter).radius_texels(),
            blend,
            far_fade: args.far_fade,
            depth_clamp: false,
            image_size,
        };
        settings.validate()?;
        check_moments(args, &warps)?;
        paths::check_coordinates(args, settings.map_sizes.len(), &warps)?;
        if args.filter_width.is_some() && !wgpu_filter(args.filter).has_width() {
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
            deferred: args.coordinates == args::Coordinates::Deferred,
            coordinates: match args.coordinates {
                args::Coordinates::Split => umbrage_render::Coordinates::Split,
                args::Coordinates::World | args::Coordinates::Deferred => umbrage_render::Coordinates::World,
            },
            depth_format: args.depth_format,
            generation: args.generation.into(),
            storage: args.storage.into(),
            notes: note.into_iter().collect(),
            tint: args.tint,
            shadows_on: args.shadows == args::Switch::On,
            fit: args.fit,
            bands: args.bands,
            stabilize,
            warps,
        })
    }

    /// How soft edges are under a sun of this angle in degrees.
    #[must_use]
    pub fn softness(&self, sun_angle: Option<f64>) -> umbrage_wgpu::Softness {
        umbrage_wgpu::Softness {
            width_m: self.filter_width.map(|width| width as f32),
            sun_angle: sun_angle.map_or(umbrage_wgpu::Softness::SUN, |degrees| degrees.to_radians() as f32),
            turned: false,
            bleeding: self.bleeding.map_or(umbrage_wgpu::Softness::default().bleeding, |share| share as f32),
        }
    }

    /// What filters of moments leave to choose.
    #[must_use]
    pub fn moments(&self) -> umbrage_render::MomentSettings {
        umbrage_render::MomentSettings {
            samples: self.msaa,
            fallbacks: self.fallbacks == args::Fallbacks::Allow,
            derivatives: match self.derivatives {
                args::Derivatives::Analytic => umbrage_wgpu::Derivatives::Analytic,
                args::Derivatives::Quad => umbrage_wgpu::Derivatives::Quad,
            },
        }
    }

    /// How shadows look.
    #[must_use]
    pub fn look(&self) -> umbrage_render::Look {
        umbrage_render::Look {
            strength: self.shadow_strength as f32,
            colour: self.shadow_colour.as_vec3().to_array(),
            bias: match self.bias {
                args::Bias::Plane => umbrage_wgpu::ReceiverBias::Plane,
                args::Bias::Slope => umbrage_wgpu::ReceiverBias::Slope,
            },
            translucent: match self.translucent {
                args::Translucent::None => umbrage_render::Translucent::None,
                args::Translucent::Dithered => umbrage_render::Translucent::Dithered,
            },
            contact: self.contact_shadows.then(umbrage_wgpu::ContactOptions::default),
        }
    }

    /// How splits meet.
    #[must_use]
    pub fn transition(&self) -> umbrage_wgpu::Transition {
        match self.transition {
            args::Transition::Blend => umbrage_wgpu::Transition::Blend,
            args::Transition::Dither => umbrage_wgpu::Transition::Dither,
            args::Transition::Hard => umbrage_wgpu::Transition::Hard,
        }
    }
}

/// The renderer's filter.
#[must_use]
pub fn wgpu_filter(filter: args::Filter) -> umbrage_wgpu::Filter {
    match filter {
        args::Filter::Hard => umbrage_wgpu::Filter::Hard,
        args::Filter::Pcf2 => umbrage_wgpu::Filter::Pcf2,
        args::Filter::Pcf3 => umbrage_wgpu::Filter::Pcf3,
        args::Filter::Pcf5 => umbrage_wgpu::Filter::Pcf5,
        args::Filter::Pcf7 => umbrage_wgpu::Filter::Pcf7,
        args::Filter::Disc => umbrage_wgpu::Filter::Disc,
        args::Filter::Pcss => umbrage_wgpu::Filter::Pcss,
        args::Filter::Esm => umbrage_wgpu::Filter::Esm,
        args::Filter::Vsm => umbrage_wgpu::Filter::Vsm,
        args::Filter::Evsm2 => umbrage_wgpu::Filter::Evsm2,
        args::Filter::Evsm4 => umbrage_wgpu::Filter::Evsm4,
        args::Filter::Msm => umbrage_wgpu::Filter::Msm,
    }
}

/// The renderer's depth format.
#[must_use]
pub fn wgpu_depth_format(format: args::DepthFormat) -> umbrage_wgpu::DepthFormat {
    match format {
        args::DepthFormat::D32f => umbrage_wgpu::DepthFormat::D32Float,
        args::DepthFormat::D16 => umbrage_wgpu::DepthFormat::D16Unorm,
        args::DepthFormat::R32f => umbrage_wgpu::DepthFormat::R32Float,
    }
}

/// The name of an option's value as it is typed.
#[must_use]
pub fn typed_name(value: impl ValueEnum) -> String {
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
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
    if wgpu_filter(args.filter).is_prefiltered() {
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

fn scheme(args: &ShadowArgs, splits: usize) -> Result<SplitScheme> {
    let scheme = args.scheme.unwrap_or(if args.planes.is_some() { Scheme::Manual } else { Scheme::Practical });
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
