//! `umbrage truth`: the mask by rays, hard or under a sun with a size.

use std::path::{Path, PathBuf};
use std::time::Instant;

use umbrage_lab::{
    failure::Result,
    output::{self, Staged, numbered_file},
    picture::{png, side_by_side},
    progress,
    reach::truth_for,
    report::{TruthReport, TruthTimesMs, to_json},
    scene_setup::SceneSetup,
    sun_disc::sun_disc,
};

use crate::{scene_options::SceneOptions, shadow_args::ShadowArgs};

/// `umbrage truth`.
#[derive(Debug, clap::Args)]
pub struct TruthArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Accepted and ignored, except for the scene of a report: rays need no settings.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Write the exact visibility mask here (PNG, grey and alpha); soft with --sun-angle, by 256
    /// directions
    #[arg(short = 'o', long = "output", value_name = "MASK", help_heading = "Output")]
    pub mask: PathBuf,
    /// Write scene, camera, sun and times here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// Runs the subcommand.
pub fn run(args: &TruthArgs) -> Result<()> {
    let request = args.scene.over(args.shadows.file())?.request()?;
    let files: Vec<_> = [Some(&args.mask), args.report.as_ref()].into_iter().flatten().map(AsRef::as_ref).collect();
    let inputs: Vec<&Path> = request.inputs().into_iter().chain(args.shadows.file()).collect();
    output::check(&files, &[], &inputs)?;
    let setup = SceneSetup::open_views(&request)?;
    let began = Instant::now();
    let views: Vec<_> = setup.shots.iter().flat_map(|shot| shot.views().map(|(_, view)| (view, shot.light))).collect();
    let truth = truth_for(&setup.scene, &setup.pose, &views)?;
    let build = began.elapsed();
    let mut staged = Staged::default();
    let shots = || setup.shots.iter().filter(|shot| setup.is_wanted(shot));
    let count = shots().map(|shot| shot.views().count()).sum::<usize>() as f32;
    let bar = progress::fraction("rays");
    let mut done = 0.0;
    for shot in shots() {
        let number = setup.file_number(shot);
        let began = Instant::now();
        let mut images = Vec::new();
        for (_, view) in shot.views() {
            let progress = |share| progress::set_fraction(&bar, (done + share) / count);
            let mask = truth.mask_under(view, &shot.light, request.size, &progress)?;
            images.push(match request.sun_angle.and_then(sun_disc) {
                Some(disc) => truth.soft(&mask, &disc, &progress)?.to_image(),
                None => mask.to_image(),
            });
            done += 1.0;
        }
        let image = side_by_side(images);
        let rays = began.elapsed();
        staged.file(&numbered_file(&args.mask, number), png(&image)?)?;
        if let Some(path) = &args.report {
            let report = TruthReport {
                shot: setup.report(&request, shot),
                times_ms: TruthTimesMs { build: build.as_secs_f64() * 1e3, rays: rays.as_secs_f64() * 1e3 },
                notes: setup.notes.clone(),
            };
            staged.file(&numbered_file(path, number), to_json(&report)?)?;
        }
        staged.finish_frame();
    }
    bar.finish_and_clear();
    staged.commit()
}
