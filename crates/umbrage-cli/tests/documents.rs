//! Command lines that the documents show are ones that the command takes.

use std::{
    fs,
    path::{Path, PathBuf},
};

use clap::Parser;
use umbrage_cli::args::Args;

/// The repository's root.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Markdown files of the repository's documents: the root, `docs`, the book, each crate's README.
fn documents() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in ["", "docs", "docs/notes", "book/src"] {
        markdown(&root().join(folder), &mut found);
    }
    for entry in fs::read_dir(root().join("crates")).expect("the crates are there").flatten() {
        markdown(&entry.path(), &mut found);
    }
    found.sort();
    found
}

fn markdown(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    found.extend(
        entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|it| it == "md")),
    );
}

/// Command lines of `umbrage` in blocks of shell, each with its number.
fn command_lines(text: &str) -> Vec<(usize, String)> {
    let mut is_shell = false;
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            is_shell = language.trim() == "sh";
            continue;
        }
        // Neither remarks nor files of the shell are the command's.
        let command = line.split(" #").next().and_then(|line| line.split(" > ").next()).unwrap_or_default().trim();
        let command = command.strip_prefix("target/release/").unwrap_or(command);
        if is_shell && command.starts_with("umbrage ") {
            found.push((number, command.to_owned()));
        }
    }
    found
}

/// What the command says of a line that it does not take.
fn refusal(command: &str) -> Option<String> {
    let words: Vec<&str> = command.split_whitespace().collect();
    Args::try_parse_from(words).err().map(|error| error.to_string())
}

#[test]
fn documents_show_command_lines_that_are_taken() {
    let mut count = 0;
    for path in documents() {
        let text = fs::read_to_string(&path).expect("a document is text");
        for (number, command) in command_lines(&text) {
            if cfg!(not(feature = "view")) && command.starts_with("umbrage view") {
                continue;
            }
            count += 1;
            if let Some(refusal) = refusal(&command) {
                panic!("{}:{number}: `{command}`\n{refusal}", path.display());
            }
        }
    }
    assert!(count > 30, "only {count} command lines were found");
}

/// An indented block is one that a tool which wraps paragraphs takes for a paragraph.
#[test]
fn documents_have_no_indented_code() {
    for path in documents() {
        let text = fs::read_to_string(&path).expect("a document is text");
        assert_eq!(indented_code(&text), [0; 0], "lines of {}", path.display());
    }
}

/// Numbers of indented lines that follow an empty one outside of fences.
fn indented_code(text: &str) -> Vec<usize> {
    let mut is_fenced = false;
    let mut after_gap = true;
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        is_fenced ^= line.trim_start().starts_with("```");
        if !is_fenced && after_gap && line.starts_with("    ") && !line.trim().is_empty() {
            found.push(number);
        }
        after_gap = line.trim().is_empty();
    }
    found
}

#[test]
fn wrong_command_lines_and_indented_code_are_found() {
    let text = "```sh\numbrage render robot-war --no-such   # a remark\n```\n\n    umbrage plan robot-war\n";
    let lines = command_lines(text);
    assert_eq!(lines, [(2, "umbrage render robot-war --no-such".to_owned())]);
    assert!(refusal(&lines[0].1).is_some_and(|text| text.contains("--no-such")));
    assert_eq!(indented_code(text), [5]);
}
