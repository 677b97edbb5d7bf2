//! What must hold of the documents: links lead somewhere, and papers are cited by keys that are
//! explained.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use crate::run::root;

/// Folders whose files are no sources.
const LEFT_OUT: [&str; 4] = ["target", "out", ".git", "assets"];

/// All files below `folder` with one of these endings.
fn files(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry of a folder can be read").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            if !LEFT_OUT.contains(&name.as_str()) {
                files(&path, endings, found);
            }
        } else if path.extension().is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted)) {
            found.push(path);
        }
    }
}

fn sources(endings: &[&str]) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    files(&root(), endings, &mut found);
    found.sort();
    found.into_iter().map(|path| (path.clone(), fs::read_to_string(path).expect("sources are text"))).collect()
}

/// Targets of the links and pictures of a Markdown text that lie in the repository.
fn local_links(text: &str) -> Vec<String> {
    let mut code = false;
    let lines = text.lines().filter(|line| {
        if line.starts_with("```") {
            code = !code;
        }
        !code && !line.starts_with("    ")
    });
    let mut links = Vec::new();
    for line in lines {
        for (at, _) in line.match_indices("](") {
            if let Some((target, _)) = line[at + 2..].split_once(')') {
                links.push(target.to_owned());
            }
        }
    }
    links.retain(|link| !link.contains("://"));
    links
}

/// What GitHub makes of headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings =
        text.lines().filter_map(|line| line.strip_prefix('#')).map(|line| line.trim_start_matches('#').trim());
    headings
        .map(|heading| {
            let kept = heading.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
            kept.collect::<String>().to_lowercase().replace(' ', "-")
        })
        .collect()
}

/// The keys of papers in a text, as docs/papers.md forms them: a capital first and two digits last,
/// or one of the two without.
fn cited(text: &str) -> BTreeSet<String> {
    let mut keys = BTreeSet::new();
    for part in text.split('[').skip(1) {
        let Some((key, _)) = part.split_once(']') else { continue };
        // rustdoc wants brackets that are no links to be escaped.
        let key = key.trim_end_matches('\\');
        let letters = key.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-');
        let year = key.len() >= 5 && key.bytes().rev().take(2).all(|letter| letter.is_ascii_digit());
        let begins = key.starts_with(|letter: char| letter.is_ascii_uppercase());
        if letters && begins && (year || ["PCSM", "PSSM-GL"].contains(&key)) {
            keys.insert(key.to_owned());
        }
    }
    keys
}

/// The keys that docs/papers.md explains: first cells of its tables.
fn explained(papers: &str) -> BTreeSet<String> {
    let rows = papers.lines().filter_map(|line| line.strip_prefix("| [")?.split_once("] |"));
    rows.map(|(key, _)| key.to_owned()).collect()
}

#[test]
fn links_lead_somewhere() {
    let mut broken = Vec::new();
    for (path, text) in sources(&["md"]) {
        for link in local_links(&text) {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name("").join(file) };
            if !target.exists() {
                broken.push(format!("{}: no {link}", path.display()));
            } else if !anchor.is_empty() {
                // Anchors of a page that is rendered later cannot be looked up before.
                let is_results = target.ends_with("docs/results.md");
                let text = fs::read_to_string(&target).expect("anchors are in texts");
                if !is_results && !anchors(&text).contains(anchor) {
                    broken.push(format!("{}: no heading {link}", path.display()));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn papers_are_cited_by_keys_that_are_explained() {
    let papers = fs::read_to_string(root().join("docs/papers.md")).expect("docs/papers.md");
    let explained = explained(&papers);
    assert!(explained.len() > 20, "{explained:?}");
    let mut unknown = Vec::new();
    for (path, text) in sources(&["md", "rs", "wesl", "wgsl"]) {
        unknown.extend(cited(&text).difference(&explained).map(|key| format!("{}: [{key}]", path.display())));
    }
    unknown.retain(|entry| !entry.contains("xtask/src/documents.rs"));
    assert!(unknown.is_empty(), "not in docs/papers.md:\n{}", unknown.join("\n"));
}

#[test]
fn links_and_keys_are_found() {
    let text = "a [b](c.md#d) ![e](f.png) [g](https://h)\n```\n[i](j)\n```\n    [k](l)\n";
    assert_eq!(local_links(text), ["c.md#d", "f.png"]);
    assert!(
        anchors("# Acne and leaks\n## `Code`, too")
            .is_superset(&BTreeSet::from(["acne-and-leaks", "code-too"].map(str::to_owned)))
    );
    assert_eq!(cited("[PSSM06] eq. 1, [Self], [0], [x86], &[DVec3], [PCSM]").len(), 2);
    assert_eq!(explained("| key | paper |\n| [GG3-10] | F. Zhang |\n"), BTreeSet::from(["GG3-10".to_owned()]));
}

/// Columns that a line of prose may have.
const MOST_COLUMNS: usize = 100;

/// Numbers of the lines of prose that are too long: of a Markdown text's all but code, tables and
/// links, of a source's comments.
fn long_lines(text: &str, is_markdown: bool) -> Vec<usize> {
    let mut code = false;
    let mut long = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let prose = match (is_markdown, line.trim_start().strip_prefix("//")) {
            (true, _) => line,
            (false, Some(comment)) => comment.trim_start_matches(['/', '!']).trim_start(),
            (false, None) => {
                code = false;
                continue;
            }
        };
        if prose.trim_start().starts_with("```") {
            code = !code;
        }
        let is_code = code || (is_markdown && line.starts_with("    "));
        let is_unbreakable = prose.trim_start().starts_with(['|', '!', '[']) || prose.contains("://");
        if !is_code && !is_unbreakable && line.chars().count() > MOST_COLUMNS {
            long.push(number);
        }
    }
    long
}

#[test]
fn prose_has_lines_of_at_most_100_columns() {
    let mut long = Vec::new();
    for (path, text) in sources(&["md", "rs", "wesl"]) {
        let is_markdown = path.extension().is_some_and(|ending| ending == "md");
        long.extend(long_lines(&text, is_markdown).iter().map(|line| format!("{}:{line}", path.display())));
    }
    assert!(long.is_empty(), "lines of more than {MOST_COLUMNS} columns:\n{}", long.join("\n"));
}

#[test]
fn long_lines_are_found_and_tables_are_not() {
    let long = "x ".repeat(60);
    assert_eq!(long_lines(&format!("{long}\n| {long} |\n```\n{long}\n```\n    {long}\n{long}"), true), [1, 7]);
    assert_eq!(long_lines(&format!("let x = 1; {long}\n/// {long}\n    // short\n//! | {long}"), false), [2]);
}

/// Items whose page begins with another item's: "The same …" means nothing to a reader who came by
/// a search.
#[test]
fn pages_of_items_stand_alone() {
    let mut found = Vec::new();
    for (path, text) in sources(&["rs"]) {
        for (number, line) in (1..).zip(text.lines()) {
            let comment = line.trim_start();
            if ["/// ", "//! "]
                .iter()
                .any(|mark| comment.strip_prefix(mark).is_some_and(|it| it.starts_with("The same")))
            {
                found.push(format!("{}:{number}", path.display()));
            }
        }
    }
    assert!(found.is_empty(), "items explained by another one:\n{}", found.join("\n"));
}

/// Crates in which the first word of every item's page is checked.
const CHECKED: [&str; 3] = ["umbrage", "umbrage-wgpu", "umbrage-shaders"];

/// First words of pages that do not name their subject.
const NO_SUBJECT: [&str; 9] = ["What", "Whether", "Where", "Which", "How", "Its", "That", "Those", "It"];

/// Numbers of the lines of a source on which an item's page begins without its subject.
fn pages_without_subject(text: &str) -> Vec<usize> {
    let opens_so = |page: &str| {
        let word = page.trim_start().split(|letter: char| !letter.is_alphabetic()).next();
        word.is_some_and(|word| NO_SUBJECT.contains(&word))
    };
    let mut is_in_page = false;
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let page = line.trim_start().strip_prefix("///");
        if !is_in_page && page.is_some_and(opens_so) {
            found.push(number);
        }
        is_in_page = page.is_some();
    }
    found
}

#[test]
fn pages_of_items_name_their_subject_first() {
    let mut found = Vec::new();
    for name in CHECKED {
        let mut paths = Vec::new();
        files(&root().join("crates").join(name).join("src"), &["rs"], &mut paths);
        for path in paths {
            let text = fs::read_to_string(&path).expect("sources are text");
            found.extend(pages_without_subject(&text).iter().map(|line| format!("{}:{line}", path.display())));
        }
    }
    assert!(found.is_empty(), "begin with the noun, as in \"Number of …\" or \"True if …\":\n{}", found.join("\n"));
}

#[test]
fn pages_without_subject_are_found() {
    let good = "/// Number of maps.\n/// What follows is no first line.\nmaps: u32,\n//! What a module does\n";
    assert!(pages_without_subject(good).is_empty());
    assert!(pages_without_subject("/// Whatever is left.\n\n/// `It` is a name.\n// What is no page").is_empty());
    let bad = "/// How many there are.\nmaps: u32,\n    /// It's dark\n    /// there.\n    dark: bool,\n///Which\n";
    assert_eq!(pages_without_subject(bad), [1, 3, 6]);
}
