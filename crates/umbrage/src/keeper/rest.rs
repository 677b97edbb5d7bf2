//! Which static casters do not rest, and are drawn in every frame like those that move.

use std::collections::BTreeMap;

use crate::casters::Change;
use crate::{Aabb, CasterHandle, CasterSet};

/// Frames for which a static caster that has moved has to stand still before it is kept again. At
/// 60 frames a second one second: a caster that stops and goes on does not change what is kept
/// twice.
pub(super) const FRAMES: u32 = 60;

/// A static caster that has moved.
#[derive(Clone, Copy, Debug)]
struct Restless {
    key: u32,
    still: u32,
}

/// Static casters that have moved lately, and the keys of all that is not kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Rest {
    restless: BTreeMap<CasterHandle, Restless>,
    /// Keys of casters that are drawn in every frame, rising.
    live: Vec<u32>,
    /// What `live` was made from.
    made_from: Option<(u64, u64)>,
}

impl Rest {
    /// Takes all static casters as resting.
    pub fn clear(&mut self) {
        self.restless.clear();
        self.made_from = None;
    }

    /// Follows a change. `drop` is called with the box of whatever is no longer what was kept.
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

    /// Ends the wait of casters that have stood still for long enough.
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

    /// A frame was drawn.
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

    /// Whether a caster is drawn in every frame.
    pub fn is_live(&self, key: u32) -> bool {
        self.live.binary_search(&key).is_ok()
    }
}
