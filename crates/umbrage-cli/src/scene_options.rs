//! The options of scene, camera, light and time as typed, which override those of a report when its
//! picture is drawn again.

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args as _, Command, FromArgMatches, parser::ValueSource};
use umbrage_lab::{
    failure::{Failure, Result},
    scene_request::SceneRequest,
    technique::{ConfigFile, Drawn, ShadowRequest},
};
use umbrage_scene::procedural::World;

use crate::{scene_args::SceneArgs, shadow_args::ShadowArgs, switch::Switch};

/// Key of SCENE, which has no dashes.
const SCENE: &str = "scene";

/// Options of a report that a typed option replaces besides itself, because they choose the same
/// property in another way.
const REPLACED: [(&str, &[&str]); 6] = [
    ("camera", &["eye", "target", "path"]),
    ("eye", &["camera", "path"]),
    ("target", &["camera", "path"]),
    ("path", &["camera", "eye", "target"]),
    ("light", &["sun"]),
    ("sun", &["light"]),
];

/// The options of [`SceneArgs`] that were typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneOptions(Vec<Typed>);

/// A typed option, or SCENE.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Typed {
    key: String,
    value: Option<String>,
}

/// Requests of a subcommand: the scene and its shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Request of scene, camera, light and time.
    pub scene: SceneRequest,
    /// Request of the technique of shadows.
    pub shadows: ShadowRequest,
}

impl Asked {
    /// Makes the requests from the options of both kinds, which override those of `--config`.
    ///
    /// # Errors
    /// [`Failure::Input`] with the option or the file at fault.
    pub fn new(scene: &SceneOptions, shadows: &ShadowArgs) -> Result<Self> {
        let args = scene.over(shadows.file())?;
        let request = args.request()?;
        let shadows = shadows.request(&args)?;
        Ok(Self { scene: request, shadows })
    }
}

impl clap::Args for SceneOptions {
    fn augment_args(command: Command) -> Command {
        SceneArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        SceneArgs::augment_args_for_update(command)
    }
}

impl FromArgMatches for SceneOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let command = parser();
        let typed = command.get_arguments().filter_map(|arg| {
            let key = arg.get_id().as_str();
            if matches.value_source(key) != Some(ValueSource::CommandLine) {
                return None;
            }
            let value = matches.get_raw(key).and_then(|mut values| values.next()).unwrap_or_default();
            let value = arg.get_action().takes_values().then(|| value.to_string_lossy().into_owned());
            Some(Typed { key: arg.get_long().unwrap_or(SCENE).to_owned(), value })
        });
        Ok(Self(typed.collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Makes a parser of these options alone.
fn parser() -> Command {
    SceneArgs::augment_args(Command::new("umbrage render").no_binary_name(true).disable_help_flag(true))
}

impl SceneOptions {
    /// Returns these options, with a scene if none was typed.
    #[must_use]
    pub fn or_scene(&self, scene: &str) -> Self {
        let mut options = self.clone();
        if options.value(SCENE).is_none() {
            options.0.push(Typed { key: SCENE.to_owned(), value: Some(scene.to_owned()) });
        }
        options
    }

    /// Merges the options with those of the report `file`, if the file is a report.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is no scene in either, or with the fault of the report.
    pub fn over(&self, file: Option<&Path>) -> Result<SceneArgs> {
        let report = file.map(ConfigFile::load).transpose()?.and_then(|file| file.drawn);
        let (merged, only_frame) = match (file, report) {
            (Some(file), Some(drawn)) => self.over_report(file, &drawn)?,
            _ => (self.clone(), None),
        };
        if merged.value(SCENE).is_none() {
            return Err(Failure::input(match file {
                Some(file) => format!(
                    "no scene: --config {} names none, as settings alone and reports of former versions do not; give SCENE",
                    file.display()
                ),
                None => "no scene: give SCENE, or --config with a report of `umbrage render`".to_owned(),
            }));
        }
        let args = parser().try_get_matches_from(merged.words()).and_then(|found| SceneArgs::from_arg_matches(&found));
        let args = args.map_err(|error| {
            // What was typed has been parsed before.
            let file =
                file.map(Path::display).map(|file| format!("--config {file}: its options: ")).unwrap_or_default();
            Failure::input(format!("{file}{}", error.to_string().trim_start_matches("error: ").trim_end()))
        })?;
        Ok(SceneArgs { only_frame, options: merged.words(), ..args })
    }

    /// Merges the options with those of a report. Returns them and the only frame that is shown, if
    /// that still applies.
    fn over_report(&self, file: &Path, drawn: &Drawn) -> Result<(Self, Option<u32>)> {
        let mut kept: Vec<Typed> = drawn.options.iter().map(|option| Typed::parse(option)).collect();
        kept.retain(|old| !self.0.iter().any(|new| new.replaces(&old.key)));
        // Frames go along a path or a moving sun.
        let has = |key: &str| kept.iter().any(|old| old.key == key) || self.0.iter().any(|new| new.key == key);
        if !has("path") && !has("sun-to") {
            kept.retain(|old| old.key != "frames");
        }
        let only_frame = drawn.frame.filter(|_| kept.iter().any(|old| old.key == "frames"));
        for old in &mut kept {
            let is_world = old.key == SCENE && old.value.as_deref().and_then(World::from_name).is_some();
            if [SCENE, "path"].contains(&old.key.as_str()) && !is_world {
                let name = old.value.as_deref().unwrap_or_default();
                old.value = Some(found(file, &old.key, name)?);
            }
        }
        kept.extend(self.0.iter().cloned());
        Ok((Self(kept), only_frame))
    }

    fn value(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|typed| typed.key == key)?.value.as_deref()
    }

    /// Returns the options as words of a command line, SCENE first.
    fn words(&self) -> Vec<String> {
        let (scene, options): (Vec<&Typed>, Vec<&Typed>) = self.0.iter().partition(|typed| typed.key == SCENE);
        scene.into_iter().chain(options).map(Typed::word).collect()
    }
}

impl Typed {
    fn parse(word: &str) -> Self {
        let Some(option) = word.strip_prefix("--") else {
            return Self { key: SCENE.to_owned(), value: Some(word.to_owned()) };
        };
        match option.split_once('=') {
            Some((key, value)) => Self { key: key.to_owned(), value: Some(value.to_owned()) },
            None => Self { key: option.to_owned(), value: None },
        }
    }

    fn word(&self) -> String {
        match (self.key.as_str(), &self.value) {
            // A file whose name looks like an option.
            (SCENE, Some(name)) if name.starts_with('-') => format!("./{name}"),
            (SCENE, Some(name)) => name.clone(),
            (key, Some(value)) => format!("--{key}={value}"),
            (key, None) => format!("--{key}"),
        }
    }

    fn replaces(&self, key: &str) -> bool {
        let others = REPLACED.iter().find(|(new, _)| *new == self.key).map_or(&[][..], |(_, old)| old);
        self.key == key || others.contains(&key)
    }
}

/// Finds a file that a report names: from the working directory, else from the report's folder.
fn found(report: &Path, key: &str, name: &str) -> Result<String> {
    let folder = report.parent().map(Path::to_path_buf).unwrap_or_default();
    let beside: PathBuf = folder.join(name);
    if Path::new(name).exists() {
        return Ok(name.to_owned());
    }
    if beside.exists() {
        return Ok(beside.to_string_lossy().into_owned());
    }
    let option = if key == SCENE { "SCENE" } else { "--path FILE" };
    let places =
        if Path::new(name).is_absolute() { "there" } else { "in the working directory or in the report's folder" };
    Err(Failure::input(format!(
        "--config {}: its {key} {name} is not {places}; give {option}, or put the file where it was",
        report.display()
    )))
}

impl ShadowArgs {
    /// Returns the file of `--config`.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        self.0.file.as_deref()
    }

    /// Makes the request of the shadows, for the picture of `scene`.
    ///
    /// # Errors
    /// [`Failure::Input`] with the option at fault.
    pub fn request(&self, scene: &SceneArgs) -> Result<ShadowRequest> {
        let mut options = self.0.clone();
        options.tint = scene.tint;
        options.shadows_off = scene.shadows == Switch::Off;
        Ok(ShadowRequest::new(options)?.under_sun(scene.sun_angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(words: &str) -> SceneOptions {
        let matches = parser().try_get_matches_from(words.split_whitespace()).expect("an argument list");
        SceneOptions::from_arg_matches(&matches).expect("options")
    }

    fn over(words: &str, options: &str, frame: Option<u32>) -> (String, Option<u32>) {
        let drawn = Drawn { options: options.split_whitespace().map(str::to_owned).collect(), frame };
        let (merged, frame) = typed(words).over_report(Path::new("report.json"), &drawn).expect("a world");
        (merged.words().join(" "), frame)
    }

    #[test]
    fn what_was_typed_is_kept_as_it_was_typed() {
        let words = "knights --eye -1,2,3e1 --target 0,0,0 --size 64x48 --parent-folders --tint --time 0";
        let kept = "knights --parent-folders --time=0 --size=64x48 --eye=-1,2,3e1 --target=0,0,0 --tint=true";
        assert_eq!(typed(words).words().join(" "), kept);
        assert_eq!(typed(kept), typed(words), "defaults are not among them");
        assert_eq!(typed("-- --odd.glb").words(), ["./--odd.glb"]);
    }

    #[test]
    fn what_is_typed_goes_over_the_report() {
        let report = "robot-war --size=64x48 --camera=middle --far=300 --sun=1,-1,0";
        assert_eq!(over("", report, None).0, report);
        for (words, merged) in [
            ("--size 32x24", "robot-war --camera=middle --far=300 --sun=1,-1,0 --size=32x24"),
            ("knights", "knights --size=64x48 --camera=middle --far=300 --sun=1,-1,0"),
            ("--light 0", "robot-war --size=64x48 --camera=middle --far=300 --light=0"),
            ("--eye 1,2,3 --target 0,0,0", "robot-war --size=64x48 --far=300 --sun=1,-1,0 --eye=1,2,3 --target=0,0,0"),
        ] {
            assert_eq!(over(words, report, None).0, merged);
        }
        let report = "robot-war --eye=1,2,3 --target=0,0,0";
        assert_eq!(over("--eye 3,2,1", report, None).0, "robot-war --target=0,0,0 --eye=3,2,1");
        assert_eq!(over("--camera near", report, None).0, "robot-war --camera=near");
    }

    #[test]
    fn a_frame_stays_the_only_one_until_frames_are_asked_for() {
        let report = "robot-war --sun=1,-1,0 --sun-to=0,-1,0 --frames=5";
        assert_eq!(over("", report, Some(3)), (report.to_owned(), Some(3)));
        assert_eq!(over("--camera near", report, Some(3)).1, Some(3));
        assert_eq!(over("--frames 9", report, Some(3)).1, None);
        let here = file!();
        let report = format!("robot-war --path={} --frames=5", Path::new(here).file_name().unwrap().display());
        let drawn = Drawn { options: report.split_whitespace().map(str::to_owned).collect(), frame: Some(3) };
        let merged = |words: &str| {
            let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/report.json");
            let (merged, frame) = typed(words).over_report(&beside, &drawn).expect("a path beside the report");
            (merged.words().join(" "), frame)
        };
        assert!(merged("").0.contains("--path=/") && merged("").0.ends_with("--frames=5"));
        assert_eq!(merged("").1, Some(3));
        assert_eq!(merged("--camera near"), ("robot-war --camera=near".to_owned(), None));
    }
}
