//! Casters under half a texel: leaving them out changes answers near them and nowhere else.

mod common;

use common::{Ask, Gpu, PCF3, World, ask, config, cuboid};
use glam::{DVec3, Vec3};
use umbrage::config::Filter;
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, ShadowPlan, View};
use umbrage_wgpu::FrameOptions;

/// A grid of boxes over the ground, small ones between large ones.
fn boxes() -> Vec<Aabb> {
    (0..400)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 20) - 10.0, 0.7, f64::from(i / 20) - 10.0);
            let size = if i % 5 == 0 { 0.6 } else { 0.004 * f64::from(1 + i % 7) };
            Aabb::new(at, at + DVec3::splat(size))
        })
        .collect()
}

fn plan(config: &ShadowConfig, casters: &[Aabb], receivers: &[Aabb]) -> ShadowPlan {
    let view = View::look_at_upright(
        DVec3::new(0.0, 9.0, 16.0),
        DVec3::ZERO,
        Frustum::perspective(1.1, 1.5, 0.5, 100.0).expect("a lens"),
    );
    let sun = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a sun");
    let mut planner = Planner::new(config).expect("a config");
    planner.plan(&view.expect("a view"), &sun, casters, receivers).expect("a plan").clone()
}

/// Whether one of the casters that are left out of a split's list may have changed its answer at a
/// point. It covers one texel at most, whose centre lies a quarter of a texel from its middle or
/// less. A filter reads texels whose centres lie within its reach and half a texel, and the next
/// one to each for the slope of what it holds.
fn may_differ(all: &ShadowPlan, fewer: &ShadowPlan, split: usize, casters: &[Aabb], point: DVec3) -> bool {
    let map = &all.splits[split];
    let at = map.map_from_world(point);
    let near = |bounds: &Aabb| {
        let middle = map.map_from_world(0.5 * (bounds.min + bounds.max));
        let reach = map.filter_radius_texels + 0.5 + 1.0 + 0.25;
        (at.x - middle.x).abs() < reach && (at.y - middle.y).abs() < reach
    };
    let dropped = all.casters(split).iter().filter(|caster| !fewer.casters(split).contains(caster));
    dropped.into_iter().any(|&caster| near(&casters[caster as usize]))
}

#[test]
fn answers_change_near_what_is_left_out_alone() {
    let casters = boxes();
    let mut receivers = casters.clone();
    receivers.push(Aabb::new(DVec3::new(-40.0, -0.1, -40.0), DVec3::new(40.0, 0.0, 40.0)));
    let triangles: Vec<Vec<Vec3>> = casters.iter().map(|it| cuboid(it.min.as_vec3(), it.max.as_vec3())).collect();
    // Between the boxes' feet, and right under them.
    let asks: Vec<Ask> = (0..22_500)
        .map(|i| Vec3::new(0.15 * (i % 150) as f32 - 11.0, 0.0, 0.15 * (i / 150) as f32 - 11.0))
        .map(|at| ask(at, Vec3::Y))
        .collect();
    for filter in [Filter::Hard, PCF3] {
        let Some(gpu) = Gpu::new() else { return };
        let config = config(&[128, 128], filter, "");
        let all = plan(&config, &casters, &receivers);
        let fewer = plan(&ShadowConfig { drop_small_casters: true, ..config.clone() }, &casters, &receivers);
        assert!(fewer.dropped_casters.iter().any(|&dropped| dropped > 50), "{:?}", fewer.dropped_casters);
        let mut world = World::new(gpu, &config);
        let mut answers = |plan: &ShadowPlan| {
            world.draw_listed(plan, &FrameOptions::default(), &triangles);
            world.ask(&asks)
        };
        let (with, without) = (answers(&all), answers(&fewer));
        let mut changed = 0;
        for ((ask, with), without) in asks.iter().zip(&with).zip(&without) {
            assert_eq!(with.split, without.split);
            if with.visibility != without.visibility {
                let (split, point) = (with.split as usize, ask.position().as_dvec3());
                // In the blend band both maps have a say.
                let splits = split..(split + 2).min(all.splits.len());
                let is_near = splits.into_iter().any(|split| may_differ(&all, &fewer, split, &casters, point));
                assert!(is_near, "{filter:?}: {point} in split {split} has nothing near that was left out");
                changed += 1;
            }
        }
        assert!(changed > 0, "{filter:?}: nothing changed, so nothing was shown");
        let dark = without.iter().filter(|answer| answer.visibility < 0.5).count();
        assert!(dark > 500, "{filter:?}: large casters cast their shadows: {dark}");
    }
}
