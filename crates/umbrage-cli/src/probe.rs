//! `umbrage probe`: visibility at given points, from the maps that `render` uses.

use std::{
    fs,
    path::{Path, PathBuf},
};

use glam::DVec3;
use umbrage_lab::{
    failure::{Failure, Result},
    notes,
    output::{self, Staged, numbered_file},
    progress,
    report::{ProbeReport, to_json},
    scene_setup::SceneSetup,
    session::Session,
};
use umbrage_render::{Outputs, ProbePoint};

use crate::{
    scene_options::{Asked, SceneOptions},
    shadow_args::ShadowArgs,
};

/// `umbrage probe`.
#[derive(Debug, clap::Args)]
pub struct ProbeArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Records of six little-endian f64: a world position and a geometric normal
    #[arg(long, value_name = "IN")]
    pub points: PathBuf,
    /// Write one little-endian f32 of visibility per record here
    #[arg(long, value_name = "OUT", help_heading = "Output")]
    pub out: PathBuf,
    /// Write what was done and what it cost here, with the split of each point (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// Size of a record in bytes: six little-endian f64, a position and a normal.
const RECORD_BYTES: usize = 6 * size_of::<f64>();

/// Runs the subcommand.
pub fn run(args: &ProbeArgs) -> Result<()> {
    let Asked { scene: request, shadows } = Asked::new(&args.scene, &args.shadows)?;
    let files: Vec<&Path> = [Some(&args.out), args.report.as_ref()].into_iter().flatten().map(AsRef::as_ref).collect();
    let inputs: Vec<&Path> =
        request.inputs().into_iter().chain([args.points.as_path()]).chain(args.shadows.file()).collect();
    output::check(&files, &[], &inputs)?;
    let bytes = fs::read(&args.points).map_err(|error| Failure::file("read", &args.points, &error))?;
    let points = points(&args.points, &bytes)?;

    let setup = SceneSetup::open(&request)?;
    let mut session = Session::open(&request, &shadows, &setup)?;
    let mut staged = Staged::default();
    let bar = progress::steps(setup.shots.len() as u64, "frames");
    for shot in &setup.shots {
        let frame = session.frame(&setup, shot, &shot.view);
        let answers = match &shot.shown {
            Some(fade) => session.renderer.probe_faded(&frame, fade, &points)?,
            None => session.renderer.probe(&frame, &points)?,
        };
        // The same maps once more, for what they cost; no picture is asked for.
        let rendered = match &args.report {
            Some(_) => session.renderer.render_views(&[frame], shot.shown.as_ref(), Outputs::default())?,
            None => Vec::new(),
        };
        notes::say(shadows.notes.iter().chain(rendered.iter().flat_map(|rendered| &rendered.stats.notes)));
        bar.inc(1);
        if !setup.is_wanted(shot) {
            continue;
        }
        let number = setup.file_number(shot);
        let visibility = answers.iter().flat_map(|answer| answer.visibility.to_le_bytes()).collect();
        staged.file(&numbered_file(&args.out, number), visibility)?;
        if let (Some(path), Some(rendered)) = (&args.report, rendered.first()) {
            let mut report = session.report(&request, &setup, shot, &rendered.stats);
            report.probe = Some(ProbeReport { split: answers.iter().map(|answer| answer.split).collect() });
            staged.file(&numbered_file(path, number), to_json(&report)?)?;
        }
        staged.finish_frame();
    }
    bar.finish_and_clear();
    staged.commit()
}

/// Reads the records of a file of points.
fn points(path: &Path, bytes: &[u8]) -> Result<Vec<ProbePoint>> {
    let bad = |reason: String| Failure::input(format!("--points {}: {reason}", path.display()));
    if !bytes.len().is_multiple_of(RECORD_BYTES) {
        return Err(bad(format!(
            "{} bytes are not a whole number of records; each is {RECORD_BYTES} bytes, six little-endian f64",
            bytes.len()
        )));
    }
    bytes
        .chunks_exact(RECORD_BYTES)
        .enumerate()
        .map(|(index, record)| {
            let numbers: [f64; 6] = std::array::from_fn(|i| {
                // chunks_exact gives 48 bytes, so each of the six slices has eight.
                f64::from_le_bytes(std::array::from_fn(|byte| record[8 * i + byte]))
            });
            let [x, y, z, nx, ny, nz] = numbers;
            let (position, normal) = (DVec3::new(x, y, z), DVec3::new(nx, ny, nz));
            if !position.is_finite() || !normal.is_finite() {
                return Err(bad(format!("record {index} holds a number that is not finite: {position}, {normal}")));
            }
            if normal.length() == 0.0 || !normal.length().is_finite() {
                return Err(bad(format!("record {index} has the normal {normal}, which has no direction")));
            }
            Ok(ProbePoint { position, normal: normal.normalize() })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(numbers: &[f64]) -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    }

    #[test]
    fn records_are_six_little_endian_numbers() {
        let path = Path::new("points.bin");
        let read =
            points(path, &bytes(&[1.0, 2.0, 3.0, 0.0, 2.0, 0.0, -4.0, 5.0, 6.0, 1.0, 0.0, 0.0])).expect("two points");
        assert_eq!(read.len(), 2);
        assert_eq!((read[0].position, read[0].normal), (DVec3::new(1.0, 2.0, 3.0), DVec3::Y));
        assert_eq!((read[1].position, read[1].normal), (DVec3::new(-4.0, 5.0, 6.0), DVec3::X));
        assert!(points(path, &[]).expect("no points at all").is_empty());
    }

    #[test]
    fn bad_records_are_named() {
        let path = Path::new("points.bin");
        for (bad, word) in [
            (vec![0; 47], "47 bytes"),
            (vec![0; 49], "49 bytes"),
            (bytes(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, f64::NAN, 0.0, 0.0, 0.0, 1.0, 0.0]), "record 1"),
            (bytes(&[0.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.0]), "record 0"),
            (bytes(&[0.0; 6]), "no direction"),
        ] {
            let error = points(path, &bad).expect_err("bad points").to_string();
            assert!(error.contains("points.bin") && error.contains(word), "{error}");
        }
    }
}
