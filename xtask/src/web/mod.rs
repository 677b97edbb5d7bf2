//! `cargo xtask web`: the viewer as a page, and a server for it.

mod browser;
mod check;
mod events;
mod memory;
mod pictures;
mod serve;
mod toolchain;
mod visit;

use std::{
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};
use brotli::enc::BrotliEncoderParams;
use flate2::{Compression, write::GzEncoder};

pub use self::check::check_in_browser;
use self::toolchain::Way;
use crate::run::{cargo, output, root, run, succeeds};

/// Crate of the page; `CRATES` adds the crates that applications build for browsers.
const PAGE: &str = "umbrage-web";
const CRATES: [&str; 5] = [PAGE, "umbrage", "umbrage-shaders", "umbrage-wgpu", "umbrage-render"];
/// Largest number of bytes, as brotli, that a visitor has to load before the page runs.
const MOST_BYTES: usize = 3_000_000;
/// Files that the page's menu opens, with the files that their licences require.
const ASSETS: [&str; 3] = ["assets/city_candela.glb", "assets/README.md", "assets/ATTRIBUTION-stk.txt"];
/// Options of `wasm-opt`: small before fast, and what Rust's compiler takes for granted.
const SHRINK: [&str; 8] = [
    "-Os",
    "--enable-bulk-memory",
    "--enable-mutable-globals",
    "--enable-nontrapping-float-to-int",
    "--enable-reference-types",
    "--enable-multivalue",
    "--enable-sign-ext",
    "--strip-producers",
];
/// Default port of the server.
const PORT: u16 = 8080;

/// Options of `cargo xtask web`.
pub struct Ask {
    out: PathBuf,
    serves: bool,
    port: u16,
}

impl Ask {
    /// Reads the options.
    pub fn read(options: &[&str]) -> Result<Self> {
        let mut ask = Self { out: root().join("out/web"), serves: true, port: PORT };
        let mut options = options.iter();
        while let Some(&option) = options.next() {
            let mut value = || options.next().with_context(|| format!("{option} needs a value"));
            match option {
                "--no-serve" => ask.serves = false,
                "--out" => ask.out = PathBuf::from(value()?),
                "--port" => {
                    ask.port = value()?.parse().with_context(|| format!("{option}: give a number up to 65535"))?
                }
                _ => bail!("web {option}: there are --no-serve, --out FOLDER and --port NUMBER"),
            }
        }
        Ok(ask)
    }
}

/// Builds the page, and serves it until it is interrupted.
pub fn web(ask: &Ask) -> Result<()> {
    let way = toolchain::find()?.context("there is no way to compile for a browser here")?;
    build(&way, &ask.out)?;
    if !ask.serves {
        return Ok(());
    }
    let server = serve::Server::open(&ask.out, ask.port)?;
    eprintln!("xtask: the viewer is at {} until Ctrl + C", server.address());
    server.run();
    Ok(())
}

/// Checks the crates that a browser runs, if this machine can compile them.
pub fn check_crates() -> Result<()> {
    let way = match toolchain::find() {
        Ok(Some(way)) => way,
        Ok(None) => return Ok(()),
        // A compiler that could not be fetched says nothing of the crates.
        Err(error) => {
            eprintln!("xtask: SKIPPED: crates are not checked for a browser: {error:#}");
            return Ok(());
        }
    };
    run(way.cargo("check").args(CRATES.iter().flat_map(|name| ["--package", name])))
}

/// Builds the page into a folder that any server of static files can show.
fn build(way: &Way, out: &Path) -> Result<()> {
    run(way.cargo("build").args(["--package", PAGE]))?;
    let bindgen = bindgen()?;
    fs::create_dir_all(out).with_context(|| format!("{} cannot be made", out.display()))?;
    run(Command::new(bindgen)
        .args([
            "--target",
            "web",
            "--no-typescript",
            "--remove-name-section",
            "--remove-producers-section",
            "--out-dir",
        ])
        .arg(out)
        .arg(Way::program(PAGE)))?;
    shrink(&out.join(format!("{PAGE}_bg.wasm")));
    copy(&root().join("crates").join(PAGE).join("index.html"), &out.join("index.html"))?;
    for asset in ASSETS {
        copy(&root().join(asset), &out.join(asset))?;
    }
    report(out)
}

/// Makes the program smaller, where `wasm-opt` is at hand and reads what the compiler wrote: an old
/// one may not. The size is checked afterwards in any case.
fn shrink(program: &Path) {
    let shrunk = toolchain::wasm_opt().and_then(|optimiser| {
        let optimiser = optimiser.context("install binaryen")?;
        run(Command::new(optimiser).args(SHRINK).arg(program).arg("-o").arg(program))
    });
    if let Err(error) = shrunk {
        eprintln!("xtask: SKIPPED: the page is larger than wasm-opt would make it: {error:#}");
    }
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).with_context(|| format!("{} cannot be made", folder.display()))?;
    }
    fs::copy(from, to).map(drop).with_context(|| format!("{} cannot be copied to {}", from.display(), to.display()))
}

/// Writes the page's files compressed beside them, for servers that send such files, and prints
/// their sizes. More than [`MOST_BYTES`] in all is an error.
fn report(out: &Path) -> Result<()> {
    let (mut as_gzip, mut as_brotli) = (0, 0);
    for name in ["index.html", "umbrage-web.js", "umbrage-web_bg.wasm"] {
        let bytes = fs::read(out.join(name)).with_context(|| format!("{name} was not built"))?;
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&bytes).context("gzip")?;
        let gzip = encoder.finish().context("gzip")?.len();
        let mut brotli = Vec::new();
        ::brotli::BrotliCompress(&mut bytes.as_slice(), &mut brotli, &BrotliEncoderParams::default())
            .context("brotli")?;
        fs::write(out.join(format!("{name}.br")), &brotli).with_context(|| format!("{name}.br cannot be written"))?;
        eprintln!("xtask: {name}: {} bytes, {gzip} as gzip, {} as brotli", bytes.len(), brotli.len());
        (as_gzip, as_brotli) = (as_gzip + gzip, as_brotli + brotli.len());
    }
    eprintln!("xtask: {}: {as_brotli} bytes to load as brotli, {as_gzip} as gzip", out.display());
    if as_brotli > MOST_BYTES {
        bail!("the page is larger than {MOST_BYTES} bytes; see what `umbrage-viewer` has begun to depend on");
    }
    Ok(())
}

/// Returns `wasm-bindgen` of the version that the page is linked with. It is built once, which
/// takes some minutes.
fn bindgen() -> Result<PathBuf> {
    let lock = fs::read_to_string(root().join("Cargo.lock")).context("Cargo.lock cannot be read")?;
    let version = locked(&lock, "wasm-bindgen").context("Cargo.lock has no wasm-bindgen")?;
    let is_it =
        |program: &Path| output(Command::new(program).arg("--version")).is_ok_and(|said| said.ends_with(version));
    let folder = toolchain::folder().join("bindgen");
    let built = folder.join("bin").join(format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX));
    for program in [PathBuf::from("wasm-bindgen"), built.clone()] {
        if succeeds(Command::new(&program).arg("--version")) && is_it(&program) {
            return Ok(program);
        }
    }
    run(cargo().args(["install", "wasm-bindgen-cli", "--version", version, "--root"]).arg(folder))?;
    Ok(built)
}

/// Returns the version of a package in a lock file.
fn locked<'l>(lock: &'l str, package: &str) -> Option<&'l str> {
    let (_, behind) = lock.split_once(&format!("name = \"{package}\"\nversion = \""))?;
    behind.split('"').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_locked_version_is_that_of_the_package_alone() {
        let lock = "[[package]]\nname = \"wasm-bindgen-futures\"\nversion = \"0.4.80\"\n\n\
                    [[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.130\"\n";
        assert_eq!(locked(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(locked(lock, "wasm"), None);
    }

    #[test]
    fn options_are_read_or_said_to_be_wrong() {
        let ask = Ask::read(&["--no-serve", "--out", "somewhere", "--port", "9000"]).expect("options");
        assert_eq!((ask.serves, ask.out.as_path(), ask.port), (false, Path::new("somewhere"), 9000));
        for (options, why) in [(&["--port", "high"][..], "--port"), (&["--out"], "--out"), (&["--fast"], "--no-serve")]
        {
            let error = Ask::read(options).err().expect("wrong").to_string();
            assert!(error.contains(why), "{error}");
        }
    }
}
