//! Checks that CI runs, and a developer before a commit.

use std::{env, process::Command};

use anyhow::Result;

use crate::{
    adapter, deny, msrv,
    packages::packages,
    run::{build_umbrage, cargo, root, run, succeeds},
    web,
};

/// Environment variable: if it is 1, tests that need an adapter fail without one, rather than skip.
const REQUIRE_GPU: &str = "UMBRAGE_REQUIRE_GPU";
/// Environment variable: if it is 1, tests write their references again.
const BLESS: &str = "UMBRAGE_BLESS";

/// Crates whose tests need no adapter and take less than a minute: `--quick` runs them.
const QUICK_CRATES: [&str; 5] = ["umbrage", "umbrage-shaders", SHADERS_JOIN, "umbrage-scene", "xtask"];
/// Name of the crate that joins the checked-in WGSL.
const SHADERS_JOIN: &str = "umbrage-shaders-join";
/// Folder of the plugin for Bevy: a workspace of its own, so that its versions stay apart from
/// ours.
const BEVY: &str = "integrations/bevy";
/// Folder of the test that composes our WGSL with `naga_oil`: a workspace of its own, because
/// `naga_oil` asks for features of naga that would build every user of naga anew.
const NAGA_OIL: &str = "integrations/naga_oil";
/// Folder of the targets of libFuzzer: a workspace of its own, which needs a nightly compiler.
const FUZZ: &str = "fuzz";
/// Features that build C++. They are checked where there is a compiler for it.
const CPP_FEATURES: [&str; 1] = ["flip"];

/// Checks formatting, lints, documentation, features, packages, and the browser's build, and runs
/// all tests.
pub fn test() -> Result<()> {
    run(cargo().args(["fmt", "--all", "--check"]))?;
    for folder in [NAGA_OIL, FUZZ] {
        run(cargo().current_dir(root().join(folder)).args(["fmt", "--check"]))?;
    }
    // Before anything is built of texts that are out of date.
    run(cargo().args(["test", "--package", SHADERS_JOIN]))?;
    run(cargo().args(["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    web::check_crates()?;
    run(cargo().args(["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))?;
    check_features()?;
    check_packages()?;
    deny::check()?;
    msrv::check()?;
    check_composed()?;
    let has_adapter = has_adapter()?;
    // Documentation's examples are among the tests.
    let mut tests = cargo();
    tests.args(["test", "--workspace"]);
    if has_adapter {
        tests.env(REQUIRE_GPU, "1");
    }
    run(&mut tests)
}

/// Checks formatting, and runs the tests that need no adapter.
pub fn quick() -> Result<()> {
    run(cargo().args(["fmt", "--all", "--check"]))?;
    run(cargo().arg("test").args(of(&QUICK_CRATES)))
}

/// Checks formatting, lints and documentation of the plugin for Bevy, runs its tests, which need no
/// adapter, and draws a scene with and without it if there is one.
pub fn bevy() -> Result<()> {
    let folder = root().join(BEVY);
    let in_folder = |arguments: &[&str]| {
        let mut command = cargo();
        command.current_dir(&folder).args(arguments);
        command
    };
    run(&mut in_folder(&["fmt", "--all", "--check"]))?;
    run(&mut in_folder(&["clippy", "--all-targets", "--locked", "--", "-D", "warnings"]))?;
    run(in_folder(&["doc", "--no-deps", "--locked"]).env("RUSTDOCFLAGS", "-D warnings"))?;
    run(&mut in_folder(&["test", "--locked"]))?;
    run(&mut in_folder(&["run", "--locked", "--quiet", "--example", "before_after", "--", "short"]))
}

/// Writes the joined WGSL again.
pub fn shaders() -> Result<()> {
    run(cargo().args(["run", "--quiet", "--package", SHADERS_JOIN]))
}

/// Packs all published crates, in the order of their dependencies, and builds each from its package
/// alone.
pub fn package() -> Result<()> {
    run(cargo().args(["package", "--workspace", "--allow-dirty"]).args(unpublished()?))
}

/// Runs the tests of pictures and accepts their pictures as the new references. Ceilings of scores
/// are constants and stay unchanged.
pub fn bless() -> Result<()> {
    adapter::ensure(&build_umbrage(false)?)?;
    run(cargo().args(["test", "--package", "umbrage-tests"]).env(BLESS, "1").env(REQUIRE_GPU, "1"))?;
    eprintln!("xtask: look at what `git diff` says before you commit it");
    Ok(())
}

/// Runs the fuzzers of plans, loaders and exact edges, longer than CI does.
pub fn fuzz() -> Result<()> {
    for (package, test, variable, count) in [
        ("umbrage", "fuzz", "UMBRAGE_FUZZ_CASES", "1000000"),
        ("umbrage-scene", "mutated", "UMBRAGE_FUZZ_FILES", "100000"),
        ("umbrage-shaders", "soups", "UMBRAGE_FUZZ_SOUPS", "1000000"),
        ("umbrage-fuzz", "corpora", "UMBRAGE_FUZZ_RUNS", "100000"),
    ] {
        let mut tests = cargo();
        tests.args(["test", "--release", "--package", package, "--test", test, "--", "--nocapture"]);
        if !is_set(variable) {
            tests.env(variable, count);
        }
        run(&mut tests)?;
    }
    Ok(())
}

/// Plans and draws for as many frames as a player sees in a while, and checks that memory stays
/// flat.
pub fn soak() -> Result<()> {
    adapter::ensure(&build_umbrage(false)?)?;
    const FRAMES: &str = "UMBRAGE_SOAK_FRAMES";
    let test = |package, test: &str, frames: &str, options: &[&str]| {
        let mut tests = cargo();
        tests.args(["test", "--package", package, "--test", test, "--", "--nocapture"]).args(options);
        tests.env(REQUIRE_GPU, "1");
        if !is_set(FRAMES) {
            tests.env(FRAMES, frames);
        }
        run(&mut tests)
    };
    test("umbrage", "soak", "100000", &[])?;
    // Its number of frames is in its name.
    test("umbrage-wgpu", "memory", "10000", &["--ignored"])?;
    test("umbrage-render", "soak", "10000", &[])
}

/// Composes our WGSL with `naga_oil`.
fn check_composed() -> Result<()> {
    let mut tests = cargo();
    tests.current_dir(root().join(NAGA_OIL)).args(["test", "--locked", "--quiet"]);
    run(&mut tests)
}

/// Returns whether there is an adapter, after trying to install one. Its lack is an error if the
/// environment demands one.
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

/// Packs all published crates without building them: manifests, versions of siblings, files.
fn check_packages() -> Result<()> {
    run(cargo().args(["package", "--workspace", "--allow-dirty", "--no-verify", "--quiet"]).args(unpublished()?))
}

/// Returns options that leave out the crates that are not published.
fn unpublished() -> Result<Vec<String>> {
    let unpublished = packages()?.into_iter().filter(|package| !package.is_published());
    Ok(unpublished.flat_map(|package| ["--exclude".to_owned(), package.name]).collect())
}

/// Checks every crate that has features without all of them, and without each of them.
fn check_features() -> Result<()> {
    let has_cpp = succeeds(Command::new("c++").arg("--version"));
    if !has_cpp {
        eprintln!("xtask: SKIPPED: no C++ compiler `c++`; features that build C++ are not checked: {CPP_FEATURES:?}");
    }
    for package in packages()? {
        let skipped = |feature: &str| feature == "default" || !has_cpp && CPP_FEATURES.contains(&feature);
        let features: Vec<&str> = package.features.keys().map(String::as_str).filter(|name| !skipped(name)).collect();
        if features.is_empty() {
            continue;
        }
        let check = |features: &[&str]| {
            let mut command = cargo();
            command.args(["check", "--all-targets", "--no-default-features", "--package", &package.name]);
            if !features.is_empty() {
                command.args(["--features", &features.join(",")]);
            }
            run(&mut command)
        };
        check(&[])?;
        for without in &features {
            let others: Vec<&str> = features.iter().copied().filter(|feature| feature != without).collect();
            // Without the only one there is none, which was checked.
            if !others.is_empty() {
                check(&others)?;
            }
        }
        check(&features)?;
    }
    if has_cpp {
        run(cargo().args(["test", "--package", "umbrage-truth", "--features", "flip", "--lib", "scores"]))?;
    }
    Ok(())
}

/// Returns options that choose crates.
fn of(names: &[&'static str]) -> Vec<&'static str> {
    names.iter().flat_map(|&name| ["--package", name]).collect()
}

fn is_set(variable: &str) -> bool {
    env::var_os(variable).is_some_and(|value| !value.is_empty() && value != "0")
}
