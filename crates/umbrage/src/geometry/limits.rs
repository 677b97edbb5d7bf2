//! How far parts of boxes inside a slice can reach, without clipping the boxes.

use glam::DVec3;

use super::region::{DIRECTIONS, Fan, Region, Undecided, bits};
use super::volume::{BEYOND, Plane, Slice};
use crate::Aabb;
use crate::bounds::Placed;

/// Share of the slice's coordinates by which rounding may move a corner of a clipped box, with room
/// to spare.
const CORNERS: f64 = 1e-12;

/// For each direction of a fan, for depth and for the world's axes how far any part of a box inside
/// a slice reaches at most, in that direction and in the opposite one.
///
/// A plane of the slice bounds the direction's part along its normal; the rest of the direction,
/// which is short where some plane is almost square to it, is bounded by the box.
#[derive(Clone, Debug)]
pub(crate) struct Limits {
    across: [[Limit; 2]; DIRECTIONS],
    depth: [Limit; 2],
    world: [[Limit; 2]; 3],
    /// Room for rounding in metres.
    room: f64,
}

/// A point of the slice reaches at most `offset` plus its place along `rest`.
#[derive(Clone, Copy, Debug)]
struct Limit {
    rest: DVec3,
    offset: f64,
}

impl Limit {
    /// The limits against a direction and along it.
    fn both(direction: DVec3, planes: &[Plane; 6]) -> [Self; 2] {
        let shares = planes.each_ref().map(|plane| direction.dot(plane.normal));
        let (mut against, mut along) = (0, 0);
        for (at, &share) in shares.iter().enumerate() {
            against = if share < shares[against] { at } else { against };
            along = if share > shares[along] { at } else { along };
        }
        let limit = |direction: DVec3, share: f64, plane: &Plane| {
            let share = share.max(0.0);
            Self { rest: direction - share * plane.normal, offset: share * plane.offset }
        };
        [limit(-direction, -shares[against], &planes[against]), limit(direction, shares[along], &planes[along])]
    }

    fn most(&self, Placed { center, half }: &Placed) -> f64 {
        self.offset + self.rest.dot(*center) + self.rest.abs().dot(*half)
    }
}

impl Limits {
    pub fn new(slice: &Slice, fan: &Fan) -> Self {
        let both = |direction| Limit::both(direction, &slice.planes);
        let farthest = slice.corners.iter().map(|corner| corner.abs().element_sum()).fold(0.0, f64::max);
        let offset = slice.planes.iter().map(|plane| plane.offset.abs()).fold(0.0, f64::max);
        Self {
            across: fan.directions.map(both),
            depth: both(fan.depth),
            world: [DVec3::X, DVec3::Y, DVec3::Z].map(both),
            room: CORNERS * farthest + BEYOND * offset,
        }
    }

    /// Bounds among `among` that parts of a box inside the slice may change, of a region and of the
    /// box around it; `None` if no part changes any. `own` is around the box.
    pub fn widened(
        &self,
        fan: &Fan,
        (placed, own): (&Placed, &Aabb),
        (region, bounds): (&Region, &Aabb),
        among: Undecided,
    ) -> Option<Undecided> {
        let room = self.room + BEYOND * (placed.center.abs() + placed.half).element_sum();
        let reaches = |limits: &[Limit; 2], ends: (f64, f64), (lo, hi): (f64, f64)| {
            let below = || ends.0 - room >= lo || -limits[0].most(placed) - room >= lo;
            let above = || ends.1 + room <= hi || limits[1].most(placed) + room <= hi;
            !(below() && above())
        };
        let is_undecided = |&k: &usize| reaches(&self.across[k], fan.ends(k, placed), (region.lo[k], region.hi[k]));
        let directions = bits(among.directions).filter(is_undecided).fold(0, |set, k| set | 1 << k);
        let depth = among.depth && reaches(&self.depth, fan.depths(placed), region.depth);
        let grows = |axis: usize| {
            let (own, bounds) = ((own.min[axis], own.max[axis]), (bounds.min[axis], bounds.max[axis]));
            let [below, above] = self.world[axis].map(|limit| limit.most(placed) + room);
            let is_within = [-below >= bounds.0, above <= bounds.1];
            own.0 < bounds.0 && !is_within[0] || own.1 > bounds.1 && !is_within[1]
        };
        let widened = Undecided { directions, depth };
        (!widened.is_nothing() || (0..3).any(grows)).then_some(widened)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Frustum, View};

    /// No corner of a clipped box lies beyond a limit, and limits are nearer than the boxes' own
    /// ends where a slice cuts much off.
    #[test]
    fn no_part_of_a_box_reaches_beyond_its_limits() {
        let lens = Frustum::perspective(1.0, 1.5, 0.5, 300.0).expect("a lens");
        let at = DVec3::new(1e5, 20.0, -3e4);
        let view = View::look_at_upright(at, at + DVec3::new(0.8, -0.2, 0.5), lens).expect("a view");
        let slice = Slice::new(&view, 40.0, 120.0);
        let depth = DVec3::new(-0.5, -0.7, 0.4).normalize();
        let fan = Fan::new(depth.any_orthonormal_vector(), depth);
        let limits = Limits::new(&slice, &fan);
        let share = |i: u32, step: u32| f64::from(i.wrapping_mul(step) % 9973) / 9972.0 - 0.5;
        let (mut parts, mut nearer) = (0, 0);
        for i in 0..4000 {
            let center = at + 300.0 * DVec3::new(share(i, 5171), 0.2 * share(i, 771), share(i, 7919));
            let placed = Placed { center, half: DVec3::splat(1.0 + 20.0 * (0.5 + share(i, 313))) };
            let room = limits.room + BEYOND * (placed.center.abs() + placed.half).element_sum();
            let most = limits.across.map(|limits| limits.map(|limit| limit.most(&placed)));
            parts += usize::from(slice.clip_box(&placed.bounds(), |point| {
                for (direction, [below, above]) in fan.directions.iter().zip(most) {
                    let along = direction.dot(point);
                    assert!(-below - room <= along && along <= above + room, "{along} in {below} to {above}");
                }
            }));
            nearer += (0..DIRECTIONS).filter(|&k| most[k][1] < fan.ends(k, &placed).1 - 1.0).count();
        }
        assert!(parts > 300 && nearer > 10_000, "{parts} parts, {nearer} limits nearer than boxes");
    }
}
