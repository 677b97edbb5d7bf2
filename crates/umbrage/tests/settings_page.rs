//! `docs/settings.md` is made from the tables of settings, presets and rules.
//!
//! `UMBRAGE_BLESS=1 cargo test -p umbrage --test settings_page` writes it anew.

use std::fmt::Write as _;

use umbrage::config::{Kind, Preset, RULES, Rebuilds, SETTINGS, Setting};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/settings.md");

const HEAD: &str = "# Settings

`umbrage::ShadowConfig` holds everything that can be chosen about shadows. Each choice has a key. A
config file (TOML or JSON) has the keys as they stand here, the command has them as options behind
two dashes, and `umbrage compare` has them behind colons. `cargo test -p umbrage --test
settings_page` makes this page from the tables in `crates/umbrage/src/config`.

*Costs* says what a change makes anew while an application runs: nothing, its maps (textures and
bind groups), or its pipelines (shader texts).
";

fn values(kind: Kind) -> String {
    match kind {
        Kind::Words(words) => words.iter().map(|word| format!("`{}`", word.word)).collect::<Vec<_>>().join(", "),
        Kind::WordList(words) => {
            let words = words.iter().map(|word| format!("`{}`", word.word)).collect::<Vec<_>>().join(", ");
            format!("{words}; one, or one per split")
        }
        Kind::Share(most) => format!("0 to {most}"),
        Kind::Metres => "metres above 0".to_owned(),
        Kind::MetresList => "metres, with commas".to_owned(),
        Kind::Range => "`N..F` in metres".to_owned(),
        Kind::Degrees(most) => format!("0° to {most}°"),
        Kind::Count(least, most) => format!("{least} to {most}"),
        Kind::Texels => "texels; one, or one per split".to_owned(),
        Kind::Colour => "`R,G,B`, 0 to 1 each".to_owned(),
        Kind::Switch => "`true`, `false`".to_owned(),
    }
}

fn costs(rebuilds: Rebuilds) -> &'static str {
    match rebuilds {
        Rebuilds::Nothing => "nothing",
        Rebuilds::Maps => "maps",
        Rebuilds::Pipelines => "pipelines",
    }
}

fn shown(setting: &Setting, preset: Preset) -> String {
    setting.get(&preset.config()).map_or_else(|| "–".to_owned(), |value| format!("`{value}`"))
}

fn page() -> String {
    let mut page = HEAD.to_owned();
    let _ = writeln!(page, "\n## Presets\n");
    for word in Preset::WORDS {
        let _ = writeln!(page, "* `{}`: {}.", word.word, word.help.trim());
    }
    let differ = |setting: &&Setting| Preset::ALL.iter().any(|p| shown(setting, *p) != shown(setting, Preset::ALL[0]));
    let head: Vec<String> = Preset::ALL.iter().map(|preset| format!("`{preset}`")).collect();
    let _ = writeln!(page, "\nWhere they differ:\n\n| key | {} |", head.join(" | "));
    let _ = writeln!(page, "|---|{}", "---|".repeat(Preset::ALL.len()));
    for setting in SETTINGS.iter().filter(differ) {
        let cells: Vec<String> = Preset::ALL.iter().map(|preset| shown(setting, *preset)).collect();
        let _ = writeln!(page, "| `{}` | {} |", setting.key, cells.join(" | "));
    }
    let _ = writeln!(page, "\n## Settings\n\n| key | meaning | values | default | costs |\n|---|---|---|---|---|");
    for setting in SETTINGS {
        let (key, help, cost) = (setting.key, setting.help, costs(setting.rebuilds));
        let (values, default) = (values(setting.kind), shown(setting, Preset::Balanced));
        let _ = writeln!(page, "| `{key}` | {help} | {values} | {default} | {cost} |");
    }
    let _ = writeln!(page, "\n## What excludes what\n");
    let _ = writeln!(page, "A setting that nobody asked for gives way to one that somebody did, with a note. Two that");
    let _ = writeln!(page, "were asked for are an error.\n\n| choice | excludes | because | do |\n|---|---|---|---|");
    for rule in RULES {
        let (first, second) = (name(rule.first), name(rule.second));
        let _ = writeln!(page, "| {first} | {second} | {} | {} |", rule.reason, rule.remedy);
    }
    page
}

/// `MapSelection` as `map selection`.
fn name(choice: umbrage::config::Choice) -> String {
    let mut name = String::new();
    for letter in format!("{choice:?}").chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push(' ');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

#[test]
fn the_page_of_settings_is_what_the_tables_say() {
    if std::env::var("UMBRAGE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(PAGE, page()).unwrap();
    }
    let written = std::fs::read_to_string(PAGE).unwrap();
    assert!(written == page(), "docs/settings.md is out of date; run this test with UMBRAGE_BLESS=1");
}
