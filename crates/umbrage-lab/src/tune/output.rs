//! What a search leaves: a config file, a plot, a page, all figures.

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

/// Where things go.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// The best config (TOML).
    pub config: Option<PathBuf>,
    /// Error over bytes (SVG).
    pub plot: Option<PathBuf>,
    /// One page (HTML).
    pub page: Option<PathBuf>,
    /// All figures (JSON).
    pub json: Option<PathBuf>,
}

impl Outputs {
    /// All files.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        [&self.config, &self.plot, &self.page, &self.json].into_iter().flatten().map(AsRef::as_ref)
    }

    /// Refuses what cannot be written, before any work is done; `results` is written beside.
    ///
    /// # Errors
    /// As [`output::check`].
    pub fn check(&self, results: Option<&Path>, inputs: &[&Path]) -> Result<()> {
        output::check(&self.files().chain(results).collect::<Vec<_>>(), &[], inputs)
    }
}

/// Everything that was found, as the JSON has it.
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
    /// The number of the best candidate.
    best: usize,
    /// The numbers of those on the Pareto front.
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

/// Chooses, and writes what was asked for, whole or not at all.
///
/// # Errors
/// [`super::Error`] where there is no best; [`Failure::Input`] naming a file that cannot be
/// written.
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

/// The best config as a file that `--config` reads, with a comment of what it was tuned for.
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
