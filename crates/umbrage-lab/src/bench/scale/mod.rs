//! Costs of shadows in growing worlds: a forest of ever more trees, with and without kept maps.

mod gpu;
mod job;
mod measure;
mod page;
mod report;

pub use job::ScaleJob;

use std::path::Path;

use umbrage_render::{Gpu, GpuOptions};

use self::measure::measure;
use self::report::ScaleReport;
use crate::{
    failure::{Failure, Result},
    output::{self, Staged},
    progress,
    report::to_json,
};

/// Measures every case at every number of objects, and writes the outputs.
///
/// # Errors
/// [`Failure`] with the scene that cannot be drawn, or the file that cannot be written.
pub fn run(job: &ScaleJob) -> Result<()> {
    let files: Vec<&Path> = [&job.json, &job.html].into_iter().flatten().map(AsRef::as_ref).collect();
    if files.is_empty() {
        return Err(Failure::input("nothing to write: give -o HTML or --json JSON"));
    }
    if job.objects.is_empty() {
        return Err(Failure::input("--scale-limit leaves no number of objects; give a higher limit or --objects"));
    }
    output::check(&files, &[], &[])?;
    let gpu = Gpu::new(&GpuOptions::default())?;
    let bar = progress::steps(job.frames(), "frames");
    let mut report = ScaleReport {
        adapter: gpu.description(),
        size: job.size,
        rounds: job.rounds,
        technique: job.technique.label.clone(),
        sizes: Vec::new(),
    };
    for &objects in &job.objects {
        report.sizes.push(measure(&gpu, job, objects, &bar)?);
    }
    bar.finish_and_clear();
    let mut staged = Staged::default();
    if let Some(path) = &job.json {
        staged.file(path, to_json(&report)?)?;
    }
    if let Some(path) = &job.html {
        staged.file(path, page::page(&report)?.into_bytes())?;
    }
    staged.commit()
}
