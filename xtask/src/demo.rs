//! `cargo xtask demo`: draws the gallery, after installing a graphics adapter if there is none.

use std::process::Command;

use anyhow::Result;

use crate::{
    adapter,
    run::{build_umbrage, root, run},
};

/// Draws everything and writes `out/demo/index.html`.
pub fn run_demo() -> Result<()> {
    let umbrage = build_umbrage(true)?;
    let adapter = adapter::ensure(&umbrage)?;
    eprintln!("xtask: drawing with {adapter}");
    run(Command::new(umbrage).current_dir(root()).args(["gallery", "-o"]).arg(root().join("out/demo")))?;
    eprintln!("xtask: look at it with a browser");
    Ok(())
}
