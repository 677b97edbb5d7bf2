//! Static casters that have moved lately, and are therefore drawn in every frame like moving ones.

use std::collections::BTreeMap;

use crate::casters::Change;
use crate::{Aabb, CasterHandle, CasterSet};

/// Frames for which a static caster that has moved has to stand still before it is kept again: one
/// second at 60 frames a second. A caster that stops and goes on does not change kept cells twice.
pub(super) const FRAMES: u32 = 60;

/// A static caster that has moved.
#[derive(Clone, Copy, Debug)]
struct Restless {
    key: u32,
    still: u32,
}

/// Static casters that have moved lately, and the keys of all casters that are not kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Rest {
    restless: BTreeMap<CasterHandle, Restless>,
    /// Keys of casters that are drawn in every frame, rising.
    live: Vec<u32>,
    /// Set and membership from which `live` was made.
    made_from: Option<(u64, u64)>,
}

impl Rest {
    /// Marks all static casters as resting.
    pub fn clear(&mut self) {
        self.restless.clear();
        self.made_from = None;
    }

    /// Follows a change. `drop` is called with each box whose kept shadow is no longer valid.
    pub fn follow(&mut self, change: &Change, drop: &mut impl FnMut(Aabb)) {
        let &Change { handle, key, old, new } = change;
        let known = self.restless.remove(&handle);
        self.made_from = None;
        if let (None, Some(old)) = (known, old) {
            drop(old);
        }
        match (old, new) {
            (Some(_), Some(_)) => {
                self.restless.insert(handle, Restless { key, still: 0 });
            }
            (None, Some(new)) => drop(new),
            _ => {}
        }
    }

    /// Lets casters rest again that have stood still for long enough.
    pub fn settle(&mut self, set: &CasterSet, drop: &mut impl FnMut(Aabb)) {
        let before = self.restless.len();
        self.restless.retain(|handle, it| {
            if it.still < FRAMES {
                return true;
            }
            if let Ok(bounds) = set.bounds(*handle) {
                drop(bounds);
            }
            false
        });
        if self.restless.len() < before {
            self.made_from = None;
        }
    }

    /// Counts a drawn frame.
    pub fn advance(&mut self) {
        self.restless.values_mut().for_each(|it| it.still += 1);
    }

    /// Lists the keys of casters that are drawn in every frame.
    pub fn list(&mut self, set: &CasterSet) {
        let from = Some((set.stamp().0, set.membership()));
        if self.made_from == from {
            return;
        }
        self.live.clear();
        self.live.extend(set.moving_keys().chain(self.restless.values().map(|it| it.key)));
        self.live.sort_unstable();
        self.live.dedup();
        self.made_from = from;
    }

    /// Returns whether a caster is drawn in every frame.
    pub fn is_live(&self, key: u32) -> bool {
        self.live.binary_search(&key).is_ok()
    }
}
