//! Boxes that the whole view may show, from which all slices choose theirs.

use super::frame::{Frame, Sun};
use crate::bounds::Placed;
use crate::casters::{Gathered, Near, spread};
use crate::config::Crop;
use crate::coverage::Served;
use crate::geometry::limits::Limits;
use crate::geometry::region::{Fan, Hull, Region, Undecided};
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
        let mut part = PartInSlice::new(slice, &sun.fan);
        part.include_large(receivers);
        part.include_inside(receivers, across);
        for receiver in across.iter().map(|&at| &receivers.boxes[at as usize]) {
            if part.is_large(receiver) {
                continue;
            }
            if let Some(widened) = part.widened(&receiver.bounds(), receiver, Lies::Across) {
                part.include_clipped(receiver, widened);
            }
        }
        (part.region, part.bounds)
    }
}

/// The part of a slice that receivers take up, box by box.
struct PartInSlice<'a> {
    slice: &'a Slice,
    fan: &'a Fan,
    limits: Limits,
    /// Least half extent of a large receiver in metres.
    large: f64,
    region: Region,
    bounds: Aabb,
}

impl<'a> PartInSlice<'a> {
    fn new(slice: &'a Slice, fan: &'a Fan) -> Self {
        let large = LARGE * slice.corners[0].distance(slice.corners[7]);
        Self { slice, fan, limits: Limits::new(slice, fan), large, region: Region::EMPTY, bounds: Aabb::EMPTY }
    }

    fn is_large(&self, part: &Placed) -> bool {
        part.half.max_element() > self.large
    }

    /// Bounds that a group or a box widens; `None` if it widens none. They are asked for anew each
    /// time, as bounds that have grown hold more.
    fn widened(&self, own: &Aabb, placed: &Placed, lies: Lies) -> Option<Undecided> {
        let widened = self.region.widened_by(&Hull::new(self.fan, placed));
        let is_held = widened.is_nothing() && self.bounds.union(*own) == self.bounds;
        match lies {
            _ if is_held => None,
            Lies::Across => self.limits.widened(self.fan, (placed, own), (&self.region, &self.bounds), widened),
            Lies::Inside | Lies::Outside => Some(widened),
        }
    }

    /// Includes the part of a receiver inside the slice.
    fn include_clipped(&mut self, receiver: &Placed, widened: Undecided) {
        let Self { slice, fan, region, bounds, .. } = self;
        let own = receiver.bounds();
        slice.clip_box(&own, |point| {
            region.include_point_in(fan, point, widened);
            // Rounding leads no part out of its box.
            *bounds = bounds.including(point.clamp(own.min, own.max));
        });
    }

    /// Includes large receivers across the slice. Few boxes make most of the bounds: a ground above
    /// all.
    fn include_large(&mut self, receivers: &Gathered) {
        for group in &receivers.groups {
            if !self.is_large(&group.bounds) {
                continue;
            }
            for receiver in &receivers.boxes[group.range()] {
                if self.is_large(receiver) && self.slice.classify(receiver.center, receiver.half) == Lies::Across {
                    self.include_clipped(receiver, Undecided::ALL);
                }
            }
        }
    }

    /// Includes receivers inside the slice, and lists those across it.
    fn include_inside(&mut self, receivers: &Gathered, across: &mut Vec<u32>) {
        across.clear();
        for block in spread(&receivers.blocks) {
            let around = self.slice.classify(block.bounds.center, block.bounds.half);
            if around == Lies::Outside || self.widened(&block.exact, &block.bounds, around).is_none() {
                continue;
            }
            for group in &receivers.groups[block.range()] {
                let lies = match around {
                    Lies::Inside => around,
                    _ => self.slice.classify(group.bounds.center, group.bounds.half),
                };
                if lies == Lies::Outside {
                    continue;
                }
                let Some(widened) = self.widened(&group.exact, &group.bounds, lies) else { continue };
                let boxes = &receivers.boxes[group.range()];
                if lies == Lies::Inside {
                    self.region.include_boxes(self.fan, boxes.iter(), widened);
                    self.bounds = self.bounds.union(group.exact);
                    continue;
                }
                for (receiver, at) in boxes.iter().zip(group.begin..) {
                    match self.slice.classify(receiver.center, receiver.half) {
                        Lies::Outside => {}
                        Lies::Inside => {
                            self.region.include_boxes(self.fan, std::iter::once(receiver), widened);
                            self.bounds = self.bounds.union(receiver.bounds());
                        }
                        Lies::Across => across.push(at),
                    }
                }
            }
        }
    }
}

/// Least half extent of a large receiver, as a share of the slice's length.
const LARGE: f64 = 0.25;
