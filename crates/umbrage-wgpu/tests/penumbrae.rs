//! How wide edges are, against closed forms: the shadow of a half plane.

mod common;

use common::{DISC, ESM, EVSM2, EVSM4, Gpu, IN_SPLIT, MSM, PCF7, PCSS, VSM, World, ask, config, plan, quad};
use glam::{DVec3, Vec3};
use umbrage::config::Filter;
use umbrage_wgpu::FrameOptions;

/// Where the half plane ends, and how high it lies.
const EDGE: f32 = 20.0;
const HEIGHT: f32 = 10.0;

/// Texels across each map.
const SIZE: u32 = 512;

const PLANES: [f64; 5] = [1.0, 20.0, 60.0, 100.0, 150.0];

/// Share of a disc of radius 1 on the far side of a line at distance `x` from its middle.
fn disc_share(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    1.0 - (x.acos() - x * (1.0 - x * x).sqrt()) / std::f64::consts::PI
}

/// Share of a tent of half width 1 that lies left of `x`.
fn tent_share(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + x - 0.5 * x * x.abs()
}

/// ∫ v (1 − v) over places: grows with an edge's width, whatever its form, and needs no threshold.
fn softness_of(values: impl Iterator<Item = f64>, step: f64) -> f64 {
    values.map(|v| v * (1.0 - v) * step).sum()
}

/// A program that asks the first `splits` splits, four at most.
fn ask_splits(splits: usize) -> String {
    let each: String = (0..splits)
        .map(|split| format!("    answer[{split}] = in_split(ask.position.xyz, ask.normal.xyz, {split});\n"))
        .collect();
    format!(
        "{IN_SPLIT}struct Ask {{ position: vec4f, normal: vec4f }}
@group(0) @binding(0) var<storage, read> asks: array<Ask>;
@group(0) @binding(1) var<storage, read_write> answers: array<vec4f>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{
    if id.x >= arrayLength(&asks) {{ return; }}
    let ask = asks[id.x];
    var answer = vec4f();
{each}    answers[id.x] = answer;
}}"
    )
}

/// Full widths of the edge in each split, in metres, if it has the form `share`; `maps` are the
/// widths of the splits' maps.
fn widths<const N: usize>(filter: Filter, softness: &str, maps: [f64; N], share: fn(f64) -> f64) -> Option<[f64; N]> {
    let sizes = [SIZE; N];
    let mut world = World::new(Gpu::new()?, &config(&sizes, filter, softness));
    let mut plan = plan(DVec3::NEG_Y, DVec3::new(f64::from(EDGE), 0.0, 0.0), &sizes, &PLANES[..=N], &maps);
    // The ground is all that is seen.
    plan.splits.iter_mut().for_each(|split| split.receiver_depths = (-5.0, 5.0));
    // The edge runs askew so that it meets texels everywhere.
    let end = |z: f32| Vec3::new(EDGE + 0.1 * z, HEIGHT, z);
    let roof = quad([Vec3::new(-300.0, HEIGHT, -200.0), end(-200.0), end(200.0), Vec3::new(-300.0, HEIGHT, 200.0)]);
    let ground = common::ground(300.0);
    world.draw(&plan, &FrameOptions::default(), &[roof, ground].concat());

    let step = 0.01f32;
    let rows: Vec<f32> = (0..24).map(|row| -1.5 + 0.131 * row as f32).collect();
    let asks: Vec<_> = (rows.iter())
        .flat_map(|&z| (-200..=200).map(move |i| ask(Vec3::new(EDGE + 0.1 * z + step * i as f32, 0.0, z), Vec3::Y)))
        .collect();
    let source = world.maps.receiver_wgsl(1) + &ask_splits(N);
    let answers: Vec<[f32; 4]> = world.gpu.compute(&source, &asks, Some(&world.maps));
    let unit = softness_of((-1000..=1000).map(|i| share(f64::from(i) / 1000.0)), 1e-3);
    Some(std::array::from_fn(|split| {
        let values = answers.iter().map(|answer| f64::from(answer[split]));
        2.0 * softness_of(values, f64::from(step)) / rows.len() as f64 / unit
    }))
}

fn check<const N: usize>(found: [f64; N], expected: f64, what: &str) {
    for width in found {
        assert!((width / expected - 1.0).abs() < 0.1, "{what}: {found:?} m wide instead of {expected} m");
    }
    check_borders(found, what);
}

/// Penumbrae are equally wide on both sides of every border between splits.
fn check_borders<const N: usize>(found: [f64; N], what: &str) {
    for sides in found.windows(2) {
        assert!(
            (sides[0] / sides[1] - 1.0).abs() < 0.1,
            "{what}: {found:?} m, so {sides:?} m on the two sides of a border"
        );
    }
}

/// Four splits, so three borders; 0.8 m are 2.2 texels of the coarsest map and more of the others,
/// but no more than the filter may take.
#[test]
fn edges_are_as_wide_on_both_sides_of_every_border() {
    for (filter, softness, maps) in [
        (PCF7, "filter-width=0.8", [64.0, 90.0, 130.0, 190.0]),
        (EVSM4, "filter-width=0.8 bleeding=0.02", [16.0, 40.0, 90.0, 190.0]),
    ] {
        assert!(2.0 * maps[3] / f64::from(SIZE) <= 0.8);
        let Some(found) = widths(filter, softness, maps, tent_share) else { return };
        eprintln!("{filter:?}: {found:.3?} m");
        check(found, 0.8, &format!("{filter:?}"));
    }
}

#[test]
fn discs_are_as_wide_as_they_are_told_in_every_split() {
    for width in [0.3f32, 0.8] {
        let softness = format!("filter-width={width}");
        let Some(found) = widths(DISC, &softness, [16.0, 40.0], disc_share) else { return };
        check(found, f64::from(width), "disc");
    }
}

#[test]
fn tents_are_as_wide_as_they_are_told_up_to_their_texels() {
    let softness = "filter-width=0.8";
    let Some(found) = widths(PCF7, softness, [64.0, 90.0], tent_share) else { return };
    check(found, 0.8, "pcf7");
    // Seven texels of 1/64 m are the most that it has.
    let Some(capped) = widths(PCF7, softness, [8.0, 90.0], tent_share) else { return };
    assert!((capped[0] / (7.0 / 64.0) - 1.0).abs() < 0.1, "{capped:?}");
}

/// Moments of two planes know the share of each, so an edge is the tent's; what is cut off as a
/// leak (here as much as floors of variance let through) narrows it alike everywhere.
#[test]
fn blurs_are_as_wide_as_they_are_told_in_every_split() {
    for filter in [ESM, VSM, EVSM2, EVSM4, MSM] {
        for width in [0.2f32, 0.8] {
            let softness = format!("filter-width={width} bleeding=0.02");
            let Some(found) = widths(filter, &softness, [16.0, 40.0], tent_share) else { return };
            check(found, f64::from(width), &format!("{filter:?}"));
        }
        let Some(found) = widths(filter, "", [24.0, 36.0], tent_share) else { return };
        check_borders(found, &format!("{filter:?}"));
        // 15 texels of 1/32 m to each side are the most.
        let softness = "filter-width=2 bleeding=0.02";
        let Some(capped) = widths(filter, softness, [16.0, 40.0], tent_share) else { return };
        assert!((capped[0] / (30.0 / 32.0) - 1.0).abs() < 0.1, "{filter:?}: {capped:?}");
    }
}

#[test]
fn penumbrae_follow_from_height_and_angle() {
    for degrees in [2.0f64, 4.0] {
        let softness = format!("sun-angle={degrees}");
        let Some(found) = widths(PCSS, &softness, [16.0, 40.0], disc_share) else { return };
        check(found, 2.0 * f64::from(HEIGHT) * (0.5 * degrees).to_radians().tan(), "pcss");
    }
}

#[test]
fn a_point_of_a_sun_throws_the_narrowest_edge() {
    let softness = "sun-angle=0";
    let Some(found) = widths(PCSS, softness, [16.0, 40.0], disc_share) else { return };
    for (width, map) in found.iter().zip([16.0, 40.0]) {
        assert!(*width < 3.0 * map / 512.0, "{found:?}");
    }
}
