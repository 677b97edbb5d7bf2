//! A browser that shows the page, on one of the graphics interfaces.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use anyhow::{Context, Result};

use super::browser::Browser;

/// Size of the browser's window in pixels, small because software draws every pixel.
pub const SIZE: [u32; 2] = [960, 600];
/// Longest wait until a picture is complete.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// Script that runs before the page's own: it keeps the times of pictures and of pasted text, and
/// the device that the page opens, so that it can be taken away.
const WATCH: &str = "
window.pictureTimes = [];
new MutationObserver(() => {
    const count = Number(document.documentElement?.dataset.pictures ?? 0);
    while (pictureTimes.length < Math.min(count, 1000)) pictureTimes.push(performance.now());
}).observe(document, { subtree: true, attributes: true, attributeFilter: ['data-pictures'] });
if (window.GPUAdapter) {
    const request = GPUAdapter.prototype.requestDevice;
    GPUAdapter.prototype.requestDevice = async function (...wanted) {
        return window.lastDevice = await request.apply(this, wanted);
    };
}";

/// A graphics interface, and the switches that enable it in a browser without a window or a
/// graphics card.
pub struct Api {
    pub name: &'static str,
    pub switches: &'static [&'static str],
    /// Part of the adapter's description.
    pub adapter: &'static str,
}

/// The interfaces that are tested.
pub const APIS: [Api; 2] = [
    Api {
        name: "webgpu",
        switches: &["--enable-unsafe-webgpu", "--use-angle=gl-egl", "--ignore-gpu-blocklist"],
        adapter: "(webgpu",
    },
    Api { name: "webgl2", switches: &["--use-angle=gl-egl", "--ignore-gpu-blocklist"], adapter: "(gl" },
];

/// A browser that shows the page.
pub struct Visit<'a> {
    pub browser: Browser,
    pub api: &'a Api,
    address: &'a str,
    pub kept: &'a Path,
}

impl<'a> Visit<'a> {
    /// Starts a browser.
    pub fn start(program: &PathBuf, api: &'a Api, address: &'a str, kept: &'a Path) -> Result<Self> {
        let mut browser = Browser::start(program, SIZE, api.switches)?;
        browser.run_before_pages(WATCH)?;
        Ok(Self { browser, api, address, kept })
    }

    pub fn say(&self, what: &str) {
        eprintln!("xtask: {}: {what}", self.api.name);
    }

    pub fn open(&mut self, fragment: &str) -> Result<()> {
        self.browser.open(&format!("{}index.html#{fragment}", self.address))
    }

    /// Waits until the page is complete.
    pub fn wait(&mut self, what: &str) -> Result<()> {
        self.browser.wait(what, PATIENCE, |browser| Ok(browser.data("shown")? == "all"))
    }

    pub fn keep(&mut self, what: &str) -> Result<PathBuf> {
        let path = self.kept.join(format!("{}-{what}.png", self.api.name));
        fs::write(&path, self.browser.picture()?).with_context(|| format!("{} cannot be written", path.display()))?;
        Ok(path)
    }
}
