//! The options of views: cameras, scenes, suns, and the motion of cameras from frame to frame. All
//! subcommands that judge views share them.

use std::path::PathBuf;

use glam::DVec3;
use umbrage_lab::{
    compare::shots::{ShotRequest, Stride, SunSpec, sun_spec},
    failure::{Failure, Result},
    parse,
    scene_request::{CameraChoice, SceneRequest},
};
use umbrage_scene::{HeightMapOptions, OpenOptions};

use crate::{scene_args::light_choice, world_args::WorldArgs};

/// Views, as typed.
#[derive(Clone, Debug, clap::Args)]
pub struct ShotArgs {
    /// Height maps: metres between posts
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_post: Option<f64>,
    /// Height maps: metres per unit of a pixel's value
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_unit: Option<f64>,
    /// Height maps: metres added to every height
    #[arg(long, value_name = "M", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub height_offset: Option<f64>,
    /// Numbers of objects.
    #[command(flatten)]
    pub world: WorldArgs,
    /// Move scenes, their cameras and lights by this many metres, to test shadows far from the
    /// world's origin; --eye, --target and --path are not moved
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Scene")]
    pub move_scene: Option<DVec3>,
    /// Seconds into the scenes' animations
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub time: f64,
    /// View depths in metres that are shadowed and scored, for all techniques [default: the
    /// camera's near and far]
    #[arg(long, value_name = "N..F", value_parser = parse::range, allow_hyphen_values = true, help_heading = "Shots")]
    pub shadow_range: Option<(f64, f64)>,
    /// Size of the pictures in pixels [default: 800x600, or a preset's; tune: 320x240]
    #[arg(long, value_name = "WxH", value_parser = parse::size, allow_hyphen_values = true, help_heading = "Shots")]
    pub size: Option<[u32; 2]>,
    /// Cameras of the scenes, by name or number [default: all that have names, or an invented one]
    #[arg(long, value_name = "NAME|INDEX,…", value_delimiter = ',', help_heading = "Shots")]
    pub camera: Vec<String>,
    /// Position of a further camera in metres
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Shots")]
    pub eye: Option<DVec3>,
    /// The point it looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Shots")]
    pub target: Option<DVec3>,
    /// Vertical field of view in degrees [default: 60, or the camera's]
    #[arg(long, value_name = "DEGREES", value_parser = parse::field_of_view, allow_hyphen_values = true, help_heading = "Shots")]
    pub fov: Option<f64>,
    /// Near plane in metres [default: 1, or the camera's]
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Shots")]
    pub near: Option<f64>,
    /// Far plane in metres, or inf [default: 800, or the camera's]
    #[arg(long, value_name = "M", value_parser = parse::positive_or_infinite, allow_hyphen_values = true, help_heading = "Shots")]
    pub far: Option<f64>,
    /// Move a camera along an author's path (JSON); one scene only
    #[arg(long, value_name = "FILE", help_heading = "Shots")]
    pub path: Option<PathBuf>,
    /// Frames of the path, or of --step; 2 or more give flicker
    #[arg(long, value_name = "N", allow_hyphen_values = true, help_heading = "Shots")]
    pub frames: Option<u32>,
    /// With --path: metres from the path up to the eye
    #[arg(long, value_name = "M", default_value = "2", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Shots")]
    pub eye_height: f64,
    /// Move every other camera forward by this many metres per frame, for --frames
    #[arg(long, value_name = "M", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Shots")]
    pub step: Option<f64>,
    /// Turn every other camera to the left by this many degrees per frame, about the world's
    /// vertical, for --frames
    #[arg(long, value_name = "DEGREES", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Shots")]
    pub turn: Option<f64>,
    /// Zoom every other camera in by this factor per frame, for --frames
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Shots")]
    pub zoom: Option<f64>,
    /// One of the scenes' lights: a directional one as their own sun, or a spot or point light in
    /// its place [default: the first directional one]
    #[arg(long, value_name = "NAME|INDEX", help_heading = "Shots")]
    pub light: Option<String>,
    /// The own sun: direction in which light travels; any length
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true, help_heading = "Shots")]
    pub sun: Option<DVec3>,
    /// Angular diameter of the sun in degrees, for pcss; compare then also scores soft masks
    /// [default: 0.53 for pcss, no soft scores]
    #[arg(long, value_name = "DEGREES", value_parser = parse::sun_angle, allow_hyphen_values = true, help_heading = "Shots")]
    pub sun_angle: Option<f64>,
    /// Suns under which every camera is drawn, see below [default: own]
    #[arg(long, value_name = "SUN,…", value_delimiter = ',', value_parser = sun_spec, allow_hyphen_values = true, help_heading = "Shots")]
    pub suns: Vec<SunSpec>,
    /// A view counts in means and comparisons if the true shadow has this many edge pixels
    #[arg(long, value_name = "PIXELS", default_value_t = umbrage_truth::scores::LEAST_EDGES, help_heading = "Shots")]
    pub least_edges: usize,
}

/// Defaults of options that were not typed.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShotDefaults {
    /// Near distance in metres.
    pub near: Option<f64>,
    /// Far distance in metres.
    pub far: Option<f64>,
    /// Names of cameras.
    pub cameras: &'static [&'static str],
    /// Suns that every camera is seen under.
    pub suns: Option<&'static [&'static str]>,
    /// Motion of cameras from frame to frame.
    pub stride: Option<Stride>,
}

impl ShotArgs {
    /// Makes the request for the views of each of so many scenes, in pictures of this size: the
    /// typed options, then the defaults.
    ///
    /// # Errors
    /// [`Failure::Input`] with the option at fault.
    pub fn request(&self, scenes: usize, size: [u32; 2], defaults: &ShotDefaults) -> Result<ShotRequest> {
        if self.path.is_some() && scenes > 1 {
            return Err(Failure::input("--path goes through one scene; give one scene"));
        }
        if self.frames == Some(0) {
            return Err(Failure::input("--frames 0 asks for no frame; give 1 or more"));
        }
        let stride = self.stride(defaults.stride)?;
        let suns = match defaults.suns {
            _ if !self.suns.is_empty() => Some(self.suns.clone()),
            Some(suns) if self.sun.is_none() && self.light.is_none() => {
                Some(suns.iter().map(|text| sun_spec(text).map_err(Failure::other)).collect::<Result<_>>()?)
            }
            _ => None,
        };
        let base = SceneRequest {
            files: OpenOptions {
                height_map: HeightMapOptions {
                    metres_per_post: self.metres_per_post,
                    metres_per_unit: self.metres_per_unit,
                    height_offset: self.height_offset,
                    ..HeightMapOptions::default()
                },
                world: self.world.into(),
                ..OpenOptions::default()
            },
            move_scene: self.move_scene,
            time_s: self.time,
            fov: self.fov,
            near: self.near.or(defaults.near),
            far: self.far.or(defaults.far),
            light: light_choice(self.light.as_deref(), self.sun)?,
            sun_angle: self.sun_angle,
            ..SceneRequest::new("", size)
        };
        Ok(ShotRequest { base, cameras: self.cameras(defaults.cameras)?, suns, stride })
    }

    /// Returns cameras by name, by eye and target, and along a path; empty for all that a scene
    /// has.
    fn cameras(&self, usual: &[&str]) -> Result<Vec<CameraChoice>> {
        let typed = !self.camera.is_empty() || self.eye.is_some() || self.path.is_some();
        let mut cameras: Vec<CameraChoice> = if typed {
            self.camera.iter().cloned().map(CameraChoice::Named).collect()
        } else {
            usual.iter().map(|&name| CameraChoice::Named(name.to_owned())).collect()
        };
        match (self.eye, self.target) {
            (Some(eye), Some(target)) => cameras.push(CameraChoice::LookAt { eye, target }),
            (None, None) => {}
            (Some(_), None) => return Err(Failure::input("--eye without --target: give the point to look at")),
            (None, Some(_)) => return Err(Failure::input("--target without --eye: give the point to look from")),
        }
        if let Some(file) = &self.path {
            let frames = Some(self.frames.unwrap_or(1));
            cameras.push(CameraChoice::Path { file: file.clone(), frames, eye_height: self.eye_height });
        }
        Ok(cameras)
    }

    /// Makes the motion of `--step`, `--turn`, `--zoom` and `--frames`, with the usual values for
    /// missing ones.
    fn stride(&self, usual: Option<Stride>) -> Result<Option<Stride>> {
        let typed = [("--step", self.step), ("--turn", self.turn), ("--zoom", self.zoom)];
        if let Some((option, _)) = typed.iter().find(|(_, value)| value.is_some()) {
            let frames = self.frames.or(usual.map(|usual| usual.frames)).unwrap_or(2);
            if frames < 2 {
                return Err(Failure::input(format!("{option} with --frames 1 goes nowhere; give --frames 2 or more")));
            }
            let still = Stride { metres: 0.0, turn: 0.0, zoom: 1.0, frames };
            return Ok(Some(Stride {
                metres: self.step.unwrap_or(still.metres),
                turn: self.turn.unwrap_or(still.turn),
                zoom: self.zoom.unwrap_or(still.zoom),
                frames,
            }));
        }
        match (self.frames, usual) {
            (Some(frames), Some(usual)) if self.path.is_none() => {
                Ok((frames > 1).then_some(Stride { frames, ..usual }))
            }
            (Some(_), None) if self.path.is_none() => Err(Failure::input(
                "--frames needs a way to go: give --path FILE, --step M, --turn DEGREES or --zoom FACTOR",
            )),
            _ => Ok(usual),
        }
    }
}
