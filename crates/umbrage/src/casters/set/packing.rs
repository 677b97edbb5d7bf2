//! Packing: casters that are kept one by one, or not yet kept, become runs.

use super::CasterSet;
use crate::Aabb;
use crate::casters::curve::Curve;
use crate::casters::kind::Kinds;
use crate::casters::loose::Entry;
use crate::casters::packed::{Packing, RUN, Run};
use crate::casters::slots::{MOST_LANES, MOST_RUNS, PackedPlace, Place};

impl CasterSet {
    /// Packs the remaining casters of a run again.
    pub(super) fn pack_rest(&mut self, number: u32) {
        let Some(run) = self.runs[number as usize].take() else { return };
        let rest = |lane: u32| {
            let ((key, kind), bounds) = (run.about(lane), run.bounds(lane));
            (lane, Entry { bounds, code: 0, key, slot: 0, kind, moves: false, is_due: true })
        };
        let mut rest: Vec<(u32, Entry)> = run.places().map(rest).collect();
        // Lanes do not know their slots: slots know their lanes.
        let mut slot_of = vec![u32::MAX; MOST_LANES];
        for slot in self.slots.iter() {
            if let Place::Packed(place) = self.slots.get(slot)
                && place.run == number
            {
                slot_of[place.lane as usize] = slot;
            }
        }
        rest.iter_mut().for_each(|(lane, entry)| entry.slot = slot_of[*lane as usize]);
        let rest: Vec<Entry> = rest.into_iter().map(|(_, entry)| entry).collect();
        self.pack_entries(&rest);
    }

    /// Packs casters that are kept nowhere yet.
    pub(super) fn pack_entries(&mut self, entries: &[Entry]) {
        let bounds = entries.iter().fold(Aabb::EMPTY, |all, entry| all.including(entry.bounds.center()));
        let curve = Curve::through(bounds);
        let mut packing: Vec<Packing> = map_all(entries, |&Entry { bounds, key, kind, slot, .. }| Packing {
            code: curve.code(bounds.center()),
            bounds,
            key,
            kind,
            slot,
        });
        sort(&mut packing);
        let chunks: Vec<&[Packing]> = packing.chunks(RUN).collect();
        let built = map_all(&chunks, |chunk| runs_of(chunk, &self.kinds));
        for (run, slots) in built.into_iter().flatten() {
            self.add_run(run, slots);
        }
    }

    /// Keeps the casters of a run one by one, for good.
    fn keep_loose(&mut self, run: &Run, slots: &[(u32, u32)]) {
        for &(slot, lane) in slots {
            let (key, kind) = run.about(lane);
            let bounds = run.bounds(lane);
            let at = self.loose.push(Entry { bounds, code: 0, key, slot, kind, moves: false, is_due: false });
            self.slots.set(slot, Place::Loose(at));
        }
    }

    fn add_run(&mut self, run: Run, slots: Vec<(u32, u32)>) {
        let number = self.runs.iter().position(Option::is_none).unwrap_or(self.runs.len());
        if number == MOST_RUNS {
            // Only millions of casters that lie hundreds of metres apart need so many.
            return self.keep_loose(&run, &slots);
        }
        for (slot, lane) in slots {
            self.slots.set(slot, Place::Packed(PackedPlace { run: number as u32, lane }));
        }
        if number == self.runs.len() {
            self.runs.push(None);
        }
        self.runs[number] = Some(run);
    }
}

/// A run, and the lane of each of its slots.
type Built = (Run, Vec<(u32, u32)>);

/// Runs of casters in the order of their codes: one, or several where they lie far apart.
fn runs_of(casters: &[Packing], kinds: &Kinds) -> Vec<Built> {
    if let Some((run, places)) = Run::new(casters, kinds) {
        let slots = casters.iter().map(|caster| caster.slot).zip(places).collect();
        return vec![(run, slots)];
    }
    let (first, second) = casters.split_at(casters.len() / 2);
    [first, second].into_iter().flat_map(|half| runs_of(half, kinds)).collect()
}

#[cfg(feature = "rayon")]
pub(super) fn map_all<T: Sync, U: Send>(items: &[T], map: impl Fn(&T) -> U + Sync + Send) -> Vec<U> {
    use rayon::prelude::*;
    items.par_iter().map(map).collect()
}

#[cfg(not(feature = "rayon"))]
pub(super) fn map_all<T, U>(items: &[T], map: impl Fn(&T) -> U) -> Vec<U> {
    items.iter().map(map).collect()
}

#[cfg(feature = "rayon")]
pub(super) fn sort(packing: &mut [Packing]) {
    use rayon::prelude::*;
    packing.par_sort_unstable_by_key(|caster| (caster.code, caster.slot));
}

#[cfg(not(feature = "rayon"))]
pub(super) fn sort(packing: &mut [Packing]) {
    packing.sort_unstable_by_key(|caster| (caster.code, caster.slot));
}
