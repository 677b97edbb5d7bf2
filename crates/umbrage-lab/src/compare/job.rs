//! What is to be compared: techniques, scenes with their views, and where the results go.

use std::path::{Path, PathBuf};

use super::shots::SceneShots;
use crate::{
    failure::{Failure, Result},
    output,
    technique::Technique,
};

/// Names of the files in `-o DIR`.
const IN_FOLDER: [&str; 4] = ["sheet.png", "errors.png", "scores.json", "compare.html"];

/// What is to be compared, everything checked that can be before a frame is drawn.
#[derive(Debug)]
pub struct Job {
    /// The rows.
    pub techniques: Vec<Technique>,
    /// Scenes, opened, with their views.
    pub scenes: Vec<SceneShots>,
    /// What holds for all of them.
    pub settings: Settings,
    /// Where things go.
    pub outputs: Outputs,
    /// What was left out.
    pub notes: Vec<String>,
    /// Where finished views are kept while the run goes on, and are taken from if one was cut off.
    pub resume: Option<PathBuf>,
    /// What was typed, for the report.
    pub command: Vec<String>,
}

/// What holds for all techniques and views.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// View depths in metres that are scored; none: the camera's near and far.
    pub shadow_range: Option<(f64, f64)>,
    /// Degrees across the sun; none: no soft scores.
    pub sun_angle: Option<f64>,
    /// Edge pixels of the true shadow that a view needs to count.
    pub least_edges: usize,
    /// Most columns of a sheet.
    pub columns: usize,
    /// Whether pictures show each split in its own colour.
    pub tint: bool,
    /// Whether FLIP and SSIM are worked out for the shots on the sheets.
    pub image_metrics: bool,
}

/// Where things go.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// The folder for everything.
    pub folder: Option<PathBuf>,
    /// Sheet, errors, JSON and page.
    pub files: [Option<PathBuf>; 4],
}

impl Outputs {
    /// The folder for everything, and the paths of sheet, errors, JSON and page.
    ///
    /// # Errors
    /// [`Failure::Input`] if nothing is to be written.
    pub fn new(folder: Option<PathBuf>, files: [Option<PathBuf>; 4]) -> Result<Self> {
        let outputs = Self { folder, files };
        if outputs.folder.is_none() && outputs.files.iter().all(Option::is_none) {
            return Err(Failure::input(
                "nothing to write: give -o DIR, or some of --sheet PNG, --errors PNG, --json JSON, --html HTML",
            ));
        }
        Ok(outputs)
    }

    /// Refuses what cannot be written, before any work is done.
    ///
    /// # Errors
    /// As [`output::check`].
    pub fn check(&self, inputs: &[&Path]) -> Result<()> {
        let mut files: Vec<PathBuf> = self.files.iter().flatten().cloned().collect();
        let mut folders = Vec::new();
        match &self.folder {
            // Into a folder that is there go single files, each of which may be in the way of
            // something.
            Some(folder) if folder.is_dir() => files.extend(IN_FOLDER.map(|name| folder.join(name))),
            Some(folder) => folders.push(folder.as_path()),
            None => {}
        }
        let files: Vec<&Path> = files.iter().map(AsRef::as_ref).collect();
        output::check(&files, &folders, inputs)
    }

    /// Stages the four files, in the order of [`Self::files`], wherever they were asked for.
    ///
    /// # Errors
    /// As [`output::Staged::file`].
    pub fn stage(&self, contents: [Vec<u8>; 4], staged: &mut output::Staged) -> Result<()> {
        for (path, bytes) in self.files.iter().zip(&contents) {
            if let Some(path) = path {
                staged.file(path, bytes.clone())?;
            }
        }
        if let Some(folder) = &self.folder {
            let files = IN_FOLDER.iter().map(|name| (*name).to_owned()).zip(contents).collect();
            staged.folder(folder, files)?;
        }
        Ok(())
    }
}
