//! Conversion of configs to text and back: Rust, TOML, the command line.

use toml::Value as Toml;
use umbrage::ShadowConfig;
use umbrage::config::{Preset, SETTINGS, Value};
use umbrage_lab::failure::Failure;

/// A config as a preset and the settings that differ from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spelled {
    /// Preset that the config starts from.
    pub preset: Preset,
    /// Settings that differ from the preset's.
    pub given: Vec<(&'static str, Value)>,
}

impl Spelled {
    /// Returns the shortest spelling of a config that reads back as that config.
    #[must_use]
    pub fn of(config: &ShadowConfig) -> Self {
        let all = config.settings();
        let short = Preset::ALL.iter().map(|&preset| {
            let same = preset.config().settings();
            let given = all.iter().filter(|setting| !same.contains(setting)).cloned().collect();
            Self { preset, given }
        });
        // What a setting that is left away would mean beside others may differ: then everything is
        // said.
        let long = Preset::ALL.iter().map(|&preset| Self { preset, given: all.clone() });
        let mut right: Vec<Self> =
            short.chain(long).filter(|spelled| spelled.config().as_ref() == Ok(config)).collect();
        right.sort_by_key(|spelled| spelled.given.len());
        let whole = || Self { preset: Preset::default(), given: all.clone() };
        right.into_iter().next().unwrap_or_else(whole)
    }

    /// Returns the config of the spelling.
    ///
    /// # Errors
    /// The reason why the settings are refused.
    pub fn config(&self) -> Result<ShadowConfig, umbrage::Error> {
        let mut config = self.preset.config();
        let given: Vec<(String, String)> =
            self.given.iter().map(|(key, value)| ((*key).to_owned(), value.to_string())).collect();
        config.apply(&given).map(|_| config)
    }

    /// Writes the config as Rust.
    #[must_use]
    pub fn rust(&self) -> String {
        let preset = format!("{:?}", self.preset);
        if self.given.is_empty() {
            return format!("let config = umbrage::config::Preset::{preset}.config();\n");
        }
        let lines: String =
            self.given.iter().map(|(key, value)| format!("    ({key:?}, {:?}),\n", value.to_string())).collect();
        format!(
            "let mut config = umbrage::config::Preset::{preset}.config();\n\
             let settings = [\n{lines}];\n\
             config.apply(&settings.map(|(key, value)| (key.to_owned(), value.to_owned())))?;\n"
        )
    }

    /// Writes the config as a file for `--config`.
    #[must_use]
    pub fn toml(&self) -> String {
        let lines = self.given.iter().map(|(key, value)| format!("{key} = {}\n", toml_of(value)));
        format!("preset = \"{}\"\n{}", self.preset, lines.collect::<String>())
    }

    /// Writes the config as options of `umbrage render` and `umbrage view`.
    #[must_use]
    pub fn command_line(&self) -> String {
        self.options().collect::<Vec<_>>().join(" ")
    }

    /// Iterates over the options of [`Spelled::command_line`].
    pub fn options(&self) -> impl Iterator<Item = String> {
        let given = self.given.iter().map(|(key, value)| format!("--{key}={value}"));
        std::iter::once(format!("--preset={}", self.preset)).chain(given)
    }
}

fn toml_of(value: &Value) -> Toml {
    match value {
        Value::Word(word) => Toml::String(word.clone()),
        Value::Number(number) => Toml::Float(*number),
        Value::Count(count) => Toml::Integer(i64::from(*count)),
        Value::Numbers(numbers) => Toml::Array(numbers.iter().map(|number| Toml::Float(*number)).collect()),
        Value::Counts(counts) => Toml::Array(counts.iter().map(|count| Toml::Integer(i64::from(*count))).collect()),
        Value::Switch(_) => Toml::String(value.to_string()),
    }
}

/// Config read from pasted text.
#[derive(Clone, Debug, PartialEq)]
pub struct Pasted {
    /// The config.
    pub config: ShadowConfig,
    /// Settings that were changed to make room for others, and parts that are not settings of
    /// shadows.
    pub notes: Vec<String>,
}

/// Reads a config that was copied as Rust, TOML, JSON or a command line.
///
/// # Errors
/// The fault of the text, for users.
pub fn read(text: &str) -> Result<Pasted, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("there is no text to paste; copy a config as Rust, TOML or a command line first".to_owned());
    }
    if text.contains("Preset::") {
        return from_rust(text);
    }
    if text.starts_with('{') {
        return plain(serde_json::from_str(text).map_err(|error| error.to_string()));
    }
    if text.split_whitespace().any(|word| word.starts_with("--")) {
        return from_command_line(text);
    }
    plain(
        toml::from_str(text).map_err(|error| format!("is not a config as Rust, TOML, JSON or a command line: {error}")),
    )
}

fn plain(config: Result<ShadowConfig, String>) -> Result<Pasted, String> {
    config.map(|config| Pasted { config, notes: Vec::new() })
}

fn from_rust(text: &str) -> Result<Pasted, String> {
    let (_, behind) = text.split_once("Preset::").unwrap_or_default();
    let name: String = behind.chars().take_while(|c| c.is_alphanumeric()).collect();
    let preset = Preset::ALL.iter().find(|preset| format!("{preset:?}") == name);
    let preset = *preset.ok_or_else(|| format!("there is no Preset::{name}"))?;
    let texts: Vec<&str> = text.split('"').skip(1).step_by(2).collect();
    let (pairs, rest) = texts.as_chunks::<2>();
    if let [alone] = rest {
        return Err(format!("{alone:?} stands alone; settings are pairs of a key and a value"));
    }
    let given = pairs.iter().map(|[key, value]| ((*key).to_owned(), (*value).to_owned())).collect();
    applied(preset, given, Vec::new())
}

fn from_command_line(text: &str) -> Result<Pasted, String> {
    let (mut preset, mut given, mut aside) = (Preset::default(), Vec::new(), Vec::new());
    let mut words = text.split_whitespace().filter(|word| *word != "\\").peekable();
    while let Some(word) = words.next() {
        let Some(option) = word.strip_prefix("--") else {
            aside.push(word.to_owned());
            continue;
        };
        let (key, value) = match option.split_once('=') {
            Some((key, value)) => (key, Some(value.to_owned())),
            None => (option, words.next_if(|next| !next.starts_with("--")).map(str::to_owned)),
        };
        let value = value.map(|value| value.trim_matches(['"', '\'']).to_owned());
        if key == "preset" {
            preset = value.unwrap_or_default().parse().map_err(|why| format!("--preset: {why}"))?;
        } else if SETTINGS.iter().any(|setting| setting.key == key) {
            // A switch may stand alone.
            given.push((key.to_owned(), value.unwrap_or_else(|| "true".to_owned())));
        } else {
            aside.push(value.map_or_else(|| word.to_owned(), |value| format!("--{key} {value}")));
        }
    }
    let aside: Vec<String> =
        aside.into_iter().filter(|word| !["umbrage", "view", "render"].contains(&&**word)).collect();
    let notes = if aside.is_empty() {
        Vec::new()
    } else {
        vec![format!("left aside, as they are no settings of shadows: {}", aside.join(" "))]
    };
    applied(preset, given, notes)
}

fn applied(preset: Preset, given: Vec<(String, String)>, mut notes: Vec<String>) -> Result<Pasted, String> {
    let mut config = preset.config();
    notes.extend(config.apply(&given).map_err(|error| Failure::of_settings(&error, &given).to_string())?);
    Ok(Pasted { config, notes })
}

#[cfg(test)]
mod tests {
    use umbrage::config::Kind;

    use super::*;

    fn returns(config: &ShadowConfig) {
        let spelled = Spelled::of(config);
        assert_eq!(spelled.config().as_ref(), Ok(config), "{spelled:?}");
        for text in [spelled.rust(), spelled.toml(), spelled.command_line()] {
            let read = read(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(&read.config, config, "{text}");
            assert_eq!(read.notes, [] as [&str; 0], "{text}");
        }
    }

    #[test]
    fn presets_come_back_and_are_spelled_by_their_names() {
        for preset in Preset::ALL {
            returns(&preset.config());
            let spelled = Spelled::of(&preset.config());
            assert_eq!((spelled.preset, spelled.given.len()), (*preset, 0));
            assert_eq!(spelled.toml(), format!("preset = \"{preset}\"\n"));
        }
    }

    /// Makes a text for a setting of some kind, which is valid more often than not.
    fn value(kind: Kind, number: f64, pick: usize) -> String {
        match kind {
            Kind::Words(words) => words[pick % words.len()].word.to_owned(),
            Kind::WordList(words) => words[pick % words.len()].word.to_owned(),
            Kind::Share(most) | Kind::Degrees(most) => (number * most).to_string(),
            Kind::Metres => (number * 3.0 + 1e-3).to_string(),
            Kind::MetresList => format!("{},{}", 5.0 + number, 50.0 + 400.0 * number),
            Kind::Range => format!("{}..{}", 0.5 + number, 2.0 + 800.0 * number),
            Kind::Count(least, most) => (least as usize + pick % (most - least + 1) as usize).to_string(),
            Kind::CountOf(counts) => counts[pick % counts.len()].to_string(),
            Kind::Texels => (64 << (pick % 6)).to_string(),
            Kind::Colour => format!("{number},0.5,{}", 1.0 - number),
            Kind::Switch => ["on", "off"][pick % 2].to_owned(),
        }
    }

    /// Random generator in which each number follows from the one before (Knuth's MMIX).
    struct Random(u64);

    impl Random {
        fn below(&mut self, most: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 33) % most as u64) as usize
        }
    }

    #[test]
    fn a_thousand_random_configs_come_back() {
        let mut random = Random(16);
        let mut refused = 0;
        for _ in 0..1000 {
            let mut config = Preset::ALL[random.below(Preset::ALL.len())].config();
            for _ in 0..=random.below(11) {
                let setting = &SETTINGS[random.below(SETTINGS.len())];
                let number = random.below(1000) as f64 / 1000.0;
                let value = value(setting.kind, number, random.below(1000));
                // What is refused leaves the config as it was.
                refused += usize::from(config.apply(&[(setting.key.to_owned(), value)]).is_err());
            }
            returns(&config);
        }
        assert!((100..4000).contains(&refused), "{refused} of some 6000 are refused");
    }

    #[test]
    fn whole_commands_are_read_and_what_is_no_setting_is_named() {
        let read =
            read("umbrage view chessboard --eye 1,2,3 --preset fast --filter pcf5 \\\n --contact-shadows --tint");
        let read = read.expect("a command");
        assert_eq!((read.config.filter.word(), read.config.look.contact, read.config.splits()), ("pcf5", true, 3));
        assert_eq!(read.notes, ["left aside, as they are no settings of shadows: chessboard --eye 1,2,3 --tint"]);
    }

    #[test]
    fn what_is_no_config_says_why() {
        for (text, why) in [
            ("  ", "no text"),
            ("hello", "TOML"),
            ("--filter=fuzzy", "--filter fuzzy"),
            ("--preset=best", "--preset"),
            ("splits = 99", "splits"),
            ("Preset::Best", "Preset::Best"),
            ("Preset::Fast \"splits\"", "stands alone"),
            ("{\"splits\": 99}", "splits"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
