//! `docs/settings.md` is made from the tables of settings, presets and rules.
//!
//! `UMBRAGE_BLESS=1 cargo test -p umbrage --test settings_page` writes it again.

use std::fmt::Write as _;

use umbrage::config::{Choice, Kind, Preset, RULES, Rebuilds, SETTINGS, Setting, Word};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/settings.md");

const HEAD: &str = "# Settings

`umbrage::ShadowConfig` holds all settings. Each has a key, written `filter = \"pcf5\"` in a config
file (TOML or JSON), `--filter pcf5` on the command line, and `:filter=pcf5` in a technique of
`umbrage compare`. A dash means that the default preset does not use the setting. `cargo test -p
umbrage --test settings_page` makes this page from the tables in `crates/umbrage/src/config`.

In Rust a setting is a field of `ShadowConfig`, or part of one: settings that exclude each other are
variants of one enum. `ShadowConfig::apply` takes keys and values as listed here.

*Costs* says what an application rebuilds when the setting changes at run time: nothing, the maps
(textures and bind groups), or the pipelines.
";

/// Words as a list.
fn listed(words: &[Word]) -> String {
    words.iter().map(|word| format!("`{}`", word.word)).collect::<Vec<_>>().join(", ")
}

fn values(kind: Kind) -> String {
    match kind {
        Kind::Words(words) => listed(words),
        Kind::WordList(words) => format!("{}; one, or one per split", listed(words)),
        Kind::Share(most) => format!("0 to {most}"),
        Kind::Metres => "metres above 0".to_owned(),
        Kind::MetresList => "metres, with commas".to_owned(),
        Kind::Range => "`N..F` in metres".to_owned(),
        Kind::Degrees(most) => format!("0° to {most}°"),
        Kind::Count(least, most) => format!("{least} to {most}"),
        Kind::CountOf(counts) => counts.iter().map(|count| format!("`{count}`")).collect::<Vec<_>>().join(", "),
        Kind::Texels => "texels; one, or one per split".to_owned(),
        Kind::Colour => "`R,G,B`, 0 to 1 each".to_owned(),
        Kind::Switch => "`on`, `off`".to_owned(),
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
    let _ = writeln!(
        page,
        "If a setting that you gave excludes one that you did not give, the latter is reset and a note says"
    );
    let _ = writeln!(page, "so. If you gave both, it is an error.\n\n| setting | excludes | because | instead |");
    let _ = writeln!(page, "|---|---|---|---|");
    for rule in RULES {
        let (first, second) = (name(rule.first), name(rule.second));
        let _ = writeln!(page, "| {first} | {second} | {} | {} |", rule.reason, rule.remedy);
    }
    page
}

/// A choice as keys and values.
const fn name(choice: Choice) -> &'static str {
    match choice {
        Choice::Warp => "`warp` other than `none`",
        Choice::AllWarped => "`warp` other than `none` for every map",
        Choice::SmallCasters => "`drop-small-casters on`",
        Choice::MapSelection => "`selection map`",
        Choice::DistanceMetric => "`bands radial`",
        Choice::VisibleRange => "`range-fit visible`",
        Choice::OptimalScheme => "`scheme optimal`",
        Choice::Band => "`transition blend` or `dither`",
        Choice::MomentFilter => "moment filters (`esm`, `vsm`, `evsm2`, `evsm4`, `msm`)",
        Choice::SunFilter => "`filter pcss`, moment filters",
        Choice::OtherThanPcf3 => "`filter` other than `pcf3`",
        Choice::ExactEdges => "`edges exact`",
        Choice::SeveralSamples => "`msaa 4`",
        Choice::ColourMaps => "`depth-format r32f`",
        Choice::TiledLayers => "`generation mixed`",
        Choice::OneMap => "`storage reused`",
        Choice::NotLayers => "`storage` other than `array`",
        Choice::NotPerSplit => "`generation` other than `per-split`",
        Choice::CubeFaces => "`storage cube`",
        Choice::MoreThanSixSplits => "more than 6 `splits`",
        Choice::UnequalSizes => "different sizes in `map-size`",
        Choice::NotStill => "`stabilize` other than `exact`",
        Choice::ExactlyStill => "`stabilize exact`",
        Choice::OtherDepth => "`depth-format` other than `d32f`",
        Choice::KeptMaps => "`cache kept`",
        Choice::DeferredCoordinates => "`coordinates deferred`",
        Choice::VertexCoordinates => "`coordinates split`",
        Choice::MoreThanFourSplits => "more than 4 `splits`",
        Choice::LocalLight => "spot and point lights",
        Choice::SeveralFaces => "several lights, point lights",
        Choice::FitToDepth => "`fit-to depth`",
        Choice::IntervalSelection => "`selection depth`",
        Choice::SliceCrop => "`fit independent`",
        _ => panic!("a choice has no words here"),
    }
}

#[test]
fn the_page_of_settings_is_what_the_tables_say() {
    if std::env::var("UMBRAGE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(PAGE, page()).unwrap();
    }
    let written = std::fs::read_to_string(PAGE).unwrap();
    assert!(written == page(), "docs/settings.md is out of date; run this test with UMBRAGE_BLESS=1");
}
