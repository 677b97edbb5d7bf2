//! What a slice holds: its receivers, the casters that can shade them, and what its map has to show of both.

use super::{Placed, Planner};
use crate::Aabb;
use crate::region::{Fan, Region};
use crate::volume::{Lies, Slice, SweptVolume, lies_below};

impl Planner {
    pub(super) fn empty_list(&self) -> std::ops::Range<usize> {
        let end = self.plan.caster_indices.len();
        end..end
    }

    /// The receivers' part of a slice: its bounds in the light's plane and in the world.
    pub(super) fn receivers_in(&mut self, slice: &Slice, fan: &Fan) -> (Region, Aabb) {
        let mut region = Region::EMPTY;
        let mut bounds = Aabb::EMPTY;
        self.across.clear();
        for &index in &self.visible {
            let receiver = &self.receivers[index as usize];
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
            let receiver = &self.receivers[index as usize];
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

    /// Appends the casters of a slice to the plan's list.
    pub(super) fn list_casters(
        &mut self,
        swept: &SweptVolume,
        served: Option<&(Region, Aabb)>,
        fan: &Fan,
        margin: f64,
    ) -> std::ops::Range<usize> {
        let begin = self.plan.caster_indices.len();
        if served.is_some_and(|(region, _)| region.is_empty()) {
            return begin..begin;
        }
        for &index in &self.candidates {
            if can_shade(&self.casters[index as usize], swept, served, fan, margin) {
                self.plan.caster_indices.push(index);
            }
        }
        begin..self.plan.caster_indices.len()
    }

    /// Takes the casters from the end of the plan's list that come no nearer than a smaller margin. Says whether there were any.
    pub(super) fn keep_casters(
        &mut self,
        listed: &mut std::ops::Range<usize>,
        swept: &SweptVolume,
        served: Option<&(Region, Aabb)>,
        fan: &Fan,
        margin: f64,
    ) -> bool {
        let mut kept = listed.start;
        for at in listed.clone() {
            let index = self.plan.caster_indices[at];
            if can_shade(&self.casters[index as usize], swept, served, fan, margin) {
                self.plan.caster_indices[kept] = index;
                kept += 1;
            }
        }
        self.plan.caster_indices.truncate(kept);
        let fewer = kept < listed.end;
        listed.end = kept;
        fewer
    }

    /// What a map with these casters has to show, in the light's plane and in depth, and the depth of the first caster.
    pub(super) fn target(
        &self,
        listed: std::ops::Range<usize>,
        served: Option<&(Region, Aabb)>,
        slice_region: Region,
        fan: &Fan,
    ) -> (Region, f64) {
        let mut casters =
            self.plan.caster_indices[listed].iter().map(|&index| &self.casters[index as usize]).peekable();
        match served {
            Some((region, _)) if casters.peek().is_some() => {
                let mut target = Region::EMPTY;
                casters.for_each(|caster| target.include_box_within(fan, caster.center, caster.half, region));
                let caster_near = target.depth.0;
                target.depth = region.depth;
                (target, caster_near)
            }
            Some((region, _)) if !region.is_empty() => (*region, region.depth.0),
            _ => {
                let near = |c: &Placed| fan.depth.dot(c.center) - fan.depth.abs().dot(c.half);
                (slice_region, casters.map(near).fold(f64::INFINITY, f64::min))
            }
        }
    }
}

/// Whether a caster may leave a shadow on the receivers of a slice, within `margin` metres beside them.
pub(crate) fn can_shade(
    caster: &Placed,
    swept: &SweptVolume,
    served: Option<&(Region, Aabb)>,
    fan: &Fan,
    margin: f64,
) -> bool {
    let &Placed { center, half } = caster;
    swept.meets(center, half, margin)
        && served.is_none_or(|(region, bounds)| {
            !lies_below(center, half, bounds, fan.depth, margin) && region.can_be_shadowed_by(fan, center, half, margin)
        })
}
