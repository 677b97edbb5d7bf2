//! What went wrong, sorted by whose fault it is: that decides the exit code.

use std::{io, path::Path};

use umbrage::config::{Conflict, SETTINGS};

/// [`std::result::Result`] with a [`Failure`].
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// Why a command ended without its outputs. No output file is left behind in either case.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The user can mend it: an option, a file, a full disk. The message names the culprit and what to do.
    #[error("{0}")]
    Input(String),
    /// Everything else: no adapter, a lost device, an internal error.
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// Bad input: exit code 2.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(message.into())
    }

    /// Not the user's fault: exit code 1.
    pub fn other(message: impl Into<String>) -> Self {
        Self::Other(message.into())
    }

    /// The operating system refused something about a file that the user named.
    #[must_use]
    pub fn file(doing: &str, path: &Path, error: &io::Error) -> Self {
        use io::ErrorKind as Kind;
        let advice = match error.kind() {
            Kind::NotFound => "; check the path, its folder has to exist",
            Kind::PermissionDenied | Kind::ReadOnlyFilesystem => "; choose a place you have the right to use",
            Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => "; make room, or choose another place",
            _ => "",
        };
        Self::Input(format!("cannot {doing} {}: {error}{advice}", path.display()))
    }
}

/// Names the option behind a field of the planner's, so that the message speaks the language of the command line.
impl From<umbrage::Error> for Failure {
    fn from(error: umbrage::Error) -> Self {
        match &error {
            umbrage::Error::Conflict(conflict) => return Self::Input(conflict_in_options(conflict)),
            umbrage::Error::InvalidSetting { field, .. } if SETTINGS.iter().any(|setting| setting.key == *field) => {
                return Self::Input(format!("--{field}: {error}"));
            }
            _ => {}
        }
        let option = match &error {
            umbrage::Error::InvalidSetting { field, .. } => match *field {
                "map_sizes" => "--map-size, --splits",
                "range" => "--shadow-range",
                "lambda" => "--lambda",
                "delta" => "--delta",
                "planes" => "--planes",
                "blend" => "--blend",
                "far_fade" => "--far-fade",
                "filter_radius" => "--filter",
                "filter_half_width_m" => "--filter-width, --sun-angle",
                "image_size" => "--size",
                "stabilize" => "--extent-steps, --extent-levels",
                "warps" => "--warp, --tsm-focus",
                _ => "",
            },
            umbrage::Error::ConflictingSettings { first: "bands", second: "camera", .. } => "--bands, --camera",
            umbrage::Error::ConflictingSettings { first: "bands", second: "light", .. } => "--bands, --light",
            umbrage::Error::ConflictingSettings { second: "light", .. } => "--warp, --light",
            umbrage::Error::ConflictingSettings { .. } => "--warp, --stabilize",
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

/// No adapter and a failing device are nobody's bad input; everything else names an option or the scene.
impl From<umbrage_render::Error> for Failure {
    fn from(error: umbrage_render::Error) -> Self {
        use umbrage_render::Error as E;
        match error {
            E::NoAdapter { .. } | E::NoDevice { .. } | E::Device { .. } | E::OutOfMemory { .. } => {
                Self::other(error.to_string())
            }
            E::Plan(error) => error.into(),
            E::ImageSize { .. } => Self::input(format!("--size: {error}")),
            E::Shadows(error) => Self::input(in_options(&error)),
            E::Probe { .. } => Self::input(format!("--points: {error}")),
            _ => Self::input(error.to_string()),
        }
    }
}

/// What the loader refuses is a file or an option.
impl From<umbrage_scene::Error> for Failure {
    fn from(error: umbrage_scene::Error) -> Self {
        match error {
            umbrage_scene::Error::View(error) => error.into(),
            _ => Self::input(error.to_string()),
        }
    }
}

/// What the judge refuses is the scene or an option.
impl From<umbrage_truth::Error> for Failure {
    fn from(error: umbrage_truth::Error) -> Self {
        Self::input(error.to_string())
    }
}

/// The library's message in the language of the command line.
#[must_use]
pub fn in_options(error: &umbrage_wgpu::Error) -> String {
    match error {
        umbrage_wgpu::Error::MapTooLarge { .. } => format!("--map-size: {error}"),
        umbrage_wgpu::Error::FilterTooWide { .. } => format!("--filter-width: {error}"),
        other => other.to_string(),
    }
}

/// A rule of the config that options break, in the language of the command line.
fn conflict_in_options(conflict: &Conflict) -> String {
    let Conflict { rule, first, second } = conflict;
    format!("--{first} and --{second} exclude each other: {}; {}", rule.reason, rule.remedy)
}
