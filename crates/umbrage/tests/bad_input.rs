//! Settings, lights and bounds that must be refused, by name.

use glam::DVec3;
use umbrage::{
    Aabb, DirectionalLight, Error, ExtentSteps, Frustum, Planner, ShadowSettings, SplitScheme, Stabilize, View, Warp,
};

fn refused(change: impl FnOnce(&mut ShadowSettings)) -> &'static str {
    let mut settings = ShadowSettings::default();
    change(&mut settings);
    match Planner::new(settings).expect_err("these settings are not valid") {
        Error::InvalidSetting { field, .. } => field,
        other => panic!("another error: {other}"),
    }
}

#[test]
fn settings() {
    assert_eq!(refused(|s| s.map_sizes = vec![]), "map_sizes");
    assert_eq!(refused(|s| s.map_sizes = vec![512; 9]), "map_sizes");
    assert_eq!(refused(|s| s.map_sizes = vec![512, 0]), "map_sizes");
    assert_eq!(refused(|s| s.map_sizes = vec![512, 4]), "map_sizes");
    assert_eq!(refused(|s| s.map_sizes = vec![1 << 20]), "map_sizes");
    assert_eq!(refused(|s| s.blend = 1.5), "blend");
    assert_eq!(refused(|s| s.blend = f64::NAN), "blend");
    assert_eq!(refused(|s| s.far_fade = -0.1), "far_fade");
    assert_eq!(refused(|s| s.filter_radius = f64::NAN), "filter_radius");
    assert_eq!(refused(|s| s.filter_radius = -1.0), "filter_radius");
    for width in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(|s| s.filter_half_width_m = Some(width)), "filter_half_width_m");
    }
    assert_eq!(refused(|s| s.image_size = [0, 600]), "image_size");
    assert_eq!(refused(|s| s.range = Some((5.0, 5.0))), "range");
    assert_eq!(refused(|s| s.range = Some((f64::NAN, 5.0))), "range");
    assert_eq!(refused(|s| s.range = Some((0.0, 5.0))), "range");
    assert_eq!(refused(|s| s.range = Some((1.0, f64::INFINITY))), "range");
    let approximate = |steps| Stabilize::Approximate(steps);
    assert_eq!(refused(|s| s.stabilize = approximate(ExtentSteps::PerDoubling(0))), "stabilize");
    assert_eq!(refused(|s| s.stabilize = approximate(ExtentSteps::PerDoubling(65))), "stabilize");
    assert_eq!(refused(|s| s.stabilize = approximate(ExtentSteps::Levels(1 << 20))), "stabilize");
    // A texel to move by is needed besides the margins: 2 · 1.5 + 5.
    assert_eq!(refused(|s| s.map_sizes = vec![7]), "map_sizes");
    let practical = |lambda, delta| SplitScheme::Practical { lambda, delta };
    assert_eq!(refused(|s| s.scheme = practical(1.1, vec![])), "lambda");
    assert_eq!(refused(|s| s.scheme = practical(f64::NAN, vec![])), "lambda");
    assert_eq!(refused(|s| s.scheme = practical(0.5, vec![1.0, 2.0])), "delta");
    assert_eq!(refused(|s| s.scheme = practical(0.5, vec![f64::INFINITY])), "delta");
    assert_eq!(refused(|s| s.scheme = SplitScheme::Manual(vec![1.0])), "planes");
    assert_eq!(refused(|s| s.scheme = SplitScheme::Manual(vec![10.0, 9.0, 20.0])), "planes");
}

#[test]
fn warps_do_not_stand_still() {
    for stabilize in [Stabilize::Exact, Stabilize::Approximate(ExtentSteps::default())] {
        let settings = ShadowSettings { stabilize, warps: vec![Warp::Lispsm], ..ShadowSettings::default() };
        let error = Planner::new(settings).expect_err("a warp follows the camera");
        assert!(matches!(error, Error::ConflictingSettings { first: "warps", second: "stabilize", .. }), "{error}");
    }
}

/// The smallest maps that are allowed do have texels.
#[test]
fn small_maps() {
    let view = View::look_at_upright(DVec3::Y, DVec3::X, Frustum::perspective(1.0, 1.0, 1.0, 100.0).expect("valid"))
        .expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.2, -1.0, 0.1)).expect("valid");
    let boxes = [Aabb::new(DVec3::splat(-60.0), DVec3::splat(60.0))];
    for (stabilize, size) in
        [(Stabilize::None, 7), (Stabilize::Exact, 8), (Stabilize::Approximate(ExtentSteps::default()), 8)]
    {
        let settings = ShadowSettings { stabilize, map_sizes: vec![size; 2], ..ShadowSettings::default() };
        let mut planner = Planner::new(settings).expect("valid");
        let plan = planner.plan(&view, &light, &boxes, &boxes).expect("a plan");
        assert!(plan.splits.iter().all(|split| split.texel_m.min_element() > 0.0 && split.texel_m.is_finite()));
    }
}

#[test]
fn lights() {
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::splat(1e-320)] {
        assert!(
            matches!(DirectionalLight::new(direction), Err(Error::InvalidLight { field: "direction", .. })),
            "{direction}"
        );
    }
}

#[test]
fn bounds() {
    let mut planner = Planner::new(ShadowSettings::default()).expect("valid");
    let view = View::look_at_upright(DVec3::ZERO, DVec3::X, Frustum::perspective(1.0, 1.0, 1.0, 100.0).expect("valid"))
        .expect("valid");
    let light = DirectionalLight::new(DVec3::NEG_Y).expect("valid");
    let good = Aabb::new(DVec3::ZERO, DVec3::ONE);
    for bad in [
        Aabb::EMPTY,
        Aabb::new(DVec3::ONE, DVec3::ZERO),
        Aabb::new(DVec3::NAN, DVec3::ONE),
        Aabb::new(DVec3::ZERO, DVec3::INFINITY),
    ] {
        let casters = planner.plan(&view, &light, &[good, bad], &[good]).expect_err("a bad caster");
        assert!(matches!(casters, Error::InvalidBounds { list: "casters", index: 1, .. }), "{casters}");
        let receivers = planner.plan(&view, &light, &[good], &[bad]).expect_err("a bad receiver");
        assert!(matches!(receivers, Error::InvalidBounds { list: "receivers", index: 0, .. }), "{receivers}");
    }
    assert!(planner.plan(&view, &light, &[], &[]).is_ok(), "an empty world is a world");
    let point = Aabb::new(DVec3::X * 50.0, DVec3::X * 50.0);
    let plan = planner.plan(&view, &light, &[point], &[point]).expect("a point is a box");
    assert!(plan.splits.iter().all(|s| s.shadow_from_world().is_finite()), "{plan:?}");
}
