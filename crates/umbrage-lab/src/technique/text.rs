//! Techniques by name: `pssm:4:512:lambda=0.9` and the like.
//!
//! ```text
//! LIST      = TECHNIQUE { "," TECHNIQUE }
//! TECHNIQUE = "pssm" ":" SPLITS ":" SIZES { ":" SETTING }  |  KIND ":" SIZE { ":" SETTING }
//! SIZES     = SIZE { "/" SIZE }                 one, or one for each split
//! SETTING   = KEY "=" VALUE { "/" VALUE }       an option of `umbrage render` without its dashes
//!           | "label" "=" TEXT
//!           | "filter" "=" "each"               every filter in turn
//! ```
//!
//! The settings are those of `umbrage render`, over the default or over the preset that
//! `preset=NAME` names, so every technique of that command can be compared, with the same defaults
//! and the same messages, and each row of a comparison can be drawn alone.

use std::path::Path;

use toml::{Table, Value};
use umbrage::config::{Filter, SETTINGS};

use super::request::{ShadowOptions, ShadowRequest};
use crate::failure::{Failure, Result};

/// Words of the kinds of techniques.
const KINDS: [&str; 5] = ["pssm", "ssm", "psm", "lispsm", "tsm"];

/// Words of kinds that are planned and do not exist yet.
const PLANNED: [&str; 1] = ["sdsm"];

/// Options of scene and view rather than of shadows, each with a remedy. They hold for the whole
/// comparison, or not at all.
const NOT_SETTINGS: [(&str, &str); 3] = [
    (
        "shadow-range",
        "it decides which pixels are scored, so it must be the same for all techniques; give --shadow-range as an option of its own",
    ),
    ("shadows", "a technique without shadows has no score; omit it"),
    (
        "sun-angle",
        "it decides what is scored, so it must be the same for all techniques; give --sun-angle as an option of its own",
    ),
];

/// Key of the preset that the settings of a technique override.
const PRESET: &str = "preset";

/// Key that colours a technique's pictures by split.
const TINT: &str = "tint";

/// Options that have a place in the short form.
const SHAPE: [&str; 3] = ["technique", "splits", "map-size"];

/// A technique with all its settings, checked.
#[derive(Debug, PartialEq)]
pub struct Technique {
    /// Name in tables and on sheets.
    pub label: String,
    /// Short form, including the settings of all techniques.
    pub spec: String,
    /// Part of the short form that is the same for the technique at other map sizes.
    pub family: String,
    /// Options of `umbrage render` that draw the technique.
    pub options: Vec<String>,
    /// Request that the options stand for.
    pub shadows: ShadowRequest,
}

impl Technique {
    /// Returns the number of texels of all maps.
    #[must_use]
    pub fn texels(&self) -> u64 {
        self.shadows.config.texels()
    }
}

/// A technique as it was written, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct TechniqueSource {
    /// Text of the technique, for messages.
    source: String,
    label: Option<String>,
    settings: Settings,
}

/// Options of `umbrage render` and their values, in the order they were written.
pub type Settings = Vec<(String, String)>;

/// Reason why a source is not a technique.
#[derive(Debug, PartialEq)]
pub enum Rejected {
    /// The kind does not exist yet. Presets leave it out.
    NotBuilt(Failure),
    /// The source has an error.
    Wrong(Failure),
}

impl From<Rejected> for Failure {
    fn from(rejected: Rejected) -> Self {
        match rejected {
            Rejected::NotBuilt(failure) | Rejected::Wrong(failure) => failure,
        }
    }
}

/// Returns the short forms that a text stands for. With `filter=each` there is one for every
/// filter, labelled by it if no label is given; otherwise the text alone.
#[must_use]
pub fn each(text: &str) -> Vec<String> {
    let parts: Vec<&str> = text.split(':').collect();
    let Some(at) = parts.iter().position(|part| part.trim() == "filter=each") else { return vec![text.to_owned()] };
    let has_label = parts.iter().any(|part| part.trim_start().starts_with("label="));
    let of = |word: &str| {
        let mut parts: Vec<String> = parts.iter().map(ToString::to_string).collect();
        parts[at] = format!("filter={word}");
        parts.extend((!has_label).then(|| format!("label={word}")));
        parts.join(":")
    };
    Filter::ALL.iter().map(|filter| of(filter.word())).collect()
}

/// Reads the short form of one technique.
///
/// # Errors
/// [`Failure::Input`] with the technique and its fault.
pub fn parse(text: &str) -> Result<TechniqueSource> {
    let source = text.trim();
    let wrong = |what: String| Failure::input(format!("technique {source:?}: {what}"));
    let (shape, settings) = split_settings(source);
    let (kind, numbers) = shape.split_first().map_or(("", &[][..]), |(kind, numbers)| (kind.trim(), numbers));
    if kind.is_empty() {
        return Err(wrong("no technique named; write for example pssm:4:1024 or ssm:2048".into()));
    }
    let mut options = vec![("technique".to_owned(), kind.to_owned())];
    match (kind, numbers) {
        ("pssm", [splits, sizes]) => {
            options.push(("splits".into(), splits.trim().into()));
            options.push(("map-size".into(), list(sizes)));
        }
        ("pssm", _) => {
            return Err(wrong(
                "write pssm:SPLITS:SIZE, then settings as KEY=VALUE, for example pssm:4:1024:lambda=0.9".into(),
            ));
        }
        (_, [size]) => options.push(("map-size".into(), list(size))),
        _ => {
            return Err(wrong(format!(
                "write {kind}:SIZE, then settings as KEY=VALUE, for example {kind}:1024:filter=hard"
            )));
        }
    }
    let (label, settings) = read_settings(&settings).map_err(wrong)?;
    if let Some((key, _)) = settings.iter().find(|(key, _)| SHAPE.contains(&key.as_str())) {
        return Err(wrong(format!("{key} is already given at the start, as in pssm:4:1024; omit {key}=")));
    }
    options.extend(settings);
    Ok(TechniqueSource { source: source.to_owned(), label, settings: options })
}

/// Reads settings for all techniques, `filter=hard:blend=0`.
///
/// # Errors
/// [`Failure::Input`] with the setting.
pub fn parse_with(text: &str) -> Result<Settings> {
    let wrong = |what: String| Failure::input(format!("--with {text:?}: {what}"));
    if text.trim().is_empty() {
        return Ok(Vec::new());
    }
    let parts: Vec<&str> = text.split(':').collect();
    let (label, settings) = read_settings(&parts).map_err(wrong)?;
    if label.is_some() {
        return Err(wrong("a label applies to one technique only".into()));
    }
    if let Some((key, _)) = settings.iter().find(|(key, _)| SHAPE.contains(&key.as_str())) {
        return Err(wrong(format!("{key} applies to one technique only, as in pssm:4:1024")));
    }
    Ok(settings)
}

/// Reads a file of techniques: `[[technique]]` tables, and one `[with]` for all of them.
///
/// # Errors
/// [`Failure::Input`] with the file, the technique and its fault.
pub fn load(path: &Path) -> Result<(Settings, Vec<TechniqueSource>)> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::file("read", path, &error))?;
    parse_file(&path.display().to_string(), &text)
}

/// Reads the text of such a file; `file` stands for it in messages.
///
/// # Errors
/// As [`load`].
pub fn parse_file(file: &str, text: &str) -> Result<(Settings, Vec<TechniqueSource>)> {
    let wrong = |what: String| Failure::input(format!("{file}: {what}"));
    let mut root: Table =
        text.parse().map_err(|error: toml::de::Error| wrong(format!("is not valid TOML: {error}")))?;
    let with = match root.remove("with") {
        None => Vec::new(),
        Some(Value::Table(table)) => options_of(table).map_err(|what| wrong(format!("[with]: {what}")))?,
        Some(_) => return Err(wrong("with is not a table; write [with] and settings below it".into())),
    };
    if let Some((key, _)) = with.iter().find(|(key, _)| key == "label" || SHAPE.contains(&key.as_str())) {
        return Err(wrong(format!("[with]: {key} applies to one [[technique]] only")));
    }
    let Some(Value::Array(tables)) = root.remove("technique") else {
        return Err(wrong("has no [[technique]]; write one for each technique".into()));
    };
    if let Some(key) = root.keys().next() {
        return Err(wrong(format!("{key} is not known; a file of techniques has [with] and [[technique]]")));
    }
    let mut sources = Vec::new();
    for (number, table) in (1..).zip(tables) {
        let source = format!("{file}, technique {number}");
        let Value::Table(table) = table else { return Err(wrong(format!("technique {number} is not a table"))) };
        let mut settings = options_of(table).map_err(|what| Failure::input(format!("{source}: {what}")))?;
        let label = settings.iter().position(|(key, _)| key == "label").map(|at| settings.remove(at).1);
        if !settings.iter().any(|(key, _)| key == "technique") {
            return Err(Failure::input(format!("{source}: no technique named; write technique = \"pssm\"")));
        }
        sources.push(TechniqueSource { source, label, settings });
    }
    Ok((with, sources))
}

/// Reads techniques in the short form. `with` are settings of all that do not override them.
///
/// # Errors
/// [`Failure::Input`] with the technique or setting.
pub fn parse_all(texts: &[String], with: &str) -> Result<Vec<Technique>> {
    let sources = texts.iter().flat_map(|text| each(text)).map(|text| parse(&text)).collect::<Result<Vec<_>>>()?;
    Ok(finish(&sources, &parse_with(with)?, None)?)
}

/// Checks sources and makes techniques of them. `with` are settings of all that do not override
/// them; the last entry of a key wins. Techniques with the same name are numbered.
///
/// # Errors
/// As [`TechniqueSource::finish`].
pub fn finish(
    sources: &[TechniqueSource],
    with: &Settings,
    range: Option<(f64, f64)>,
) -> Result<Vec<Technique>, Rejected> {
    let mut techniques: Vec<Technique> = Vec::new();
    for source in sources {
        let mut technique = source.finish(with, range)?;
        let taken = |label: &str| techniques.iter().any(|other| other.label == label);
        if taken(&technique.label) {
            let free = (2..).map(|n| format!("{} #{n}", technique.label)).find(|label| !taken(label));
            technique.label = free.unwrap_or_default();
        }
        techniques.push(technique);
    }
    Ok(techniques)
}

impl TechniqueSource {
    /// Checks all settings.
    ///
    /// # Errors
    /// [`Rejected::NotBuilt`] for a kind that is planned, else [`Rejected::Wrong`], both with the
    /// technique and the setting.
    pub fn finish(&self, with: &Settings, range: Option<(f64, f64)>) -> Result<Technique, Rejected> {
        let wrong = |what: String| Rejected::Wrong(Failure::input(format!("technique {:?}: {what}", self.source)));
        self.check_kind()?;
        let mut settings = self.settings.clone();
        for (key, value) in with {
            if self.settings.iter().any(|(own, _)| own == key) {
                continue;
            }
            match settings.iter_mut().find(|(known, _)| known == key) {
                Some(known) => known.1.clone_from(value),
                None => settings.push((key.clone(), value.clone())),
            }
        }
        for (key, _) in &settings {
            if let Some((_, why)) = NOT_SETTINGS.iter().find(|(not, _)| not == key) {
                return Err(wrong(format!("--{key}: {why}")));
            }
            if ![PRESET, TINT].contains(&key.as_str()) && SETTINGS.iter().all(|setting| setting.key != key) {
                let keys = SETTINGS.iter().map(|setting| setting.key);
                let there = keys.filter(|key| !SHAPE.contains(key) && NOT_SETTINGS.iter().all(|(not, _)| not != key));
                let there = there.collect::<Vec<_>>().join(", ");
                return Err(wrong(format!("there is no setting {key}; there are label, {PRESET}, {TINT}, {there}")));
            }
        }
        let mut options: Vec<String> = settings.iter().map(|(key, value)| format!("--{key}={value}")).collect();
        let mut asked = ShadowOptions { given: settings.clone(), ..ShadowOptions::default() };
        asked.given.retain(|(key, _)| ![PRESET, TINT].contains(&key.as_str()));
        if let Some((_, tint)) = settings.iter().find(|(key, _)| key == TINT) {
            let not = |_| wrong(format!("--{TINT} {tint} is neither true nor false"));
            asked.tint = tint.parse().map_err(not)?;
        }
        if let Some((_, preset)) = settings.iter().find(|(key, _)| key == PRESET) {
            asked.preset = Some(preset.parse().map_err(|why| wrong(format!("--{PRESET}: {why}")))?);
        }
        if let Some((near, far)) = range {
            options.push(format!("--shadow-range={near}..{far}"));
            asked.given.retain(|(key, _)| key != "range-fit");
            asked.given.push(("shadow-range".to_owned(), format!("{near}..{far}")));
        }
        let shadows = ShadowRequest::new(asked).map_err(|failure| wrong(failure.to_string()))?;
        let without_sizes: Vec<String> =
            settings.iter().filter(|(key, _)| key != "map-size").map(|(key, value)| format!("{key}={value}")).collect();
        Ok(Technique {
            label: self.label.clone().unwrap_or_else(|| self.default_label(&shadows)),
            spec: spec(&settings),
            family: without_sizes.join(":"),
            options,
            shadows,
        })
    }

    fn check_kind(&self) -> Result<(), Rejected> {
        let kind = self.settings.iter().find(|(key, _)| key == "technique").map_or("", |(_, kind)| kind.as_str());
        if KINDS.contains(&kind) {
            return Ok(());
        }
        let there = KINDS.join(", ");
        let message = |what: &str| Failure::input(format!("technique {:?}: {what}; there are {there}", self.source));
        Err(if PLANNED.contains(&kind) {
            Rejected::NotBuilt(message(&format!("{kind} is not built yet")))
        } else {
            Rejected::Wrong(message(&format!("there is no technique {kind}")))
        })
    }

    /// Makes the default label, such as `PSSM(4; 512²) λ 0.9`: the shape, then the technique's own
    /// further settings.
    fn default_label(&self, shadows: &ShadowRequest) -> String {
        let sizes = &shadows.config.map_sizes;
        let size = match &sizes[..] {
            [first, rest @ ..] if rest.iter().all(|size| size == first) => format!("{first}²"),
            _ => sizes.iter().map(|size| format!("{size}²")).collect::<Vec<_>>().join("+"),
        };
        let kind = self.settings.iter().find(|(key, _)| key == "technique").map_or("pssm", |(_, kind)| kind.as_str());
        let kind = kind.to_uppercase();
        let mut label =
            if kind == "PSSM" { format!("{kind}({}; {size})", sizes.len()) } else { format!("{kind}({size})") };
        for (key, value) in self.settings.iter().filter(|(key, _)| !SHAPE.contains(&key.as_str())) {
            let text = match key.as_str() {
                "lambda" => format!("λ {value}"),
                "stabilize" if value == "exact" => "still".into(),
                "stabilize" if value == "approximate" => "almost still".into(),
                "stabilize" => "tight".into(),
                "extent-steps" => format!("2^(1/{value})"),
                "extent-levels" => format!("1/{value} levels"),
                "selection" => format!("by {value}"),
                "bands" => format!("{value} bands"),
                "coordinates" | "scheme" | "fit" | "filter" | "depth-format" => value.clone(),
                _ => format!("{key} {value}"),
            };
            label += &format!(" {text}");
        }
        label
    }
}

/// Writes the short form of settings that begin with the shape.
fn spec(settings: &Settings) -> String {
    let part = |(key, value): &(String, String)| {
        let value = value.replace(',', "/");
        if SHAPE.contains(&key.as_str()) { value } else { format!("{key}={value}") }
    };
    let in_order = SHAPE.iter().filter_map(|shape| settings.iter().find(|(key, _)| key == shape));
    let rest = settings.iter().filter(|(key, _)| !SHAPE.contains(&key.as_str()));
    in_order.chain(rest).map(part).collect::<Vec<_>>().join(":")
}

/// Splits a text into the parts before the first setting, and the settings.
fn split_settings(text: &str) -> (Vec<&str>, Vec<&str>) {
    let parts: Vec<&str> = text.split(':').collect();
    let first = parts.iter().position(|part| part.contains('=')).unwrap_or(parts.len());
    (parts[..first].to_vec(), parts[first..].to_vec())
}

/// Reads label and settings from `KEY=VALUE` parts.
fn read_settings(parts: &[&str]) -> Result<(Option<String>, Settings), String> {
    let (mut label, mut settings) = (None, Settings::new());
    for part in parts {
        let Some((key, value)) = part.split_once('=') else {
            return Err(format!("{part:?} is not a setting; write KEY=VALUE, with sizes before all settings"));
        };
        let (key, value) = (key.trim(), value.trim());
        if value.is_empty() {
            return Err(format!("{key} has no value"));
        }
        if key == "label" {
            if label.replace(value.to_owned()).is_some() {
                return Err("label is said twice".into());
            }
        } else if settings.iter().any(|(known, _)| known == key) {
            return Err(format!("{key} is said twice"));
        } else {
            settings.push((key.to_owned(), list(value)));
        }
    }
    Ok((label, settings))
}

/// Writes a list as `umbrage render` reads it.
fn list(text: &str) -> String {
    text.trim().replace('/', ",")
}

/// Reads the options of a table's entries.
fn options_of(table: Table) -> Result<Settings, String> {
    fn scalar(key: &str, value: Value) -> Result<String, String> {
        match value {
            Value::String(text) => Ok(text),
            Value::Integer(number) => Ok(number.to_string()),
            Value::Float(number) => Ok(number.to_string()),
            _ => Err(format!("{key} is neither text nor a number nor a list of numbers")),
        }
    }
    table
        .into_iter()
        .map(|(key, value)| {
            let value = match value {
                Value::Array(values) => {
                    values.into_iter().map(|value| scalar(&key, value)).collect::<Result<Vec<_>, _>>()?.join(",")
                }
                value => scalar(&key, value)?,
            };
            Ok((key, value))
        })
        .collect()
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
