//! Tests of the page of results: its required content, and the cases in which it is refused.

use std::fs;

use serde_json::Value;

use super::*;
use crate::{
    results::{compact, kept_folder, page_file},
    run::root,
};

/// Text in place of the page until the jobs have run.
const UNMEASURED: &str = "\
# Results

No figures are kept of this version. `cargo xtask results` runs the jobs, up to 25 minutes on two
cores and Mesa's software driver, and writes this page. Figures of earlier builds stand beside the
decisions that rest on them: [notes](notes/README.md).
";

/// Writes kept results of tiny runs.
fn example() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for job in &JOBS {
        let file = file_of(&root().join("xtask/example-results"), job);
        fs::copy(&file, file_of(folder.path(), job)).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }
    folder
}

fn rendered(folder: &Path, scale: Scale) -> Result<String> {
    page(&Figures::read(folder)?, scale)
}

#[test]
fn the_page_has_every_section_and_every_command() {
    let folder = example();
    let page = rendered(folder.path(), Scale::Tiny).unwrap_or_else(|error| panic!("{error:#}"));
    for heading in ["Presets", "Error", "Dueling frusta", "Acne and leaks", "Stillness", "Filters", "Pictures"] {
        assert!(page.contains(&format!("\n## {heading}\n")), "{heading}\n{page}");
    }
    for job in &JOBS {
        assert!(page.contains(&job.shown(Scale::Tiny)), "{}", job.name);
    }
    let prose = page.lines().filter(|line| !line.starts_with('|') && !line.starts_with("umbrage "));
    prose.for_each(|line| assert!(line.chars().count() <= 100, "{line}"));
}

#[test]
fn a_page_without_a_figure_is_refused() {
    let folder = example();
    let mut removed = 0;
    for job in &JOBS {
        let file = file_of(folder.path(), job);
        let whole: Value = read(&file).expect("the example is JSON");
        for path in keys(&whole) {
            let mut less = whole.clone();
            let (last, parents) = path.split_last().expect("a key is somewhere");
            let object = parents.iter().fold(&mut less, |value, step| match step.parse::<usize>() {
                Ok(index) if value.is_array() => &mut value[index],
                _ => &mut value[step.as_str()],
            });
            object.as_object_mut().expect("keys are in objects").remove(last);
            fs::write(&file, compact(&less)).expect("the folder can be written");
            let error = rendered(folder.path(), Scale::Tiny).err();
            let error = format!("{:#}", error.unwrap_or_else(|| panic!("{}: without {path:?}", job.name)));
            assert!(error.contains(last.as_str()) || error.contains("soft"), "{path:?}: {error}");
            removed += 1;
        }
        fs::write(&file, compact(&whole)).expect("the folder can be written");
    }
    assert!(removed > 200, "{removed} keys");
    rendered(folder.path(), Scale::Tiny).expect("whole again");
}

/// Returns the paths of all keys, of the first item of each array.
fn keys(value: &Value) -> Vec<Vec<String>> {
    let below = |step: String, value: &Value| {
        keys(value).into_iter().map(move |path| [vec![step.clone()], path].concat()).collect::<Vec<_>>()
    };
    match value {
        Value::Object(map) => {
            map.iter().flat_map(|(key, value)| [vec![vec![key.clone()]], below(key.clone(), value)].concat()).collect()
        }
        Value::Array(items) => items.first().map_or_else(Vec::new, |item| below("0".into(), item)),
        _ => Vec::new(),
    }
}

#[test]
fn figures_of_two_builds_make_no_page() {
    let folder = example();
    let file = file_of(folder.path(), &JOBS[3]);
    let mut other: Value = read(&file).expect("the example is JSON");
    other["build"]["commit"] = "another".into();
    fs::write(&file, compact(&other)).expect("the folder can be written");
    let error = rendered(folder.path(), Scale::Tiny).expect_err("two builds").to_string();
    assert!(error.contains("another") && error.contains(JOBS[3].name), "{error}");
}

#[test]
fn the_page_in_the_documents_is_that_of_the_kept_figures() {
    let there = fs::read_to_string(page_file()).expect("docs/results.md");
    let expected = if file_of(&kept_folder(), &JOBS[0]).exists() {
        rendered(&kept_folder(), Scale::Full).unwrap_or_else(|error| panic!("{error:#}"))
    } else {
        UNMEASURED.to_owned()
    };
    assert!(there == expected, "docs/results.md is stale; `cargo xtask results --render` renders it");
}
