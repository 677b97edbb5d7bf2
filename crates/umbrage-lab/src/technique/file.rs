//! The file of `--config`: a config as TOML or JSON, or a report, which also holds the request of
//! its picture.

use std::path::Path;

use serde_json::Value;
use umbrage::ShadowConfig;

use crate::failure::{Failure, Result};

/// Content of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ConfigFile {
    /// Config of the shadows.
    pub config: ShadowConfig,
    /// Request of the picture, if the file is a report.
    pub drawn: Option<Drawn>,
}

/// Request of a picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Scene, camera, light and time as options of `umbrage render`.
    pub options: Vec<String>,
    /// Number of the picture among several frames.
    pub frame: Option<u32>,
}

impl ConfigFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Failure::Input`] with the file and its fault.
    pub fn load(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|error| Failure::file("read", path, &error))?;
        Self::parse(&text).map_err(|why| Failure::input(format!("--config {}: {why}", path.display())))
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> std::result::Result<Self, String> {
        if !text.trim_start().starts_with('{') {
            let config = toml::from_str(text).map_err(|error| error.to_string())?;
            return Ok(Self { config, drawn: None });
        }
        let json: Value = serde_json::from_str(text).map_err(|error| format!("is neither JSON nor TOML: {error}"))?;
        let drawn = drawn(&json)?;
        let is_report = json.get("adapter").is_some() || json.get("splits").is_some_and(Value::is_array);
        let config = match json.get("config") {
            Some(config) => config.clone(),
            None if json.get("techniques").is_some() => {
                return Err(
                    "is a report of several techniques, of `umbrage compare` or `umbrage bench`; give a report \
                            of `umbrage render`"
                        .to_owned(),
                );
            }
            None if is_report || json.get("scene").is_some() => {
                return Err("is a report without a config, of `umbrage truth`, of `umbrage plan` or of a former \
                            version; give a report of `umbrage render`"
                    .to_owned());
            }
            None => json,
        };
        let config = serde_json::from_value(config).map_err(|error| error.to_string())?;
        Ok(Self { config, drawn })
    }
}

/// Reads the request of a report's picture.
fn drawn(json: &Value) -> std::result::Result<Option<Drawn>, String> {
    let Some(options) = json.get("options") else { return Ok(None) };
    let options = serde_json::from_value(options.clone()).map_err(|error| format!("its options: {error}"))?;
    let frame = json.get("frame").cloned().unwrap_or_default();
    let frame = serde_json::from_value(frame).map_err(|error| format!("its frame: {error}"))?;
    Ok(Some(Drawn { options, frame }))
}

#[cfg(test)]
mod tests {
    use umbrage::config::Preset;

    use super::*;

    fn config(text: &str) -> std::result::Result<ShadowConfig, String> {
        ConfigFile::parse(text).map(|file| file.config)
    }

    #[test]
    fn files_are_toml_json_or_reports() {
        let papers = Preset::Papers.config();
        assert_eq!(config("preset = \"papers\"\n").as_ref(), Ok(&papers));
        let toml = config("preset = \"papers\"\nmap-size = [512, 256]\nsplits = 2\nblend = 0.2\n").unwrap();
        assert_eq!((toml.map_sizes.as_slice(), toml.blend()), (&[512, 256][..], 0.2));
        let json = serde_json::to_string(&toml).unwrap();
        assert_eq!(config(&json).as_ref(), Ok(&toml));
        assert_eq!(config(&format!("{{\"adapter\": \"x\", \"config\": {json}}}")).as_ref(), Ok(&toml));
        for (bad, culprit) in [
            ("{", "JSON"),
            ("splits = ", "splits"),
            ("colour = 3", "colour"),
            ("{\"splits\": 99}", "splits"),
            ("blend = []", "blend"),
            ("{\"adapter\": \"x\"}", "without a config"),
            ("{\"scene\": \"x\", \"splits\": []}", "umbrage plan"),
            ("{\"adapter\": \"x\", \"techniques\": []}", "umbrage compare"),
            ("{\"config\": {}, \"options\": 3}", "its options"),
            ("{\"config\": {}, \"options\": [], \"frame\": -1}", "its frame"),
        ] {
            let message = config(bad).unwrap_err();
            assert!(message.contains(culprit), "{bad}: {message}");
        }
    }

    #[test]
    fn reports_say_how_their_picture_was_asked_for() {
        let drawn = |text: &str| ConfigFile::parse(text).unwrap().drawn;
        assert_eq!(drawn("splits = 2"), None);
        assert_eq!(drawn("{\"config\": {}}"), None);
        let options = vec!["robot-war".to_owned(), "--time=2".to_owned()];
        let report = r#"{"config": {}, "options": ["robot-war", "--time=2"]}"#;
        assert_eq!(drawn(report), Some(Drawn { options: options.clone(), frame: None }));
        let report = r#"{"config": {}, "options": ["robot-war", "--time=2"], "frame": 3}"#;
        assert_eq!(drawn(report), Some(Drawn { options, frame: Some(3) }));
    }
}
