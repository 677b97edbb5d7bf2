//! A graphics adapter for machines that have none: Mesa's software Vulkan.

use std::{path::Path, process::Command};

use anyhow::{Context, Result, bail};

use crate::run::{run, succeeds};

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// Makes sure that `umbrage` finds an adapter, and returns its name. Installs the software driver
/// where it may.
pub fn ensure(umbrage: &Path) -> Result<String> {
    if let Some(name) = find(umbrage)? {
        return Ok(name);
    }
    eprintln!("xtask: no graphics adapter here; the software Vulkan driver (Mesa's lavapipe) will do");
    install()?;
    match find(umbrage)? {
        Some(name) => Ok(name),
        None => bail!(
            "still no graphics adapter after installing {}; is a driver file in /usr/share/vulkan/icd.d?",
            PACKAGES.join(" ")
        ),
    }
}

/// The adapter that `umbrage` would use.
fn find(umbrage: &Path) -> Result<Option<String>> {
    let output = Command::new(umbrage)
        .arg("adapter")
        .output()
        .with_context(|| format!("{} did not start", umbrage.display()))?;
    Ok(output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned()))
}

fn install() -> Result<()> {
    let by_hand = format!("apt-get install -y {}", PACKAGES.join(" "));
    if !succeeds(Command::new("apt-get").arg("--version")) {
        bail!("this is no Debian-like system; install a Vulkan driver, such as Mesa's lavapipe, and run this again");
    }
    let by_sudo = !is_root();
    if by_sudo && !succeeds(Command::new("sudo").args(["-n", "true"])) {
        bail!(
            "it has to be installed, and that needs rights that I do not have. Run this, then try again:\n\n    sudo {by_hand}\n"
        );
    }
    eprintln!("xtask: installing {}", PACKAGES.join(" and "));
    let apt = |arguments: &[&str]| {
        let mut command = Command::new(if by_sudo { "sudo" } else { "env" });
        if by_sudo {
            command.args(["-n", "env"]);
        }
        run(command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]).args(arguments))
    };
    apt(&["update"])?;
    apt(&["install", "-y", "--no-install-recommends", PACKAGES[0], PACKAGES[1]])
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
