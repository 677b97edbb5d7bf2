//! Stage 3 of a sun's plan: the receivers of a slice, and the casters that can shade them.

use glam::DVec3;

use super::fit::MapSize;
use super::frame::{Frame, Sun};
use super::in_view::InView;
use super::layout::{Layout, SplitFrame};
use super::picked::{Asked, Picked};
use super::shaft::{Shaft, first_depth};
use super::slice_ends::SliceEnds;
use crate::Warp;
use crate::bounds::Placed;
use crate::casters::{Gathered, Group, spread};
use crate::config::Crop;
use crate::coverage::CoverageVolume;
use crate::geometry::region::{Hull, Region, Undecided};
use crate::geometry::volume::{Slice, lies_below, some_lies_below};
use crate::held::recovery::Row;

/// A slice of the view with its receivers.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub ends: SliceEnds,
    /// Bounds of the slice itself across the light.
    pub region: Region,
    /// Volume for which casters are complete, once they are listed.
    pub volume: CoverageVolume,
}

impl Scene {
    /// The scene of one split.
    pub fn of_split(split: &SplitFrame<'_>, in_view: &mut InView) -> Self {
        let (ends, seen_alone) = ends_of_split(split, split.layout.planes(), in_view);
        Self::new(split.frame, split.sun, ends, (in_view, seen_alone))
    }

    /// The scenes of one split by `next` planes, and by these and its own.
    pub fn of_next_and_both(split: &SplitFrame<'_>, next: &Row, in_view: &mut InView) -> [Self; 2] {
        let SplitFrame { frame, sun, layout, .. } = *split;
        let (now, seen_alone_now) = ends_of_split(split, layout.planes(), in_view);
        let (then, seen_alone_then) = ends_of_split(split, &next.planes[..=next.splits], in_view);
        let both = match (now.is_visible, then.is_visible) {
            (false, true) => then,
            (true, true) => SliceEnds { from: now.from.min(then.from), to: now.to.max(then.to), ..now },
            _ => now,
        };
        let next = Self::new(frame, sun, then, (in_view, seen_alone_then));
        [next, Self::new(frame, sun, both, (in_view, seen_alone_now && seen_alone_then))]
    }

    /// The scene of all splits: the volume that any map may be asked about with
    /// [`crate::config::Selection::Map`].
    pub fn of_view(frame: &Frame<'_>, sun: &Sun<'_>, layout: &Layout, in_view: &mut InView) -> Self {
        let frustum = frame.view.frustum();
        let (near, far) = (frustum.near, layout.range.far.min(frustum.far));
        let far = if far > near { far } else { near * 1.01 + 0.01 };
        // Each map has a margin of its own: none is added here.
        Self::new(frame, sun, SliceEnds { from: near, to: far, is_visible: true }, (in_view, false))
    }

    fn new(frame: &Frame<'_>, sun: &Sun<'_>, ends: SliceEnds, (in_view, seen_alone): (&mut InView, bool)) -> Self {
        let slice = Slice::new(frame.view, ends.from, ends.to);
        let swept = slice.swept_towards_light(sun.direction);
        let mut region = Region::EMPTY;
        slice.corners.iter().for_each(|&corner| region.include_point(&sun.fan, corner));
        let receivers = match frame.config.crop {
            Crop::SceneIndependent => None,
            Crop::SceneDependent => Some(in_view.receivers_in(&slice, sun, seen_alone)),
        };
        let volume = CoverageVolume { slice, swept, receivers, margin: 0.0, is_void: !ends.is_visible };
        Self { ends, region, volume }
    }

    /// The widest extent of the shown region across the light, in metres.
    pub fn widest(&self) -> f64 {
        self.volume.receivers.as_ref().map_or(&self.region, |(region, _)| region).widest().max(0.0)
    }

    /// Range of depths of the shown region along the light, in metres.
    pub fn depths(&self) -> (f64, f64) {
        self.volume.receivers.as_ref().map_or(&self.region, |(region, _)| region).depth
    }
}

/// Depths that a split serves between `planes`, and whether that is what was seen alone.
fn ends_of_split(split: &SplitFrame<'_>, planes: &[f64], in_view: &InView) -> (SliceEnds, bool) {
    let SplitFrame { frame, index, .. } = *split;
    let ends_of = |i: usize| SliceEnds::new(frame, planes, i);
    let mut ends = ends_of(index);
    let is_last = (index + 1..frame.config.splits()).all(|i| !ends_of(i).is_visible);
    if in_view.is_seen && is_last && ends.is_visible {
        // It serves whatever the maps before it do not: they show what was seen alone.
        ends.from = ends.from.min(ends_of(0).from);
    }
    (ends, in_view.is_seen && !is_last)
}

/// The region that a map with a slice's casters has to show.
#[derive(Clone, Debug)]
pub(super) struct Listed {
    /// Bounds across the light and in depth.
    pub target: Region,
    /// Depth along the light of the first caster, in metres.
    pub first: f64,
}

impl Listed {
    /// Lists the casters of a split.
    pub fn new(
        split: &SplitFrame<'_>,
        size: &MapSize,
        scene: &mut Scene,
        casters: &Gathered,
        listed: &mut Picked,
    ) -> Self {
        let sun = split.sun;
        scene.volume.margin = size.margin(split, scene.widest());
        let is_shown = scene.volume.receivers.is_none_or(|(region, _)| !region.is_empty());
        listed.clear();
        if scene.ends.is_visible && is_shown {
            listed.pick(casters, |group, hull| scene.ask(sun, (group, hull)));
        }
        let (mut target, mut first) = scene.target(sun, casters, listed);
        // Casters leave a map with smaller texels than its receivers alone, and with those its
        // filter reaches less far.
        if scene.volume.receivers.is_some() && !listed.is_empty() && split.warp() == Warp::None {
            let before = (scene.volume.margin, listed.len());
            scene.volume.margin = size.margin(split, target.widest());
            if scene.volume.margin < before.0 {
                listed.narrow(casters, |group, hull| scene.ask(sun, (group, hull)));
            }
            if listed.len() < before.1 {
                (target, first) = scene.target(sun, casters, listed);
            }
        }
        Self { target, first }
    }
}

impl Scene {
    /// The test of [`CoverageVolume::is_shaded_by`] for the casters of a group, of which only that
    /// is tested that does not hold for all of them; `None` if no caster passes.
    fn ask<'a>(
        &'a self,
        sun: &'a Sun<'a>,
        (group, hull): (&Group, Option<&Hull>),
    ) -> Option<Asked<impl Fn(&Placed) -> bool + use<'a>>> {
        let CoverageVolume { swept, receivers, margin, .. } = &self.volume;
        let (fan, margin) = (&sun.fan, *margin);
        let planes = swept.undecided_in(&group.bounds, margin)?;
        let (mut shadowed, mut may_be_below) = (Undecided::default(), false);
        if let Some((region, bounds)) = receivers {
            shadowed = match hull {
                Some(hull) => region.undecided_in(hull, margin)?,
                None => Undecided::ALL,
            };
            may_be_below = some_lies_below(&group.core, bounds, fan.depth);
        }
        if planes == 0 && shadowed.is_nothing() && !may_be_below {
            return Some(Asked::All);
        }
        Some(Asked::Each(move |caster: &Placed| {
            swept.meets_some(planes, caster, margin)
                && receivers.as_ref().is_none_or(|(region, bounds)| {
                    !(may_be_below && lies_below(caster.center, caster.half, bounds, fan.depth, margin))
                        && region.can_be_shadowed_along(fan, caster, margin, shadowed)
                })
        }))
    }

    /// The region that a map with these casters has to show, in the light's plane and in depth, and
    /// the depth of the first caster.
    fn target(&self, sun: &Sun<'_>, casters: &Gathered, listed: &Picked) -> (Region, f64) {
        match &self.volume.receivers {
            Some((region, _)) if !listed.is_empty() => {
                let mut target = Region::EMPTY;
                for part in spread(&listed.parts) {
                    let hull = listed.hull(casters, part);
                    let widened = hull.map_or(u32::MAX, |hull| target.widened_within(hull, region));
                    target.include_boxes_within(&sun.fan, listed.boxes(casters, part), widened, region);
                }
                target.depth = region.depth;
                (target, self.first(sun, casters, listed))
            }
            Some((region, _)) if !region.is_empty() => (*region, region.depth.0),
            _ => (self.region, self.first(sun, casters, listed)),
        }
    }

    /// Depth along the light of the first caster, in metres. If the whole caster would make the
    /// depth range too long to be precise, only its part over the shown region counts.
    fn first(&self, sun: &Sun<'_>, casters: &Gathered, listed: &Picked) -> f64 {
        let first = -listed.most(casters, |c| -first_depth(c, sun.direction));
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
        let begin = |c: &Placed| shaft.passage(c).map_or(f64::INFINITY, |it| it.0);
        (-listed.most(casters, |c| -begin(c))).min(self.depths().0)
    }
}

/// Most widths of a map to which a tight map's depth range may extend for whole casters: 32-bit
/// depth then resolves a tenth of a texel.
const MOST_WIDTHS: f64 = 1000.0;
