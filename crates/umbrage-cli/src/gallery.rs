//! `umbrage gallery`: the worlds and a city, drawn with the defaults, as one page.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use umbrage_lab::{
    failure::Result,
    gallery::{self, Job, SCENES, Scene},
    parse,
};

use crate::print::print;

/// `umbrage gallery`.
#[derive(Debug, clap::Args)]
pub struct GalleryArgs {
    /// Scenes to show [default: all]; the city is in the folder assets of the repository
    #[arg(value_name = "SCENE", value_parser = scene_parser())]
    pub scenes: Vec<&'static Scene>,
    /// Size of each picture in pixels
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse::size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// Write index.html and the folder shots into this folder, and print where the page is
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub folder: PathBuf,
}

/// Reads the names of the gallery's scenes.
fn scene_parser() -> impl TypedValueParser<Value = &'static Scene> {
    let names = SCENES.iter().map(|scene| PossibleValue::new(scene.id).help(scene.title));
    PossibleValuesParser::new(names)
        .try_map(|name| SCENES.iter().find(|scene| scene.id == name).ok_or("there is no such scene"))
}

/// Runs the subcommand.
pub fn run(args: &GalleryArgs) -> Result<()> {
    let all = || SCENES.iter().collect();
    let scenes = if args.scenes.is_empty() { all() } else { args.scenes.clone() };
    let page = gallery::run(&Job { scenes, size: args.size, folder: args.folder.clone() })?;
    print(&format!("{}\n", page.display()))
}
