//! What CI runs, and a developer before a commit.

use std::{env, path::Path, process::Command};

use anyhow::Result;

use crate::{
    adapter,
    run::{build_umbrage, cargo, run},
};

/// Tests that need an adapter fail without one, rather than skip, where this is 1.
const REQUIRE_GPU: &str = "UMBRAGE_REQUIRE_GPU";
/// Tests write their references anew where this is 1.
const BLESS: &str = "UMBRAGE_BLESS";

/// What a browser runs.
const WASM_TARGET: &str = "wasm32-unknown-unknown";
/// The crates that must build for it.
const WASM_CRATES: [&str; 4] = ["umbrage", "umbrage-shaders", "umbrage-wgpu", "umbrage-render"];

/// Formatting, lints, the browser's build, all tests.
pub fn test() -> Result<()> {
    run(cargo().args(["fmt", "--all", "--check"]))?;
    run(cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    check_wasm()?;
    let has_adapter = has_adapter()?;
    let mut tests = cargo();
    tests.args(["test", "--workspace"]);
    if has_adapter {
        tests.env(REQUIRE_GPU, "1");
    }
    run(&mut tests)
}

/// The tests of pictures, accepting what they see as the new reference. Ceilings of scores are constants and stay as they are.
pub fn bless() -> Result<()> {
    adapter::ensure(&build_umbrage(false)?)?;
    run(cargo().args(["test", "--package", "umbrage-tests"]).env(BLESS, "1").env(REQUIRE_GPU, "1"))?;
    eprintln!("xtask: look at what `git diff` says before you commit it");
    Ok(())
}

/// The fuzzer of loaders, long enough to find what CI's short run does not.
pub fn fuzz() -> Result<()> {
    const FILES: &str = "UMBRAGE_FUZZ_FILES";
    let mut tests = cargo();
    tests.args(["test", "--release", "--package", "umbrage-scene", "--test", "mutated", "--", "--nocapture"]);
    if !is_set(FILES) {
        tests.env(FILES, "100000");
    }
    run(&mut tests)
}

/// Whether there is an adapter, after trying to install one. None is an error where the environment demands one.
fn has_adapter() -> Result<bool> {
    match adapter::ensure(&build_umbrage(false)?) {
        Ok(name) => {
            eprintln!("xtask: tests run on {name}");
            Ok(true)
        }
        Err(error) if is_set(REQUIRE_GPU) || is_set("CI") => Err(error),
        Err(error) => {
            eprintln!("xtask: {error:#}\nxtask: tests that need an adapter will be SKIPPED");
            Ok(false)
        }
    }
}

/// Checks the crates that a browser runs, where the compiler has that target.
fn check_wasm() -> Result<()> {
    if !has_target(WASM_TARGET) {
        eprintln!(
            "xtask: SKIPPED: the compiler has no {WASM_TARGET}; `rustup target add {WASM_TARGET}` lets the browser's build be checked"
        );
        return Ok(());
    }
    run(cargo().args(["check", "--target", WASM_TARGET]).args(WASM_CRATES.iter().flat_map(|name| ["--package", name])))
}

fn has_target(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|output| {
        output.status.success() && Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir()
    })
}

fn is_set(variable: &str) -> bool {
    env::var_os(variable).is_some_and(|value| !value.is_empty() && value != "0")
}
