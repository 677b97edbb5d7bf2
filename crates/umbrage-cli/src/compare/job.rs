//! The job of `umbrage compare`: options and preset combined. Everything that can be is checked
//! before a frame is drawn.

use std::path::Path;

use umbrage_lab::{
    compare::{
        Job, Outputs, Preset, Settings,
        shots::{SceneShots, ShotRequest},
    },
    failure::{Failure, Result},
    technique::{
        Technique,
        text::{self, Rejected},
    },
};

use super::args::CompareArgs;
use crate::{shot_args::ShotDefaults, switch::Switch};

/// Default width and height in pixels, where neither the options nor the preset give any.
const DEFAULT_SIZE: [u32; 2] = [800, 600];

/// # Errors
/// [`Failure::Input`] naming the option, technique or file at fault.
pub fn job(args: &CompareArgs) -> Result<Job> {
    let files = [&args.sheet, &args.errors, &args.json, &args.html].map(Clone::clone);
    let outputs = Outputs::new(args.folder.clone(), files)?;
    let mut notes = Vec::new();
    let techniques = techniques_of(args, &mut notes)?;
    let scenes = scenes_of(args)?;
    let mut inputs: Vec<&Path> = scenes.iter().map(Path::new).collect();
    inputs.extend([&args.shots.path, &args.techniques_file].into_iter().flatten().map(AsRef::<Path>::as_ref));
    outputs.check(&inputs)?;
    let shots = shot_request(args, scenes.len())?;
    let scenes = scenes.iter().map(|scene| shots.open(scene)).collect::<Result<Vec<SceneShots>>>()?;
    let settings = Settings {
        size: size(args),
        shadow_range: args.shots.shadow_range,
        sun_angle: args.shots.sun_angle,
        least_edges: args.shots.least_edges,
        columns: args.columns as usize,
        tint: args.tint || args.preset.is_some_and(|preset| preset.tint),
        image_metrics: args.image_metrics == Switch::On,
    };
    let command = ["umbrage".to_owned()].into_iter().chain(std::env::args().skip(1)).collect();
    Ok(Job { techniques, scenes, settings, outputs, notes, resume: args.resume.clone(), command })
}

fn size(args: &CompareArgs) -> [u32; 2] {
    args.shots.size.or_else(|| args.preset?.size).unwrap_or(DEFAULT_SIZE)
}

fn techniques_of(args: &CompareArgs, notes: &mut Vec<String>) -> Result<Vec<Technique>> {
    let preset = args.preset;
    let mut with = text::parse_with(preset.map_or("", |preset| preset.with))?;
    let mut sources = Vec::new();
    for text in preset.map_or(&[][..], |preset| preset.techniques).iter().flat_map(|text| text::each(text)) {
        let source = text::parse(&text)?;
        match source.finish(&with, args.shots.shadow_range) {
            Ok(_) => sources.push(source),
            Err(Rejected::NotBuilt(failure)) => notes.push(format!("left out of the preset: {failure}")),
            Err(Rejected::Wrong(failure)) => return Err(failure),
        }
    }
    if let Some(path) = &args.techniques_file {
        let (with_of_file, from_file) = text::load(path)?;
        with.extend(with_of_file);
        sources.extend(from_file);
    }
    for text in args.techniques.iter().flat_map(|text| text::each(text)) {
        sources.push(text::parse(&text)?);
    }
    with.extend(text::parse_with(args.with.as_deref().unwrap_or(""))?);
    if sources.is_empty() {
        return Err(Failure::input(
            "no technique: give --techniques (for example pssm:4:1024,ssm:2048), --techniques-file or --preset",
        ));
    }
    Ok(text::finish(&sources, &with, args.shots.shadow_range)?)
}

fn scenes_of(args: &CompareArgs) -> Result<Vec<String>> {
    match args.preset {
        _ if !args.scenes.is_empty() => Ok(args.scenes.clone()),
        Some(preset) if preset.scenes.is_empty() => {
            Err(Failure::input("no scene: the preset has none of its own; give one, such as assets/city_candela.glb"))
        }
        Some(preset) => Ok(preset.scenes.iter().map(|&scene| scene.to_owned()).collect()),
        None => Err(Failure::input("no scene: give one or more, or a --preset")),
    }
}

/// Returns the preset's defaults for views.
fn shot_defaults(preset: Option<&Preset>) -> ShotDefaults {
    preset.map_or_else(ShotDefaults::default, |preset| ShotDefaults {
        near: preset.near,
        far: preset.far,
        cameras: preset.cameras,
        suns: Some(preset.suns),
        stride: preset.stride,
    })
}

/// Makes the request for the views of each scene.
fn shot_request(args: &CompareArgs, scenes: usize) -> Result<ShotRequest> {
    args.shots.request(scenes, size(args), &shot_defaults(args.preset))
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use umbrage::config::{Filter, Stability};

    use umbrage_lab::{
        compare::shots::{Stride, SunSpec},
        scene_request::CameraChoice,
    };

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
            let content = args.preset.expect("a preset");
            let mut notes = Vec::new();
            let techniques = techniques_of(&args, &mut notes).expect(preset);
            assert_eq!(techniques.len() + notes.len(), content.techniques.len(), "{preset}: {notes:?}");
            assert!(techniques.len() >= 4 && notes.is_empty(), "{preset}");
            let mut labels: Vec<_> = techniques.iter().map(|technique| &technique.label).collect();
            labels.sort();
            labels.dedup();
            assert!(labels.len() == techniques.len() && labels.iter().all(|label| !label.contains('#')), "{labels:?}");
            shot_request(&args, 4).expect("shots");
        }
    }

    #[test]
    fn what_was_typed_goes_before_the_preset() {
        let args = args("robot-war --preset ladder --with filter=pcf3 --suns 30 --near 2 --camera near,far -o x");
        let techniques = techniques_of(&args, &mut Vec::new()).expect("techniques");
        assert!(techniques.iter().all(|technique| technique.shadows.config.filter == Filter::Pcf3 { width_m: None }));
        assert!(techniques.iter().any(|technique| technique.shadows.config.stability == Stability::Exact));
        let shots = shot_request(&args, 1).expect("shots");
        assert_eq!((shots.base.near, shots.base.far), (Some(2.0), Some(500.0)));
        assert_eq!(shots.cameras, ["near", "far"].map(|name| CameraChoice::Named(name.into())));
        assert_eq!(shots.suns, Some(vec![SunSpec::At { elevation: 30.0, bearing: None }]));
        assert_eq!(scenes_of(&args).expect("a scene"), ["robot-war"]);
    }

    #[test]
    fn a_walk_needs_a_way_to_go() {
        for (words, culprit) in [
            ("a --frames 0 -o x", "--frames 0"),
            ("a --frames 5 -o x", "--step"),
            ("a --step 1 --frames 1 -o x", "--step"),
            ("a --zoom 2 --frames 1 -o x", "--zoom"),
        ] {
            let message = shot_request(&args(words), 1).expect_err(words).to_string();
            assert!(message.contains(culprit), "{words}: {message}");
        }
        assert!(shot_request(&args("a b --path p.json -o x"), 2).is_err());
        assert_eq!(
            shot_request(&args("a --step 0.5 -o x"), 1).expect("steps").stride,
            Some(Stride { metres: 0.5, turn: 0.0, zoom: 1.0, frames: 2 })
        );
        assert_eq!(
            shot_request(&args("a --turn -1 --zoom 1.1 --frames 9 -o x"), 1).expect("turns").stride,
            Some(Stride { metres: 0.0, turn: -1.0, zoom: 1.1, frames: 9 })
        );
        assert_eq!(shot_request(&args("a --path p --frames 5 -o x"), 1).expect("a path").stride, None);
    }
}
