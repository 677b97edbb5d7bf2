//! Requests of a technique: a config, and the options that it was made from.

use std::path::PathBuf;

use umbrage::ShadowConfig;
use umbrage::config::{Filter, LightKind, Preset, RULES, SETTINGS};
use umbrage_render::{LightMaps, RenderSettings, Samples};

use super::file::ConfigFile;
use crate::{
    failure::{Failure, Result, in_options},
    lights::{self, NamedLight},
};

/// Options of a technique: settings over a preset or a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowOptions {
    /// Preset that the settings override.
    pub preset: Option<Preset>,
    /// File with a config (TOML or JSON), or a report.
    pub file: Option<PathBuf>,
    /// Settings by key.
    pub given: Vec<(String, String)>,
    /// True if the picture is coloured by split.
    pub tint: bool,
    /// True if nothing casts shadows.
    pub shadows_off: bool,
}

/// A technique of shadows with the options that it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowRequest {
    /// Config of the technique.
    pub config: ShadowConfig,
    /// Options that the config was made from.
    pub options: ShadowOptions,
    /// Settings that were changed to make room for others.
    pub notes: Vec<String>,
}

impl ShadowRequest {
    /// Puts the settings over the preset or the file.
    ///
    /// # Errors
    /// [`Failure::Input`] with the setting or the file at fault.
    pub fn new(options: ShadowOptions) -> Result<Self> {
        for (key, value) in &options.given {
            let setting = SETTINGS.iter().find(|setting| setting.key == key);
            let checked = setting.map_or(Ok(()), |setting| setting.check(value.trim()));
            checked.map_err(|why| Failure::input(format!("--{key} {value}: {why}")))?;
        }
        let mut config = match (&options.file, options.preset) {
            (Some(file), Some(preset)) => {
                return Err(Failure::input(format!(
                    "--config {} and --preset {preset} both choose all settings; give one of them",
                    file.display()
                )));
            }
            (Some(file), None) => ConfigFile::load(file)?.config,
            (None, preset) => preset.unwrap_or_default().config(),
        };
        let notes = config.apply(&options.given).map_err(|error| Failure::of_settings(&error, &options.given))?;
        let notes = notes.iter().map(|note| in_options(note)).collect();
        Ok(Self { config, options, notes })
    }

    /// Sets the angular diameter of the sun in degrees, which the filter pcss uses.
    #[must_use]
    pub fn under_sun(mut self, sun_angle: Option<f64>) -> Self {
        if let (Filter::Pcss { sun_degrees, .. }, Some(angle)) = (&mut self.config.filter, sun_angle) {
            *sun_degrees = angle;
        }
        self
    }

    /// Adapts the technique to the kinds of lights. Settings that the lights exclude are changed,
    /// unless they were asked for.
    ///
    /// # Errors
    /// [`Failure::Input`] with the setting and the light that exclude each other.
    pub fn for_lights(&self, lights: &[NamedLight]) -> Result<Self> {
        let kinds = lights::kinds(lights);
        let mut request = self.clone();
        for rule in RULES.iter().filter(|rule| rule.is_about_lights()) {
            if !rule.is_broken_by(&request.config, &kinds) {
                continue;
            }
            let said = rule.first.say(&request.config);
            let asked = rule.first.keys().iter().any(|key| self.options.given.iter().any(|(given, _)| given == key));
            if asked || !rule.first.relax(&mut request.config) {
                let names: Vec<&str> = lights.iter().map(|light| light.name.as_str()).collect();
                return Err(Failure::input(format!(
                    "--{said} and --light {} exclude each other: {}; {}",
                    names.join(","),
                    rule.reason,
                    rule.remedy
                )));
            }
            request.notes.push(in_options(&format!("{said} is ignored: {}", rule.reason)));
        }
        request.config.validate_for(&kinds).map_err(|error| Failure::of_settings(&error, &self.options.given))?;
        Ok(request)
    }

    /// Makes the settings of a renderer.
    #[must_use]
    pub fn render_settings(&self, size: [u32; 2], samples: Samples, lights: Vec<LightKind>) -> RenderSettings {
        let lights = lights.into_iter().map(LightMaps::from).collect();
        RenderSettings { size, samples, config: self.config.clone(), lights, ..RenderSettings::default() }
    }

    /// Returns a setting's value as text; empty if the config has no such setting.
    #[must_use]
    pub fn word(&self, key: &str) -> String {
        word(&self.config, key)
    }
}

/// Returns a setting's value as text; empty if the config has no such setting.
#[must_use]
pub fn word(config: &ShadowConfig, key: &str) -> String {
    let setting = SETTINGS.iter().find(|setting| setting.key == key);
    setting.and_then(|setting| setting.get(config)).map(|value| value.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(given: &[(&str, &str)]) -> ShadowOptions {
        let given = given.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        ShadowOptions { given, ..ShadowOptions::default() }
    }

    #[test]
    fn options_go_over_a_preset() {
        let request =
            ShadowRequest::new(ShadowOptions { preset: Some(Preset::Papers), ..options(&[("lambda", "0.9")]) });
        assert_eq!(request.unwrap().word("lambda"), "0.9");
        let both =
            ShadowOptions { preset: Some(Preset::Fast), file: Some("x.toml".into()), ..ShadowOptions::default() };
        assert!(ShadowRequest::new(both).unwrap_err().to_string().contains("--preset fast"));
        let missing = ShadowOptions { file: Some("no-such-file.toml".into()), ..ShadowOptions::default() };
        assert!(ShadowRequest::new(missing).unwrap_err().to_string().contains("no-such-file.toml"));
    }
}
