//! What the whole view may show: the lists that all slices choose from.

use super::frame::{Frame, Sun};
use crate::Aabb;
use crate::bounds::Placed;
use crate::coverage::Served;
use crate::geometry::region::Region;
use crate::geometry::volume::{Lies, Slice};

/// What the whole view may show, as indices into a frame's lists.
#[derive(Clone, Debug, Default)]
pub(super) struct InView {
    /// Receivers that some slice can contain.
    pub receivers: Vec<u32>,
    /// Casters that some slice's sweep can meet.
    pub casters: Vec<u32>,
    /// Receivers that a slice cuts.
    across: Vec<u32>,
}

impl InView {
    pub fn cull(&mut self, frame: &Frame<'_>, sun: &Sun<'_>, far: f64, whole_width: f64) {
        let frustum = frame.view.frustum();
        let whole = Slice::new(frame.view, frustum.near, far.min(frustum.far));
        let keep = |list: &mut Vec<u32>, boxes: &[Placed], test: &dyn Fn(&Placed) -> bool| {
            list.clear();
            list.extend(boxes.iter().enumerate().filter(|(_, placed)| test(placed)).map(|(i, _)| i as u32));
        };
        keep(&mut self.receivers, frame.receivers, &|r| whole.classify(r.center, r.half) != Lies::Outside);
        let swept = whole.swept_towards_light(sun.direction);
        // The margin around a split is a few of its texels: at most this share of its width.
        let across = whole.corners[4].distance(whole.corners[7]).max(whole.corners[0].distance(whole.corners[7]));
        let margin = frame.margin_share() * across.max(whole_width);
        keep(&mut self.casters, frame.casters, &|c| swept.meets(c.center, c.half, margin));
    }

    /// The receivers' part of a slice: its bounds in the light's plane and in the world.
    pub fn receivers_in(&mut self, slice: &Slice, frame: &Frame<'_>, sun: &Sun<'_>) -> Served {
        let fan = &sun.fan;
        let mut region = Region::EMPTY;
        let mut bounds = Aabb::EMPTY;
        self.across.clear();
        for &index in &self.receivers {
            let receiver = &frame.receivers[index as usize];
            match slice.classify(receiver.center, receiver.half) {
                Lies::Outside => {}
                Lies::Inside => {
                    region.include_box(fan, receiver.center, receiver.half);
                    bounds = bounds.union(receiver.bounds());
                }
                Lies::Across => self.across.push(index),
            }
        }
        for &index in &self.across {
            let receiver = &frame.receivers[index as usize];
            let own = receiver.bounds();
            let changes_nothing =
                bounds.union(own) == bounds && region.encloses_box(fan, receiver.center, receiver.half);
            if !changes_nothing {
                slice.clip_box(&own, |point| {
                    region.include_point(fan, point);
                    bounds = bounds.including(point);
                });
            }
        }
        (region, bounds)
    }
}
