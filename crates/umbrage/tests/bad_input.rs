//! Settings, lights and bounds that must be refused, by name.

use glam::DVec3;
use umbrage::{
    Aabb, DirectionalLight, Error, ExtentSteps, Frustum, Planner, PointLight, ShadowSettings, SplitScheme, Stabilize,
    View, Warp,
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

/// Huge but finite numbers are refused by name, with the bounds; those within them give plans without NaN.
#[test]
fn numbers_without_meaning() {
    let lens = Frustum::perspective(1.0, 1.0, 1.0, 100.0).expect("valid");
    let camera = |result: umbrage::Result<View>| match result.expect_err("no camera") {
        Error::InvalidCamera { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    assert_eq!(camera(View::look_at_upright(DVec3::splat(1e154), DVec3::ZERO, lens)), "eye");
    let frustum = |result: umbrage::Result<Frustum>| match result.expect_err("no frustum") {
        Error::InvalidCamera { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    assert_eq!(frustum(Frustum::perspective(1.0, 1.0, 1e-300, 100.0)), "near");
    assert_eq!(frustum(Frustum::perspective(1.0, 1.0, 1.0, 1e154)), "far");
    assert_eq!(frustum(Frustum::perspective(1.0, 1e200, 1.0, 10.0)), "left");
    assert_eq!(frustum(Frustum::orthographic(1e154, 1.0, 1.0, 10.0)), "left");
    let light = |result: umbrage::Result<PointLight>| match result.expect_err("no lamp") {
        Error::InvalidLight { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    assert_eq!(light(PointLight::new(DVec3::ZERO, 1e-17)), "range");
    assert_eq!(light(PointLight::new(DVec3::ZERO, 1e154)), "range");
    assert_eq!(light(PointLight::new(DVec3::splat(1e154), 1.0)), "position");
    let view = View::look_at_upright(DVec3::ZERO, DVec3::X, lens).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let mut planner = Planner::new(ShadowSettings::default()).expect("valid");
    let huge = Aabb::new(DVec3::splat(-1e154), DVec3::splat(1e154));
    let error = planner.plan(&view, &sun, &[huge], &[]).expect_err("no box");
    assert!(error.to_string().contains("10^12"), "{error}");
    for size in [1e6, 1e12] {
        let boxes = [Aabb::new(DVec3::splat(-size), DVec3::splat(size)), Aabb::new(DVec3::X * 5.0, DVec3::X * 6.0)];
        let plan = planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
        assert!(plan.splits.iter().all(|s| s.shadow_from_world().is_finite() && s.texel_m.is_finite()), "{plan:?}");
    }
}

/// A frame that is refused changes nothing of the next.
#[test]
fn a_refused_frame_leaves_no_trace() {
    let view = |x: f64| {
        let lens = Frustum::perspective(1.0, 1.0, 0.1, 1000.0).expect("valid");
        View::look_at_upright(DVec3::new(x, 2.0, 0.0), DVec3::new(x, 1.0, -9.0), lens).expect("valid")
    };
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let world = [Aabb::new(DVec3::splat(-100.0), DVec3::splat(100.0))];
    for scheme in [SplitScheme::default(), SplitScheme::Fitted] {
        let settings = ShadowSettings { scheme, ..ShadowSettings::default() };
        let (mut plain, mut disturbed) =
            (Planner::new(settings.clone()).expect("valid"), Planner::new(settings).expect("valid"));
        for frame in 0..40 {
            let now = view(0.4 * f64::from(frame));
            let expected = plain.plan(&now, &sun, &world, &world).expect("a plan").clone();
            let elsewhere = view(300.0 - f64::from(frame));
            disturbed.plan(&elsewhere, &sun, &world, &[Aabb::EMPTY]).expect_err("a bad box");
            let beyond = [Aabb::new(DVec3::splat(1e13), DVec3::splat(2e13))];
            disturbed.plan(&elsewhere, &sun, &beyond, &world).expect_err("a box beyond all bounds");
            assert_eq!(disturbed.plan(&now, &sun, &world, &world).expect("a plan"), &expected, "frame {frame}");
        }
    }
}

/// Without stabilisation a plan does not depend on the frames before, whatever the scheme.
#[test]
fn tight_plans_have_no_memory() {
    let world: Vec<Aabb> = (0..40)
        .map(|i| {
            let at = DVec3::new(f64::from(i * 17 % 60) - 30.0, 0.0, -f64::from(i * 23 % 90));
            Aabb::new(at, at + DVec3::new(1.0, 3.0, 1.0))
        })
        .collect();
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    for scheme in [SplitScheme::default(), SplitScheme::Fitted] {
        let settings = ShadowSettings { scheme, stabilize: Stabilize::None, ..ShadowSettings::default() };
        let mut walking = Planner::new(settings.clone()).expect("valid");
        for frame in 0..30 {
            let lens = Frustum::perspective(1.0, 1.0, 0.1, 300.0).expect("valid");
            let eye = DVec3::new(0.0, 5.0, 10.0 - 2.0 * f64::from(frame));
            let view = View::look_at_upright(eye, eye + DVec3::new(0.1, -0.1, -1.0), lens).expect("valid");
            let plan = walking.plan(&view, &sun, &world, &world).expect("a plan");
            let mut fresh = Planner::new(settings.clone()).expect("valid");
            assert_eq!(plan, fresh.plan(&view, &sun, &world, &world).expect("a plan"), "frame {frame}");
        }
    }
}
