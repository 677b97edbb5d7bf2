//! The range of view depths that a split serves.

use super::frame::Frame;
use crate::View;
use crate::config::Range;
use crate::planes::scheme::coverage;

/// The range of view depths that a split serves.
#[derive(Clone, Copy, Debug)]
pub(super) struct SliceEnds {
    pub from: f64,
    pub to: f64,
    /// True if the camera shows any of these depths. Other splits still get a valid matrix.
    pub is_visible: bool,
}

impl SliceEnds {
    /// The ends of split `i` between `planes`.
    pub fn new(frame: &Frame<'_>, planes: &[f64], i: usize) -> Self {
        let (from, to) = covered(frame, frame.view, planes, i);
        // Where the range holds all that is visible, nothing before it asks.
        let fitted_begin = i == 0 && frame.config.range == Range::Visible;
        let from = if fitted_begin { from.max(planes[i]) } else { from };
        let is_visible = to > from;
        let (from, to) = if is_visible { (from, to) } else { (planes[i], planes[i + 1]) };
        Self { from, to, is_visible }
    }
}

/// The range of view depths between `planes` that may sample the map of split `i`, for the pixels
/// of `view`.
pub(super) fn covered(frame: &Frame<'_>, view: &View, planes: &[f64], i: usize) -> (f64, f64) {
    let (blend, metric) = (frame.config.blend(), frame.config.selection.metric());
    coverage(view, planes, i, blend, frame.image_size, metric)
}
