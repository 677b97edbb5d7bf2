//! The WGSL on a GPU against its twin on the CPU, over random input.

mod common;

use bytemuck::{Pod, Zeroable};
use common::{DISC, Gpu, World, ask, config, depth_filters, plan};
use glam::{DVec3, Vec3};
use umbrage::config::Filter;
use umbrage_shaders::{layout, twin};
use umbrage_wgpu::FrameOptions;

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
    let source = umbrage_shaders::receiver(1, umbrage_shaders::Maps { without_loads: true, ..Default::default() })
        + "@group(0) @binding(0) var<storage, read> input: array<vec4f>;
           @group(0) @binding(1) var<storage, read_write> output: array<vec4f>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x >= arrayLength(&input) { return; }
               let it = input[id.x];
               let tap = umbrage_kernel_pair(2u, vec2f(it.x), vec2f(it.y), vec2f(it.z));
               output[id.x] = vec4f(tap.texel.x, tap.weight.x, umbrage_kernel_integral(vec2f(it.w), vec2f(it.z)).x, 0.0);
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

/// Nine taps give 6×6 texels the weights that [Castano13] derives for a sample a share `s` of the
/// way from one texel's centre to the next: (1 − s, 3 − 2s, 4 − s, 3 + s, 1 + 2s, s) / 12 per axis.
#[test]
fn castano_s_taps_weigh_texels_as_published() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, umbrage_shaders::Maps { without_loads: true, ..Default::default() })
        + "@group(0) @binding(0) var<storage, read> input: array<vec2f>;
           @group(0) @binding(1) var<storage, read_write> output: array<vec2f>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x >= arrayLength(&input) { return; }
               let it = input[id.x];
               let tap = umbrage_kernel_pair(5u, vec2f(it.x), vec2f(it.y), vec2f(2.5));
               output[id.x] = vec2f(tap.texel.x - it.x - 0.5, tap.weight.x);
           }";
    let mut next = random();
    let places: Vec<(f32, f32)> = (0..4096u16)
        .map(|i| {
            let s = if i % 4 == 0 { f32::from(i % 16) / 16.0 } else { next() };
            (f32::from(i % 512) + 0.5, s)
        })
        .collect();
    let taps = places.iter().flat_map(|&(texel, s)| [-2.0, 0.0, 2.0].map(|pair| [texel - 0.5 + pair, texel + s]));
    let output: Vec<[f32; 2]> = gpu.compute(&source, &taps.collect::<Vec<_>>(), None);
    for ((_, s), taps) in places.iter().zip(output.chunks(3)) {
        let weights: Vec<f32> =
            taps.iter().flat_map(|&[second, weight]| [weight * (1.0 - second), weight * second]).collect();
        let published = [1.0 - s, 3.0 - 2.0 * s, 4.0 - s, 3.0 + s, 1.0 + 2.0 * s, *s].map(|twelfths| twelfths / 12.0);
        // A place near 512 is known to 6e-5 of a texel, and a weight changes by a sixth of that.
        assert!(weights.iter().zip(published).all(|(a, b)| (a - b).abs() < 5e-5), "{s}: {weights:?}, {published:?}");
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5 && weights.iter().all(|weight| *weight >= 0.0));
    }
}

#[test]
fn filters_reach_as_far_as_they_say() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, umbrage_shaders::Maps::default())
        + "@group(0) @binding(0) var<storage, read> input: array<u32>;
           @group(0) @binding(1) var<storage, read_write> output: array<f32>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x < arrayLength(&input) { output[id.x] = umbrage_kernel_radius(input[id.x]); }
           }";
    // A disc without a width reaches what its width in texels says, less than the most.
    let of = |filter| match filter {
        Filter::Disc { rotated, .. } => Filter::Disc { width_m: Some(1.0), rotated },
        other => other,
    };
    let kinds = layout::FilterKind::ALL.into_iter().filter(|kind| !kind.is_of_moments());
    let filters: Vec<_> = kinds.zip(depth_filters().map(of)).collect();
    let numbers: Vec<u32> = filters.iter().map(|(kind, _)| *kind as u32).collect();
    let radii: Vec<f32> = gpu.compute(&source, &numbers, None);
    assert_eq!(radii.len(), depth_filters().count());
    for (radius, (_, filter)) in radii.iter().zip(filters) {
        assert_eq!(f64::from(*radius), filter.radius_texels(), "{filter:?}");
    }
}

#[test]
fn discs_widths_and_noise_agree() {
    let Some(gpu) = Gpu::new() else { return };
    let source = umbrage_shaders::receiver(1, umbrage_shaders::Maps::default())
        + "@group(0) @binding(0) var<storage, read> input: array<vec4f>;
           @group(0) @binding(1) var<storage, read_write> output: array<vec4f>;
           @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
               if id.x >= arrayLength(&input) { return; }
               let it = input[id.x];
               let point = umbrage_disc_vogel(u32(it.x), 32u, it.y);
               // What the taps reach is less than the kernel's own width for one half of them.
               let wide = umbrage_kernel_half_width(it.z, vec2f(it.w), 2.5, select(15.0, 2.0, (id.x & 1u) == 1u)).x;
               output[id.x] = vec4f(point, wide, umbrage_filter_gradient_noise(vec2f(it.x + 0.5, it.x * 2.0 + 0.5)));
           }";
    let mut next = random();
    let input: Vec<[f32; 4]> = (0..4096u16)
        .map(|i| [f32::from(i % 32), 6.0 * next() - 3.0, if i % 5 == 0 { 0.0 } else { 2.0 * next() }, 0.01 + next()])
        .collect();
    let output: Vec<[f32; 4]> = gpu.compute(&source, &input, None);
    for (index, (&[i, turn, width, texel], &[x, y, wide, noise])) in input.iter().zip(&output).enumerate() {
        let most = if index % 2 == 1 { 2.0 } else { 15.0 };
        let [twin_x, twin_y] = twin::vogel(i as u32, 32, turn);
        // Sines of angles up to 80: WGSL promises 2^-11 near 0 and nothing beyond; drivers keep
        // 1e-4.
        assert!((x - twin_x).abs() < 1e-3 && (y - twin_y).abs() < 1e-3, "{x} {y}, {twin_x} {twin_y}");
        assert!((wide - twin::half_width(width, texel, 2.5, most)).abs() < 1e-4);
        assert!((noise - twin::gradient_noise([i + 0.5, i * 2.0 + 0.5])).abs() < 1e-3);
    }
}

#[test]
fn selection_agrees_at_and_around_every_border() {
    let Some(gpu) = Gpu::new() else { return };
    let sizes = [64; 8];
    let mut world = World::new(gpu, &config(&sizes, Filter::Hard, ""));
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

/// Discs keep free as many texels as they have without a width, and metres where those say more.
#[test]
fn discs_say_how_many_metres_they_reach() {
    let reach = |filter: Filter| (filter.radius_texels(), filter.radius_m());
    // A tap reaches one texel past its place.
    assert_eq!(reach(DISC), (f64::from(twin::DISC_RADIUS) + 1.0, None));
    let (texels, metres) = reach(Filter::Disc { width_m: Some(0.8), rotated: false });
    assert!(texels == 16.0 && metres.is_some_and(|metres| (metres - 0.4).abs() < 1e-6), "{metres:?}");
    let (texels, metres) = reach(Filter::Pcss { sun_degrees: 0.1_f64.to_degrees(), rotated: false });
    let expected = f64::from(twin::MOST_BLOCKER_M) * 0.05f64.tan();
    assert!(texels == 16.0 && metres.is_some_and(|metres| (metres - expected).abs() < 1e-5), "{metres:?}");
    assert_eq!(reach(Filter::Pcf5 { width_m: Some(0.8) }), (2.5, None));
}

/// A receiver and a texel near it, as the shader below takes them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct BiasAsk {
    split: layout::Split,
    position: [f32; 4],
    normal: [f32; 4],
    to_light: [f32; 4],
    /// Offset in texels, what the texel stores, and texels of reach without a plane; negative for
    /// with one.
    tap: [f32; 4],
    /// What the next texels store, and the offset of a texel that may lie across the crease.
    beyond: [f32; 4],
    /// What those behind them store more, and two numbers that stand for nothing.
    farther: [f32; 4],
}

/// What the shader below makes of it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct BiasAnswer {
    texel: [f32; 2],
    slope: [f32; 2],
    tilt: [f32; 2],
    texel_m: [f32; 2],
    linear: [f32; 2],
    depth: f32,
    range_m: f32,
    tolerance: [f32; 4],
    reference: f32,
    /// Bits: behind, the same surface, meets the receiver, makes a crease, lies across it, own,
    /// before the plane, goes on along u and v, straight along u and v.
    decided: u32,
    padding: [u32; 2],
    /// Height and rise of the crease, and what is unsure.
    crease: [f32; 4],
}

const ASK_BIAS: &str = "
struct BiasAsk { split: UmbrageSplit, position: vec4f, normal: vec4f, to_light: vec4f, tap: vec4f, beyond: vec4f,
    farther: vec4f }
struct BiasAnswer {
    texel: vec2f, slope: vec2f, tilt: vec2f, texel_m: vec2f, linear: vec2f, depth: f32, range_m: f32,
    tolerance: vec4f, reference: f32, decided: u32, crease: vec4f,
}
@group(0) @binding(0) var<storage, read> asks: array<BiasAsk>;
@group(0) @binding(1) var<storage, read_write> answers: array<BiasAnswer>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let it = asks[id.x];
    var at = umbrage_bias_receiver(it.split, it.position.xyz, it.normal.xyz, it.to_light.xyz);
    if it.tap.w >= 0.0 {
        at = umbrage_bias_without_plane(at, vec2f(it.tap.w));
    }
    let behind = umbrage_bias_lies_behind(at, it.tap.xy, it.tap.z);
    let same = umbrage_bias_same_surface(at, it.tap.xy, it.tap.z);
    let meets = umbrage_bias_meets_receiver(at, it.tap.xy, it.tap.z, it.beyond.xy);
    let farther = it.beyond.xy + it.farther.xy;
    let crease = umbrage_bias_crease_at(at, it.tap.xy, it.tap.z, it.beyond.xy, farther);
    let before = umbrage_bias_before_plane(at, it.beyond.zw, it.tap.z);
    let across = umbrage_crease_is_across(crease, it.beyond.zw, before);
    let bits = vec3u(vec3<bool>(behind, same, meets)) << vec3u(0u, 1u, 2u);
    let of_crease = vec2u(vec2<bool>(umbrage_crease_is_there(crease), across)) << vec2u(3u, 4u);
    let own = umbrage_bias_is_own(at, it.tap.xy, it.tap.z);
    let nearer = umbrage_bias_lies_before(at, it.tap.xy, it.tap.z, at.tolerance.rounding);
    let of_plane = vec2u(vec2<bool>(own, nearer)) << vec2u(5u, 6u);
    let nexts = umbrage_bias_beyond_before_plane(at, it.tap.xy, -1.0, it.beyond.xy);
    let goes_on = umbrage_bias_goes_on(at, umbrage_bias_before_plane(at, it.tap.xy, it.tap.z), nexts);
    let straight = umbrage_bias_is_straight(at, vec2f(it.tap.z), it.beyond.xy, farther);
    let of_row = vec4u(vec4<bool>(goes_on, straight)) << vec4u(7u, 8u, 9u, 10u);
    let tolerance = vec4f(at.tolerance.bend, at.tolerance.past, at.tolerance.steep, at.tolerance.arrival);
    answers[id.x] = BiasAnswer(at.texel, at.slope, at.tilt, at.texel_m, at.linear, at.depth, at.range_m, tolerance,
        umbrage_bias_reference(at, it.tap.xy, vec2f(0.5)),
        bits.x | bits.y | bits.z | of_crease.x | of_crease.y | of_plane.x | of_plane.y | of_row.x | of_row.y | of_row.z | of_row.w,
        vec4f(crease.height, crease.rise, crease.unsure));
}";

/// A plain map, a warped one, or a local light's of either kind of depth, around a point before it.
fn bias_ask(next: &mut impl FnMut() -> f32, kind: usize) -> BiasAsk {
    let unit = |next: &mut dyn FnMut() -> f32| loop {
        let v = Vec3::new(next(), next(), next()) * 2.0 - 1.0;
        if (0.1..1.0).contains(&v.length()) {
            return v.normalize();
        }
    };
    let d = unit(next);
    let u = d.any_orthonormal_vector();
    let v = d.cross(u);
    let texel_m = [0.01 + 0.3 * next(), 0.01 + 0.3 * next()];
    let row = |xyz: Vec3, w: f32| xyz.extend(w).to_array();
    let mut position = unit(next) * 100.0 * next();
    let mut to_light = -d;
    let mut split = layout::Split {
        u_row: row(u / texel_m[0], next()),
        v_row: row(v / texel_m[1], next()),
        texel_m,
        size: 1024.0,
        ..Default::default()
    };
    let range = 50.0 + 400.0 * next();
    split.depth_row = row(d / range, 0.5);
    split.depth_range_m = range;
    split.depth_step_m = if next() < 0.3 { range / 65535.0 } else { 0.0 };
    if kind == 1 {
        // w changes across the light alone.
        let way = u * (next() - 0.5) + v * (next() - 0.5);
        split.w_row = row(way * 0.01, 1.0);
    }
    if kind >= 2 {
        // A lamp in the frame's origin that shines along d.
        let (near, far, focal) = (0.1, 30.0, 200.0 + 400.0 * next());
        let w = 0.3 + 20.0 * next();
        position = (d + u * (next() - 0.5) + v * (next() - 0.5)) * w;
        to_light = -position.normalize();
        split.u_row = row(u * focal + d * 512.0, 0.0);
        split.v_row = row(v * focal + d * 512.0, 0.0);
        split.w_row = row(d, 0.0);
        split.depth_row = [0.0, 0.0, 0.0, -far * near / (far - near)];
        split.depth_offset = far / (far - near);
        split.depth_range_m = 1.0;
        split.depth_step_m = 0.0;
        split.is_linear = u32::from(kind == 3);
    }
    // From facing the light to grazed by it.
    let aside = unit(next);
    let normal = (to_light + (aside - to_light * aside.dot(to_light)) * (4.0 * next()).exp()).normalize();
    let offset = [8.0 * next() - 4.0, 8.0 * next() - 4.0];
    let at = twin::bias::receiver(&split, position.to_array(), normal.to_array(), to_light.to_array());
    // Around every border of the decision.
    let width = at.tolerance.past + at.tolerance.bend + (at.slope[0] * offset[0] + at.slope[1] * offset[1]).abs();
    let mut stored = (at.reference(offset, [0.0; 2]) + (3.0 * next() - 1.5) * width).clamp(0.0, 1.0);
    let mut beyond = [stored + (2.0 * next() - 1.0) * width, stored + (2.0 * next() - 1.0) * width];
    if next() < 0.4 {
        // A surface that passes close over or under the receiver.
        let away = texel_m.map(|texel| 6.0 * next() * at.tolerance.crease * texel);
        let before = away[0] * offset[0].abs() + away[1] * offset[1].abs() + (3.5 * next() - 1.0) * away[0];
        stored = at.before_plane(offset, 0.0) - before;
        beyond = [0, 1].map(|i| stored + (at.tilt[i] + at.slope[i]) * offset[i].signum() - away[i]);
    }
    let reach = if next() < 0.2 { 2.0 * next() } else { -1.0 };
    let other = [4.0 * next() - 2.0, 4.0 * next() - 2.0];
    let farther = [0, 1].map(|i| (beyond[i] - stored) * (0.8 + 0.3 * next()));
    BiasAsk {
        split,
        position: position.extend(0.0).to_array(),
        normal: normal.extend(0.0).to_array(),
        to_light: to_light.extend(0.0).to_array(),
        tap: [offset[0], offset[1], stored, reach],
        beyond: [beyond[0], beyond[1], other[0], other[1]],
        farther: [farther[0], farther[1], 0.0, 0.0],
    }
}

/// The twin's receiver of a question.
fn bias_receiver(ask: &BiasAsk) -> twin::bias::Receiver {
    let xyz = |v: [f32; 4]| [v[0], v[1], v[2]];
    let at = twin::bias::receiver(&ask.split, xyz(ask.position), xyz(ask.normal), xyz(ask.to_light));
    if ask.tap[3] >= 0.0 { at.without_plane([ask.tap[3]; 2]) } else { at }
}

/// What the twin decides: the same bits.
fn bias_decided(at: &twin::bias::Receiver, ask: &BiasAsk, stored: f32) -> u32 {
    let (offset, beyond) = ([ask.tap[0], ask.tap[1]], [ask.beyond[0], ask.beyond[1]]);
    let farther = [beyond[0] + ask.farther[0], beyond[1] + ask.farther[1]];
    let crease = at.crease_at(offset, stored, beyond, farther);
    let other = [ask.beyond[2], ask.beyond[3]];
    let nexts = at.beyond_before_plane(offset, -1.0, beyond);
    let goes_on = at.goes_on(at.before_plane(offset, stored), nexts).map(u32::from);
    let straight = at.is_straight([stored; 2], beyond, farther).map(u32::from);
    u32::from(at.lies_behind(offset, stored))
        | u32::from(at.same_surface(offset, stored)) << 1
        | u32::from(at.meets_receiver(offset, stored, beyond)) << 2
        | u32::from(crease.is_there()) << 3
        | u32::from(crease.is_across(other, at.before_plane(other, stored))) << 4
        | u32::from(at.is_own(offset, stored)) << 5
        | u32::from(at.lies_before(offset, stored, at.tolerance.rounding)) << 6
        | goes_on[0] << 7
        | goes_on[1] << 8
        | straight[0] << 9
        | straight[1] << 10
}

/// Decisions of the twin that hold a little nearer and a little farther, and how many of them the
/// GPU does not share.
fn bias_disagreements(
    asks: &[BiasAsk],
    answers: &[BiasAnswer],
    twin: impl Fn(&BiasAsk) -> twin::bias::Receiver,
) -> [usize; 2] {
    let (mut sure, mut wrong) = (0, 0);
    for (ask, answer) in asks.iter().zip(answers) {
        let at = twin(ask);
        let span = at.tolerance.past + (at.slope[0] * ask.tap[0] + at.slope[1] * ask.tap[1]).abs();
        // A tangent of a grazed surface is a quotient of small numbers, and all that is aside grows
        // with the way there.
        let aside_m = (ask.tap[0] * at.texel_m[0]).hypot(ask.tap[1] * at.texel_m[1]);
        let unsure = 2e-5 + 1e-3 * span + 0.02 * aside_m / at.range_m;
        let [near, here, far] = [-unsure, 0.0, unsure].map(|by| bias_decided(&at, ask, ask.tap[2] + by));
        if near == here && here == far {
            sure += 1;
            wrong += usize::from(answer.decided != here);
            if answer.decided != here {
                eprintln!("{:b} and {here:b}: {at:?} {ask:?}", answer.decided);
            }
        }
    }
    [sure, wrong]
}

#[test]
fn bias_agrees_in_every_kind_of_map() {
    let Some(gpu) = Gpu::new() else { return };
    // Maps of colours are the ones that may hold a depth that is linear in w.
    let maps = umbrage_shaders::Maps { r32f: true, ..Default::default() };
    let source = umbrage_shaders::receiver(1, maps) + ASK_BIAS;
    let mut next = random();
    let asks: Vec<BiasAsk> = (0..20_000).map(|i| bias_ask(&mut next, i % 4)).collect();
    let answers: Vec<BiasAnswer> = gpu.compute(&source, &asks, None);
    let mut seen = [[0; 2]; 11];
    for (ask, answer) in asks.iter().zip(&answers) {
        let at = bias_receiver(ask);
        let close = |found: f32, twin: f32, scale: f32| {
            assert!((found - twin).abs() <= 2e-4 * (twin.abs() + scale), "{found} {twin} of {ask:?}: {answer:?}");
        };
        let tolerance = [at.tolerance.bend, at.tolerance.past, at.tolerance.steep, at.tolerance.arrival];
        (0..2).for_each(|i| {
            close(answer.texel[i], at.texel[i], 1.0);
            close(answer.slope[i], at.slope[i], at.slope[0].abs() + at.slope[1].abs());
            close(answer.tilt[i], at.tilt[i], at.tilt[0].abs() + at.tilt[1].abs() + 1e-6);
            close(answer.texel_m[i], at.texel_m[i], 0.0);
            close(answer.linear[i], at.linear[i], 0.0);
        });
        close(answer.depth, at.depth, 0.01);
        close(answer.range_m, at.range_m, 0.0);
        close(answer.reference, at.reference([ask.tap[0], ask.tap[1]], [0.5; 2]), 0.02);
        // The tangent of a grazed surface is a quotient of small numbers.
        (0..4)
            .for_each(|i| close(answer.tolerance[i], tolerance[i], 5.0 * tolerance[i].abs() + 1.0 / at.range_m * 0.1));
        (0..11).for_each(|bit| seen[bit][(answer.decided >> bit & 1) as usize] += 1);
    }
    let [sure, wrong] = bias_disagreements(&asks, &answers, bias_receiver);
    assert_eq!(wrong, 0, "of {sure}");
    assert!(sure > 12_000 && seen.iter().flatten().all(|&count| count > 1000), "{sure} {seen:?}");
    // The comparison can say no: to a constant bias that is larger by half a texel, to a plane that
    // is not followed.
    let biased = |ask: &BiasAsk| {
        let at = bias_receiver(ask);
        twin::bias::Receiver { depth: at.depth - 0.5 * at.texel_m[0] / at.range_m, ..at }
    };
    assert!(bias_disagreements(&asks, &answers, biased)[1] > 100);
    let flat = |ask: &BiasAsk| twin::bias::Receiver { slope: [0.0; 2], ..bias_receiver(ask) };
    assert!(bias_disagreements(&asks, &answers, flat)[1] > 100);
}
