//! Planes that find themselves.

use glam::DVec3;
use proptest::prelude::*;
use umbrage::config::{
    Choice, Crop, ExtentSteps, Preset, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Transition,
};
use umbrage::{
    Aabb, DirectionalLight, Error, Frustum, Light, Planner, PointLight, SpotLight, View, Warp, split_planes,
};

fn fitted(splits: usize) -> ShadowConfig {
    ShadowConfig { map_sizes: vec![512; splits], scheme: SplitScheme::Optimal, ..Preset::Papers.config() }
}

fn tight(splits: usize) -> ShadowConfig {
    ShadowConfig { stability: Stability::tight(), transition: Transition::Hard, ..fitted(splits) }
}

fn lens(near: f64, far: f64) -> Frustum {
    Frustum::perspective(1.0, 1.5, near, far).expect("valid")
}

fn sun() -> DirectionalLight {
    DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("valid")
}

/// A view along −Z from 10 m above the ground.
fn view(frustum: Frustum) -> View {
    View::look_at_upright(DVec3::Y * 10.0, DVec3::new(0.0, 8.0, -30.0), frustum).expect("valid")
}

/// Rows of pillars across the view at these distances, and flat ground.
fn rows(distances: &[f64]) -> Vec<Aabb> {
    let row = |&distance: &f64| {
        (-4..=4).map(move |i| {
            let at = DVec3::new(f64::from(i) * 3.0, 0.0, -distance);
            Aabb::new(at - DVec3::new(0.5, 0.0, 0.5), at + DVec3::new(0.5, 5.0, 0.5))
        })
    };
    let ground = Aabb::new(DVec3::new(-900.0, 0.0, -900.0), DVec3::new(900.0, 0.0, 900.0));
    distances.iter().flat_map(row).chain([ground]).collect()
}

fn planes(settings: ShadowConfig, view: &View, world: &[Aabb]) -> Vec<f64> {
    let mut planner = Planner::new(&settings).expect("valid settings");
    planner.plan(view, &sun(), world, world).expect("a plan").planes.clone()
}

/// Area of all maps' texels.
fn texel_area(settings: ShadowConfig, view: &View, world: &[Aabb]) -> f64 {
    let mut planner = Planner::new(&settings).expect("valid settings");
    let plan = planner.plan(view, &sun(), world, world).expect("a plan");
    plan.splits.iter().filter(|split| !split.casters.is_empty()).map(|split| split.texel_m.element_product()).sum()
}

#[test]
fn a_plane_stands_in_the_gap_between_two_rows() {
    let world = rows(&[40.0, 42.0, 200.0, 203.0]);
    let planes = planes(tight(2), &view(lens(1.0, 800.0)), &world);
    // The first rows' shadows reach some 4 m on.
    assert!((46.0..199.0).contains(&planes[1]), "{planes:?}");
    let log = ShadowConfig { scheme: SplitScheme::Logarithmic, ..tight(2) };
    let view = view(lens(1.0, 800.0));
    let (fitted, log) = (texel_area(tight(2), &view, &world), texel_area(log, &view, &world));
    assert!(fitted < 0.5 * log, "log cuts at 28 m, before both rows: {fitted} {log}");
}

#[test]
fn a_caster_is_listed_by_the_reach_of_a_filter_in_the_map_that_it_leaves() {
    // 3 texels of a map of all ground up to 800 m are some 6 m, of a map of the rows beyond the
    // plane 0.15 m.
    let world = rows(&[40.0, 42.0, 200.0, 203.0]);
    let mut planner =
        Planner::new(&ShadowConfig { scheme: SplitScheme::Manual { planes: vec![48.0] }, ..tight(2) }).expect("valid");
    let view = view(lens(1.0, 800.0));
    let plan = planner.plan(&view, &sun(), &world, &world).expect("a plan");
    let listed = |i: usize| plan.caster_indices[plan.splits[i].casters.clone()].to_vec();
    assert_eq!(listed(0), (0..18).collect::<Vec<u32>>());
    assert_eq!(listed(1), (18..36).collect::<Vec<u32>>());
}

#[test]
fn nothing_that_throws_a_shadow_means_planes_of_near_and_far_alone() {
    let view = view(lens(1.0, 400.0));
    let mut log = Vec::new();
    split_planes(&SplitScheme::Logarithmic, 1.0, 400.0, 4, &mut log).expect("planes");
    let settings = || ShadowConfig { range: Range::Metres { near: 1.0, far: 400.0 }, ..tight(4) };
    assert_eq!(planes(settings(), &view, &[]), log);
    assert_eq!(planes(settings(), &view, &rows(&[])), log);
    // Behind the eye, its shadow too.
    let behind = Aabb::new(DVec3::new(0.0, 0.0, 90.0), DVec3::new(1.0, 1.0, 91.0));
    assert_eq!(planes(settings(), &view, &[behind]), log);
}

#[test]
fn one_caster_and_many_in_one_place() {
    let view = view(lens(1.0, 800.0));
    for world in [rows(&[50.0])[4..5].to_vec(), rows(&[50.0]), vec![rows(&[50.0])[4]; 100]] {
        for splits in 1..=8 {
            let planes = planes(tight(splits), &view, &world);
            assert_eq!(planes.len(), splits + 1);
            assert!(planes.windows(2).all(|p| p[0] < p[1]), "{planes:?}");
        }
    }
}

#[test]
fn maps_of_several_sizes_get_slices_of_several_lengths() {
    let world = rows(&(0..60).map(|i| 10.0 + 8.0 * f64::from(i)).collect::<Vec<_>>());
    let first = |sizes: [u32; 2]| {
        planes(ShadowConfig { map_sizes: sizes.to_vec(), ..tight(2) }, &view(lens(1.0, 800.0)), &world)[1]
    };
    let same = first([512, 512]);
    assert!(first([2048, 512]) > 1.2 * same && first([512, 2048]) < 0.9 * same);
}

#[test]
fn local_lights_and_scenes_that_are_not_there_are_refused() {
    let world = rows(&[30.0]);
    let mut planner = Planner::new(&tight(3)).expect("valid settings");
    let at = DVec3::new(0.0, 10.0, -20.0);
    let lamps: [Light; 2] = [
        PointLight::new(at, 80.0).expect("valid").into(),
        SpotLight::new(at, DVec3::NEG_Y, 0.8, 90.0).expect("valid").into(),
    ];
    for lamp in lamps {
        let error = planner.plan(&view(lens(1.0, 400.0)), &lamp, &world, &world).expect_err("no sun");
        let Error::Conflict(conflict) = error else { panic!("{error}") };
        assert_eq!((conflict.rule.first, conflict.rule.second), (Choice::OptimalScheme, Choice::LocalLight));
    }
    let error = split_planes(&SplitScheme::Optimal, 1.0, 100.0, 3, &mut Vec::new()).expect_err("no scene");
    assert!(matches!(error, Error::InvalidSetting { field: "scheme", .. }), "{error}");
}

#[test]
fn a_range_without_room_is_refused() {
    let near = 100.0f64;
    let far = near.next_up().next_up();
    for splits in [3, 8] {
        let settings = ShadowConfig { range: Range::Metres { near, far }, ..tight(splits) };
        let mut planner = Planner::new(&settings).expect("valid settings");
        let error = planner.plan(&view(lens(1.0, 400.0)), &sun(), &[], &rows(&[101.0])).expect_err("no room");
        assert!(matches!(error, Error::InvalidSetting { field: "shadow-range", .. }), "{error}");
    }
}

/// How often the planes change while the camera walks 30 m and turns by half a radian in 300
/// frames.
fn changes(stability: Stability) -> usize {
    let world = rows(&(0..30).map(|i| 15.0 + 13.0 * f64::from(i)).collect::<Vec<_>>());
    let mut planner = Planner::new(&ShadowConfig { stability, ..fitted(4) }).expect("valid settings");
    let mut before: Option<Vec<f64>> = None;
    let mut changes = 0;
    for frame in 0..300 {
        let (step, angle) = (0.1 * f64::from(frame), 0.5 * f64::from(frame) / 300.0);
        let eye = DVec3::new(0.0, 10.0, -step);
        let target = eye + DVec3::new(angle.sin(), -0.1, -angle.cos());
        let view = View::look_at_upright(eye, target, lens(1.0, 500.0)).expect("valid");
        let plan = planner.plan(&view, &sun(), &world, &world).expect("a plan");
        let inner = plan.planes[1..4].to_vec();
        changes += usize::from(before.is_some_and(|before| before != inner));
        before = Some(inner);
    }
    changes
}

#[test]
fn planes_are_held_where_maps_have_to_stand_still() {
    assert!(changes(Stability::Exact) <= 2, "exact: {}", changes(Stability::Exact));
    let approximate = changes(Stability::Approximate { steps: ExtentSteps::default() });
    assert!(approximate <= 5, "approximate: {approximate}");
    // What would be without: the comparison must be able to fail.
    assert!(changes(Stability::tight()) > 30, "tight: {}", changes(Stability::tight()));
}

#[derive(Clone, Debug)]
struct Case {
    settings: ShadowConfig,
    view: View,
    sun: DirectionalLight,
    world: Vec<Aabb>,
}

fn any_case() -> impl Strategy<Value = Case> {
    let number = || prop_oneof![Just(0.0), -300.0..300.0, -5.0..5.0];
    let point = move || (number(), number(), number()).prop_map(DVec3::from);
    let size = || prop_oneof![Just(0.0), 0.01..3.0, Just(500.0)];
    let aabb = (point(), (size(), size(), size())).prop_map(|(at, size)| Aabb::new(at, at + DVec3::from(size)));
    let sizes = proptest::collection::vec(prop_oneof![Just(64u32), Just(512), Just(2048)], 1..=8);
    let stability = prop_oneof![
        Just(Stability::tight()),
        Just(Stability::Exact),
        Just(Stability::Approximate { steps: ExtentSteps::default() }),
        Just(Stability::Approximate { steps: ExtentSteps::Levels(64) }),
    ];
    let crop = prop_oneof![Just(Crop::SceneDependent), Just(Crop::SceneIndependent)];
    let way = prop_oneof![
        Just((Range::Camera, Selection::VIEW_DEPTH)),
        Just((Range::Visible, Selection::VIEW_DEPTH)),
        Just((Range::Visible, Selection::Map)),
        Just((Range::Camera, Selection::Interval(SplitMetric::Distance))),
    ];
    let frustum = prop_oneof![
        3 => (0.01f64..3.0, prop_oneof![Just(f64::INFINITY), 20.0..2000.0]).prop_map(|(near, far)| lens(near, far)),
        1 => (0.5f64..50.0).prop_map(|near| Frustum::orthographic(80.0, 60.0, near, near + 400.0).expect("valid")),
        1 => (0.1f64..0.9).prop_map(|side| Frustum { left: -side, ..lens(0.5, 900.0) }),
    ];
    let share = prop_oneof![Just(0.0), Just(0.1), Just(1.0)];
    let warp = any::<bool>();
    (
        sizes,
        stability,
        crop,
        way,
        frustum,
        share,
        warp,
        (point(), point(), point()),
        proptest::collection::vec(aabb, 0..40),
    )
        .prop_filter_map(
            "a camera and a sun",
            |(
                map_sizes,
                mut stability,
                crop,
                (range, mut selection),
                frustum,
                share,
                warp,
                (eye, target, sun),
                world,
            )| {
                let orthographic = frustum.projection == umbrage::Projection::Orthographic;
                if orthographic && selection != Selection::Map {
                    selection = Selection::VIEW_DEPTH;
                }
                if warp && selection == Selection::VIEW_DEPTH && stability == Stability::tight() {
                    stability = Stability::Tight { warps: vec![Warp::Lispsm] };
                }
                let scheme = SplitScheme::Optimal;
                Some(Case {
                    settings: ShadowConfig {
                        map_sizes,
                        scheme,
                        stability,
                        crop,
                        range,
                        selection,
                        transition: Transition::Blend { share },
                        ..Preset::Papers.config()
                    },
                    view: View::look_at_upright(eye, target, frustum).ok()?,
                    sun: DirectionalLight::new(sun).ok()?,
                    world,
                })
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn planes_rise_from_end_to_end(case in any_case()) {
        let mut planner = Planner::new(&case.settings).expect("valid settings");
        let other = SplitScheme::Logarithmic;
        let mut plain = Planner::new(&ShadowConfig { scheme: other, ..case.settings.clone() }).expect("valid settings");
        let half = case.world.len() / 2;
        // A second frame, with what the first holds and half of its world.
        for world in [&case.world[..], &case.world[half..]] {
            let plan = planner.plan(&case.view, &case.sun, world, world).expect("a plan");
            let plain = plain.plan(&case.view, &case.sun, world, world).expect("a plan");
            let m = case.settings.splits();
            prop_assert_eq!(plan.planes.len(), m + 1);
            prop_assert!(plan.planes.iter().all(|plane| plane.is_finite()));
            prop_assert!(plan.planes.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", plan.planes);
            prop_assert_eq!((plan.planes[0], plan.planes[m]), (plain.planes[0], plain.planes[m]), "the range is the same");
        }
    }
}
