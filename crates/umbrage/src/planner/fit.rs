//! Stage 4 of a sun's plan: the size of a split's map, and the margin that its filter needs.

use glam::DVec2;

use super::layout::SplitFrame;
use crate::Warp;
use crate::config::Stability;
use crate::geometry::sphere::stable_texel;
use crate::held::rectangle::{HeldRectangle, longest_edge};
use crate::margin::{EDGE_TEXELS, FilterReach};

/// Size of a stabilised map, and the filter's reach in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct MapSize {
    /// Reach of the split's filter; the texels depend on the map's size.
    pub reach: FilterReach,
    /// Half the edges of a stabilised map without its margin, in metres.
    pub half: DVec2,
    /// The filter's reach in a stabilised map, in texels.
    pub still_reach: f64,
    /// Metres per texel of a stabilised map.
    pub still_texel: DVec2,
    /// The longest edge in metres that a held rectangle may have although less is shown.
    pub longest: f64,
}

impl MapSize {
    pub fn new(split: &SplitFrame<'_>, held: &HeldRectangle) -> Self {
        let (half, size) = (split.layout.row.half[split.index], split.size());
        // A warped map's texels differ in size.
        let reach = if split.warp() == Warp::None { split.frame.reach } else { split.frame.reach.most() };
        let still_reach = reach.texels(2.0 * half.min_element(), size, 2.0 * EDGE_TEXELS + 1.0);
        let texel = |half| stable_texel(half, size, still_reach + EDGE_TEXELS);
        let longest = match split.stride() {
            Some(stride) => held.longest_edge() * stride.most(),
            None => 0.0,
        };
        Self { reach, half, still_reach, longest, still_texel: DVec2::new(texel(half.x), texel(half.y)) }
    }

    /// Upper bound in metres of the margin that filters read around the served region, if that is
    /// `widest` metres wide.
    pub fn margin(&self, split: &SplitFrame<'_>, widest: f64) -> f64 {
        let (margin, size) = (split.frame.margin, f64::from(split.size()));
        match split.frame.config.stability {
            Stability::Exact => (self.still_reach + EDGE_TEXELS) * self.still_texel.max_element(),
            Stability::Approximate { steps } => {
                let edge = longest_edge(steps, widest, split.layout.whole_width).max(self.longest);
                margin * edge / (size - 2.0 * margin - 1.0)
            }
            Stability::Tight { .. } => widest * margin / (size - 2.0 * margin).max(1.0),
        }
    }
}
