//! Goals of almost still maps when the planes between them are about to move: each map grows to
//! what it serves by the planes before and after ([`crate::held::approach`]).

use super::casters::{Listed, Scene};
use super::fit::MapSize;
use super::frame::{Frame, Sun};
use super::in_view::InView;
use super::layout::{Layout, SplitFrame};
use super::picked::Picked;
use crate::config::{Selection, Stability};
use crate::geometry::region::Region;
use crate::held::rectangle::HeldRectangle;

/// The regions that the map of one split has to show; `None` where it has no casters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goals {
    by_new: Option<Region>,
    by_both: Option<Region>,
}

impl Goals {
    /// Measures the goals of a split; `None` if no planes are about to move.
    pub fn measure(
        split: &SplitFrame<'_>,
        size: &MapSize,
        (in_view, casters): (&mut InView, &mut Picked),
    ) -> Option<Self> {
        let next = split.layout.next.as_ref()?;
        let scenes = Scene::of_next_and_both(split, next, in_view);
        let [by_new, by_both] = scenes.map(|mut scene| {
            let listed = Listed::new(split, size, &mut scene, &in_view.casters, casters);
            (!casters.is_empty()).then_some(listed.target)
        });
        Some(Self { by_new, by_both })
    }

    /// Sets the goal of the split's map.
    pub fn set(&self, split: &SplitFrame<'_>, has_casters: bool, held: &mut HeldRectangle) {
        let Stability::Approximate { steps } = split.frame.config.stability else { return };
        match &self.by_both {
            Some(by_both) if has_casters => held.set_goal(by_both, self.by_new.as_ref()),
            by_both => held.begin(by_both.as_ref(), steps, split.layout.whole_width),
        }
    }
}

/// Limits goals by those of the maps behind, once all have been set.
pub(super) fn limit((frame, sun): (&Frame<'_>, &Sun<'_>), layout: &Layout, held: &mut [HeldRectangle]) {
    if layout.next.is_none() || frame.config.selection != Selection::Map {
        return;
    }
    for index in (0..frame.config.splits()).rev() {
        let split = SplitFrame { frame, sun, layout, index };
        if let Some(area) = like_the_next(&split, held) {
            held[index].limit_goal(area);
        }
    }
}

/// Area in square metres of the split's map if its texels were as large as those of the next map
/// that has casters, once that has reached its goal.
fn like_the_next(split: &SplitFrame<'_>, held: &[HeldRectangle]) -> Option<f64> {
    let sizes = &split.frame.config.map_sizes;
    let scaled = |map: usize| {
        let scale = f64::from(split.size()) / f64::from(sizes[map]);
        held[map].goal_area().map(|area| area * scale * scale)
    };
    (split.index + 1..sizes.len()).find_map(scaled)
}
