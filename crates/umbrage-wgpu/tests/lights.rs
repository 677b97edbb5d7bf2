//! Several lights in one bind group, spot and point lights: against closed forms, each other, and
//! what must be refused.

mod common;

use bytemuck::{Pod, Zeroable};
use common::{Ask, DISC, Gpu, PCF3, PCF5, PCSS, World, ask, config, cuboid, ground, quad};
use glam::{DVec3, Vec3};
use umbrage::config::{Filter, LightKind, ShadowConfig};
use umbrage::{
    Aabb, DirectionalLight, Frustum, Light, Planner, PlannerOptions, PointLight, ShadowPlan, SpotLight, View,
};
use umbrage_wgpu::{Error, FrameOptions, LightMaps, ShadowMaps};

const LAMP: DVec3 = DVec3::new(0.0, 4.0, 0.0);

fn maps_of(filter: Filter) -> ShadowConfig {
    config(&[256; 2], filter, "")
}

/// A plate of 1 × 1 m, 2 m over the ground, and a wall beside it.
fn triangles() -> Vec<Vec3> {
    let plate = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| Vec3::new(x, 2.0, z));
    [ground(12.0), quad(plate), cuboid(Vec3::new(5.0, 0.0, -4.0), Vec3::new(5.2, 6.0, 4.0))].concat()
}

fn boxes() -> [Aabb; 3] {
    [
        Aabb::new(DVec3::new(-12.0, 0.0, -12.0), DVec3::new(12.0, 0.0, 12.0)),
        Aabb::new(DVec3::new(-0.5, 2.0, -0.5), DVec3::new(0.5, 2.0, 0.5)),
        Aabb::new(DVec3::new(5.0, 0.0, -4.0), DVec3::new(5.2, 6.0, 4.0)),
    ]
}

fn view() -> View {
    let lens = Frustum::perspective(1.4, 1.0, 0.3, 60.0).expect("valid");
    View::look_at_upright(DVec3::new(-6.0, 9.0, 6.0), DVec3::new(0.5, 0.0, 0.0), lens).expect("valid")
}

fn planned(maps: &ShadowMaps, light: Light) -> ShadowPlan {
    let options = PlannerOptions { depth_clamp: maps.depth_clamp(), ..PlannerOptions::default() };
    let mut planner = Planner::with_options(maps.config(), options).expect("valid");
    planner.plan(&view(), &light, &boxes(), &boxes()).expect("valid").clone()
}

fn lights() -> [Light; 4] {
    [
        DirectionalLight::new(DVec3::new(0.4, -1.0, 0.1)).expect("valid").into(),
        PointLight::new(LAMP, 9.0).expect("valid").into(),
        SpotLight::new(LAMP, DVec3::new(0.1, -1.0, 0.0), 0.9, 9.0).expect("valid").into(),
        SpotLight::new(DVec3::new(4.9, 5.5, 0.0), DVec3::new(0.0, -1.0, 0.05), 0.9, 12.0).expect("valid").into(),
    ]
}

/// What `umbrage_shadow` said of four lights.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Answers {
    visibility: [f32; 4],
    split: [i32; 4],
}

const ASK_ALL: &str = "
struct Ask { position: vec4f, normal: vec4f }
struct Answers { visibility: vec4f, split: vec4i }
@group(0) @binding(0) var<storage, read> asks: array<Ask>;
@group(0) @binding(1) var<storage, read_write> answers: array<Answers>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let p = asks[id.x].position.xyz;
    let n = asks[id.x].normal.xyz;
    var it: Answers;
    for (var light = 0u; light < 4u; light++) {
        var query = umbrage_query(p, n);
        query.light = light;
        let shadow = umbrage_shadow(query);
        it.visibility[light] = shadow.visibility;
        it.split[light] = shadow.split;
    }
    answers[id.x] = it;
}";

fn ground_asks() -> Vec<Ask> {
    let steps = || (-60..60).map(|i| 0.1137 * i as f32);
    steps().flat_map(|x| steps().map(move |z| ask(Vec3::new(x, 0.0, z), Vec3::Y))).collect()
}

/// Whether the ground is lit by a lamp at `LAMP` within its range; abstains near edges.
fn lit_by_lamp(p: Vec3, unsure: f32) -> Option<bool> {
    let plate = p.x.abs().max(p.z.abs());
    // Where the ray passes the wall's near and far face.
    let rim = [5.0, 5.2].map(|wall| p.z.abs() * wall / p.x.abs().max(1.0));
    let behind = p.x > 5.0;
    if (plate - 1.0).abs() < unsure || (p.x - 5.1).abs() < 0.3 || (behind && rim.iter().any(|z| (z - 4.0).abs() < 0.3))
    {
        return None;
    }
    Some(plate > 1.0 && !(behind && rim[0] < 4.0))
}

#[test]
fn a_lamp_throws_shadows_as_large_as_similar_triangles_say() {
    for (filter, reach, index) in [(Filter::Hard, 1.0, 1), (PCF3, 3.0, 1), (PCF5, 4.0, 2), (DISC, 5.0, 2)] {
        let Some(gpu) = Gpu::new() else { return };
        let light = lights()[index];
        let mut world = World::of_lights(gpu, &maps_of(filter), &[light]);
        let plan = planned(&world.maps, light);
        world.draw(&plan, &FrameOptions::default(), &triangles());
        let asks = ground_asks();
        let texel = plan.splits.iter().map(|s| s.texel_size_m(DVec3::ZERO).max_element()).filter(|t| t.is_finite());
        let unsure = reach * texel.fold(0.0, f64::max) as f32;
        assert!(unsure < 0.5, "{unsure} m leave nothing to look at");
        let mut counted = [0; 2];
        for (it, answer) in asks.iter().zip(world.ask(&asks)) {
            let point = it.position();
            let reached = light.illuminates(point.as_dvec3());
            let near_rim = [0.97, 1.03].iter().any(|&s| light.illuminates((point * s).as_dvec3()) != reached);
            let Some(lit) = lit_by_lamp(point, unsure).filter(|_| !near_rim) else { continue };
            let lit = lit || !reached;
            let wrong = (answer.visibility - f32::from(u8::from(lit))).abs();
            assert!(wrong < 1e-5, "{filter:?} {light:?} says {} at {point}", answer.visibility);
            assert!(reached || answer.split == -1, "out of reach no split answers, but {} did", answer.split);
            counted[usize::from(lit)] += 1;
        }
        assert!(counted[0] > 100 && counted[1] > 1000, "{counted:?}");
    }
}

#[test]
fn several_lights_answer_as_each_does_alone() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::of_lights(gpu, &maps_of(PCF3), &lights());
    assert_eq!(world.maps.map_count(), 2 * (1 + 6 + 1 + 1));
    assert_eq!([0, 1, 2, 3].map(|light| world.maps.first_map(light)), [0, 2, 14, 16]);
    let plans = lights().map(|light| planned(&world.maps, light));
    world.draw_all(&plans.each_ref(), &FrameOptions::default(), &triangles());
    let asks = ground_asks();
    let source = world.maps.receiver_wgsl(1) + ASK_ALL;
    let together: Vec<Answers> = world.gpu.compute(&source, &asks, Some(&world.maps));
    for (index, light) in lights().into_iter().enumerate() {
        let Some(gpu) = Gpu::new() else { return };
        let mut alone = World::of_lights(gpu, &maps_of(PCF3), &[light]);
        alone.draw(&plans[index], &FrameOptions::default(), &triangles());
        let answers = alone.ask(&asks);
        let dark = answers.iter().filter(|answer| answer.visibility < 0.5).count();
        assert!(dark > 50 && dark < answers.len() - 50, "light {index}: {dark} of {} points are dark", answers.len());
        for ((one, all), it) in answers.iter().zip(&together).zip(&asks) {
            let point = it.position();
            assert_eq!(
                (one.visibility, one.split),
                (all.visibility[index], all.split[index]),
                "light {index} at {point}"
            );
        }
    }
}

#[test]
fn a_light_that_grazes_a_wall_makes_no_stripes() {
    // 10 cm from a wall 6 m high: over most of it light and wall meet at less than 5°.
    let light = lights()[3];
    for filter in [Filter::Hard, PCF5] {
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::of_lights(gpu, &maps_of(filter), &[light]);
        let plan = planned(&world.maps, light);
        world.draw(&plan, &FrameOptions::default(), &triangles());
        let steps = |from: f32, to: f32, n: i32| (0..n).map(move |i| from + (to - from) * (i as f32 + 0.5) / n as f32);
        let asks: Vec<_> = steps(0.3, 4.7, 60)
            .flat_map(|y| steps(-1.5, 1.5, 60).map(move |z| ask(Vec3::new(5.0, y, z), Vec3::NEG_X)))
            .collect();
        let reached = |it: &Ask| light.illuminates(it.position().as_dvec3());
        let answers = world.ask(&asks);
        let (all, wrong) = asks
            .iter()
            .zip(&answers)
            .filter(|(it, _)| reached(it))
            .fold((0, 0), |(all, wrong), (_, a)| (all + 1, wrong + usize::from(a.visibility < 0.5)));
        assert!(all > 1000 && wrong * 200 <= all, "{filter:?}: {wrong} of {all} points of a lit wall are dark");
    }
}

/// A lamp has maps of its own: two of 128 texels for each face beside a sun's three of 256.
#[test]
fn lights_have_map_sizes_of_their_own() {
    let Some(gpu) = Gpu::new() else { return };
    let [sun, lamp] = [lights()[0], lights()[1]];
    let slots =
        [LightMaps::with_sizes(LightKind::Directional, &[256; 3]), LightMaps::with_sizes(LightKind::Point, &[128; 2])];
    let asked = maps_of(PCF3);
    let mut world = World::of_lights(gpu, &asked, &slots);
    assert_eq!((world.maps.map_count(), world.maps.first_map(1)), (3 + 6 * 2, 3));
    assert_eq!((world.maps.map_sizes(0), world.maps.map_sizes(1)), (&[256; 3][..], &[128; 2][..]));
    assert_eq!(
        (world.maps.light_of_map(2), world.maps.light_of_map(3), world.maps.light_of_map(14)),
        ((0, 2), (1, 0), (1, 11))
    );
    let plan_with = |light: Light, map_sizes: &[u32]| {
        let own = ShadowConfig { map_sizes: map_sizes.to_vec(), ..asked.clone() };
        let mut planner = Planner::new(&own).expect("valid");
        planner.plan(&view(), &light, &boxes(), &boxes()).expect("valid").clone()
    };
    let plans = [plan_with(sun, &[256; 3]), plan_with(lamp, &[128; 2])];
    world.draw_all(&plans.each_ref(), &FrameOptions::default(), &triangles());
    let asks = ground_asks();
    let source = world.maps.receiver_wgsl(1) + &ASK_ALL.replace("light < 4u", "light < 2u");
    let together: Vec<Answers> = world.gpu.compute(&source, &asks, Some(&world.maps));
    for (index, (light, map_sizes)) in [(sun, &[256; 3][..]), (lamp, &[128; 2])].into_iter().enumerate() {
        let Some(gpu) = Gpu::new() else { return };
        let mut alone = World::of_lights(gpu, &config(map_sizes, PCF3, ""), &[light]);
        alone.draw(&plans[index], &FrameOptions::default(), &triangles());
        for ((one, all), it) in alone.ask(&asks).iter().zip(&together).zip(&asks) {
            // A sampler weighs in steps of 1/256 from coordinates that round otherwise in another
            // layer's size.
            let off = (one.visibility - all.visibility[index]).abs();
            assert!(off < 1.0 / 64.0, "light {index} at {}: {off}", it.position());
            assert_eq!(one.split, all.split[index], "light {index} at {}", it.position());
        }
    }
}

#[test]
fn what_the_device_or_the_config_cannot_hold_is_refused() {
    let Some(gpu) = Gpu::new() else { return };
    // Three lights of eight maps each, kept apart: an array would do.
    let three = [LightKind::Directional; 3];
    for storage in ["separate", "atlas"] {
        let asked = config(&[64; 8], PCF3, &format!("storage={storage}"));
        let error = ShadowMaps::new(&gpu.device, &asked, &three).expect_err("one light's alone");
        assert!(matches!(error, Error::Config(umbrage::Error::Conflict(_))), "{error}");
        let message = error.to_string();
        assert!(message.contains("lights") && message.contains(&format!("storage {storage}")), "{message}");
    }
    assert!(ShadowMaps::new(&gpu.device, &config(&[64; 8], PCF3, ""), &three).is_ok());

    let none: [LightKind; 0] = [];
    let error = ShadowMaps::new(&gpu.device, &maps_of(PCF3), &none);
    assert!(matches!(error, Err(Error::TooManyLights { frames: 0, .. })));
    let error =
        ShadowMaps::new(&gpu.device, &config(&[16], PCF3, ""), &[LightKind::Point; 100]).expect_err("600 frames");
    assert!(matches!(error, Error::TooManyLights { frames: 600, .. }), "{error}");

    let mut maps = ShadowMaps::new(&gpu.device, &maps_of(PCF3), &[LightKind::Directional; 2]).expect("valid");
    let lamp = planned(&maps, lights()[1]);
    let spot = planned(&maps, lights()[2]);
    let sun = planned(&maps, lights()[0]);
    let frame = FrameOptions::default();
    for (wrong, given) in [(&lamp, LightKind::Point), (&spot, LightKind::Spot)] {
        let error = maps.prepare_lights(&gpu.queue, &[&sun, wrong], &frame).expect_err("no sun");
        assert_eq!(error, Error::LightKind { light: 1, given, made_for: LightKind::Directional });
    }
    let error = maps.prepare(&gpu.queue, &sun, &frame).expect_err("one of two");
    assert!(matches!(error, Error::LightCount { plans: 1, lights: 2 }), "{error}");
    let error = ShadowMaps::new(&gpu.device, &maps_of(PCSS), &[LightKind::Point]).expect_err("a lamp is no sun");
    assert!(error.to_string().contains("filter pcss"), "{error}");
    // A sun in a point light's place is drawn there; the other five faces are nobody's.
    let mut cube = ShadowMaps::new(&gpu.device, &maps_of(PCF3), &[LightKind::Point]).expect("valid");
    assert!([&sun, &spot, &lamp].iter().all(|plan| cube.prepare(&gpu.queue, plan, &frame).is_ok()));
    let options = PlannerOptions { depth_clamp: maps.depth_clamp(), ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&config(&[128; 2], PCF3, ""), options).expect("valid");
    let plan = planner.plan(&view(), &lights()[1], &boxes(), &boxes()).expect("valid");
    assert!(matches!(cube.prepare(&gpu.queue, plan, &frame), Err(Error::PlanMismatch { .. })));
}
