//! Stage 3 of a sun's plan: what a slice serves, and the casters that can shade it.

use glam::DVec3;

use super::fit::MapSize;
use super::frame::{Frame, Sun};
use super::in_view::InView;
use super::layout::{Layout, SplitFrame};
use super::shaft::{Shaft, first_depth};
use super::slice_ends::SliceEnds;
use crate::config::Crop;
use crate::coverage::{CoverageVolume, can_shade};
use crate::geometry::region::Region;
use crate::geometry::volume::Slice;
use crate::{ShadowPlan, Warp};

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
        Self::new(frame, sun, SliceEnds::new(frame, layout.planes(), index), in_view)
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
        let receivers = match frame.config.crop {
            Crop::SceneIndependent => None,
            Crop::SceneDependent => Some(in_view.receivers_in(&slice, frame, sun)),
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
                target.depth = region.depth;
                (target, self.first(frame, sun, listed))
            }
            Some((region, _)) if !region.is_empty() => (*region, region.depth.0),
            _ => (self.region, self.first(frame, sun, listed)),
        }
    }

    /// Depth along the light of the first caster, metres: of its part over what is shown where the whole would make the depth
    /// range too long to be precise.
    fn first(&self, frame: &Frame<'_>, sun: &Sun<'_>, listed: &[u32]) -> f64 {
        let casters = || listed.iter().map(|&index| &frame.casters[index as usize]);
        let first = casters().map(|c| first_depth(c, sun.direction)).fold(f64::INFINITY, f64::min);
        let (widest, last) = (self.widest() + self.volume.margin, self.depths().1);
        if last - first <= MOST_WIDTHS * widest {
            return first;
        }
        let middle = match &self.volume.receivers {
            Some((_, bounds)) if !bounds.is_empty() => bounds.center(),
            _ => self.volume.slice.corners.iter().sum::<DVec3>() / 8.0,
        };
        // Twice as wide: the middle of a box need not be that of what it bounds.
        let shaft = Shaft::new(middle, 2.0 * widest, sun.light);
        casters().filter_map(|c| shaft.passage(c)).map(|it| it.0).fold(self.depths().0, f64::min)
    }
}

/// A tight map's depth range is that of its whole casters up to so many times the map's width: 32-bit depth then resolves a
/// tenth of a texel.
const MOST_WIDTHS: f64 = 1000.0;
