//! Warped splits through the planner: that they are warped at all, what their texels are, and what
//! is refused.

use glam::{DQuat, DVec3};
use umbrage::config::{Crop, Preset, Range, Stability};
use umbrage::{Aabb, DirectionalLight, Error, Frustum, Planner, ShadowConfig, ShadowPlan, View, Warp};

const WARPS: [Warp; 3] = [Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.2 }];

fn settings(warps: &[Warp], splits: usize) -> ShadowConfig {
    ShadowConfig {
        map_sizes: vec![512; splits],
        range: Range::Metres { near: 1.0, far: 300.0 },
        stability: Stability::Tight { warps: warps.to_vec() },
        ..Preset::Papers.config()
    }
}

/// A ground with posts, seen from 15 m up; the light comes from `bearing` degrees beside the view
/// and `up` degrees above the ground.
fn plan(settings: ShadowConfig, bearing: f64, up: f64) -> (View, ShadowPlan) {
    let mut world: Vec<Aabb> = (0..200)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 20) * 30.0 - 300.0, 0.0, f64::from(i / 20) * -30.0);
            Aabb::new(at, at + DVec3::new(2.0, 9.0, 2.0))
        })
        .collect();
    world.push(Aabb::new(DVec3::new(-600.0, -0.5, -600.0), DVec3::new(600.0, 0.0, 600.0)));
    let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 1.0, 400.0).expect("valid");
    let view = View::look_at_upright(DVec3::Y * 15.0, DVec3::new(0.0, 12.0, -40.0), frustum).expect("valid");
    let level = DQuat::from_rotation_y(bearing.to_radians()) * DVec3::NEG_Z;
    let to_light = level * up.to_radians().cos() + DVec3::Y * up.to_radians().sin();
    let light = DirectionalLight::new(-to_light).expect("valid");
    let mut planner = Planner::new(&settings).expect("valid");
    let plan = planner.plan(&view, &light, &world, &world).expect("valid").clone();
    (view, plan)
}

/// Largest over smallest texel along the ground before the eye.
fn spread(view: &View, plan: &ShadowPlan) -> f64 {
    let split = &plan.splits[0];
    let at = |d: f64| split.texel_size_m(DVec3::new(view.eye().x, 0.0, view.eye().z - d)).max_element();
    at(250.0) / at(30.0)
}

#[test]
fn warps_are_in_force_wherever_light_and_view_do_not_meet() {
    let (mut plain, mut all) = (0, 0);
    for warp in WARPS {
        for crop in [Crop::SceneIndependent, Crop::SceneDependent] {
            for bearing in [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0] {
                for up in [15.0, 30.0, 45.0, 60.0, 75.0, 90.0] {
                    let (view, plan) = plan(ShadowConfig { crop, ..settings(&[warp], 1) }, bearing, up);
                    assert!(!plan.splits[0].casters.is_empty());
                    let angle = view.forward().angle_between(-plan.light_direction).to_degrees();
                    if (40.0..140.0).contains(&angle) {
                        all += 1;
                        // Spread counts too: a warp that is there and does nothing is none.
                        plain += usize::from(plan.splits[0].warp.is_none() || spread(&view, &plan) < 2.0);
                    }
                }
            }
        }
    }
    assert!(all > 150 && plain * 20 < all, "{plain} of {all} maps are not warped");
}

#[test]
fn across_the_view_a_perspective_map_follows_the_eye() {
    // Light from the side: the camera's own perspective, so that a texel grows as depth does,
    // across the view.
    let (view, plan) = plan(ShadowConfig { crop: Crop::SceneIndependent, ..settings(&[Warp::Psm], 1) }, 90.0, 60.0);
    let spread = spread(&view, &plan);
    assert!((3.0..80.0).contains(&spread), "{spread}");
}

#[test]
fn dueling_frusta_get_their_plain_map_or_nearly() {
    let turn = |warp| {
        let (view, plan) = plan(settings(&[warp], 1), 0.0, 0.5);
        spread(&view, &plan)
    };
    let plain = turn(Warp::None);
    for warp in WARPS {
        assert!(turn(warp) / plain < 3.0, "{warp:?}: {} instead of {plain}", turn(warp));
    }
}

#[test]
fn each_split_has_its_own() {
    let (_, plan) = plan(settings(&[Warp::Tsm { focus: 0.3 }, Warp::Lispsm, Warp::None], 3), 60.0, 40.0);
    let warped: Vec<bool> = plan.splits.iter().map(|split| split.warp.is_some()).collect();
    assert_eq!(warped, [true, true, false]);
}

#[test]
fn gradients_are_those_of_the_map() {
    for warp in [Warp::None, Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.2 }] {
        let (view, plan) = plan(settings(&[warp], 2), 60.0, 40.0);
        for split in &plan.splits {
            let point = view.eye() + view.forward() * (0.5 * (split.near + split.far)) - DVec3::Y;
            let [u, v] = split.texel_jacobian(point);
            let [along_u, along_v] = split.texel_axes_m(point);
            assert!(u.dot(split.depth_axis).abs() < 1e-6 && v.dot(split.depth_axis).abs() < 1e-6, "{warp:?}");
            for (axis, direction) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
                let h = 1e-3;
                let change = split.map_from_world(point + direction * h) - split.map_from_world(point - direction * h);
                let expected = change.truncate() / (2.0 * h);
                assert!((u[axis] - expected.x).abs() < 1e-4 * (1.0 + expected.x.abs()), "{warp:?}: {u} {expected}");
                assert!((v[axis] - expected.y).abs() < 1e-4 * (1.0 + expected.y.abs()), "{warp:?}: {v} {expected}");
            }
            assert!((u.dot(along_u) - 1.0).abs() < 1e-9 && v.dot(along_u).abs() < 1e-9, "{warp:?}");
            assert!((v.dot(along_v) - 1.0).abs() < 1e-9 && u.dot(along_v).abs() < 1e-9, "{warp:?}");
            let normal = -split.depth_axis;
            let facing = split.bias_at(point, normal);
            assert!(facing.depth_per_texel.length() < 1e-6 && facing.constant_m > 0.0, "{warp:?}: {facing:?}");
        }
    }
}

#[test]
fn behind_its_centre_a_warped_map_shows_nothing() {
    let (view, plan) = plan(settings(&[Warp::Lispsm], 1), 90.0, 45.0);
    let behind = view.eye() - view.forward() * 1e5;
    assert!(plan.splits[0].map_from_world(behind).is_nan() && !plan.splits[0].contains(behind, 0.0));
}

#[test]
fn an_orthographic_camera_has_nothing_to_undo() {
    let frustum = Frustum::orthographic(80.0, 60.0, 1.0, 400.0).expect("valid");
    let view = View::look_at_upright(DVec3::Y * 15.0, DVec3::new(0.0, 12.0, -40.0), frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.5, -1.0, 0.2)).expect("valid");
    let world = [Aabb::new(DVec3::new(-2.0, 0.0, -50.0), DVec3::new(2.0, 5.0, -40.0))];
    for warp in WARPS {
        let mut planner = Planner::new(&settings(&[warp], 1)).expect("valid");
        let plan = planner.plan(&view, &light, &world, &world).expect("valid");
        assert_eq!(plan.splits[0].warp, None, "{warp:?}");
    }
}

#[test]
fn what_does_not_go_together_is_refused_at_creation() {
    let all_with = |warp: &str| {
        [("splits", "2"), ("stabilize", "exact"), ("warp", warp)].map(|(key, value)| (key.into(), value.into()))
    };
    let error = Preset::Papers.config().apply(&all_with("none,psm")).expect_err("a warp cannot stand still");
    assert!(matches!(error, Error::InvalidSetting { field: "warp", .. }), "{error}");
    assert!(error.to_string().contains("warp") && error.to_string().contains("stabilize"), "{error}");
    let mut still = Preset::Papers.config();
    assert!(still.apply(&all_with("none")).is_ok() && Planner::new(&still).is_ok(), "no warp at all may stand still");
    for (warps, key) in [
        (vec![Warp::Psm; 2], "warp"),
        (vec![Warp::Tsm { focus: 0.0 }], "tsm-focus"),
        (vec![Warp::Tsm { focus: f64::NAN }], "tsm-focus"),
    ] {
        let error = Planner::new(&settings(&warps, 3)).expect_err("not valid");
        assert!(matches!(error, Error::InvalidSetting { field, .. } if field == key), "{error}");
    }
}
