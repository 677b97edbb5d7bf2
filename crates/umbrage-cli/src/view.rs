//! `umbrage view`: the scene in a window.

use std::path::PathBuf;

use umbrage::config::Preset;
use umbrage_lab::{
    failure::{Failure, Result},
    output, parse,
};
use umbrage_viewer::{Error, Options, ShowAtStart};

use crate::{scene_args::SceneArgs, scene_options::SceneOptions, shadow_args::ShadowArgs};

/// Scene that is shown if none is given.
pub const FIRST_SCENE: &str = "robot-war";

/// `umbrage view`.
#[derive(Debug, clap::Args)]
pub struct ViewArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Show at once: tint, frusta, held (maps held for the first view, seen from behind it),
    /// density, errors, tests, maps, planes, times, casters
    #[arg(long, value_name = "WHAT,…", value_delimiter = ',', help_heading = "Window")]
    pub show: Vec<ShowAtStart>,
    /// Compare with a preset: a wipe between two pictures
    #[arg(long, value_name = "NAME", help_heading = "Window")]
    pub compare: Option<Preset>,
    /// Size of text and controls; 2 is twice as large
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = scale, help_heading = "Window")]
    pub scale: f32,
    /// The picture alone, without panels (H brings them back)
    #[arg(long, help_heading = "Window")]
    pub bare: bool,
    /// Let the time run at once, for scenes that move
    #[arg(long, help_heading = "Window")]
    pub run: bool,
    /// Write a picture of the window here (PNG) once everything is shown, and end
    #[arg(long, value_name = "PICTURE", help_heading = "Output")]
    pub screenshot: Option<PathBuf>,
}

/// Reads a factor that keeps text readable.
fn scale(text: &str) -> std::result::Result<f32, String> {
    let factor = parse::positive(text)?;
    if (0.5..=5.0).contains(&factor) { Ok(factor as f32) } else { Err(format!("{factor}; give 0.5 to 5")) }
}

/// Runs the subcommand.
pub fn run(args: &ViewArgs) -> Result<()> {
    let file = args.shadows.file();
    let scene = match file {
        Some(_) => args.scene.over(file)?,
        None => args.scene.or_scene(FIRST_SCENE).over(None)?,
    };
    if scene.sun_to.is_some() {
        return Err(Failure::input(
            "--sun-to moves the sun over the frames of `umbrage render`; in the window, drag the sun",
        ));
    }
    if scene.frames.is_some() && args.screenshot.is_none() {
        return Err(Failure::input("--frames counts the pictures before a screenshot; give --screenshot PICTURE"));
    }
    let frames = scene.frames.unwrap_or(1);
    if frames == 0 {
        return Err(Failure::input("--frames 0 asks for no picture; give 1 or more"));
    }
    let shadows = args.shadows.request(&scene)?;
    let request = SceneArgs { frames: None, ..scene }.request()?;
    if let Some(path) = &args.screenshot {
        output::check(&[path.as_path()], &[], &request.inputs())?;
    }
    let mut options = Options {
        config: shadows.config,
        notes: shadows.notes,
        show: umbrage_viewer::session::Show {
            tint: shadows.options.tint,
            shadows: !shadows.options.shadows_off,
            ..Default::default()
        },
        held: false,
        other: args.compare.map(Preset::config),
        bare: args.bare,
        runs: args.run,
        scale: args.scale,
        screenshot: args.screenshot.clone(),
        frames: u64::from(frames),
        request,
    };
    args.show.iter().for_each(|show| show.apply(&mut options));
    umbrage_viewer::run(options).map_err(|error| match error {
        Error::NotShown(_) | Error::Screenshot { .. } => Failure::input(error.to_string()),
        other => Failure::other(other.to_string()),
    })
}
