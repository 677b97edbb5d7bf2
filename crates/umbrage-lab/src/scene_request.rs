//! Requests of a scene, a camera and a light: plain data, checked before a file is read.
//!
//! [`crate::scene_setup`] opens it.

use std::path::{Path, PathBuf};

use glam::DVec3;
use umbrage::SteppedSun;
use umbrage_scene::OpenOptions;

use crate::failure::{Failure, Result};

/// Default of `--fov`, in degrees.
pub const DEFAULT_FOV: f64 = 60.0;
/// Default of `--near`, in metres.
pub const DEFAULT_NEAR: f64 = 1.0;
/// Default of `--far`, in metres.
pub const DEFAULT_FAR: f64 = 800.0;
/// Default of `--sun-fade`, in frames.
pub const DEFAULT_SUN_FADE: u32 = 8;

/// Request of a scene, a camera and a light.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneRequest {
    /// Name of a world, or a file.
    pub scene: String,
    /// Options of reading the file.
    pub files: OpenOptions,
    /// Translation of the scene in metres.
    pub move_scene: Option<DVec3>,
    /// Time of the animations in seconds.
    pub time_s: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Choice of the camera.
    pub camera: CameraChoice,
    /// Vertical field of view in degrees; `None` uses the camera's own, or [`DEFAULT_FOV`].
    pub fov: Option<f64>,
    /// Near distance in metres; `None` uses the camera's own.
    pub near: Option<f64>,
    /// Far distance in metres; `None` uses the camera's own.
    pub far: Option<f64>,
    /// Choice of the light.
    pub light: LightChoice,
    /// Motion of the sun over the frames.
    pub sun_travel: Option<SunTravel>,
    /// Angular diameter of the sun in degrees; `None` if it was not given.
    pub sun_angle: Option<f64>,
    /// Number of the only frame that is shown, of several. Frames before it are drawn, for state
    /// that maps keep from frame to frame, but are not shown.
    pub only_frame: Option<u32>,
    /// The request as options of `umbrage render`, for reports; empty if the request was not typed.
    pub options: Vec<String>,
}

/// Choice of the camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// No choice: the scene's first camera, or an invented one.
    Default,
    /// A camera by name: `--camera`.
    Named(String),
    /// An eye and a target: `--eye` and `--target`.
    LookAt {
        /// Position of the eye, in metres.
        eye: DVec3,
        /// Position of the target, different from the eye.
        target: DVec3,
    },
    /// A camera path: `--path`.
    Path {
        /// File of the path.
        file: PathBuf,
        /// Number of frames: `--frames`. Without it the path's first point is one frame without a
        /// number.
        frames: Option<u32>,
        /// Height of the eye over the path in metres.
        eye_height: f64,
    },
}

/// Choice of the light.
#[derive(Clone, Debug, PartialEq)]
pub enum LightChoice {
    /// No choice: the path's sun, else the scene's first directional light, else an invented one.
    Default,
    /// A light by name: `--light`.
    Named(String),
    /// A sun by the direction in which its light travels: `--sun`.
    Given(DVec3),
}

/// Motion of the sun over the frames.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTravel {
    /// Direction in which light travels in the last frame.
    pub to: DVec3,
    /// Number of frames.
    pub frames: u32,
    /// Steps in which shadows follow the sun; without it they follow in every frame.
    pub steps: Option<SteppedSun>,
}

impl SceneRequest {
    /// Makes a request of a scene at its first moment, with its own camera and light.
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

    /// Chooses the camera. A camera of the scene keeps its own near and far where the request has
    /// none; any other gets [`DEFAULT_NEAR`] and [`DEFAULT_FAR`].
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

    /// Returns width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Returns the files that the request reads by name, so that no output replaces one.
    #[must_use]
    pub fn inputs(&self) -> Vec<&Path> {
        let scene = Path::new(&self.scene);
        match &self.camera {
            CameraChoice::Path { file, .. } => vec![scene, file],
            _ => vec![scene],
        }
    }
}
