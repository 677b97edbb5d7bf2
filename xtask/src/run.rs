//! Running other programs, with their command lines printed.

use std::{
    env,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::Instant,
};

use anyhow::{Context, Result, bail};

/// Returns the repository's root.
pub fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_path_buf()
}

/// Returns a command of the cargo that runs this program, in the repository's root.
pub fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Runs `command` with its output on the terminal. Says how long it took, so that a check that
/// became slow is seen.
pub fn run(command: &mut Command) -> Result<()> {
    let shown = shown(command);
    eprintln!("xtask: {shown}");
    let start = Instant::now();
    let status = command.status().with_context(|| format!("{shown} did not start"))?;
    if !status.success() {
        bail!("{shown} failed: {status}");
    }
    eprintln!("xtask: {:.0} s for {shown}", start.elapsed().as_secs_f64());
    Ok(())
}

/// Runs `command` and returns its output, without the white space around it.
pub fn output(command: &mut Command) -> Result<String> {
    let shown = shown(command);
    let output = command.output().with_context(|| format!("{shown} did not start"))?;
    if !output.status.success() {
        bail!("{shown} failed: {}\n{}", output.status, String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Returns whether `command` can be run and succeeds. Its output is hidden.
pub fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Formats the command line for messages.
fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let words = std::iter::once(program.file_name().unwrap_or(program.as_os_str())).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Returns the folder of build artefacts.
pub fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |folder| root().join(folder))
}

/// Builds the command `umbrage` and returns its path.
pub fn build_umbrage(release: bool) -> Result<PathBuf> {
    let mut build = cargo();
    match release {
        true => build.args(["build", "--release", "--package", "umbrage-cli"]),
        // As the tests build it: `cargo build` would choose other features, and build dependencies
        // once more for them.
        false => build.args(["test", "--workspace", "--no-run", "--quiet"]),
    };
    run(&mut build)?;
    let binary =
        target().join(if release { "release" } else { "debug" }).join(format!("umbrage{}", env::consts::EXE_SUFFIX));
    if !binary.is_file() {
        bail!("{} was not built", binary.display());
    }
    Ok(binary)
}

/// Installs Debian packages, or explains how, because not every system has them and not every user
/// may.
pub fn install(packages: &[&str]) -> Result<()> {
    let names = packages.join(" ");
    if !succeeds(Command::new("apt-get").arg("--version")) {
        bail!("this is no Debian-like system; install what it has for {names}, and run this again");
    }
    let by_sudo = !is_root();
    if by_sudo && !succeeds(Command::new("sudo").args(["-n", "true"])) {
        bail!(
            "{names} has to be installed, and that needs rights that I do not have. Run this, then try again:\n\n    \
             sudo apt-get install -y {names}\n"
        );
    }
    eprintln!("xtask: installing {names}");
    let apt = |arguments: &[&str]| {
        let mut command = Command::new(if by_sudo { "sudo" } else { "env" });
        if by_sudo {
            command.args(["-n", "env"]);
        }
        run(command.args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]).args(arguments))
    };
    apt(&["update"])?;
    apt(&[&["install", "-y", "--no-install-recommends"], packages].concat())
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
