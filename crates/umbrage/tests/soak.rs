//! Memory stays where it is, however many frames are planned.
//!
//! `UMBRAGE_SOAK_FRAMES` chooses how many. Counted as the process's resident memory, so one test
//! plans everything, one way after the other.
#![cfg(target_os = "linux")]

use umbrage::config::{Cache, Preset};
use umbrage::glam::DVec3;
use umbrage::{
    Aabb, Caster, CasterHandle, CasterSet, DirectionalLight, Frustum, Light, Motion, PlanInputs, Planner, ShadowConfig,
    ShadowPlan, SpotLight, View,
};

/// Frames of a run in CI.
const FRAMES: u32 = 400;

/// Frames until everything that is made once has been made.
const WARM_UP: u32 = 200;

/// MiB that a run may add.
const MOST_MIB: f64 = 20.0;

/// Casters, of which every tenth moves.
const CASTERS: u32 = 2000;

fn resident_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux says what a process holds");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("its resident memory");
    line.trim().trim_end_matches("kB").trim().parse::<f64>().expect("a number of kB") / 1024.0
}

/// The box of a caster at a time in seconds.
fn bounds(index: u32, time: f64) -> Aabb {
    let (row, column) = (f64::from(index / 50), f64::from(index % 50));
    let moved = if index.is_multiple_of(10) { DVec3::new(time.sin(), 0.0, time.cos()) * 3.0 } else { DVec3::ZERO };
    let at = DVec3::new(12.0 * column - 300.0, 0.0, 14.0 * row - 280.0) + moved;
    Aabb::new(at, at + DVec3::new(3.0, 2.0 + f64::from(index % 7), 3.0))
}

/// A world that goes on: casters move, appear and go, the camera walks in a large circle.
struct World {
    set: CasterSet,
    handles: Vec<CasterHandle>,
    ways: Vec<(Planner, Light, ShadowPlan)>,
}

impl World {
    fn new() -> Self {
        let mut set = CasterSet::new();
        let caster = |index: u32| {
            let motion = if index.is_multiple_of(10) { Motion::Moving } else { Motion::Static };
            Caster { motion, ..Caster::new(bounds(index, 0.0), index) }
        };
        let handles = set.insert_all((0..CASTERS).map(caster)).expect("boxes");
        let sun = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.25)).expect("a sun");
        let spot = SpotLight::new(DVec3::new(0.0, 30.0, 0.0), DVec3::NEG_Y, 0.8, 60.0).expect("a spot light");
        let kept = ShadowConfig { cache: Cache::Kept, ..Preset::Papers.config() };
        let spot_config = Preset::Papers.config().for_lights(&[umbrage::config::LightKind::Spot]).0;
        let ways = [
            (Preset::Balanced.config(), Light::from(sun)),
            (Preset::Papers.config(), sun.into()),
            (kept, sun.into()),
            (spot_config, spot.into()),
        ];
        let way = |(config, light)| (Planner::new(&config).expect("a config"), light, ShadowPlan::default());
        Self { set, handles, ways: ways.map(way).into() }
    }

    fn frame(&mut self, frame: u32) {
        let time = f64::from(frame) / 60.0;
        for index in (0..CASTERS).step_by(10) {
            self.set.set_bounds(self.handles[index as usize], bounds(index, time)).expect("a box");
        }
        // One caster goes and comes back as another.
        let index = frame % CASTERS;
        self.set.remove(self.handles[index as usize]).expect("a caster");
        self.handles[index as usize] = self.set.insert(Caster::new(bounds(index, time), index)).expect("a box");
        let eye = DVec3::new(150.0 * (0.1 * time).cos(), 8.0, 150.0 * (0.1 * time).sin());
        let lens = Frustum::perspective(1.0 + 0.2 * (0.05 * time).sin(), 1.5, 0.1, 1000.0).expect("a lens");
        let target = eye + DVec3::new((0.37 * time).cos(), -0.2, (0.37 * time).sin());
        let view = View::look_at_upright(eye, target, lens).expect("a view");
        for (planner, light, plan) in &mut self.ways {
            planner.plan_into(&PlanInputs::new(&view, *light, &self.set, &self.set), plan).expect("a plan");
        }
    }
}

#[test]
fn planning_takes_no_more_memory_frame_by_frame() {
    // What is held is seen: the count says no where it has to.
    let before = resident_mib();
    let held = vec![1_u8; 24 << 20];
    assert!(resident_mib() - before > MOST_MIB, "{} bytes are held and not seen", held.len());
    drop(held);

    let frames = std::env::var("UMBRAGE_SOAK_FRAMES").ok().map_or(FRAMES, |it| it.parse().expect("a whole number"));
    let mut world = World::new();
    (0..WARM_UP).for_each(|frame| world.frame(frame));
    let (before, kept) = (resident_mib(), world.set.memory());
    (WARM_UP..WARM_UP + frames).for_each(|frame| world.frame(frame));
    let grown = resident_mib() - before;
    eprintln!("{grown:.1} MiB in {frames} frames; the set takes {} bytes, took {kept}", world.set.memory());
    assert!(grown < MOST_MIB, "{grown:.1} MiB in {frames} frames");
}
