//! Maps of a world that stands still are the same texels when the camera moves by whole texels.
//!
//! Which triangle a texel shows is the same without exception. Its depth is the same up to the
//! rasteriser's own rounding: lavapipe, for one, evaluates a triangle's depth as `a + b·x + c·y`
//! from the target's corner, so that a shift rounds differently. For a triangle that the light sees
//! edge-on, `b` and `c` are as large as its area is small and nothing is left of `a`, wherever it
//! lies; such slivers are drawn by every rasteriser as it can and are left out here.

mod common;

use common::{Gpu, World, ask, config, depth_filters, plan};
use glam::{DVec2, DVec3, Vec3};
use umbrage::config::Filter;
use umbrage_wgpu::FrameOptions;

const SIZE: u32 = 256;
const WIDTH_M: f64 = 60.0;

/// Depths may differ by this share of the 200 m range: 32 steps of an f32 just below 1, 0.4 mm.
const ROUNDING: f32 = 1.9073486e-6;

/// A triangle is drawn if its height above its longest edge, as the light sees it, is at least this
/// many texels.
const LEAST_HEIGHT: f64 = 0.25;

/// Triangles of all sizes around the origin, from a linear congruential generator (Knuth's
/// constants).
fn soup(count: usize) -> Vec<Vec3> {
    let mut state = 2025u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut triangles = Vec::new();
    for _ in 0..count {
        let at = Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 80.0;
        let size = 0.05 + 12.0 * next() * next() * next();
        triangles.extend([0; 3].map(|_| at + size * Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5)));
    }
    triangles
}

/// Those of the triangles that are no slivers in the light's eyes.
fn without_slivers(triangles: &[Vec3], light: DVec3) -> Vec<Vec3> {
    let texel = WIDTH_M / f64::from(SIZE);
    let is_wide = |corners: &[Vec3]| {
        let seen = |i: usize| corners[i].as_dvec3().reject_from(light);
        let (a, b, c) = (seen(0), seen(1), seen(2));
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        (b - a).cross(c - a).length() >= LEAST_HEIGHT * texel * longest
    };
    triangles.chunks(3).filter(|corners| is_wide(corners)).flatten().copied().collect()
}

/// Texels of one map, drawn with its corner moved by `shift` texels.
fn drawn(world: &mut World, light: DVec3, origin: DVec3, shift: DVec2, triangles: &[Vec3]) -> Vec<f32> {
    let mut plan = plan(light, origin, &[SIZE], &[0.1, 100.0], &[WIDTH_M]);
    plan.splits[0].min_texel += shift;
    world.draw(&plan, &FrameOptions { origin, ..FrameOptions::default() }, triangles);
    world.texels(0)
}

/// How many texels both maps hold, how many of those are not empty, and in how many they differ.
fn compared(a: &[f32], b: &[f32], shift: (i32, i32)) -> (usize, usize, usize) {
    let size = SIZE as i32;
    let (mut count, mut filled, mut different) = (0, 0, 0);
    for y in 0..size {
        for x in 0..size {
            let (bx, by) = (x - shift.0, y - shift.1);
            if !(0..size).contains(&bx) || !(0..size).contains(&by) {
                continue;
            }
            let (before, after) = (a[(y * size + x) as usize], b[(by * size + bx) as usize]);
            count += 1;
            filled += usize::from(before < 1.0);
            different += usize::from((before - after).abs() > ROUNDING);
        }
    }
    (count, filled, different)
}

#[test]
fn whole_texels_change_nothing() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &config(&[SIZE], Filter::Hard, ""));
    for light in [DVec3::new(0.3, -1.0, 0.2), DVec3::new(0.0, -1.0, 0.0), DVec3::new(-1.0, -0.2, 0.5)] {
        let triangles = without_slivers(&soup(3000), light);
        // 0, 10 and 100 km from the world's origin.
        for origin in [DVec3::ZERO, DVec3::new(7_071.3, 12.7, -7_071.1), DVec3::new(99_999.9, -31.4, 77.7)] {
            let still = drawn(&mut world, light, origin, DVec2::ZERO, &triangles);
            for shift in [(1, 0), (0, -3), (37, 21), (-100, 64)] {
                let at = DVec2::new(f64::from(shift.0), f64::from(shift.1));
                let moved = drawn(&mut world, light, origin, at, &triangles);
                let (count, filled, different) = compared(&still, &moved, shift);
                assert!(count > 20_000 && filled > 3_000, "{count} texels compared, {filled} with something in them");
                assert_eq!(different, 0, "of {count} texels, {shift:?}, light {light}, origin {origin}");
            }
        }
    }
}

/// What receivers are told stands still with the maps: points of the triangles themselves, at any
/// place of the map, under every filter. A linear sampler weighs in steps of 1/256 from a
/// coordinate that does round.
#[test]
fn whole_texels_change_no_answer() {
    let mut compared = 0;
    for filter in depth_filters().filter(|filter| filter.texels_read() < 64) {
        let tolerance = if filter == Filter::Hard { 0.0 } else { 1.0 / 64.0 };
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &config(&[SIZE], filter, ""));
        let light = DVec3::new(0.3, -1.0, 0.2);
        let triangles = without_slivers(&soup(3000), light);
        let asks: Vec<_> = triangles
            .chunks(3)
            .flat_map(|t| [(0.2, 0.3), (0.6, 0.3), (0.1, 0.8), (0.33, 0.34)].map(|(a, b)| (t, a, b)))
            .map(|(t, a, b)| {
                let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
                let towards = normal * -normal.dot(light.as_vec3()).signum();
                ask(t[0] + a * (t[1] - t[0]) + b * (1.0 - a) * (t[2] - t[0]), towards)
            })
            .collect();
        let origin = DVec3::new(99_999.9, -31.4, 77.7);
        let answers = |world: &mut World, shift| {
            drawn(world, light, origin, shift, &triangles);
            world.ask(&asks)
        };
        let still = answers(&mut world, DVec2::ZERO);
        for shift in [DVec2::new(1.0, 0.0), DVec2::new(-7.0, 12.0)] {
            let moved = answers(&mut world, shift);
            // Points that one of the maps does not cover, or covers at its edge, are lit there and
            // left out.
            let plan = plan(light, origin, &[SIZE], &[0.1, 100.0], &[WIDTH_M]);
            for ((a, b), it) in still.iter().zip(&moved).zip(&asks) {
                if plan.splits[0].contains(origin + it.position().as_dvec3(), 16.0) {
                    let change = (a.in_split[0] - b.in_split[0]).abs();
                    assert!(change <= tolerance, "{filter:?}, {shift}: changes by {change}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 20_000, "{compared} answers were compared");
}

/// The comparison must be able to say no: half a texel is no whole one.
#[test]
fn half_a_texel_is_seen() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &config(&[SIZE], Filter::Hard, ""));
    let triangles = soup(3000);
    let light = DVec3::new(0.3, -1.0, 0.2);
    let still = drawn(&mut world, light, DVec3::ZERO, DVec2::ZERO, &triangles);
    let moved = drawn(&mut world, light, DVec3::ZERO, DVec2::splat(0.5), &triangles);
    let (_, _, different) = compared(&still, &moved, (0, 0));
    assert!(different > 1000, "{different} texels differ");
}
