//! What a run is of and what it found, as it is in a file of results.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Axis, candidates::Candidate};

/// Which part of the candidates is judged: every `of`-th, from `number` on, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// 1 to `of`.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl Shard {
    /// All candidates.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether a candidate belongs to it.
    #[must_use]
    pub const fn has(self, candidate: usize) -> bool {
        candidate % self.of + 1 == self.number
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// `--shard`: `2/4`.
pub fn shard(text: &str) -> Result<Shard, String> {
    let numbers =
        text.split_once('/').and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
    match numbers {
        Some((number, of)) if number >= 1 && number <= of => Ok(Shard { number, of }),
        Some((number, of)) => Err(format!("shard {number} of {of}; give 1/{of} to {of}/{of}")),
        None => Err(format!("{text:?} is not a shard; write I/N, as in 2/4 for the second of four")),
    }
}

/// Everything that decides what candidates come to: the first line of a file of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Run {
    /// Of umbrage.
    pub version: String,
    /// The graphics adapter.
    pub adapter: String,
    /// What maps may take.
    pub budget: String,
    /// What is tried.
    #[serde(rename = "try")]
    pub axes: Vec<Axis>,
    /// Settings of all that do not try others.
    pub with: Vec<(String, String)>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// View depths that are scored, metres.
    pub shadow_range: Option<(f64, f64)>,
    /// Degrees across the sun.
    pub sun_angle: Option<f64>,
    /// Edge pixels of a view that counts.
    pub least_edges: usize,
    /// What all candidates are judged on.
    pub views: Vec<ViewName>,
    /// In the order of their numbers.
    pub candidates: Vec<Candidate>,
    /// Why combinations were left out, and how many.
    pub skipped: BTreeMap<String, usize>,
    /// Which of them are judged.
    pub shard: Shard,
}

/// A view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewName {
    /// The scene as it was named.
    pub scene: String,
    /// The camera.
    pub camera: String,
    /// The sun in words.
    pub sun: String,
    /// Number of the frame in its walk.
    pub frame: usize,
    /// The options of `umbrage render` that show it.
    pub options: Vec<String>,
}

/// What a candidate came to; one line of a file of results. Rates are shares in 0..=1.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Its number.
    pub candidate: usize,
    /// Bytes of all maps on the device.
    pub bytes: u64,
    /// E, the mean over the views that count.
    pub e: Option<f64>,
    /// E_log.
    pub e_log: Option<f64>,
    /// Acne.
    pub acne: Option<f64>,
    /// Leaks.
    pub leak: Option<f64>,
    /// D.
    pub edge_distance_px: Option<f64>,
    /// F_edge, the mean over the walks that count; none where no camera moves.
    pub flicker: Option<f64>,
    /// Draw calls into maps, the mean over the views that count.
    pub draws: Option<f64>,
    /// Each view alone.
    pub views: Vec<ViewOutcome>,
}

/// What a candidate came to in a view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewOutcome {
    /// E.
    pub e: Option<f64>,
    /// Edge pixels of the true shadow.
    pub edges: usize,
    /// Whether it counts in means.
    pub counts: bool,
}

/// The figures of an outcome in words.
pub(super) fn figures(outcome: &Outcome) -> String {
    let percent = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{:.3} %", 100.0 * value));
    format!(
        "E {}, F_edge {}, {:.2} MiB of maps.",
        percent(outcome.e),
        percent(outcome.flicker),
        outcome.bytes as f64 / f64::from(1 << 20)
    )
}

/// The scenes of a run.
pub(super) fn scenes(run: &Run) -> Vec<String> {
    let mut scenes: Vec<String> = run.views.iter().map(|view| view.scene.clone()).collect();
    scenes.dedup();
    scenes
}

/// The views of the outcomes that count; they are the same for all.
pub(super) fn views_of(outcomes: &[Outcome]) -> &[ViewOutcome] {
    outcomes.first().map_or(&[], |outcome| &outcome.views)
}
