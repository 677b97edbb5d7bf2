//! Check for files of one target (a library, a program, a test) that use each other in a circle. A
//! module may use its parents.
//!
//! A path is a use of the file that defines the item, however many re-exports lie between.

mod modules;
mod names;
mod tests;

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use modules::Modules;

/// Pairs of files of which the first uses the second, each with the paths that do so.
type Uses = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// Uses among a target's files, without a module's uses of its parents.
fn uses_of(modules: &Modules) -> Uses {
    let files = modules.files();
    let is_parent = |from: &Path, to: &Path| files[from].starts_with(files[to]);
    modules.uses().into_iter().filter(|((from, to), _)| !is_parent(from, to)).collect()
}

/// Files that can be reached from `start`.
fn reached<'a>(start: &'a Path, uses: &'a Uses) -> BTreeSet<&'a Path> {
    let mut seen = BTreeSet::new();
    let mut next = vec![start];
    while let Some(file) = next.pop() {
        for (_, to) in uses.keys().filter(|(from, _)| from == file) {
            if seen.insert(to.as_path()) {
                next.push(to);
            }
        }
    }
    seen
}

/// Uses that are part of a circle, as `user -> used: paths`.
fn in_circles(uses: &Uses) -> Vec<String> {
    let mut lines = Vec::new();
    for ((from, to), paths) in uses {
        if reached(to, uses).contains(from.as_path()) {
            let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
            lines.push(format!("{} -> {}: {}", from.display(), to.display(), paths.join(", ")));
        }
    }
    lines
}
