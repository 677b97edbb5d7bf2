//! The options of shadows: one for each setting of `umbrage::config::SETTINGS`, and the config that
//! they override.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgMatches, Command, FromArgMatches};
use umbrage::config::{Kind, Preset, Renamed, SETTINGS, Setting};

use umbrage_lab::technique::ShadowOptions;

use crate::words;

/// Heading of these options in the help.
const HEADING: &str = "Shadows";

/// Settings that are listed with other options: the sun's angle belongs to the light.
const ELSEWHERE: [&str; 1] = ["sun-angle"];

/// The options of shadows, as typed.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowArgs(pub ShadowOptions);

impl clap::Args for ShadowArgs {
    fn augment_args(command: Command) -> Command {
        let command = command.next_help_heading(HEADING).args([preset(), config()]);
        command.args(settings().map(option))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for ShadowArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let typed = |setting: &Setting| {
            let value = matches.get_one::<String>(setting.key)?;
            Some((setting.key.to_owned(), value.clone()))
        };
        Ok(Self(ShadowOptions {
            preset: matches.get_one::<Preset>("preset").copied(),
            file: matches.get_one::<PathBuf>("config").cloned(),
            given: settings().filter_map(typed).collect(),
            ..ShadowOptions::default()
        }))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn settings() -> impl Iterator<Item = &'static Setting> {
    SETTINGS.iter().filter(|setting| !ELSEWHERE.contains(&setting.key))
}

/// Makes the option of a setting.
fn option(setting: &'static Setting) -> Arg {
    let default = setting.get(&Preset::Balanced.config()).map(|value| format!(" [default: {value}]"));
    let arg = Arg::new(setting.key)
        .long(setting.key)
        .value_name(setting.kind.placeholder())
        .help(format!("{}{}", setting.help, default.unwrap_or_default()))
        .allow_hyphen_values(true);
    match setting.kind {
        Kind::Words(words) => arg.value_parser(Words { key: setting.key, offered: words::offered(words) }),
        // The option alone means `on`.
        Kind::Switch => arg
            .value_parser([PossibleValue::new("on").alias("true"), PossibleValue::new("off").alias("false")])
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("on"),
        // Checked beside the other settings, where a message can say more.
        _ => arg,
    }
}

/// Reads one of a setting's words. Old words pass: [`umbrage::ShadowConfig::apply`] refuses them by
/// a message that names the new one, which the parser's own would not.
#[derive(Clone, Debug)]
struct Words {
    key: &'static str,
    offered: PossibleValuesParser,
}

impl TypedValueParser for Words {
    type Value = String;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<String, clap::Error> {
        match value.to_str().and_then(|word| Renamed::find(self.key, word)) {
            Some(renamed) => Ok(renamed.old.to_owned()),
            None => self.offered.parse_ref(command, arg, value),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.offered.possible_values()
    }
}

fn preset() -> Arg {
    Arg::new("preset")
        .long("preset")
        .value_name("NAME")
        .help("Settings by name; single options override them [default: balanced]")
        .value_parser(words::parser::<Preset>(Preset::WORDS))
}

fn config() -> Arg {
    Arg::new("config")
        .long("config")
        .value_name("FILE")
        .help(
            "Settings from a file (TOML or JSON). If it is a report of render or probe, its picture is drawn again and SCENE \
             may be omitted. Options override the file. Files that a report names are looked for in the working directory, \
             then beside the report",
        )
        .value_parser(clap::value_parser!(PathBuf))
}
