//! Radial bands: what a turning camera leaves alone, and what they cannot be combined with.

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use umbrage::config::{Choice, Preset, Range, Selection, SplitMetric, Transition};
use umbrage::{Aabb, DirectionalLight, Error, Frustum, Planner, PlannerOptions, ShadowConfig, SpotLight, View};

const EYE: DVec3 = DVec3::new(3.0, 4.0, -2.0);

fn lens() -> Frustum {
    Frustum::perspective(1.0, 1.5, 0.5, 100.0).expect("a lens")
}

fn turned(yaw: f64, pitch: f64, lens: Frustum) -> View {
    let ahead = DQuat::from_rotation_y(yaw) * DQuat::from_rotation_x(pitch) * DVec3::NEG_Z;
    View::look_at_upright(EYE, EYE + ahead, lens).expect("a view")
}

fn sun() -> DirectionalLight {
    DirectionalLight::new(DVec3::new(0.3, -1.0, 0.4)).expect("a sun")
}

fn world() -> Vec<Aabb> {
    let boxes = (0..60).map(|i| {
        let at = DVec3::new(f64::from(i * 37 % 100) - 50.0, 0.0, f64::from(i * 61 % 100) - 50.0);
        Aabb::new(at, at + DVec3::new(2.0, 5.0, 2.0))
    });
    boxes.chain([Aabb::new(DVec3::new(-60.0, 0.0, -60.0), DVec3::new(60.0, 0.0, 60.0))]).collect()
}

/// Of points around the eye the splits in several directions of the same eye: how many change.
fn changed(metric: SplitMetric, turns: &[(f64, f64)], points: &[DVec3]) -> usize {
    let mut planner = Planner::new(&ShadowConfig { selection: Selection::Interval(metric), ..Preset::Papers.config() })
        .expect("settings");
    let mut before: Option<Vec<Option<usize>>> = None;
    let mut changed = 0;
    for &(yaw, pitch) in turns {
        let plan = planner.plan(&turned(yaw, pitch, lens()), &sun(), &world(), &world()).expect("a plan");
        let splits: Vec<_> =
            points.iter().map(|&point| plan.splits.iter().position(|split| plan.depth_at(point) < split.far)).collect();
        changed += before.map_or(0, |before| before.iter().zip(&splits).filter(|(was, is)| was != is).count());
        before = Some(splits);
    }
    changed
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    #[test]
    fn turning_changes_the_split_of_no_point(
        turns in prop::collection::vec((-3.1..3.1f64, -1.2..1.2f64), 2..6),
        points in prop::collection::vec((-60.0..60.0f64, 0.0..9.0f64, -60.0..60.0f64), 40),
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        prop_assert_eq!(changed(SplitMetric::Distance, &turns, &points), 0);
    }
}

/// The comparison above can say no.
#[test]
fn planar_bands_turn_with_the_camera() {
    let points: Vec<DVec3> = (0..40).map(|i| DVec3::new(f64::from(i) - 20.0, 0.0, -30.0)).collect();
    assert!(changed(SplitMetric::ViewDepth, &[(0.0, 0.0), (0.4, 0.0)], &points) > 5);
}

/// The farthest corner of an off-axis view decides how much view depth a band needs.
#[test]
fn a_radial_slice_is_widened_to_its_farthest_corner() {
    let off_axis = Frustum { left: -2.0, right: 0.1, bottom: -0.2, top: 1.0, ..lens() };
    let settings = ShadowConfig {
        selection: Selection::Interval(SplitMetric::Distance),
        range: Range::Metres { near: 1.0, far: 90.0 },
        transition: Transition::Hard,
        ..Preset::Papers.config()
    };
    let options = PlannerOptions { image_size: [1_000_000; 2], ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&settings, options).expect("settings");
    let plan = planner.plan(&turned(0.3, 0.0, off_axis), &sun(), &world(), &world()).expect("a plan");
    assert_eq!((plan.metric(), plan.eye), (SplitMetric::Distance, EYE));
    for split in &plan.splits[1..] {
        let expected = split.near / 6.0_f64.sqrt();
        assert!((split.coverage.0 - expected).abs() < 1e-3 * expected, "{:?} of {}", split.coverage, split.near);
        assert!((split.coverage.1 - split.far).abs() < 1e-9);
    }
}

#[test]
fn what_radial_bands_exclude_is_named() {
    let selection = Selection::Interval(SplitMetric::Distance);
    let radial = ShadowConfig { selection, ..Preset::Papers.config() };
    let named = |error: Error| match error {
        Error::Conflict(conflict) => (conflict.rule.first, conflict.rule.second),
        other => panic!("{other}"),
    };
    let visible = Planner::new(&ShadowConfig { range: Range::Visible, ..radial.clone() }).expect_err("a conflict");
    assert_eq!(named(visible), (Choice::VisibleRange, Choice::DistanceMetric));
    let mut planner = Planner::new(&radial).expect("settings");
    let flat = turned(0.0, 0.0, Frustum::orthographic(10.0, 10.0, 0.5, 100.0).expect("a lens"));
    let error = planner.plan(&flat, &sun(), &[], &[]).expect_err("no eye");
    assert!(matches!(error, Error::CameraConflict { setting: "bands", .. }), "{error}");
    let spot = SpotLight::new(DVec3::Y * 9.0, DVec3::NEG_Y, 0.5, 20.0).expect("a spot light");
    let local = planner.plan(&turned(0.0, 0.0, lens()), &spot, &[], &[]).expect_err("local");
    assert_eq!(named(local), (Choice::DistanceMetric, Choice::LocalLight));
}
