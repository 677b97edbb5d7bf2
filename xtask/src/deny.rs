//! Checks of the dependencies by cargo-deny: licences, sources, bans, advisories (deny.toml).

use anyhow::Result;

use crate::run::{cargo, run, succeeds};

/// Checks dependencies where cargo-deny is installed, and says loudly where not.
pub fn check() -> Result<()> {
    if !succeeds(cargo().args(["deny", "--version"])) {
        eprintln!(
            "xtask: SKIPPED: no cargo-deny; licences, sources and advisories of dependencies are not checked \
             (cargo install cargo-deny --locked)"
        );
        return Ok(());
    }
    run(cargo().args(["deny", "--locked", "check", "licenses", "bans", "sources"]))?;
    // The database is fetched from GitHub.
    if !succeeds(cargo().args(["deny", "fetch", "db"])) {
        eprintln!("xtask: SKIPPED: the advisory database cannot be fetched; advisories are not checked");
        return Ok(());
    }
    run(cargo().args(["deny", "--locked", "check", "advisories"]))
}
