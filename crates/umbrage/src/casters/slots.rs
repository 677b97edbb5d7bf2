//! Handles that stay while places change.

use std::fmt;

use crate::{Error, Result};

/// Names a caster of a [`crate::CasterSet`] until it is removed. A handle of a removed caster never
/// names another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CasterHandle {
    index: u32,
    generation: u8,
}

impl fmt::Display for CasterHandle {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}v{}", self.index, self.generation)
    }
}

/// Place where a caster is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Among the loose casters, at this index.
    Loose(u32),
    /// In a run.
    Packed(PackedPlace),
}

/// A place in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PackedPlace {
    pub run: u32,
    /// 16 times the leaf, plus the lane.
    pub lane: u32,
}

/// Bits of [`PackedPlace::lane`].
const LANE_BITS: u32 = 15;

/// Places in a run, at most.
pub(super) const MOST_LANES: usize = 1 << LANE_BITS;

/// Most runs of a set.
pub(super) const MOST_RUNS: usize = 1 << (31 - LANE_BITS);

/// Most casters of a set: even if none fills a leaf, the runs have room for so many.
const MOST_CASTERS: usize = 1 << 26;

const LOOSE: u32 = 1 << 31;
const NOBODY: u32 = u32::MAX;

/// Table from handles to places: five bytes each.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    /// Places; for a free slot, the next free one.
    places: Vec<u32>,
    /// Generations; [`RETIRED`] for a slot whose generations are used up.
    generations: Vec<u8>,
    /// One bit for each slot, set if the slot is taken.
    taken: Vec<u64>,
    free: u32,
}

/// Generation of a slot that is used no more: its next handle would be one that has been given out.
const RETIRED: u8 = u8::MAX;

impl Default for Slots {
    fn default() -> Self {
        Self { places: Vec::new(), generations: Vec::new(), taken: Vec::new(), free: NOBODY }
    }
}

impl Slots {
    pub fn insert(&mut self, place: Place) -> Result<CasterHandle> {
        let index = if self.free == NOBODY {
            let index = self.places.len();
            self.check_room(1)?;
            grow(&mut self.places, 0);
            grow(&mut self.generations, 0);
            if index.is_multiple_of(64) {
                self.taken.push(0);
            }
            index as u32
        } else {
            let index = self.free;
            self.free = self.places[index as usize];
            index
        };
        self.taken[index as usize / 64] |= 1 << (index % 64);
        self.set(index, place);
        Ok(CasterHandle { index, generation: self.generations[index as usize] })
    }

    /// Checks that there are handles for `more` more casters.
    pub fn check_room(&self, more: usize) -> Result<()> {
        let room = MOST_CASTERS - self.places.len();
        if more <= room { Ok(()) } else { Err(Error::TooManyCasters) }
    }

    /// The slot of a caster that has not been removed.
    pub fn index(&self, handle: CasterHandle) -> Result<u32> {
        let index = handle.index as usize;
        let is_there = self.generations.get(index) == Some(&handle.generation) && self.is_taken(handle.index);
        if is_there { Ok(handle.index) } else { Err(Error::RemovedCaster { handle }) }
    }

    pub fn handle(&self, index: u32) -> CasterHandle {
        CasterHandle { index, generation: self.generations[index as usize] }
    }

    fn is_taken(&self, index: u32) -> bool {
        self.taken[index as usize / 64] >> (index % 64) & 1 == 1
    }

    pub fn get(&self, index: u32) -> Place {
        let place = self.places[index as usize];
        if place & LOOSE != 0 {
            return Place::Loose(place & !LOOSE);
        }
        Place::Packed(PackedPlace { run: place >> LANE_BITS, lane: place & (MOST_LANES as u32 - 1) })
    }

    pub fn set(&mut self, index: u32, place: Place) {
        self.places[index as usize] = match place {
            Place::Loose(at) => LOOSE | at,
            Place::Packed(PackedPlace { run, lane }) => run << LANE_BITS | lane,
        };
    }

    pub fn remove(&mut self, index: u32) {
        let at = index as usize;
        self.taken[at / 64] &= !(1 << (index % 64));
        self.generations[at] += 1;
        if self.generations[at] == RETIRED {
            return;
        }
        self.places[at] = self.free;
        self.free = index;
    }

    /// The slots that are taken.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.places.len() as u32).filter(|&index| self.is_taken(index))
    }

    pub fn reserve(&mut self, more: usize) {
        self.places.reserve_exact(more);
        self.generations.reserve_exact(more);
    }

    pub fn bytes(&self) -> usize {
        4 * self.places.capacity() + self.generations.capacity() + 8 * self.taken.capacity()
    }
}

/// Pushes onto a list that grows by an eighth: doubling would leave up to half of it unused.
fn grow<T>(list: &mut Vec<T>, value: T) {
    if list.len() == list.capacity() {
        list.reserve_exact(list.len() / 8 + 64);
    }
    list.push(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_handle_names_two_casters() {
        let mut slots = Slots::default();
        let mut seen = std::collections::HashSet::new();
        for round in 0..2000 {
            let handle = slots.insert(Place::Loose(round)).expect("room");
            assert!(seen.insert(handle), "{handle} names a second caster");
            assert_eq!(slots.get(slots.index(handle).expect("there")), Place::Loose(round));
            slots.remove(handle.index);
            assert_eq!(slots.index(handle), Err(Error::RemovedCaster { handle }));
        }
        assert!(slots.places.len() < 10, "slots are used again");
    }

    #[test]
    fn places_are_read_as_they_were_written() {
        let mut slots = Slots::default();
        for place in [Place::Loose(0), Place::Loose(LOOSE - 2)].into_iter().chain(
            [(0, 0), (MOST_RUNS as u32 - 1, MOST_LANES as u32 - 1)]
                .map(|(run, lane)| Place::Packed(PackedPlace { run, lane })),
        ) {
            let handle = slots.insert(place).expect("room");
            assert_eq!(slots.get(handle.index), place);
        }
    }
}
