//! The bias follows a plane exactly, and no further than it should.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use umbrage::config::{Preset, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, STEEPEST, ShadowConfig, Split, View};

fn split(sun: DVec3) -> Split {
    let settings = ShadowConfig { stability: Stability::tight(), ..Preset::Papers.config() };
    let frustum = Frustum::perspective(1.0, 1.5, 1.0, 300.0).expect("valid");
    let view = View::look_at_upright(DVec3::new(3.0, 9.0, 20.0), DVec3::ZERO, frustum).expect("valid");
    let world = [Aabb::new(DVec3::splat(-50.0), DVec3::splat(50.0))];
    let mut planner = Planner::new(&settings).expect("valid");
    planner.plan(&view, &DirectionalLight::new(sun).expect("valid"), &world, &world).expect("valid").splits[1].clone()
}

proptest! {
    #[test]
    fn a_plane_is_followed_exactly(sun in (-1.0..1.0f64, -1.0..-0.1f64, -1.0..1.0f64), n in (-1.0..1.0f64, 0.05..1.0f64, -1.0..1.0f64), step in (-3.0..3.0f64, -3.0..3.0f64)) {
        let (split, normal) = (split(DVec3::from(sun)), DVec3::from(n).normalize());
        let facing = -normal.dot(split.depth_axis);
        let bias = split.bias(normal);
        prop_assert!(bias.depth_per_texel.is_finite() && bias.constant_m > 0.0 && bias.corner_per_texel.min_element() > 0.0);
        prop_assert!((bias.depth_per_texel / split.texel_m).length() <= STEEPEST * (1.0 + 1e-9));
        if facing > 0.03 {
            // A point of the plane that lies `step` texels aside in the map is deeper by what the
            // bias says.
            let step = DVec2::from(step);
            let across = split.u_axis * (step.x * split.texel_m.x) + split.v_axis * (step.y * split.texel_m.y);
            let on_plane = across - split.depth_axis * (normal.dot(across) / normal.dot(split.depth_axis));
            let deeper = split.depth_axis.dot(on_plane);
            prop_assert!((bias.depth_per_texel.dot(step) - deeper).abs() <= 1e-9 * (1.0 + deeper.abs()));
            // Without the plane no place within reach is compared as if it were deeper than the
            // plane is there, and less is not enough.
            let flat = bias.without_plane(step.abs());
            prop_assert!(-flat.constant_m <= deeper - bias.constant_m + 1e-9 * (1.0 + deeper.abs()));
            prop_assert!(flat.constant_m <= bias.constant_m + bias.depth_per_texel.abs().dot(step.abs()) + 1e-9);
            prop_assert_eq!((flat.depth_per_texel, flat.corner_per_texel), (DVec2::ZERO, DVec2::ZERO));
        }
    }
}
