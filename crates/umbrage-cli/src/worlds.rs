//! `umbrage worlds`: the procedural worlds, by name and as files.

use std::path::PathBuf;

use clap::Subcommand;
use umbrage_lab::{
    failure::{Failure, Result},
    output::{self, Staged},
};
use umbrage_scene::procedural::{World, WorldOptions};

use crate::print::print;

/// `umbrage worlds`.
#[derive(Debug, Subcommand)]
pub enum WorldsCommand {
    /// Name them, with their cameras
    List,
    /// Write one as binary glTF
    Export {
        /// A world's name, see `umbrage worlds list`
        #[arg(value_name = "NAME")]
        name: String,
        /// Write it here (.glb)
        #[arg(short = 'o', long = "output", value_name = "FILE")]
        output: PathBuf,
    },
}

/// Runs the subcommand.
pub fn run(command: &WorldsCommand) -> Result<()> {
    match command {
        WorldsCommand::List => list(),
        WorldsCommand::Export { name, output } => {
            let world = World::from_name(name).ok_or_else(|| {
                Failure::input(format!("{name}: there is no such world; there are {}", names().join(", ")))
            })?;
            output::check(&[output], &[], &[])?;
            let mut staged = Staged::default();
            staged.file(output, umbrage_scene::export_glb(&world.build())?)?;
            staged.commit()
        }
    }
}

fn names() -> Vec<String> {
    World::ALL.iter().map(|world| world.name().to_string()).collect()
}

/// Prints one line per world: its name and its cameras, with a tab in between.
fn list() -> Result<()> {
    let mut text = String::new();
    for world in World::ALL {
        // Cameras do not depend on how many objects there are.
        let few = match world {
            World::Forest => WorldOptions { trees: Some(1), ..WorldOptions::default() },
            World::CityBlocks => WorldOptions { buildings: Some(1), ..WorldOptions::default() },
            _ => WorldOptions::default(),
        };
        let scene = world.build_with(&few, &|_| ())?;
        let cameras: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
        text += &format!("{}\t{}\n", world.name(), cameras.join(" "));
    }
    print(&text)
}
