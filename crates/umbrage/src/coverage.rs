//! Coverage of a plan's caster lists: the points that a map serves with all their casters, and the
//! parts of casters that shade these points.

use glam::DVec3;

use crate::Aabb;
use crate::bounds::Placed;
use crate::geometry::light_frustum::{LightFrustum, Part};
use crate::geometry::receiver_mask::ReceiverMask;
use crate::geometry::region::{Fan, Region};
use crate::geometry::volume::{Slice, SweptVolume, lies_below};

/// The receivers of a slice: their bounds in the light's plane and in the world.
pub(crate) type Served = (Region, Aabb);

/// The points for whose shadows a sun's map has all casters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoverageVolume {
    pub slice: Slice,
    /// The slice pushed towards the light.
    pub swept: SweptVolume,
    /// Receivers inside the slice, for a scene-dependent fit.
    pub receivers: Option<Served>,
    /// Margin around the volume in metres, within which filters read.
    pub margin: f64,
    /// True if the view shows nothing of the slice: no caster was looked for.
    pub is_void: bool,
}

impl CoverageVolume {
    /// Returns whether a box may cast a shadow into the volume or its margin (conservative).
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

/// Returns whether a caster may cast a shadow on the receivers of a slice or within `margin` metres
/// beside them (conservative).
pub(crate) fn can_shade(caster: &Placed, swept: &SweptVolume, served: Option<&Served>, fan: &Fan, margin: f64) -> bool {
    let &Placed { center, half } = caster;
    swept.meets(center, half, margin)
        && served.is_none_or(|(region, bounds)| {
            !lies_below(center, half, bounds, fan.depth, margin) && region.can_be_shadowed_by(fan, center, half, margin)
        })
}

/// The points for whose shadows a local light's map has all casters.
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

/// Points for which the caster lists of a [`crate::ShadowPlan`] are complete, split by split. Made
/// by the planner, and used by [`crate::ShadowPlan::casts_into`] and
/// [`crate::ShadowPlan::covering_split`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanCoverage {
    /// Directions of a sun's plan.
    pub(crate) fan: Option<Fan>,
    pub(crate) volumes: Vec<CoverageVolume>,
    /// With [`crate::config::Selection::Map`], the volume that every map may be asked about.
    pub(crate) shown: Option<CoverageVolume>,
    /// Positions of each split's receiver clusters; meaningful if `has_masks`.
    pub(crate) masks: Vec<ReceiverMask>,
    pub(crate) has_masks: bool,
    /// Volumes of a local light's plan.
    pub(crate) local: Vec<LocalVolume>,
    /// Bit `i` is set if the next split also serves the points of split `i`.
    pub(crate) handed_on: u8,
}

impl PlanCoverage {
    /// Clears it for a frame; buffers are kept.
    pub(crate) fn clear(&mut self) {
        self.fan = None;
        self.volumes.clear();
        self.shown = None;
        self.has_masks = false;
        self.local.clear();
        self.handed_on = 0;
    }

    /// Lets the next split also serve the points of `split`.
    pub(crate) fn hand_on(&mut self, split: usize) {
        self.handed_on |= 1 << split;
    }

    /// Returns whether the next split also serves the points of `split`.
    pub(crate) fn is_handed_on(&self, split: usize) -> bool {
        split < u8::BITS as usize && self.handed_on >> split & 1 == 1
    }

    /// The splits whose points `split` serves: none, itself, or itself and some before it.
    fn served_by(&self, split: usize) -> std::ops::Range<usize> {
        if self.is_handed_on(split) {
            return 0..0;
        }
        let first = (0..split).rev().take_while(|&before| self.is_handed_on(before)).last();
        first.unwrap_or(split)..split + 1
    }

    /// Copies everything but the masks. Buffers are kept.
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

    /// Implements [`crate::ShadowPlan::casts_into`].
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

    /// Returns whether a sun's split has all casters of a point.
    pub(crate) fn contains(&self, split: usize, point: DVec3) -> bool {
        self.served_by(split).any(|split| {
            let volume = self.shown.as_ref().or(self.volumes.get(split));
            self.fan.as_ref().zip(volume).is_some_and(|(fan, volume)| volume.contains(fan, point))
        })
    }

    /// Returns whether a local light's split has all casters of a point.
    pub(crate) fn contains_local(&self, split: usize, point: DVec3) -> bool {
        self.local.get(split).is_some_and(|volume| volume.contains(point))
    }
}
