//! What was typed after `umbrage bench`.

use std::path::PathBuf;

use glam::DVec3;

use crate::{
    args::{HeightEncoding, SceneArgs, Switch, TEXTURE_MIB},
    parse,
};

/// `umbrage bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// Scenes as for `umbrage render` [default: the four worlds]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Techniques, as for `umbrage compare`; the first is what the others are divided by
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "ssm:1024,pssm:2:512,pssm:3:512,pssm:3:512:scheme=fitted,pssm:4:512"
    )]
    pub techniques: Vec<String>,
    /// All filters over four maps of 1024² instead of techniques, divided by pcf2; over robot-war if no scene is named
    #[arg(long, conflicts_with_all = ["techniques", "with"])]
    pub filters: bool,
    /// Settings for all techniques that do not say otherwise, as for `umbrage compare`; the papers' splits meet in hard borders
    #[arg(long, value_name = "SETTINGS", default_value = "filter=pcf2:stabilize=none:blend=0")]
    pub with: String,
    /// Rounds that are measured, after one that is not
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rounds: u32,
    /// Pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse::size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// Samples per pixel of the picture: 1 or 4
    #[arg(long, value_name = "N", default_value = "1", value_parser = ["1", "4"])]
    pub samples: String,
    /// Camera by name or number [default: middle, or the scene's first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub camera: Option<String>,
    /// The way light travels [default: the scene's own sun]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true)]
    pub sun: Option<DVec3>,
    /// Seconds into the scenes' animations
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse::number, allow_hyphen_values = true)]
    pub time: f64,
    /// Numbers of objects for GPU Gems' Figure 10-9, four splits each
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "10,30,100,300,1000", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub objects: Vec<u32>,
    /// Measure every pair of generation and storage on each scene, too, with PSSM(4; 512²)
    #[arg(long, value_enum, default_value_t)]
    pub paths: Switch,
    /// Write all figures here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// Write one page with tables and plots here (HTML)
    #[arg(short = 'o', long = "output", value_name = "HTML", help_heading = "Output")]
    pub html: Option<PathBuf>,
}

impl BenchArgs {
    /// What the options say about one scene. `camera` is what is chosen if nothing was.
    #[must_use]
    pub fn scene_args(&self, scene: &str, camera: Option<&str>) -> SceneArgs {
        SceneArgs {
            scene: scene.to_owned(),
            metres_per_post: None,
            metres_per_unit: None,
            height_offset: None,
            height_encoding: HeightEncoding::default(),
            texture_memory: TEXTURE_MIB,
            parent_folders: false,
            move_scene: None,
            time: self.time,
            size: self.size,
            camera: self.camera.clone().or(camera.map(str::to_owned)),
            eye: None,
            target: None,
            fov: None,
            near: None,
            far: None,
            path: None,
            frames: None,
            eye_height: 2.0,
            light: None,
            sun: self.sun,
            sun_to: None,
            sun_step: None,
            sun_fade: None,
            sun_angle: None,
        }
    }
}
