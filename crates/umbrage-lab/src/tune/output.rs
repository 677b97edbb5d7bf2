//! Outputs of a search: a config file, a plot, a page, all results.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use serde::Serialize;

use super::{
    choice::{Choice, choose, is_still},
    page,
    record::{Outcome, Run, figures, scenes},
};
use crate::{
    failure::{Failure, Result},
    output::{self, Staged},
    report::to_json,
};

/// Output files of a search.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// File of the best config (TOML).
    pub config: Option<PathBuf>,
    /// File of the plot of error over bytes (SVG).
    pub plot: Option<PathBuf>,
    /// File of the page (HTML).
    pub page: Option<PathBuf>,
    /// File of all results (JSON).
    pub json: Option<PathBuf>,
}

impl Outputs {
    /// Iterates over all files.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        [&self.config, &self.plot, &self.page, &self.json].into_iter().flatten().map(AsRef::as_ref)
    }

    /// Refuses files that cannot be written, before any work is done. `results` is another file
    /// that is written.
    ///
    /// # Errors
    /// As [`output::check`].
    pub fn check(&self, results: Option<&Path>, inputs: &[&Path]) -> Result<()> {
        output::check(&self.files().chain(results).collect::<Vec<_>>(), &[], inputs)
    }
}

/// Results of a search, as they are written to JSON.
#[derive(Serialize)]
struct Found<'a> {
    version: &'a str,
    adapter: &'a str,
    budget: &'a str,
    most_flicker: f64,
    size: [u32; 2],
    shadow_range: Option<(f64, f64)>,
    sun_angle: Option<f64>,
    least_edges: usize,
    #[serde(rename = "try")]
    axes: &'a [super::Axis],
    with: &'a [(String, String)],
    /// Number of the best candidate.
    best: usize,
    /// Numbers of the candidates on the Pareto front.
    front: Vec<usize>,
    candidates: Vec<FoundCandidate<'a>>,
    skipped: Vec<Skipped<'a>>,
    views: &'a [super::record::ViewName],
}

#[derive(Serialize)]
struct FoundCandidate<'a> {
    label: &'a str,
    preset: Option<&'a str>,
    is_still: bool,
    #[serde(flatten)]
    outcome: &'a Outcome,
    config: &'a umbrage::ShadowConfig,
}

#[derive(Serialize)]
struct Skipped<'a> {
    reason: &'a str,
    count: usize,
}

/// Chooses the best candidate and writes all outputs, or none.
///
/// # Errors
/// [`super::Error`] if there is no best one; [`Failure::Input`] with a file that cannot be written.
pub fn write(run: &Run, mut outcomes: Vec<Outcome>, most: f64, outputs: &Outputs) -> Result<()> {
    outcomes.sort_by_key(|outcome| outcome.candidate);
    let choice = choose(run, &outcomes, most)?;
    let plot = page::plot(run, &outcomes, &choice, most)?;
    let mut staged = Staged::default();
    if let Some(path) = &outputs.config {
        staged.file(path, config_file(run, &outcomes[choice.best], most)?.into_bytes())?;
    }
    if let Some(path) = &outputs.plot {
        staged.file(path, plot.clone().into_bytes())?;
    }
    if let Some(path) = &outputs.page {
        let toml = config_file(run, &outcomes[choice.best], most)?;
        staged.file(path, page::page(run, &outcomes, &choice, most, (plot, &toml)).into_bytes())?;
    }
    if let Some(path) = &outputs.json {
        staged.file(path, to_json(&found(run, &outcomes, &choice, most))?)?;
    }
    staged.commit()
}

fn found<'a>(run: &'a Run, outcomes: &'a [Outcome], choice: &Choice, most: f64) -> Found<'a> {
    let number = |index: usize| outcomes[index].candidate;
    let candidate = |outcome: &'a Outcome| {
        let candidate = &run.candidates[outcome.candidate];
        FoundCandidate {
            label: &candidate.label,
            preset: candidate.preset.as_deref(),
            is_still: is_still(outcome, most),
            outcome,
            config: &candidate.config,
        }
    };
    Found {
        version: &run.version,
        adapter: &run.adapter,
        budget: &run.budget,
        most_flicker: most,
        size: run.size,
        shadow_range: run.shadow_range,
        sun_angle: run.sun_angle,
        least_edges: run.least_edges,
        axes: &run.axes,
        with: &run.with,
        best: number(choice.best),
        front: choice.front.iter().map(|&index| number(index)).collect(),
        candidates: outcomes.iter().map(candidate).collect(),
        skipped: run.skipped.iter().map(|(reason, &count)| Skipped { reason, count }).collect(),
        views: &run.views,
    }
}

/// Writes the best config as a file for `--config`, with a comment on the run.
fn config_file(run: &Run, best: &Outcome, most: f64) -> Result<String> {
    let candidate = &run.candidates[best.candidate];
    let settings = toml::to_string(&candidate.config)
        .map_err(|error| Failure::other(format!("the best config cannot be written as TOML: {error}")))?;
    let mut text = String::new();
    let mut say = |line: std::fmt::Arguments<'_>| {
        // Names in files may hold anything, even the end of a comment.
        let line: String = line.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        writeln!(text, "# {}", line.trim_end()).map_err(|error| Failure::other(error.to_string()))
    };
    let [width, height] = run.size;
    say(format_args!("Tuned by umbrage {} for {}, within {}.", run.version, scenes(run).join(", "), run.budget))?;
    let counting = best.views.iter().filter(|view| view.counts).count();
    say(format_args!("Views: {counting} that count, of {width} x {height} pixels, on {}.", run.adapter))?;
    say(format_args!("{}", figures(best)))?;
    say(format_args!(
        "The least E of {} candidates, of those with F_edge <= {} %.",
        run.candidates.len(),
        100.0 * most
    ))?;
    say(format_args!("Candidate: {}.", candidate.label))?;
    Ok(text + "\n" + &settings)
}
