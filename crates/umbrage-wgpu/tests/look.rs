//! Colour and strength of shadows, and the two kinds of bias.

mod common;

use common::{Gpu, PCF3, PCF7, PCSS, World, ask, config, cuboid, ground, plan};
use glam::{DVec3, Quat, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::{Filter, ReceiverBias};
use umbrage_wgpu::FrameOptions;

fn world(filter: Filter) -> Option<World> {
    Some(World::new(Gpu::new()?, &config(&[256], filter, "")))
}

/// One split of 256 texels over 64 m: a texel is a quarter of a metre.
fn one_split(light: DVec3) -> ShadowPlan {
    plan(light, DVec3::new(20.0, 0.0, 0.0), &[256], &[0.1, 100.0], &[64.0])
}

#[test]
fn shadows_have_the_colour_and_the_strength_that_they_are_given() {
    let Some(mut world) = world(PCF3) else { return };
    let roof = cuboid(Vec3::new(15.0, 4.0, -5.0), Vec3::new(25.0, 5.0, 5.0));
    let asks = [ask(Vec3::new(20.0, 0.0, 0.0), Vec3::Y), ask(Vec3::new(40.0, 0.0, 0.0), Vec3::Y)];
    let mut lights = |strength: f32, shadow_colour: [f32; 3]| -> Vec<[f32; 4]> {
        let [red, green, blue] = shadow_colour;
        world.set(&format!("shadow-strength={strength} shadow-colour={red},{green},{blue}"));
        world.draw(&one_split(DVec3::NEG_Y), &FrameOptions::default(), &[roof.clone(), ground(100.0)].concat());
        let source = world.maps.receiver_wgsl(1)
            + "struct Ask { position: vec4f, normal: vec4f }
               @group(0) @binding(0) var<storage, read> asks: array<Ask>;
               @group(0) @binding(1) var<storage, read_write> answers: array<vec4f>;
               @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
                   if id.x >= arrayLength(&asks) { return; }
                   let shadow = umbrage_shadow(umbrage_query(asks[id.x].position.xyz, asks[id.x].normal.xyz));
                   answers[id.x] = vec4f(shadow.light, shadow.visibility);
               }";
        world.gpu.compute(&source, &asks, Some(&world.maps))
    };
    let lit = [1.0; 4];
    assert_eq!(lights(1.0, [0.0; 3]), [[0.0; 4], lit]);
    assert_eq!(lights(1.0, [0.25, 0.5, 1.0]), [[0.25, 0.5, 1.0, 0.0], lit]);
    // A quarter of the shadow: three quarters of the light, and a quarter of its colour.
    assert_eq!(lights(0.25, [0.0; 3]), [[0.75; 4], lit]);
    assert_eq!(lights(0.25, [0.0, 0.5, 1.0]), [[0.75, 0.875, 1.0, 0.75], lit]);
}

/// How many decisions over a tilted plane that nothing shades but itself are not lit, asked about
/// with a normal `aside` degrees from its own.
fn dark_on_a_bare_plane(world: &mut World, bias: ReceiverBias, aside: f32) -> usize {
    let light = DVec3::new(0.7, -0.5, 0.3).normalize();
    world.set(&format!("bias={bias}"));
    world.draw(&one_split(light), &FrameOptions::default(), &ground(60.0));
    let normal = Quat::from_axis_angle(light.as_vec3(), aside.to_radians()) * Vec3::Y;
    let asks: Vec<_> = (0..900)
        .map(|i| ask(Vec3::new(14.0 + 0.413 * (i % 30) as f32, 0.0, -6.0 + 0.397 * (i / 30) as f32), normal))
        .collect();
    world.ask(&asks).iter().filter(|answer| answer.visibility < 0.999).count()
}

#[test]
fn planes_do_not_shade_themselves_and_the_slope_forgives_normals_that_point_aside() {
    for filter in [Filter::Hard, PCF3, PCF7, PCSS] {
        let Some(mut world) = world(filter) else { return };
        let mut dark = |bias, aside| dark_on_a_bare_plane(&mut world, bias, aside);
        assert_eq!(dark(ReceiverBias::Plane, 0.0), 0, "{filter:?}");
        assert_eq!(dark(ReceiverBias::Slope, 0.0), 0, "{filter:?}");
        assert_eq!(dark(ReceiverBias::Slope, 25.0), 0, "{filter:?}");
        // One texel alone knows nothing but its depth; several are followed to where they lead,
        // which is this plane.
        if filter == Filter::Hard {
            let found = dark(ReceiverBias::Plane, 90.0);
            assert!(found > 50, "a plane that is another's: {found}");
        } else {
            assert_eq!(dark(ReceiverBias::Plane, 25.0), 0, "{filter:?}");
        }
    }
}
