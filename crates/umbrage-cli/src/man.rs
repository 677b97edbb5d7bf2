//! `umbrage man`: the command's manual, as man pages.

use std::path::PathBuf;

use clap::Command;
use clap_mangen::Man;
use umbrage_lab::{
    failure::{Failure, Result},
    output::{self, Staged},
};

use crate::print::print;

/// `umbrage man`.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// Write umbrage.1, and umbrage-render.1 and so on for each subcommand, into this folder
    /// [default: print umbrage.1]
    #[arg(value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
}

/// Runs the subcommand; `command` is the whole one.
pub fn run(args: &ManArgs, command: Command) -> Result<()> {
    let pages = pages(command)?;
    match (&args.folder, pages.first()) {
        (Some(folder), _) => {
            output::check(&[], &[folder], &[])?;
            let files = pages.into_iter().map(|page| (page.file, page.text.into_bytes())).collect();
            let mut staged = Staged::default();
            staged.folder(folder, files)?;
            staged.commit()
        }
        (None, Some(first)) => print(&first.text),
        (None, None) => Ok(()),
    }
}

/// A man page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Name of its file, as `umbrage-render.1`.
    pub file: String,
    /// The page in the language of `man`.
    pub text: String,
}

/// Returns the page of `command`, then those of the subcommands that the help lists.
///
/// # Errors
/// [`Failure::Other`] if a page is no text.
pub fn pages(command: Command) -> Result<Vec<Page>> {
    // `umbrage help SUBCOMMAND` would get pages that say nothing.
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    add(&command, &mut pages)?;
    Ok(pages)
}

fn add(command: &Command, pages: &mut Vec<Page>) -> Result<()> {
    let man = Man::new(command.clone()).source(concat!("umbrage ", env!("CARGO_PKG_VERSION")));
    let mut text = Vec::new();
    man.render(&mut text).map_err(|error| Failure::other(error.to_string()))?;
    pages.push(Page {
        file: man.get_filename(),
        text: String::from_utf8(text).map_err(|error| Failure::other(error.to_string()))?,
    });
    command.get_subcommands().filter(|subcommand| !subcommand.is_hide_set()).try_for_each(|it| add(it, pages))
}
