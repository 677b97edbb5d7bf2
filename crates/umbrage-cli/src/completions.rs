//! `umbrage completions`: the script by which a shell completes command lines of `umbrage`.

use clap::CommandFactory;
use clap_complete::Shell;
use umbrage_lab::failure::{Failure, Result};

use crate::{args::Args, print::print};

/// `umbrage completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Runs the subcommand.
pub fn run(args: &CompletionsArgs) -> Result<()> {
    print(&script(args.shell)?)
}

/// Returns the script of a shell: every subcommand that the help lists, its options, and the words
/// that they take.
///
/// # Errors
/// [`Failure::Other`] if the script is no text.
pub fn script(shell: Shell) -> Result<String> {
    let mut command = Args::command();
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    String::from_utf8(script).map_err(|error| Failure::other(error.to_string()))
}
