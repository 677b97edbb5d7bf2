//! Calls that wait by blocking the thread, which a page in a browser may not do.

use super::{Frame, Outputs, Rendered, Renderer};
use crate::{ProbeAnswer, ProbePoint, Result};

impl Renderer {
    /// Draws a frame and waits for the requested outputs.
    ///
    /// # Errors
    /// As [`Renderer::render_async`].
    pub fn render(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        pollster::block_on(self.render_async(frame, outputs))
    }

    /// Probes points as [`Renderer::probe_async`] does, and blocks until the answers are there.
    ///
    /// # Errors
    /// As [`Renderer::probe_async`].
    pub fn probe(&mut self, frame: &Frame<'_>, points: &[ProbePoint]) -> Result<Vec<ProbeAnswer>> {
        pollster::block_on(self.probe_async(frame, points))
    }
}
