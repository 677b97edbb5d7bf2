//! What a plan's lists are complete for: the points that a map may be asked about, and the parts
//! that shade them.

use glam::DVec3;

use crate::Aabb;
use crate::bounds::Placed;
use crate::geometry::light_frustum::{LightFrustum, Part};
use crate::geometry::receiver_mask::ReceiverMask;
use crate::geometry::region::{Fan, Region};
use crate::geometry::volume::{Slice, SweptVolume, lies_below};

/// The receivers of a slice: their bounds in the light's plane and in the world.
pub(crate) type Served = (Region, Aabb);

/// The points whose shadows a sun's map has all casters for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoverageVolume {
    pub slice: Slice,
    /// The slice pushed towards the light.
    pub swept: SweptVolume,
    /// Scene-dependent fit: the receivers inside the slice.
    pub receivers: Option<Served>,
    /// Metres around it that filters ask about.
    pub margin: f64,
    /// The slice is none that the view shows: no caster was looked for.
    pub is_void: bool,
}

impl CoverageVolume {
    /// Whether a box can cast a shadow into the volume or its margin (conservatively).
    pub fn is_shaded_by(&self, fan: &Fan, center: DVec3, half: DVec3) -> bool {
        can_shade(&Placed { center, half }, &self.swept, self.receivers.as_ref(), fan, self.margin)
    }

    fn contains(&self, fan: &Fan, point: DVec3) -> bool {
        !self.is_void
            && self.swept.contains(point)
            && self.receivers.is_none_or(|(region, bounds)| {
                region.contains(fan, point)
                    && (0..3).all(|axis| match fan.depth[axis] {
                        along if along < 0.0 => point[axis] >= bounds.min[axis],
                        along if along > 0.0 => point[axis] <= bounds.max[axis],
                        _ => true,
                    })
            })
    }
}

/// Whether a caster may leave a shadow on the receivers of a slice, within `margin` metres beside
/// them.
pub(crate) fn can_shade(caster: &Placed, swept: &SweptVolume, served: Option<&Served>, fan: &Fan, margin: f64) -> bool {
    let &Placed { center, half } = caster;
    swept.meets(center, half, margin)
        && served.is_none_or(|(region, bounds)| {
            !lies_below(center, half, bounds, fan.depth, margin) && region.can_be_shadowed_by(fan, center, half, margin)
        })
}

/// The points whose shadows a local light's map has all casters for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LocalVolume {
    pub swept: SweptVolume,
    pub frustum: LightFrustum,
    pub part: Part,
}

impl LocalVolume {
    fn contains(&self, point: DVec3) -> bool {
        let Self { swept, frustum, part } = self;
        let hull = part.bounds.including(frustum.position);
        !part.is_empty()
            && swept.contains(point)
            && frustum.depth(point) <= part.far
            && part.sides(frustum).iter().all(|side| side.distance(point) <= 0.0)
            && hull.including(point) == hull
    }
}

/// What the lists of a [`crate::ShadowPlan`] are complete for, split by split. Made by the planner;
/// [`crate::ShadowPlan::casts_into`] and [`crate::ShadowPlan::covering_split`] ask it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanCoverage {
    /// Of a sun's plan.
    pub(crate) fan: Option<Fan>,
    pub(crate) volumes: Vec<CoverageVolume>,
    /// Where maps are chosen by what they contain: any map may be asked about all of this.
    pub(crate) shown: Option<CoverageVolume>,
    /// Where the clusters of each split's receivers lie; meaningful if `has_masks`.
    pub(crate) masks: Vec<ReceiverMask>,
    pub(crate) has_masks: bool,
    /// Of a local light's plan.
    pub(crate) local: Vec<LocalVolume>,
    /// Bit `i`: the next split answers for split `i`, too.
    pub(crate) handed_on: u8,
}

impl PlanCoverage {
    /// Empties it for a frame; buffers are kept.
    pub(crate) fn clear(&mut self) {
        self.fan = None;
        self.volumes.clear();
        self.shown = None;
        self.has_masks = false;
        self.local.clear();
        self.handed_on = 0;
    }

    /// Lets the next split answer for `split`, too.
    pub(crate) fn hand_on(&mut self, split: usize) {
        self.handed_on |= 1 << split;
    }

    /// Whether the next split answers for `split`, too.
    pub(crate) fn is_handed_on(&self, split: usize) -> bool {
        split < u8::BITS as usize && self.handed_on >> split & 1 == 1
    }

    /// The splits that `split` answers for: none, itself, or some before it and itself.
    fn served_by(&self, split: usize) -> std::ops::Range<usize> {
        if self.is_handed_on(split) {
            return 0..0;
        }
        let first = (0..split).rev().take_while(|&before| self.is_handed_on(before)).last();
        first.unwrap_or(split)..split + 1
    }

    /// Takes over what has no masks. Buffers are kept.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.clear();
        (self.fan, self.shown) = (other.fan, other.shown.clone());
        self.volumes.clone_from(&other.volumes);
        self.local.clone_from(&other.local);
    }

    /// Fills the masks from the boxes that receivers consist of.
    pub(crate) fn mask(&mut self, clusters: &[Aabb]) {
        let (Some(fan), None) = (&self.fan, &self.shown) else { return };
        self.masks.resize_with(self.volumes.len(), ReceiverMask::default);
        for (mask, volume) in self.masks.iter_mut().zip(&self.volumes) {
            if let Some((_, bounds)) = &volume.receivers {
                mask.fill(&volume.slice, bounds, clusters, fan.depth, volume.margin);
            }
        }
        self.has_masks = true;
    }

    /// As [`crate::ShadowPlan::casts_into`].
    pub(crate) fn casts_into(&self, split: usize, part: &Aabb) -> bool {
        self.served_by(split).any(|split| self.casts_into_slice(split, part))
    }

    fn casts_into_slice(&self, split: usize, part: &Aabb) -> bool {
        let (center, half) = (part.center(), part.half_extent());
        match (&self.fan, &self.shown, self.volumes.get(split)) {
            (Some(fan), None, Some(volume)) => {
                let masked = self.has_masks && volume.receivers.is_some();
                volume.is_shaded_by(fan, center, half) && (!masked || self.masks[split].lies_before_some(center, half))
            }
            _ => true,
        }
    }

    /// Whether a sun's split has all casters of a point.
    pub(crate) fn contains(&self, split: usize, point: DVec3) -> bool {
        self.served_by(split).any(|split| {
            let volume = self.shown.as_ref().or(self.volumes.get(split));
            self.fan.as_ref().zip(volume).is_some_and(|(fan, volume)| volume.contains(fan, point))
        })
    }

    /// Whether a local light's split has all casters of a point.
    pub(crate) fn contains_local(&self, split: usize, point: DVec3) -> bool {
        self.local.get(split).is_some_and(|volume| volume.contains(point))
    }
}
