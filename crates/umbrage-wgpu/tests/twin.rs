//! The WGSL on a GPU against its twin on the CPU, over random input.

mod common;

use common::{Gpu, World, ask, plan};
use glam::{DVec3, Vec3};
use umbrage_shaders::{layout, twin};
use umbrage_wgpu::{DepthFormat, Filter, FrameOptions, ShadowMapsOptions, Softness};

/// Numbers in [0, 1) from a linear congruential generator (Knuth's constants).
fn random() -> impl FnMut() -> f32 {
    let mut state = 11u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

#[test]
fn tent_taps_agree() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, Default::default())
        + "@group(0) @binding(0) var<storage, read> input: array<vec4f>;
           @group(0) @binding(1) var<storage, read_write> output: array<vec4f>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x >= arrayLength(&input) { return; }
               let it = input[id.x];
               let tap = umbrage_filter_tent_tap(vec2f(it.x), vec2f(it.y), vec2f(it.z));
               output[id.x] = vec4f(tap.texel.x, tap.weight.x, umbrage_filter_tent_integral(vec2f(it.w), vec2f(it.z)).x, 0.0);
           }";
    let mut next = random();
    let input: Vec<[f32; 4]> = (0..20_000)
        .map(|i| {
            // Every tap of every kernel, at places that include texel edges and centres.
            let r = [1.5f32, 2.5, 3.5, 1.0 + 2.5 * next()][i % 4];
            let centre = if i % 3 == 0 { (next() * 2048.0).floor() / 2.0 } else { next() * 1024.0 };
            let tap = (next() * (r + 0.5)).floor();
            [(centre - r).floor() + 2.0 * tap, centre, r, 8.0 * next() - 4.0]
        })
        .collect();
    let output: Vec<[f32; 4]> = gpu.compute(&source, &input, None);
    for (&[first, centre, r, x], &[texel, weight, integral, _]) in input.iter().zip(&output) {
        let (twin_texel, twin_weight) = twin::tent_tap(first, centre, r);
        // Two roundings of numbers near 1000 apart (1.2e-4), as an FMA may leave out.
        assert!((texel - twin_texel).abs() < 3e-4, "{texel} {twin_texel}");
        assert!((weight - twin_weight).abs() < 1e-5, "{weight} {twin_weight}");
        assert!((integral - twin::tent_integral(x, r)).abs() < 1e-6);
    }
    assert_eq!(output.len(), 20_000);
}

#[test]
fn filters_reach_as_far_as_they_say() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, Default::default())
        + "@group(0) @binding(0) var<storage, read> input: array<u32>;
           @group(0) @binding(1) var<storage, read_write> output: array<f32>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x < arrayLength(&input) { output[id.x] = umbrage_filter_radius(input[id.x]); }
           }";
    let filters = [
        (layout::FilterKind::Hard, Filter::Hard),
        (layout::FilterKind::Pcf2, Filter::Pcf2),
        (layout::FilterKind::Pcf3, Filter::Pcf3),
        (layout::FilterKind::Pcf5, Filter::Pcf5),
        (layout::FilterKind::Pcf7, Filter::Pcf7),
        (layout::FilterKind::Disc, Filter::Disc),
        (layout::FilterKind::Pcss, Filter::Pcss),
    ];
    let radii: Vec<f32> = gpu.compute(&source, &filters.map(|(kind, _)| kind as u32), None);
    for (radius, (_, filter)) in radii.iter().zip(filters) {
        assert_eq!(f64::from(*radius), filter.radius_texels(), "{filter:?}");
    }
}

#[test]
fn discs_widths_and_noise_agree() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, Default::default())
        + "@group(0) @binding(0) var<storage, read> input: array<vec4f>;
           @group(0) @binding(1) var<storage, read_write> output: array<vec4f>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x >= arrayLength(&input) { return; }
               let it = input[id.x];
               let point = umbrage_filter_vogel(u32(it.x), 32u, it.y);
               let wide = umbrage_filter_half_width(it.z, vec2f(it.w), 2.5, 15.0).x;
               output[id.x] = vec4f(point, wide, umbrage_filter_gradient_noise(vec2f(it.x + 0.5, it.x * 2.0 + 0.5)));
           }";
    let mut next = random();
    let input: Vec<[f32; 4]> = (0..4096u16)
        .map(|i| [f32::from(i % 32), 6.0 * next() - 3.0, if i % 5 == 0 { 0.0 } else { 2.0 * next() }, 0.01 + next()])
        .collect();
    let output: Vec<[f32; 4]> = gpu.compute(&source, &input, None);
    for (&[i, turn, width, texel], &[x, y, wide, noise]) in input.iter().zip(&output) {
        let [twin_x, twin_y] = twin::vogel(i as u32, 32, turn);
        // Sines of angles up to 80: WGSL promises 2^-11 near 0 and nothing beyond; drivers keep 1e-4.
        assert!((x - twin_x).abs() < 1e-3 && (y - twin_y).abs() < 1e-3, "{x} {y}, {twin_x} {twin_y}");
        assert!((wide - twin::half_width(width, texel, 2.5, 15.0)).abs() < 1e-4);
        assert!((noise - twin::gradient_noise([i + 0.5, i * 2.0 + 0.5])).abs() < 1e-3);
    }
}

#[test]
fn selection_agrees_at_and_around_every_border() {
    let Some(gpu) = Gpu::new() else { return };
    let sizes = [64; 8];
    let options = ShadowMapsOptions {
        map_sizes: sizes.to_vec(),
        depth_format: DepthFormat::D32Float,
        filter: Filter::Hard,
        ..Default::default()
    };
    let mut world = World::new(gpu, &options);
    let planes = [1.0, 2.5, 6.0, 14.0, 30.0, 65.0, 140.0, 300.0, 640.0];
    let mut plan = plan(DVec3::NEG_Y, DVec3::ZERO, &sizes, &planes, &[2000.0; 8]);
    for split in &mut plan.splits {
        split.blend_begin = split.near + 0.8 * (split.far - split.near);
    }
    plan.fade_begin = 500.0;
    // Nothing is drawn: everything is lit, and only the choice is looked at.
    world.draw(&plan, &FrameOptions::default(), &[Vec3::ZERO; 3]);
    let mut next = random();
    let mut depths: Vec<f32> = (0..5000).map(|_| 700.0 * next() * next() - 5.0).collect();
    for plane in planes.map(|plane| plane as f32) {
        depths.extend([plane.next_down(), plane, plane.next_up()]);
    }
    let asks: Vec<_> = depths.iter().map(|&depth| ask(Vec3::new(depth, 0.0, 3.0), Vec3::Y)).collect();
    let mut frame = layout::Frame { split_count: 8, ..Default::default() };
    for (uniform, split) in frame.splits.iter_mut().zip(&plan.splits) {
        uniform.far = split.far as f32;
    }
    for (answer, depth) in world.ask(&asks).iter().zip(&depths) {
        let expected = twin::split_at(&frame, *depth).map_or(-1, |split| split as i32);
        assert_eq!(answer.split, expected, "at view depth {depth}");
        assert_eq!(answer.visibility, 1.0, "at view depth {depth}");
    }
}

/// What the planner is told of discs: as many texels as they have without a width, and metres where those say more.
#[test]
fn discs_say_how_many_metres_they_reach() {
    let wide = Softness { width_m: Some(0.8), sun_angle: 0.1, ..Softness::default() };
    assert_eq!(Filter::Disc.reach(&Softness::default()), (4.0, None));
    let (texels, metres) = Filter::Disc.reach(&wide);
    assert!(texels == 16.0 && metres.is_some_and(|metres| (metres - 0.4).abs() < 1e-6), "{metres:?}");
    let (texels, metres) = Filter::Pcss.reach(&wide);
    assert!(texels == 16.0 && metres.is_some_and(|metres| (metres - 200.0 * 0.05f64.tan()).abs() < 1e-5), "{metres:?}");
    assert_eq!(Filter::Pcf5.reach(&wide), (2.5, None));
}
