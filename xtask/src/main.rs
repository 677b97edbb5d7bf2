//! `cargo xtask COMMAND`: the project's automation, which needs nothing but Rust.

mod adapter;
mod book;
mod check;
#[cfg(test)]
mod circles;
mod demo;
mod deny;
#[cfg(test)]
mod documents;
#[cfg(test)]
mod lengths;
mod msrv;
mod packages;
#[cfg(test)]
mod published;
mod results;
mod run;
mod web;

use std::process::ExitCode;

use crate::results::Ask;

const USAGE: &str = "\
Usage: cargo xtask COMMAND

  demo    install the software Vulkan driver if there is no graphics adapter, build, render the four worlds and the
          city, and write out/demo/index.html
  test [--quick | --web | --bevy]
          formatting, lints, documentation, features, packages, dependencies, the oldest compiler, the build for the
          browser and all tests, as CI runs them;
          --quick: formatting and the tests of what needs no graphics adapter, in under two minutes once it is built;
          --web: the viewer in a browser (Chromium), on WebGPU and on WebGL2, beside the native picture;
          --bevy: the plugin for Bevy, integrations/bevy, which is a workspace of its own and builds Bevy
  web [--no-serve] [--out FOLDER] [--port NUMBER]
          build the viewer as a page into out/web, and serve it on this machine
  book [--pictures]
          build the book into out/book; --pictures redraws its pictures instead
  fuzz    check 1,000,000 plans of random scenes, load 100,000 mutated files, test exact edges on 1,000,000 soups of
          triangles and run the bodies of `fuzz/` on 100,000 mutations of each corpus; UMBRAGE_FUZZ_CASES,
          UMBRAGE_FUZZ_FILES, UMBRAGE_FUZZ_SOUPS, UMBRAGE_FUZZ_RUNS and UMBRAGE_FUZZ_SEED choose others
  soak    plan 100,000 frames, draw 10,000 frames of maps and 10,000 pictures: memory stays flat
  shaders join the modules of umbrage-shaders/shaders into the texts that are checked in, umbrage-shaders/src/wgsl
  package pack every crate that is published and build each from its package
  bless   redraw the reference pictures of the tests
  results [--resume | --render | --tiny]
          run the jobs whose figures docs/results.md shows (up to 25 minutes), keep the figures in docs/results and
          render the page; --resume leaves out jobs whose figures are of this build, --render runs none, --tiny runs
          them as small as they can be, into out/results
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["demo"] => demo::run_demo(),
        ["test"] => check::test(),
        ["test", "--quick"] => check::quick(),
        ["test", "--web"] => web::check_in_browser(),
        ["test", "--bevy"] => check::bevy(),
        ["web", ref options @ ..] => web::Ask::read(options).and_then(|ask| web::web(&ask)),
        ["book"] => book::build(),
        ["book", "--pictures"] => book::draw(),
        ["shaders"] => check::shaders(),
        ["package"] => check::package(),
        ["bless"] => check::bless(),
        ["fuzz"] => check::fuzz(),
        ["soak"] => check::soak(),
        ["results"] => results::results(Ask::All),
        ["results", "--resume"] => results::results(Ask::Resume),
        ["results", "--render"] => results::results(Ask::Render),
        ["results", "--tiny"] => results::results(Ask::Tiny),
        ["help" | "-h" | "--help"] => {
            eprint!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprint!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}
