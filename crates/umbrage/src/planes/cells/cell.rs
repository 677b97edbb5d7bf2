//! A thin slice of the view, and what is known of its receivers and casters.

use glam::DVec3;

use crate::Aabb;
use crate::bounds::Placed;
use crate::geometry::limits::Limits;
use crate::geometry::region::{Fan, Region, Undecided};
use crate::geometry::volume::Slice;

/// The part of the view between two candidate planes.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub slice: Slice,
    limits: Limits,
    /// The receivers inside, in the light's plane and in the world.
    pub receivers: Region,
    pub bounds: Aabb,
    /// Bounds of the whole casters that can shade the receivers; empty if there are none.
    pub casters: Region,
    /// Expected length of shadow edges in the light's plane, in [`Cells::unit`]: an integer, so
    /// that the sum does not depend on its order.
    pub edges: u64,
    /// [`Region::least_direction`] of the receivers, once all are included.
    pub least_direction: usize,
}

impl Cell {
    pub fn new(slice: Slice, fan: &Fan) -> Self {
        Self {
            limits: Limits::new(&slice, fan),
            slice,
            receivers: Region::EMPTY,
            bounds: Aabb::EMPTY,
            casters: Region::EMPTY,
            edges: 0,
            least_direction: 0,
        }
    }

    /// Includes a point of a box that can change these bounds alone.
    pub fn include(&mut self, fan: &Fan, point: DVec3, (of, widened): (&Aabb, Undecided)) {
        self.receivers.include_point_in(fan, point, widened);
        self.bounds = self.bounds.including(point.clamp(of.min, of.max));
    }

    /// Bounds among `among` that parts of a box inside the slice may change; `None` if no part
    /// changes any, nor the bounds in the world.
    pub fn widened(&self, fan: &Fan, (placed, own): (&Placed, &Aabb), among: Undecided) -> Option<Undecided> {
        if among.is_nothing() && self.bounds.union(*own) == self.bounds {
            return None;
        }
        self.limits.widened(fan, (placed, own), (&self.receivers, &self.bounds), among)
    }
}
