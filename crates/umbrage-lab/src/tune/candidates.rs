//! Candidates of a search: every combination of some settings' values, with maps as large as the
//! budget allows.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use umbrage::config::{Budget, Filter, LightKind, Preset, SETTINGS, Storage};
use umbrage::{Error as SettingError, ShadowConfig};

use super::Error;
use crate::{
    failure::{Failure, Result, in_options},
    technique::text::Settings,
};

/// Key of a share of the budget.
const SHARE: &str = "share";
/// Key of a preset, which other settings override.
const PRESET: &str = "preset";

/// Keys that cannot be an axis, each with the reason.
const NOT_TRIED: [(&str, &str); 3] = [
    ("map-size", "it follows from the budget; give share=1/0.5/0.25 for smaller maps"),
    ("shadow-range", "it decides which pixels are scored and is one for all; give --shadow-range beside"),
    ("sun-angle", "it must be the same for all candidates; give --sun-angle as an option of its own"),
];

/// A setting with the values that are tried.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Axis {
    /// Key of the setting; `share` is a share of the budget, `preset` is overridden by all others.
    pub key: String,
    /// Values of the setting.
    pub values: Vec<String>,
}

/// Reads an axis of `--try`: `splits=2/3/4/6`.
///
/// # Errors
/// [`Error::Axis`] with the key or value that cannot be tried.
pub fn axis(text: &str) -> std::result::Result<Axis, Error> {
    let wrong = |reason: String| Error::Axis { axis: text.to_owned(), reason };
    let Some((key, values)) = text.split_once('=') else {
        return Err(wrong("write KEY=VALUE/VALUE, as in splits=2/3/4".to_owned()));
    };
    let key = key.trim();
    if let Some((_, why)) = NOT_TRIED.iter().find(|(not, _)| *not == key) {
        return Err(wrong((*why).to_owned()));
    }
    let setting = SETTINGS.iter().find(|setting| setting.key == key);
    let check = |value: &str| match (key, setting) {
        (SHARE, _) => match value.parse::<f64>() {
            Ok(share) if share > 0.0 && share <= 1.0 => Ok(()),
            _ => Err(format!("{value:?} is not a share of the budget; give a number above 0, up to 1")),
        },
        (PRESET, _) => value.parse::<Preset>().map(|_| ()),
        (_, Some(setting)) => setting.check(value),
        (_, None) => {
            let keys = SETTINGS.iter().map(|setting| setting.key);
            let keys: Vec<&str> = keys.filter(|key| NOT_TRIED.iter().all(|(not, _)| not != key)).collect();
            Err(format!("there is no setting {key}; there are {SHARE}, {PRESET}, {}", keys.join(", ")))
        }
    };
    let values: Vec<String> = values.split('/').map(|value| value.trim().to_owned()).collect();
    for (number, value) in values.iter().enumerate() {
        check(value).map_err(&wrong)?;
        if values[..number].contains(value) {
            return Err(wrong(format!("{value} is given twice")));
        }
    }
    Ok(Axis { key: key.to_owned(), values })
}

/// Returns the default axes: numbers of splits and filters, with the whole budget and a quarter of
/// it.
#[must_use]
pub fn usual_axes() -> Vec<Axis> {
    let axis = |key: &str, values: &[&str]| Axis {
        key: key.to_owned(),
        values: values.iter().map(|&value| value.to_owned()).collect(),
    };
    vec![axis("splits", &["2", "3", "4", "6"]), axis("filter", &["pcf2", "pcf3", "pcf5"]), axis(SHARE, &["1", "0.25"])]
}

/// A config that is tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Label in tables: the values that are tried.
    pub label: String,
    /// Config of the candidate.
    pub config: ShadowConfig,
    /// Name of the preset, if the candidate is one with maps of another size.
    pub preset: Option<String>,
}

/// All candidates of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidates {
    /// Candidates in the order of their numbers.
    pub all: Vec<Candidate>,
    /// Reasons why combinations were left out, and the number of combinations for each.
    pub skipped: BTreeMap<String, usize>,
}

/// Axes and settings that candidates are made from.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// Axes of the search.
    pub axes: &'a [Axis],
    /// Settings of all candidates that do not override them.
    pub with: &'a Settings,
    /// True if the presets are candidates too.
    pub presets: bool,
    /// Budget of the maps.
    pub budget: Budget,
    /// View depths in metres that shadows cover.
    pub range: Option<(f64, f64)>,
    /// Kinds of the lights of the shots.
    pub lights: &'a [LightKind],
}

/// Result of a combination.
enum Tried {
    Config(Box<ShadowConfig>),
    /// Rules exclude the combination.
    Excluded(String),
    /// The budget is too small; at least this budget is needed.
    TooSmall(Budget),
}

impl Grid<'_> {
    /// Makes every combination that rules allow and the budget pays for, and then the presets.
    ///
    /// # Errors
    /// [`Failure::Input`] with a setting whose value is wrong, [`Error::BudgetTooSmall`],
    /// [`Error::NothingToTry`].
    pub fn candidates(&self) -> Result<Candidates> {
        for (number, axis) in self.axes.iter().enumerate() {
            if self.axes[..number].iter().any(|other| other.key == axis.key) {
                let reason = format!("{} is tried twice; write all its values behind one --try", axis.key);
                return Err(Error::Axis { axis: axis.key.clone(), reason }.into());
            }
        }
        let mut found = Candidates { all: Vec::new(), skipped: BTreeMap::new() };
        let mut least: Option<Budget> = None;
        for tried in self.combinations() {
            let label = tried.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(":");
            let why = match self.config(&tried, true)? {
                Tried::Config(config) => {
                    found.all.push(Candidate { label, config: *config, preset: None });
                    continue;
                }
                Tried::Excluded(reason) => reason,
                Tried::TooSmall(needed) => {
                    least = least.filter(|least| least.texels(1) <= needed.texels(1)).or(Some(needed));
                    "the budget is too small for it".to_owned()
                }
            };
            *found.skipped.entry(why).or_default() += 1;
        }
        if found.all.is_empty() {
            return Err(match (least, found.skipped.first_key_value()) {
                (Some(least), _) => Error::BudgetTooSmall { budget: self.budget, least }.into(),
                (None, first) => {
                    let reason = first.map_or(String::new(), |(reason, _)| reason.clone());
                    Error::NothingToTry { count: found.skipped.values().sum(), reason }.into()
                }
            });
        }
        if self.presets {
            self.add_presets(&mut found)?;
        }
        Ok(found)
    }

    /// Adds the presets at the budget. One that is a candidate already is marked.
    fn add_presets(&self, found: &mut Candidates) -> Result<()> {
        for preset in Preset::ALL {
            let name = preset.word().to_owned();
            let Tried::Config(config) = self.config(&[(PRESET.to_owned(), name.clone())], false)? else { continue };
            match found.all.iter_mut().find(|candidate| candidate.config == *config) {
                Some(candidate) => candidate.preset = Some(name),
                None => {
                    let label = format!("{PRESET}={name}");
                    found.all.push(Candidate { label, config: *config, preset: Some(name) });
                }
            }
        }
        Ok(())
    }

    /// Returns every way to take one value of each axis; the last axis changes fastest.
    fn combinations(&self) -> Vec<Settings> {
        self.axes.iter().fold(vec![Settings::new()], |before, axis| {
            let with = |settings: &Settings, value: &String| {
                let mut settings = settings.clone();
                settings.push((axis.key.clone(), value.clone()));
                settings
            };
            before.iter().flat_map(|settings| axis.values.iter().map(move |value| with(settings, value))).collect()
        })
    }

    /// Makes the config of a combination, with or without the settings for all.
    fn config(&self, tried: &[(String, String)], with_all: bool) -> Result<Tried> {
        let mut given: Settings = tried.to_vec();
        if with_all {
            let free = |(key, _): &&(String, String)| tried.iter().all(|(other, _)| other != key);
            given.extend(self.with.iter().filter(free).cloned());
        }
        let own = |key: &str| given.iter().find(|(other, _)| other == key).map(|(_, value)| value.as_str());
        let preset = own(PRESET).map_or(Ok(Preset::default()), str::parse).map_err(Failure::input)?;
        let share = own(SHARE).map_or(Ok(1.0), str::parse).map_err(|_| Failure::input("share is not a number"))?;
        given.retain(|(key, _)| ![PRESET, SHARE].contains(&key.as_str()));
        if let Some((near, far)) = self.range {
            given.retain(|(key, _)| key != "range-fit");
            given.push(("shadow-range".to_owned(), format!("{near}..{far}")));
        }
        let mut config = preset.config();
        match config.apply(&given) {
            Ok(_) => {}
            Err(SettingError::Conflict(conflict)) => return Ok(Tried::Excluded(in_options(&conflict.to_string()))),
            Err(error) => return Err(Failure::of_settings(&error, &given)),
        }
        // What the light excludes gives way, unless it was asked for.
        let is_asked = |key: &&'static str| given.iter().any(|(other, _)| other == key);
        if let Some(conflict) =
            config.conflict(self.lights).filter(|found| found.rule.first.keys().iter().any(is_asked))
        {
            return Ok(Tried::Excluded(in_options(&conflict.to_string())));
        }
        let mut config = config.for_lights(self.lights).0;
        if let Some(conflict) = config.conflict(self.lights) {
            return Ok(Tried::Excluded(in_options(&conflict.to_string())));
        }
        let least = Budget::least_edge(&config.filter, config.is_stabilised());
        let edge = edge(&config, self.budget.share(share), self.lights);
        if edge < least {
            return Ok(Tried::TooSmall(least_budget(&config, self.budget, self.lights, share)));
        }
        config.map_sizes = vec![edge; config.splits()];
        config.validate_for(self.lights).map_err(|error| Failure::of_settings(&error, &given))?;
        Ok(Tried::Config(Box::new(config)))
    }
}

/// Returns the largest number of maps of a config that are stored at once.
fn maps(config: &ShadowConfig, lights: &[LightKind]) -> usize {
    let splits = config.splits();
    let faces: usize = lights.iter().map(|light| light.faces()).max().unwrap_or(1);
    let layers = match (config.layout.storage(), config.layout.generation()) {
        (Storage::Cube, _) => 6,
        (Storage::Reused, _) => 1,
        // Passes draw equally many layers; the last may have some to spare.
        (_, umbrage::config::Generation::Layered | umbrage::config::Generation::Mixed) => splits.next_power_of_two(),
        _ => splits,
    };
    layers * faces
}

/// Returns the most bytes that one texel of every map takes: depth, an id or a depth buffer beside
/// it, moments with their levels and the texture between two blurs.
fn texel_bytes(config: &ShadowConfig, maps: usize) -> u64 {
    let maps = maps as u64;
    let depth = config.texel_bytes() * u64::from(config.filter.samples());
    let beside = if config.depth_format.is_colour() { 4 } else { 0 };
    let moments = match &config.filter {
        Filter::Moments(moments) => {
            use umbrage::config::MomentKind as Kind;
            let texel = match moments.kind {
                Kind::Esm => 4,
                Kind::Vsm | Kind::Evsm2 => 8,
                Kind::Evsm4 | Kind::Msm => 16,
            };
            // All levels are less than 4/3 of the first.
            (maps * texel * 4).div_ceil(3) + texel
        }
        _ => 0,
    };
    maps * (depth + beside) + moments
}

/// Returns the edge in texels of the largest maps that a budget pays for.
fn edge(config: &ShadowConfig, budget: Budget, lights: &[LightKind]) -> u32 {
    let maps = maps(config, lights);
    match budget {
        Budget::Bytes(_) => budget.edge(1, texel_bytes(config, maps)),
        Budget::Texels(_) => budget.edge(maps, 1),
    }
}

/// Returns the least whole budget, of the kind of `like`, a share of which pays for a config.
fn least_budget(config: &ShadowConfig, like: Budget, lights: &[LightKind], share: f64) -> Budget {
    let maps = maps(config, lights);
    let edge = u64::from(Budget::least_edge(&config.filter, config.is_stabilised()));
    let whole = |amount: u64| (amount as f64 / share).ceil() as u64;
    match like {
        Budget::Bytes(_) => Budget::Bytes(whole(edge * edge * texel_bytes(config, maps))),
        Budget::Texels(_) => Budget::Texels(whole(edge * edge * maps as u64)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid<'a>(axes: &'a [Axis], with: &'a Settings, budget: &str) -> Grid<'a> {
        let budget = budget.parse().expect("a budget");
        Grid { axes, with, presets: false, budget, range: None, lights: &[LightKind::Directional] }
    }

    fn axes(texts: &[&str]) -> Vec<Axis> {
        texts.iter().map(|text| axis(text).expect(text)).collect()
    }

    #[test]
    fn every_combination_has_the_largest_maps_that_the_budget_pays_for() {
        let axes = axes(&["splits=1/4", "filter=pcf2/evsm4", "share=1/0.25", "depth-format=d32f/d16"]);
        let found = grid(&axes, &Settings::new(), "8MiB").candidates().expect("candidates");
        assert_eq!((found.all.len(), found.skipped.len()), (16, 0));
        for candidate in &found.all {
            let config = &candidate.config;
            assert_eq!(config.validate(), Ok(()), "{}", candidate.label);
            let share = if candidate.label.contains("share=1") { 1.0 } else { 0.25 };
            let texel = texel_bytes(config, config.splits()) as f64;
            let taken = |edge: u32| texel * f64::from(edge) * f64::from(edge) / (share * f64::from(8 << 20));
            let edge = config.map_sizes[0];
            assert!(taken(edge) <= 1.0 && taken(edge + 8) > 1.0, "{}: {edge}", candidate.label);
        }
        let largest =
            found.all.iter().find(|candidate| candidate.label == "splits=4:filter=pcf2:share=1:depth-format=d32f");
        assert_eq!(largest.expect("the plainest").config.map_sizes, [720; 4]);
    }

    #[test]
    fn what_rules_exclude_is_left_out_and_counted() {
        let axes = axes(&["warp=none/tsm", "filter=pcf2/evsm4"]);
        let found = grid(&axes, &Settings::new(), "8MiB").candidates().expect("candidates");
        assert_eq!((found.all.len(), found.skipped.values().sum::<usize>()), (3, 1), "{:?}", found.skipped);
        assert!(found.skipped.keys().all(|reason| reason.contains("moments need depth")), "{:?}", found.skipped);
        let excluded = [axis("warp=tsm").expect("an axis"), axis("filter=vsm").expect("an axis")];
        let message = grid(&excluded, &Settings::new(), "8MiB").candidates().expect_err("nothing").to_string();
        assert!(message.contains("1 are excluded") && message.contains("moments"), "{message}");
    }

    #[test]
    fn presets_stand_beside_and_are_marked_where_they_are_candidates() {
        let axes = axes(&["splits=2/4"]);
        let found = Grid { presets: true, ..grid(&axes, &Settings::new(), "16MiB") }.candidates().expect("candidates");
        let named = |name: &str| found.all.iter().filter(|c| c.preset.as_deref() == Some(name)).collect::<Vec<_>>();
        assert_eq!(named("balanced")[0].label, "splits=4");
        for preset in Preset::ALL {
            assert_eq!(named(preset.word()).len(), 1, "{preset}");
        }
        assert_eq!(named("balanced")[0].config, Preset::Balanced.config());
    }

    #[test]
    fn a_budget_too_small_for_one_split_says_the_least() {
        let axes = axes(&["splits=1/2", "filter=pcf5/pcf2"]);
        let refused = |budget: &str| grid(&axes, &Settings::new(), budget).candidates().expect_err(budget).to_string();
        assert!(
            refused("255B").contains("the least that is possible with these settings is 256 B"),
            "{}",
            refused("255B")
        );
        assert!(refused("63texel").contains("64 texel"), "{}", refused("63texel"));
        let found = grid(&axes, &Settings::new(), "256B").candidates().expect("one map");
        assert_eq!((found.all.len(), found.skipped.values().sum::<usize>()), (1, 3), "{found:?}");
    }

    #[test]
    fn what_cannot_be_tried_is_named() {
        for (text, culprit) in [
            ("splits", "KEY=VALUE"),
            ("splits=2/2", "twice"),
            ("splits=0", "0"),
            ("splits=99", "99"),
            ("colour=3", "no setting colour"),
            ("filter=pcf9", "pcf9"),
            ("map-size=512", "share"),
            ("shadow-range=1..2", "--shadow-range"),
            ("sun-angle=1", "--sun-angle"),
            ("share=0", "share"),
            ("share=2", "share"),
            ("preset=best", "best"),
        ] {
            let message = axis(text).expect_err(text).to_string();
            assert!(message.contains("--try") && message.contains(culprit), "{text}: {message}");
        }
        let twice = [axis("splits=2").expect("an axis"), axis("splits=3").expect("an axis")];
        let message = grid(&twice, &Settings::new(), "8MB").candidates().expect_err("twice").to_string();
        assert!(message.contains("splits is tried twice"), "{message}");
    }
}
