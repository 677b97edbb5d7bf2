//! Completions and man pages: whole, and taken by the programs that read them.

mod common;

use std::{
    fs,
    io::Write as _,
    process::{Command, Stdio},
};

use clap::{CommandFactory, ValueEnum as _};
use clap_complete::Shell;
use common::{Folder, names};
use umbrage_cli::{
    args::Args,
    completions::script,
    man::{Page, pages},
};

/// A subcommand that the help lists, or the command itself: the words that name it, and its options
/// as they are typed.
struct Listed {
    path: Vec<String>,
    options: Vec<String>,
}

/// The command and all its subcommands.
fn listed() -> Vec<Listed> {
    let mut command = Args::command().disable_help_subcommand(true);
    command.build();
    let mut found = Vec::new();
    list(&command, &[], &mut found);
    found
}

fn list(command: &clap::Command, path: &[String], found: &mut Vec<Listed>) {
    let options = command.get_arguments().filter_map(|arg| arg.get_long()).map(|long| format!("--{long}")).collect();
    found.push(Listed { path: path.to_vec(), options });
    for subcommand in command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()) {
        list(subcommand, &[path, &[subcommand.get_name().to_owned()]].concat(), found);
    }
}

/// Returns whether `text` has the word: no letter, digit or hyphen follows it.
fn has_word(text: &str, word: &str) -> bool {
    let ends = |rest: &str| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '-');
    text.match_indices(word).any(|(at, _)| ends(&text[at + word.len()..]))
}

/// The part of a script that completes one subcommand.
fn part(shell: Shell, script: &str, path: &[String]) -> String {
    let after = |begin: &str, end: &str| {
        let at = script.find(begin).unwrap_or_else(|| panic!("{shell}: no part begins with {begin:?}"));
        let rest = &script[at + begin.len()..];
        rest[..rest.find(end).unwrap_or(rest.len())].to_owned()
    };
    let name = path.last().map(String::as_str);
    match shell {
        Shell::Bash => {
            let names: Vec<&str> = path.iter().map(String::as_str).collect();
            let label = ["umbrage"].iter().chain(&names).copied().collect::<Vec<_>>().join("__subcmd__");
            after(&format!("\n        {label})"), "\n        umbrage")
        }
        Shell::Zsh => name.map_or_else(
            || after("\n    _arguments ", "case $state in"),
            |name| after(&format!("({name})\n_arguments "), "\n;;"),
        ),
        Shell::Fish => {
            let is_of = |line: &str| match (path, line.split_once("using_subcommand ")) {
                ([], _) => line.contains("needs_command"),
                (_, Some((_, rest))) => path.iter().all(|name| has_word(rest, name)),
                (_, None) => false,
            };
            script.lines().filter(|line| is_of(line)).map(|line| line.replace("-l ", "--") + "\n").collect()
        }
        _ => {
            let key = ["umbrage"].into_iter().chain(path.iter().map(String::as_str)).collect::<Vec<_>>().join(";");
            let begin = if shell == Shell::Elvish { format!("&'{key}'= {{") } else { format!("\n        '{key}' {{") };
            after(&begin, "\n        }")
        }
    }
}

/// What the script of a shell lacks.
fn lacking(shell: Shell, script: &str) -> Vec<String> {
    let mut found = Vec::new();
    for Listed { path, options } in listed() {
        let part = part(shell, script, &path);
        found.extend(
            options.iter().filter(|option| !has_word(&part, option)).map(|it| format!("{shell}: {path:?} {it}")),
        );
    }
    found
}

#[test]
fn completions_have_every_subcommand_and_option() {
    for &shell in Shell::value_variants() {
        let script = script(shell, Args::command()).expect("a script");
        assert_eq!(lacking(shell, &script), [""; 0]);
        // And the words of a setting, where scripts have more than options.
        let has_words = !matches!(shell, Shell::PowerShell | Shell::Elvish);
        assert!(!has_words || has_word(&script, "pcf5"), "{shell}");
    }
}

#[test]
fn a_script_without_an_option_is_seen() {
    for &shell in Shell::value_variants() {
        let whole = script(shell, Args::command()).expect("a script");
        let option = if shell == Shell::Fish { "-l splits " } else { "--splits" };
        let less = whole.replacen(option, "-x ", 1);
        assert_ne!(less, whole, "{shell}");
        let without = whole.replace(option, "-x ");
        let found = lacking(shell, &without);
        assert!(found.iter().any(|line| line.contains("render") && line.ends_with("--splits")), "{shell}: {found:?}");
    }
}

/// What a shell that is installed says of a script by this option; `None` where it is not.
fn refusal(shell: Shell, program: &str, option: &str) -> Option<String> {
    let mut command = Command::new(program);
    command.arg(option).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let Ok(mut child) = command.spawn() else {
        eprintln!("SKIPPED: no {program}, which would read its completions");
        return None;
    };
    let script = script(shell, Args::command()).expect("a script");
    // A shell that has found an error reads no further.
    drop(child.stdin.take().expect("a pipe").write_all(script.as_bytes()));
    let output = child.wait_with_output().expect("it ends");
    Some(if output.status.success() { String::new() } else { String::from_utf8_lossy(&output.stderr).into_owned() })
}

#[test]
fn shells_take_their_scripts() {
    for (shell, program, option) in
        [(Shell::Bash, "bash", "-n"), (Shell::Zsh, "zsh", "-n"), (Shell::Fish, "fish", "-n")]
    {
        if let Some(refusal) = refusal(shell, program, option) {
            assert_eq!(refusal, "", "{program}");
        }
    }
    // A shell says no where it has to.
    if let Some(refusal) = refusal(Shell::Fish, "bash", "-n") {
        assert_ne!(refusal, "", "bash takes the script of fish");
    }
}

/// What bash offers after these words.
fn offered(words: &[&str], begun: &str) -> Option<Vec<String>> {
    let script = script(Shell::Bash, Args::command()).expect("a script");
    let before = words.last().copied().unwrap_or_default();
    let ask = format!(
        "{script}\nCOMP_WORDS=({} {begun})\nCOMP_CWORD={}\n_umbrage umbrage '{begun}' '{before}'\nprintf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
        words.join(" "),
        words.len()
    );
    let output = Command::new("bash").args(["--norc", "-c", &ask]).output().ok()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect())
}

#[test]
fn bash_offers_what_there_is() {
    let Some(subcommands) = offered(&["umbrage"], "") else {
        eprintln!("SKIPPED: no bash");
        return;
    };
    for Listed { path, options } in listed() {
        if let [name] = &path[..] {
            assert!(subcommands.contains(name), "{name}: {subcommands:?}");
        }
        let words: Vec<&str> = ["umbrage"].into_iter().chain(path.iter().map(String::as_str)).collect();
        let offered = offered(&words, "--").expect("there is a bash");
        for option in &options {
            assert!(offered.contains(option), "{words:?} {option}: {offered:?}");
        }
    }
    let schemes = offered(&["umbrage", "render", "--scheme"], "").expect("there is a bash");
    assert!(schemes.iter().any(|word| word == "practical"), "{schemes:?}");
}

/// The text of a page as it is read: without fonts and escapes.
fn plain(page: &Page) -> String {
    ["\\fB", "\\fI", "\\fR"].iter().fold(page.text.replace("\\-", "-"), |text, font| text.replace(font, " "))
}

/// What the pages lack.
fn lacking_of_pages(pages: &[Page]) -> Vec<String> {
    let mut found = Vec::new();
    for Listed { path, options } in listed() {
        let file = ["umbrage"].into_iter().chain(path.iter().map(String::as_str)).collect::<Vec<_>>().join("-") + ".1";
        match pages.iter().find(|page| page.file == file).map(plain) {
            Some(text) => found.extend(
                options.iter().filter(|option| !has_word(&text, option)).map(|it| format!("{file} lacks {it}")),
            ),
            None => found.push(format!("there is no {file}")),
        }
    }
    found
}

#[test]
fn man_pages_have_every_subcommand_and_option() {
    let pages = pages(Args::command()).expect("pages");
    assert_eq!(lacking_of_pages(&pages), [""; 0]);
    assert_eq!(pages.len(), listed().len(), "one for each");
    let first = plain(&pages[0]);
    for Listed { path, .. } in listed() {
        if let [name] = &path[..] {
            assert!(first.contains(&format!("umbrage-{name}(1)")), "umbrage.1 names {name}");
        }
    }

    // Pages that lack something are seen.
    let mut less = pages.clone();
    let render = less.iter_mut().find(|page| page.file == "umbrage-render.1").expect("a page");
    render.text = render.text.replace("\\-\\-sun\\fR", "");
    less.retain(|page| page.file != "umbrage-worlds-export.1");
    assert_eq!(lacking_of_pages(&less), ["umbrage-render.1 lacks --sun", "there is no umbrage-worlds-export.1"]);
}

#[test]
fn the_command_prints_and_writes_them() {
    let folder = Folder::new();
    for &shell in Shell::value_variants() {
        let output = folder.run(&format!("completions {shell}"));
        assert!(output.status.success(), "{}", common::stderr(&output));
        assert_eq!(String::from_utf8_lossy(&output.stdout), script(shell, Args::command()).expect("a script"));
    }
    folder.refuse("completions cmd", &["cmd", "bash"]);
    folder.refuse("completions", &["SHELL"]);

    let pages = pages(Args::command()).expect("pages");
    let output = folder.run("man");
    assert_eq!(String::from_utf8_lossy(&output.stdout), pages[0].text);
    folder.refuse("man tiny.glb", &["tiny.glb", "not a folder"]);
    folder.refuse("man none/man1", &["none/man1"]);
    // Beside other pages, and over those of a former version.
    fs::create_dir(folder.at("man1")).expect("a folder");
    fs::write(folder.at("man1/other.1"), "other").expect("another page");
    fs::write(folder.at("man1/umbrage.1"), "old").expect("an old page");
    folder.succeed("man man1");
    let mut expected: Vec<String> = pages.iter().map(|page| page.file.clone()).collect();
    expected.push("other.1".to_owned());
    expected.sort();
    assert_eq!(names(&folder.at("man1")), expected);
    for page in &pages {
        assert_eq!(fs::read_to_string(folder.at("man1").join(&page.file)).expect("a page"), page.text);
    }
}
