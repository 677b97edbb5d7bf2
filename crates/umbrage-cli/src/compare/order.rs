//! What is to be compared, all options and presets taken together, everything checked that can be before a frame is drawn.

use std::path::{Path, PathBuf};

use super::{
    args::CompareArgs,
    preset::{self, Content},
    shots::{Set, Stride, SunSpec, Wish, sun_spec},
    techniques::{self, Rejected, Technique},
};
use crate::{
    failure::{Failure, Result},
    output,
};

/// Names of the files in `-o DIR`.
const IN_FOLDER: [&str; 4] = ["sheet.png", "errors.png", "scores.json", "compare.html"];

/// What is to be done.
#[derive(Debug)]
pub struct Order {
    /// The rows.
    pub techniques: Vec<Technique>,
    /// Scenes, opened, with their views.
    pub sets: Vec<Set>,
    /// Where things go.
    pub outputs: Outputs,
    /// What was left out.
    pub notes: Vec<String>,
}

/// Where things go.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// The folder for everything.
    pub folder: Option<PathBuf>,
    /// Sheet, errors, JSON and page, in the order of [`IN_FOLDER`].
    pub files: [Option<PathBuf>; 4],
}

impl Outputs {
    /// Everything that is to be written: its number in [`IN_FOLDER`] and its path, those in the folder with a name only.
    fn new(args: &CompareArgs) -> Result<Self> {
        let files = [&args.sheet, &args.errors, &args.json, &args.html].map(Clone::clone);
        let outputs = Self { folder: args.folder.clone(), files };
        if outputs.folder.is_none() && outputs.files.iter().all(Option::is_none) {
            return Err(Failure::input(
                "nothing to write: give -o DIR, or some of --sheet PNG, --errors PNG, --json JSON, --html HTML",
            ));
        }
        Ok(outputs)
    }

    fn check(&self, inputs: &[&Path]) -> Result<()> {
        let mut files: Vec<PathBuf> = self.files.iter().flatten().cloned().collect();
        let mut folders = Vec::new();
        match &self.folder {
            // Into a folder that is there go single files, each of which may be in the way of something.
            Some(folder) if folder.is_dir() => files.extend(IN_FOLDER.map(|name| folder.join(name))),
            Some(folder) => folders.push(folder.as_path()),
            None => {}
        }
        let files: Vec<&Path> = files.iter().map(AsRef::as_ref).collect();
        output::check(&files, &folders, inputs)
    }

    /// Stages the four files, in the order of [`IN_FOLDER`], wherever they were asked for.
    pub fn stage(&self, contents: [Vec<u8>; 4], staged: &mut output::Staged) -> Result<()> {
        for (path, bytes) in self.files.iter().zip(&contents) {
            if let Some(path) = path {
                staged.file(path, bytes.clone())?;
            }
        }
        if let Some(folder) = &self.folder {
            let files = IN_FOLDER.iter().map(|name| (*name).to_owned()).zip(contents).collect();
            staged.folder(folder, files)?;
        }
        Ok(())
    }
}

impl Order {
    /// # Errors
    /// [`Failure::Input`] naming the option, technique or file at fault.
    pub fn new(args: &CompareArgs) -> Result<Self> {
        let outputs = Outputs::new(args)?;
        let content = args.preset.map(preset::content);
        let mut notes = Vec::new();
        let techniques = techniques_of(args, content, &mut notes)?;
        let scenes = scenes_of(args, content)?;
        let mut inputs: Vec<&Path> = scenes.iter().map(Path::new).collect();
        inputs.extend([&args.path, &args.techniques_file].into_iter().flatten().map(AsRef::<Path>::as_ref));
        outputs.check(&inputs)?;
        let wish = wish_of(args, content, scenes.len())?;
        let sets = scenes.iter().map(|scene| wish.open(scene)).collect::<Result<Vec<Set>>>()?;
        Ok(Self { techniques, sets, outputs, notes })
    }
}

fn techniques_of(args: &CompareArgs, content: Option<&Content>, notes: &mut Vec<String>) -> Result<Vec<Technique>> {
    let mut with = techniques::parse_with(content.map_or("", |content| content.with))?;
    let mut drafts = Vec::new();
    for text in content.map_or(&[][..], |content| content.techniques) {
        let draft = techniques::parse(text)?;
        match draft.finish(&with, args.shadow_range, args.size()) {
            Ok(_) => drafts.push(draft),
            Err(Rejected::NotBuilt(failure)) => notes.push(format!("left out of the preset: {failure}")),
            Err(Rejected::Wrong(failure)) => return Err(failure),
        }
    }
    if let Some(path) = &args.techniques_file {
        let (with_of_file, from_file) = techniques::load(path)?;
        with.extend(with_of_file);
        drafts.extend(from_file);
    }
    for text in &args.techniques {
        drafts.push(techniques::parse(text)?);
    }
    with.extend(techniques::parse_with(args.with.as_deref().unwrap_or(""))?);
    if drafts.is_empty() {
        return Err(Failure::input(
            "no technique: give --techniques (for example pssm:4:1024,ssm:2048), --techniques-file or --preset",
        ));
    }
    Ok(techniques::finish(&drafts, &with, args.shadow_range, args.size())?)
}

fn scenes_of(args: &CompareArgs, content: Option<&Content>) -> Result<Vec<String>> {
    match content {
        _ if !args.scenes.is_empty() => Ok(args.scenes.clone()),
        Some(content) if content.scenes.is_empty() => {
            Err(Failure::input("no scene: the preset has none of its own; give one, such as assets/city_candela.glb"))
        }
        Some(content) => Ok(content.scenes.iter().map(|&scene| scene.to_owned()).collect()),
        None => Err(Failure::input("no scene: give one or more, or a --preset")),
    }
}

fn wish_of<'a>(args: &'a CompareArgs, content: Option<&Content>, scenes: usize) -> Result<Wish<'a>> {
    if args.path.is_some() && scenes > 1 {
        return Err(Failure::input("--path goes through one scene; give one scene"));
    }
    if args.frames == Some(0) {
        return Err(Failure::input("--frames 0 asks for no frame; give 1 or more"));
    }
    let stride = stride_of(args, content.and_then(|content| content.stride))?;
    let own_cameras = !args.camera.is_empty() || args.eye.is_some() || args.path.is_some();
    let cameras = match content {
        Some(content) if !own_cameras => content.cameras.iter().map(|&camera| camera.to_owned()).collect(),
        _ => args.camera.clone(),
    };
    let suns = match content {
        _ if !args.suns.is_empty() => args.suns.clone(),
        Some(content) if args.sun.is_none() && args.light.is_none() => {
            content.suns.iter().map(|text| sun_spec(text).map_err(Failure::other)).collect::<Result<_>>()?
        }
        _ => vec![SunSpec::Own],
    };
    Ok(Wish {
        args,
        cameras,
        suns,
        stride,
        near: args.near.or(content.and_then(|content| content.near)),
        far: args.far.or(content.and_then(|content| content.far)),
    })
}

/// `--step`, `--turn`, `--zoom` and `--frames`, what is not said taken from the preset.
fn stride_of(args: &CompareArgs, preset: Option<Stride>) -> Result<Option<Stride>> {
    let typed = [("--step", args.step), ("--turn", args.turn), ("--zoom", args.zoom)];
    if let Some((option, _)) = typed.iter().find(|(_, value)| value.is_some()) {
        let frames = args.frames.or(preset.map(|preset| preset.frames)).unwrap_or(2);
        if frames < 2 {
            return Err(Failure::input(format!("{option} with --frames 1 goes nowhere; give --frames 2 or more")));
        }
        let still = Stride { metres: 0.0, turn: 0.0, zoom: 1.0, frames };
        return Ok(Some(Stride {
            metres: args.step.unwrap_or(still.metres),
            turn: args.turn.unwrap_or(still.turn),
            zoom: args.zoom.unwrap_or(still.zoom),
            frames,
        }));
    }
    match (args.frames, preset) {
        (Some(frames), Some(preset)) if args.path.is_none() => Ok((frames > 1).then_some(Stride { frames, ..preset })),
        (Some(_), None) if args.path.is_none() => Err(Failure::input(
            "--frames needs a way to go: give --path FILE, --step M, --turn DEGREES or --zoom FACTOR",
        )),
        _ => Ok(preset),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: CompareArgs,
    }

    fn args(words: &str) -> CompareArgs {
        Line::try_parse_from(["compare"].into_iter().chain(words.split_whitespace())).expect("an argument list").args
    }

    #[test]
    fn presets_hold_only_what_exists_and_say_so() {
        for preset in ["ladder", "figure8", "dueling", "table"] {
            let args = args(&format!("--preset {preset} -o x"));
            let content = args.preset.map(preset::content).expect("a preset");
            let mut notes = Vec::new();
            let techniques = techniques_of(&args, Some(content), &mut notes).expect(preset);
            assert_eq!(techniques.len() + notes.len(), content.techniques.len(), "{preset}: {notes:?}");
            assert!(techniques.len() >= 4 && notes.is_empty(), "{preset}");
            let mut labels: Vec<_> = techniques.iter().map(|technique| &technique.label).collect();
            labels.sort();
            labels.dedup();
            assert!(labels.len() == techniques.len() && labels.iter().all(|label| !label.contains('#')), "{labels:?}");
            wish_of(&args, Some(content), 4).expect("shots");
        }
    }

    #[test]
    fn what_was_typed_goes_before_the_preset() {
        let args = args("robot-war --preset ladder --with filter=pcf3 --suns 30 --near 2 --camera near,far -o x");
        let content = args.preset.map(preset::content);
        let techniques = techniques_of(&args, content, &mut Vec::new()).expect("techniques");
        assert!(techniques.iter().all(|technique| technique.job.filter == crate::args::Filter::Pcf3));
        assert!(techniques.iter().any(|technique| technique.job.stabilize == crate::args::Stabilize::Exact));
        let wish = wish_of(&args, content, 1).expect("shots");
        assert_eq!((wish.near, wish.far), (Some(2.0), Some(500.0)));
        assert_eq!(wish.cameras, ["near", "far"]);
        assert_eq!(wish.suns, [SunSpec::At { elevation: 30.0, bearing: None }]);
        assert_eq!(scenes_of(&args, content).expect("a scene"), ["robot-war"]);
    }

    #[test]
    fn a_walk_needs_a_way_to_go() {
        for (words, culprit) in [
            ("a --frames 0 -o x", "--frames 0"),
            ("a --frames 5 -o x", "--step"),
            ("a --step 1 --frames 1 -o x", "--step"),
            ("a --zoom 2 --frames 1 -o x", "--zoom"),
        ] {
            let message = wish_of(&args(words), None, 1).expect_err(words).to_string();
            assert!(message.contains(culprit), "{words}: {message}");
        }
        assert!(wish_of(&args("a b --path p.json -o x"), None, 2).is_err());
        assert_eq!(
            wish_of(&args("a --step 0.5 -o x"), None, 1).expect("steps").stride,
            Some(Stride { metres: 0.5, turn: 0.0, zoom: 1.0, frames: 2 })
        );
        assert_eq!(
            wish_of(&args("a --turn -1 --zoom 1.1 --frames 9 -o x"), None, 1).expect("turns").stride,
            Some(Stride { metres: 0.0, turn: -1.0, zoom: 1.1, frames: 9 })
        );
        assert_eq!(wish_of(&args("a --path p --frames 5 -o x"), None, 1).expect("a path").stride, None);
    }
}
