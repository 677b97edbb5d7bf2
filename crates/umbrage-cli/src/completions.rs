//! `umbrage completions`: the script by which a shell completes command lines of `umbrage`.

use clap::Command;
use clap_complete::Shell;
use umbrage_lab::failure::{Failure, Result};

use crate::print::print;

/// `umbrage completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Runs the subcommand; `command` is the whole one.
pub fn run(args: &CompletionsArgs, command: Command) -> Result<()> {
    print(&script(args.shell, command)?)
}

/// Returns the script by which a shell completes `command`: every subcommand that the help lists,
/// its options, and the words that they take.
///
/// # Errors
/// [`Failure::Other`] if the script is no text.
pub fn script(shell: Shell, mut command: Command) -> Result<String> {
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    String::from_utf8(script).map_err(|error| Failure::other(error.to_string()))
}
