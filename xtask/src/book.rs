//! `cargo xtask book`: the book in `book/`, as pages for a browser, and its pictures.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result};

use crate::{
    adapter,
    run::{build_umbrage, cargo, root, run, succeeds},
};

/// Folder of the pictures.
const PICTURES_FOLDER: &str = "book/src/images";
const EXAMPLES_FOLDER: &str = "crates/umbrage-wgpu/examples";
const EXAMPLES_PICTURES_FOLDER: &str = "docs/images/examples";

/// A picture of the book and the command that draws it: words after `umbrage`, without the file.
struct Picture {
    name: &'static str,
    words: &'static str,
}

const SIZE: &str = "--size 640x360";

/// All pictures, in the order of the book. Pictures of symptoms name the setting that provokes
/// them, as the book does.
const PICTURES: [Picture; 7] = [
    Picture { name: "one-map", words: "render robot-war --camera near --technique ssm --preset papers" },
    Picture { name: "four-splits", words: "render robot-war --camera near --tint" },
    Picture { name: "floating", words: "render robot-war --camera near --preset papers --bias slope --filter pcf7" },
    Picture {
        name: "seam",
        words: "render robot-war --camera near --preset papers --transition hard --splits 2 --map-size 256",
    },
    Picture { name: "cut-off", words: "render robot-war --camera near --shadow-range 1..60 --far-fade 0" },
    Picture {
        name: "leak",
        words: "render robot-war --camera near --preset papers --shadow-range 1..120 --filter esm --filter-width 1",
    },
    Picture { name: "blur", words: "render robot-war --camera near --preset papers" },
];

/// Builds the book into `out/book`; installs `mdbook` below the target folder where there is none.
pub fn build() -> Result<()> {
    let mdbook = mdbook()?;
    run(Command::new(mdbook).current_dir(root()).args(["build", "book"]))?;
    eprintln!("xtask: look at {} with a browser", root().join("out/book/index.html").display());
    Ok(())
}

/// Redraws the pictures of the book and those of the examples.
pub fn draw() -> Result<()> {
    let umbrage = build_umbrage(true)?;
    adapter::ensure(&umbrage)?;
    let folder = root().join(PICTURES_FOLDER);
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for picture in PICTURES {
        let file = folder.join(picture.name).with_extension("png");
        let words = picture.words.split_whitespace().chain(SIZE.split_whitespace());
        run(Command::new(&umbrage).current_dir(root()).args(words).arg("-o").arg(file))?;
    }
    for name in ["bias.svg", "split-views.png", "stillness.png"] {
        copy(&root().join("docs/images").join(name), &folder.join(name))?;
    }
    let folder = root().join(EXAMPLES_PICTURES_FOLDER);
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for name in examples()? {
        let file = folder.join(&name).with_extension("png");
        let example = ["run", "-p", "umbrage-wgpu", "--example", &name, "--", "--picture"];
        run(cargo().args(example).arg(file))?;
    }
    Ok(())
}

/// Returns the names of the examples.
fn examples() -> Result<Vec<String>> {
    let folder = root().join(EXAMPLES_FOLDER);
    let entries = fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names = Vec::new();
    for entry in entries {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "rs") {
            names.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::copy(from, to).with_context(|| format!("cannot copy {} to {}", from.display(), to.display()))?;
    Ok(())
}

/// Returns the program `mdbook`: the one on the path, or one that is installed here.
fn mdbook() -> Result<PathBuf> {
    let on_path = PathBuf::from("mdbook");
    if succeeds(Command::new(&on_path).arg("--version")) {
        return Ok(on_path);
    }
    let folder = root().join("target/tools");
    let own = folder.join("bin").join(format!("mdbook{}", env::consts::EXE_SUFFIX));
    if !own.is_file() {
        run(cargo().args(["install", "mdbook", "--locked", "--version", MDBOOK, "--root"]).arg(&folder))?;
    }
    Ok(own)
}

/// Version of `mdbook` that the book is written for.
const MDBOOK: &str = "0.5";

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn pages() -> Vec<(PathBuf, String)> {
        let folder = root().join("book/src");
        let entries = fs::read_dir(&folder).expect("the book").map(|entry| entry.expect("an entry").path());
        let pages = entries.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
        pages.map(|path| (path.clone(), fs::read_to_string(path).expect("a page is text"))).collect()
    }

    #[test]
    fn every_page_is_in_the_summary() {
        let summary = fs::read_to_string(root().join("book/src/SUMMARY.md")).expect("the summary");
        for (path, _) in pages() {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            assert!(name == "SUMMARY.md" || summary.contains(&format!("({name})")), "{name}");
        }
    }

    #[test]
    fn pictures_are_shown_and_say_what_provokes_them() {
        let text: String = pages().into_iter().map(|(_, text)| text).collect();
        let mut names = BTreeSet::new();
        for Picture { name, words } in PICTURES {
            assert!(names.insert(name), "{name} twice");
            assert!(text.contains(&format!("(images/{name}.png)")), "{name} is not shown");
            assert!(words.starts_with("render "), "{words}");
        }
    }

    #[test]
    fn every_example_has_a_line_and_a_picture() {
        let table = fs::read_to_string(root().join(EXAMPLES_FOLDER).join("README.md")).expect("the table");
        let names = examples().expect("the examples");
        assert!(names.len() > 8, "{names:?}");
        for name in names {
            assert!(table.contains(&format!("[`{name}`]({name}.rs)")), "{name} has no line");
            let picture = root().join(EXAMPLES_PICTURES_FOLDER).join(&name).with_extension("png");
            assert!(table.contains(&format!("{EXAMPLES_PICTURES_FOLDER}/{name}.png)")), "{name} is not shown");
            assert!(picture.is_file(), "{} is missing; run `cargo xtask book --pictures`", picture.display());
        }
    }
}
