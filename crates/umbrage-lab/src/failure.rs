//! Errors sorted by fault, which decides the exit code.

use std::{io, path::Path};

use umbrage::config::{Kind, SETTINGS};

/// [`std::result::Result`] with a [`Failure`].
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// Reason why a command ended without its outputs. No output file is left behind.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// An error that the user can fix: an option, a file, a full disk. The message names the
    /// culprit and says what to do.
    #[error("{0}")]
    Input(String),
    /// Any other error: no adapter, a lost device, an internal error.
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// Makes an error of bad input: exit code 2.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(message.into())
    }

    /// Makes an error that is not the user's fault: exit code 1.
    pub fn other(message: impl Into<String>) -> Self {
        Self::Other(message.into())
    }

    /// Makes the error of refused settings, in the terms of the command line.
    #[must_use]
    pub fn of_settings(error: &umbrage::Error, given: &[(String, String)]) -> Self {
        match error {
            umbrage::Error::InvalidSetting { field, reason } => {
                let value = given.iter().rev().find(|(key, _)| key == field).map(|(_, value)| value.as_str());
                let reason = in_options(reason);
                Self::Input(match value {
                    Some(value) => format!("--{field} {value}: {reason}"),
                    None => format!("--{field}: {reason}"),
                })
            }
            umbrage::Error::Conflict(conflict) => Self::Input(in_options(&conflict.to_string())),
            umbrage::Error::RenamedWord(renamed) => Self::Input(format!("--{renamed}")),
            umbrage::Error::UnknownSetting { key } => {
                let keys: Vec<&str> = SETTINGS.iter().map(|setting| setting.key).collect();
                Self::Input(format!("there is no setting {key}; there are {}", keys.join(", ")))
            }
            other => other.clone().into(),
        }
    }

    /// Makes the error of an operation on a file that the user named.
    #[must_use]
    pub fn file(doing: &str, path: &Path, error: &io::Error) -> Self {
        use io::ErrorKind as Kind;
        let advice = match error.kind() {
            Kind::NotFound => "; check the path: its folder must exist",
            Kind::PermissionDenied | Kind::ReadOnlyFilesystem => "; choose a place you have the right to use",
            Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => "; make room, or choose another place",
            _ => "",
        };
        Self::Input(format!("cannot {doing} {}: {error}{advice}", path.display()))
    }
}

/// Names the option behind a field of the planner, so that the message is in the terms of the
/// command line.
impl From<umbrage::Error> for Failure {
    fn from(error: umbrage::Error) -> Self {
        let option = match &error {
            umbrage::Error::InvalidSetting { .. }
            | umbrage::Error::Conflict(_)
            | umbrage::Error::RenamedWord(_)
            | umbrage::Error::UnknownSetting { .. } => return Self::of_settings(&error, &[]),
            umbrage::Error::CameraConflict { .. } => "--bands, --camera",
            umbrage::Error::InvalidCamera { field, .. } => match *field {
                "fov" => "--fov",
                "near" | "far" => "--near, --far",
                "eye" | "target" | "up" => "--eye, --target",
                _ => "",
            },
            umbrage::Error::InvalidLight { .. } => "--sun, --light",
            _ => "",
        };
        Self::Input(if option.is_empty() { error.to_string() } else { format!("{option}: {error}") })
    }
}

/// A missing adapter and a failing device are not bad input. Every other error names an option or
/// the scene.
impl From<umbrage_render::Error> for Failure {
    fn from(error: umbrage_render::Error) -> Self {
        use umbrage_render::Error as E;
        match error {
            E::NoAdapter { .. } | E::NoDevice { .. } | E::Device { .. } | E::OutOfMemory { .. } => {
                Self::other(error.to_string())
            }
            E::Plan(error) => error.into(),
            E::Shadows(umbrage_wgpu::Error::DeviceLost) => Self::other(error.to_string()),
            E::ImageSize { .. } => Self::input(format!("--size: {error}")),
            E::Shadows(error) => Self::input(of_maps(&error)),
            E::Probe { .. } => Self::input(format!("--points: {error}")),
            _ => Self::input(error.to_string()),
        }
    }
}

/// Every error of the loader concerns a file or an option.
impl From<umbrage_scene::Error> for Failure {
    fn from(error: umbrage_scene::Error) -> Self {
        match error {
            umbrage_scene::Error::View(error) => error.into(),
            _ => Self::input(error.to_string()),
        }
    }
}

/// Every error of the judge concerns the scene or an option.
impl From<umbrage_truth::Error> for Failure {
    fn from(error: umbrage_truth::Error) -> Self {
        Self::input(error.to_string())
    }
}

/// Rewrites a message of the library with its settings as options: `selection map` becomes
/// `--selection map`.
#[must_use]
pub fn in_options(message: &str) -> String {
    let words: Vec<&str> = message.split(' ').collect();
    let is_value = |kind: Kind, word: &str| {
        let word = word.trim_end_matches([',', ';', ':', ')', '.']);
        match kind {
            Kind::Words(words) | Kind::WordList(words) => {
                word.split(',').all(|part| words.iter().any(|known| known.word == part))
            }
            _ => word.starts_with(|first: char| first.is_ascii_digit()) || word.starts_with("A,"),
        }
    };
    let mut options = Vec::new();
    for (i, word) in words.iter().enumerate() {
        let (open, key) = word.split_at(word.len() - word.trim_start_matches('(').len());
        let setting = SETTINGS.iter().find(|setting| setting.key == key);
        let next = words.get(i + 1).copied().unwrap_or_default();
        match setting {
            // A key with a hyphen is no word of English.
            Some(setting) if key.contains('-') || is_value(setting.kind, next) => {
                options.push(format!("{open}--{key}"))
            }
            _ => options.push((*word).to_owned()),
        }
    }
    options.join(" ")
}

/// Rewrites the message of the maps in the terms of the command line.
fn of_maps(error: &umbrage_wgpu::Error) -> String {
    match error {
        umbrage_wgpu::Error::MapTooLarge { .. } => format!("--map-size: {error}"),
        umbrage_wgpu::Error::FilterTooWide { .. } => format!("--filter-width: {error}"),
        other => in_options(&other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_become_options_where_a_value_follows() {
        for (message, options) in [
            ("selection map and warp tsm exclude each other", "--selection map and --warp tsm exclude each other"),
            ("use scheme log, or omit splits", "use --scheme log, or omit splits"),
            (
                "storage reused (generation multipass) and blend 0.1",
                "--storage reused (--generation multipass) and --blend 0.1",
            ),
            ("the filter compares depth", "the filter compares depth"),
        ] {
            assert_eq!(in_options(message), options);
        }
    }
}
