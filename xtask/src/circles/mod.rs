//! Files of one target that use each other in a circle. A module may use its parents.
//!
//! A path counts as a use of the file that defines what it names, however many re-exports lie
//! between.

mod modules;
mod names;
mod tests;

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use modules::Modules;

/// Which files each file uses, and by which paths.
type Uses = BTreeMap<(PathBuf, PathBuf), BTreeSet<String>>;

/// The uses among a target's files, but for those of a module's parents.
fn uses_of(modules: &Modules) -> Uses {
    let files = modules.files();
    let is_parent = |from: &Path, to: &Path| files[from].starts_with(files[to]);
    modules.uses().into_iter().filter(|((from, to), _)| !is_parent(from, to)).collect()
}

/// The files that can be reached from `start`.
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

/// The uses that are part of a circle: `user -> used: paths`.
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
