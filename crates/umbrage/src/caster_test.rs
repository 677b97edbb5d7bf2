//! The test by which the casters of a split are listed, in single precision for culling on a GPU.

use glam::{DVec3, Vec2, Vec3, Vec4};

use crate::bounds::rounding;
use crate::coverage::CoverageVolume;
use crate::geometry::receiver_mask::CasterMask;
use crate::geometry::region::Fan;
use crate::{ShadowPlan, Split};

/// Share of the numbers in a test by which `f32` may have rounded them, with room to spare: eight
/// times its precision.
const ROUNDING: f32 = 1e-6;

/// Most cells of a mask that are looked up for a box along either axis; a wider box passes.
const MOST_CELLS: f32 = 12.0;

/// A component of the light's direction below this does not count as falling or rising.
const LEVEL: f32 = 1e-9;

/// Conservative test of boxes in `f32`, relative to an origin: a box that fails casts no shadow
/// that the split serves. For culling on a GPU; [`CasterTest::passes`] is the same test on the CPU.
///
/// A box passes only if it reaches into every half space of [`CasterTest::planes`], does not lie
/// below all receivers ([`CasterTest::below`]) and has a receiver behind it
/// ([`CasterTest::mask`]). Every test leaves room for rounding: a box that
/// [`ShadowPlan::casts_into`] accepts passes, and drawing one more never changes a visible pixel.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CasterTest {
    /// Half spaces `normal · p <= w` with outward unit normals. `w` is in metres and includes the
    /// filter's reach.
    pub planes: Vec<Vec4>,
    /// Test against the receivers' box, if that box is known.
    pub below: Option<BelowTest>,
    /// Heights of the receivers along the light, if the plan was made with clusters of receivers.
    pub mask: Option<CasterMask>,
}

/// Test that rejects a box lying wholly below all receivers: it casts no visible shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BelowTest {
    /// Direction in which light travels.
    pub direction: Vec3,
    /// Least corner of the receivers' box.
    pub min: Vec3,
    /// Greatest corner of the receivers' box.
    pub max: Vec3,
    /// Metres by which a flat box may rise above the receivers' lowest point and still be rejected.
    pub slack: f32,
    /// Metres by which any other box has to lie below the receivers' lowest point to be rejected.
    pub margin: f32,
}

impl ShadowPlan {
    /// The test of a split's casters for boxes relative to `origin`. `None` for a plan that is not
    /// of a sun, for a warped map, for a split that does not exist, and for one whose points the
    /// next split serves ([`crate::config::Cache::Kept`]).
    #[must_use]
    pub fn caster_test(&self, split: usize, origin: DVec3) -> Option<CasterTest> {
        let (map, coverage) = (self.splits.get(split)?, &self.coverage);
        let fan = coverage.fan.as_ref().filter(|_| map.warp.is_none() && !coverage.is_handed_on(split))?;
        let mut test = CasterTest::default();
        match (&coverage.shown, coverage.volumes.get(split)) {
            // Where maps are chosen by what they contain, what lies over a map matters.
            (Some(_), _) => test.planes.extend(map_planes(map, origin)),
            (None, Some(volume)) => {
                test.planes.extend(volume_planes(volume, fan, origin));
                test.below = below(volume, fan, origin);
                let mask = coverage.has_masks && volume.receivers.is_some();
                test.mask = mask.then(|| coverage.masks[split].caster_mask(origin));
            }
            (None, None) => return None,
        }
        Some(test)
    }
}

/// A half space relative to an origin.
fn plane(normal: DVec3, offset: f64, origin: DVec3) -> Vec4 {
    normal.as_vec3().extend((offset - normal.dot(origin)) as f32)
}

/// The sides of a plain map, moved outwards by one texel.
fn map_planes(map: &Split, origin: DVec3) -> Vec<Vec4> {
    let mut planes = Vec::with_capacity(5);
    for (axis, texel, begin) in
        [(map.u_axis, map.texel_m.x, map.min_texel.x), (map.v_axis, map.texel_m.y, map.min_texel.y)]
    {
        planes.push(plane(axis, texel * (begin + f64::from(map.size) + 1.0), origin));
        planes.push(plane(-axis, -texel * (begin - 1.0), origin));
    }
    planes.push(plane(map.depth_axis, map.depth_far, origin));
    planes
}

/// The half spaces of [`crate::coverage::can_shade`].
fn volume_planes(volume: &CoverageVolume, fan: &Fan, origin: DVec3) -> Vec<Vec4> {
    let margin = volume.margin;
    let mut planes: Vec<Vec4> =
        volume.swept.planes().iter().map(|side| plane(side.normal, side.offset + margin, origin)).collect();
    if let Some((region, _)) = &volume.receivers {
        planes.push(plane(fan.depth, region.depth.1, origin));
        for (k, &direction) in fan.directions.iter().enumerate() {
            planes.push(plane(direction, region.hi[k] + margin, origin));
            planes.push(plane(-direction, margin - region.lo[k], origin));
        }
    }
    planes
}

fn below(volume: &CoverageVolume, fan: &Fan, origin: DVec3) -> Option<BelowTest> {
    let (_, bounds) = volume.receivers.as_ref()?;
    let slack = rounding(bounds.max - bounds.min) as f32;
    let [min, max] = [bounds.min, bounds.max].map(|corner| (corner - origin).as_vec3());
    Some(BelowTest { direction: fan.depth.as_vec3(), min, max, slack, margin: volume.margin as f32 })
}

impl CasterTest {
    /// Returns whether a box passes; its centre is relative to the test's origin.
    #[must_use]
    pub fn passes(&self, center: Vec3, half: Vec3) -> bool {
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let room = ROUNDING * (normal.abs().dot(center.abs() + half) + plane.w.abs());
            let outside = normal.dot(center) - normal.abs().dot(half) > plane.w + room;
            !outside
        }) && !self.below.is_some_and(|below| below.holds(center, half))
            && self.mask.as_ref().is_none_or(|mask| mask.lies_before_some(center, half))
    }
}

impl BelowTest {
    fn holds(&self, center: Vec3, half: Vec3) -> bool {
        (0..3).any(|axis| {
            let along = self.direction[axis];
            let beyond = if along < -LEVEL {
                self.min[axis] - (center[axis] + half[axis])
            } else if along > LEVEL {
                center[axis] - half[axis] - self.max[axis]
            } else {
                return false;
            };
            let is_flat = 2.0 * half[axis] <= self.slack;
            let room = ROUNDING * (center[axis].abs() + half[axis] + self.min[axis].abs() + self.max[axis].abs());
            beyond >= if is_flat { -self.slack } else { self.margin + room }
        })
    }
}

impl CasterMask {
    fn lies_before_some(&self, center: Vec3, half: Vec3) -> bool {
        let axes = [self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3].map(|axis| axis as usize);
        let height = self.sign * center[axes[0]];
        let at = Vec2::new(center[axes[1]], center[axes[2]]) + self.slope * height;
        let reach = Vec2::new(half[axes[1]], half[axes[2]]) + self.slope.abs() * half[axes[0]];
        let room =
            ROUNDING * (at.abs() + reach + self.begin.abs() + self.slope.abs() * height.abs()) + 1e-3 * self.cell;
        let lo = ((at - reach - room - self.begin) / self.cell).floor();
        let hi = ((at + reach + room - self.begin) / self.cell).floor();
        let last = (Self::EDGE - 1) as f32;
        if hi.min_element() < 0.0 || lo.max_element() > last {
            return false;
        }
        let (lo, hi) = (lo.max(Vec2::ZERO), hi.min(Vec2::splat(last)));
        if (hi - lo).max_element() > MOST_CELLS {
            return true;
        }
        let top = height + half[axes[0]];
        let top = top + ROUNDING * (top.abs() + half[axes[0]]);
        let (columns, rows) = (lo.x as usize..=hi.x as usize, lo.y as usize..=hi.y as usize);
        rows.into_iter().any(|row| columns.clone().any(|column| self.lowest[row * Self::EDGE + column] < top))
    }
}
