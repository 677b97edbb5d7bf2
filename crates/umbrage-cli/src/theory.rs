//! `umbrage theory`: the papers' theory, drawn.

use std::path::PathBuf;

use umbrage_lab::{
    failure::Result,
    output::{self, Staged},
    theory,
};

/// `umbrage theory`.
#[derive(Debug, clap::Args)]
pub struct TheoryArgs {
    /// Write the page here (HTML, one file)
    #[arg(short = 'o', long = "output", value_name = "HTML")]
    pub output: PathBuf,
}

/// Runs the subcommand.
pub fn run(args: &TheoryArgs) -> Result<()> {
    output::check(&[&args.output], &[], &[])?;
    let mut staged = Staged::default();
    staged.file(&args.output, theory::page()?.html().into_bytes())?;
    staged.commit()
}
