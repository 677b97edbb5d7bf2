//! Every valid pair of generation and storage answers alike, and no filter ever sees a neighbour's
//! texels.

mod common;

use common::{Ask, Gpu, IN_SPLIT, PCF3, PCF5, PCF7, PCSS, SUN, World, ask, config, cuboid, ground, plan};
use glam::{DVec3, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{DepthFormat, Fallbacks, Filter, Generation, Layout, ShadowConfig, Storage};
use umbrage_wgpu::{Error, FrameOptions, ShadowMaps};

/// All layouts but that of one map, which `umbrage-render` draws pictures with.
const LAYOUTS: [Layout; 8] = [
    Layout::Array,
    Layout::Atlas,
    Layout::Separate,
    Layout::Cube,
    Layout::LayeredArray,
    Layout::LayeredCube,
    Layout::InstancedAtlas,
    Layout::MixedArray,
];

const LIGHT: DVec3 = DVec3::new(0.4, -1.0, 0.3);

fn laid_out(sizes: &[u32], filter: Filter, layout: Layout, depth_format: DepthFormat) -> ShadowConfig {
    ShadowConfig { layout, depth_format, ..config(sizes, filter, "blend=0") }
}

/// Splits side by side in view depth along +X, each map centred on its slice.
fn splits(sizes: &[u32]) -> ShadowPlan {
    let planes: Vec<f64> = (0..=sizes.len()).map(|i| 1.0 + 12.0 * i as f64).collect();
    let mut whole = plan(LIGHT, DVec3::ZERO, sizes, &planes, &vec![40.0; sizes.len()]);
    for i in 0..sizes.len() {
        let center = DVec3::new(0.5 * (planes[i] + planes[i + 1]), 0.0, 0.0);
        whole.splits[i] = plan(LIGHT, center, sizes, &planes, &vec![40.0; sizes.len()]).splits[i].clone();
    }
    whole
}

/// Boxes on the ground, all along the splits.
fn boxes() -> Vec<Vec3> {
    let mut triangles = ground(300.0);
    for i in 0..40 {
        let at = Vec3::new(2.5 * i as f32, 0.0, 4.0 * (i as f32 * 1.7).sin());
        triangles.extend(cuboid(at, at + Vec3::new(1.0, 1.5 + (i % 4) as f32, 0.8)));
    }
    triangles
}

fn asks() -> Vec<Ask> {
    let points = (0..140).flat_map(|i| (0..40).map(move |k| Vec3::new(0.7 * i as f32, 0.0, 0.46 * k as f32 - 9.0)));
    points.map(|point| ask(point, Vec3::Y)).collect()
}

fn answers(world: &mut World, plan: &ShadowPlan) -> Vec<f32> {
    world.draw(plan, &FrameOptions::default(), &boxes());
    world.ask(&asks()).iter().map(|answer| answer.visibility).collect()
}

/// How many answers differ by more than `tolerance`.
fn different(a: &[f32], b: &[f32], tolerance: f32) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| (*a - *b).abs() > tolerance).count()
}

fn check_pairs(sizes: &[u32], filter: Filter, depth_format: DepthFormat) {
    let plan = splits(sizes);
    let mut expected: Option<Vec<f32>> = None;
    for layout in LAYOUTS {
        let cube = layout.storage() == Storage::Cube;
        if cube && (sizes.len() > 6 || sizes.iter().any(|&size| size != sizes[0])) {
            continue;
        }
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &laid_out(sizes, filter, layout, depth_format));
        if world.maps.layout() != layout {
            eprintln!("SKIPPED: {}", world.maps.notes()[0]);
            continue;
        }
        let answers = answers(&mut world, &plan);
        let expected = expected.get_or_insert_with(|| answers.clone());
        // A direction into a cube and a place in an atlas round differently: a linear sampler's
        // weights are steps of 1/256.
        let count = different(&answers, expected, 1.0 / 64.0);
        let tiles = matches!(layout, Layout::Atlas | Layout::InstancedAtlas | Layout::MixedArray);
        let most = if tiles { answers.len() / 2000 } else { 0 };
        assert!(count <= most, "{layout:?}, {filter:?}, {sizes:?}: {count} of {} answers differ", answers.len());
        let dark = answers.iter().filter(|&&lit| lit < 0.5).count();
        assert!(dark > answers.len() / 300 && dark < answers.len() / 2, "{dark} of {} are dark", answers.len());
    }
}

#[test]
fn every_pair_answers_alike() {
    for filter in [Filter::Hard, PCF3, PCSS] {
        check_pairs(&[256; 4], filter, DepthFormat::D32Float);
    }
    check_pairs(&[256, 192, 128, 64, 128, 70, 64, 256], PCF5, DepthFormat::D32Float);
    check_pairs(&[256; 6], Filter::Hard, DepthFormat::D32Float);
    check_pairs(&[200], PCF3, DepthFormat::D32Float);
}

#[test]
fn every_pair_stores_floats_and_sixteen_bits_alike() {
    for filter in [Filter::Hard, PCSS] {
        check_pairs(&[128; 5], filter, DepthFormat::R32Float);
    }
    check_pairs(&[128; 3], PCF3, DepthFormat::D16Unorm);
}

/// Colours compared by hand are what depth compared by hardware is.
#[test]
fn floats_say_what_depth_says() {
    for filter in [Filter::Hard, Filter::Pcf2, PCF7, PCSS] {
        let of = |depth_format| {
            let asked = laid_out(&[256; 3], filter, Layout::Array, depth_format);
            Some(answers(&mut World::new(Gpu::new()?, &asked), &splits(&[256; 3])))
        };
        let (Some(depth), Some(floats)) = (of(DepthFormat::D32Float), of(DepthFormat::R32Float)) else { return };
        let tolerance = if filter == Filter::Hard { 0.0 } else { 1.0 / 64.0 };
        assert_eq!(different(&depth, &floats, tolerance), 0, "{filter:?}");
    }
}

/// A neighbour that is black all over must not darken anything: splits 1 and 3 are filled right
/// before the light, splits 0 and 2 are asked along all their edges.
#[test]
fn filters_never_see_a_neighbour() {
    let sizes = [128u32; 4];
    for layout in LAYOUTS {
        for (filter, format) in [
            (PCF7, DepthFormat::D32Float),
            (Filter::Pcss { sun_degrees: 28.65, rotated: false }, DepthFormat::D32Float),
            (Filter::Pcf2, DepthFormat::R32Float),
        ] {
            let Some(gpu) = Gpu::new() else { return };
            let mut world = World::new(gpu, &laid_out(&sizes, filter, layout, format));
            // All four look straight down on squares of 40 m, 1000 m apart; those of 1 and 3 are
            // covered by a roof 90 m up.
            let mut plan = plan(DVec3::NEG_Y, DVec3::ZERO, &sizes, &[1.0, 2.0, 3.0, 4.0, 5.0], &[40.0; 4]);
            for (i, split) in plan.splits.iter_mut().enumerate() {
                split.min_texel += split.u_axis.dot(DVec3::X * 1000.0 * i as f64) / split.texel_m.x * glam::DVec2::X
                    + split.v_axis.dot(DVec3::X * 1000.0 * i as f64) / split.texel_m.y * glam::DVec2::Y;
            }
            // A disc as wide as it gets, and one that was planned to be narrow.
            plan.splits[2].filter_radius_texels = 5.0;
            let mut triangles = ground(5000.0);
            for x in [1000.0, 3000.0] {
                let corner = |dx: f32, dz: f32| Vec3::new(x + dx, 90.0, dz);
                triangles.extend(common::quad([
                    corner(-60.0, -60.0),
                    corner(60.0, -60.0),
                    corner(60.0, 60.0),
                    corner(-60.0, 60.0),
                ]));
            }
            world.draw(&plan, &FrameOptions::default(), &triangles);
            // In and right outside of the map: what is outside is lit without being asked.
            let edge: Vec<f32> = (0..=200).map(|i| -20.3 + 0.203 * i as f32).collect();
            let mut asks = Vec::new();
            for split in [0.0, 2.0] {
                for &a in &edge {
                    for b in [-20.0, -19.999, -19.9, -19.6, -19.0, 19.0, 19.6, 19.9, 19.999, 20.0] {
                        asks.push((split, ask(Vec3::new(1000.0 * split + a, 0.0, b), Vec3::Y)));
                        asks.push((split, ask(Vec3::new(1000.0 * split + b, 0.0, a), Vec3::Y)));
                    }
                }
            }
            let only: Vec<Ask> = asks.iter().map(|(_, ask)| *ask).collect();
            let source = world.maps.receiver_wgsl(1)
                + IN_SPLIT
                + "struct Ask { position: vec4f, normal: vec4f }
                   @group(0) @binding(0) var<storage, read> asks: array<Ask>;
                   @group(0) @binding(1) var<storage, read_write> answers: array<vec4f>;
                   @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
                       if id.x >= arrayLength(&asks) { return; }
                       let p = asks[id.x].position.xyz;
                       let n = asks[id.x].normal.xyz;
                       answers[id.x] = vec4f(in_split(p, n, 0), in_split(p, n, 1), in_split(p, n, 2), in_split(p, n, 3));
                   }";
            let answers: Vec<[f32; 4]> = world.gpu.compute(&source, &only, Some(&world.maps));
            for ((split, ask), answer) in asks.iter().zip(&answers) {
                let lit = answer[*split as usize];
                assert!(lit > 0.999, "{layout:?}, {filter:?}: {lit} at {}", ask.position());
            }
            // And the neighbours are black indeed.
            let dark: Vec<[f32; 4]> = world.gpu.compute(
                &source,
                &[ask(Vec3::X * 1000.0, Vec3::Y), ask(Vec3::X * 3000.0, Vec3::Y)],
                Some(&world.maps),
            );
            assert!(dark[0][1] < 0.001 && dark[1][3] < 0.001, "{layout:?}, {filter:?}: {dark:?}");
        }
    }
}

/// The comparison must be able to say no: maps of another size answer otherwise.
#[test]
fn another_resolution_is_seen() {
    let of = |size| {
        let asked = laid_out(&[size; 3], Filter::Hard, Layout::Array, DepthFormat::D32Float);
        Some(answers(&mut World::new(Gpu::new()?, &asked), &splits(&[size; 3])))
    };
    let (Some(a), Some(b)) = (of(256), of(250)) else { return };
    assert!(different(&a, &b, 1.0 / 64.0) > a.len() / 500);
}

#[test]
fn memory_is_that_of_the_storage() {
    let Some(gpu) = Gpu::new() else { return };
    let sizes = [512u32, 256, 256, 128];
    let bytes = |layout, depth_format| {
        let asked = laid_out(&sizes, PCF3, layout, depth_format);
        ShadowMaps::new(&gpu.device, &asked, &SUN).expect("valid").bytes()
    };
    let sum: u64 = sizes.iter().map(|&size| 4 * u64::from(size * size)).sum();
    let d32 = DepthFormat::D32Float;
    assert_eq!(bytes(Layout::Array, d32), 4 * 4 * 512 * 512);
    assert_eq!(bytes(Layout::Separate, d32), sum);
    assert_eq!(bytes(Layout::Reused, d32), 4 * 512 * 512);
    let atlas = bytes(Layout::Atlas, d32);
    assert!(atlas >= sum && atlas <= sum + sum / 4, "{atlas} bytes for maps of {sum}");
    // Beside floats there is a depth buffer for one pass.
    let r32f = DepthFormat::R32Float;
    assert_eq!(bytes(Layout::Array, r32f), 5 * 4 * 512 * 512);
    assert_eq!(bytes(Layout::Reused, r32f), 2 * 4 * 512 * 512);
}

#[test]
fn what_a_device_cannot_do_is_replaced_and_said() {
    for (withheld, layout) in [
        (wgpu::Features::MULTIVIEW, Layout::LayeredCube),
        (wgpu::Features::CLIP_DISTANCES, Layout::InstancedAtlas),
        (wgpu::Features::MULTIVIEW, Layout::MixedArray),
        (wgpu::Features::CLIP_DISTANCES, Layout::MixedArray),
    ] {
        let Some(gpu) = Gpu::without(withheld) else { return };
        let asked = laid_out(&[128; 3], PCF3, layout, DepthFormat::D32Float);
        let strict = ShadowConfig { fallbacks: Fallbacks::Forbid, ..asked.clone() };
        let strict = ShadowMaps::new(&gpu.device, &strict, &SUN);
        assert!(matches!(strict, Err(Error::MissingFeature { .. })), "{layout:?}");
        let mut world = World::new(gpu, &asked);
        assert_eq!(world.maps.layout().generation(), Generation::PerSplit);
        assert_eq!(world.maps.layout().storage(), layout.storage());
        assert!(world.maps.notes()[0].contains(layout.generation().word()), "{:?}", world.maps.notes());
        let answers = answers(&mut world, &splits(&[128; 3]));
        assert!(answers.contains(&0.0) && answers.contains(&1.0));
    }
}

#[test]
fn more_separate_maps_than_textures_are_refused() {
    let Some(gpu) = Gpu::new() else { return };
    let limits = wgpu::Limits { max_sampled_textures_per_shader_stage: 16, ..Default::default() };
    assert!(gpu.device.limits().max_sampled_textures_per_shader_stage >= limits.max_sampled_textures_per_shader_stage);
    // No device has fewer than 16, and there are 8 splits at most: one light alone never meets the
    // limit.
    let eight = laid_out(&[64; 8], PCF3, Layout::Separate, DepthFormat::D32Float);
    gpu.checked(|| ShadowMaps::new(&gpu.device, &eight, &SUN).expect("eight textures"));
    let message = Error::TooManyTextures { maps: 24, count: 24, limit: 16 }.to_string();
    assert!(message.contains("separate") && message.contains("map_sizes") && message.contains("16"), "{message}");
}

/// One map at a time cannot be blended with the next one.
#[test]
fn a_reused_map_has_nothing_to_blend_with() {
    let Some(gpu) = Gpu::new() else { return };
    let hard = laid_out(&[128; 3], PCF3, Layout::Reused, DepthFormat::D32Float);
    let mut maps = ShadowMaps::new(&gpu.device, &hard, &SUN).expect("valid");
    assert_eq!(maps.prepare(&gpu.queue, &splits(&[128; 3]), &FrameOptions::default()), Ok(()));
    let transition = umbrage::config::Transition::Blend { share: 0.1 };
    let blends = ShadowConfig { transition, ..hard };
    let error = ShadowMaps::new(&gpu.device, &blends, &SUN).expect_err("a band").to_string();
    assert!(error.contains("storage reused") && error.contains("blend"), "{error}");
}
