//! What does a plan cost by a set of casters, and what by the list of the same boxes?
//!
//! A wood of 10,000 trees to the square kilometre, of 10² to 10⁶ trees, one in a hundred of which
//! moves in every frame. The camera walks and turns; four splits reach 800 m. Lists must be equal
//! before anything is timed.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use umbrage::config::{Crop, Preset, Range, SplitScheme, Stability};
use umbrage::{
    Aabb, Caster, CasterHandle, CasterSet, DirectionalLight, Frustum, Motion, Planner, ShadowConfig, ShadowPlan, View,
};

/// Trees to the square kilometre.
const DENSITY: f64 = 10_000.0;

/// Trees.
const COUNTS: [u32; 5] = [100, 1_000, 10_000, 100_000, 1_000_000];

/// Views before the first comes again.
const VIEWS: usize = 200;

struct World {
    set: CasterSet,
    /// The boxes of the set, by key.
    list: Vec<Aabb>,
    movers: Vec<(CasterHandle, u32)>,
    views: Vec<View>,
    frame: usize,
}

impl World {
    fn new(count: u32, far: f64) -> Self {
        let edge = 1000.0 * (f64::from(count) / DENSITY).sqrt();
        let casters = (0..count).map(|i| {
            let (x, z) = ((f64::from(i) * 0.754_877_666_2).fract(), (f64::from(i) * 0.569_840_290_998).fract());
            let (at, size) = (DVec3::new(edge * x, 0.0, edge * z), 3.0 + f64::from(i % 5));
            let motion = if i % 100 == 7 { Motion::Moving } else { Motion::Static };
            Caster { motion, ..Caster::new(Aabb::new(at, at + DVec3::new(size, 2.0 * size, size)), i) }
        });
        let mut set = CasterSet::new();
        let handles = set.insert_all(casters).expect("valid");
        let ground = Aabb::new(DVec3::ZERO, DVec3::new(edge, 0.0, edge));
        set.insert(Caster::new(ground, count)).expect("valid");
        let movers = handles.into_iter().zip(0..count).filter(|(_, key)| key % 100 == 7).collect();
        let lens = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 0.5, far).expect("valid");
        let view = |i: usize| {
            let (turn, along) = (0.026 * i as f64, 0.023 * i as f64);
            let eye = DVec3::new(0.5 * edge + along, 12.0, 0.5 * edge);
            View::look_at_upright(eye, eye + DVec3::new(turn.cos(), -0.05, turn.sin()), lens).expect("valid")
        };
        let list = set.iter().map(|(_, caster)| caster.bounds).collect();
        Self { set, list, movers, views: (0..VIEWS).map(view).collect(), frame: 0 }
    }

    /// Moves what moves, in the set and in the list.
    fn step(&mut self) -> View {
        self.frame += 1;
        let by = DVec3::X * (0.02 * (self.frame as f64 * 0.1).sin());
        for &(handle, key) in &self.movers {
            let bounds = &mut self.list[key as usize];
            *bounds = Aabb::new(bounds.min + by, bounds.max + by);
            self.set.set_bounds(handle, *bounds).expect("there");
        }
        self.views[self.frame % VIEWS]
    }
}

fn configs() -> [(&'static str, ShadowConfig); 3] {
    let range = Range::Metres { near: 0.5, far: 800.0 };
    let papers = ShadowConfig { map_sizes: vec![1024; 4], range, ..Preset::Papers.config() };
    [
        ("exactly still", papers.clone()),
        (
            "tight, scene-dependent",
            ShadowConfig {
                stability: Stability::tight(),
                crop: Crop::SceneDependent,
                scheme: SplitScheme::Logarithmic,
                ..papers
            },
        ),
        ("balanced", ShadowConfig { map_sizes: vec![1024; 4], range, ..ShadowConfig::default() }),
    ]
}

fn lists(plan: &ShadowPlan) -> Vec<&[u32]> {
    (0..plan.splits.len()).map(|split| plan.casters(split)).collect()
}

fn timed(frames: u64, mut frame: impl FnMut() -> Duration) -> Duration {
    (0..frames).map(|_| frame()).sum()
}

/// Ten thousand casters that are all in view, which nothing can be saved of by not looking.
fn all_in_view(criterion: &mut Criterion) {
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("valid");
    let world = World::new(10_000, 3000.0);
    let lens = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 0.5, 3000.0).expect("valid");
    let eye = DVec3::new(500.0, 200.0, -900.0);
    let view = View::look_at_upright(eye, DVec3::new(500.0, 0.0, 500.0), lens).expect("valid");
    let mut group = criterion.benchmark_group("10,000 in view");
    group.sample_size(20).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    for (name, config) in configs() {
        let config = ShadowConfig { range: Range::Camera, ..config };
        let mut planner = Planner::new(&config).expect("valid");
        let pairs = planner.plan(&view, &sun, &world.list, &world.list).expect("valid").caster_indices.len();
        group.bench_function(format!("list, {name} ({pairs} pairs)"), |bencher| {
            bencher.iter(|| planner.plan(&view, &sun, &world.list, &world.list).expect("valid").splits.len());
        });
        let mut set = world.set.clone();
        let (handle, _) = world.movers[0];
        group.bench_function(format!("set, {name}"), |bencher| {
            bencher.iter_custom(|frames| {
                timed(frames, || {
                    // A set that has changed is planned again.
                    set.set_bounds(handle, world.list[7]).expect("there");
                    let begin = Instant::now();
                    planner.plan(&view, &sun, &set, &set).expect("valid");
                    begin.elapsed()
                })
            });
        });
    }
    group.finish();
}

/// Counts that do not depend on the machine, beside the times.
#[allow(clippy::print_stdout, reason = "a bench reports on standard output")]
fn say_counts(name: &str, [pairs, nodes, boxes]: [u64; 3], bytes: f64) {
    println!("{name}: {pairs} pairs, {nodes} nodes and {boxes} boxes a frame, {bytes:.1} B a caster");
}

fn set_against_list(criterion: &mut Criterion) {
    let sun = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("valid");
    for (name, config) in configs() {
        let mut group = criterion.benchmark_group(format!("plan, {name}"));
        group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
        for count in COUNTS {
            let mut world = World::new(count, 800.0);
            let [mut by_set, mut by_list] = [(); 2].map(|()| Planner::new(&config).expect("valid"));
            let (mut pairs, mut nodes, mut boxes) = (0, 0, 0);
            for _ in 0..20 {
                let view = world.step();
                let of_set = by_set.plan(&view, &sun, &world.set, &world.set).expect("valid").clone();
                let of_list = by_list.plan(&view, &sun, &world.list, &world.list).expect("valid");
                assert_eq!(lists(&of_set), lists(of_list), "{name}, {count}");
                pairs += of_set.caster_indices.len() as u64;
                let visited = by_set.visited();
                (nodes, boxes) = (nodes + visited.nodes, boxes + visited.boxes);
            }
            let each = world.set.memory() as f64 / f64::from(count);
            say_counts(&format!("{name}, {count}"), [pairs, nodes, boxes].map(|sum| sum / 20), each);
            group.bench_function(BenchmarkId::new("set", count), |bencher| {
                bencher.iter_custom(|frames| {
                    timed(frames, || {
                        let view = world.step();
                        let begin = Instant::now();
                        by_set.plan(&view, &sun, &world.set, &world.set).expect("valid");
                        begin.elapsed()
                    })
                });
            });
            group.bench_function(BenchmarkId::new("list", count), |bencher| {
                bencher.iter_custom(|frames| {
                    timed(frames, || {
                        let view = world.step();
                        let begin = Instant::now();
                        by_list.plan(&view, &sun, &world.list, &world.list).expect("valid");
                        begin.elapsed()
                    })
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, all_in_view, set_against_list);
criterion_main!(benches);
