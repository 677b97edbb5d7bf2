//! Splits whose maps are not filled yet, and which the next split serves in their place.

use crate::{ShadowPlan, Split};

/// Far end in metres of a slice that contains no view depth.
const NOWHERE: f64 = -1e30;

impl ShadowPlan {
    /// Lets the next split also serve the slice and the casters of `split`. The next split's map
    /// has to contain the map of `split`.
    pub(super) fn hand_on(&mut self, split: usize) {
        let begin = self.caster_indices.len();
        let [own, next] = [split, split + 1].map(|at| self.splits[at].casters.clone());
        merge(&mut self.caster_indices, own, next);
        if let Some(before) = split.checked_sub(1) {
            // The band would go over into a split that nobody asks.
            let before = &mut self.splits[before];
            before.blend_begin = before.far;
        }
        let (from, to) = self.splits.split_at_mut(split + 1);
        let (own, next) = (&mut from[split], &mut to[0]);
        next.near = own.near;
        next.coverage.0 = next.coverage.0.min(own.coverage.0);
        next.receiver_depths = both(own, next);
        next.casters = begin..self.caster_indices.len();
        (own.far, own.blend_begin, own.casters) = (NOWHERE, NOWHERE, 0..0);
        self.coverage.hand_on(split);
    }

    /// Returns whether the next split serves the points of `split`, because the map of `split` was
    /// not filled in time: see [`crate::Keeper`].
    #[must_use]
    pub fn is_handed_on(&self, split: usize) -> bool {
        self.coverage.is_handed_on(split)
    }

    /// Returns whether every split serves its own slice, so that shadows are as sharp as they get.
    /// False if the maps of some were not filled in time: see [`crate::Keeper`].
    #[must_use]
    pub fn is_filled(&self) -> bool {
        !(0..self.splits.len()).any(|split| self.is_handed_on(split))
    }
}

/// Range of depths along the light that either of two splits shows.
fn both(own: &Split, next: &Split) -> (f64, f64) {
    let ((a, b), (c, d)) = (own.receiver_depths, next.receiver_depths);
    (a.min(c), b.max(d))
}

/// Appends two rising ranges of a list as one, each number once.
fn merge(list: &mut Vec<u32>, mut a: std::ops::Range<usize>, mut b: std::ops::Range<usize>) {
    loop {
        let next = match (a.is_empty(), b.is_empty()) {
            (true, true) => return,
            (false, true) => list[a.start],
            (true, false) => list[b.start],
            (false, false) => list[a.start].min(list[b.start]),
        };
        for range in [&mut a, &mut b] {
            if range.start < range.end && list[range.start] == next {
                range.start += 1;
            }
        }
        list.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::merge;

    #[test]
    fn two_lists_become_one_that_rises() {
        let mut list = vec![1, 4, 9, 2, 4, 5];
        merge(&mut list, 0..3, 3..6);
        assert_eq!(list[6..], [1, 2, 4, 5, 9]);
        merge(&mut list, 0..0, 3..6);
        assert_eq!(list[11..], [2, 4, 5]);
    }
}
