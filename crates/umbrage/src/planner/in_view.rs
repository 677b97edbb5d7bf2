//! Boxes that the whole view may show, from which all slices choose theirs.

use super::frame::{Frame, Sun};
use crate::bounds::Placed;
use crate::casters::{Gathered, Near, spread};
use crate::config::Crop;
use crate::coverage::Served;
use crate::geometry::limits::Limits;
use crate::geometry::region::{Hull, Region, Undecided};
use crate::geometry::volume::{Lies, Slice};
use crate::held::ends::Range;
use crate::{Aabb, View};

/// Boxes that the whole view may show.
#[derive(Clone, Debug, Default)]
pub(super) struct InView {
    /// Receivers that some slice can contain.
    pub receivers: Gathered,
    /// Casters that some slice's sweep can meet.
    pub casters: Gathered,
    /// The part of them that an earlier image showed.
    seen: Gathered,
    /// True if `seen` gives the positions of receivers: it is known and not empty.
    pub is_seen: bool,
    /// Receivers that a slice cuts.
    across: Vec<u32>,
}

impl InView {
    pub fn cull(&mut self, frame: &Frame<'_>, sun: &Sun<'_>, far: f64, whole_width: f64) {
        let frustum = frame.view.frustum();
        let whole = Slice::new(frame.view, frustum.near, far.min(frustum.far));
        frame.receivers.near(&Near { planes: &whole.planes, margin: 0.0 }, &mut self.receivers);
        if let Some(seen) = &frame.seen {
            seen.near(&Near { planes: &whole.planes, margin: 0.0 }, &mut self.seen);
        }
        self.is_seen = frame.seen.is_some() && self.seen.len() > 0;
        let swept = whole.swept_towards_light(sun.direction);
        // The margin around a split is a few of its texels: at most this share of its width.
        let across = whole.corners[4].distance(whole.corners[7]).max(whole.corners[0].distance(whole.corners[7]));
        let margin = frame.margin_share() * across.max(whole_width);
        frame.casters.near(&Near { planes: swept.planes(), margin }, &mut self.casters);
        if frame.config.crop == Crop::SceneDependent {
            self.casters.measure(&sun.fan);
        }
    }

    /// The receivers for which planes are placed.
    pub fn sought(&self) -> &Gathered {
        if self.is_seen { &self.seen } else { &self.receivers }
    }

    /// The region that all receivers in range and the casters over them take up across the light;
    /// `None` if there are none.
    pub fn shadowed(&mut self, view: &View, sun: &Sun<'_>, range: Range) -> Option<Region> {
        let frustum = view.frustum();
        let slice = Slice::new(view, frustum.near, range.far.min(frustum.far).max(1.01 * frustum.near + 0.01));
        let (receivers, _) = self.receivers_in(&slice, sun, false);
        let mut casters = Region::EMPTY;
        for group in spread(&self.casters.groups) {
            let widened = casters.widened_by(&Hull::new(&sun.fan, &group.bounds));
            casters.include_boxes(&sun.fan, self.casters.boxes[group.range()].iter(), widened);
        }
        (!receivers.is_empty() && !casters.is_empty()).then(|| casters.within(&receivers))
    }

    /// The part of a slice that its receivers, or the seen ones among them, take up: its bounds in
    /// the light's plane and in the world.
    ///
    /// Receivers inside the bounds of others are skipped: the bounds do not depend on the order of
    /// receivers.
    pub fn receivers_in(&mut self, slice: &Slice, sun: &Sun<'_>, seen_alone: bool) -> Served {
        let Self { receivers, seen, across, .. } = self;
        let receivers = if seen_alone { seen } else { receivers };
        let fan = &sun.fan;
        let mut region = Region::EMPTY;
        let mut bounds = Aabb::EMPTY;
        // Few boxes make most of the bounds: those that are large, a ground above all.
        let large = LARGE * slice.corners[0].distance(slice.corners[7]);
        let of_large = |part: &Placed| part.half.max_element() > large;
        let limits = Limits::new(slice, fan);
        // Asked for each group and box anew, as bounds that have grown hold more.
        let widened = |region: &Region, bounds: &Aabb, own: &Aabb, placed: &Placed, lies: Lies| {
            let widened = region.widened_by(&Hull::new(fan, placed));
            let is_held = widened.is_nothing() && bounds.union(*own) == *bounds;
            match lies {
                _ if is_held => None,
                Lies::Across => limits.widened(fan, (placed, own), (region, bounds), widened),
                Lies::Inside | Lies::Outside => Some(widened),
            }
        };
        let include = |region: &mut Region, bounds: &mut Aabb, receiver: &Placed, widened: Undecided| {
            let own = receiver.bounds();
            slice.clip_box(&own, |point| {
                region.include_point_in(fan, point, widened);
                // Rounding leads no part out of its box.
                *bounds = bounds.including(point.clamp(own.min, own.max));
            });
        };
        for group in receivers.groups.iter().filter(|group| of_large(&group.bounds)) {
            for receiver in receivers.boxes[group.range()].iter().filter(|it| of_large(it)) {
                match slice.classify(receiver.center, receiver.half) {
                    Lies::Across => include(&mut region, &mut bounds, receiver, Undecided::ALL),
                    // One inside is taken below.
                    Lies::Inside | Lies::Outside => {}
                }
            }
        }
        across.clear();
        for block in spread(&receivers.blocks) {
            let around = slice.classify(block.bounds.center, block.bounds.half);
            if around == Lies::Outside || widened(&region, &bounds, &block.exact, &block.bounds, around).is_none() {
                continue;
            }
            for group in &receivers.groups[block.range()] {
                let lies = match around {
                    Lies::Inside => around,
                    _ => slice.classify(group.bounds.center, group.bounds.half),
                };
                if lies == Lies::Outside {
                    continue;
                }
                let Some(widened) = widened(&region, &bounds, &group.exact, &group.bounds, lies) else { continue };
                let boxes = &receivers.boxes[group.range()];
                if lies == Lies::Inside {
                    region.include_boxes(fan, boxes.iter(), widened);
                    bounds = bounds.union(group.exact);
                    continue;
                }
                for (receiver, at) in boxes.iter().zip(group.begin..) {
                    match slice.classify(receiver.center, receiver.half) {
                        Lies::Outside => {}
                        Lies::Inside => {
                            region.include_boxes(fan, std::iter::once(receiver), widened);
                            bounds = bounds.union(receiver.bounds());
                        }
                        Lies::Across => across.push(at),
                    }
                }
            }
        }
        for receiver in across.iter().map(|&at| &receivers.boxes[at as usize]).filter(|it| !of_large(it)) {
            if let Some(widened) = widened(&region, &bounds, &receiver.bounds(), receiver, Lies::Across) {
                include(&mut region, &mut bounds, receiver, widened);
            }
        }
        (region, bounds)
    }
}

/// Least half extent of a large receiver, as a share of the slice's length.
const LARGE: f64 = 0.25;
