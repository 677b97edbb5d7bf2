//! Installation of a graphics adapter on machines that have none: Mesa's software Vulkan.

use std::{path::Path, process::Command};

use anyhow::{Context, Result, bail};

use crate::run::install;

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// Makes sure that `umbrage` finds an adapter, and returns its name. Installs the software driver
/// if it may.
pub fn ensure(umbrage: &Path) -> Result<String> {
    if let Some(name) = find(umbrage)? {
        return Ok(name);
    }
    eprintln!("xtask: no graphics adapter here; the software Vulkan driver (Mesa's lavapipe) will do");
    install(&PACKAGES)?;
    match find(umbrage)? {
        Some(name) => Ok(name),
        None => bail!(
            "still no graphics adapter after installing {}; is a driver file in /usr/share/vulkan/icd.d?",
            PACKAGES.join(" ")
        ),
    }
}

/// Returns the adapter that `umbrage` would use.
fn find(umbrage: &Path) -> Result<Option<String>> {
    let output = Command::new(umbrage)
        .arg("adapter")
        .output()
        .with_context(|| format!("{} did not start", umbrage.display()))?;
    Ok(output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned()))
}
