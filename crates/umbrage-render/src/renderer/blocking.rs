//! What waits by blocking the thread, which no page in a browser may do.

use super::{Frame, Outputs, Rendered, Renderer};
use crate::{ProbeAnswer, ProbePoint, Result};

impl Renderer {
    /// Draws a frame and waits for what was asked for.
    ///
    /// # Errors
    /// As [`Renderer::render_async`].
    pub fn render(&mut self, frame: &Frame<'_>, outputs: Outputs) -> Result<Rendered> {
        pollster::block_on(self.render_async(frame, outputs))
    }

    /// [`Renderer::probe_async`], blocking.
    ///
    /// # Errors
    /// As [`Renderer::probe_async`].
    pub fn probe(&mut self, frame: &Frame<'_>, points: &[ProbePoint]) -> Result<Vec<ProbeAnswer>> {
        pollster::block_on(self.probe_async(frame, points))
    }
}
