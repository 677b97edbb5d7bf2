//! `cargo xtask results`: writes docs/results.md from results of one build.
//!
//! The jobs run one after the other. Each leaves its results, with the build that was measured, in
//! `docs/results/NAME.json`. The page is rendered from these files alone, and only if all of them
//! belong to one build.

mod jobs;
mod kept;
mod quoted;
mod render;
mod table;

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::Instant,
};

use anyhow::{Context, Result, bail};
use serde::{Serialize, de::DeserializeOwned};

use self::{
    jobs::{JOBS, Job, Kind, Scale},
    kept::{Bench, Build, Comparison, Kept},
    render::Figures,
};
use crate::{
    adapter,
    run::{build_umbrage, output, root, run},
};

/// Task of `cargo xtask results`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Run all jobs, then render.
    All,
    /// Run the jobs whose kept results belong to another build, then render. This continues an
    /// interrupted run.
    Resume,
    /// Render from the kept results.
    Render,
    /// Run all jobs at the smallest size into out/results, and render there. This proves that jobs
    /// and page fit each other.
    Tiny,
}

/// Runs a task.
pub fn results(ask: Ask) -> Result<()> {
    let (folder, page, scale) = match ask {
        Ask::Tiny => (root().join("out/results"), root().join("out/results/results.md"), Scale::Tiny),
        _ => (kept_folder(), page_file(), Scale::Full),
    };
    if ask != Ask::Render {
        fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        measure(&folder, scale, ask == Ask::Resume)?;
    }
    let figures = Figures::read(&folder)?;
    fs::write(&page, render::page(&figures, scale)?).with_context(|| format!("cannot write {}", page.display()))?;
    if scale == Scale::Full {
        quoted::write(&root(), &figures)?;
    }
    eprintln!("xtask: wrote {}", page.display());
    Ok(())
}

/// Returns the folder of the kept results.
fn kept_folder() -> PathBuf {
    root().join("docs/results")
}

/// Returns the path of the page.
fn page_file() -> PathBuf {
    root().join("docs/results.md")
}

/// Runs the jobs. A page for the documents needs a commit that identifies the measured build, so
/// tracked files may not differ from it.
fn measure(folder: &Path, scale: Scale, resume: bool) -> Result<()> {
    let umbrage = build_umbrage(scale == Scale::Full)?;
    let build = build(&umbrage)?;
    if scale == Scale::Full && build.commit.ends_with('+') {
        bail!("tracked files differ from the commit that the page would name; commit them first");
    }
    for job in JOBS {
        let file = file_of(folder, &job);
        if resume && is_of(&file, &build) {
            eprintln!("xtask: {} is of this build", file.display());
            continue;
        }
        match job.kind {
            Kind::Compare => keep::<Comparison>(&umbrage, &job, scale, &build, &file),
            Kind::Bench => keep::<Bench>(&umbrage, &job, scale, &build, &file),
        }
        .with_context(|| format!("job {}", job.name))?;
    }
    Ok(())
}

/// Runs one job and writes its kept results.
fn keep<T: Serialize + DeserializeOwned>(
    umbrage: &Path,
    job: &Job,
    scale: Scale,
    build: &Build,
    file: &Path,
) -> Result<()> {
    let report = file.with_extension("report.tmp");
    let begin = Instant::now();
    run(Command::new(umbrage).current_dir(root()).args(job.words(scale)).arg("--json").arg(&report))?;
    let seconds = begin.elapsed().as_secs();
    let figures: T = read(&report)?;
    let kept = Kept { build: build.clone(), command: job.shown(scale), seconds, figures };
    fs::write(file, compact(&serde_json::to_value(&kept)?))
        .with_context(|| format!("cannot write {}", file.display()))?;
    fs::remove_file(&report).with_context(|| format!("cannot remove {}", report.display()))?;
    eprintln!("xtask: {} took {seconds} s of the {} min that are meant for it", job.name, job.minutes);
    Ok(())
}

/// Returns the path of a job's kept results.
fn file_of(folder: &Path, job: &Job) -> PathBuf {
    folder.join(job.name).with_extension("json")
}

/// Returns whether there are results of this build.
fn is_of(file: &Path, build: &Build) -> bool {
    read::<Kept<serde_json::Value>>(file).is_ok_and(|kept| kept.build == *build)
}

/// Reads JSON. Errors name the file, the line and the key.
fn read<T: DeserializeOwned>(file: &Path) -> Result<T> {
    let text = fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{} is not what is kept of a job", file.display()))
}

/// Returns the build that is about to be measured.
fn build(umbrage: &Path) -> Result<Build> {
    let git = |arguments: &[&str]| output(Command::new("git").current_dir(root()).args(arguments));
    // What the jobs write themselves is no difference.
    let differs =
        !git(&["status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/results", ":!docs/results.md"])?
            .is_empty();
    Ok(Build {
        commit: git(&["rev-parse", "--short=10", "HEAD"])? + if differs { "+" } else { "" },
        day: git(&["show", "--no-patch", "--format=%cs", "HEAD"])?,
        adapter: adapter::ensure(umbrage)?,
    })
}

/// Writes JSON with one line for each value that holds no object with arrays, so that the file is
/// short and a changed number is a changed line.
fn compact(value: &serde_json::Value) -> String {
    let mut text = String::new();
    write(&mut text, value, 0);
    text.push('\n');
    text
}

fn write(text: &mut String, value: &serde_json::Value, depth: usize) {
    let entries: Vec<(String, &serde_json::Value)> = match value {
        serde_json::Value::Object(map) if depth < 2 => {
            map.iter().map(|(key, value)| (format!("{}: ", serde_json::Value::from(key.as_str())), value)).collect()
        }
        serde_json::Value::Array(items) if items.iter().any(serde_json::Value::is_object) && depth < 3 => {
            items.iter().map(|value| (String::new(), value)).collect()
        }
        flat => return text.push_str(&flat.to_string()),
    };
    let (open, close) = if value.is_object() { ('{', '}') } else { ('[', ']') };
    text.push(open);
    for (index, (key, value)) in entries.iter().enumerate() {
        text.push_str(if index == 0 { "\n" } else { ",\n" });
        text.push_str(&" ".repeat(depth + 1));
        text.push_str(key);
        write(text, value, depth + 1);
    }
    text.push('\n');
    text.push_str(&" ".repeat(depth));
    text.push(close);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compact_json_is_the_same_json() {
        let value = serde_json::json!({
            "build": {"commit": "c", "day": "d"},
            "figures": {"size": [1, 2], "views": [{"scores": [{"e": 0.5}, {"e": null}]}, {"scores": []}], "walks": []},
        });
        let text = compact(&value);
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).expect("it is JSON"), value);
        assert!(text.lines().count() < 16, "{text}");
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let error = read::<Kept<Bench>>(Path::new("no/such.json")).expect_err("there is none");
        assert!(format!("{error:#}").contains("no/such.json"), "{error:#}");
    }
}
