//! Check of the oldest compiler that the libraries promise (`rust-version` in their manifests).

use std::{collections::BTreeSet, process::Command};

use anyhow::{Result, bail};

use crate::packages::packages;
use crate::run::{root, run, succeeds, target};

/// Compiles the libraries with the oldest compiler that they promise, where rustup has it, and says
/// loudly where not.
pub fn check() -> Result<()> {
    let libraries: Vec<(String, String)> = packages()?
        .into_iter()
        .filter(|package| package.is_published())
        .filter_map(|package| Some((package.name, package.rust_version?)))
        .filter(|(_, version)| version != env!("CARGO_PKG_RUST_VERSION"))
        .collect();
    let versions: BTreeSet<&str> = libraries.iter().map(|(_, version)| version.as_str()).collect();
    if versions.is_empty() {
        bail!("no library promises an older compiler than {}", env!("CARGO_PKG_RUST_VERSION"));
    }
    for version in versions {
        if !succeeds(Command::new("rustup").args(["run", version, "cargo", "--version"])) {
            eprintln!(
                "xtask: SKIPPED: no Rust {version}; that the libraries compile with it is not checked (rustup toolchain \
                 install {version} --profile minimal)"
            );
            continue;
        }
        let mut check = Command::new("rustup");
        check.args(["run", version, "cargo", "check", "--locked", "--lib", "--all-features"]).current_dir(root());
        // Artefacts of another compiler, beside those of ours.
        check.arg("--target-dir").arg(target().join(format!("rust-{version}")));
        for (name, _) in libraries.iter().filter(|(_, promised)| promised == version) {
            check.args(["--package", name]);
        }
        // Those of the compiler that runs this program.
        ["CARGO", "RUSTC", "RUSTDOC", "RUSTUP_TOOLCHAIN"].into_iter().for_each(|name| {
            check.env_remove(name);
        });
        run(&mut check)?;
    }
    Ok(())
}
