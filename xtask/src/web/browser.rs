//! Chromium without a window, driven over the pipe of its DevTools protocol as a person would use
//! it.

use std::{
    io::{BufRead as _, BufReader, Write as _},
    path::PathBuf,
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc::{Receiver, RecvTimeoutError, channel},
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, anyhow, bail};
use base64::{Engine as _, prelude::BASE64_STANDARD};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::run::succeeds;

/// Names of Chromium on various systems.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// Longest wait for an answer. Software rendering is slow, and a busy page answers late.
const PATIENCE: Duration = Duration::from_secs(120);
/// Time between two polls of the page.
const LOOK: Duration = Duration::from_millis(50);

/// Returns the path of the program, if it is installed.
pub fn find() -> Option<PathBuf> {
    NAMES.iter().map(PathBuf::from).find(|name| succeeds(Command::new(name).arg("--version")))
}

/// A running browser with one page.
pub struct Browser {
    child: Child,
    orders: ChildStdin,
    answers: Receiver<Value>,
    session: Value,
    next: u64,
    /// Errors and warnings that the page has reported.
    pub complaints: Vec<String>,
    _profile: TempDir,
}

impl Browser {
    /// Starts the browser with a window of this size and these switches.
    pub fn start(program: &PathBuf, size: [u32; 2], switches: &[&str]) -> Result<Self> {
        let profile = tempfile::tempdir().context("there is no place for a profile")?;
        // The browser listens on descriptor 3 and answers on 4.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null"])
            .arg(program)
            .args(["--headless", "--no-sandbox", "--no-first-run", "--remote-debugging-pipe", "--hide-scrollbars"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("--window-size={},{}", size[0], size[1]))
            .args(switches)
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("the browser does not start")?;
        let orders = child.stdin.take().context("the browser takes no orders")?;
        let said = child.stdout.take().context("the browser says nothing")?;
        let (sender, answers) = channel();
        thread::spawn(move || {
            for message in BufReader::new(said).split(0).map_while(std::io::Result::ok) {
                let Ok(message) = serde_json::from_slice(&message) else { continue };
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let mut browser =
            Self { child, orders, answers, session: Value::Null, next: 0, complaints: Vec::new(), _profile: profile };
        browser.open_page(size)?;
        Ok(browser)
    }

    fn open_page(&mut self, size: [u32; 2]) -> Result<()> {
        let target = self.call("Target.createTarget", json!({ "url": "about:blank" }))?["targetId"].clone();
        let attached = self.call("Target.attachToTarget", json!({ "targetId": target, "flatten": true }))?;
        self.session = attached["sessionId"].clone();
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            self.call(domain, json!({}))?;
        }
        self.resize(size)
    }

    /// Sets the size of the window in pixels.
    pub fn resize(&mut self, [width, height]: [u32; 2]) -> Result<()> {
        let screen = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", screen).map(drop)
    }

    /// Sends a command and waits for its result.
    pub fn call(&mut self, method: &str, params: Value) -> Result<Value> {
        self.next += 1;
        let id = self.next;
        let mut order = json!({ "id": id, "method": method, "params": params });
        if !self.session.is_null() {
            order["sessionId"] = self.session.clone();
        }
        let mut bytes = serde_json::to_vec(&order).context("an order is no JSON")?;
        bytes.push(0);
        self.orders.write_all(&bytes).with_context(|| format!("{method}: the browser has gone"))?;
        loop {
            let answer = self.answers.recv_timeout(PATIENCE).map_err(|error| match error {
                RecvTimeoutError::Timeout => anyhow!("{method}: no answer within {} s", PATIENCE.as_secs()),
                RecvTimeoutError::Disconnected => anyhow!("{method}: the browser has gone"),
            })?;
            if answer["id"] == id {
                if let Some(error) = answer.get("error") {
                    bail!("{method}: {error}");
                }
                return Ok(answer["result"].clone());
            }
            self.hear(&answer);
        }
    }

    /// Records the page's errors and warnings.
    fn hear(&mut self, event: &Value) {
        let params = &event["params"];
        match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => {
                self.complaints.push(params["exceptionDetails"]["exception"]["description"].to_string());
            }
            Some("Runtime.consoleAPICalled") if params["type"] == "error" => {
                self.complaints.push(params["args"][0]["value"].to_string());
            }
            Some("Log.entryAdded") if params["entry"]["level"] == "error" => {
                self.complaints.push(params["entry"]["text"].to_string());
            }
            _ => {}
        }
    }

    /// Runs a script in every page that is opened from now on, before the page's own.
    pub fn run_before_pages(&mut self, script: &str) -> Result<()> {
        self.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": script })).map(drop)
    }

    /// Returns the resident bytes of the process that draws; 0 on systems without `/proc`.
    pub fn graphics_memory(&mut self) -> Result<u64> {
        let session = std::mem::take(&mut self.session);
        let told = self.call("SystemInfo.getProcessInfo", json!({}));
        self.session = session;
        let told = told?;
        let processes = told["processInfo"].as_array().map_or(&[][..], Vec::as_slice);
        let graphics = processes.iter().find(|process| process["type"] == "GPU").map(|process| process["id"].clone());
        let Some(id) = graphics else { return Ok(0) };
        let Ok(status) = std::fs::read_to_string(format!("/proc/{id}/status")) else { return Ok(0) };
        let kilobytes = status.lines().find_map(|line| line.strip_prefix("VmRSS:")?.split_whitespace().next());
        Ok(1024 * kilobytes.and_then(|number| number.parse::<u64>().ok()).unwrap_or(0))
    }

    /// Opens an address afresh.
    pub fn open(&mut self, address: &str) -> Result<()> {
        self.call("Page.navigate", json!({ "url": "about:blank" }))?;
        self.call("Page.navigate", json!({ "url": address })).map(drop)
    }

    /// Evaluates a JavaScript expression and returns the result as text.
    pub fn text(&mut self, expression: &str) -> Result<String> {
        let asked = json!({ "expression": format!("String({expression})"), "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", asked)?;
        if let Some(error) = answer.get("exceptionDetails") {
            bail!("{expression}: {error}");
        }
        Ok(answer["result"]["value"].as_str().unwrap_or_default().to_owned())
    }

    /// Returns the state that the page writes under a key.
    pub fn data(&mut self, key: &str) -> Result<String> {
        self.text(&format!("document.documentElement?.dataset.{key} ?? ''"))
    }

    /// Waits until the page's state is as wanted. Errors and a missing viewer end the wait.
    pub fn wait(
        &mut self,
        what: &str,
        limit: Duration,
        mut is_there: impl FnMut(&mut Self) -> Result<bool>,
    ) -> Result<()> {
        self.wait_despite(what, limit, |browser| {
            if is_there(browser)? {
                return Ok(true);
            }
            let message =
                browser.text("document.getElementById('message')?.hidden === false ? message.textContent : ''")?;
            let errors = browser.data("errors")?;
            if !(message.is_empty() && errors.is_empty()) {
                bail!("{what}: the page says: {message}{errors}\n{}", browser.complaints.join("\n"));
            }
            Ok(false)
        })
    }

    /// Waits until the page's state is as wanted, whatever errors it reports.
    pub fn wait_despite(
        &mut self,
        what: &str,
        limit: Duration,
        mut is_there: impl FnMut(&mut Self) -> Result<bool>,
    ) -> Result<()> {
        let begun = Instant::now();
        while !is_there(self)? {
            if begun.elapsed() > limit {
                bail!("{what}: not within {} s\n{}", limit.as_secs(), self.complaints.join("\n"));
            }
            thread::sleep(LOOK);
        }
        Ok(())
    }

    /// Clicks, or drags from the first point to the last.
    pub fn drag(&mut self, points: &[[f64; 2]]) -> Result<()> {
        let mouse = |kind: &str, [x, y]: [f64; 2], buttons: u32| {
            let button = if kind == "mouseMoved" && buttons == 0 { "none" } else { "left" };
            json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 })
        };
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Ok(()) };
        let mut events = vec![mouse("mouseMoved", first, 0), mouse("mousePressed", first, 1)];
        events.extend(points.iter().skip(1).map(|&point| mouse("mouseMoved", point, 1)));
        events.push(mouse("mouseReleased", last, 0));
        for event in events {
            self.call("Input.dispatchMouseEvent", event)?;
            // The controls see the pointer frame by frame, as it is with a hand.
            thread::sleep(LOOK);
        }
        Ok(())
    }

    /// Takes a screenshot as PNG.
    pub fn picture(&mut self) -> Result<Vec<u8>> {
        let taken = self.call("Page.captureScreenshot", json!({ "format": "png" }))?;
        BASE64_STANDARD.decode(taken["data"].as_str().unwrap_or_default()).context("the screenshot is no picture")
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may have ended by itself.
        drop(self.call("Browser.close", json!({})));
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
