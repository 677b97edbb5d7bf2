//! Receivers away from edges are decided by bounds over their kernel: with the same answers as by
//! asking every texel, whatever stands there.

mod common;

use common::{ASK, Answer, Ask, Gpu, PCF3, PCF5, World, ask, config, cuboid, ground, plan, quad};
use glam::{DVec3, Vec3};
use umbrage::config::Filter;
use umbrage_wgpu::FrameOptions;

const CALL: &str = "let plain = umbrage_square_plain(layer, kind, softness, at, centre);";
const UNSURE: &str = "let plain = UMBRAGE_KERNEL_UNSURE;";
/// The bounds as somebody might get them wrong: by the texel in the middle alone.
const NARROW: &str = "var plain = UMBRAGE_KERNEL_UNSURE;
    let middle = umbrage_map_load(layer.index, vec2i(floor(centre + layer.offset)));
    if middle < at.depth - at.tolerance.past { plain = 0.0; }";

/// Numbers in [0, 1) from a linear congruential generator (Knuth's constants).
fn random() -> impl FnMut() -> f32 {
    let mut state = 29u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// A ground with boxes, leaves and slopes on it, some of them less than a texel wide.
fn things(next: &mut impl FnMut() -> f32) -> Vec<Vec3> {
    let mut triangles = ground(40.0);
    for i in 0..160 {
        let at = Vec3::new(60.0 * next() - 30.0, 4.0 * next() * next(), 60.0 * next() - 30.0);
        let size = Vec3::new(next(), next(), next()) * [0.1, 1.0, 6.0][i % 3];
        if i % 4 == 0 {
            let aside = Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 4.0;
            triangles.extend(quad([at, at + size, at + size + aside, at + aside]));
        } else {
            triangles.extend(cuboid(at, at + size));
        }
    }
    triangles
}

/// Points on all of it, just over and under it, and in the air.
fn receivers(triangles: &[Vec3], next: &mut impl FnMut() -> f32) -> Vec<Ask> {
    let mut asks = Vec::new();
    for corners in triangles.chunks(3) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if normal.length() < 1e-4 {
            continue;
        }
        for i in 0..6 {
            let (mut u, mut v) = (next(), next());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let on = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
            let off = [0.0, 0.0, 0.02, -0.02, 1.0][i % 5] * next();
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            asks.push(ask(on + normal.normalize() * off, normal.normalize() * side));
        }
    }
    asks
}

/// The answers of a text, and of that text with other words for the bounds.
fn answers(world: &World, asks: &[Ask], bounds: &str) -> Vec<Answer> {
    let text = world.maps.receiver_wgsl(1);
    assert_eq!(text.matches(CALL).count(), 1, "the text asks for bounds once");
    world.gpu.compute(&(text.replace(CALL, bounds) + ASK), asks, Some(&world.maps))
}

/// How many answers differ, and how many are neither 0 nor 1.
fn differences(a: &[Answer], b: &[Answer]) -> (usize, usize) {
    let differ = |(a, b): (&Answer, &Answer)| (a.visibility - b.visibility).abs() > 1e-6 || a.split != b.split;
    let partly = |answer: &&Answer| answer.visibility > 1e-6 && answer.visibility < 1.0 - 1e-6;
    (a.iter().zip(b).filter(|pair| differ(*pair)).count(), a.iter().filter(partly).count())
}

#[test]
fn bounds_over_a_kernel_change_no_answer() {
    for (filter, settings) in [(Filter::Pcf2, ""), (PCF3, ""), (PCF3, "bias=slope"), (PCF5, ""), (Filter::Castano5, "")]
    {
        let Some(gpu) = Gpu::new() else { return };
        let mut next = random();
        let triangles = things(&mut next);
        let asks = receivers(&triangles, &mut next);
        let sizes = [128, 96];
        let mut world = World::new(gpu, &config(&sizes, filter, settings));
        let mut seen = 0;
        for light in [DVec3::new(0.3, -1.0, 0.2), DVec3::new(1.0, -0.12, 0.4)] {
            let plan = plan(light.normalize(), DVec3::ZERO, &sizes, &[1.0, 5.0, 100.0], &[60.0, 70.0]);
            world.draw(&plan, &FrameOptions::default(), &triangles);
            let all = answers(&world, &asks, UNSURE);
            let (differ, partly) = differences(&all, &answers(&world, &asks, CALL));
            assert_eq!(differ, 0, "{filter:?} {settings} {light}: of {}", asks.len());
            assert!(40 * partly > asks.len(), "{partly} of {} are on edges", asks.len());
            seen += differences(&all, &answers(&world, &asks, NARROW)).0;
        }
        assert!(seen > 20, "the comparison sees bounds that are too narrow: {seen}");
    }
}
