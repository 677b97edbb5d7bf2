//! What is looked at, from where, under which light: plain data, checked before a file is read.
//!
//! [`crate::scene_setup`] opens it.

use std::path::{Path, PathBuf};

use glam::DVec3;
use umbrage::SteppedSun;
use umbrage_scene::OpenOptions;

use crate::failure::{Failure, Result};

/// `--fov` where nothing else says one, degrees.
pub const DEFAULT_FOV: f64 = 60.0;
/// `--near` where nothing else says one, metres.
pub const DEFAULT_NEAR: f64 = 1.0;
/// `--far` where nothing else says one, metres.
pub const DEFAULT_FAR: f64 = 800.0;
/// `--sun-fade` where nothing else says one, frames.
pub const DEFAULT_SUN_FADE: u32 = 8;

/// What is looked at, from where, under which light.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneRequest {
    /// A world's name or a file.
    pub scene: String,
    /// How its file is read.
    pub files: OpenOptions,
    /// The scene is moved by so many metres.
    pub move_scene: Option<DVec3>,
    /// Seconds into the animations.
    pub time_s: f64,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// The eye.
    pub camera: CameraChoice,
    /// Vertical field of view, degrees; none: the camera's own, or [`DEFAULT_FOV`].
    pub fov: Option<f64>,
    /// Near plane, metres; none: the camera's own.
    pub near: Option<f64>,
    /// Far plane, metres; none: the camera's own.
    pub far: Option<f64>,
    /// The light.
    pub light: LightChoice,
    /// A sun that moves over the frames.
    pub sun_travel: Option<SunTravel>,
    /// Degrees across the sun; none where nothing was said.
    pub sun_angle: Option<f64>,
    /// Of several frames this one alone is wanted; those before it are drawn, for what maps keep
    /// from frame to frame, and not shown.
    pub only_frame: Option<u32>,
    /// All this as options of `umbrage render`, for reports; empty where nobody typed any.
    pub options: Vec<String>,
}

/// How the eye was chosen.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
pub enum LightChoice {
    /// Not at all: the path's, else the scene's first directional light, else an invented one.
    Default,
    /// `--light`.
    Named(String),
    /// `--sun`: the way light travels.
    Given(DVec3),
}

/// How the sun moves over the frames.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTravel {
    /// The way light travels in the last frame.
    pub to: DVec3,
    /// How many frames there are.
    pub frames: u32,
    /// Shadows follow in steps; every frame without.
    pub steps: Option<SteppedSun>,
}

impl SceneRequest {
    /// A scene at its first moment, by its own camera and light.
    pub fn new(scene: impl Into<String>, size: [u32; 2]) -> Self {
        Self {
            scene: scene.into(),
            files: OpenOptions::default(),
            move_scene: None,
            time_s: 0.0,
            size,
            camera: CameraChoice::Default,
            fov: None,
            near: None,
            far: None,
            light: LightChoice::Default,
            sun_travel: None,
            sun_angle: None,
            only_frame: None,
            options: Vec::new(),
        }
    }

    /// Chooses the camera. One of the scene keeps its own near and far where the request has none;
    /// any other gets [`DEFAULT_NEAR`] and [`DEFAULT_FAR`].
    ///
    /// # Errors
    /// [`Failure::Input`] if near is not less than far.
    pub fn with_camera(self, camera: CameraChoice) -> Result<Self> {
        let own_lens = matches!(camera, CameraChoice::Default | CameraChoice::Named(_));
        let near = self.near.or((!own_lens).then_some(DEFAULT_NEAR));
        let far = self.far.or((!own_lens).then_some(DEFAULT_FAR));
        if let (Some(near), Some(far)) = (near, far)
            && near >= far
        {
            return Err(Failure::input(format!(
                "--near {near} is not less than --far {far}; give a nearer near or a farther far"
            )));
        }
        Ok(Self { camera, near, far, ..self })
    }

    /// Width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// The files that the request reads by name, so that no output replaces one.
    #[must_use]
    pub fn inputs(&self) -> Vec<&Path> {
        let scene = Path::new(&self.scene);
        match &self.camera {
            CameraChoice::Path { file, .. } => vec![scene, file],
            _ => vec![scene],
        }
    }
}
