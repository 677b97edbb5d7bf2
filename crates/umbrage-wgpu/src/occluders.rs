//! Ids of the triangles of casters, for exact edges.

use std::collections::BTreeMap;

use umbrage_shaders::layout::{RUN_BITS, RUN_TRIANGLES, StoredRun};

use crate::{Error, Result};

/// Number of runs in a slot.
const SLOT_RUNS: u32 = 1 << RUN_BITS;

/// Number of slots. One more would have ids beyond 32 bits, because 0 is not an id of a run.
const SLOTS: u32 = (1 << (32 - RUN_BITS)) - 1;

/// Ids of a caster, one for each of its runs: [`Occluder::first_id`] and those that follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Occluder {
    first_slot: u32,
    slots: u32,
}

impl Occluder {
    /// Id of the caster's first run: `first` of `umbrage_caster_id(first, run)`. Never 0.
    #[must_use]
    pub const fn first_id(self) -> u32 {
        1 + (self.first_slot << RUN_BITS)
    }

    /// Slots of the caster, as indices into the array of
    /// [`StoredSlot`](umbrage_shaders::layout::StoredSlot)s. Run `r` belongs to slot `r / 4096` of
    /// them, whose `first_run` gives the index of its first run.
    #[must_use]
    pub fn slots(self) -> impl ExactSizeIterator<Item = u32> {
        self.first_slot..self.first_slot + self.slots
    }

    /// Slots of the caster, each with the index of its first run among the caster's.
    #[must_use]
    pub fn runs_of_slots(self) -> impl ExactSizeIterator<Item = (u32, u32)> {
        (0..self.slots).map(move |slot| (self.first_slot + slot, slot * SLOT_RUNS))
    }
}

/// Allocator of ids for exact edges ([`umbrage::config::Edges::Exact`]): shaders can look up the
/// triangles of a caster that is drawn with ids.
///
/// Removed ids are allocated again only after the next [`crate::Shadows::prepare`], because the
/// texels of the last maps contain them until the maps are drawn again.
#[derive(Clone, Debug, Default)]
pub struct Occluders {
    /// First slot that was never allocated.
    end: u32,
    /// Free slots before `end`: the first slot of each row, and the number of slots in it.
    free: BTreeMap<u32, u32>,
    /// Slots of casters: the first slot of each, and the number of its slots.
    used: BTreeMap<u32, u32>,
    /// Removed slots that the texels of the last maps may contain.
    removed: Vec<Occluder>,
}

impl Occluders {
    /// Allocates ids for a caster of so many runs, at least 1.
    ///
    /// # Errors
    /// [`Error::TooManyOccluders`] if there are not enough free slots in a row.
    pub fn insert(&mut self, runs: u32) -> Result<Occluder> {
        let slots = runs.max(1).div_ceil(SLOT_RUNS);
        let row = self.free.iter().find(|&(_, &count)| count >= slots).map(|(&first, &count)| (first, count));
        let first_slot = match row {
            Some((first, count)) => {
                self.free.remove(&first);
                if count > slots {
                    self.free.insert(first + slots, count - slots);
                }
                first
            }
            None if SLOTS - self.end >= slots => {
                self.end += slots;
                self.end - slots
            }
            None => {
                let free = SLOTS - self.used.values().sum::<u32>();
                return Err(Error::TooManyOccluders { runs, needed: slots, free, all: SLOTS });
            }
        };
        self.used.insert(first_slot, slots);
        Ok(Occluder { first_slot, slots })
    }

    /// Frees the ids of a caster.
    ///
    /// # Errors
    /// [`Error::UnknownOccluder`] for a caster that was already removed, or that belongs to another
    /// allocator. The ids are unchanged then.
    pub fn remove(&mut self, occluder: Occluder) -> Result<()> {
        let Occluder { first_slot, slots } = occluder;
        if self.used.get(&first_slot) != Some(&slots) {
            return Err(Error::UnknownOccluder { first: first_slot, last: first_slot + slots.max(1) - 1 });
        }
        self.used.remove(&first_slot);
        self.removed.push(occluder);
        Ok(())
    }

    /// Number of slots up to the last one that was ever allocated: the buffer needs so many
    /// [`StoredSlot`](umbrage_shaders::layout::StoredSlot)s.
    #[must_use]
    pub fn slot_count(&self) -> usize {
        self.end as usize
    }

    /// Frees the slots that were removed earlier. To be called before maps are drawn again.
    pub(crate) fn recycle(&mut self) {
        for Occluder { first_slot, slots } in self.removed.drain(..) {
            let (mut first, mut count) = (first_slot, slots);
            if let Some(after) = self.free.remove(&(first + count)) {
                count += after;
            }
            if let Some((&before, &rows)) = self.free.range(..first).next_back()
                && before + rows == first
            {
                (first, count) = (before, count + rows);
            }
            self.free.insert(first, count);
        }
    }
}

/// The runs of a triangle list in drawing order, for [`stored_runs_wgsl`]. `first_index` is the
/// offset of `indices` in the stored ones, and indices refer to the stored `positions`.
///
/// # Panics
/// If an index points beyond the positions.
#[must_use]
pub fn stored_runs(positions: &[[f32; 3]], indices: &[u32], first_index: u32) -> Vec<StoredRun> {
    let runs = indices.chunks(3 * RUN_TRIANGLES as usize).zip(0..);
    let run = |(corners, number): (&[u32], u32)| {
        let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for corner in corners.iter().map(|&index| positions[index as usize]) {
            for axis in 0..3 {
                (min[axis], max[axis]) = (min[axis].min(corner[axis]), max[axis].max(corner[axis]));
            }
        }
        let first_index = first_index + 3 * RUN_TRIANGLES * number;
        StoredRun { min, triangles: corners.len() as u32 / 3, max, first_index }
    };
    runs.map(run).collect()
}

/// WGSL to put beside [`crate::Shadows::receiver_wgsl`] if an application keeps positions and
/// indices of its casters in storage buffers: the two functions that exact edges call. See
/// [`umbrage_shaders::stored_runs`] for the four bindings, from `binding` on in group `group`, and
/// for the functions of applications that keep them otherwise.
#[must_use]
pub fn stored_runs_wgsl(group: u32, binding: u32) -> String {
    umbrage_shaders::stored_runs(group, binding)
}

/// Layout of the bindings that [`stored_runs_wgsl`] declares: four read-only storage buffers.
#[must_use]
pub fn stored_runs_layout(binding: u32, visibility: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 4] {
    [0, 1, 2, 3].map(|offset| wgpu::BindGroupLayoutEntry {
        binding: binding + offset,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn ids_count_from_one_and_large_casters_take_several_slots() {
        let mut occluders = Occluders::default();
        let small = occluders.insert(3).expect("there is room");
        assert_eq!((small.first_id(), small.slots().len()), (1, 1));
        let large = occluders.insert(2 * SLOT_RUNS + 1).expect("there is room");
        assert_eq!((large.first_id(), large.slots().len()), (1 + SLOT_RUNS, 3));
        assert_eq!(large.runs_of_slots().collect::<Vec<_>>(), [(1, 0), (2, SLOT_RUNS), (3, 2 * SLOT_RUNS)]);
        assert_eq!(occluders.slot_count(), 4);
    }

    #[test]
    fn what_was_removed_is_given_away_after_the_next_frame() {
        let mut occluders = Occluders::default();
        let first = occluders.insert(1).expect("there is room");
        occluders.remove(first).expect("it is there");
        assert_ne!(occluders.insert(1).expect("there is room").first_id(), first.first_id());
        occluders.recycle();
        assert_eq!(occluders.insert(1).expect("there is room").first_id(), first.first_id());
    }

    #[test]
    fn a_slot_is_freed_once() {
        let mut occluders = Occluders::default();
        let first = occluders.insert(9).expect("there is room");
        assert_eq!(occluders.remove(first), Ok(()));
        let error = occluders.remove(first).expect_err("it is gone");
        assert_eq!(error, Error::UnknownOccluder { first: 0, last: 0 });
        assert!(error.to_string().contains("remove a caster once"), "{error}");
        occluders.recycle();
        assert!(occluders.remove(first).is_err());
    }

    #[test]
    fn more_runs_than_ids_are_refused() {
        let mut occluders = Occluders::default();
        let most = occluders.insert(SLOTS * SLOT_RUNS - 5).expect("all slots");
        assert_eq!((most.first_id(), most.slots().len()), (1, SLOTS as usize));
        let last_id = most.first_id() + (SLOTS * SLOT_RUNS - 1);
        assert_eq!(last_id, SLOTS * SLOT_RUNS, "ids fit 32 bits");
        let error = occluders.insert(1).expect_err("none is left");
        assert_eq!(error, Error::TooManyOccluders { runs: 1, needed: 1, free: 0, all: SLOTS });
        assert!(error.to_string().contains("0 of 1048575 are free"), "{error}");
    }

    #[test]
    fn runs_hold_eight_triangles_and_their_box() {
        let positions: Vec<[f32; 3]> = (0u8..51).map(|i| [f32::from(i), -f32::from(i), 1.0]).collect();
        let indices: Vec<u32> = (0..51).collect();
        let runs = stored_runs(&positions, &indices, 300);
        assert_eq!(runs.iter().map(|run| run.triangles).collect::<Vec<_>>(), [8, 8, 1]);
        assert_eq!(runs.iter().map(|run| run.first_index).collect::<Vec<_>>(), [300, 324, 348]);
        assert_eq!((runs[1].min, runs[1].max), ([24.0, -47.0, 1.0], [47.0, -24.0, 1.0]));
        assert!(stored_runs(&positions, &[], 0).is_empty());
    }

    proptest! {
        /// No slot has two owners, and none is lost.
        #[test]
        fn slots_have_one_owner(steps in prop::collection::vec((0u32..4, 1u32..3 * SLOT_RUNS), 1..200)) {
            let mut occluders = Occluders::default();
            let mut there: Vec<Occluder> = Vec::new();
            for (what, amount) in steps {
                match what {
                    0 | 1 => there.push(occluders.insert(amount).expect("there is room")),
                    2 if !there.is_empty() => {
                        let gone = there.swap_remove(amount as usize % there.len());
                        prop_assert_eq!(occluders.remove(gone), Ok(()));
                    }
                    _ => occluders.recycle(),
                }
                let mut slots: Vec<u32> = there.iter().flat_map(|one| one.slots()).collect();
                slots.extend(occluders.removed.iter().flat_map(|one| one.slots()));
                slots.extend(occluders.free.iter().flat_map(|(&first, &count)| first..first + count));
                slots.sort_unstable();
                prop_assert_eq!(slots, (0..occluders.end).collect::<Vec<_>>());
            }
        }
    }
}
