//! The settings of shadows as rows of controls, made from [`SETTINGS`]. A new setting appears by
//! itself.

use umbrage::ShadowConfig;
use umbrage::config::{Kind, LightKind, Preset, Rebuilds, SETTINGS, Setting, Value};

/// A setting with its current value.
#[derive(Clone, Debug)]
pub struct Row {
    /// The setting.
    pub setting: &'static Setting,
    /// Current value; `None` if the config's other choices exclude the setting.
    pub value: Option<Value>,
    /// Value in the default config.
    pub default: Option<Value>,
}

impl Row {
    /// Returns the unit of the setting's numbers; empty for words and shares.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self.setting.kind {
            Kind::Metres | Kind::MetresList | Kind::Range => "m",
            Kind::Degrees(_) => "°",
            Kind::Texels => "texels",
            Kind::Words(_)
            | Kind::WordList(_)
            | Kind::Share(_)
            | Kind::Count(..)
            | Kind::CountOf(_)
            | Kind::Colour
            | Kind::Switch => "",
        }
    }

    /// Describes the cost of a change for users.
    #[must_use]
    pub fn cost(&self) -> &'static str {
        match self.setting.rebuilds {
            Rebuilds::Nothing => "takes effect with the next frame",
            Rebuilds::Maps => "rebuilds the maps",
            Rebuilds::Pipelines => "rebuilds the shaders: a moment on a graphics card, seconds in software",
        }
    }

    /// Returns a value for a setting that has none: that of the default config, of some preset, or
    /// the least.
    #[must_use]
    pub fn stand_in(&self) -> String {
        let presets = Preset::ALL.iter().find_map(|preset| self.setting.get(&preset.config()));
        let known = self.value.clone().or_else(|| self.default.clone()).or(presets);
        known.map(|value| value.to_string()).unwrap_or_else(|| match self.setting.kind {
            Kind::Words(words) | Kind::WordList(words) => words.first().map_or("", |word| word.word).to_owned(),
            Kind::Share(most) => (0.5 * most).to_string(),
            Kind::Metres => "0.5".to_owned(),
            Kind::MetresList => "10".to_owned(),
            Kind::Range => "1..400".to_owned(),
            Kind::Degrees(_) => umbrage::config::SUN_DEGREES.to_string(),
            Kind::Count(least, _) => least.to_string(),
            Kind::CountOf(counts) => counts.first().map_or_else(String::new, u32::to_string),
            Kind::Texels => "1024".to_owned(),
            Kind::Colour => "0,0,0".to_owned(),
            Kind::Switch => "on".to_owned(),
        })
    }
}

/// Returns all settings of a config.
#[must_use]
pub fn rows(config: &ShadowConfig) -> Vec<Row> {
    let usual = ShadowConfig::default();
    let row = |setting: &'static Setting| Row { setting, value: setting.get(config), default: setting.get(&usual) };
    SETTINGS.iter().map(row).collect()
}

/// Effect of a choice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The value is chosen already.
    Chosen,
    /// The choice changes no other setting.
    Free,
    /// The choice conflicts with others, which would be changed: the reasons, in the words of the
    /// rules.
    Excluded(Vec<String>),
    /// The choice is impossible: the reason and the remedy.
    Impossible(String),
}

/// Returns the effect of choosing a value.
#[must_use]
pub fn verdict(config: &ShadowConfig, lights: &[LightKind], setting: &Setting, value: &str) -> Verdict {
    if setting.get(config).is_some_and(|chosen| chosen.to_string() == value) {
        return Verdict::Chosen;
    }
    match choose(config, lights, setting, value) {
        Ok((_, given_way)) if given_way.is_empty() => Verdict::Free,
        Ok((_, given_way)) => Verdict::Excluded(given_way),
        Err(why) => Verdict::Impossible(why),
    }
}

/// Returns the config with another value of a setting, and the settings that were changed to make
/// room for it.
///
/// # Errors
/// The reason why the value cannot be chosen, for users.
pub fn choose(
    config: &ShadowConfig,
    lights: &[LightKind],
    setting: &Setting,
    value: &str,
) -> Result<(ShadowConfig, Vec<String>), String> {
    let value = value.trim();
    setting.check(value)?;
    let mut chosen = config.clone();
    let notes = chosen.apply(&[(setting.key.to_owned(), value.to_owned())]).map_err(|error| match error {
        umbrage::Error::InvalidSetting { field, reason } if field == setting.key => reason,
        other => other.to_string(),
    })?;
    // Lamps replace what excludes them for themselves alone; what is left is an error.
    chosen.validate_shared(lights).map_err(|error| error.to_string())?;
    Ok((chosen, notes))
}

/// Lists the settings that differ between two configs, for display before an excluded setting is
/// chosen.
#[must_use]
pub fn changes(before: &ShadowConfig, after: &ShadowConfig) -> Vec<String> {
    let changed = SETTINGS.iter().filter(|setting| setting.get(before) != setting.get(after));
    let say = |setting: &Setting| match setting.get(after) {
        Some(value) => format!("{} {value}", setting.key),
        None => format!("no {}", setting.key),
    };
    changed.map(say).collect()
}

/// Headings of the panel, each with its keys. Keys under no heading go under [`OTHERS`].
pub const SECTIONS: &[(&str, &[&str])] = &[
    (
        "Splits",
        &[
            "technique",
            "splits",
            "map-size",
            "scheme",
            "lambda",
            "delta",
            "planes",
            "range-fit",
            "shadow-range",
            "far-fade",
        ],
    ),
    (
        "Edges",
        &[
            "edges",
            "edge-samples",
            "filter",
            "filter-width",
            "sun-angle",
            "rotate-kernel",
            "msaa",
            "bleeding",
            "derivatives",
            "bias",
        ],
    ),
    ("Borders between splits", &["selection", "bands", "transition", "blend"]),
    ("Stillness and fit", &["stabilize", "extent-steps", "extent-levels", "fit", "fit-to", "warp", "tsm-focus"]),
    ("Look", &["shadow-strength", "shadow-colour", "translucent", "contact-shadows"]),
    (
        "Memory and passes",
        &["storage", "generation", "depth-format", "cache", "coordinates", "drop-small-casters", "fallbacks"],
    ),
];

/// Heading of settings that are in no section.
pub const OTHERS: &str = "Others";

/// Returns the heading of a setting.
#[must_use]
pub fn section(key: &str) -> &'static str {
    SECTIONS.iter().find(|(_, keys)| keys.contains(&key)).map_or(OTHERS, |(heading, _)| heading)
}

#[cfg(test)]
mod tests {
    use umbrage::config::{RULES, Selection};

    use super::*;

    const SUN: &[LightKind] = &[LightKind::Directional];

    fn setting(key: &str) -> &'static Setting {
        SETTINGS.iter().find(|setting| setting.key == key).expect(key)
    }

    #[test]
    fn every_setting_has_a_row_under_one_heading() {
        let rows = rows(&ShadowConfig::default());
        assert_eq!(rows.len(), SETTINGS.len());
        for (row, setting) in rows.iter().zip(SETTINGS) {
            assert_eq!(row.setting.key, setting.key);
            assert_ne!(section(setting.key), OTHERS, "{}: give it a section", setting.key);
        }
        for (_, keys) in SECTIONS {
            assert!(keys.iter().all(|key| SETTINGS.iter().any(|setting| setting.key == *key)), "{keys:?}");
        }
        assert_eq!(section("a new setting"), OTHERS);
    }

    #[test]
    fn every_value_that_stands_in_is_one() {
        for preset in Preset::ALL {
            for row in rows(&preset.config()) {
                assert_eq!(row.setting.kind.check(&row.stand_in()), Ok(()), "{}", row.setting.key);
            }
        }
    }

    #[test]
    fn choices_that_exclude_each_other_are_said_in_the_words_of_the_rules() {
        let balanced = ShadowConfig::default();
        assert_eq!(balanced.selection, Selection::Map);
        let Verdict::Excluded(why) = verdict(&balanced, SUN, setting("storage"), "reused") else {
            panic!("one map is none to choose from");
        };
        assert!(why.iter().all(|why| RULES.iter().any(|rule| why.contains(rule.reason))), "{why:?}");
        assert_eq!(verdict(&balanced, SUN, setting("filter"), "pcf5"), Verdict::Free);
        assert_eq!(verdict(&balanced, SUN, setting("selection"), "map"), Verdict::Chosen);
    }

    #[test]
    fn choices_that_cannot_be_made_say_what_to_do() {
        let many = choose(&ShadowConfig::default(), SUN, setting("splits"), "8").expect("8 splits").0;
        let Verdict::Impossible(why) = verdict(&many, SUN, setting("storage"), "cube") else {
            panic!("a cube has six faces");
        };
        assert!(why.contains("six faces") && why.contains("use 6 splits at most"), "{why}");
        let lamps = [LightKind::Directional, LightKind::Point];
        let Verdict::Impossible(why) = verdict(&ShadowConfig::default(), &lamps, setting("filter"), "evsm2") else {
            panic!("moments are of a sun");
        };
        assert!(why.contains("directional light") && why.contains("use another filter"), "{why}");
        for (key, value) in [("splits", "0"), ("blend", "2"), ("map-size", "many"), ("shadow-colour", "1,2,3")] {
            assert!(choose(&ShadowConfig::default(), SUN, setting(key), value).is_err(), "{key} {value}");
        }
    }

    #[test]
    fn what_comes_along_is_named() {
        let before = ShadowConfig::default();
        let (after, _) = choose(&before, SUN, setting("lambda"), "0.7").expect("the practical scheme");
        let said = changes(&before, &after);
        assert!(said.contains(&"scheme practical".to_owned()) && said.contains(&"lambda 0.7".to_owned()), "{said:?}");
        assert_eq!(changes(&before, &before), [] as [&str; 0]);
    }
}
