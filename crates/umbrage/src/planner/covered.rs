//! The region that a map covers with selection by map: its square along the light, less what
//! earlier maps cover.

use glam::{DVec2, DVec3};

use super::frame::Sun;
use super::picked::{Asked, Picked};
use super::shaft::first_depth;
use crate::bounds::Placed;
use crate::casters::Gathered;
use crate::coverage::CoverageVolume;
use crate::geometry::region::Undecided;
use crate::geometry::volume::{lies_below, some_lies_below};
use crate::{ShadowPlan, Split};

/// Texels beyond the filter's reach by which a caster may be off, because the position of a sample
/// is rounded.
const ROUNDING_TEXELS: f64 = 1.0;

/// The rectangle of a box in a plain map, in texels.
fn rectangle(split: &Split, center: DVec3, half: DVec3) -> (DVec2, DVec2) {
    let middle = DVec2::new(split.u_axis.dot(center), split.v_axis.dot(center)) / split.texel_m - split.min_texel;
    let reach = DVec2::new(split.u_axis.abs().dot(half), split.v_axis.abs().dot(half)) / split.texel_m;
    (middle - reach, middle + reach)
}

/// Returns whether a box can cover any texel of the map.
fn reaches(split: &Split, center: DVec3, half: DVec3) -> bool {
    let (lo, hi) = rectangle(split, center, half);
    lo.cmple(DVec2::splat(f64::from(split.size) + ROUNDING_TEXELS)).all()
        && hi.cmpge(DVec2::splat(-ROUNDING_TEXELS)).all()
}

/// The earlier maps, and the margins within which they take points from the planned one.
struct Taken<'a> {
    earlier: &'a [Split],
    /// Texels that a filter reaches around a sample of the planned map, rounding included.
    margin: f64,
    /// Share of a map's half edge over which the next map is also used.
    blend: f64,
    /// The margin in metres, in the planned map.
    reach_m: f64,
}

impl<'a> Taken<'a> {
    fn new(split: &Split, earlier: &'a [Split], blend: f64) -> Self {
        let margin = split.filter_radius_texels + ROUNDING_TEXELS;
        Self { earlier, margin, blend, reach_m: margin * split.texel_m.max_element() }
    }

    /// Returns whether all points that a box can shade belong to one earlier map, filter and blend
    /// band included. A point and its casters lie at one position of that map.
    fn holds(&self, center: DVec3, half: DVec3) -> bool {
        self.earlier.iter().filter(|split| !split.casters.is_empty()).any(|split| {
            let (lo, hi) = rectangle(split, center, half);
            let size = f64::from(split.size);
            let room = split.filter_radius_texels
                + ROUNDING_TEXELS
                + 0.5 * self.blend * size
                + self.reach_m / split.texel_m.min_element();
            lo.cmpge(DVec2::splat(room)).all() && hi.cmple(DVec2::splat(size - room)).all()
        })
    }
}

/// The split with a list and a depth range for the whole region that its map covers and no earlier
/// map takes, and the depth of its first caster. `shown` and its depths describe the region that
/// any map may be asked about.
pub(super) fn serving_all_it_covers(
    sun: &Sun<'_>,
    (mut split, mut first): (Split, f64),
    shown: (&CoverageVolume, (f64, f64)),
    (casters, listed): (&Gathered, &mut Picked),
    plan: &ShadowPlan,
) -> (Split, f64) {
    let direction = sun.direction;
    let taken = Taken::new(&split, &plan.splits, plan.blend);
    let margin = taken.margin * split.texel_m.max_element();
    let (volume, depths) = shown;
    let served = volume.receivers.as_ref();
    listed.pick(casters, |group, hull| {
        // What no box of a group can do, or all of them do.
        let all = &group.bounds;
        if !reaches(&split, all.center, all.half) || taken.holds(all.center, all.half) {
            return None;
        }
        let shadowed = match (served, hull) {
            (Some((region, _)), Some(hull)) => region.undecided_in(hull, margin)?,
            _ => Undecided::ALL,
        };
        let may_be_below = served.is_some_and(|(_, bounds)| some_lies_below(&group.core, bounds, direction));
        let (split, taken) = (&split, &taken);
        Some(Asked::Each(move |caster: &Placed| {
            let &Placed { center, half } = caster;
            reaches(split, center, half)
                && served.is_none_or(|(region, bounds)| {
                    !(may_be_below && lies_below(center, half, bounds, direction, margin))
                        && region.can_be_shadowed_along(&sun.fan, caster, margin, shadowed)
                })
                && !taken.holds(center, half)
        }))
    });
    first = first.min(-listed.most(casters, |c| -first_depth(c, direction)));
    split.depth_near = split.depth_near.min(depths.0);
    split.depth_far = split.depth_far.max(depths.1);
    // Any of it may be looked up in this map.
    split.receiver_depths = (split.receiver_depths.0.min(depths.0), split.receiver_depths.1.max(depths.1));
    (split, first)
}
