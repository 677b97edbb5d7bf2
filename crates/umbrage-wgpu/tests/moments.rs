//! Filters of moments on a GPU: light, shadow, borders, levels, fallbacks.

mod common;

use common::{Ask, ESM, EVSM2, EVSM4, Gpu, MSM, PCF3, SUN, VSM, World, ask, config, cuboid, ground, plan, quad, with};
use glam::{DVec3, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{Filter, LightKind, ShadowConfig};
use umbrage_wgpu::{Error, FrameOptions, MomentStorage, ShadowMaps};

const ALL: [Filter; 5] = [ESM, VSM, EVSM2, EVSM4, MSM];
const SLANTED: DVec3 = DVec3::new(0.3, -0.8, 0.2);

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

/// A sunlit plane is lit under every angle and with every width; a steep one under a wide blur
/// loses a little of it to what four moments or a falling exponential make of its own depths.
#[test]
fn planes_do_not_shade_themselves() {
    for filter in ALL {
        let Some(gpu) = Gpu::new() else { return };
        let mut narrow = World::new(gpu, &config(&[256], filter, ""));
        let Some(gpu) = Gpu::new() else { return };
        let mut wide = World::new(gpu, &config(&[256], filter, "filter-width=2"));
        for (tilt, turn) in [(0.0, 0.0), (40.0, 10.0), (70.0, 100.0), (80.0, 300.0)] {
            let (tilt, turn) = (f64::to_radians(tilt), f64::to_radians(turn));
            let light = -DVec3::new(tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin());
            for (world, width_m) in [(&mut narrow, None), (&mut wide, Some(2.0))] {
                world.draw(&one_map(light, 256), &FrameOptions::default(), &ground(400.0));
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
        (ESM, false, MomentStorage::F32),
        (VSM, false, MomentStorage::F32),
        (EVSM2, false, MomentStorage::F32),
        (EVSM4, false, MomentStorage::F32),
        (MSM, false, MomentStorage::F32),
        (ESM, true, MomentStorage::F16),
        (VSM, true, MomentStorage::F32Manual),
        (EVSM2, true, MomentStorage::F16),
        (EVSM4, true, MomentStorage::F16),
        (MSM, true, MomentStorage::F32Manual),
    ] {
        let Some(gpu) = (if withheld { without_float_filtering() } else { Gpu::new() }) else { return };
        let can = gpu.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE);
        let mut world = World::new(gpu, &config(&[256], filter, ""));
        if withheld || can {
            assert_eq!(world.maps.moment_storage(), Some(storage), "{filter:?}");
        }
        let mut triangles = ground(400.0);
        triangles.extend(cuboid(Vec3::new(18.0, 0.0, -4.0), Vec3::new(19.0, 6.0, 4.0)));
        world.draw(&one_map(SLANTED, 256), &FrameOptions::default(), &triangles);
        // The light goes 0.375 m along x and 0.25 m along z a metre down: the shadow of the wall
        // reaches to x = 21.25.
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

/// What the shader filters by itself is what the sampler filters, to the eight bits of a sampler's
/// weights.
#[test]
fn by_hand_is_as_by_sampler() {
    let mut answers = Vec::new();
    for gpu in [Gpu::new(), without_float_filtering()] {
        let Some(gpu) = gpu else { return };
        let mut world = World::new(gpu, &config(&[128], VSM, ""));
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
    for (filter, sizes) in [(VSM, [256, 128]), (MSM, [100, 100]), (EVSM4, [90, 130])] {
        for dark in [0, 1] {
            let Some(gpu) = Gpu::new() else { return };
            let mut world = World::new(gpu, &config(&sizes, filter, "filter-width=60"));
            let widths = [64.0, 64.0];
            let mut plan = plan(DVec3::NEG_Y, DVec3::ZERO, &sizes, &[1.0, 2.0, 400.0], &widths);
            // A roof over everything in one map; nothing but ground in the other.
            plan.splits[1 - dark].depth_near = 60.0;
            plan.splits[1 - dark].depth_far = 100.0;
            let roof = quad(
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                    .map(|(x, z)| Vec3::new(500.0 * x, 50.0, 500.0 * z)),
            );
            world.draw(&plan, &FrameOptions::default(), &roof);
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

/// Every level has the mean of the first, whether its edge is odd or not; what lies outside a
/// smaller map counts as far away.
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
        let mut world = World::new(gpu, &config(&sizes, VSM, ""));
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

/// Four samples make smooth what one cuts: the mean visibility along an edge is the same, and its
/// steps are smaller.
#[test]
fn four_samples_smooth_edges() {
    let mut roughness = Vec::new();
    for samples in [1, 4] {
        let Some(gpu) = Gpu::new() else { return };
        // The narrowest kernel: what smooths is the samples.
        let narrow = format!("msaa={samples} filter-width=0.01 bleeding=0");
        let mut world = World::new(gpu, &config(&[128], VSM, &narrow));
        let end = |z: f32| Vec3::new(20.0 + 0.1 * z, 10.0, z);
        let roof = quad([Vec3::new(-300.0, 10.0, -200.0), end(-200.0), end(200.0), Vec3::new(-300.0, 10.0, 200.0)]);
        world.draw(&one_map(DVec3::NEG_Y, 128), &FrameOptions::default(), &[roof, ground(300.0)].concat());
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
    let bytes = |filter, settings: &str| {
        ShadowMaps::new(&gpu.device, &config(&[256, 128], filter, settings), &SUN).expect("valid").bytes()
    };
    let depth = 2 * 256 * 256 * 4;
    assert_eq!(bytes(PCF3, ""), depth);
    let texel = if gpu.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE) { 4 } else { 2 };
    // Levels 256 to 4, of two layers, and the texture between two blurs.
    let levels: u64 = (2..=8).map(|k| 1u64 << (2 * k)).sum();
    assert_eq!(bytes(EVSM4, ""), depth + 4 * texel * (2 * levels + 256 * 256));
    assert_eq!(bytes(ESM, "msaa=4"), 4 * 4 * (256 * 256 + 128 * 128) + texel * (2 * levels + 256 * 256));
}

#[test]
fn what_cannot_be_is_an_error_that_says_so() {
    let Some(gpu) = without_float_filtering() else { return };
    let error = |asked: &ShadowConfig, lights: &[LightKind]| {
        ShadowMaps::new(&gpu.device, asked, lights).expect_err("it cannot be")
    };
    let says = |found: Error, words: &[&str]| {
        let message = found.to_string();
        assert!(matches!(found, Error::Config(_)), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    for samples in [0, 2, 3, 8, 16] {
        let mut asked = config(&[256], VSM, "");
        if let Filter::Moments(moments) = &mut asked.filter {
            moments.samples = samples;
        }
        says(error(&asked, &SUN), &["msaa", &format!("{samples} samples")]);
    }
    for filter in ALL {
        let word = filter.word();
        let asked = config(&[256], filter, "");
        let found = error(&with(asked.clone(), "fallbacks=forbid"), &SUN);
        assert_eq!(found, Error::NoFilterableFloats { filter: word });
        assert!(found.to_string().contains("FLOAT32_FILTERABLE"), "{found}");
        // A blur wider than the map.
        says(error(&ShadowConfig { map_sizes: vec![32], ..asked.clone() }, &SUN), &["map 0 is 32 texels", word]);
        let layout = umbrage::config::Layout::Atlas;
        says(error(&ShadowConfig { layout, ..asked.clone() }, &SUN), &["storage atlas", &format!("filter {word}")]);
        says(error(&asked, &[LightKind::Directional; 2]), &["several lights", &format!("filter {word}")]);
    }
}

#[test]
fn plans_and_frames_that_cannot_be_are_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let mut maps = ShadowMaps::new(&gpu.device, &config(&[256], EVSM4, ""), &SUN).expect("valid");
    let good = one_map(SLANTED, 256);
    let mut warped = good.clone();
    warped.splits[0].warp = Some(warped.splits[0].shadow_from_world());
    let found = maps.prepare(&gpu.queue, &warped, &FrameOptions::default()).expect_err("a warped map");
    assert!(matches!(found, Error::PlanOfOtherConfig { setting: "warp", .. }), "{found}");
    for depths in [(1.0, 1.0), (f64::NAN, 2.0), (0.0, f64::INFINITY)] {
        let mut bad = good.clone();
        bad.splits[0].receiver_depths = depths;
        let found = maps.prepare(&gpu.queue, &bad, &FrameOptions::default()).expect_err("no range");
        assert!(matches!(found, Error::InvalidSplit { field: "receiver_depths", .. }), "{found}");
    }
    maps.prepare(&gpu.queue, &good, &FrameOptions::default()).expect("a good plan");
}
