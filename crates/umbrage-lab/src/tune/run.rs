//! Running a search: traces the truth, judges candidate after candidate, writes the outputs.

use std::path::PathBuf;

use umbrage::config::{Budget, LightKind};
use umbrage_render::{Gpu, GpuOptions};

use super::{
    Axis, Error, Outputs, RESULTS, Settings,
    candidates::Grid,
    judged::{JudgedScene, judge},
    output,
    record::{Outcome, Run, Shard, ViewName},
};
use crate::{
    compare::shots::SceneShots, failure::Result, journal::Journal, notes, progress, technique::text::Settings as Given,
};

/// A search. Everything that can be is checked before a frame is drawn.
#[derive(Debug)]
pub struct Job {
    /// Budget of the maps.
    pub budget: Budget,
    /// Axes of the search.
    pub axes: Vec<Axis>,
    /// Settings of all candidates that do not override them.
    pub with: Given,
    /// True if the presets are candidates too.
    pub presets: bool,
    /// Scenes, opened, with their views.
    pub scenes: Vec<SceneShots>,
    /// Settings of all candidates.
    pub settings: Settings,
    /// Largest F_edge of the best candidate, as a share.
    pub most_flicker: f64,
    /// File of finished candidates, from which a run that was cut off continues.
    pub results: Option<PathBuf>,
    /// Shard of the candidates that are judged.
    pub shard: Shard,
    /// Output files.
    pub outputs: Outputs,
}

/// Judges the candidates of the shard that no earlier run judged. Writes the outputs, unless the
/// shard is only a part.
///
/// # Errors
/// [`crate::failure::Failure`] with the option, file or candidate at fault.
pub fn run(job: &Job) -> Result<()> {
    let lights: Vec<LightKind> =
        job.scenes.iter().flat_map(|set| &set.series).map(|series| series.light.light.into()).collect();
    let grid = Grid {
        axes: &job.axes,
        with: &job.with,
        presets: job.presets,
        budget: job.budget,
        range: job.settings.shadow_range,
        lights: &lights[..lights.len().min(1)],
    };
    let found = grid.candidates()?;
    let gpu = Gpu::new(&GpuOptions::default())?;
    let run = Run {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        adapter: gpu.description(),
        budget: job.budget.to_string(),
        axes: job.axes.clone(),
        with: job.with.clone(),
        size: job.settings.size,
        shadow_range: job.settings.shadow_range,
        sun_angle: job.settings.sun_angle,
        least_edges: job.settings.least_edges,
        views: view_names(&job.scenes),
        candidates: found.all,
        skipped: found.skipped,
        shard: job.shard,
    };
    let read = |line: &str| read_outcome(line, run.candidates.len());
    let mut journal = job.results.as_deref().map(|path| Journal::open(path, RESULTS, &run, read)).transpose()?;
    let mut outcomes: Vec<Outcome> = journal.as_mut().map(|journal| journal.finished.clone()).unwrap_or_default();
    if let Some(journal) = journal.as_ref().filter(|journal| !journal.finished.is_empty() || journal.dropped > 0) {
        notes::say([&went_on(journal)]);
    }
    judge_missing(job, &gpu, &run, journal.as_mut(), &mut outcomes)?;
    if job.shard == Shard::WHOLE { output::write(&run, outcomes, job.most_flicker, &job.outputs) } else { Ok(()) }
}

fn judge_missing(
    job: &Job,
    gpu: &Gpu,
    run: &Run,
    mut journal: Option<&mut Journal<Outcome>>,
    outcomes: &mut Vec<Outcome>,
) -> Result<()> {
    let is_done = |number: usize| outcomes.iter().any(|outcome| outcome.candidate == number);
    let missing: Vec<usize> =
        (0..run.candidates.len()).filter(|&number| job.shard.has(number) && !is_done(number)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let bar = progress::steps((run.views.len() * (missing.len() + 1)) as u64, "views × candidates");
    let scenes: Vec<JudgedScene<'_>> =
        job.scenes.iter().map(|set| JudgedScene::trace(set, &job.settings, &bar)).collect::<Result<_>>()?;
    if !scenes.iter().any(JudgedScene::counts) {
        return Err(Error::NoView { least_edges: job.settings.least_edges }.into());
    }
    for number in missing {
        let outcome = judge(gpu, &scenes, (number, &run.candidates[number]), &job.settings, &bar)?;
        if let Some(journal) = journal.as_deref_mut() {
            journal.append(&outcome)?;
        }
        outcomes.push(outcome);
    }
    bar.finish_and_clear();
    Ok(())
}

/// Reads a line of a file of results, of a run with `candidates` candidates. The error says what is
/// wrong with it.
pub(super) fn read_outcome(line: &str, candidates: usize) -> std::result::Result<Outcome, String> {
    let outcome: Outcome = serde_json::from_str(line).map_err(|error| error.to_string())?;
    if outcome.candidate < candidates {
        return Ok(outcome);
    }
    Err(format!("it is of candidate {}, and there are {candidates}", outcome.candidate))
}

fn went_on(journal: &Journal<Outcome>) -> String {
    let cut = if journal.dropped > 0 { "; another was cut off and is judged again" } else { "" };
    format!("--results {}: {} candidates were finished before{cut}", journal.path().display(), journal.finished.len())
}

fn view_names(scenes: &[SceneShots]) -> Vec<ViewName> {
    let of_scene = |set: &SceneShots| -> Vec<ViewName> {
        let frames = |series: &crate::compare::shots::Series| -> Vec<ViewName> {
            let name = |(frame, options): (usize, &Vec<String>)| ViewName {
                scene: set.name.clone(),
                camera: series.camera.clone(),
                sun: series.sun_name.clone(),
                frame,
                options: options.clone(),
            };
            series.options.iter().take(series.views.len()).enumerate().map(name).collect()
        };
        set.series.iter().flat_map(frames).collect()
    };
    scenes.iter().flat_map(of_scene).collect()
}
