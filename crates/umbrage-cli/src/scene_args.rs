//! The options of scene, picture size, camera, light and time, and the request that they make.

use std::path::PathBuf;

use clap::builder::TypedValueParser;
use glam::DVec3;
use umbrage::SteppedSun;
use umbrage::config::Word;
use umbrage_lab::{
    failure::{Failure, Result},
    parse,
    scene_request::{CameraChoice, DEFAULT_SUN_FADE, LightChoice, SceneRequest, SunTravel},
};
use umbrage_scene::procedural::World;
use umbrage_scene::{EXTENSIONS, GltfOptions, HeightEncoding, HeightMapOptions, OpenOptions};

use crate::{switch::Switch, words, world_args::WorldArgs};

/// Scene, picture size, camera, light and time.
#[derive(Clone, Debug, clap::Args)]
pub struct SceneArgs {
    /// A file or a world.
    #[arg(value_name = "SCENE", help = scene_help())]
    pub scene: Option<String>,
    /// Height map: metres between posts
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_post: Option<f64>,
    /// Height map: metres per unit of a pixel's value
    #[arg(long, value_name = "M", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Scene")]
    pub metres_per_unit: Option<f64>,
    /// Height map: metres added to every height
    #[arg(long, value_name = "M", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub height_offset: Option<f64>,
    /// Height map: how a picture encodes heights, if its values do not show it
    #[arg(long, value_name = "WORD", value_parser = height_encoding(), default_value = "auto", help_heading = "Scene")]
    pub height_encoding: NamedEncoding,
    /// glTF: memory limit for textures in MiB; beyond it they are scaled down, with a note
    #[arg(long, value_name = "MIB", default_value = "512", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Scene")]
    pub texture_memory: u32,
    /// glTF: allow its files to lie outside its folder, such as ../textures/bark.png
    #[arg(long, help_heading = "Scene")]
    pub parent_folders: bool,
    /// Numbers of objects.
    #[command(flatten)]
    pub world: WorldArgs,
    /// Move the scene, its cameras and lights by this many metres, to test shadows far from the
    /// world's origin; --eye, --target and --path are not moved
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::vector, allow_hyphen_values = true, help_heading = "Scene")]
    pub move_scene: Option<DVec3>,
    /// Seconds into the scene's animations
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse::number, allow_hyphen_values = true, help_heading = "Scene")]
    pub time: f64,

    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse::size, allow_hyphen_values = true, help_heading = "Camera")]
    pub size: [u32; 2],
    /// One of the scene's cameras, or several separated by commas, which render and truth show side
    /// by side, each of --size
    #[arg(long, value_name = "NAME|INDEX,…", help_heading = "Camera")]
    pub camera: Option<String>,
    /// Position of the eye in metres
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

    /// Lights of the scene, directional, spot or point: one, several separated by commas, or all
    /// (at most 8). Pictures show all of them with their shadows; masks, probes, exact masks and
    /// plans use the first [default: the first directional one]
    #[arg(long, value_name = "NAME|INDEX,…", help_heading = "Light")]
    pub light: Option<String>,
    /// Direction in which sunlight travels; any length
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true, help_heading = "Light")]
    pub sun: Option<DVec3>,
    /// Direction in which sunlight travels in the last of --frames; the sun moves there evenly
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_to: Option<DVec3>,
    /// With --sun-to: shadows follow in steps of this many degrees and stand still in between
    /// [default: they move every frame]
    #[arg(long, value_name = "DEGREES", value_parser = parse::positive, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_step: Option<f64>,
    /// With --sun-step: frames over which a step is faded; 0: no fade [default: 8]
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true, help_heading = "Light")]
    pub sun_fade: Option<u32>,
    /// Angular diameter of the sun in degrees, for --filter pcss and the exact soft mask of
    /// `umbrage truth` [default: 0.53 for pcss; the exact mask is hard]
    #[arg(long, value_name = "DEGREES", value_parser = parse::sun_angle, allow_hyphen_values = true, help_heading = "Light")]
    pub sun_angle: Option<f64>,

    /// Colour the picture by split
    #[arg(long, value_name = "true|false", num_args = 0..=1, require_equals = true, default_value = "false", default_missing_value = "true", action = clap::ArgAction::Set, help_heading = "Picture")]
    pub tint: bool,
    /// Draw with shadows or without
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t, help_heading = "Picture")]
    pub shadows: Switch,

    /// Number of the only frame that is shown, of several.
    #[arg(skip)]
    pub only_frame: Option<u32>,
    /// Words of a command line with all these options.
    #[arg(skip)]
    pub options: Vec<String>,
}

/// Returns the help text of SCENE.
fn scene_help() -> String {
    let worlds: Vec<&str> = World::ALL.iter().map(|world| world.name()).collect();
    format!(
        "A {EXTENSIONS}, or a world: {}. A height map without a scale of its own needs a .json beside it or the --metres \
         options. May be omitted if --config names a report, whose scene is then used",
        worlds.join(", ")
    )
}

/// An encoding that was named; `None` for the one that fits the picture's values.
type NamedEncoding = Option<HeightEncoding>;

/// `--height-encoding`: the words of the encodings, and `auto`.
fn height_encoding() -> impl TypedValueParser<Value = NamedEncoding> {
    const AUTO: Word = Word { word: "auto", help: "Whichever fits its values" };
    words::offered([&AUTO].into_iter().chain(HeightEncoding::WORDS))
        .try_map(|word| if word == AUTO.word { Ok(None) } else { word.parse::<HeightEncoding>().map(Some) })
}

impl SceneArgs {
    /// Makes the request of the options.
    ///
    /// # Errors
    /// [`Failure::Input`] with the options that exclude each other.
    pub fn request(&self) -> Result<SceneRequest> {
        let camera = camera_choice(self)?;
        let request = SceneRequest {
            files: OpenOptions {
                height_map: HeightMapOptions {
                    metres_per_post: self.metres_per_post,
                    metres_per_unit: self.metres_per_unit,
                    height_offset: self.height_offset,
                    encoding: self.height_encoding,
                },
                gltf: GltfOptions {
                    texture_bytes: u64::from(self.texture_memory) << 20,
                    parent_folders: self.parent_folders,
                },
                world: self.world.into(),
            },
            move_scene: self.move_scene,
            time_s: self.time,
            fov: self.fov,
            near: self.near,
            far: self.far,
            light: light_choice(self.light.as_deref(), self.sun)?,
            sun_angle: self.sun_angle,
            only_frame: self.only_frame,
            options: self.options.clone(),
            ..SceneRequest::new(self.scene.clone().unwrap_or_default(), self.size)
        };
        Ok(SceneRequest { sun_travel: sun_travel(self)?, ..request.with_camera(camera)? })
    }
}

/// Makes the choice of the light from `--light` and `--sun`.
///
/// # Errors
/// [`Failure::Input`] if both are given.
pub fn light_choice(light: Option<&str>, sun: Option<DVec3>) -> Result<LightChoice> {
    match (light, sun) {
        (Some(_), Some(_)) => Err(Failure::input("--light and --sun both choose the light; give one of them")),
        (Some(name), None) => Ok(LightChoice::Named(name.to_owned())),
        (None, Some(direction)) => Ok(LightChoice::Given(direction)),
        (None, None) => Ok(LightChoice::Default),
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
