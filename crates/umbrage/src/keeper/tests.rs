//! The keeper compared with a model that draws: a texture holds what should be drawn there.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::{Area, Keeper, KeptFrame};
use crate::bounds::Placed;
use crate::config::{Cache, Preset, Range};
use crate::{
    Aabb, Caster, CasterHandle, CasterSet, DirectionalLight, Frustum, Layers, Motion, PlanInputs, Planner,
    ShadowConfig, ShadowPlan, View,
};

/// Random numbers that are the same in every run.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn bounds(&mut self) -> Aabb {
        let at = DVec3::new(self.between(-60.0, 60.0), 0.0, self.between(-60.0, 60.0));
        let size = if self.below(20) == 0 { 30.0 } else { 3.0 };
        Aabb::new(at, at + DVec3::new(self.between(0.1, size), self.between(0.1, 6.0), self.between(0.1, size)))
    }
}

/// Drawn casters by key, each with its version at that time.
type Drawn = BTreeMap<u32, u32>;

/// A caster of the model.
#[derive(Clone, Copy, Debug)]
struct Known {
    key: u32,
    version: u32,
}

/// A world, its keeper, and the model of the textures.
struct Stage {
    dice: Dice,
    set: CasterSet,
    known: BTreeMap<CasterHandle, Known>,
    next_key: u32,
    planner: Planner,
    plan: ShadowPlan,
    keeper: Keeper,
    /// Contents by split and place in the texture, in cells.
    textures: BTreeMap<(usize, [i64; 2]), Drawn>,
    /// Contents of each map, cell by cell, and its position.
    maps: BTreeMap<usize, (Area, Vec<Drawn>)>,
    eye: DVec3,
    turn: f64,
    sun: DVec3,
    origin: DVec3,
    /// True if a caster's shape changes without the set being told.
    lies: bool,
    /// All casters of this frame.
    census: Vec<Counted>,
}

/// A caster in one frame.
#[derive(Clone, Copy, Debug)]
struct Counted {
    known: Known,
    placed: Placed,
    /// True if the caster's shadow is kept.
    rests: bool,
}

const SIZES: [u32; 3] = [64, 100, 128];

impl Stage {
    fn new(seed: u64, lies: bool) -> Self {
        let range = Range::Metres { near: 1.0, far: 80.0 };
        let config = ShadowConfig { cache: Cache::Kept, map_sizes: SIZES.to_vec(), range, ..Preset::Papers.config() };
        let (mut set, mut dice) = (CasterSet::new(), Dice(seed));
        let ground = Aabb::new(DVec3::new(-90.0, -1.0, -90.0), DVec3::new(90.0, 0.0, 90.0));
        let ground = Caster { casts: false, ..Caster::new(ground, u32::MAX) };
        set.insert(ground).expect("a box");
        let boxes: Vec<Caster> = (0..300).map(|key| Caster::new(dice.bounds(), key)).collect();
        let handles = set.insert_all(boxes).expect("boxes");
        let known = handles.into_iter().zip(0..).map(|(handle, key)| (handle, Known { key, version: 0 })).collect();
        Self {
            dice,
            set,
            known,
            next_key: 300,
            planner: Planner::new(&config).expect("a config"),
            plan: ShadowPlan::default(),
            keeper: Keeper::new(&SIZES),
            textures: BTreeMap::new(),
            maps: BTreeMap::new(),
            eye: DVec3::new(0.0, 2.0, 0.0),
            turn: 0.0,
            sun: DVec3::new(0.4, -1.0, 0.3),
            origin: DVec3::ZERO,
            lies,
            census: Vec::new(),
        }
    }

    fn pick(&mut self) -> Option<CasterHandle> {
        let at = self.dice.below(self.known.len().max(1) as u64) as usize;
        self.known.keys().nth(at).copied()
    }

    fn insert(&mut self) {
        let (key, bounds) = (self.next_key, self.dice.bounds());
        let motion = if self.dice.below(4) == 0 { Motion::Moving } else { Motion::Static };
        let handle = self.set.insert(Caster { motion, ..Caster::new(bounds, key) }).expect("a box");
        self.known.insert(handle, Known { key, version: 0 });
        self.next_key += 1;
    }

    /// Makes a random change to the set.
    fn edit(&mut self) {
        let Some(handle) = self.pick() else { return self.insert() };
        let is_crowded = self.known.len() > 320;
        let known = self.known.get_mut(&handle).expect("it is there");
        known.version += 1;
        let caster = self.set.get(handle).expect("it is there");
        match self.dice.below(12) {
            0..=2 => {
                let step = DVec3::new(self.dice.between(-1.0, 1.0), 0.0, self.dice.between(-1.0, 1.0));
                let bounds = Aabb::new(caster.bounds.min + step, caster.bounds.max + step);
                self.set.set_bounds(handle, bounds).expect("a box");
            }
            3 => self.set.set_bounds(handle, self.dice.bounds()).expect("a box"),
            4..=7 if is_crowded => {
                self.set.remove(handle).expect("it is there");
                self.known.remove(&handle);
            }
            4 | 5 => {
                self.set.remove(handle).expect("it is there");
                self.known.remove(&handle);
            }
            6 if self.lies => {}
            6 => self.set.reshape(handle).expect("it is there"),
            7 => {
                let motion = if caster.motion == Motion::Static { Motion::Moving } else { Motion::Static };
                self.set.set_motion(handle, motion).expect("it is there");
            }
            8 => {
                let other = Caster { bounds: self.dice.bounds(), ..caster };
                self.set.replace(handle, other).expect("a box");
            }
            _ => {
                known.version -= 1;
                self.insert();
            }
        }
    }

    /// Moves the eye, now and then the sun and the origin.
    fn travel(&mut self) {
        match self.dice.below(60) {
            0 => self.eye = DVec3::new(self.dice.between(-50.0, 50.0), 2.0, self.dice.between(-50.0, 50.0)),
            1 => self.sun.x = self.dice.between(-1.0, 1.0),
            2 => self.origin = (self.eye / 16.0).round() * 16.0,
            3..=20 => {}
            21..=40 => self.turn += self.dice.between(-0.05, 0.05),
            _ => self.eye += 0.3 * DVec3::new(self.turn.sin(), 0.0, self.turn.cos()),
        }
    }

    fn frame(&mut self, budget: Option<u64>) -> Result<(), String> {
        let frustum = Frustum::perspective(0.9, 1.3, 0.5, 200.0).expect("a lens");
        let target = self.eye + DVec3::new(self.turn.sin(), -0.1, self.turn.cos());
        let view = View::look_at_upright(self.eye, target, frustum).expect("a view");
        let sun = DirectionalLight::new(self.sun).expect("a direction");
        let inputs = PlanInputs::new(&view, sun, &self.set, &self.set);
        self.planner.plan_into(&inputs, &mut self.plan).expect("a plan");
        let wanted: Vec<BTreeSet<u32>> = (0..3).map(|i| self.plan.casters(i).iter().copied().collect()).collect();
        let (set, layers, origin) = (&self.set, Layers::ALL, self.origin);
        let frame = KeptFrame { set, layers, origin, budget, drops_small: false, redraws: false };
        self.keeper.prepare(&frame, &mut self.plan);
        self.count();
        self.draw();
        self.check(&wanted)?;
        self.keeper.accept();
        Ok(())
    }

    /// Contents that a cell should have: static casters that rest, in their present version.
    fn drawn_in(&self, split: usize, cell: [i64; 2], among: Option<&[u32]>) -> Drawn {
        let kept = &self.keeper.books[split];
        let texels = kept.books.texels(&Area::square(cell, 1));
        let split = &self.plan.splits[split];
        let axes = [split.u_axis / split.texel_m.x, split.v_axis / split.texel_m.y];
        let overlaps = |placed: &Placed| {
            (0..2).all(|k| {
                let (at, reach) = (axes[k].dot(placed.center), axes[k].abs().dot(placed.half));
                at + reach > texels.min[k] as f64 && at - reach < texels.max[k] as f64
            })
        };
        let mut drawn = Drawn::new();
        for Counted { known, placed, rests } in &self.census {
            let is_drawn = among.map_or(*rests, |keys| keys.binary_search(&known.key).is_ok());
            if is_drawn && overlaps(placed) {
                drawn.insert(known.key, known.version);
            }
        }
        drawn
    }

    /// Looks at all casters.
    fn count(&mut self) {
        self.census.clear();
        for (handle, &known) in &self.known {
            let caster = self.set.get(*handle).expect("it is there");
            let rests = caster.motion == Motion::Static && !self.keeper.rest.is_live(known.key);
            self.census.push(Counted { known, placed: caster.bounds.into(), rests });
        }
    }

    fn place(&self, split: usize, cell: [i64; 2]) -> (usize, [i64; 2]) {
        let size = SIZES[split];
        let cells = i64::from(Keeper::texture_edge(size) / size.div_ceil(8));
        (split, cell.map(|at| at.rem_euclid(cells)))
    }

    /// Draws the regions into the textures, and copies the maps.
    fn draw(&mut self) {
        for region in self.keeper.regions().to_vec() {
            let casters = self.keeper.casters(&region).to_vec();
            for cell in self.keeper.books[region.split].books.cells(&region.texels).each() {
                let drawn = self.drawn_in(region.split, cell, Some(&casters));
                self.textures.insert(self.place(region.split, cell), drawn);
            }
        }
        for (split, map) in self.keeper.maps().to_vec().into_iter().enumerate() {
            if map.is_due {
                let (window, cells) = self.shown(split);
                self.maps.insert(split, (window, cells));
            }
        }
    }

    /// Contents that a copy of a split's window would have.
    fn shown(&self, split: usize) -> (Area, Vec<Drawn>) {
        let window = super::window(&self.plan.splits[split]);
        let cells = self.keeper.books[split].books.cells(&window).each();
        let drawn = |cell| self.textures.get(&self.place(split, cell)).cloned().unwrap_or_default();
        (window, cells.map(drawn).collect())
    }

    fn check(&self, wanted: &[BTreeSet<u32>]) -> Result<(), String> {
        for split in 0..SIZES.len() {
            if self.plan.splits[split].casters.is_empty() {
                continue;
            }
            let (window, shown) = &self.maps[&split];
            if *window != super::window(&self.plan.splits[split]) {
                return Err(format!("map {split} shows {window:?}"));
            }
            for (cell, found) in self.keeper.books[split].books.cells(window).each().zip(shown) {
                let expected = self.drawn_in(split, cell, None);
                if *found != expected {
                    return Err(format!("split {split}, cell {cell:?}: {found:?} instead of {expected:?}"));
                }
            }
        }
        self.check_lists(wanted)
    }

    /// Checks that every caster that a slice needs is in the list of the split that serves it, and
    /// is drawn over its map if it does not rest.
    fn check_lists(&self, wanted: &[BTreeSet<u32>]) -> Result<(), String> {
        for (slice, wanted) in wanted.iter().enumerate() {
            let answers = (slice..SIZES.len()).find(|&split| !self.plan.is_handed_on(split));
            let Some(split) = answers else { return Err(format!("nobody answers for slice {slice}")) };
            let movers = self.keeper.movers(&self.keeper.maps()[split]);
            for key in wanted {
                if !self.plan.casters(split).contains(key) {
                    return Err(format!("caster {key} of slice {slice} is missing in split {split}"));
                }
                if self.keeper.rest.is_live(*key) && !movers.contains(key) {
                    return Err(format!("caster {key} moves and is not drawn in split {split}"));
                }
            }
            let it = &self.plan.splits[split];
            let from = self.plan.planes[slice];
            if !(it.near <= from && it.far >= self.plan.planes[slice + 1]) {
                return Err(format!("split {split} does not reach over slice {slice}"));
            }
        }
        Ok(())
    }
}

/// Runs frames of a random life. Returns how often a split was handed on, and the number of edits.
fn live(seed: u64, frames: u32, lies: bool) -> Result<(u32, u32), String> {
    let mut stage = Stage::new(seed, lies);
    let (mut handed_on, mut edits) = (0, 0);
    for frame in 0..frames {
        let count = if stage.dice.below(4) == 0 { stage.dice.below(120) } else { 0 };
        (0..count).for_each(|_| stage.edit());
        edits += count as u32;
        stage.travel();
        let budget = (frame / 100 % 2 == 1).then(|| stage.dice.below(6000));
        stage.frame(budget).map_err(|error| format!("frame {frame}: {error}"))?;
        handed_on += (0..2).filter(|&split| stage.plan.is_handed_on(split)).count() as u32;
    }
    Ok((handed_on, edits))
}

#[test]
fn textures_hold_what_is_there_after_100_000_edits() {
    let (mut handed_on, mut edits) = (0, 0);
    for seed in 1..=8 {
        let (more_handed_on, more) = live(seed, 900, false).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        (handed_on, edits) = (handed_on + more_handed_on, edits + more);
    }
    assert!(handed_on > 100, "only {handed_on} splits had to wait");
    assert!(edits > 100_000, "only {edits} edits");
}

#[test]
fn one_missed_change_is_seen() {
    assert!(live(1, 900, true).is_err(), "a shape that changes unsaid goes unseen");
}

#[test]
fn who_stands_still_draws_nothing() {
    let mut stage = Stage::new(5, false);
    (0..80).for_each(|_| stage.frame(None).expect("right"));
    for _ in 0..20 {
        stage.frame(None).expect("right");
        assert!(stage.keeper.regions().is_empty() && stage.keeper.maps().iter().all(|map| !map.is_due));
    }
}

#[test]
fn a_caster_that_moves_is_drawn_over_the_map_until_it_rests() {
    let mut stage = Stage::new(9, false);
    let handle = stage.set.insert(Caster::new(Aabb::new(DVec3::new(0.0, 0.0, 4.0), DVec3::new(1.0, 1.0, 5.0)), 1000));
    let handle = handle.expect("a box");
    stage.known.insert(handle, Known { key: 1000, version: 0 });
    (0..80).for_each(|_| stage.frame(None).expect("right"));
    assert!(!stage.keeper.rest.is_live(1000));
    let moved = Aabb::new(DVec3::new(0.5, 0.0, 4.0), DVec3::new(1.5, 1.0, 5.0));
    stage.set.set_bounds(handle, moved).expect("a box");
    stage.known.get_mut(&handle).expect("known").version += 1;
    stage.frame(None).expect("right");
    assert!(!stage.keeper.regions().is_empty(), "where it was is drawn without it");
    for _ in 1..super::rest::FRAMES {
        stage.frame(None).expect("right");
        assert!(stage.keeper.rest.is_live(1000) && stage.keeper.regions().is_empty());
        let movers = stage.keeper.maps().iter().map(|map| stage.keeper.movers(map));
        assert!(movers.flatten().any(|&key| key == 1000));
    }
    stage.frame(None).expect("right");
    assert!(!stage.keeper.rest.is_live(1000) && !stage.keeper.regions().is_empty(), "it is kept again");
}
