//! Writes the texts of `umbrage-shaders` again and prints the names of those that changed: `cargo
//! xtask shaders`.

use std::process::ExitCode;

use anyhow::Result;
use umbrage_shaders_join::{checked_in, differences, join, sources, write};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let (folder, texts) = (checked_in(), join(&sources())?);
    let changed = differences(&folder, &texts)?;
    write(&folder, &texts)?;
    for line in &changed {
        eprintln!("mended: {line}");
    }
    eprintln!("{} texts, {} changed", texts.len(), changed.len());
    Ok(())
}
