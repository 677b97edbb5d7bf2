//! `umbrage tune`: the best config for a budget, searched against the judge.

use std::path::{Path, PathBuf};

use umbrage::config::Budget;
use umbrage_lab::{
    compare::shots::Stride,
    failure::{Failure, Result},
    technique::text,
    tune::{self, Axis, Job, Outputs, Settings, Shard, axis, candidates::usual_axes, shard},
};

use crate::{
    shot_args::{ShotArgs, ShotDefaults},
    switch::Switch,
};

/// Default width and height in pixels; small, because many candidates draw every view.
const DEFAULT_SIZE: [u32; 2] = [320, 240];

/// Default motion of cameras: a walk that turns, so that flicker shows.
const STRIDE: Stride = Stride { metres: 0.15, turn: 0.3, zoom: 1.0, frames: 2 };

const TUNE_HELP: &str = "\
Candidates are all combinations of the values of --try, over the default or over the preset that --with names. Maps are as large as \
the budget allows. The presets are candidates too, at the same budget. Combinations that exclude each other are omitted and counted. \
Without --try: --try splits=2/3/4/6 --try filter=pcf2/pcf3/pcf5 --try share=1/0.25.

The best has the least share of wrong decisions (E, the mean over the views that count) of all candidates whose edges flicker no more \
than --most-flicker allows. Cameras walk 0.15 m and turn 0.3 degrees a frame, over two frames, unless --step, --turn, --zoom, --frames or \
--path say otherwise.

A search over several machines: give each the same options, --shard I/N and a --results file of its own, then
  umbrage tune --merge 1.jsonl,2.jsonl,3.jsonl -o best.toml --page tune.html";

/// `umbrage tune`.
#[derive(Debug, clap::Args)]
#[command(after_long_help = TUNE_HELP)]
pub struct TuneArgs {
    /// Scenes as for `umbrage render`: .glb or .gltf files, height maps, worlds
    #[arg(value_name = "SCENE", required_unless_present = "merge", conflicts_with = "merge")]
    pub scenes: Vec<String>,
    /// Budget of all maps: bytes (8MB, 8MiB) or texels (2Mtexel)
    #[arg(
        long,
        value_name = "AMOUNT",
        required_unless_present = "merge",
        conflicts_with = "merge",
        allow_hyphen_values = true,
        help_heading = "Search"
    )]
    pub budget: Option<Budget>,
    /// Values of a setting to try, once for each setting: splits=2/3/4; share=1/0.5 for shares of
    /// the budget, preset=still/balanced
    #[arg(long = "try", value_name = "KEY=VALUE/…", value_parser = axis, help_heading = "Search")]
    pub axes: Vec<Axis>,
    /// Settings for all candidates that do not try others: preset=still:blend=0
    #[arg(long, value_name = "SETTINGS", default_value = "", hide_default_value = true, help_heading = "Search")]
    pub with: String,
    /// Most flicker that the best config may have: F_edge in %
    #[arg(long, value_name = "PERCENT", default_value = "1", value_parser = umbrage_lab::parse::number, allow_hyphen_values = true, help_heading = "Search")]
    pub most_flicker: f64,
    /// Also judge the presets at the budget
    #[arg(long, value_enum, default_value = "on", help_heading = "Search")]
    pub presets: Switch,
    /// Judge every N-th candidate only, from the I-th on; needs --results, and --merge afterwards
    #[arg(long, value_name = "I/N", value_parser = shard, requires = "results", help_heading = "Search")]
    pub shard: Option<Shard>,
    /// Combine the files of all shards of a run; needs no scene
    #[arg(long, value_name = "FILE,…", value_delimiter = ',', conflicts_with_all = ["axes", "with", "shard", "results"], help_heading = "Search")]
    pub merge: Vec<PathBuf>,
    /// Views.
    #[command(flatten)]
    pub shots: ShotArgs,

    /// Write the best config here (TOML); `umbrage render --config` reads it
    #[arg(short = 'o', long = "output", value_name = "TOML", help_heading = "Output")]
    pub config: Option<PathBuf>,
    /// Write error over bytes here, with the Pareto front and the presets (SVG)
    #[arg(long, value_name = "SVG", help_heading = "Output")]
    pub plot: Option<PathBuf>,
    /// Write one page with the plot and tables here (HTML)
    #[arg(long, value_name = "HTML", help_heading = "Output")]
    pub page: Option<PathBuf>,
    /// Write all figures here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// Save finished candidates in this file; after an interruption, the same command continues
    /// from there. The file is kept
    #[arg(long, value_name = "JSONL", help_heading = "Output")]
    pub results: Option<PathBuf>,
}

/// Runs the subcommand.
pub fn run(args: &TuneArgs) -> Result<()> {
    let outputs = Outputs {
        config: args.config.clone(),
        plot: args.plot.clone(),
        page: args.page.clone(),
        json: args.json.clone(),
    };
    check_outputs(args, &outputs)?;
    let most_flicker = most_flicker(args)?;
    if !args.merge.is_empty() {
        outputs.check(None, &args.merge.iter().map(AsRef::as_ref).collect::<Vec<&Path>>())?;
        return tune::merge(&args.merge, most_flicker, &outputs);
    }
    let budget = args
        .budget
        .ok_or_else(|| Failure::input("--budget is missing; give the memory for all maps, for example --budget 8MB"))?;
    let with = text::parse_with(&args.with)?;
    if let Some((key, _)) = with.iter().find(|(key, _)| NOT_FOR_ALL.contains(&key.as_str())) {
        return Err(Failure::input(format!(
            "--with {key}: {key} must be the same for all candidates; give --{key} as an option of its own"
        )));
    }
    let mut inputs: Vec<&Path> = args.scenes.iter().map(Path::new).collect();
    inputs.extend(args.shots.path.as_deref());
    outputs.check(args.results.as_deref(), &inputs)?;
    let size = args.shots.size.unwrap_or(DEFAULT_SIZE);
    let defaults = ShotDefaults { stride: args.shots.path.is_none().then_some(STRIDE), ..ShotDefaults::default() };
    let shots = args.shots.request(args.scenes.len(), size, &defaults)?;
    let job = Job {
        budget,
        axes: if args.axes.is_empty() { usual_axes() } else { args.axes.clone() },
        with,
        presets: args.presets == Switch::On,
        scenes: args.scenes.iter().map(|scene| shots.open(scene)).collect::<Result<_>>()?,
        settings: Settings {
            size,
            shadow_range: args.shots.shadow_range,
            sun_angle: args.shots.sun_angle,
            least_edges: args.shots.least_edges,
        },
        most_flicker,
        results: args.results.clone(),
        shard: args.shard.unwrap_or(Shard::WHOLE),
        outputs,
    };
    tune::run(&job)
}

/// Settings that decide which pixels are scored.
const NOT_FOR_ALL: [&str; 2] = ["shadow-range", "sun-angle"];

/// Checks that a whole run has outputs, and that a shard has only results.
fn check_outputs(args: &TuneArgs, outputs: &Outputs) -> Result<()> {
    let some = outputs.files().next();
    match (args.shard, some) {
        (Some(shard), Some(path)) if shard != Shard::WHOLE => Err(Failure::input(format!(
            "{}: shard {shard} judges only a part of the candidates; write this file with --merge instead",
            path.display()
        ))),
        (_, None) if args.results.is_none() => Err(Failure::input(
            "nothing to write: give -o TOML, or some of --plot SVG, --page HTML, --json JSON, --results JSONL",
        )),
        _ => Ok(()),
    }
}

/// Returns `--most-flicker` as a share.
fn most_flicker(args: &TuneArgs) -> Result<f64> {
    if args.most_flicker >= 0.0 {
        return Ok(0.01 * args.most_flicker);
    }
    Err(Failure::input(format!("--most-flicker {}: give per cent, 0 or more", args.most_flicker)))
}
