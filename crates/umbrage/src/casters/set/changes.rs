//! Changes of a set's static casters, for keepers of maps drawn with these casters.

use super::CasterSet;
use crate::casters::journal::Change;
use crate::casters::slots::{CasterHandle, Place};
use crate::{Aabb, Result};

/// Most casters inserted together that are noted one by one; with more, all casters count as
/// changed.
const MOST_NOTED: usize = 1024;

impl CasterSet {
    /// Declares that the shape of a caster has changed within its box: the kept parts of its shadow
    /// ([`crate::config::Cache::Kept`]) are drawn again. A caster whose shape changes in many
    /// frames should be a [`crate::Motion::Moving`] one.
    ///
    /// # Errors
    /// [`crate::Error::RemovedCaster`].
    pub fn reshape(&mut self, handle: CasterHandle) -> Result<()> {
        let slot = self.slots.index(handle)?;
        let bounds = self.static_bounds(slot);
        self.note_static(slot, bounds);
        self.revision += 1;
        Ok(())
    }

    /// Changes of static casters from a number on, and the number to continue from. The changes are
    /// `None` if they are no longer known.
    pub(crate) fn changes_since(&self, number: u64) -> (Option<impl Iterator<Item = &Change>>, u64) {
        (self.journal.since(number), self.journal.next())
    }

    /// A number that changes with every caster that comes, goes or changes its motion.
    pub(crate) fn membership(&self) -> u64 {
        self.membership
    }

    /// The keys of all casters that are expected to move.
    pub(crate) fn moving_keys(&self) -> impl Iterator<Item = u32> + '_ {
        self.loose.entries.iter().filter(|entry| entry.moves).map(|entry| entry.key)
    }

    /// The box of a static caster that casts shadows.
    pub(super) fn static_bounds(&self, slot: u32) -> Option<Aabb> {
        if let Place::Loose(at) = self.slots.get(slot)
            && self.loose.entries[at as usize].moves
        {
            return None;
        }
        Some(self.caster(slot)).filter(|caster| caster.casts).map(|caster| caster.bounds)
    }

    /// Notes that casters have been added, after the fact.
    pub(super) fn note_all(&mut self, handles: &[CasterHandle]) {
        if handles.len() > MOST_NOTED {
            self.journal.note_too_many();
            self.membership += 1;
            return;
        }
        for &handle in handles {
            if let Ok(slot) = self.slots.index(handle) {
                self.note(slot, None);
            }
        }
    }

    /// Notes that a caster is removed, before the fact.
    pub(super) fn note_end(&mut self, slot: u32) {
        if let Some(old) = self.static_bounds(slot) {
            let (handle, key) = (self.slots.handle(slot), self.about(slot).0);
            self.journal.note(Change { handle, key, old: Some(old), new: None }, self.len);
        }
        self.membership += 1;
    }

    /// Notes that a caster was added or changed its motion, after the fact.
    pub(super) fn note(&mut self, slot: u32, before: Option<Aabb>) {
        self.membership += 1;
        self.note_static(slot, before);
    }

    /// Notes a change of a static caster's box or shape, after the fact.
    pub(super) fn note_static(&mut self, slot: u32, old: Option<Aabb>) {
        let new = self.static_bounds(slot);
        if old.is_some() || new.is_some() {
            let (handle, key) = (self.slots.handle(slot), self.about(slot).0);
            self.journal.note(Change { handle, key, old, new }, self.len);
        }
    }
}
