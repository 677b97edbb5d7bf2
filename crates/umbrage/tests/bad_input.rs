//! Settings, lights and bounds that must be refused, by name.

use glam::DVec3;
use umbrage::config::{DepthFormat, ExtentSteps, Filter, Look, Preset, Range, SplitScheme, Stability, Transition};
use umbrage::{
    Aabb, DirectionalLight, Error, FilterReach, Frustum, PlanInputs, Planner, PlannerOptions, PointLight, ShadowConfig,
    View,
};

fn refused(change: impl FnOnce(&mut ShadowConfig)) -> &'static str {
    let mut config = Preset::Papers.config();
    change(&mut config);
    named(Planner::new(&config))
}

fn refused_option(change: impl FnOnce(&mut PlannerOptions)) -> &'static str {
    let mut options = PlannerOptions::default();
    change(&mut options);
    named(Planner::with_options(&Preset::Papers.config(), options))
}

fn named(result: umbrage::Result<Planner>) -> &'static str {
    match result.expect_err("these settings are not valid") {
        Error::InvalidSetting { field, .. } => field,
        other => panic!("another error: {other}"),
    }
}

#[test]
fn settings() {
    assert_eq!(refused(|c| c.map_sizes = vec![]), "splits");
    assert_eq!(refused(|c| c.map_sizes = vec![512; 9]), "splits");
    assert_eq!(refused(|c| c.map_sizes = vec![512, 0]), "map-size");
    assert_eq!(refused(|c| c.map_sizes = vec![512, 4]), "map-size");
    assert_eq!(refused(|c| c.map_sizes = vec![1 << 20]), "map-size");
    assert_eq!(refused(|c| c.transition = Transition::Blend { share: 1.5 }), "blend");
    assert_eq!(refused(|c| c.transition = Transition::Blend { share: f64::NAN }), "blend");
    assert_eq!(refused(|c| c.far_fade = -0.1), "far-fade");
    let range = |near, far| Range::Metres { near, far };
    assert_eq!(refused(|c| c.range = range(5.0, 5.0)), "shadow-range");
    assert_eq!(refused(|c| c.range = range(f64::NAN, 5.0)), "shadow-range");
    assert_eq!(refused(|c| c.range = range(0.0, 5.0)), "shadow-range");
    assert_eq!(refused(|c| c.range = range(1.0, f64::INFINITY)), "shadow-range");
    let approximate = |steps| Stability::Approximate { steps };
    assert_eq!(refused(|c| c.stability = approximate(ExtentSteps::PerDoubling(0))), "extent-steps");
    assert_eq!(refused(|c| c.stability = approximate(ExtentSteps::PerDoubling(65))), "extent-steps");
    assert_eq!(refused(|c| c.stability = approximate(ExtentSteps::Levels(1 << 20))), "extent-levels");
    // A texel to move by is needed besides the margins: 2 · 1.5 + 5.
    assert_eq!(refused(|c| c.map_sizes = vec![7]), "map-size");
    let practical = |lambda, delta| SplitScheme::Practical { lambda, delta };
    assert_eq!(refused(|c| c.scheme = practical(1.1, vec![])), "lambda");
    assert_eq!(refused(|c| c.scheme = practical(f64::NAN, vec![])), "lambda");
    assert_eq!(refused(|c| c.scheme = practical(0.5, vec![1.0, 2.0])), "delta");
    assert_eq!(refused(|c| c.scheme = practical(0.5, vec![f64::INFINITY])), "delta");
    assert_eq!(refused(|c| c.scheme = practical(0.5, vec![1e13])), "delta");
    assert_eq!(refused(|c| c.scheme = SplitScheme::Manual { planes: vec![1.0] }), "planes");
    assert_eq!(refused(|c| c.scheme = SplitScheme::Manual { planes: vec![10.0, 9.0, 20.0] }), "planes");
}

#[test]
fn options() {
    let reach = |radius_texels, radius_m| Some(FilterReach { radius_texels, radius_m });
    for radius in [f64::NAN, -1.0, 65.0] {
        assert_eq!(refused_option(|o| o.filter_reach = reach(radius, None)), "radius_texels");
    }
    for width in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(refused_option(|o| o.filter_reach = reach(1.5, Some(width))), "radius_m");
    }
    assert_eq!(refused_option(|o| o.image_size = [0, 600]), "image_size");
    // A filter of the engine's own asks for its own margins: 2 · 4 + 5.
    let wide = PlannerOptions { filter_reach: reach(4.0, None), ..PlannerOptions::default() };
    let of_size = |size| ShadowConfig { map_sizes: vec![size; 2], ..Preset::Papers.config() };
    assert_eq!(named(Planner::with_options(&of_size(12), wide)), "map-size");
    assert!(Planner::with_options(&of_size(13), wide).is_ok());
}

#[test]
fn warps_do_not_stand_still() {
    for stability in ["exact", "approximate"] {
        let given = [("stabilize", stability), ("warp", "lispsm")].map(|(key, value)| (key.into(), value.into()));
        let error = Preset::Papers.config().apply(&given).expect_err("a warp follows the camera");
        assert!(matches!(error, Error::InvalidSetting { field: "warp", .. }), "{error}");
        assert!(error.to_string().contains(&format!("stabilize {stability}")), "{error}");
    }
}

/// A planner goes on holding what it holds through every change that plans do not depend on, and
/// through no other.
#[test]
fn a_change_of_what_is_not_planned_leaves_a_planner_alone() {
    let lens = Frustum::perspective(1.0, 1.0, 0.1, 1000.0).expect("valid");
    let view = View::look_at_upright(DVec3::Y, DVec3::X, lens).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(0.2, -1.0, 0.1)).expect("valid");
    let boxes = [Aabb::new(DVec3::splat(-60.0), DVec3::splat(60.0))];
    let papers = Preset::Papers.config();
    let options = PlannerOptions::default();
    let holds_after = |config: &ShadowConfig, options| {
        let mut planner = Planner::new(&papers).expect("valid");
        planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
        planner.set_config(config, options).expect("valid");
        assert_eq!((planner.config(), planner.options()), (config, options));
        *planner.held() != umbrage::Held::default()
    };
    let strength = Look { strength: 0.5, ..Look::default() };
    let dither = Transition::Dither { share: papers.blend() };
    for same in [
        papers.clone(),
        ShadowConfig { look: strength, ..papers.clone() },
        ShadowConfig { depth_format: DepthFormat::D16Unorm, ..papers.clone() },
        ShadowConfig { transition: dither, ..papers.clone() },
    ] {
        assert!(holds_after(&same, options), "{same:?}");
    }
    for other in [
        ShadowConfig { far_fade: 0.2, ..papers.clone() },
        ShadowConfig { transition: Transition::Hard, ..papers.clone() },
        ShadowConfig { filter: Filter::Pcf5 { width_m: None }, ..papers.clone() },
        ShadowConfig { range: Range::Visible, ..papers.clone() },
    ] {
        assert!(!holds_after(&other, options), "{other:?}");
    }
    assert!(!holds_after(&papers, PlannerOptions { depth_clamp: true, ..options }));
    let mut planner = Planner::new(&papers).expect("valid");
    let wrong = ShadowConfig { far_fade: 2.0, ..papers.clone() };
    assert!(planner.set_config(&wrong, options).is_err() && *planner.config() == papers);
}

/// The smallest maps that are allowed do have texels.
#[test]
fn small_maps() {
    let view = View::look_at_upright(DVec3::Y, DVec3::X, Frustum::perspective(1.0, 1.0, 1.0, 100.0).expect("valid"))
        .expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.2, -1.0, 0.1)).expect("valid");
    let boxes = [Aabb::new(DVec3::splat(-60.0), DVec3::splat(60.0))];
    for (stability, size) in
        [(Stability::tight(), 7), (Stability::Exact, 8), (Stability::Approximate { steps: ExtentSteps::default() }, 8)]
    {
        let settings = ShadowConfig { stability, map_sizes: vec![size; 2], ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings).expect("valid");
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
    let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
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
        let (seen, boxes) = ([good, good, bad], [good]);
        let inputs = PlanInputs { seen: Some(&seen), ..PlanInputs::new(&view, light, &boxes, &boxes) };
        let seen = planner.plan_frame(&inputs).expect_err("a bad box");
        assert!(matches!(seen, Error::InvalidBounds { list: "seen", index: 2, .. }), "{seen}");
    }
    assert!(planner.plan(&view, &light, &[], &[]).is_ok(), "an empty world is a world");
    let point = Aabb::new(DVec3::X * 50.0, DVec3::X * 50.0);
    let plan = planner.plan(&view, &light, &[point], &[point]).expect("a point is a box");
    assert!(plan.splits.iter().all(|s| s.shadow_from_world().is_finite()), "{plan:?}");
}

/// Huge but finite numbers are refused by name, with the bounds; those within them give plans
/// without NaN.
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
    let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
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
    for scheme in [SplitScheme::practical(), SplitScheme::Optimal] {
        let settings = ShadowConfig { scheme, ..Preset::Papers.config() };
        let (mut plain, mut disturbed) =
            (Planner::new(&settings).expect("valid"), Planner::new(&settings).expect("valid"));
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
    for scheme in [SplitScheme::practical(), SplitScheme::Optimal] {
        let settings = ShadowConfig { scheme, stability: Stability::tight(), ..Preset::Papers.config() };
        let mut walking = Planner::new(&settings).expect("valid");
        for frame in 0..30 {
            let lens = Frustum::perspective(1.0, 1.0, 0.1, 300.0).expect("valid");
            let eye = DVec3::new(0.0, 5.0, 10.0 - 2.0 * f64::from(frame));
            let view = View::look_at_upright(eye, eye + DVec3::new(0.1, -0.1, -1.0), lens).expect("valid");
            let plan = walking.plan(&view, &sun, &world, &world).expect("a plan");
            let mut fresh = Planner::new(&settings).expect("valid");
            assert_eq!(plan, fresh.plan(&view, &sun, &world, &world).expect("a plan"), "frame {frame}");
        }
    }
}
