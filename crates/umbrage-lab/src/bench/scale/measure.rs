//! The frames of each case at one number of objects.

use std::time::Instant;

use glam::DVec3;
use indicatif::ProgressBar;
use umbrage::Aabb;
use umbrage::config::Cache;
use umbrage_render::{Frame, FrameStats, Gpu, LightMaps, Outputs, RenderSettings, Renderer, Samples};
use umbrage_scene::{OpenOptions, Pose, procedural::World, procedural::WorldOptions};

use super::job::{Case, STEP_M, ScaleJob, WARM_UP, ahead};
use super::report::{CaseReport, SizeReport};
use crate::{
    bench::summary::Summary,
    failure::Result,
    lights,
    scene_request::{CameraChoice, SceneRequest},
    scene_setup::SceneSetup,
};

/// Number of objects of which one moves.
const MOVES: usize = 100;

/// Name of the camera.
const CAMERA: &str = "middle";

/// Measures all cases in a forest of `trees` trees.
pub fn measure(gpu: &Gpu, job: &ScaleJob, trees: u32, bar: &ProgressBar) -> Result<SizeReport> {
    let begun = Instant::now();
    let world = WorldOptions { trees: Some(trees), ..WorldOptions::default() };
    let request = SceneRequest {
        files: OpenOptions { world, ..OpenOptions::default() },
        ..SceneRequest::new(World::Forest.name(), job.size)
    };
    let mut setup = SceneSetup::open(&request.with_camera(CameraChoice::Named(CAMERA.to_owned()))?)?;
    let open_ms = 1e3 * begun.elapsed().as_secs_f64();
    let light_maps: Vec<LightMaps> = lights::kinds(&setup.lights).into_iter().map(LightMaps::from).collect();
    let bare =
        RenderSettings { size: job.size, samples: Samples::One, lights: light_maps, ..RenderSettings::default() };
    let mut without = Renderer::without_shadows(gpu, &setup.scene, &bare)?;
    let mut cases = Vec::new();
    for case in Case::ALL {
        let mut shadows = job.technique.shadows.for_lights(&setup.lights)?;
        shadows.config.cache = if case.is_kept() { Cache::Kept } else { Cache::Off };
        let settings = shadows.render_settings(job.size, Samples::One, lights::kinds(&setup.lights));
        let mut renderer = Renderer::new(gpu, &setup.scene, &settings)?;
        cases.push(frames(&mut setup, (&mut renderer, &mut without), case, job, bar)?);
    }
    let by_gpu = super::gpu::measure(gpu, &setup, job)?;
    Ok(SizeReport { trees, objects: setup.pose.objects.len(), open_ms, cases, by_gpu })
}

/// Draws the frames of a case.
fn frames(
    setup: &mut SceneSetup,
    (renderer, without): (&mut Renderer, &mut Renderer),
    case: Case,
    job: &ScaleJob,
    bar: &ProgressBar,
) -> Result<CaseReport> {
    let movers = match case {
        Case::Movers => Movers::of(&setup.pose),
        _ => Movers::default(),
    };
    let (mut stats, mut bare): (Vec<FrameStats>, Vec<FrameStats>) = (Vec::new(), Vec::new());
    let outputs = Outputs { picture: true, ..Outputs::default() };
    let shot = setup.shots[0].clone();
    for _ in 0..case.settling() {
        let frame = Frame { moved: Some(&[]), ..setup.frame(&shot, &shot.view, true, false) };
        stats.push(renderer.render(&frame, Outputs::default())?.stats);
        bar.inc(1);
    }
    let first_triangles = stats.drain(..).next().map(|stats| stats.shadow_triangles);
    for round in 0..WARM_UP + job.rounds {
        movers.step(&mut setup.pose, round);
        let view = if case.walks() { ahead(&shot.view, STEP_M * f64::from(round)) } else { shot.view };
        let frame = Frame { moved: Some(&movers.objects), ..setup.frame(&shot, &view, true, false) };
        stats.push(renderer.render(&frame, outputs)?.stats);
        bare.push(without.render(&Frame { shadows_on: false, ..frame }, outputs)?.stats);
        bar.inc(1);
    }
    movers.restore(&mut setup.pose);
    let counted = |value: &dyn Fn(&FrameStats) -> f64, of: &[FrameStats]| {
        Summary::of(&of[WARM_UP as usize..].iter().map(value).collect::<Vec<_>>())
    };
    Ok(CaseReport {
        case,
        plan_us: counted(&|stats| 1e3 * stats.plan_ms, &stats),
        pairs: counted(&|stats| stats.splits.iter().map(|split| split.casters as f64).sum(), &stats),
        triangles: counted(&|stats| stats.shadow_triangles as f64, &stats),
        first_triangles: first_triangles.or(stats.first().map(|stats| stats.shadow_triangles)).unwrap_or(0),
        shadow_ms: counted(&|stats| stats.shadow_ms, &stats),
        frame_ms: counted(&|stats| stats.frame_ms, &stats),
        frame_without_ms: counted(&|stats| stats.frame_ms, &bare),
    })
}

/// Objects that move, with their positions at rest.
#[derive(Default)]
struct Movers {
    objects: Vec<u32>,
    stand: Vec<(DVec3, Aabb)>,
}

impl Movers {
    /// Chooses one instance in [`MOVES`], spread over the pose.
    fn of(pose: &Pose) -> Self {
        let instances = pose.objects.iter().enumerate().filter(|(_, object)| object.instance.is_some());
        let chosen = instances
            .step_by(MOVES)
            .map(|(index, object)| (index as u32, (object.world_from_local.translation, object.bounds)));
        let (objects, stand) = chosen.unzip();
        Self { objects, stand }
    }

    /// Moves the objects to their positions in a frame.
    fn step(&self, pose: &mut Pose, frame: u32) {
        let by = DVec3::X * (0.5 * (0.1 * f64::from(frame)).sin());
        self.put(pose, by);
    }

    fn restore(&self, pose: &mut Pose) {
        self.put(pose, DVec3::ZERO);
    }

    fn put(&self, pose: &mut Pose, by: DVec3) {
        for (&object, (at, bounds)) in self.objects.iter().zip(&self.stand) {
            let object = &mut pose.objects[object as usize];
            object.world_from_local.translation = *at + by;
            object.bounds = Aabb::new(bounds.min + by, bounds.max + by);
        }
    }
}
