//! Words that have a new name: an old word is refused by a message that names the new one.

/// A word of a setting that has a new name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Renamed {
    /// The setting's key.
    pub key: &'static str,
    /// The word of former versions.
    pub old: &'static str,
    /// The word that replaces it.
    pub new: &'static str,
}

/// All words of settings that have a new name. No key has one: each is the name of an option of the
/// command, and scripts use these.
pub const RENAMED: &[Renamed] = &[Renamed { key: "scheme", old: "fitted", new: "optimal" }];

impl Renamed {
    /// The row of a setting's old word; `None` for any other word.
    #[must_use]
    pub fn find(key: &str, word: &str) -> Option<&'static Self> {
        RENAMED.iter().find(|row| row.key == key && row.old == word.trim())
    }
}

impl std::fmt::Display for Renamed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { key, old, new } = self;
        write!(f, "{key} `{old}` is now called `{new}`")
    }
}
