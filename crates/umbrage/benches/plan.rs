//! How long does a plan for 10,000 casters and 4 splits take on one core?

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use umbrage::config::{Crop, Preset, Range, SplitScheme, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, View};

fn plan(criterion: &mut Criterion) {
    let mut world: Vec<Aabb> = (0..10_000u32)
        .map(|i| {
            let (x, z) = ((f64::from(i) * 0.754_877_666_2).fract(), (f64::from(i) * 0.569_840_290_998).fract());
            let at = DVec3::new(4000.0 * x - 2000.0, 0.0, 4000.0 * z - 2000.0);
            Aabb::new(at, at + DVec3::new(6.0, 12.0, 6.0))
        })
        .collect();
    world.push(Aabb::new(DVec3::new(-2000.0, 0.0, -2000.0), DVec3::new(2000.0, 0.0, 2000.0)));
    let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 1.0, 2000.0).expect("valid");
    let view = View::look_at_upright(DVec3::new(0.0, 20.0, 1500.0), DVec3::ZERO, frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("valid");
    let mut group = criterion.benchmark_group("plan 10,000 casters, 4 splits");
    for crop in [Crop::SceneIndependent, Crop::SceneDependent] {
        for stability in [Stability::tight(), Stability::Exact] {
            for scheme in [SplitScheme::practical(), SplitScheme::Optimal] {
                let name = if scheme == SplitScheme::Optimal { " optimal planes" } else { "" };
                let (range, stability) = (Range::Metres { near: 1.0, far: 800.0 }, stability.clone());
                let settings = ShadowConfig { crop, stability, range, scheme, ..Preset::Papers.config() };
                let mut planner = Planner::new(&settings).expect("valid");
                let pairs = planner.plan(&view, &light, &world, &world).expect("valid").caster_indices.len();
                group.bench_function(format!("{crop} {}{name} ({pairs} pairs)", settings.stability.word()), |b| {
                    b.iter(|| planner.plan(&view, &light, &world, &world).expect("valid").caster_indices.len());
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, plan);
criterion_main!(benches);
