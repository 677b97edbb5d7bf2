//! Filters of moments on a GPU: light, shadow, borders, levels, fallbacks.

mod common;

use common::{Ask, Gpu, World, ask, cuboid, ground, plan, quad};
use glam::{DVec3, Vec3};
use umbrage::ShadowPlan;
use umbrage_wgpu::{
    Error, Filter, FrameOptions, LightSlot, MomentStorage, ShadowMaps, ShadowMapsOptions, Softness, Storage,
};

const ALL: [Filter; 5] = [Filter::Esm, Filter::Vsm, Filter::Evsm2, Filter::Evsm4, Filter::Msm];
const SLANTED: DVec3 = DVec3::new(0.3, -0.8, 0.2);

fn options(map_sizes: &[u32], filter: Filter) -> ShadowMapsOptions {
    ShadowMapsOptions { map_sizes: map_sizes.to_vec(), filter, ..Default::default() }
}

fn without_float_filtering() -> Option<Gpu> {
    Gpu::without(wgpu::Features::FLOAT32_FILTERABLE)
}

fn up(points: &[Vec3]) -> Vec<Ask> {
    points.iter().map(|&point| ask(point, Vec3::Y)).collect()
}

fn grid(x: std::ops::Range<i32>, z: std::ops::Range<i32>, step: f32) -> Vec<Vec3> {
    x.flat_map(|i| z.clone().map(move |k| step * Vec3::new(i as f32, 0.0, k as f32))).collect()
}

/// One map of 40 m around x = 20; depths 20 m before and behind are seen.
fn one_map(light: DVec3, size: u32) -> ShadowPlan {
    let mut plan = plan(light, DVec3::new(20.0, 0.0, 0.0), &[size], &[0.1, 100.0], &[40.0]);
    let middle = plan.splits[0].depth_axis.dot(DVec3::new(20.0, 0.0, 0.0));
    plan.splits[0].receiver_depths = (middle - 20.0, middle + 20.0);
    plan
}

/// A sunlit plane is lit under every angle and with every width; a steep one under a wide blur loses a little of it
/// to what four moments or a falling exponential make of its own depths.
#[test]
fn planes_do_not_shade_themselves() {
    for filter in ALL {
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &options(&[256], filter));
        for (tilt, turn) in [(0.0, 0.0), (40.0, 10.0), (70.0, 100.0), (80.0, 300.0)] {
            let (tilt, turn) = (f64::to_radians(tilt), f64::to_radians(turn));
            let light = -DVec3::new(tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin());
            for width_m in [None, Some(2.0)] {
                let softness = Softness { width_m, ..Softness::default() };
                world.draw(&one_map(light, 256), &FrameOptions { softness, ..FrameOptions::default() }, &ground(400.0));
                let points = grid(80..240, -60..60, 0.0913);
                for (point, answer) in points.iter().zip(world.ask(&up(&points))) {
                    let lit = answer.visibility;
                    assert!(lit > 0.9, "{filter:?}, light {light}, width {width_m:?}: {point} is {lit}");
                }
            }
        }
    }
}

/// A wall's shadow on the ground, deep inside and far outside, as every storage has it.
#[test]
fn walls_throw_shadows_in_every_storage() {
    for (filter, withheld, storage) in [
        (Filter::Esm, false, MomentStorage::Floats),
        (Filter::Vsm, false, MomentStorage::Floats),
        (Filter::Evsm2, false, MomentStorage::Floats),
        (Filter::Evsm4, false, MomentStorage::Floats),
        (Filter::Msm, false, MomentStorage::Floats),
        (Filter::Esm, true, MomentStorage::Halves),
        (Filter::Vsm, true, MomentStorage::FloatsByHand),
        (Filter::Evsm2, true, MomentStorage::Halves),
        (Filter::Evsm4, true, MomentStorage::Halves),
        (Filter::Msm, true, MomentStorage::FloatsByHand),
    ] {
        let Some(gpu) = (if withheld { without_float_filtering() } else { Gpu::new() }) else { return };
        let can = gpu.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE);
        let mut world = World::new(gpu, &options(&[256], filter));
        if withheld || can {
            assert_eq!(world.maps.moment_storage(), Some(storage), "{filter:?}");
        }
        let mut triangles = ground(400.0);
        triangles.extend(cuboid(Vec3::new(18.0, 0.0, -4.0), Vec3::new(19.0, 6.0, 4.0)));
        world.draw(&one_map(SLANTED, 256), &FrameOptions::default(), &triangles);
        // The light goes 0.375 m along x and 0.25 m along z a metre down: the shadow of the wall reaches to x = 21.25.
        let dark: Vec<Vec3> = (-25..25).map(|k| Vec3::new(20.0, 0.0, 0.1 * k as f32)).collect();
        let lit: Vec<Vec3> = (-60..60).map(|k| Vec3::new(24.0, 0.0, 0.1 * k as f32)).collect();
        for answer in world.ask(&up(&dark)) {
            assert!(answer.visibility < 0.02, "{filter:?} in {storage:?}: {} in the shadow", answer.visibility);
        }
        for answer in world.ask(&up(&lit)) {
            assert!(answer.visibility > 0.98, "{filter:?} in {storage:?}: {} in the light", answer.visibility);
        }
    }
}

/// What the shader filters by itself is what the sampler filters, to the eight bits of a sampler's weights.
#[test]
fn by_hand_is_as_by_sampler() {
    let mut answers = Vec::new();
    for gpu in [Gpu::new(), without_float_filtering()] {
        let Some(gpu) = gpu else { return };
        let mut world = World::new(gpu, &options(&[128], Filter::Vsm));
        let mut triangles = ground(400.0);
        triangles.extend(cuboid(Vec3::new(18.0, 0.0, -4.0), Vec3::new(19.0, 6.0, 4.0)));
        world.draw(&one_map(SLANTED, 128), &FrameOptions::default(), &triangles);
        let points = grid(160..240, -60..60, 0.1);
        answers.push(world.ask(&up(&points)));
    }
    let off = answers[0].iter().zip(&answers[1]).map(|(a, b)| (a.visibility - b.visibility).abs());
    let worst = off.fold(0.0, f32::max);
    assert!(worst < 0.02, "{worst}");
    let between = answers[0].iter().filter(|answer| (0.1..0.9).contains(&answer.visibility)).count();
    assert!(between > 100, "only {between} points in penumbrae");
}

/// Neither blur nor levels reach into another layer, or past a map that is smaller than its layer.
#[test]
fn a_map_reads_itself_only() {
    for (filter, sizes) in [(Filter::Vsm, [256, 128]), (Filter::Msm, [100, 100]), (Filter::Evsm4, [90, 130])] {
        for dark in [0, 1] {
            let Some(gpu) = Gpu::new() else { return };
            let mut world = World::new(gpu, &options(&sizes, filter));
            let widths = [64.0, 64.0];
            let mut plan = plan(DVec3::NEG_Y, DVec3::ZERO, &sizes, &[1.0, 2.0, 400.0], &widths);
            // A roof over everything in one map; nothing but ground in the other.
            plan.splits[1 - dark].depth_near = 60.0;
            plan.splits[1 - dark].depth_far = 100.0;
            let softness = Softness { width_m: Some(60.0), ..Softness::default() };
            let frame = FrameOptions { softness, ..FrameOptions::default() };
            let roof = quad(
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                    .map(|(x, z)| Vec3::new(500.0 * x, 50.0, 500.0 * z)),
            );
            world.draw(&plan, &frame, &roof);
            let points = grid(-64..64, -64..64, 0.49);
            for (point, answer) in points.iter().zip(world.ask(&up(&points))) {
                let lit = answer.in_split[1 - dark];
                assert!(lit > 0.999, "{filter:?} {sizes:?}: {point} is {lit}, darkened by the other map");
                // Past its border a map is lit, and so is a blur that reaches there.
                let texel = widths[dark] as f32 / sizes[dark] as f32;
                if point.abs().max_element() < 32.0 - 17.0 * texel {
                    let lit = answer.in_split[dark];
                    assert!(lit < 0.01, "{filter:?} {sizes:?}: {point} is {lit}, lit by the other map");
                }
            }
        }
    }
}

/// Every level has the mean of the first, whether its edge is odd or not; what lies outside a smaller map counts as far away.
#[test]
fn levels_keep_the_mean() {
    let source = "
@group(0) @binding(0) var<storage, read> input: array<vec2u>;
@group(0) @binding(1) var<storage, read_write> output: array<vec4f>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&input) { return; }
    let level = input[id.x].x;
    let size = textureDimensions(umbrage_moment_maps) >> vec2u(level);
    var sum = vec4f(0.0);
    for (var y = 0u; y < size.y; y++) {
        for (var x = 0u; x < size.x; x++) { sum += textureLoad(umbrage_moment_maps, vec2u(x, y), input[id.x].y, level); }
    }
    output[id.x] = sum / f32(size.x * size.y) + 0.0 * umbrage_moments.bleeding;
}";
    for sizes in [[128, 128], [100, 75], [67, 67]] {
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &options(&sizes, Filter::Vsm));
        let plan = plan(SLANTED, DVec3::new(20.0, 0.0, 0.0), &sizes, &[1.0, 20.0, 60.0], &[40.0, 60.0]);
        world.draw(&plan, &FrameOptions::default(), &cuboid(Vec3::new(12.0, 0.0, -4.0), Vec3::new(23.0, 6.0, 4.0)));
        let levels = u32::ilog2(sizes[0]) - 1;
        let input: Vec<[u32; 2]> = (0..levels).flat_map(|level| [[level, 0], [level, 1]]).collect();
        // Nothing else of the text is used here, and a group has to be.
        let text = world.maps.receiver_wgsl(1) + source;
        let means: Vec<[f32; 4]> = world.gpu.compute(&text, &input, Some(&world.maps));
        for (&[level, layer], mean) in input.iter().zip(&means) {
            let first = means[layer as usize];
            for (m, expected) in mean.iter().zip(first) {
                assert!((m - expected).abs() < 1e-4, "{sizes:?}: {mean:?} instead of {first:?} in level {level}");
            }
        }
        assert!(means[0][0] < 0.99, "the box is there");
        assert!(levels >= 5);
    }
}

/// Four samples make smooth what one cuts: the mean visibility along an edge is the same, and its steps are smaller.
#[test]
fn four_samples_smooth_edges() {
    let mut roughness = Vec::new();
    for samples in [1, 4] {
        let Some(gpu) = Gpu::new() else { return };
        // The narrowest kernel: what smooths is the samples.
        let softness = Softness { width_m: Some(0.01), bleeding: 0.0, ..Softness::default() };
        let mut world = World::new(gpu, &ShadowMapsOptions { samples, ..options(&[128], Filter::Vsm) });
        let end = |z: f32| Vec3::new(20.0 + 0.1 * z, 10.0, z);
        let roof = quad([Vec3::new(-300.0, 10.0, -200.0), end(-200.0), end(200.0), Vec3::new(-300.0, 10.0, 200.0)]);
        let frame = FrameOptions { softness, ..FrameOptions::default() };
        world.draw(&one_map(DVec3::NEG_Y, 128), &frame, &[roof, ground(300.0)].concat());
        let along: Vec<Vec3> =
            (-500..500).map(|k| 0.01 * k as f32).map(|z| Vec3::new(20.0 + 0.1 * z, 0.0, z)).collect();
        let lit: Vec<f32> = world.ask(&up(&along)).iter().map(|answer| answer.visibility).collect();
        let mean = lit.iter().sum::<f32>() / lit.len() as f32;
        assert!((mean - 0.5).abs() < 0.05, "{mean} on the edge itself");
        roughness.push(lit.iter().map(|v| (v - mean).powi(2)).sum::<f32>());
    }
    assert!(roughness[1] < 0.5 * roughness[0], "{roughness:?}");
}

#[test]
fn bytes_count_everything() {
    let Some(gpu) = Gpu::new() else { return };
    let bytes = |filter, samples| {
        let options = ShadowMapsOptions { samples, ..options(&[256, 128], filter) };
        ShadowMaps::new(&gpu.device, &options).expect("valid options").bytes()
    };
    let depth = 2 * 256 * 256 * 4;
    assert_eq!(bytes(Filter::Pcf3, 1), depth);
    let texel = if gpu.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE) { 4 } else { 2 };
    // Levels 256 to 4, of two layers, and the texture between two blurs.
    let levels: u64 = (2..=8).map(|k| 1u64 << (2 * k)).sum();
    assert_eq!(bytes(Filter::Evsm4, 1), depth + 4 * texel * (2 * levels + 256 * 256));
    assert_eq!(bytes(Filter::Esm, 4), 4 * 4 * (256 * 256 + 128 * 128) + texel * (2 * levels + 256 * 256));
}

#[test]
fn what_cannot_be_is_an_error_that_says_so() {
    let Some(gpu) = without_float_filtering() else { return };
    let error = |options: ShadowMapsOptions| ShadowMaps::new(&gpu.device, &options).expect_err("it cannot be");
    for samples in [0, 2, 3, 8, 16] {
        let found = error(ShadowMapsOptions { samples, ..options(&[256], Filter::Vsm) });
        assert_eq!(found, Error::Samples { samples, filter: Filter::Vsm });
    }
    let found = error(ShadowMapsOptions { samples: 4, ..options(&[256], Filter::Pcf3) });
    assert_eq!(found, Error::Samples { samples: 4, filter: Filter::Pcf3 });
    for filter in ALL {
        let found = error(ShadowMapsOptions { fallbacks: false, ..options(&[256], filter) });
        assert_eq!(found, Error::NoFilterableFloats { filter });
        assert!(found.to_string().contains("FLOAT32_FILTERABLE"), "{found}");
        let found = error(options(&[32], filter));
        assert_eq!(found, Error::MapTooSmall { split: 0, size: 32, filter, least: 33 }, "a blur wider than the map");
        let found = error(ShadowMapsOptions { storage: Storage::Atlas, ..options(&[256], filter) });
        assert_eq!(found, Error::MomentsNeedArray { storage: Storage::Atlas, filter });
        let lights = vec![LightSlot::Single, LightSlot::Cube];
        let found = error(ShadowMapsOptions { lights: lights.clone(), ..options(&[256], filter) });
        assert_eq!(found, Error::MomentsNeedOneSun { lights, filter });
    }
}

#[test]
fn plans_and_frames_that_cannot_be_are_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let mut maps = ShadowMaps::new(&gpu.device, &options(&[256], Filter::Evsm4)).expect("valid options");
    let good = one_map(SLANTED, 256);
    let mut warped = good.clone();
    warped.splits[0].warp = Some(warped.splits[0].shadow_from_world());
    let found = maps.prepare(&gpu.queue, &warped, &FrameOptions::default()).expect_err("a warped map");
    assert_eq!(found, Error::WarpedMoments { split: 0, filter: Filter::Evsm4 });
    for depths in [(1.0, 1.0), (f64::NAN, 2.0), (0.0, f64::INFINITY)] {
        let mut bad = good.clone();
        bad.splits[0].receiver_depths = depths;
        let found = maps.prepare(&gpu.queue, &bad, &FrameOptions::default()).expect_err("no range");
        assert!(matches!(found, Error::InvalidSplit { field: "receiver_depths", .. }), "{found}");
    }
    for softness in [
        Softness { width_m: Some(0.0), ..Softness::default() },
        Softness { bleeding: 1.0, ..Softness::default() },
        Softness { bleeding: f32::NAN, ..Softness::default() },
        Softness { sun_angle: -0.1, ..Softness::default() },
    ] {
        let frame = FrameOptions { softness, ..FrameOptions::default() };
        assert!(maps.prepare(&gpu.queue, &good, &frame).is_err(), "{softness:?}");
    }
    maps.prepare(&gpu.queue, &good, &FrameOptions::default()).expect("a good plan");
}
