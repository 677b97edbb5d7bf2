//! Stillness: spheres that hold every slice, and maps that move in whole texels only.

use glam::{DQuat, DVec2, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, Projection, ShadowSettings, Stabilize, View, slice_sphere};

proptest! {
    #[test]
    fn the_sphere_holds_the_slice_and_no_smaller_one_does(
        l in 0.05..3.0f64, r in 0.05..3.0f64, b in 0.05..3.0f64, t in 0.05..3.0f64, symmetric in any::<bool>(),
        perspective in any::<bool>(), near in 0.01..10.0f64, ratio in prop_oneof![1.0001..1.01f64, 1.01..1000.0f64],
    ) {
        let (l, b) = if symmetric { (r, t) } else { (l, b) };
        let projection = if perspective { Projection::Perspective } else { Projection::Orthographic };
        let frustum = Frustum { projection, left: -l, right: r, bottom: -b, top: t, near, far: near * ratio };
        let sphere = slice_sphere(&frustum, near, near * ratio);
        let corners: Vec<DVec3> = frustum.corners_at(near).into_iter().chain(frustum.corners_at(near * ratio)).collect();
        let reach = |center: DVec3| corners.iter().map(|c| c.distance(center)).fold(0.0, f64::max);
        prop_assert!(reach(sphere.center) <= sphere.radius * (1.0 + 1e-9));
        // The least radius is where no step improves it: the radius about a centre is convex, so local is global.
        for step in [1e-2, 1e-4] {
            for axis in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
                prop_assert!(reach(sphere.center + axis * step * sphere.radius) >= sphere.radius * (1.0 - 1e-9));
            }
        }
    }

    #[test]
    fn maps_move_in_whole_texels(
        distance in prop_oneof![Just(0.0), Just(1e4), Just(1e5)],
        eye in prop::array::uniform3(-50.0..50.0f64), turn in prop::array::uniform3(-3.0..3.0f64), step in prop::array::uniform3(-2.0..2.0f64),
        sun in prop_oneof![Just([0.0, -1.0, 0.0]), (-1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, z)| [x, -0.5, z])],
    ) {
        let settings = ShadowSettings { range: Some((1.0, 300.0)), stabilize: Stabilize::Exact, ..ShadowSettings::default() };
        let mut planner = Planner::new(settings)?;
        let light = DirectionalLight::new(DVec3::from(sun))?;
        let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.1, 1000.0)?;
        let place = DVec3::new(distance, 0.0, -distance);
        let world = [Aabb::new(place - 400.0, place + 400.0)];
        let view = |eye: DVec3, turn: [f64; 3]| {
            let rotation = DQuat::from_euler(EulerRot::YXZ, turn[0], turn[1], turn[2]);
            View::look_at(eye, eye + rotation * DVec3::NEG_Z, rotation * DVec3::Y, frustum)
        };
        let eye = place + DVec3::from(eye);
        let first = planner.plan(&view(eye, [0.1, 0.2, 0.0])?, &light, &world, &world)?.clone();
        let second = planner.plan(&view(eye + DVec3::from(step), turn)?, &light, &world, &world)?;
        for (a, b) in first.splits.iter().zip(&second.splits) {
            prop_assert_eq!((a.u_axis, a.v_axis, a.texel_m), (b.u_axis, b.v_axis, b.texel_m));
            prop_assert_eq!((a.depth_near, a.depth_far), (b.depth_near, b.depth_far));
            prop_assert_eq!(a.min_texel.fract(), DVec2::ZERO);
            prop_assert_eq!(b.min_texel.fract(), DVec2::ZERO);
        }
    }

    #[test]
    fn a_zoom_changes_the_texel_in_steps(fovs in prop::collection::vec(0.3..1.2f64, 2..40)) {
        let settings = ShadowSettings { range: Some((1.0, 300.0)), stabilize: Stabilize::Exact, ..ShadowSettings::default() };
        let mut planner = Planner::new(settings.clone())?;
        let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
        let (mut held, mut changes) = (0.0, 0);
        for fov in &fovs {
            let view = View::look_at_upright(DVec3::ZERO, DVec3::NEG_Z, Frustum::perspective(*fov, 1.5, 0.1, 1000.0)?)?;
            let texel = planner.plan(&view, &light, &[], &[])?.splits[3].texel_m.x;
            let tight = Planner::new(settings.clone())?.plan(&view, &light, &[], &[])?.splits[3].texel_m.x;
            prop_assert!(texel >= tight * (1.0 - 1e-12), "the map no longer holds the slice");
            prop_assert!(texel <= tight * 2f64.powf(2.0 / 8.0) * (1.0 + 1e-9), "{texel} is much larger than {tight}");
            if texel != held {
                changes += 1;
                held = texel;
            }
        }
        // Between 0.3 and 1.2 rad the radius changes by less than a factor of 4: 16 steps; a zoom back and forth by less
        // than a step changes nothing.
        prop_assert!(changes <= fovs.len());
    }
}

#[test]
fn a_small_zoom_back_and_forth_changes_nothing() {
    let settings = ShadowSettings { range: Some((1.0, 300.0)), ..ShadowSettings::default() };
    let mut planner = Planner::new(settings).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let mut texel = |fov: f64| {
        let view = View::look_at_upright(
            DVec3::ZERO,
            DVec3::NEG_Z,
            Frustum::perspective(fov, 1.5, 0.1, 1000.0).expect("valid"),
        )
        .expect("valid");
        planner.plan(&view, &light, &[], &[]).expect("valid").splits[2].texel_m.x
    };
    let _ = texel(0.8);
    let held = texel(1.0);
    for fov in [0.97, 1.0, 0.95, 0.99, 1.0] {
        assert_eq!(texel(fov), held, "at {fov}");
    }
    assert!(texel(0.5) < held, "a long zoom does get finer texels");
}
