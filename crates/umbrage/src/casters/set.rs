//! The set of casters and its public methods.

mod changes;
mod packing;
mod query;

use std::sync::atomic::{AtomicU64, Ordering};

use super::journal::Journal;
use super::kind::{Kind, Kinds, Layers};
use super::loose::{Entry, Loose};
use super::packed::{RUN, Run, on_lattice};
use super::slots::{CasterHandle, PackedPlace, Place, Slots};
use crate::{Aabb, Error, Result};

/// Expected motion of a caster: static or moving.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// The caster stays in place for a long time: a building, a tree, a piece of ground. Moving it
    /// is still allowed.
    #[default]
    Static,
    /// The caster moves in many frames: a vehicle, a walker, a door.
    Moving,
}

/// A caster or receiver of a [`CasterSet`].
///
/// ```
/// # use umbrage::{Aabb, Caster, Layers, Motion};
/// # use umbrage::glam::DVec3;
/// let tree = Caster::new(Aabb::new(DVec3::ZERO, DVec3::new(4.0, 12.0, 4.0)), 7);
/// let bird = Caster { motion: Motion::Moving, receives: false, ..tree };
/// let unseen = Caster { layers: Layers::one(3)?, ..tree };
/// # Ok::<(), umbrage::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caster {
    /// Bounding box in world metres.
    pub bounds: Aabb,
    /// Name of the caster in plans, for example the index of the object in the application's own
    /// list. Casters that share a key are drawn as one: lists contain the key once.
    pub key: u32,
    /// Expected motion.
    pub motion: Motion,
    /// Layers that the caster is on: see [`crate::PlanInputs::layers`].
    pub layers: Layers,
    /// True if the caster casts shadows.
    pub casts: bool,
    /// True if the caster shows shadows: it counts where the set is given as receivers.
    pub receives: bool,
}

impl Caster {
    /// A static caster on the first layer that casts shadows and shows them.
    #[must_use]
    pub fn new(bounds: impl Into<Aabb>, key: u32) -> Self {
        let (motion, layers) = (Motion::Static, Layers::default());
        Self { bounds: bounds.into(), key, motion, layers, casts: true, receives: true }
    }

    fn kind(&self) -> Kind {
        Kind { layers: self.layers, casts: self.casts, receives: self.receives }
    }
}

/// Casters and receivers by the million, kept from frame to frame.
///
/// A planner that is given lists looks at every box in every frame. A set keeps the boxes in trees,
/// and the planner looks only at relevant boxes: the cost of a plan follows from the part of the
/// world in view, not from the size of the world.
///
/// ```
/// use umbrage::{Aabb, Caster, CasterSet, DirectionalLight, Frustum, Motion, PlanInputs, Planner, ShadowConfig, View};
/// # use umbrage::glam::DVec3;
/// let tree = |i: u32| {
///     let corner = DVec3::new(f64::from(i % 1000) * 10.0, 0.0, f64::from(i / 1000) * 10.0);
///     Caster::new(Aabb::new(corner, corner + DVec3::new(4.0, 12.0, 4.0)), i)
/// };
/// let mut forest = CasterSet::new();
/// forest.insert_all((0..20_000).map(tree))?;
/// let car = Caster { motion: Motion::Moving, ..tree(20_000) };
/// let car = forest.insert(car)?;
///
/// let frustum = Frustum::perspective(1.0, 1.5, 0.1, 500.0)?;
/// let view = View::look_at_upright(DVec3::new(50.0, 10.0, 50.0), DVec3::new(90.0, 0.0, 90.0), frustum)?;
/// let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
/// let mut planner = Planner::new(&ShadowConfig::default())?;
/// forest.set_bounds(car, Aabb::new(DVec3::splat(60.0), DVec3::splat(62.0)))?;
/// let plan = planner.plan_frame(&PlanInputs::new(&view, sun, &forest, &forest))?;
/// // Keys, rising, of the casters to draw into the map of the first split.
/// println!("{:?}", plan.casters(0));
/// # Ok::<(), umbrage::Error>(())
/// ```
///
/// # Plans
///
/// A plan from a set equals the plan from the list of its boxes, [`CasterSet::bounds`], in the
/// order of their keys, bit for bit. It does not depend on the order of insertion. Its lists
/// contain keys.
///
/// # Memory per caster
///
/// A static box is kept in 18 bytes: rounded outwards to 2^-14 m (0.06 mm), on a lattice that is as
/// fine 100 km from the world's origin as there. With handle, key and tree that is 32 bytes per
/// caster, at ten or more casters per square kilometre. Boxes that move, that are longer than
/// 256 m, that are flat or that lie farther away than 17 million kilometres are kept as they are
/// given, in some 250 bytes.
///
/// # Speed
///
/// * [`CasterSet::insert_all`] packs all casters that it is given in the best order. Fill a set by
///   it while a level is loaded, and tile by tile where a world is streamed.
/// * Casters that come one by one are packed 16,384 at a time, which takes some ten milliseconds.
///   [`CasterSet::pack`] puts everything in the best order again.
/// * Moving a caster costs some tens of nanoseconds, plus its share of fitting the tree of all
///   moving casters.
/// * A static caster that is moved a little is changed in place; one that is moved far is packed
///   again later.
///
/// With the feature `rayon`, packing uses all cores.
#[derive(Debug)]
pub struct CasterSet {
    slots: Slots,
    kinds: Kinds,
    /// Runs of packed casters; empty ones keep their number.
    runs: Vec<Option<Run>>,
    loose: Loose,
    len: usize,
    /// Identity of the set, and number of its changes: sets that agree in both have the same
    /// contents.
    identity: u64,
    revision: u64,
    /// Changes of static casters.
    journal: Journal,
    /// Number of times that casters have come, gone or changed their motion.
    membership: u64,
}

impl Default for CasterSet {
    fn default() -> Self {
        Self {
            slots: Slots::default(),
            kinds: Kinds::default(),
            runs: Vec::new(),
            loose: Loose::default(),
            len: 0,
            identity: new_identity(),
            revision: 0,
            journal: Journal::default(),
            membership: 0,
        }
    }
}

impl Clone for CasterSet {
    fn clone(&self) -> Self {
        Self {
            slots: self.slots.clone(),
            kinds: self.kinds.clone(),
            runs: self.runs.clone(),
            loose: self.loose.clone(),
            identity: new_identity(),
            journal: self.journal.clone(),
            ..*self
        }
    }
}

/// A number that no other set has.
fn new_identity() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl CasterSet {
    /// An empty set.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of casters.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether the set has no caster.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Adds a caster and returns its handle, which names it until it is removed.
    ///
    /// # Errors
    /// [`Error::InvalidCaster`] naming its key if its box is inverted, NaN or beyond 10^12 m;
    /// [`Error::TooManyCasters`]; [`Error::TooManyCasterKinds`]. Nothing has changed then.
    pub fn insert(&mut self, caster: Caster) -> Result<CasterHandle> {
        check(caster.bounds, None, caster.key)?;
        let kind = self.kinds.number(caster.kind())?;
        let handle = self.slots.insert(Place::Loose(self.loose.entries.len() as u32))?;
        let slot = self.slots.index(handle)?;
        self.loose.push(entry(&caster, kind, slot));
        self.len += 1;
        self.note(slot, None);
        self.changed();
        Ok(handle)
    }

    /// Adds many casters and packs the static ones together. Returns their handles in the same
    /// order.
    ///
    /// # Errors
    /// Those of [`CasterSet::insert`]. Nothing has changed then.
    pub fn insert_all(&mut self, casters: impl IntoIterator<Item = Caster>) -> Result<Vec<CasterHandle>> {
        let casters: Vec<Caster> = casters.into_iter().collect();
        casters.iter().try_for_each(|caster| check(caster.bounds, None, caster.key))?;
        let mut kinds = self.kinds.clone();
        let numbers = casters.iter().map(|caster| kinds.number(caster.kind())).collect::<Result<Vec<_>>>()?;
        self.slots.check_room(casters.len())?;
        self.kinds = kinds;
        self.slots.reserve(casters.len());
        let (mut handles, mut packing) = (Vec::with_capacity(casters.len()), Vec::new());
        for (caster, kind) in casters.iter().zip(numbers) {
            let handle = self.slots.insert(Place::Loose(self.loose.entries.len() as u32))?;
            let slot = self.slots.index(handle)?;
            let entry = entry(caster, kind, slot);
            if entry.is_due {
                packing.push(entry);
            } else {
                self.loose.push(entry);
            }
            handles.push(handle);
        }
        self.len += casters.len();
        self.pack_entries(&packing);
        self.note_all(&handles);
        self.changed();
        Ok(handles)
    }

    /// Moves a caster.
    ///
    /// # Errors
    /// [`Error::InvalidCaster`] naming the handle if the box is inverted, NaN or beyond 10^12 m;
    /// [`Error::RemovedCaster`]. Nothing has changed then.
    pub fn set_bounds(&mut self, handle: CasterHandle, bounds: impl Into<Aabb>) -> Result<()> {
        let bounds = bounds.into();
        let slot = self.slots.index(handle)?;
        let (key, kind) = self.about(slot);
        check(bounds, Some(handle), key)?;
        let before = self.static_bounds(slot);
        match self.slots.get(slot) {
            Place::Loose(at) => {
                let moves = self.loose.entries[at as usize].moves;
                let lattice = on_lattice(bounds).filter(|_| !moves);
                self.loose.set(at, lattice.unwrap_or(bounds), lattice.is_some());
            }
            Place::Packed(PackedPlace { run, lane }) => {
                let lattice = on_lattice(bounds);
                let layers = self.kinds.get(kind).layers;
                let run = self.runs[run as usize].as_mut();
                let fits = lattice.zip(run).is_some_and(|(bounds, run)| run.set(lane, bounds, layers));
                if !fits {
                    self.loosen(slot, &|caster| caster.bounds = bounds);
                }
            }
        }
        if before.is_some() && before != self.static_bounds(slot) {
            self.note_static(slot, before);
        }
        self.changed();
        Ok(())
    }

    /// Replaces a caster by another under the same handle.
    ///
    /// # Errors
    /// Those of [`CasterSet::set_bounds`] and [`CasterSet::insert`]. Nothing has changed then.
    pub fn replace(&mut self, handle: CasterHandle, caster: Caster) -> Result<()> {
        let slot = self.slots.index(handle)?;
        check(caster.bounds, Some(handle), caster.key)?;
        let kind = self.kinds.number(caster.kind())?;
        self.note_end(slot);
        self.unplace(slot);
        let at = self.loose.push(entry(&caster, kind, slot));
        self.slots.set(slot, Place::Loose(at));
        self.note(slot, None);
        self.changed();
        Ok(())
    }

    /// Sets whether a caster is expected to move from now on.
    ///
    /// # Errors
    /// [`Error::RemovedCaster`].
    pub fn set_motion(&mut self, handle: CasterHandle, motion: Motion) -> Result<()> {
        let slot = self.slots.index(handle)?;
        if self.caster(slot).motion != motion {
            let before = self.static_bounds(slot);
            self.loosen(slot, &|caster| caster.motion = motion);
            self.note(slot, before);
            self.changed();
        }
        Ok(())
    }

    /// Removes a caster. Its handle is invalid from now on.
    ///
    /// # Errors
    /// [`Error::RemovedCaster`].
    pub fn remove(&mut self, handle: CasterHandle) -> Result<()> {
        let slot = self.slots.index(handle)?;
        self.note_end(slot);
        self.unplace(slot);
        self.slots.remove(slot);
        self.len -= 1;
        self.changed();
        Ok(())
    }

    /// Removes all casters.
    pub fn clear(&mut self) {
        let taken: Vec<u32> = self.slots.iter().collect();
        taken.into_iter().for_each(|slot| self.slots.remove(slot));
        (self.runs, self.loose, self.len) = (Vec::new(), Loose::default(), 0);
        self.journal.note_too_many();
        self.membership += 1;
        self.revision += 1;
    }

    /// The box that is kept for a caster: the given one, rounded outwards by 0.06 mm at most.
    ///
    /// # Errors
    /// [`Error::RemovedCaster`].
    pub fn bounds(&self, handle: CasterHandle) -> Result<Aabb> {
        Ok(self.caster(self.slots.index(handle)?).bounds)
    }

    /// A caster as it is kept.
    ///
    /// # Errors
    /// [`Error::RemovedCaster`].
    pub fn get(&self, handle: CasterHandle) -> Result<Caster> {
        Ok(self.caster(self.slots.index(handle)?))
    }

    /// Returns whether a handle names a caster.
    #[must_use]
    pub fn contains(&self, handle: CasterHandle) -> bool {
        self.slots.index(handle).is_ok()
    }

    /// All casters as they are kept, in the order of their handles.
    pub fn iter(&self) -> impl Iterator<Item = (CasterHandle, Caster)> + '_ {
        self.slots.iter().map(|slot| (self.slots.handle(slot), self.caster(slot)))
    }

    /// Packs all static casters again, in the best order. A million take about a second of one
    /// core.
    pub fn pack(&mut self) {
        let mut packing = self.loose.take_due();
        self.tell_loose();
        for slot in self.slots.iter() {
            if let Place::Packed(_) = self.slots.get(slot) {
                packing.push(entry(&self.caster(slot), self.about(slot).1, slot));
            }
        }
        self.loose.shrink();
        self.runs.clear();
        self.pack_entries(&packing);
        self.revision += 1;
    }

    /// Memory of the set in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        let runs = self.runs.iter().flatten().map(Run::bytes).sum::<usize>();
        let table = self.runs.capacity() * size_of::<Option<Run>>();
        size_of::<Self>()
            + self.slots.bytes()
            + self.kinds.bytes()
            + runs
            + table
            + self.loose.bytes()
            + self.journal.bytes()
    }

    /// Stamp of the contents: sets with equal stamps have the same contents.
    pub(crate) fn stamp(&self) -> (u64, u64) {
        (self.identity, self.revision)
    }

    pub(super) fn parts(&self) -> (&[Option<Run>], &Loose, &Kinds) {
        (&self.runs, &self.loose, &self.kinds)
    }

    /// Key and kind of a caster.
    fn about(&self, slot: u32) -> (u32, u16) {
        match self.slots.get(slot) {
            Place::Loose(at) => (self.loose.entries[at as usize].key, self.loose.entries[at as usize].kind),
            Place::Packed(PackedPlace { run, lane }) => {
                self.runs[run as usize].as_ref().map_or((0, 0), |run| run.about(lane))
            }
        }
    }

    fn caster(&self, slot: u32) -> Caster {
        let (key, kind) = self.about(slot);
        let Kind { layers, casts, receives } = self.kinds.get(kind);
        let (bounds, motion) = match self.slots.get(slot) {
            Place::Loose(at) => {
                let Entry { bounds, moves, .. } = self.loose.entries[at as usize];
                (bounds, if moves { Motion::Moving } else { Motion::Static })
            }
            Place::Packed(PackedPlace { run, lane }) => {
                let bounds = self.runs[run as usize].as_ref().map_or(Aabb::EMPTY, |run| run.bounds(lane));
                (bounds, Motion::Static)
            }
        };
        Caster { bounds, key, motion, layers, casts, receives }
    }

    /// Changes a caster and keeps it among the loose ones.
    fn loosen(&mut self, slot: u32, change: &dyn Fn(&mut Caster)) {
        let (_, kind) = self.about(slot);
        let mut caster = self.caster(slot);
        change(&mut caster);
        self.unplace(slot);
        let at = self.loose.push(entry(&caster, kind, slot));
        self.slots.set(slot, Place::Loose(at));
    }

    /// Removes a caster from the place where it is kept.
    fn unplace(&mut self, slot: u32) {
        match self.slots.get(slot) {
            Place::Loose(at) => {
                if let Some(moved) = self.loose.remove(at) {
                    self.slots.set(moved, Place::Loose(at));
                }
            }
            Place::Packed(PackedPlace { run: number, lane }) => {
                let Some(run) = &mut self.runs[number as usize] else { return };
                run.remove(lane);
                if 2 * run.live < run.built {
                    self.pack_rest(number);
                }
            }
        }
    }

    /// Called after a change: fits and packs casters if it is time for that.
    fn changed(&mut self) {
        self.revision += 1;
        if self.loose.due >= RUN {
            let due = self.loose.take_due();
            self.tell_loose();
            self.pack_entries(&due);
        } else if self.loose.settle() {
            self.tell_loose();
        }
    }

    /// Writes the places of the loose casters into the slots.
    fn tell_loose(&mut self) {
        for (at, entry) in self.loose.entries.iter().enumerate() {
            self.slots.set(entry.slot, Place::Loose(at as u32));
        }
    }
}

fn entry(caster: &Caster, kind: u16, slot: u32) -> Entry {
    let moves = caster.motion == Motion::Moving;
    let lattice = on_lattice(caster.bounds).filter(|_| !moves);
    let bounds = lattice.unwrap_or(caster.bounds);
    Entry { bounds, code: 0, key: caster.key, slot, kind, moves, is_due: lattice.is_some() }
}

fn check(bounds: Aabb, handle: Option<CasterHandle>, key: u32) -> Result<()> {
    if bounds.is_accepted() {
        return Ok(());
    }
    Err(Error::InvalidCaster { handle, key, min: bounds.min, max: bounds.max })
}
