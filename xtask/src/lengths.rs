//! Check that sources have at most 500 lines.

use crate::{documents::sources, run::root};

/// Most lines of a source.
const MOST_LINES: usize = 500;

/// Sources with more lines, each with the reason.
const LONGER: [(&str, &str); 0] = [];

/// Messages about sources, given as path and number of lines, that are too long or listed in vain.
fn wrong_lengths(lengths: &[(String, usize)], longer: &[(&str, &str)]) -> Vec<String> {
    let is_listed = |path: &str| longer.iter().any(|(listed, _)| *listed == path);
    let mut wrong: Vec<String> = lengths
        .iter()
        .filter(|(path, lines)| *lines > MOST_LINES && !is_listed(path))
        .map(|(path, lines)| format!("{path} has {lines} lines; {MOST_LINES} are allowed"))
        .collect();
    for (listed, reason) in longer {
        if !lengths.iter().any(|(path, lines)| path == listed && *lines > MOST_LINES) {
            wrong.push(format!("{listed} is on the list of longer files ({reason}), but is not longer"));
        }
    }
    wrong
}

#[test]
fn sources_have_at_most_500_lines() {
    let lengths: Vec<(String, usize)> = sources(&["rs", "wesl"])
        .into_iter()
        .map(|(path, text)| {
            let inside = path.strip_prefix(root()).expect("sources lie in the repository");
            (inside.to_string_lossy().replace('\\', "/"), text.lines().count())
        })
        .collect();
    for folder in ["crates", "xtask", "integrations"] {
        assert!(lengths.iter().any(|(path, _)| path.starts_with(folder)), "no source in {folder}");
    }
    let wrong = wrong_lengths(&lengths, &LONGER);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn long_sources_and_stale_exceptions_are_found() {
    let lengths = [("short.rs".to_owned(), 500), ("long.rs".to_owned(), 501), ("listed.wesl".to_owned(), 600)];
    assert_eq!(wrong_lengths(&lengths, &[("listed.wesl", "generated")]), ["long.rs has 501 lines; 500 are allowed"]);
    for stale in ["short.rs", "gone.rs"] {
        let wrong = wrong_lengths(&lengths[..1], &[(stale, "why")]);
        assert_eq!(wrong, [format!("{stale} is on the list of longer files (why), but is not longer")]);
    }
}
