//! How long does a plan for 10,000 casters and 4 splits take on one core?

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use umbrage::{Aabb, DirectionalLight, Fit, Frustum, Planner, ShadowSettings, SplitScheme, Stabilize, View};

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
    for fit in [Fit::Independent, Fit::Dependent] {
        for stabilize in [Stabilize::None, Stabilize::Exact] {
            for scheme in [SplitScheme::default(), SplitScheme::Fitted] {
                let name = if scheme == SplitScheme::Fitted { " fitted planes" } else { "" };
                let range = Some((1.0, 800.0));
                let settings = ShadowSettings { fit, stabilize, range, scheme, ..ShadowSettings::default() };
                let mut planner = Planner::new(settings).expect("valid");
                let pairs = planner.plan(&view, &light, &world, &world).expect("valid").caster_indices.len();
                group.bench_function(format!("{fit:?} {stabilize:?}{name} ({pairs} pairs)"), |b| {
                    b.iter(|| planner.plan(&view, &light, &world, &world).expect("valid").caster_indices.len());
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, plan);
criterion_main!(benches);
