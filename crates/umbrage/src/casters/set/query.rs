//! Queries by an application: the members of a set in a part of the world.

use std::cell::Cell;

use glam::DVec3;

use super::CasterSet;
use crate::Aabb;
use crate::casters::kind::{Layers, Role};
use crate::casters::tree::Counter;
use crate::casters::view::Crowd;

impl CasterSet {
    /// Calls `visit` with key and kept box of every member that shows shadows, is on one of
    /// `layers` and passes `test`: the objects that a view has to draw, for example.
    ///
    /// The test is first applied to boxes around groups of neighbours, so it has to pass for every
    /// box that contains one for which it passes. The order of calls is that of the set's tree.
    ///
    /// ```
    /// # use umbrage::{Aabb, Caster, CasterSet, Layers};
    /// # use glam::DVec3;
    /// # let mut set = CasterSet::new();
    /// # set.insert(Caster::new(Aabb::new(DVec3::ZERO, DVec3::ONE), 7))?;
    /// let mut keys = Vec::new();
    /// set.each_receiver(Layers::ALL, |bounds| bounds.min.x < 10.0, |key, _| keys.push(key));
    /// assert_eq!(keys, [7]);
    /// # Ok::<(), umbrage::Error>(())
    /// ```
    pub fn each_receiver(
        &self,
        layers: Layers,
        mut test: impl FnMut(&Aabb) -> bool,
        mut visit: impl FnMut(u32, &Aabb),
    ) {
        let counter: Counter = Cell::default();
        let all = Crowd::of_set(self, (layers, Role::Receiver), DVec3::ZERO, &counter);
        all.each(|placed| test(&placed.bounds()), |key, placed| visit(key, &placed.bounds()));
    }
}
