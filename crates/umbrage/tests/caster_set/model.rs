//! Whatever can be done to a set of casters, and a list that goes with it.

use std::collections::BTreeMap;

use glam::DVec3;
use proptest::prelude::*;
use umbrage::{Aabb, Caster, CasterHandle, CasterSet, Error, Layers, Motion};

/// 2^-14 m, by which a packed box is rounded outwards at most.
pub const STEP: f64 = 1.0 / 16_384.0;

/// Whatever can be done to a set.
#[derive(Clone, Debug)]
pub enum Edit {
    Insert(Caster),
    InsertAll(Vec<Caster>),
    Move(usize, Aabb),
    Replace(usize, Caster),
    SetMotion(usize, Motion),
    Remove(usize),
    Pack,
}

/// Boxes about `at`: small, flat, points, long, and some very far away.
pub fn bounds(at: DVec3) -> impl Strategy<Value = Aabb> {
    let size = || prop_oneof![6 => 0.05..6.0f64, 1 => Just(0.0), 1 => 20.0..600.0f64];
    let place = prop_oneof![
        8 => [-60.0..60.0f64, -1.0..10.0, -60.0..60.0],
        2 => [-900.0..900.0f64, -1.0..10.0, -900.0..900.0],
        1 => [-1e6..1e6f64, -10.0..1e3, -1e6..1e6],
    ];
    (place, [size(), size(), size()])
        .prop_map(move |(place, size)| Aabb::new(at + DVec3::from(place), at + DVec3::from(place) + DVec3::from(size)))
}

pub fn caster(at: DVec3) -> impl Strategy<Value = Caster> {
    let layers = prop_oneof![4 => Just(1u32), 1 => any::<u32>(), 1 => Just(0)].prop_map(Layers::from_bits);
    let motion = prop_oneof![3 => Just(Motion::Static), 1 => Just(Motion::Moving)];
    (bounds(at), layers, motion, prop::bool::weighted(0.9), prop::bool::weighted(0.9)).prop_map(
        |(bounds, layers, motion, casts, receives)| Caster {
            layers,
            motion,
            casts,
            receives,
            ..Caster::new(bounds, 0)
        },
    )
}

pub fn edit(at: DVec3) -> impl Strategy<Value = Edit> {
    let motion = prop_oneof![Just(Motion::Static), Just(Motion::Moving)];
    prop_oneof![
        4 => caster(at).prop_map(Edit::Insert),
        2 => prop::collection::vec(caster(at), 0..60).prop_map(Edit::InsertAll),
        4 => (any::<usize>(), bounds(at)).prop_map(|(which, bounds)| Edit::Move(which, bounds)),
        1 => (any::<usize>(), caster(at)).prop_map(|(which, caster)| Edit::Replace(which, caster)),
        1 => (any::<usize>(), motion).prop_map(|(which, motion)| Edit::SetMotion(which, motion)),
        3 => any::<usize>().prop_map(Edit::Remove),
        1 => Just(Edit::Pack),
    ]
}

/// A set and what it should hold.
#[derive(Default)]
pub struct Tracked {
    pub set: CasterSet,
    pub model: BTreeMap<CasterHandle, Caster>,
    pub removed: Vec<CasterHandle>,
    pub next_key: u32,
}

impl Tracked {
    /// Keys fall as often as they rise.
    pub fn key(&mut self) -> u32 {
        self.next_key += 1;
        self.next_key.wrapping_mul(0x9e37_79b9)
    }

    pub fn pick(&self, which: usize) -> Option<CasterHandle> {
        let at = which.checked_rem(self.model.len())?;
        self.model.keys().nth(at).copied()
    }

    pub fn apply(&mut self, edit: &Edit) {
        match edit {
            Edit::Insert(caster) => {
                let caster = Caster { key: self.key(), ..*caster };
                let handle = self.set.insert(caster).expect("valid");
                assert!(self.model.insert(handle, caster).is_none(), "{handle} is new");
            }
            Edit::InsertAll(casters) => {
                let casters: Vec<Caster> = casters.iter().map(|it| Caster { key: self.key(), ..*it }).collect();
                let handles = self.set.insert_all(casters.iter().copied()).expect("valid");
                self.model.extend(handles.into_iter().zip(casters));
            }
            Edit::Move(which, bounds) => {
                let Some(handle) = self.pick(*which) else { return };
                self.set.set_bounds(handle, *bounds).expect("there");
                self.model.get_mut(&handle).expect("there").bounds = *bounds;
            }
            Edit::Replace(which, caster) => {
                let Some(handle) = self.pick(*which) else { return };
                let caster = Caster { key: self.key(), ..*caster };
                self.set.replace(handle, caster).expect("there");
                self.model.insert(handle, caster);
            }
            Edit::SetMotion(which, motion) => {
                let Some(handle) = self.pick(*which) else { return };
                self.set.set_motion(handle, *motion).expect("there");
                self.model.get_mut(&handle).expect("there").motion = *motion;
            }
            Edit::Remove(which) => {
                let Some(handle) = self.pick(*which) else { return };
                self.set.remove(handle).expect("there");
                self.model.remove(&handle);
                self.removed.push(handle);
            }
            Edit::Pack => self.set.pack(),
        }
    }

    /// That the set holds what it should.
    pub fn check(&self) {
        assert_eq!(self.set.len(), self.model.len());
        assert_eq!(self.set.is_empty(), self.model.is_empty());
        let kept: BTreeMap<CasterHandle, Caster> = self.set.iter().collect();
        assert!(kept.keys().eq(self.model.keys()), "handles");
        for (handle, caster) in &self.model {
            let found = self.set.get(*handle).expect("there");
            assert_eq!(found.bounds, self.set.bounds(*handle).expect("there"));
            assert_eq!(Caster { bounds: caster.bounds, ..found }, *caster);
            let (given, kept) = (caster.bounds, found.bounds);
            assert_eq!(kept.union(given), kept, "{handle} {given:?} lies in {kept:?}");
            let grown = (given.min - kept.min).max(kept.max - given.max).max_element();
            assert!(grown < STEP, "{handle} grew by {grown} m");
        }
        for &handle in &self.removed {
            assert_eq!(self.set.bounds(handle), Err(Error::RemovedCaster { handle }));
        }
    }
}
