//! Stage 3 of a sun's plan: what a slice serves, and the casters that can shade it.

use glam::DVec3;

use super::fit::{MapSize, SliceEnds};
use super::frame::{Frame, Sun};
use super::layout::{Layout, SplitFrame};
use crate::bounds::Placed;
use crate::coverage::{CoverageVolume, Served, can_shade};
use crate::geometry::region::Region;
use crate::geometry::volume::{Lies, Slice};
use crate::{Aabb, Fit, ShadowPlan, Warp};

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
    fn receivers_in(&mut self, slice: &Slice, frame: &Frame<'_>, sun: &Sun<'_>) -> Served {
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

/// A slice of the view and what it shows.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub ends: SliceEnds,
    /// The slice's own bounds across the light.
    pub region: Region,
    /// Where casters are complete for, once they are listed.
    pub volume: CoverageVolume,
}

impl Scene {
    /// Of one split.
    pub fn of_split(split: &SplitFrame<'_>, in_view: &mut InView) -> Self {
        let SplitFrame { frame, sun, layout, index } = *split;
        Self::new(frame, sun, SliceEnds::new(frame, layout, layout.planes(), index), in_view)
    }

    /// Of all splits: what any map may be asked about where maps are chosen by what they contain.
    pub fn of_view(frame: &Frame<'_>, sun: &Sun<'_>, layout: &Layout, in_view: &mut InView) -> Self {
        let frustum = frame.view.frustum();
        let (near, far) = (frustum.near, layout.range.far.min(frustum.far));
        let far = if far > near { far } else { near * 1.01 + 0.01 };
        // Each map has a margin of its own: none is added here.
        Self::new(frame, sun, SliceEnds { from: near, to: far, is_visible: true }, in_view)
    }

    fn new(frame: &Frame<'_>, sun: &Sun<'_>, ends: SliceEnds, in_view: &mut InView) -> Self {
        let slice = Slice::new(frame.view, ends.from, ends.to);
        let swept = slice.swept_towards_light(sun.direction);
        let mut region = Region::EMPTY;
        slice.corners.iter().for_each(|&corner| region.include_point(&sun.fan, corner));
        let receivers = match frame.settings.fit {
            Fit::Independent => None,
            Fit::Dependent => Some(in_view.receivers_in(&slice, frame, sun)),
        };
        let volume = CoverageVolume { slice, swept, receivers, margin: 0.0, is_void: !ends.is_visible };
        Self { ends, region, volume }
    }

    /// The widest extent of what is shown across the light, metres.
    pub fn widest(&self) -> f64 {
        self.volume.receivers.as_ref().map_or(&self.region, |(region, _)| region).widest().max(0.0)
    }

    /// Depths along the light of what is shown, metres.
    pub fn depths(&self) -> (f64, f64) {
        self.volume.receivers.as_ref().map_or(&self.region, |(region, _)| region).depth
    }
}

/// The casters of a slice and what its map has to show with them.
#[derive(Clone, Debug)]
pub(super) struct Listed {
    /// Their place in [`ShadowPlan::caster_indices`].
    pub casters: std::ops::Range<usize>,
    /// Bounds across the light and in depth.
    pub target: Region,
    /// Depth of the first caster along the light.
    pub first: f64,
}

impl Listed {
    /// Appends the casters of a split to the plan's list.
    pub fn new(
        split: &SplitFrame<'_>,
        size: &MapSize,
        scene: &mut Scene,
        in_view: &InView,
        plan: &mut ShadowPlan,
    ) -> Self {
        let SplitFrame { frame, sun, .. } = *split;
        let begin = plan.caster_indices.len();
        scene.volume.margin = size.margin(split, scene.widest());
        let is_shown = scene.volume.receivers.is_none_or(|(region, _)| !region.is_empty());
        if scene.ends.is_visible && is_shown {
            let shades = |&&index: &&u32| scene.is_shaded_by(frame, sun, index);
            plan.caster_indices.extend(in_view.casters.iter().filter(shades));
        }
        let (target, first) = scene.target(frame, sun, &plan.caster_indices[begin..]);
        let mut listed = Self { casters: begin..plan.caster_indices.len(), target, first };
        // Casters leave a map with smaller texels than its receivers alone, and with those its filter reaches less far.
        if scene.volume.receivers.is_some() && !listed.casters.is_empty() && split.warp() == Warp::None {
            scene.volume.margin = size.margin(split, target.widest());
            if listed.thin(frame, sun, scene, plan) {
                (listed.target, listed.first) = scene.target(frame, sun, &plan.caster_indices[begin..]);
            }
        }
        listed
    }

    /// Takes away the casters, at the end of the plan's list, that come no nearer than the scene's margin. Says whether there
    /// were any.
    fn thin(&mut self, frame: &Frame<'_>, sun: &Sun<'_>, scene: &Scene, plan: &mut ShadowPlan) -> bool {
        let mut kept = self.casters.start;
        for at in self.casters.clone() {
            let index = plan.caster_indices[at];
            if scene.is_shaded_by(frame, sun, index) {
                plan.caster_indices[kept] = index;
                kept += 1;
            }
        }
        plan.caster_indices.truncate(kept);
        let fewer = kept < self.casters.end;
        self.casters.end = kept;
        fewer
    }
}

impl Scene {
    fn is_shaded_by(&self, frame: &Frame<'_>, sun: &Sun<'_>, caster: u32) -> bool {
        let CoverageVolume { swept, receivers, margin, .. } = &self.volume;
        can_shade(&frame.casters[caster as usize], swept, receivers.as_ref(), &sun.fan, *margin)
    }

    /// What a map with these casters has to show, in the light's plane and in depth, and the depth of the first caster.
    fn target(&self, frame: &Frame<'_>, sun: &Sun<'_>, listed: &[u32]) -> (Region, f64) {
        let fan = &sun.fan;
        let casters = listed.iter().map(|&index| &frame.casters[index as usize]);
        match &self.volume.receivers {
            Some((region, _)) if !listed.is_empty() => {
                let mut target = Region::EMPTY;
                casters.for_each(|caster| target.include_box_within(fan, caster.center, caster.half, region));
                let first = target.depth.0;
                target.depth = region.depth;
                (target, first)
            }
            Some((region, _)) if !region.is_empty() => (*region, region.depth.0),
            _ => (self.region, casters.map(|c| first_depth(c, fan.depth)).fold(f64::INFINITY, f64::min)),
        }
    }
}

/// Where a box begins along the light, metres.
pub(super) fn first_depth(placed: &Placed, direction: DVec3) -> f64 {
    direction.dot(placed.center) - direction.abs().dot(placed.half)
}
