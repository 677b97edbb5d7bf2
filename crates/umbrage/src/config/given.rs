//! Settings given as text, and the reason why a value was refused.

/// Settings as keys and values, in the order in which they were given. If a key is given twice, its
/// last value counts.
#[derive(Clone, Copy, Debug)]
pub struct Given<'a>(pub &'a [(String, String)]);

impl<'a> Given<'a> {
    /// The value of a key.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&'a str> {
        self.0.iter().rev().find(|(given, _)| given == key).map(|(_, value)| value.as_str())
    }

    /// Returns whether a key was given.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.value(key).is_some()
    }
}

/// Reason why a setting's value was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// The setting at fault, if it is not the one whose value is read.
    pub(super) key: Option<&'static str>,
    pub(super) reason: String,
}

impl From<String> for Wrong {
    fn from(reason: String) -> Self {
        Self { key: None, reason }
    }
}

impl From<&str> for Wrong {
    fn from(reason: &str) -> Self {
        reason.to_owned().into()
    }
}

/// Refuses a value for a reason.
pub(super) fn refuse<T>(reason: impl Into<Wrong>) -> Result<T, Wrong> {
    Err(reason.into())
}

/// Refuses a value of another setting for a reason.
pub(super) fn refuse_other<T>(key: &'static str, reason: String) -> Result<T, Wrong> {
    Err(Wrong { key: Some(key), reason })
}
