//! Test of the page in a browser, used as a person would use it, on WebGPU and on WebGL2.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail, ensure};

use super::{
    browser::{self, Browser},
    build,
    memory::Memory,
    pictures, serve, toolchain,
    visit::{APIS, PATIENCE, SIZE, Visit},
};
use crate::{
    adapter,
    run::{build_umbrage, install, root, run},
};

/// Largest share of pixels in which the browser's picture may differ from the native one.
const MOST_DIFFERENT: f64 = 0.005;
/// Number of frames of the search for growing memory; `UMBRAGE_WEB_FRAMES` chooses another.
const FRAMES: u64 = 5_000;
/// Share of these frames after which everything has its size.
const WARM: u64 = 5;
/// Size of the window for these frames, in pixels. Memory does not depend on it.
const SMALL: [u32; 2] = [160, 120];

/// Positions of controls at [`SIZE`]. The effects of clicks show whether the controls are still
/// there.
mod places {
    /// Position of a world in the menu.
    pub const ROBOT_WAR: [f64; 2] = [46.0, 37.0];
    /// Drag from the handle of the number of splits, 4, to the left.
    pub const SPLITS: [[f64; 2]; 4] = [[749.0, 205.0], [745.0, 205.0], [740.0, 205.0], [733.0, 205.0]];
}

/// Opens the page in a browser, uses it and compares its picture with the native one.
pub fn check_in_browser() -> Result<()> {
    let way = toolchain::find()?.context("there is no way to compile for a browser here")?;
    let program = match browser::find() {
        Some(program) => program,
        None => {
            install(&["chromium"])?;
            browser::find().context("Chromium is installed and does not start")?
        }
    };
    let umbrage = build_umbrage(false)?;
    adapter::ensure(&umbrage)?;
    let folder = root().join("out/web");
    build(&way, &folder)?;
    let address = serve::Server::open(&folder, 0)?.start();
    let kept = root().join("out/web-test");
    fs::create_dir_all(&kept).with_context(|| format!("{} cannot be made", kept.display()))?;
    for api in &APIS {
        let mut visit = Visit::start(&program, api, &address, &kept)?;
        visit.first_picture()?;
        visit.use_controls()?;
        visit.compare(&umbrage)?;
        visit.change_filter()?;
        visit.drop_files()?;
        visit.hide()?;
        visit.lose()?;
        visit.run_on()?;
    }
    without_an_interface(&program, &address)
}

impl Visit<'_> {
    /// Checks that the page opens with the chessboard, on the right interface.
    fn first_picture(&mut self) -> Result<()> {
        self.open("chessboard")?;
        self.wait("the chessboard")?;
        let adapter = self.browser.data("adapter")?;
        ensure!(adapter.contains(self.api.adapter), "{}: the page draws with {adapter}", self.api.name);
        let all = self.browser.text("Math.round(performance.now())")?;
        let first = self.browser.text("Math.round(pictureTimes[0])")?;
        self.say(&format!("{adapter}; the first picture {first} ms after the page began to load, all after {all} ms"));
        self.keep("panels").map(drop)
    }

    /// Picks a world in the menu, and drags a slider.
    fn use_controls(&mut self) -> Result<()> {
        let begun = Instant::now();
        self.browser.drag(&[places::ROBOT_WAR])?;
        self.browser.wait("a click on Robot War", PATIENCE, |b| Ok(b.data("command")?.contains(" robot-war ")))?;
        self.wait("Robot War")?;
        self.say(&format!("another world after {:.1} s", begun.elapsed().as_secs_f64()));
        let before = self.browser.data("command")?;
        self.browser.drag(&places::SPLITS)?;
        self.browser.wait("a drag of the slider", PATIENCE, |b| Ok(b.data("command")? != before))?;
        self.wait("other splits")?;
        let after = self.browser.data("command")?;
        let took = self.browser.data("wall")?;
        self.say(&format!("{after}: drawn in {took} ms"));
        self.keep("used").map(drop)
    }

    /// Checks that the page and the command draw the same picture for one address.
    fn compare(&mut self, umbrage: &Path) -> Result<()> {
        let link = self.browser.text("location.hash.slice(1)")?;
        self.open(&format!("{link}&bare"))?;
        self.wait("the page's own link")?;
        let shown = pictures::read(&self.keep("picture")?)?;
        let command = self.browser.data("command")?;
        let path = self.kept.join(format!("{}-native.png", self.api.name));
        let words = command.strip_prefix("umbrage view ").with_context(|| format!("{command:?} is no command"))?;
        let size = format!("{}x{}", shown.width(), shown.height());
        run(Command::new(umbrage)
            .arg("render")
            .args(words.split_whitespace())
            .args(["--size", &size, "-o"])
            .arg(&path))?;
        let difference = pictures::difference(&shown, &pictures::read(&path)?)?;
        self.say(&format!("{:.3} % of the pixels differ from the native picture", 100.0 * difference));
        if difference > MOST_DIFFERENT {
            bail!("{}: more than {} %; see {}", self.api.name, 100.0 * MOST_DIFFERENT, self.kept.display());
        }
        Ok(())
    }

    /// Lets time run, and checks that memory does not grow.
    fn run_on(&mut self) -> Result<()> {
        let frames: u64 = std::env::var("UMBRAGE_WEB_FRAMES").ok().and_then(|n| n.parse().ok()).unwrap_or(FRAMES);
        self.browser.resize(SMALL)?;
        self.open("chessboard&bare&run")?;
        let count = |browser: &mut Browser| -> Result<u64> { Ok(browser.data("pictures")?.parse().unwrap_or(0)) };
        let limit = PATIENCE + Duration::from_secs(frames);
        self.browser.wait("the first frames", limit, |browser| Ok(count(browser)? >= frames / WARM))?;
        let before = Memory::of(&mut self.browser)?;
        self.browser.wait("more frames", limit, |browser| Ok(count(browser)? >= frames))?;
        let after = Memory::of(&mut self.browser)?;
        self.say(&format!("after {} frames: {}", frames / WARM, before.text()));
        self.say(&format!("after {frames} frames: {}", after.text()));
        after.check_since(&before).with_context(|| self.api.name)
    }
}

/// Checks that a browser without either interface reports this.
fn without_an_interface(program: &PathBuf, address: &str) -> Result<()> {
    let mut browser = Browser::start(program, SIZE, &["--disable-gpu", "--disable-3d-apis", "--disable-webgpu"])?;
    browser.open(&format!("{address}index.html"))?;
    let shown = "document.getElementById('message')?.hidden === false ? message.textContent : ''";
    let begun = Instant::now();
    loop {
        let said = browser.text(shown)?;
        if said.contains("WebGPU or WebGL2") {
            eprintln!("xtask: neither: {said}");
            return Ok(());
        }
        ensure!(begun.elapsed() < PATIENCE, "a browser without graphics is told nothing but {said:?}");
    }
}
