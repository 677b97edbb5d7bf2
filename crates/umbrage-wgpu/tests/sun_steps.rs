//! A sun that moves in steps, faded on the GPU: what a point sees never jumps.

mod common;

use bytemuck::{Pod, Zeroable};
use common::{Gpu, World, cuboid};
use glam::{DQuat, DVec3, Vec3};
use umbrage::config::{Filter, LightKind};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, PlannerOptions, SteppedSun, View};
use umbrage_wgpu::FrameOptions;

/// A point, and the share of the second sun.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Ask {
    position: [f32; 3],
    weight: f32,
}

const FADED: &str = "
@group(0) @binding(0) var<storage, read> asks: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> answers: array<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let ask = asks[id.x];
    var query = umbrage_query(ask.xyz, vec3f(0.0, 1.0, 0.0));
    let from_before = umbrage_shadow(query).visibility;
    query.light = 1u;
    answers[id.x] = mix(from_before, umbrage_shadow(query).visibility, ask.w);
}";

const FADE: f64 = 5.0;

/// Visibility of points of the ground in each frame of a sun that moves by 0.02 rad a frame.
fn seen(frames: u32, fade: f64) -> Option<Vec<Vec<f32>>> {
    let asked = common::config(&[256; 2], Filter::Hard, "");
    let mut world = World::of_lights(Gpu::new()?, &asked, &[LightKind::Directional; 2]);
    let source = world.maps.receiver_wgsl(1) + FADED;
    let options = PlannerOptions { depth_clamp: world.maps.depth_clamp(), ..PlannerOptions::default() };
    let planner = || Planner::with_options(&asked, options).expect("valid");
    let mut planners = [planner(), planner()];
    let mut stepped = SteppedSun::new(0.07, fade).expect("valid");
    let lens = Frustum::perspective(1.2, 1.0, 0.3, 60.0).expect("a lens");
    let view = View::look_at_upright(DVec3::new(-6.0, 9.0, 6.0), DVec3::ZERO, lens).expect("a view");
    let boxes = [
        Aabb::new(DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 4.0, 0.5)),
        Aabb::new(DVec3::new(-12.0, 0.0, -12.0), DVec3::new(12.0, 0.0, 12.0)),
    ];
    let tower = cuboid(boxes[0].min.as_vec3(), boxes[0].max.as_vec3());
    let frames = (0..frames).map(|k| {
        let sun = DQuat::from_rotation_y(0.02 * f64::from(k)) * DVec3::new(0.6, -1.0, 0.3);
        let fade = stepped.follow(&DirectionalLight::new(sun).expect("a direction"), 1.0).expect("a time");
        let plans = [fade.from, fade.to].map(|sun| {
            let planner = &mut planners[usize::from(sun == fade.to)];
            planner.plan(&view, &sun, &boxes[..1], &boxes).expect("a plan").clone()
        });
        world.draw_all(&plans.each_ref(), &FrameOptions::default(), &tower);
        let steps = || (-30..30).map(|i| 0.1137 * i as f32);
        let ask = |x, z| Ask { position: Vec3::new(x, 0.0, z).to_array(), weight: fade.weight as f32 };
        let asks: Vec<Ask> = steps().flat_map(|x| steps().map(move |z| ask(x, z))).collect();
        world.gpu.compute(&source, &asks, Some(&world.maps))
    });
    Some(frames.collect())
}

/// The most that any point's visibility changes from one frame to the next, and from the first
/// frame to the last.
fn changes(frames: &[Vec<f32>]) -> (f32, f32) {
    let most = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let steps = frames.windows(2).map(|pair| most(&pair[0], &pair[1])).fold(0.0, f32::max);
    (steps, most(&frames[0], &frames[frames.len() - 1]))
}

#[test]
fn a_step_is_faded() {
    let Some(frames) = seen(20, FADE) else { return };
    let (largest, whole) = changes(&frames);
    assert!(whole == 1.0, "the shadow did move");
    assert!(largest > 0.0 && f64::from(largest) <= 1.0 / FADE + 1e-5, "a jump by {largest}");
    let still = frames.windows(2).filter(|pair| pair[0] == pair[1]).count();
    assert!(still >= 3, "between two fades nothing changes, in {still} of 19 pairs");
}

/// The test can say no: without a fade shadows jump.
#[test]
fn a_step_that_is_not_faded_jumps() {
    let Some(frames) = seen(8, 0.0) else { return };
    assert_eq!(changes(&frames).0, 1.0);
}
