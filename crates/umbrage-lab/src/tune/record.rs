//! The description of a run and its outcomes, as they are written to a file of results.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Axis, candidates::Candidate};

/// A shard: every `of`-th candidate, from the `number`-th on, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Number of the shard, 1 to `of`.
    pub number: usize,
    /// Number of shards.
    pub of: usize,
}

impl Shard {
    /// Shard of all candidates.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Returns whether a candidate belongs to the shard.
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

/// Reads a shard of `--shard`: `2/4`.
pub fn shard(text: &str) -> Result<Shard, String> {
    let numbers =
        text.split_once('/').and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
    match numbers {
        Some((number, of)) if number >= 1 && number <= of => Ok(Shard { number, of }),
        Some((number, of)) => Err(format!("shard {number} of {of}; give 1/{of} to {of}/{of}")),
        None => Err(format!("{text:?} is not a shard; write I/N, as in 2/4 for the second of four")),
    }
}

/// Description of a run: all inputs that the outcomes depend on. It is the first line of a file of
/// results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Run {
    /// Version of umbrage.
    pub version: String,
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Budget of the maps.
    pub budget: String,
    /// Axes of the search.
    #[serde(rename = "try")]
    pub axes: Vec<Axis>,
    /// Settings of all candidates that do not override them.
    pub with: Vec<(String, String)>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// View depths that are scored, in metres.
    pub shadow_range: Option<(f64, f64)>,
    /// Angular diameter of the sun in degrees.
    pub sun_angle: Option<f64>,
    /// Fewest edge pixels of a view that counts.
    pub least_edges: usize,
    /// Views that all candidates are judged on.
    pub views: Vec<ViewName>,
    /// Candidates in the order of their numbers.
    pub candidates: Vec<Candidate>,
    /// Reasons why combinations were left out, and the number of combinations for each.
    pub skipped: BTreeMap<String, usize>,
    /// Shard of the candidates that are judged.
    pub shard: Shard,
}

/// Name of a view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewName {
    /// Scene as it was named.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Sun in words.
    pub sun: String,
    /// Number of the frame in its walk.
    pub frame: usize,
    /// Options of `umbrage render` that show the view.
    pub options: Vec<String>,
}

/// Scores of a candidate: one line of a file of results. Rates are shares in 0..=1.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Number of the candidate.
    pub candidate: usize,
    /// Bytes of all maps on the device.
    pub bytes: u64,
    /// Mean of the error rate E over the views that count.
    pub e: Option<f64>,
    /// Mean of E over bins of depth, E_log.
    pub e_log: Option<f64>,
    /// Rate of acne.
    pub acne: Option<f64>,
    /// Rate of leaks.
    pub leak: Option<f64>,
    /// Mean distance of edges in pixels, D.
    pub edge_distance_px: Option<f64>,
    /// Mean of F_edge over the walks that count; `None` if no camera moves.
    pub flicker: Option<f64>,
    /// Mean number of draw calls into maps, over the views that count.
    pub draws: Option<f64>,
    /// Scores of each view.
    pub views: Vec<ViewOutcome>,
}

/// Scores of a candidate in a view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewOutcome {
    /// Error rate E.
    pub e: Option<f64>,
    /// Number of edge pixels of the true shadow.
    pub edges: usize,
    /// True if the view counts in means.
    pub counts: bool,
}

/// Describes the scores of an outcome in words.
pub(super) fn figures(outcome: &Outcome) -> String {
    let percent = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{:.3} %", 100.0 * value));
    format!(
        "E {}, F_edge {}, {:.2} MiB of maps.",
        percent(outcome.e),
        percent(outcome.flicker),
        outcome.bytes as f64 / f64::from(1 << 20)
    )
}

/// Returns the scenes of a run.
pub(super) fn scenes(run: &Run) -> Vec<String> {
    let mut scenes: Vec<String> = run.views.iter().map(|view| view.scene.clone()).collect();
    scenes.dedup();
    scenes
}

/// Returns the views of the first outcome. The views, and which of them count, are the same for all
/// outcomes.
pub(super) fn views_of(outcomes: &[Outcome]) -> &[ViewOutcome] {
    outcomes.first().map_or(&[], |outcome| &outcome.views)
}
