//! Opens, measures, writes.

use std::path::Path;

use clap::ValueEnum;
use umbrage::{DirectionalLight, Frustum, SunFade, View};
use umbrage_render::{Gpu, GpuOptions, Samples};
use umbrage_scene::procedural::World;

use super::{
    args::BenchArgs,
    crowd,
    measure::measure,
    page, papers,
    report::{CrowdReport, Report, SceneReport},
};
use crate::{
    adapter,
    args::Filter,
    args::Switch,
    compare::techniques::{self, Technique},
    failure::{Failure, Result},
    lights::NamedLight,
    output::{self, Staged},
    progress,
    report::to_json,
    scene_job::SceneJob,
    shadow_job::typed_name,
    stage::{Shot, Stage},
};

/// The camera that is taken if none is named: shadows near, in the middle and far in one picture.
const CAMERA: &str = "middle";

/// Figure 10-9's paths, four splits: filtered in the shader from one nearest texel's comparison, and compared and filtered in
/// hardware; multipass, and everything in a single submission.
const CROWD: [&str; 5] = [
    "pssm:4:1024:filter=hard:label=per split, one texel",
    "pssm:4:1024:filter=pcf2:label=per split, hardware comparison",
    "pssm:4:1024:filter=pcf2:blend=0:generation=multipass:label=multipass",
    "pssm:4:1024:filter=pcf2:generation=layered:label=layered",
    "pssm:4:1024:filter=pcf2:generation=instanced:label=instanced",
];

/// Every pair of generation and storage.
const PAIRS: [&str; 9] = [
    "per-split:storage=array",
    "per-split:storage=atlas",
    "per-split:storage=separate",
    "per-split:storage=cube",
    "multipass:storage=reused",
    "layered:storage=array",
    "layered:storage=cube",
    "instanced:storage=atlas",
    "mixed:storage=array",
];

/// Runs the subcommand.
pub fn run(args: &BenchArgs) -> Result<()> {
    let files: Vec<&Path> = [&args.json, &args.html].into_iter().flatten().map(AsRef::as_ref).collect();
    if files.is_empty() {
        return Err(Failure::input("nothing to write: give -o HTML or --json JSON"));
    }
    let (specs, with) = if args.filters { (of_filters(), "") } else { (args.techniques.clone(), &*args.with) };
    let techniques = parsed(&specs, with, args)?;
    let crowd = parsed(&CROWD.map(str::to_owned), "stabilize=none", args)?;
    let pairs = match args.paths {
        Switch::On => {
            PAIRS.map(|pair| format!("pssm:4:512:generation={pair}:label={}", pair.replace(":storage=", ", "))).to_vec()
        }
        Switch::Off => Vec::new(),
    };
    // Without a blend, which a reused map cannot have: all of them draw the same picture.
    let others = args.with.split(':').filter(|setting| !setting.starts_with("blend="));
    let pairs = parsed(&pairs, &others.chain(["blend=0"]).collect::<Vec<_>>().join(":"), args)?;
    let samples = if args.samples == "4" { Samples::Four } else { Samples::One };
    let scenes: Vec<String> = match &args.scenes[..] {
        [] if args.filters => vec![World::RobotWar.name().to_owned()],
        [] => World::ALL.iter().map(|world| world.name().to_owned()).collect(),
        given => given.to_vec(),
    };
    let inputs: Vec<&Path> = scenes.iter().map(Path::new).collect();
    output::check(&files, &[], &inputs)?;

    let gpu = Gpu::new(&GpuOptions::default())?;
    let rounds = u64::from(args.rounds) + 1;
    let objects = if args.filters { &[][..] } else { &args.objects[..] };
    let tables = scenes.len() * (techniques.len() + pairs.len()) + objects.len() * crowd.len();
    let bar = progress::steps(rounds * tables as u64, "frames with and without shadows");
    let mut report = Report {
        adapter: adapter::description(&gpu),
        size: args.size,
        samples: args.samples.clone(),
        rounds: args.rounds,
        with: with.to_owned(),
        scenes: Vec::new(),
        crowds: Vec::new(),
    };
    for scene in &scenes {
        let stage = open(args, scene)?;
        let mut rows = measure(&gpu, &stage, &techniques, args.size, samples, args.rounds, &bar)?;
        for (row, technique) in rows.iter_mut().zip(&techniques) {
            let alike = technique.job.settings.map_sizes.iter().all(|&size| size == 512);
            row.paper_ratio = alike.then(|| papers::table_1(scene, row.splits)).flatten();
        }
        report.scenes.push(SceneReport {
            scene: scene.clone(),
            camera: stage.shots[0].camera.clone(),
            triangles: stage.scene.placed_triangles(),
            rows,
            paths: measure(&gpu, &stage, &pairs, args.size, samples, args.rounds, &bar)?,
        });
    }
    for &objects in objects {
        let stage = crowd_stage(args, objects)?;
        let rows = measure(&gpu, &stage, &crowd, args.size, samples, args.rounds, &bar)?;
        report.crowds.push(CrowdReport { objects, rows });
    }
    bar.finish_and_clear();

    let mut staged = Staged::default();
    if let Some(path) = &args.json {
        staged.file(path, to_json(&report)?)?;
    }
    if let Some(path) = &args.html {
        staged.file(path, page::page(&report)?.into_bytes())?;
    }
    staged.commit()
}

/// Four maps and every filter, PCF 2×2 first.
fn of_filters() -> Vec<String> {
    let all = Filter::value_variants().iter();
    let rest = all.filter(|&&filter| filter != Filter::Pcf2).copied();
    [Filter::Pcf2]
        .into_iter()
        .chain(rest)
        .map(typed_name)
        .map(|name| format!("pssm:4:1024:filter={name}:label={name}"))
        .collect()
}

fn parsed(specs: &[String], with: &str, args: &BenchArgs) -> Result<Vec<Technique>> {
    let drafts = specs.iter().map(|text| techniques::parse(text)).collect::<Result<Vec<_>>>()?;
    Ok(techniques::finish(&drafts, &techniques::parse_with(with)?, None, args.size)?)
}

/// The scene, by the camera that was named, the one in the middle, or its first.
fn open(args: &BenchArgs, scene: &str) -> Result<Stage> {
    if args.camera.is_none() && World::from_name(scene).is_some() {
        return Stage::open(&SceneJob::new(&args.scene_args(scene, Some(CAMERA)))?);
    }
    Stage::open(&SceneJob::new(&args.scene_args(scene, None))?)
}

fn crowd_stage(args: &BenchArgs, objects: u32) -> Result<Stage> {
    let (scene, eye, target) = crowd::crowd(objects)?;
    let aspect = f64::from(args.size[0]) / f64::from(args.size[1]);
    let sun = DirectionalLight::new(umbrage_scene::invented_sun())?;
    let view = View::look_at_upright(eye, target, Frustum::perspective(60f64.to_radians(), aspect, 1.0, 800.0)?)?;
    let light = NamedLight { name: "invented".into(), lamp: sun.into() };
    let shot = Shot {
        frame: None,
        camera: "crowd".into(),
        view,
        beside: Vec::new(),
        light: sun.into(),
        shown: Some(SunFade { from: sun, to: sun, weight: 1.0 }),
    };
    let pose = scene.pose(0.0)?;
    Ok(Stage::new(scene, pose, vec![light], vec![shot], Vec::new()))
}
