//! Applies settings given as text to a config. A setting that was not given is reset if it excludes
//! one that was.

use super::given::{Given, Wrong};
use super::{RULES, Renamed, SETTINGS, ShadowConfig, settings};
use crate::{Error, Result as UmbrageResult};

impl ShadowConfig {
    /// Applies settings to this config. A setting that was not given and excludes one that was is
    /// reset; the notes name it.
    ///
    /// # Errors
    /// [`Error::UnknownSetting`] naming a key that does not exist, [`Error::RenamedWord`] for a word
    /// of [`super::RENAMED`], [`Error::InvalidSetting`] naming a key whose value is wrong,
    /// [`Error::Conflict`] naming two settings that exclude each other. The config is then
    /// unchanged.
    pub fn apply(&mut self, given: &[(String, String)]) -> UmbrageResult<Vec<String>> {
        let given = Given(given);
        if let Some((key, _)) = given.0.iter().find(|(key, _)| settings::find(key).is_none()) {
            return Err(Error::UnknownSetting { key: key.clone() });
        }
        if let Some(renamed) = given.0.iter().find_map(|(key, value)| Renamed::find(key, value)) {
            return Err(Error::RenamedWord(*renamed));
        }
        let mut config = self.clone();
        for setting in SETTINGS {
            if let Some(value) = given.value(setting.key) {
                (setting.set)(&mut config, value.trim(), &given)
                    .map_err(|Wrong { key, reason }| Error::setting(key.unwrap_or(setting.key), reason))?;
            }
        }
        let notes = config.reset_excluded(&given);
        config.validate()?;
        *self = config;
        Ok(notes)
    }

    /// All settings of this config as keys and values, in the form that [`ShadowConfig::apply`]
    /// reads.
    #[must_use]
    pub fn settings(&self) -> Vec<(&'static str, super::Value)> {
        let listed = SETTINGS.iter().filter_map(|setting| Some((setting.key, setting.get(self)?)));
        // A technique is splits, map sizes and warps under one name.
        listed.filter(|(key, _)| *key != "technique").collect()
    }

    /// Resets settings that were not given where they exclude ones that were.
    fn reset_excluded(&mut self, given: &Given<'_>) -> Vec<String> {
        let mut notes = Vec::new();
        for rule in RULES {
            if !rule.is_broken_by(self, &[]) {
                continue;
            }
            let asked = |choice: super::Choice| choice.keys().iter().any(|key| given.has(key));
            let weak = match (asked(rule.first), asked(rule.second)) {
                (true, true) => continue,
                (true, false) => rule.second,
                (false, _) => rule.first,
            };
            let said = weak.say(self);
            if weak.relax(self) {
                notes.push(format!("{said} is ignored: {}", rule.reason));
            }
        }
        notes
    }
}
