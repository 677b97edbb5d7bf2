//! Errors in settings, cameras, lights and bounds.

/// [`std::result::Result`] with this crate's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Error in the planner's input. Every message names the field, the problem and the values that are
/// allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter of the camera is out of range.
    #[error("camera {field} is {value}, but it has to be {expected}")]
    InvalidCamera {
        /// The parameter at fault.
        field: &'static str,
        /// The value as given.
        value: f64,
        /// Values that are allowed.
        expected: &'static str,
    },
    /// The matrices of an orthographic camera do not say which way it looks.
    #[error(
        "orthographic matrices do not say which way a camera looks: a left-handed or mirrored one shares them with a \
         reversed one; use View::from_orthographic, which takes the direction"
    )]
    OrthographicDirection,
    /// A parameter of a light is out of range.
    #[error("light {field}: {reason}")]
    InvalidLight {
        /// The parameter at fault.
        field: &'static str,
        /// Problem and remedy.
        reason: String,
    },
    /// A shadow setting is out of range.
    #[error("shadow setting {field}: {reason}")]
    InvalidSetting {
        /// The setting at fault by its key in [`crate::config::SETTINGS`], or the field of
        /// [`crate::PlannerOptions`], [`crate::FilterReach`] or [`crate::PlanInputs`].
        field: &'static str,
        /// Problem and remedy.
        reason: String,
    },
    /// A shadow setting and the camera exclude each other.
    #[error("shadow setting {setting} and the camera exclude each other: {reason}")]
    CameraConflict {
        /// The setting's key.
        setting: &'static str,
        /// Reason and remedy.
        reason: String,
    },
    /// Two settings of a [`crate::ShadowConfig`], or a setting and the light, exclude each other.
    #[error("{0}")]
    Conflict(Box<crate::config::Conflict>),
    /// No setting has this key.
    #[error("{key:?} is not a shadow setting; see docs/settings.md (umbrage::config::SETTINGS)")]
    UnknownSetting {
        /// The key as given.
        key: String,
    },
    /// A setting was given a word of a former version.
    #[error("shadow setting {0}")]
    RenamedWord(crate::config::Renamed),
    /// A budget cannot be read.
    #[error("budget {text:?}: {reason}")]
    InvalidBudget {
        /// The budget as given.
        text: String,
        /// Problem and remedy.
        reason: String,
    },
    /// A budget does not pay for one map.
    #[error("a budget of {budget} is too small for one split; give at least {least}")]
    BudgetTooSmall {
        /// The budget as given.
        budget: crate::config::Budget,
        /// The least budget that pays for one map.
        least: crate::config::Budget,
    },
    /// The bounds of a caster or receiver are inverted, NaN or beyond 10^12 m.
    #[error(
        "{list}[{index}] has no valid bounds ({min} to {max}); give finite corners with min <= max, within ±10^12 m"
    )]
    InvalidBounds {
        /// `casters`, `receivers` or `receiver_clusters`.
        list: &'static str,
        /// Index into that list.
        index: usize,
        /// Minimum corner as given.
        min: glam::DVec3,
        /// Maximum corner as given.
        max: glam::DVec3,
    },
    /// A caster of a [`crate::CasterSet`] has bounds that are inverted, NaN or beyond 10^12 m.
    #[error(
        "caster {} has no valid bounds ({min} to {max}); give finite corners with min <= max, within ±10^12 m",
        handle.map_or_else(|| format!("with key {key}"), |handle| format!("{handle} (key {key})"))
    )]
    InvalidCaster {
        /// Handle of the caster, if it has one yet.
        handle: Option<crate::CasterHandle>,
        /// Key of the caster.
        key: u32,
        /// Minimum corner as given.
        min: glam::DVec3,
        /// Maximum corner as given.
        max: glam::DVec3,
    },
    /// No caster of this [`crate::CasterSet`] has the handle.
    #[error("no caster of this set has handle {handle}: it was removed, or belongs to another set")]
    RemovedCaster {
        /// The handle.
        handle: crate::CasterHandle,
    },
    /// A layer has a number that does not exist.
    #[error("there is no layer {layer}; layers are counted from 0 to 31")]
    NoSuchLayer {
        /// The layer as given.
        layer: u32,
    },
    /// A [`crate::CasterSet`] is full.
    #[error("a set holds 67,108,864 casters at most; keep some of them in another set, or merge small ones")]
    TooManyCasters,
    /// The casters of a [`crate::CasterSet`] have too many combinations of layers and flags.
    #[error("the casters of a set have 65,536 combinations of layers and flags at most; use fewer layers")]
    TooManyCasterKinds,
}

impl Error {
    pub(crate) fn camera(field: &'static str, value: f64, expected: &'static str) -> Self {
        Self::InvalidCamera { field, value, expected }
    }

    pub(crate) fn light(field: &'static str, reason: impl Into<String>) -> Self {
        Self::InvalidLight { field, reason: reason.into() }
    }

    pub(crate) fn setting(field: &'static str, reason: impl Into<String>) -> Self {
        Self::InvalidSetting { field, reason: reason.into() }
    }
}
