//! What may happen to a page: files are dropped on it, its tab is hidden, its graphics are taken
//! away.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, ensure};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use serde_json::json;

use super::{
    browser::Browser,
    visit::{PATIENCE, Visit},
};
use crate::run::root;

/// Time for which a hand rests between two changes: the page makes pipelines ahead meanwhile.
const REST: Duration = Duration::from_secs(4);
/// Scene that is dropped, and its name on the page.
const DROPPED: (&str, &str) = ("assets/city_candela.glb", "dropped-city.glb");
/// Name of a dropped file that is no scene.
const BROKEN: &str = "broken.glb";

impl Visit<'_> {
    /// Drops a file on the page, as a hand does.
    fn drop_file(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        let packed = BASE64_STANDARD.encode(bytes);
        self.browser.text(&format!(
            "(() => {{
                const bytes = Uint8Array.from(atob('{packed}'), (letter) => letter.charCodeAt(0));
                const dataTransfer = new DataTransfer();
                dataTransfer.items.add(new File([bytes], '{name}'));
                const options = {{ dataTransfer, bubbles: true, cancelable: true }};
                for (const kind of ['dragenter', 'dragover', 'drop']) {{
                    document.getElementById('canvas').dispatchEvent(new DragEvent(kind, options));
                }}
            }})()"
        ))?;
        Ok(())
    }

    /// Pastes settings, and measures the time until the picture that has them.
    pub(super) fn change_filter(&mut self) -> Result<()> {
        self.open("chessboard")?;
        self.wait("the chessboard")?;
        for filter in ["pcf7", "disc", "pcf3", "pcf7"] {
            thread::sleep(REST);
            let before = self.browser.data("command")?;
            self.browser.text(&format!(
                "(() => {{
                    const clipboardData = new DataTransfer();
                    clipboardData.setData('text', '--filter={filter}');
                    window.pasted = [performance.now(), pictureTimes.length];
                    window.dispatchEvent(new ClipboardEvent('paste', {{ clipboardData, bubbles: true }}));
                }})()"
            ))?;
            self.browser.wait("another filter", PATIENCE, |b| Ok(b.data("command")? != before))?;
            self.wait("another filter")?;
            let command = self.browser.data("command")?;
            ensure!(command.contains(&format!("--filter={filter}")), "after pasting --filter={filter}: {command}");
            let took = self.browser.text("Math.round(pictureTimes[pasted[1]] - pasted[0])")?;
            self.say(&format!("filter {filter}: drawn after {took} ms"));
        }
        Ok(())
    }

    /// Drops a scene and a file that is none: the scene stays, and a message says why.
    pub(super) fn drop_files(&mut self) -> Result<()> {
        let (scene, name) = DROPPED;
        let bytes = fs::read(root().join(scene)).with_context(|| format!("{scene} cannot be read"))?;
        let begun = Instant::now();
        self.drop_file(name, &bytes)?;
        self.browser.wait("a dropped scene", PATIENCE, |b| Ok(b.data("command")?.contains(name)))?;
        self.wait("a dropped scene")?;
        self.say(&format!("a dropped scene after {:.1} s", begun.elapsed().as_secs_f64()));
        self.keep("dropped")?;
        let before = self.browser.data("command")?;
        self.drop_file(BROKEN, b"glTF is what this begins with, and nothing more")?;
        let begun = Instant::now();
        while !self.browser.data("errors")?.contains(BROKEN) {
            ensure!(begun.elapsed() < PATIENCE, "{}: nothing is said of a dropped {BROKEN}", self.api.name);
        }
        self.browser.wait_despite("the scene before", PATIENCE, |b| Ok(b.data("shown")? == "all"))?;
        ensure!(self.browser.data("command")? == before, "{}: {BROKEN} took the scene away", self.api.name);
        let said = self.browser.data("errors")?;
        self.say(&format!("a bad file: {said}"));
        self.keep("broken").map(drop)
    }

    /// Hides the tab for a while, in which its address changes.
    pub(super) fn hide(&mut self) -> Result<()> {
        self.open("chessboard")?;
        self.wait("the chessboard")?;
        let state = |on: bool| json!({ "state": if on { "active" } else { "frozen" } });
        self.browser.call("Page.setWebLifecycleState", state(false))?;
        self.browser.text("void (location.hash = 'chessboard&tint')")?;
        self.browser.call("Page.setWebLifecycleState", state(true))?;
        self.browser.wait("a tab that was hidden", PATIENCE, |b| Ok(b.data("command")?.contains(" --tint")))?;
        self.wait("a tab that was hidden")
    }

    /// Takes the graphics away: the page goes on, or says why not, and its address still shows the
    /// same.
    pub(super) fn lose(&mut self) -> Result<()> {
        self.open("chessboard&filter=pcf3")?;
        self.wait("the chessboard")?;
        let pictures = |b: &mut Browser| Ok::<u64, anyhow::Error>(b.data("pictures")?.parse()?);
        if self.api.name == "webgpu" {
            let before = pictures(&mut self.browser)?;
            self.browser.text("lastDevice.destroy()")?;
            self.browser.wait("a lost device", PATIENCE, |b| Ok(pictures(b)? > before))?;
            self.wait("a lost device")?;
            self.say("a device was lost, and the page went on");
        } else {
            let lost = "document.getElementById('canvas').getContext('webgl2')\
                        .getExtension('WEBGL_lose_context').loseContext()";
            self.browser.text(lost)?;
            let message = "document.getElementById('message').hidden ? '' : message.textContent";
            let begun = Instant::now();
            let said = loop {
                let said = self.browser.text(message)?;
                if !said.is_empty() {
                    break said;
                }
                ensure!(begun.elapsed() < PATIENCE, "webgl2: nothing is said of a lost context");
            };
            ensure!(said.contains("--filter=pcf3"), "the message does not tell the settings: {said}");
            self.say(&format!("a lost context: {said}"));
            self.browser.call("Page.reload", json!({}))?;
            self.wait("the page after a lost context")?;
        }
        let command = self.browser.data("command")?;
        ensure!(command.contains("--filter=pcf3"), "{}: the settings are lost: {command}", self.api.name);
        Ok(())
    }
}
