//! Record of the changes to a set's static casters, for keepers of maps drawn with these casters.

use std::collections::VecDeque;

use super::slots::CasterHandle;
use crate::Aabb;

/// One change of one static caster that casts shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Change {
    pub handle: CasterHandle,
    pub key: u32,
    /// Box before the change; `None` if the caster cast no shadow as a static caster.
    pub old: Option<Aabb>,
    /// Box after the change; `None` if the caster no longer casts a shadow as a static caster.
    pub new: Option<Aabb>,
}

/// Most changes that are remembered for a small set. A reader that has missed more has to treat all
/// casters as changed. 4,096 changes take some 600 kB.
const MOST: usize = 4096;

/// For a large set, one change for every so many casters is remembered: 31,250 of a million
/// casters, some 5 MB once so many change in a frame.
const SHARE: usize = 32;

/// The latest changes, by number.
#[derive(Clone, Debug, Default)]
pub(super) struct Journal {
    changes: VecDeque<Change>,
    /// The number of the next change.
    next: u64,
}

impl Journal {
    /// Notes a change of a set of `casters` casters.
    pub fn note(&mut self, change: Change, casters: usize) {
        while self.changes.len() >= MOST.max(casters / SHARE) {
            self.changes.pop_front();
        }
        self.changes.push_back(change);
        self.next += 1;
    }

    /// Notes more changes than are remembered.
    pub fn note_too_many(&mut self) {
        self.changes.clear();
        self.next += 1;
    }

    /// The number of the next change.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// The changes from a number on; `None` if not all of them are remembered.
    pub fn since(&self, number: u64) -> Option<impl Iterator<Item = &Change>> {
        let missed = usize::try_from(self.next.checked_sub(number)?).ok()?;
        let first = self.changes.len().checked_sub(missed)?;
        Some(self.changes.range(first..))
    }

    pub fn bytes(&self) -> usize {
        self.changes.capacity() * size_of::<Change>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Caster, CasterSet};
    use glam::DVec3;

    #[test]
    fn changes_are_told_from_a_number_on_or_not_at_all() {
        let mut set = CasterSet::new();
        let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
        let handle = set.insert(Caster::new(unit, 7)).expect("a box");
        let mut journal = Journal::default();
        for key in 0..2 * MOST as u32 {
            journal.note(Change { handle, key, old: None, new: Some(unit) }, set.len());
        }
        let end = journal.next();
        let keys = |from| journal.since(from).map(|changes| changes.map(|change| change.key).collect::<Vec<_>>());
        assert_eq!(keys(end), Some(vec![]));
        assert_eq!(keys(end - 2), Some(vec![end as u32 - 2, end as u32 - 1]));
        assert_eq!(keys(end - MOST as u64).map(|keys| keys.len()), Some(MOST));
        assert_eq!(keys(end - MOST as u64 - 1), None, "forgotten");
        assert_eq!(keys(end + 1), None, "another set's number");
        let begin = journal.next();
        for key in 0..2 * MOST as u32 {
            journal.note(Change { handle, key, old: None, new: Some(unit) }, 2 * MOST * SHARE);
        }
        let remembered = journal.since(begin).map(Iterator::count);
        assert_eq!(remembered, Some(2 * MOST), "more of a larger set");
        let end = journal.next();
        journal.note_too_many();
        assert!(journal.since(end).is_none() && journal.since(journal.next()).is_some());
    }
}
