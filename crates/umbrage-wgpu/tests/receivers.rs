//! What receivers are told, against closed forms: a box on the ground, splits side by side, blend,
//! fade, range.

mod common;

use common::{Ask, DISC, Gpu, PCF5, PCF7, PCSS, World, ask, config, cuboid, depth_filters, ground, plan};
use glam::{DVec3, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{DepthFormat, Filter};
use umbrage_wgpu::{FrameOptions, ShadowConfig};

const DOWN: DVec3 = DVec3::new(0.0, -1.0, 0.0);
/// 45° down towards +X: a wall of height h casts a shadow h long.
const SLANTED: DVec3 = DVec3::new(1.0, -1.0, 0.0);

fn stored(map_sizes: &[u32], filter: Filter, depth_format: DepthFormat) -> ShadowConfig {
    ShadowConfig { depth_format, ..config(map_sizes, filter, "") }
}

/// The ground, and a box of 4 × 2 × 6 m standing on it around x = 20.
fn box_on_ground() -> Vec<Vec3> {
    let mut triangles = ground(200.0);
    triangles.extend(cuboid(Vec3::new(18.0, 0.0, -3.0), Vec3::new(22.0, 2.0, 3.0)));
    triangles
}

/// Points of the ground every 0.37 m around the box.
fn ground_points() -> Vec<Vec3> {
    let steps = || (-40..40).map(|i| i as f32 * 0.37);
    steps().flat_map(|x| steps().map(move |z| Vec3::new(x + 20.0, 0.0, z))).collect()
}

fn up(points: &[Vec3]) -> Vec<Ask> {
    points.iter().map(|&p| ask(p, Vec3::Y)).collect()
}

/// Distance in metres from the edge of the rectangle that is in shadow; negative inside.
fn outside_shadow(point: Vec3, shadow_length: f32) -> f32 {
    let dx = (18.0 - point.x).max(point.x - 22.0 - shadow_length);
    let dz = point.z.abs() - 3.0;
    dx.max(dz)
}

/// Every answer farther from the shadow's edge than the filter and the bias reach must be exact.
fn check_box(light: DVec3, shadow_length: f32, filter: Filter, depth_format: DepthFormat) {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &stored(&[512], filter, depth_format));
    let plan = plan(light, DVec3::new(20.0, 0.0, 0.0), &[512], &[0.1, 100.0], &[64.0]);
    world.draw(&plan, &FrameOptions::default(), &box_on_ground());
    let points = ground_points();
    let texel = plan.splits[0].texel_m.x as f32;
    // A slanted texel is √2 longer on the ground; the bias grows with the filter and lets light in
    // under a caster that is lower.
    let reach = match filter {
        // Without a width, and under the sun's own angle: not the widest that they may be.
        Filter::Disc { .. } => 4.0,
        Filter::Pcss { .. } => 2.0,
        _ => filter.radius_texels() as f32,
    };
    let unsure = texel * (2.0 * reach + 1.5);
    let (mut lit, mut dark, mut wrong) = (0, 0, 0);
    for (&point, answer) in points.iter().zip(world.ask(&up(&points))) {
        assert_eq!(answer.split, 0);
        assert_eq!(answer.short, answer.visibility);
        assert_eq!(answer.in_split, [answer.visibility, 1.0], "the only split's own answer, and none from split 1");
        let outside = outside_shadow(point, shadow_length);
        // Inside the box itself nothing is seen.
        if outside.abs() < unsure {
            assert!((0.0..=1.0).contains(&answer.visibility));
            continue;
        }
        let expected = if outside > 0.0 { 1.0 } else { 0.0 };
        if (answer.visibility - expected).abs() > 1e-5 {
            eprintln!("{filter:?} {depth_format:?} {light}: {point} is {} instead of {expected}", answer.visibility);
            wrong += 1;
        }
        if outside > 0.0 { lit += 1 } else { dark += 1 }
    }
    assert!(lit > 1000 && dark > 40, "only {lit} lit and {dark} dark points were compared");
    assert_eq!(wrong, 0, "of {} points", lit + dark);
}

#[test]
fn a_box_under_the_zenith_sun_shades_its_footprint() {
    for filter in depth_filters() {
        check_box(DOWN, 0.0, filter, DepthFormat::D32Float);
    }
}

#[test]
fn a_box_under_a_slanted_sun_throws_its_height() {
    for filter in depth_filters() {
        check_box(SLANTED, 2.0, filter, DepthFormat::D32Float);
    }
}

#[test]
fn sixteen_bits_of_depth_are_enough() {
    for filter in [Filter::Hard, PCF5] {
        check_box(SLANTED, 2.0, filter, DepthFormat::D16Unorm);
        check_box(DOWN, 0.0, filter, DepthFormat::D16Unorm);
    }
}

/// A plane that the light grazes under every angle does not shade itself: closed form, everything
/// is lit.
#[test]
fn planes_do_not_shade_themselves() {
    let Some(gpu) = Gpu::new() else { return };
    let mut count = 0;
    let mut gpu = Some(gpu);
    for filter in depth_filters() {
        let mut world = World::new(
            gpu.take().or_else(Gpu::new).expect("there was one"),
            &stored(&[128], filter, DepthFormat::D32Float),
        );
        for (tilt, turn) in [(0.0, 0.0), (30.0, 10.0), (60.0, 100.0), (75.0, 200.0), (83.0, 300.0)] {
            let (tilt, turn) = (f64::to_radians(tilt), f64::to_radians(turn));
            let light = -DVec3::new(tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin());
            let plan = plan(light, DVec3::new(20.0, 0.0, 0.0), &[128], &[0.1, 100.0], &[64.0]);
            world.draw(&plan, &FrameOptions::default(), &ground(400.0));
            for (point, answer) in ground_points().iter().zip(world.ask(&up(&ground_points()))) {
                assert!(answer.visibility > 1.0 - 1e-5, "{filter:?}, {light}: {point} is {}", answer.visibility);
                count += 1;
            }
        }
    }
    assert!(count > 100_000);
}

fn two_splits() -> ShadowPlan {
    let mut plan = plan(SLANTED, DVec3::new(20.0, 0.0, 0.0), &[256, 128], &[1.0, 20.5, 60.0], &[64.0, 128.0]);
    plan.splits[0].blend_begin = 19.0;
    plan.fade_begin = 50.0;
    plan
}

#[test]
fn splits_blend_and_fade_without_a_jump() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &stored(&[256, 128], PCF5, DepthFormat::D32Float));
    let plan = two_splits();
    let frame = FrameOptions { tint: true, ..FrameOptions::default() };
    // A long wall along the line of sight: its shadow's edge runs through the border and on through
    // the fade.
    let mut triangles = ground(200.0);
    triangles.extend(cuboid(Vec3::new(-10.0, 0.0, -0.4), Vec3::new(120.0, 2.0, 0.4)));
    world.draw(&plan, &frame, &triangles);

    for z in [-0.55f32, -0.3, 0.0, 0.2, 0.45, 0.6] {
        let points: Vec<Vec3> = (0..6200).map(|i| Vec3::new(i as f32 * 0.01, 0.0, z)).collect();
        let answers = world.ask(&up(&points));
        for (pair, point) in answers.windows(2).zip(&points) {
            // Pcf5 and a band of 1.5 m change by less than this over a centimetre; a hard border
            // would show as a jump.
            let step = (pair[1].visibility - pair[0].visibility).abs();
            assert!(step < 0.03, "visibility jumps by {step} at {point}");
        }
        for (answer, point) in answers.iter().zip(&points) {
            let split = if point.x < 20.5 {
                0
            } else if point.x < 60.0 {
                1
            } else {
                -1
            };
            assert_eq!(answer.split, split, "at {point}");
            let both = answer.in_split;
            let share = ((point.x - 19.0) / 1.5).clamp(0.0, 1.0);
            let blended = both[0] + (both[1] - both[0]) * share;
            let strength = ((60.0 - point.x) / 10.0).clamp(0.0, 1.0);
            let expected = 1.0 + (blended - 1.0) * strength;
            assert!((answer.visibility - expected).abs() < 1e-4, "{answer:?} instead of {expected} at {point}");
            if split == -1 {
                assert_eq!((answer.visibility, answer.tint), (1.0, [1.0; 3]));
            } else {
                assert_ne!(answer.tint, [1.0; 3]);
            }
        }
    }
}

#[test]
fn a_smaller_split_reads_its_own_corner_only() {
    for filter in [PCF5, PCF7] {
        check_own_corner(filter, 16.0);
    }
    // Planned for the widest disc, and for narrow ones.
    for (filter, reach) in [(DISC, 16.0), (DISC, 5.0), (PCSS, 16.0), (PCSS, 4.0)] {
        check_own_corner(filter, reach);
    }
}

fn check_own_corner(filter: Filter, reach: f64) {
    let Some(gpu) = Gpu::new() else { return };
    // As wide as they get.
    let softness = if matches!(filter, Filter::Pcss { .. }) { "sun-angle=28.65" } else { "filter-width=60" };
    let mut world = World::new(gpu, &config(&[256, 128], filter, softness));
    let mut plan = two_splits();
    plan.splits[1].filter_radius_texels = reach;
    plan.planes = vec![1.0, 2.0, 400.0];
    (plan.splits[0].far, plan.splits[0].blend_begin, plan.splits[1].near, plan.splits[1].far) = (2.0, 2.0, 2.0, 400.0);
    (plan.splits[1].blend_begin, plan.fade_begin) = (400.0, 400.0);
    // First everything dark in both layers and in all of them, then an empty world in the second
    // map only.
    let roof = [
        Vec3::new(-500.0, 50.0, -500.0),
        Vec3::new(500.0, 50.0, -500.0),
        Vec3::new(500.0, 50.0, 500.0),
        Vec3::new(-500.0, 50.0, 500.0),
    ];
    world.draw(&plan, &FrameOptions::default(), &common::quad(roof));
    let points: Vec<Vec3> =
        (0..400).flat_map(|i| (-40..40).map(move |k| Vec3::new(i as f32 * 0.5, 0.0, k as f32 * 1.7))).collect();
    let split = &plan.splits[1];
    let (mut inside, mut outside) = (0, 0);
    for (point, answer) in points.iter().zip(world.ask(&up(&points))).filter(|(p, _)| p.x >= 2.0) {
        let at = split.map_from_world(point.as_dvec3());
        let covered = (0.0..=128.0).contains(&at.x) && (0.0..=128.0).contains(&at.y);
        let edge = at.x.min(at.y).min(128.0 - at.x).min(128.0 - at.y).abs();
        if edge < 1e-3 {
            continue;
        }
        assert_eq!(answer.visibility, if covered { 0.0 } else { 1.0 }, "{filter:?}, {point}, texel {at}");
        if covered { inside += 1 } else { outside += 1 }
    }
    assert!(inside > 1000 && outside > 1000, "{inside} points inside, {outside} outside");
}

#[test]
fn facing_strength_enabled_and_empty_splits() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &stored(&[256, 128], Filter::Hard, DepthFormat::D32Float));
    let mut plan = two_splits();
    let dark = Vec3::new(19.0, 0.0, 0.0);
    let behind_eye = Vec3::new(-1.0, 0.0, 0.0);
    let asks = [
        ask(dark, Vec3::Y),
        ask(dark, -Vec3::Y),
        ask(dark, Vec3::new(1.0, 1.0, 0.0).normalize()),
        ask(behind_eye, Vec3::Y),
        ask(Vec3::new(70.0, 0.0, 0.0), -Vec3::Y),
    ];
    let answers = |world: &mut World, plan: &ShadowPlan, frame: FrameOptions| {
        world.draw(plan, &frame, &box_on_ground());
        world.ask(&asks).iter().map(|a| (a.visibility, a.split)).collect::<Vec<_>>()
    };
    // Below the box; from below; a plane that the light runs along; behind the eye; out of range
    // and turned away.
    let frame = FrameOptions::default();
    assert_eq!(answers(&mut world, &plan, frame), [(0.0, 0), (0.0, 0), (0.0, 0), (1.0, 0), (0.0, -1)]);
    world.set("shadow-strength=0.25");
    assert_eq!(answers(&mut world, &plan, frame)[..2], [(0.75, 0), (0.0, 0)]);
    world.set("shadow-strength=1");
    let off = FrameOptions { enabled: false, ..frame };
    assert_eq!(answers(&mut world, &plan, off)[..2], [(1.0, -1), (0.0, -1)]);
    plan.splits[0].casters = 0..0;
    assert_eq!(answers(&mut world, &plan, frame)[..2], [(1.0, 0), (0.0, 0)]);
}

/// With and without `DEPTH_CLIP_CONTROL`: a caster before the near plane is kept by the first and
/// by the planner's care only in the second.
#[test]
fn casters_before_the_near_plane_survive_with_depth_clamp() {
    for withheld in [wgpu::Features::empty(), wgpu::Features::DEPTH_CLIP_CONTROL] {
        let Some(gpu) = Gpu::without(withheld) else { return };
        let mut world = World::new(gpu, &stored(&[128], Filter::Hard, DepthFormat::D32Float));
        let mut plan = plan(DOWN, DVec3::new(20.0, 0.0, 0.0), &[128], &[0.1, 100.0], &[64.0]);
        plan.splits[0].depth_near = -1.0;
        world.draw(&plan, &FrameOptions::default(), &box_on_ground());
        let answer = world.ask(&[ask(Vec3::new(20.0, 0.0, 0.0), Vec3::Y)])[0].visibility;
        let clamps = world.maps.caster_primitive().unclipped_depth;
        assert_eq!(answer, if clamps { 0.0 } else { 1.0 });
        assert_eq!(clamps, world.gpu.device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL));
        // Near planes move up to the receivers for 16-bit maps alone.
        assert!(!world.maps.depth_clamp());
        let Some(gpu) = Gpu::without(withheld) else { return };
        let world = World::new(gpu, &stored(&[128], Filter::Hard, DepthFormat::D16Unorm));
        assert_eq!(world.maps.depth_clamp(), clamps);
    }
}

#[test]
fn borders_blend_dither_or_are_hard() {
    let Some(gpu) = Gpu::new() else { return };
    let mut gpu = Some(gpu);
    let plan = two_splits();
    let points: Vec<Vec3> = (0..400).map(|i| Vec3::new(18.5 + i as f32 * 0.005, 0.0, 0.45)).collect();
    let mut triangles = ground(200.0);
    triangles.extend(cuboid(Vec3::new(-10.0, 0.0, -0.4), Vec3::new(120.0, 2.0, 0.4)));
    for (transition, border) in [("hard", 20.5), ("dither", 19.75)] {
        let asked = config(&[256, 128], PCF5, &format!("transition={transition}"));
        let mut world = World::new(gpu.take().or_else(Gpu::new).expect("there was one"), &asked);
        world.draw(&plan, &FrameOptions::default(), &triangles);
        for (answer, point) in world.ask(&up(&points)).iter().zip(&points) {
            // Without a pixel a dithered border lies in the middle of its band, which is 19 to
            // 20.5.
            let split = usize::from(point.x >= border);
            if (point.x - border).abs() > 1e-3_f32 {
                assert_eq!(answer.split, split as i32, "{transition} at {point}");
                assert_eq!(answer.visibility, answer.in_split[split], "{transition} at {point}");
            }
        }
    }
}
