//! What the scene's options mean: everything that can be checked before a file is read. The scene comes in [`crate::stage`].

use std::path::{Path, PathBuf};

use glam::DVec3;
use umbrage::SteppedSun;
use umbrage_scene::{GltfOptions, HeightEncoding, HeightMapOptions, OpenOptions};

use crate::args::{self, SceneArgs};
use crate::failure::{Failure, Result};

/// `--fov` where nothing else says one, degrees.
pub const DEFAULT_FOV: f64 = 60.0;
/// `--near` where nothing else says one, metres.
pub const DEFAULT_NEAR: f64 = 1.0;
/// `--far` where nothing else says one, metres.
pub const DEFAULT_FAR: f64 = 800.0;
/// `--sun-fade` where nothing else says one, frames.
pub const DEFAULT_SUN_FADE: u32 = 8;

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
    /// `--height-encoding`.
    pub height_encoding: Option<HeightEncoding>,
    /// `--texture-memory`, bytes.
    pub texture_bytes: u64,
    /// `--parent-folders`.
    pub parent_folders: bool,
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
            height_encoding: match args.height_encoding {
                args::HeightEncoding::Auto => None,
                args::HeightEncoding::Grey => Some(HeightEncoding::Grey),
                args::HeightEncoding::Terrarium => Some(HeightEncoding::Terrarium),
                args::HeightEncoding::Mapbox => Some(HeightEncoding::Mapbox),
            },
            texture_bytes: u64::from(args.texture_memory) << 20,
            parent_folders: args.parent_folders,
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

    /// How the scene's file is read.
    #[must_use]
    pub fn open_options(&self) -> OpenOptions {
        OpenOptions {
            height_map: HeightMapOptions {
                metres_per_post: self.metres_per_post,
                metres_per_unit: self.metres_per_unit,
                height_offset: self.height_offset,
                encoding: self.height_encoding,
            },
            gltf: GltfOptions { texture_bytes: self.texture_bytes, parent_folders: self.parent_folders },
        }
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
