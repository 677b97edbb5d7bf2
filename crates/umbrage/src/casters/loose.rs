//! Casters that are kept one by one, as they were given: those that move, those that have just
//! come, and boxes that the lattice of the packed ones does not suit. A small tree over them is
//! refitted as they move.

use super::curve::Curve;
use super::kind::{Ask, Kinds};
use super::tree::{Asked, BoxTree};
use crate::Aabb;
use crate::bounds::Placed;

/// A caster that is kept by itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub bounds: Aabb,
    pub code: u64,
    pub key: u32,
    pub slot: u32,
    pub kind: u16,
    pub moves: bool,
    /// True if the next packing takes the caster.
    pub is_due: bool,
}

/// Changes after which nodes are fitted again, at least.
const LEAST_CHANGES: usize = 64;

/// Factor by which the spread of leaves may grow after they were last put in order.
const MOST_SPREAD: f64 = 1.5;

/// The casters that are kept one by one.
#[derive(Clone, Debug, Default)]
pub(super) struct Loose {
    pub entries: Vec<Entry>,
    tree: BoxTree,
    changes: usize,
    /// Number of entries with [`Entry::is_due`].
    pub due: usize,
    /// Spread of the leaves when they were last put in order.
    ordered_spread: f64,
}

impl Loose {
    pub fn push(&mut self, entry: Entry) -> u32 {
        self.due += usize::from(entry.is_due);
        self.tree.push(entry.bounds.into());
        self.entries.push(entry);
        self.changes += 1;
        (self.entries.len() - 1) as u32
    }

    /// Changes the box of a caster.
    pub fn set(&mut self, at: u32, bounds: Aabb, is_due: bool) {
        let entry = &mut self.entries[at as usize];
        entry.bounds = bounds;
        self.due -= usize::from(entry.is_due);
        self.due += usize::from(is_due);
        entry.is_due = is_due;
        self.tree.set(at as usize, bounds.into());
        self.changes += 1;
    }

    /// Removes a caster, and returns the slot of the one that has moved to place `at` instead.
    pub fn remove(&mut self, at: u32) -> Option<u32> {
        let entry = self.entries.swap_remove(at as usize);
        self.due -= usize::from(entry.is_due);
        self.tree.swap_remove(at as usize);
        self.changes += 1;
        self.entries.get(at as usize).map(|moved| moved.slot)
    }

    /// Takes out the casters that are due.
    pub fn take_due(&mut self) -> Vec<Entry> {
        let due = self.entries.iter().filter(|entry| entry.is_due).copied().collect();
        self.entries.retain(|entry| !entry.is_due);
        self.due = 0;
        self.order();
        due
    }

    /// Gives back memory that is not used.
    pub fn shrink(&mut self) {
        self.entries.shrink_to_fit();
        self.tree.shrink();
    }

    /// Fits the nodes once about every caster may have moved. Returns whether casters have changed
    /// places.
    pub fn settle(&mut self) -> bool {
        if self.changes < self.entries.len().max(LEAST_CHANGES) {
            return false;
        }
        self.changes = 0;
        self.tree.refit();
        let is_spread = self.tree.spread() > MOST_SPREAD * self.ordered_spread;
        if is_spread {
            self.order();
        }
        is_spread
    }

    /// Puts the casters in order along a curve through all of them.
    fn order(&mut self) {
        let bounds = self.entries.iter().fold(Aabb::EMPTY, |all, entry| all.including(entry.bounds.center()));
        let curve = Curve::through(bounds);
        self.entries.iter_mut().for_each(|entry| entry.code = curve.code(entry.bounds.center()));
        self.entries.sort_unstable_by_key(|entry| (entry.code, entry.slot));
        self.tree.fill(self.entries.iter().map(|entry| entry.bounds.into()));
        self.ordered_spread = self.tree.spread();
        self.changes = 0;
    }

    /// The tree for queries up to `farthest` metres from the origin.
    pub fn asked<'a>(&'a self, ask: Ask, kinds: &'a Kinds, farthest: f64) -> Asked<'a, impl Fn(usize) -> bool + 'a> {
        Asked { tree: &self.tree, farthest, is_for: move |at: usize| ask.is_for(kinds.get(self.entries[at].kind)) }
    }

    /// The boxes without thickness, with their places.
    pub fn flats(&self) -> impl Iterator<Item = (usize, &Placed)> + '_ {
        self.tree.flats()
    }

    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Entry>() + self.tree.bytes()
    }
}
