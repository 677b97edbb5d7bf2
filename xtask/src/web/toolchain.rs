//! Compilation for a browser: with rustup's target if the compiler has it; else with Debian's
//! compiler and the source of its standard library, unpacked below `target` and installed nowhere.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};

use crate::run::{cargo, output, root, run, succeeds};

/// Target of browsers.
const TARGET: &str = "wasm32-unknown-unknown";
/// Cargo profile of the page: see `Cargo.toml`.
pub const PROFILE: &str = "web";
/// Packages of Debian's compiler, which Debian keeps up to date for its browsers; 131 MB with the
/// packages that they need.
const PACKAGES: [&str; 3] = ["rustc-web", "libstd-rust-web-dev", "rust-web-src"];
/// Prefixes of the names of packages that these need to run.
const NEEDED: [&str; 2] = ["libstd-rust-web-", "libllvm"];
/// Debian's package of `wasm-opt`, 26 MB.
const BINARYEN: [&str; 1] = ["binaryen"];

/// A way to compile for a browser.
pub enum Way {
    /// The compiler has the target.
    Target,
    /// Debian's compiler, with which the standard library is built first.
    Source {
        /// Folder in which the packages are unpacked, as `usr`.
        root: PathBuf,
        /// Path of the linker.
        linker: PathBuf,
    },
}

/// Finds the way that this machine has; `None` if it has none, after printing the reason.
pub fn find() -> Result<Option<Way>> {
    if has_target() {
        return Ok(Some(Way::Target));
    }
    let Some(linker) = linker().filter(|_| is_debian()) else {
        eprintln!("xtask: SKIPPED: the compiler has no {TARGET}; `rustup target add {TARGET}` adds it");
        return Ok(None);
    };
    let root = folder().join("root");
    if !compiler(&root).is_file() {
        unpack(&root, &PACKAGES)?;
    }
    let way = Way::Source { root, linker };
    way.check_version()?;
    Ok(Some(way))
}

/// Returns `wasm-opt`, which makes programs smaller: the installed one, or Debian's, unpacked
/// below `target`; `None` where there is neither.
pub fn wasm_opt() -> Result<Option<PathBuf>> {
    let installed = PathBuf::from("wasm-opt");
    if succeeds(Command::new(&installed).arg("--version")) {
        return Ok(Some(installed));
    }
    if !is_debian() {
        return Ok(None);
    }
    let root = folder().join("binaryen");
    let program = root.join("usr/bin/wasm-opt");
    if !program.is_file() {
        unpack(&root, &BINARYEN)?;
    }
    Ok(Some(program))
}

fn is_debian() -> bool {
    succeeds(Command::new("apt-get").arg("--version")) && succeeds(Command::new("dpkg").arg("--version"))
}

/// Returns the folder of the unpacked compiler.
pub fn folder() -> PathBuf {
    root().join("target/wasm-toolchain")
}

impl Way {
    /// Makes the command `cargo VERB` for the browser.
    pub fn cargo(&self, verb: &str) -> Command {
        let mut command = cargo();
        command.args([verb, "--profile", PROFILE, "--target", TARGET]).env("CARGO_TARGET_DIR", target());
        if let Self::Source { root, linker } = self {
            command
                .args(["-Z", "build-std=std,panic_abort"])
                .env("RUSTC", compiler(root))
                // The standard library is built by what only newer compilers call stable.
                .env("RUSTC_BOOTSTRAP", "1")
                .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker)
                .env("LD_LIBRARY_PATH", libraries(root));
        }
        command
    }

    /// Returns the path of a program that [`Way::cargo`] built.
    pub fn program(name: &str) -> PathBuf {
        target().join(TARGET).join(PROFILE).join(format!("{name}.wasm"))
    }

    /// Checks that Debian's compiler is not older than the workspace demands.
    fn check_version(&self) -> Result<()> {
        let Self::Source { root: unpacked, .. } = self else { return Ok(()) };
        let said =
            output(Command::new(compiler(unpacked)).arg("--version").env("LD_LIBRARY_PATH", libraries(unpacked)))?;
        let manifest = fs::read_to_string(root().join("Cargo.toml")).context("Cargo.toml cannot be read")?;
        let least = manifest.lines().find_map(|line| line.strip_prefix("rust-version = \"")?.split('"').next());
        let least = least.context("Cargo.toml names no rust-version")?;
        let has = said.split_whitespace().nth(1).unwrap_or_default();
        if numbers(has) < numbers(least) {
            bail!(
                "Debian's rustc-web is {has} and {least} is needed; run `apt-get update`, remove {} and try again",
                unpacked.display()
            );
        }
        Ok(())
    }
}

/// Returns the target folder of the browser's build, separate from the rest because another
/// compiler builds it.
fn target() -> PathBuf {
    root().join("target/wasm")
}

fn compiler(root: &Path) -> PathBuf {
    root.join("usr/bin/rustc")
}

fn libraries(root: &Path) -> String {
    [root.join("usr/lib"), root.join(format!("usr/lib/{}-linux-gnu", std::env::consts::ARCH))]
        .map(|folder| folder.display().to_string())
        .join(":")
}

fn has_target() -> bool {
    let said = output(Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]));
    said.is_ok_and(|folder| Path::new(&folder).is_dir())
}

/// Returns `rust-lld` of the compiler that builds the other crates.
fn linker() -> Option<PathBuf> {
    let sysroot = output(Command::new("rustc").args(["--print", "sysroot"])).ok()?;
    let about = output(Command::new("rustc").arg("-vV")).ok()?;
    let host = about.lines().find_map(|line| line.strip_prefix("host: "))?;
    let linker = Path::new(&sysroot).join("lib/rustlib").join(host).join("bin/rust-lld");
    linker.is_file().then_some(linker)
}

/// Downloads Debian's packages and those that they need, and unpacks them.
fn unpack(root: &Path, packages: &[&str]) -> Result<()> {
    // Lists of an older day name an older compiler. Where they may not be renewed they have to do.
    if !succeeds(Command::new("apt-get").arg("update")) {
        eprintln!("xtask: the lists of packages are those of the last `apt-get update`");
    }
    let mut packages: Vec<String> = packages.iter().map(|&name| name.to_owned()).collect();
    let mut known = 0;
    while known < packages.len() {
        let needs = output(Command::new("apt-cache").args(["depends", &packages[known]]))?;
        for name in needs.lines().filter_map(|line| line.trim().strip_prefix("Depends: ")) {
            if NEEDED.iter().any(|start| name.starts_with(start)) && !packages.iter().any(|other| other == name) {
                packages.push(name.to_owned());
            }
        }
        known += 1;
    }
    let parts = root.with_extension("parts");
    fs::create_dir_all(&parts).with_context(|| format!("{} cannot be made", parts.display()))?;
    run(Command::new("apt-get").arg("download").args(&packages).current_dir(&parts))?;
    for file in fs::read_dir(&parts).context("nothing was downloaded")? {
        let file = file.context("nothing was downloaded")?.path();
        run(Command::new("dpkg").arg("-x").arg(file).arg(parts.join("root")))?;
    }
    // It is there whole or not at all.
    fs::rename(parts.join("root"), root).with_context(|| format!("{} cannot be made", root.display()))?;
    fs::remove_dir_all(&parts).with_context(|| format!("{} cannot be removed", parts.display()))
}

/// Reads a version such as `1.96.0` as numbers.
fn numbers(version: &str) -> Vec<u32> {
    version.split('.').map(|part| part.parse().unwrap_or(0)).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn versions_are_compared_by_their_numbers() {
        assert!(super::numbers("1.100.0") > super::numbers("1.95"));
        assert!(super::numbers("1.85.0") < super::numbers("1.95"));
        assert!(super::numbers("1.95.0") >= super::numbers("1.95"));
    }
}
