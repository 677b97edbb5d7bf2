//! The command `umbrage`, as a library, so that its parts can be tested.
//!
//! [`args`] is what was typed, [`job`] what it means, [`stage`] the scene it is about; then there is one file per
//! subcommand. [`output`] makes files appear whole or not at all, [`failure`] decides the exit code.
//! [`plot`] draws charts, [`html`] makes report pages of them, [`theory`] and [`compare`] are such pages.

mod adapter;
pub mod args;
mod bench;
pub mod compare;
pub mod failure;
pub mod html;
mod lights;
mod notes;
pub mod output;
pub mod parse;
mod paths;
mod plan;
pub mod plot;
mod probe;
pub mod progress;
mod render;
pub mod report;
pub mod scene_job;
pub mod shadow_job;
pub mod split_views;
pub mod stage;
pub mod theory;
mod truth;
mod worlds;

use args::{Args, Command};
use failure::Result;

/// Does what was asked for.
///
/// # Errors
/// [`failure::Failure`], which knows its exit code. No output file is left behind.
pub fn run(args: &Args) -> Result<()> {
    match &args.command {
        Command::Render(args) => render::run(args),
        Command::Probe(args) => probe::run(args),
        Command::Truth(args) => truth::run(args),
        Command::Plan(args) => plan::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Theory { output } => theory::run(output),
        Command::Worlds { command } => worlds::run(command),
        Command::Adapter => adapter::run(),
    }
}
