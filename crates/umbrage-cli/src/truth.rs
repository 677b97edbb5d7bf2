//! `umbrage truth`: the mask by rays, hard or under a sun with a size.

use std::time::Instant;

use umbrage_truth::{SunDisc, Truth};

use crate::{
    args::TruthArgs,
    failure::{Failure, Result},
    output::{self, Staged, numbered_file},
    progress,
    render::{png, side_by_side},
    report::{TruthReport, TruthTimesMs, to_json},
    scene_job::SceneJob,
    stage::Stage,
};

/// Directions by which a sun with a size is looked at.
const SOFT_SAMPLES: u32 = 256;

/// The sun's disc of an angle in degrees; a sun of 0 degrees is a point and throws hard shadows.
#[must_use]
pub fn sun_disc(degrees: f64) -> Option<SunDisc> {
    (degrees > 0.0).then(|| SunDisc::new(degrees.to_radians(), SOFT_SAMPLES))
}

/// Runs the subcommand.
pub fn run(args: &TruthArgs) -> Result<()> {
    let job = SceneJob::new(&args.scene)?;
    let files: Vec<_> = [Some(&args.mask), args.report.as_ref()].into_iter().flatten().map(AsRef::as_ref).collect();
    output::check(&files, &[], &job.inputs())?;
    let stage = Stage::open_views(&job)?;
    let began = Instant::now();
    let truth = Truth::build(&stage.scene, &stage.pose, stage.shots[0].view.eye())?;
    let build = began.elapsed();
    let mut staged = Staged::default();
    let count = stage.shots.iter().map(|shot| shot.views().count()).sum::<usize>() as f32;
    let bar = progress::fraction("rays");
    let mut done = 0.0;
    for shot in &stage.shots {
        let began = Instant::now();
        let mut images = Vec::new();
        for (_, view) in shot.views() {
            let progress = |share| progress::set_fraction(&bar, (done + share) / count);
            let mask = truth.mask_under(view, &shot.light, job.size, &progress)?;
            images.push(match job.sun_angle.and_then(sun_disc) {
                Some(disc) => truth.soft(&mask, &disc, &progress)?.to_image(),
                None => mask.to_image(),
            });
            done += 1.0;
        }
        let image = side_by_side(images);
        let rays = began.elapsed();
        staged.file(&numbered_file(&args.mask, shot.frame), png(&image)?)?;
        if let Some(path) = &args.report {
            let report = TruthReport {
                shot: stage.report(&job, shot),
                times_ms: TruthTimesMs { build: build.as_secs_f64() * 1e3, rays: rays.as_secs_f64() * 1e3 },
                notes: stage.notes.clone(),
            };
            staged.file(&numbered_file(path, shot.frame), to_json(&report)?)?;
        }
    }
    bar.finish_and_clear();
    staged.commit()
}

/// What the judge refuses is the scene or an option.
impl From<umbrage_truth::Error> for Failure {
    fn from(error: umbrage_truth::Error) -> Self {
        Self::input(error.to_string())
    }
}
