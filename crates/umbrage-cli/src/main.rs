//! The command `umbrage`: parse, run, exit code.

use std::{panic, process::ExitCode};

use clap::Parser;
use umbrage_cli::{args::Args, failure::exit_code};

/// Exit code of a defect of the program: 1, as for any failure that is not the user's.
const DEFECT: u8 = 1;

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => {
            // Help and version go to standard output and are no error; a reader who has left is
            // none either.
            drop(error.print());
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(DEFECT));
        }
    };
    umbrage_cli::environment::restart_with_runtime_folder();
    umbrage_lab::output::clean_up_on_signals();
    match panic::catch_unwind(|| umbrage_cli::run(&args)) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            eprintln!("umbrage: {failure}");
            ExitCode::from(exit_code(&failure))
        }
        Err(_) => ExitCode::from(DEFECT),
    }
}
