//! The job of a comparison: techniques, scenes with their views, and outputs.

use std::path::{Path, PathBuf};

use super::shots::SceneShots;
use crate::{
    failure::{Failure, Result},
    output,
    technique::Technique,
};

/// Names of the files in `-o DIR`.
const IN_FOLDER: [&str; 4] = ["sheet.png", "errors.png", "scores.json", "compare.html"];

/// A comparison. Everything that can be is checked before a frame is drawn.
#[derive(Debug)]
pub struct Job {
    /// Techniques: the rows of tables and sheets.
    pub techniques: Vec<Technique>,
    /// Scenes, opened, with their views.
    pub scenes: Vec<SceneShots>,
    /// Settings of all techniques and views.
    pub settings: Settings,
    /// Output files.
    pub outputs: Outputs,
    /// Notes on parts that were left out.
    pub notes: Vec<String>,
    /// File in which finished views are kept while the run goes on. A run that was cut off
    /// continues from it.
    pub resume: Option<PathBuf>,
    /// Command as it was typed, for the report.
    pub command: Vec<String>,
}

/// Settings of all techniques and views.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// View depths in metres that are scored; `None` uses the camera's near and far.
    pub shadow_range: Option<(f64, f64)>,
    /// Angular diameter of the sun in degrees; `None` computes no soft scores.
    pub sun_angle: Option<f64>,
    /// Fewest edge pixels of the true shadow in a view that counts.
    pub least_edges: usize,
    /// Most columns of a sheet.
    pub columns: usize,
    /// True if pictures show each split in its own colour.
    pub tint: bool,
    /// True if FLIP and SSIM are computed for the shots on the sheets.
    pub image_metrics: bool,
}

/// Output files of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Folder for all files.
    pub folder: Option<PathBuf>,
    /// Paths of sheet, errors, JSON and page.
    pub files: [Option<PathBuf>; 4],
}

impl Outputs {
    /// Combines the folder for all files with the paths of sheet, errors, JSON and page.
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

    /// Refuses outputs that cannot be written, before any work is done.
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

    /// Stages the four files, in the order of [`Self::files`], for every place that was asked for.
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
