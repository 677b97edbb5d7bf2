//! Several views of one scene, side by side.

use umbrage::SunFade;

use super::{Frame, Outputs, Rendered, Renderer};
use crate::Result;

impl Renderer {
    /// Draws several views, for a split screen: each as if it were drawn alone, under the suns of
    /// `fade` if there is one. The views use the maps one after the other. Stabilisation state is
    /// kept for each, so a view keeps its place in the list from frame to frame.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_views(
        &mut self,
        frames: &[Frame<'_>],
        fade: Option<&SunFade>,
        outputs: Outputs,
    ) -> Result<Vec<Rendered>> {
        let mut views = Vec::with_capacity(frames.len());
        for (view, frame) in frames.iter().enumerate() {
            // The next slot is that of a sun that is faded to.
            self.view_slot = 2 * view as u32;
            let rendered = match fade {
                Some(fade) => self.render_faded(frame, fade, outputs),
                None => self.render(frame, outputs),
            };
            self.view_slot = 0;
            views.push(rendered?);
        }
        Ok(views)
    }
}
