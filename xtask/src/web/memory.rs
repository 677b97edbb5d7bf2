//! Memory of the page: what thousands of frames may add to it.

use anyhow::{Context, Result, ensure};
use serde_json::json;

use super::browser::Browser;

/// Bytes by which WebAssembly's memory may grow. A page of it is 64 KiB, and allocators take
/// several at once.
const MOST_OF_PROGRAM: u64 = 1 << 20;
/// Bytes by which the objects of JavaScript may grow after the collection of garbage: code that is
/// optimised meanwhile, and samples of the browser's own.
const MOST_OF_SCRIPT: u64 = 1 << 20;
/// Bytes by which the graphics process may grow. Its allocators return memory late.
const MOST_OF_GRAPHICS: u64 = 48 << 20;

/// Bytes in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// WebAssembly's memory.
    program: u64,
    /// Objects of JavaScript.
    script: u64,
    /// Resident memory of the graphics process; 0 where the system does not tell.
    graphics: u64,
}

impl Memory {
    /// Reads the page's memory, after the collection of garbage.
    pub fn of(browser: &mut Browser) -> Result<Self> {
        // What a first collection lets go of may hold more.
        for _ in 0..2 {
            browser.call("HeapProfiler.collectGarbage", json!({}))?;
        }
        let heap = browser.call("Runtime.getHeapUsage", json!({}))?;
        Ok(Self {
            program: browser.data("memory")?.parse().context("the page does not tell its memory")?,
            script: heap["usedSize"].as_f64().context("the browser does not tell the heap's size")? as u64,
            graphics: browser.graphics_memory()?,
        })
    }

    /// Describes the memory in MB.
    pub fn text(&self) -> String {
        let [program, script, graphics] = [self.program, self.script, self.graphics].map(|bytes| bytes as f64 / 1e6);
        format!(
            "{program:.1} MB of WebAssembly, {script:.1} MB of JavaScript, {graphics:.0} MB of the graphics process"
        )
    }

    /// Checks that the memory has not grown since `before`.
    pub fn check_since(&self, before: &Self) -> Result<()> {
        for (what, before, after, most) in [
            ("WebAssembly's memory", before.program, self.program, MOST_OF_PROGRAM),
            ("the objects of JavaScript", before.script, self.script, MOST_OF_SCRIPT),
            ("the graphics process", before.graphics, self.graphics, MOST_OF_GRAPHICS),
        ] {
            ensure!(after <= before + most, "{what} grew from {before} to {after} bytes; {most} more are allowed");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_of_each_kind_is_noticed() {
        let before = Memory { program: 30 << 20, script: 5 << 20, graphics: 300 << 20 };
        let more = Memory { program: before.program + MOST_OF_PROGRAM, ..before };
        assert!(before.check_since(&before).is_ok() && more.check_since(&before).is_ok());
        for (grown, what) in [
            (Memory { program: more.program + 1, ..before }, "WebAssembly"),
            (Memory { script: before.script + MOST_OF_SCRIPT + 1, ..before }, "JavaScript"),
            (Memory { graphics: before.graphics + MOST_OF_GRAPHICS + 1, ..before }, "graphics"),
        ] {
            let error = grown.check_since(&before).expect_err("it has grown").to_string();
            assert!(error.contains(what), "{error}");
        }
    }
}
