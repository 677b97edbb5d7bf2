//! Running a benchmark: opens scenes, measures, writes the outputs.

use std::path::Path;

use umbrage::{DirectionalLight, Frustum, SunFade, View};
use umbrage_render::{Gpu, GpuOptions, Samples};

use super::{
    crowd,
    job::Job,
    measure::measure,
    page, papers,
    report::{CrowdReport, Report, SceneReport},
};
use crate::{
    failure::{Failure, Result},
    lights::NamedLight,
    output::{self, Staged},
    progress,
    report::to_json,
    scene_setup::{SceneSetup, Shot},
    technique::text,
};

/// Paths of Figure 10-9 with four splits: filtered in the shader from one nearest texel's
/// comparison, and compared and filtered in hardware; multipass, and everything in a single
/// submission.
const CROWD: [&str; 5] = [
    "pssm:4:1024:filter=hard:label=per split, one texel",
    "pssm:4:1024:filter=pcf2:label=per split, hardware comparison",
    "pssm:4:1024:filter=pcf2:blend=0:generation=multipass:label=multipass",
    "pssm:4:1024:filter=pcf2:generation=layered:label=layered",
    "pssm:4:1024:filter=pcf2:generation=instanced:label=instanced",
];

/// All pairs of generation and storage.
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

/// Measures everything and writes the outputs.
///
/// # Errors
/// [`Failure`] with the scene or technique at fault, or the file that cannot be written.
pub fn run(job: &Job) -> Result<()> {
    let files: Vec<&Path> = [&job.json, &job.html].into_iter().flatten().map(AsRef::as_ref).collect();
    if files.is_empty() {
        return Err(Failure::input("nothing to write: give -o HTML or --json JSON"));
    }
    let crowd = text::parse_all(&CROWD.map(str::to_owned), "preset=papers:stabilize=none")?;
    let pairs = if job.paths {
        PAIRS.map(|pair| format!("pssm:4:512:generation={pair}:label={}", pair.replace(":storage=", ", "))).to_vec()
    } else {
        Vec::new()
    };
    // Without a blend, which a reused map cannot have: all of them draw the same picture.
    let others = job.paths_with.split(':').filter(|setting| !setting.starts_with("blend="));
    let pairs = text::parse_all(&pairs, &others.chain(["blend=0"]).collect::<Vec<_>>().join(":"))?;
    let inputs: Vec<&Path> = job.scenes.iter().map(|scene| Path::new(&scene.scene)).collect();
    output::check(&files, &[], &inputs)?;

    let gpu = Gpu::new(&GpuOptions::default())?;
    let rounds = u64::from(job.rounds) + 1;
    let tables = job.scenes.len() * (job.techniques.len() + pairs.len()) + job.objects.len() * crowd.len();
    let bar = progress::steps(rounds * tables as u64, "frames with and without shadows");
    let mut report = Report {
        adapter: gpu.description(),
        size: job.size,
        samples: if job.samples == Samples::Four { "4" } else { "1" }.into(),
        rounds: job.rounds,
        with: job.with.clone(),
        scenes: Vec::new(),
        crowds: Vec::new(),
    };
    for request in &job.scenes {
        let setup = SceneSetup::open(request)?;
        let mut rows = measure(&gpu, &setup, &job.techniques, job, &bar)?;
        for (row, technique) in rows.iter_mut().zip(&job.techniques) {
            let alike = technique.shadows.config.map_sizes.iter().all(|&size| size == 512);
            row.paper_ratio = alike.then(|| papers::table_1(&request.scene, row.splits)).flatten();
        }
        report.scenes.push(SceneReport {
            scene: request.scene.clone(),
            camera: setup.shots[0].camera.clone(),
            triangles: setup.scene.placed_triangles(),
            rows,
            paths: measure(&gpu, &setup, &pairs, job, &bar)?,
        });
    }
    for &objects in &job.objects {
        let setup = crowd_setup(job.size, objects)?;
        let rows = measure(&gpu, &setup, &crowd, job, &bar)?;
        report.crowds.push(CrowdReport { objects, rows });
    }
    bar.finish_and_clear();

    let mut staged = Staged::default();
    if let Some(path) = &job.json {
        staged.file(path, to_json(&report)?)?;
    }
    if let Some(path) = &job.html {
        staged.file(path, page::page(&report)?.into_bytes())?;
    }
    staged.commit()
}

fn crowd_setup(size: [u32; 2], objects: u32) -> Result<SceneSetup> {
    let (scene, eye, target) = crowd::crowd(objects)?;
    let aspect = f64::from(size[0]) / f64::from(size[1]);
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
    Ok(SceneSetup::new(scene, pose, vec![light], vec![shot], Vec::new()))
}
