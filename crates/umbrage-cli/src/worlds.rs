//! `umbrage worlds`: the procedural worlds, by name and as files.

use std::io::{self, Write};

use umbrage_scene::procedural::World;

use crate::{
    args::WorldsCommand,
    failure::{Failure, Result},
    output::{self, Staged},
};

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

/// One line per world: its name and its cameras, tab between.
fn list() -> Result<()> {
    let mut text = String::new();
    for world in World::ALL {
        let scene = world.build();
        let cameras: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
        text += &format!("{}\t{}\n", world.name(), cameras.join(" "));
    }
    print(&text)
}

/// To standard output; a reader who has left is no error.
pub fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
