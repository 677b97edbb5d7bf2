//! Settings: a key, the values that it takes, and the cost of a change.

use std::fmt;

use super::given::{Given, Wrong};
use super::names::Word;
use super::{Renamed, ShadowConfig, text};

/// One choice of a [`ShadowConfig`], as a key with a value.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Setting {
    /// The key in config files; the command's option is the key behind two dashes.
    pub key: &'static str,
    /// One line of explanation.
    pub help: &'static str,
    /// Kind of values that the setting takes.
    pub kind: Kind,
    /// Resources that an application rebuilds when the setting changes.
    pub rebuilds: Rebuilds,
    pub(super) set: fn(&mut ShadowConfig, &str, &Given<'_>) -> Result<(), Wrong>,
    pub(super) get: fn(&ShadowConfig) -> Option<Value>,
}

impl Setting {
    /// Checks a value alone, without regard to other settings.
    ///
    /// # Errors
    /// A message that says what is wrong and what to give instead; of a word of a former version,
    /// the word that replaces it.
    pub fn check(&self, text: &str) -> Result<(), String> {
        match Renamed::find(self.key, text) {
            Some(renamed) => Err(renamed.to_string()),
            None => self.kind.check(text),
        }
    }

    /// The setting's value in a config; `None` if other choices of the config exclude the setting.
    #[must_use]
    pub fn get(&self, config: &ShadowConfig) -> Option<Value> {
        (self.get)(config)
    }
}

/// Kind of values that a setting takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// One of a list of words.
    Words(&'static [Word]),
    /// Words separated by commas, one for all splits or one for each.
    WordList(&'static [Word]),
    /// A number from 0 to this maximum.
    Share(f64),
    /// Metres, above 0.
    Metres,
    /// Lengths in metres, separated by commas.
    MetresList,
    /// Two view depths in metres, `N..F`.
    Range,
    /// Degrees, from 0 to this maximum.
    Degrees(f64),
    /// A whole number between two bounds.
    Count(u32, u32),
    /// One of a few whole numbers.
    CountOf(&'static [u32]),
    /// Texels separated by commas, one number for all splits or one for each.
    Texels,
    /// Linear red, green and blue, 0 to 1 each.
    Colour,
    /// `on` or `off`; `true` and `false` are also read.
    Switch,
}

impl Kind {
    /// Checks a value alone, without regard to other settings.
    ///
    /// The problem with the value, and the values that are allowed.
    pub fn check(&self, text: &str) -> Result<(), String> {
        let within = |value: f64, most: f64| {
            if (0.0..=most).contains(&value) {
                Ok(())
            } else {
                Err(format!("{value} is out of range; give 0 to {most}"))
            }
        };
        let positive = |text: &str| {
            text::number(text).and_then(|v| if v > 0.0 { Ok(v) } else { Err(format!("{v} is not greater than 0")) })
        };
        match *self {
            Self::Words(words) => text::one_of(text, words),
            Self::WordList(words) => text.split(',').try_for_each(|word| text::one_of(word.trim(), words)),
            Self::Share(most) | Self::Degrees(most) => text::number(text).and_then(|value| within(value, most)),
            Self::Metres => positive(text).map(|_| ()),
            Self::MetresList => text.split(',').try_for_each(|metres| text::number(metres).map(|_| ())),
            Self::Range => text::range(text).map(|_| ()),
            Self::Count(least, most) => match text::count(text)? {
                count if (least..=most).contains(&count) => Ok(()),
                count => Err(format!("{count}; give {least} to {most}")),
            },
            Self::CountOf(counts) => match text::count(text)? {
                count if counts.contains(&count) => Ok(()),
                count => Err(format!("{count}; give {}", text::choice(counts))),
            },
            Self::Texels => text::map_sizes(text).map(|_| ()),
            Self::Colour => match text.split(',').count() {
                3 => text.split(',').try_for_each(|part| match text::number(part)? {
                    part if (0.0..=1.0).contains(&part) => Ok(()),
                    part => Err(format!("{part}; give red, green and blue from 0 to 1")),
                }),
                count => Err(format!("{count} numbers; give red, green and blue from 0 to 1")),
            },
            Self::Switch => text::switch(text).map(|_| ()),
        }
    }

    /// The placeholder of a value in a line of help, such as `TEXELS,…`.
    #[must_use]
    pub const fn placeholder(&self) -> &'static str {
        match self {
            Self::Words(_) => "WORD",
            Self::WordList(_) => "WORD,…",
            Self::Share(_) => "SHARE",
            Self::Metres => "M",
            Self::MetresList => "M,…",
            Self::Range => "N..F",
            Self::Degrees(_) => "DEGREES",
            Self::Count(..) | Self::CountOf(_) => "N",
            Self::Texels => "TEXELS,…",
            Self::Colour => "R,G,B",
            Self::Switch => "on|off",
        }
    }
}

/// Resources that a change of a setting rebuilds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rebuilds {
    /// Nothing: the change takes effect with the next frame.
    Nothing,
    /// Textures and bind groups. Pipelines stay valid.
    Maps,
    /// WGSL sources, and the pipelines that use them.
    Pipelines,
}

/// A setting's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A word or words.
    Word(String),
    /// A number.
    Number(f64),
    /// A whole number.
    Count(u32),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Whole numbers.
    Counts(Vec<u32>),
    /// `on` or `off`.
    Switch(bool),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn list<T: fmt::Display>(f: &mut fmt::Formatter<'_>, values: &[T]) -> fmt::Result {
            values.iter().enumerate().try_for_each(|(i, value)| write!(f, "{}{value}", if i > 0 { "," } else { "" }))
        }
        match self {
            Self::Word(word) => f.write_str(word),
            Self::Number(number) => write!(f, "{number}"),
            Self::Count(count) => write!(f, "{count}"),
            Self::Numbers(numbers) => list(f, numbers),
            Self::Counts(counts) => list(f, counts),
            Self::Switch(on) => f.write_str(if *on { "on" } else { "off" }),
        }
    }
}
