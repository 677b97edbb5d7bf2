//! The options of `umbrage compare`.

use std::path::PathBuf;

use crate::{shot_args::ShotArgs, switch::Switch};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use umbrage_lab::compare::preset::{self, Preset};

const TECHNIQUES_HELP: &str = "\
A technique is KIND:SPLITS:SIZE for pssm and KIND:SIZE for single maps, then settings: the shadow options of `umbrage render` \
without their dashes, as :KEY=VALUE, lists with / between their numbers, and :label=TEXT; :filter=each is every filter in turn. \
For example
  pssm:4:512,pssm:4:512:lambda=0.9:stabilize=none:fit=independent,pssm:3:1024/512/256:filter=hard,ssm:1024

A file of techniques (TOML) says the same:
  [with]                       # for all techniques that do not say otherwise
  filter = \"hard\"
  [[technique]]
  technique = \"pssm\"
  splits = 4
  map-size = [1024, 512, 512, 256]
  label = \"ours\"

Suns: own (the scene's), an elevation in degrees at the own sun's bearing (43), an elevation at a bearing from north by east (43@120), \
into (the sun ahead of the camera, 11 degrees up; into@30: 30 degrees up), metrics (43 and 11 for all cameras, into for the first).

Presets, each reproduced by one command such as `umbrage compare --preset ladder -o ladder`; options given with one override it:
  ladder   SSM and PSSM at 1 and 4 Mtexel, tight and still, over the worlds under the suns `metrics`, with flicker
  figure8  the rows and worlds of the paper's Figure 8, columns (a) to (d)
  psvsm    the five pictures of Parallel-Split Variance Shadow Maps
  filters  every filter on the same maps; give --sun-angle 3 for soft scores
  dueling  Figure 8, column (e): looking into the light, larger maps
  stillness  unstabilised, exact, approximate and the source's 64 levels along a walk with turns, with flicker
  table    PSSM(2, 3, 4; 512) beside SSM(1024) over all cameras of all worlds
  selection     splits chosen by view depth and by map, coloured (Practical Cascaded Shadow Maps, Figure 4.1.9)
  gems-figure   SSM(2048) beside PSSM(3; 1024) (GPU Gems 3, Figure 10-8)
  gems-results  PSSM(3; 1024) and PSSM(4; 1024) at 1280x1024 (its section 10.5), with a scene of yours such as assets/city_candela.glb
  suns     the defaults over all cameras of all worlds, suns 80, 43, 20, 11 and 5 degrees up: acne and leaks";

/// `umbrage compare`.
#[derive(Debug, clap::Args)]
#[command(after_long_help = TECHNIQUES_HELP)]
pub struct CompareArgs {
    /// Scenes as for `umbrage render`: .glb or .gltf files, height maps, worlds [default: the
    /// preset's]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Techniques to compare, see below
    #[arg(long, value_name = "LIST", value_delimiter = ',', help_heading = "Techniques")]
    pub techniques: Vec<String>,
    /// Techniques to compare, from a file (TOML), see below
    #[arg(long, value_name = "FILE", help_heading = "Techniques")]
    pub techniques_file: Option<PathBuf>,
    /// A known set of techniques, scenes, cameras and suns
    #[arg(long, value_parser = preset_parser(), help_heading = "Techniques")]
    pub preset: Option<&'static Preset>,
    /// Settings for all techniques that do not set them: filter=hard:blend=0
    #[arg(long, value_name = "SETTINGS", help_heading = "Techniques")]
    pub with: Option<String>,
    /// Views.
    #[command(flatten)]
    pub shots: ShotArgs,

    /// Write everything into this folder: sheet.png, errors.png, scores.json, compare.html
    #[arg(short = 'o', long = "output", value_name = "DIR", help_heading = "Output")]
    pub folder: Option<PathBuf>,
    /// Write the contact sheet here (PNG)
    #[arg(long, value_name = "PNG", help_heading = "Output")]
    pub sheet: Option<PathBuf>,
    /// Write the sheet of errors here (PNG): leaks red, acne blue, on the truth in grey; along a
    /// walk, flips yellow
    #[arg(long, value_name = "PNG", help_heading = "Output")]
    pub errors: Option<PathBuf>,
    /// Write all scores here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// Write one page with sheets, tables and plots here (HTML)
    #[arg(long, value_name = "HTML", help_heading = "Output")]
    pub html: Option<PathBuf>,
    /// Save finished results in this file during the run; after an interruption, the same command
    /// continues from there. The file is deleted at the end
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub resume: Option<PathBuf>,
    /// Most shots on the sheets; of more, evenly spaced ones are shown
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=64), help_heading = "Output")]
    pub columns: u32,
    /// Colour the pictures by split; scores do not change
    #[arg(long, help_heading = "Output")]
    pub tint: bool,
    /// Also compute FLIP and SSIM, over the shots on the sheets
    #[arg(long, value_enum, default_value_t, help_heading = "Output")]
    pub image_metrics: Switch,
}

/// Reads the names of the laboratory's presets.
fn preset_parser() -> impl TypedValueParser<Value = &'static Preset> {
    let names = preset::ALL.map(|preset| PossibleValue::new(preset.name).help(preset.about));
    PossibleValuesParser::new(names).try_map(|name| preset::named(&name).ok_or("there is no such preset"))
}
