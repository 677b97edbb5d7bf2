//! What went wrong, sorted by whose fault it is: that decides the exit code.

use std::{io, path::Path};

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

    /// The exit code of the process: 2 for bad input, 1 for anything else.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Other(_) => 1,
        }
    }
}

/// Names the option behind a field of the planner's, so that the message speaks the language of the command line.
impl From<umbrage::Error> for Failure {
    fn from(error: umbrage::Error) -> Self {
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
