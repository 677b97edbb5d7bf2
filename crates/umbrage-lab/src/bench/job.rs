//! What is to be measured.

use std::path::PathBuf;

use umbrage::config::Filter;
use umbrage_render::Samples;

use crate::{scene_request::SceneRequest, technique::Technique};

/// Techniques on scenes, and where the figures go.
#[derive(Debug)]
pub struct Job {
    /// The scenes, each with its camera and light.
    pub scenes: Vec<SceneRequest>,
    /// The techniques; the first is what the others are divided by.
    pub techniques: Vec<Technique>,
    /// Settings of all techniques that do not say otherwise, for the report.
    pub with: String,
    /// Rounds that are measured, after one that is not.
    pub rounds: u32,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Samples per pixel of the picture.
    pub samples: Samples,
    /// Numbers of objects for GPU Gems' Figure 10-9.
    pub objects: Vec<u32>,
    /// Whether every pair of generation and storage is measured too.
    pub paths: bool,
    /// Settings of those pairs.
    pub paths_with: String,
    /// The figures (JSON).
    pub json: Option<PathBuf>,
    /// The page.
    pub html: Option<PathBuf>,
}

/// Four maps of 1024² under every filter, PCF 2×2 first, as text.
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
