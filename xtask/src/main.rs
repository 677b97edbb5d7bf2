//! `cargo xtask demo | test | bless`: the project's automation, so that a machine that has Rust needs nothing else.

mod adapter;
mod check;
mod demo;
mod page;
mod run;

use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask COMMAND

  demo    install the software Vulkan driver if there is no graphics adapter, build, render the four worlds and the
          city, and write out/demo/index.html
  test    formatting, lints, the build for the browser and all tests, as CI runs them
  bless   draw the reference pictures of the tests anew
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["demo"] => demo::run(),
        ["test"] => check::test(),
        ["bless"] => check::bless(),
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
