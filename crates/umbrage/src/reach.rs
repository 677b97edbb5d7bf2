//! What can throw a shadow on the points that a split serves.

use glam::DVec3;

use crate::planner::Placed;
use crate::planner::lists::can_shade;
use crate::receiver_mask::ReceiverMask;
use crate::region::{Fan, Region};
use crate::volume::{Slice, SweptVolume};
use crate::{Aabb, Error, Planner, Result};

/// The points whose shadows a split's caster list is complete for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CoverageVolume {
    pub slice: Slice,
    /// The slice pushed towards the light.
    pub swept: SweptVolume,
    /// Scene-dependent fit: the receivers inside the slice, in the light's plane and as a world box.
    pub receivers: Option<(Region, Aabb)>,
    /// Metres around it that filters ask about.
    pub margin: f64,
}

impl CoverageVolume {
    /// Whether a box can throw a shadow into the volume or its margin (conservatively).
    pub fn is_shaded_by(&self, fan: &Fan, center: DVec3, half: DVec3) -> bool {
        can_shade(&Placed { center, half }, &self.swept, self.receivers.as_ref(), fan, self.margin)
    }

    fn contains(&self, fan: &Fan, point: DVec3) -> bool {
        self.swept.contains(point)
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

impl Planner {
    /// Tells what the receivers of the last plan are made of: boxes in the world that hold all that is drawn of them, which leave less
    /// air than the receivers' own. [`Planner::reaches`] then also leaves out parts of casters that have none of these boxes behind
    /// them. For [`crate::Fit::Dependent`]; forgotten with the next plan.
    ///
    /// # Errors
    /// [`crate::Error::InvalidBounds`] naming a box that is inverted or not finite; nothing is told then.
    pub fn tell_parts(&mut self, parts: &[Aabb]) -> Result<()> {
        if let Some((index, bounds)) = parts.iter().enumerate().find(|(_, bounds)| !bounds.is_valid()) {
            return Err(Error::InvalidBounds { list: "parts", index, min: bounds.min, max: bounds.max });
        }
        let (Some(fan), None) = (&self.fan, &self.shown) else { return Ok(()) };
        self.masks.resize_with(self.volumes.len(), ReceiverMask::default);
        for (mask, volume) in self.masks.iter_mut().zip(&self.volumes) {
            if let Some((_, bounds)) = &volume.receivers {
                mask.fill(&volume.slice, bounds, parts, fan.depth, volume.margin);
            }
        }
        self.knows_parts = true;
        Ok(())
    }

    /// Whether a part of a caster that the last plan lists for `split` can throw a shadow on anything that the split serves: the test
    /// that casters were listed by, for the part's own world box. An app that keeps its large meshes in clusters leaves those out of a
    /// map that it answers `false` for; what the split's points look up stays the same. After [`Planner::tell_parts`] only the points of
    /// surfaces count, not those of the air between them.
    ///
    /// Conservative, and `true` for every part where lists are made otherwise: for local lights and with [`crate::Selection::Map`].
    #[must_use]
    pub fn reaches(&self, split: usize, part: &Aabb) -> bool {
        let (center, half) = (part.center(), part.half_extent());
        match (&self.fan, &self.shown, self.volumes.get(split)) {
            (Some(fan), None, Some(volume)) => {
                let masked = self.knows_parts && volume.receivers.is_some();
                volume.is_shaded_by(fan, center, half) && (!masked || self.masks[split].lies_before_some(center, half))
            }
            _ => true,
        }
    }

    /// The first split whose map holds every caster that can shade `point`, for points that the view does not show (points
    /// that it shows use the split of their view depth). `None`: no map answers for it. Refers to the last plan.
    #[must_use]
    pub fn covering_split(&self, point: DVec3) -> Option<usize> {
        if let Some(light) = self.plan.light.filter(|light| light.position().is_some()) {
            return self.local.covering_split(&self.plan, &light, point, self.settings.filter_radius);
        }
        let fan = self.fan.as_ref()?;
        self.plan.splits.iter().zip(&self.volumes).position(|(split, volume)| {
            volume.contains(fan, point) && (split.casters.is_empty() || split.contains(point, split.filter_reach))
        })
    }
}
