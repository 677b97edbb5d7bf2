//! The job of a benchmark.

use std::path::PathBuf;

use umbrage::config::Filter;
use umbrage_render::Samples;

use crate::{scene_request::SceneRequest, technique::Technique};

/// Techniques and scenes to measure, and the outputs.
#[derive(Debug)]
pub struct Job {
    /// Scenes, each with its camera and light.
    pub scenes: Vec<SceneRequest>,
    /// Techniques. The results of the others are divided by those of the first.
    pub techniques: Vec<Technique>,
    /// Settings of all techniques that do not override them, for the report.
    pub with: String,
    /// Number of measured rounds, after one that is not measured.
    pub rounds: u32,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel of the picture.
    pub samples: Samples,
    /// Numbers of objects for GPU Gems' Figure 10-9.
    pub objects: Vec<u32>,
    /// True if every pair of generation and storage is measured too.
    pub paths: bool,
    /// Settings of these pairs.
    pub paths_with: String,
    /// File of the results (JSON).
    pub json: Option<PathBuf>,
    /// File of the page.
    pub html: Option<PathBuf>,
}

/// Returns four maps of 1024² under every filter, PCF 2×2 first, as text.
#[must_use]
pub fn filter_techniques() -> Vec<String> {
    let rest = Filter::ALL.into_iter().filter(|filter| *filter != Filter::Pcf2);
    [Filter::Pcf2]
        .into_iter()
        .chain(rest)
        .map(|filter| filter.word())
        .map(|name| format!("pssm:4:1024:filter={name}:label={name}"))
        .collect()
}
