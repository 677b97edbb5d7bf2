//! The feet of lit walls with ground before them that the light grazes: neither dark by the ground
//! nor lit in a shadow.

mod common;

use common::{Gpu, PCF3, PCF5, World, ask, config, cuboid, ground, plan};
use glam::{DVec3, Vec3};
use umbrage::config::ReceiverBias;
use umbrage_wgpu::FrameOptions;

/// Metres per texel: 256 of them over 64 m.
const TEXEL: f32 = 0.25;

/// Visibilities up the first half metre of a riser at x = 20 that faces a sun 8° up, with ground
/// before it, and `casters` on that. The sun stands a little aside so that texels lie everywhere
/// along the foot.
fn up_the_riser(world: &mut World, bias: ReceiverBias, casters: &[Vec3]) -> Vec<f32> {
    let (sine, cosine) = 8.0_f64.to_radians().sin_cos();
    let light = DVec3::new(cosine * 0.98, -sine, cosine * 0.2).normalize();
    let one_split = plan(light, DVec3::new(20.0, 0.0, 0.0), &[256], &[0.1, 100.0], &[64.0]);
    let riser = cuboid(Vec3::new(20.0, 0.0, -20.0), Vec3::new(40.0, 3.0, 20.0));
    let scene = [ground(100.0), riser, casters.to_vec()].concat();
    world.set(&format!("bias={bias}"));
    world.draw(&one_split, &FrameOptions::default(), &scene);
    let asks: Vec<_> = (0..800)
        .map(|i| ask(Vec3::new(20.0, 0.01 + 0.0247 * (i % 20) as f32, -4.0 + 0.203 * (i / 20) as f32), Vec3::NEG_X))
        .collect();
    world.ask(&asks).iter().map(|answer| answer.visibility).collect()
}

fn dark(visibilities: &[f32]) -> usize {
    visibilities.iter().filter(|&&visibility| visibility < 0.5).count()
}

#[test]
fn the_foot_of_a_lit_wall_is_lit() {
    for filter in [PCF3, PCF5] {
        let Some(gpu) = Gpu::new() else { return };
        let mut world = World::new(gpu, &config(&[256], filter, ""));
        assert_eq!(dark(&up_the_riser(&mut world, ReceiverBias::Plane, &[])), 0, "{filter:?}");
        // Which surface a texel belongs to is not asked without the receiver's plane: the seam that
        // there would be.
        assert!(dark(&up_the_riser(&mut world, ReceiverBias::Slope, &[])) > 20, "{filter:?}");

        // A wall before it, 2 to 24 texels away and high enough that its shadow ends above all that
        // was asked about.
        for distance in [2.0, 24.0] {
            let x = 20.0 - distance * TEXEL;
            let height = 1.2 + distance * TEXEL * 0.15;
            let wall = cuboid(Vec3::new(x - 0.3, 0.0, -20.0), Vec3::new(x, height, 20.0));
            let shaded = up_the_riser(&mut world, ReceiverBias::Plane, &wall);
            let lit = shaded.len() - dark(&shaded);
            // Close by, the lowest texel of the wall and the ground before it may look like a
            // tread.
            let most = if distance < 6.0 { shaded.len() / 100 } else { 0 };
            assert!(lit <= most, "{filter:?}, {distance} texels away: {lit} of {} lit", shaded.len());
        }
    }
}
