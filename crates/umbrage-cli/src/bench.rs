//! `umbrage bench`: measures the cost of shadows.

use std::path::PathBuf;

use glam::DVec3;
use umbrage_lab::{
    bench::{
        self, Job,
        scale::{self, ScaleJob},
    },
    failure::{Failure, Result},
    parse,
    scene_request::{CameraChoice, LightChoice, SceneRequest},
    technique::text,
};
use umbrage_render::Samples;
use umbrage_scene::OpenOptions;
use umbrage_scene::procedural::{World, WorldOptions};

use crate::{switch::Switch, world_args::WorldArgs};

/// Default camera of a world: it shows near, middle and far shadows in one picture.
const CAMERA: &str = "middle";

/// `umbrage bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// Scenes as for `umbrage render` [default: the four worlds]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Techniques, as for `umbrage compare`; ratios are to the first
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "ssm:1024,pssm:2:512,pssm:3:512,pssm:3:512:scheme=optimal,pssm:4:512"
    )]
    pub techniques: Vec<String>,
    /// All filters over four maps of 1024² instead of techniques, with ratios to pcf2; in robot-war
    /// if no scene is named
    #[arg(long, conflicts_with_all = ["techniques", "with"])]
    pub filters: bool,
    /// Settings for all techniques that do not set them, as for `umbrage compare`; the papers'
    /// splits have hard borders
    #[arg(long, value_name = "SETTINGS", default_value = "preset=papers:filter=pcf2:stabilize=none:blend=0")]
    pub with: String,
    /// Measured rounds, after one for warming up
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rounds: u32,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse::size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// Samples per pixel of the picture: 1 or 4
    #[arg(long, value_name = "N", default_value = "1", value_parser = ["1", "4"])]
    pub samples: String,
    /// Camera by name or number [default: middle, or the scene's first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub camera: Option<String>,
    /// Direction in which light travels [default: the scene's own sun]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::direction, allow_hyphen_values = true)]
    pub sun: Option<DVec3>,
    /// Seconds into the scenes' animations
    #[arg(long, value_name = "SECONDS", default_value = "0", value_parser = parse::number, allow_hyphen_values = true)]
    pub time: f64,
    /// Numbers of objects for GPU Gems' Figure 10-9, four splits each, or of trees for --scale
    /// [default: 10,30,100,300,1000; with --scale 100,1000,10000,100000,1000000]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=i64::from(WorldOptions::MOST_TREES)))]
    pub objects: Vec<u32>,
    /// A forest of ever more trees instead of scenes: cost over the number of objects, with nothing
    /// kept of maps, and kept while the camera stands, walks, and one tree in a hundred moves
    #[arg(long, conflicts_with_all = ["scenes", "techniques", "filters", "with", "paths", "camera", "sun", "time"])]
    pub scale: bool,
    /// With --scale: leave out larger numbers of objects
    #[arg(long, value_name = "N", requires = "scale")]
    pub scale_limit: Option<u32>,
    /// Numbers of objects of the scenes.
    #[command(flatten)]
    pub world: WorldArgs,
    /// Measure every pair of generation and storage on each scene too, with PSSM(4; 512²)
    #[arg(long, value_enum, default_value_t)]
    pub paths: Switch,
    /// Write all figures here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// Write one page with tables and plots here (HTML)
    #[arg(short = 'o', long = "output", value_name = "HTML", help_heading = "Output")]
    pub html: Option<PathBuf>,
}

/// Largest number of objects of GPU Gems' Figure 10-9, which are nodes of a list.
const MOST_OBJECTS: u32 = 100_000;

/// Technique whose maps can be kept, because they stand exactly still.
const SCALED: &str = "pssm:4:1024:preset=papers:scheme=log:label=PSSM(4; 1024²), exactly still";

/// Runs the subcommand.
pub fn run(args: &BenchArgs) -> Result<()> {
    if args.scale {
        return scale::run(&scale_job(args)?);
    }
    if let Some(objects) = args.objects.iter().find(|&&objects| objects > MOST_OBJECTS) {
        return Err(Failure::input(format!(
            "--objects {objects}: without --scale {MOST_OBJECTS} are the most; give fewer, or --scale"
        )));
    }
    let objects = if args.objects.is_empty() { vec![10, 30, 100, 300, 1000] } else { args.objects.clone() };
    let (texts, with) =
        if args.filters { (bench::filter_techniques(), "") } else { (args.techniques.clone(), &*args.with) };
    let techniques = text::parse_all(&texts, with)?;
    let scenes: Vec<String> = match &args.scenes[..] {
        [] if args.filters => vec![World::RobotWar.name().to_owned()],
        [] => World::PAPER.iter().map(|world| world.name().to_owned()).collect(),
        given => given.to_vec(),
    };
    bench::run(&Job {
        scenes: scenes.iter().map(|scene| scene_request(args, scene)).collect::<Result<_>>()?,
        techniques,
        with: with.to_owned(),
        rounds: args.rounds,
        size: args.size,
        samples: if args.samples == "4" { Samples::Four } else { Samples::One },
        objects: if args.filters { Vec::new() } else { objects },
        paths: args.paths == Switch::On,
        paths_with: args.with.clone(),
        json: args.json.clone(),
        html: args.html.clone(),
    })
}

/// Makes the job of `--scale`.
fn scale_job(args: &BenchArgs) -> Result<ScaleJob> {
    let mut objects =
        if args.objects.is_empty() { vec![100, 1000, 10_000, 100_000, 1_000_000] } else { args.objects.clone() };
    objects.retain(|&objects| args.scale_limit.is_none_or(|limit| objects <= limit));
    let techniques = text::parse_all(&[SCALED.to_owned()], "")?;
    let technique = techniques.into_iter().next().ok_or_else(|| Failure::other("no technique to measure"))?;
    let (json, html) = (args.json.clone(), args.html.clone());
    Ok(ScaleJob { objects, technique, rounds: args.rounds, size: args.size, json, html })
}

/// Makes the request of a scene, with the camera that was named, the one in the middle of a world,
/// or the scene's first.
fn scene_request(args: &BenchArgs, scene: &str) -> Result<SceneRequest> {
    let of_world = World::from_name(scene).map(|_| CAMERA.to_owned());
    let camera = args.camera.clone().or(of_world);
    let request = SceneRequest {
        files: OpenOptions { world: args.world.into(), ..OpenOptions::default() },
        time_s: args.time,
        light: args.sun.map_or(LightChoice::Default, LightChoice::Given),
        ..SceneRequest::new(scene, args.size)
    };
    request.with_camera(camera.map_or(CameraChoice::Default, CameraChoice::Named))
}
