//! The command `umbrage`, as a library, so that its parts can be tested.
//!
//! [`args`] parses the command line; every subcommand has a file with its options and its code. The
//! work is done by `umbrage-lab`. [`failure`] decides the exit code.

mod adapter;
pub mod args;
pub mod bench;
pub mod compare;
pub mod completions;
pub mod environment;
pub mod failure;
pub mod gallery;
pub mod man;
pub mod plan;
mod print;
pub mod probe;
pub mod render;
pub mod scene_args;
pub mod scene_options;
pub mod shadow_args;
pub mod shot_args;
pub mod switch;
pub mod theory;
pub mod truth;
pub mod tune;
#[cfg(feature = "view")]
pub mod view;
mod words;
pub mod world_args;
pub mod worlds;

use args::{Args, Command};
use clap::CommandFactory as _;
use umbrage_lab::failure::Result;

/// Runs the subcommand.
///
/// # Errors
/// [`umbrage_lab::failure::Failure`], which [`failure::exit_code`] turns into an exit code. No
/// output file is left behind.
pub fn run(args: &Args) -> Result<()> {
    match &args.command {
        Command::Render(args) => render::run(args),
        Command::Probe(args) => probe::run(args),
        Command::Truth(args) => truth::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Tune(args) => tune::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Gallery(args) => gallery::run(args),
        Command::Theory(args) => theory::run(args),
        #[cfg(feature = "view")]
        Command::View(args) => view::run(args),
        Command::Worlds { command } => worlds::run(command),
        Command::Completions(args) => completions::run(args, Args::command()),
        Command::Man(args) => man::run(args, Args::command()),
        Command::Adapter => adapter::run(),
    }
}
