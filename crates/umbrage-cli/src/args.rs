//! The subcommands of the command line. The options of each are in its file.
//!
//! One set of scene, camera, light and time options serves every subcommand; a subcommand accepts
//! and ignores options that it does not need, so one argument list serves `render`, `probe` and
//! `truth`.

use clap::{Parser, Subcommand};

use crate::{
    bench::BenchArgs, compare::CompareArgs, completions::CompletionsArgs, gallery::GalleryArgs, man::ManArgs,
    plan::PlanArgs, probe::ProbeArgs, render::RenderArgs, theory::TheoryArgs, truth::TruthArgs, tune::TuneArgs,
    worlds::WorldsCommand,
};

/// Sunlight and its shadows over large worlds: pictures, visibility masks, probes, and the exact
/// truth to compare with.
#[derive(Debug, Parser)]
#[command(name = "umbrage", version, max_term_width = 110)]
pub struct Args {
    /// The subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw the scene: a picture, its visibility mask, its shadow maps, a report
    Render(Box<RenderArgs>),
    /// Compute the visibility of given points, from the maps that `render` uses
    Probe(Box<ProbeArgs>),
    /// Trace the exact visibility mask with rays
    Truth(Box<TruthArgs>),
    /// Plan shadow maps without a GPU: planes, matrices and casters of each split, as JSON
    Plan(Box<PlanArgs>),
    /// Draw the papers' theory: split schemes and aliasing, areas, fits, frusta
    Theory(TheoryArgs),
    /// Compare techniques with each other and with the truth: contact sheets, scores, one page
    Compare(Box<CompareArgs>),
    /// Search the best settings for a memory budget, judged by rays
    Tune(Box<TuneArgs>),
    /// Measure the cost of shadows: times and counts of techniques, ratios to the first, one page
    Bench(Box<BenchArgs>),
    /// Draw the worlds and a city from near and far with the defaults, as one page
    Gallery(GalleryArgs),
    /// Open a window on the scene: fly, drag the sun, change settings, see why a shadow looks as it
    /// does
    #[cfg(feature = "view")]
    #[command(
        mut_arg("scene", |arg| arg.required(false).default_value(crate::view::FIRST_SCENE)),
        mut_arg("size", |arg| arg.default_value("1360x850").help("Size of the window in pixels")),
        mut_arg("frames", |arg| arg.help("With --screenshot: pictures of the scene before it [default: 1]"))
    )]
    View(Box<crate::view::ViewArgs>),
    /// The procedural worlds
    Worlds {
        /// The subcommand of `worlds`.
        #[command(subcommand)]
        command: WorldsCommand,
    },
    /// Print the script by which a shell completes command lines of umbrage
    Completions(CompletionsArgs),
    /// Print or write the manual as man pages
    Man(ManArgs),
    /// Print which graphics adapter would be used, or fail if there is none
    #[command(hide = true)]
    Adapter,
}
