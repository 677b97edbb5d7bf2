//! A fuzzer of plans: any camera, sun and scene against what every plan has to keep. 512 cases in a
//! plain test run; `cargo xtask fuzz` or `UMBRAGE_FUZZ_CASES` asks for more.

mod case;

use case::{Case, keeps_its_promises, seen};
use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use umbrage::config::{
    Crop, ExtentSteps, FitTo, Preset, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Transition,
};
use umbrage::{Aabb, DirectionalLight, FilterReach, Frustum, PlannerOptions, Projection, View};

/// A check of a commit tries the same cases every time; a long run tries new ones.
fn config() -> ProptestConfig {
    let is_long = std::env::var_os("UMBRAGE_FUZZ_CASES").is_some();
    let rng_seed = if is_long { RngSeed::Random } else { RngSeed::Fixed(2026) };
    ProptestConfig { rng_seed, ..ProptestConfig::with_cases(cases()) }
}

fn cases() -> u32 {
    std::env::var("UMBRAGE_FUZZ_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(512)
}

/// Any direction, with those among them in which axes coincide or nearly do.
fn direction() -> impl Strategy<Value = DVec3> {
    let part = || prop_oneof![Just(0.0), Just(1.0), Just(-1.0), -1.0..1.0f64, Just(1e-7), Just(-1e-12)];
    [part(), part(), part()].prop_map(DVec3::from).prop_map(|d| if d.length() > 1e-3 { d } else { DVec3::NEG_Y })
}

fn settings() -> impl Strategy<Value = (ShadowConfig, PlannerOptions)> {
    let scheme = prop_oneof![
        Just(SplitScheme::Logarithmic),
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Optimal),
        Just(SplitScheme::practical()),
    ];
    let stability = prop_oneof![
        Just(Stability::tight()),
        Just(Stability::Exact),
        Just(Stability::Approximate { steps: ExtentSteps::default() }),
        Just(Stability::Approximate { steps: ExtentSteps::Levels(64) }),
    ];
    let way = prop_oneof![
        3 => Just(Selection::Interval(SplitMetric::ViewDepth)),
        2 => Just(Selection::Map),
        1 => Just(Selection::Interval(SplitMetric::Distance)),
    ];
    let range = prop_oneof![3 => Just(Range::Camera), 1 => (0.1..50.0f64, 1.5..1000.0f64).prop_map(|(n, r)| Range::Metres { near: n, far: n * r })];
    let share = prop_oneof![Just(0.0), 0.0..1.0f64];
    (1usize..=8, scheme, stability, way, range, share, any::<[bool; 3]>(), 0.5..4.0f64).prop_map(
        |(m, scheme, stability, selection, range, share, [dependent, depth_clamp, visible], radius_texels)| {
            let fits = visible && range == Range::Camera && selection.metric() == SplitMetric::ViewDepth;
            let fits_to_depth = dependent && selection == Selection::Map && stability != Stability::Exact;
            let config = ShadowConfig {
                map_sizes: vec![256; m],
                scheme,
                stability,
                selection,
                range: if fits { Range::Visible } else { range },
                transition: Transition::Blend { share },
                crop: if dependent { Crop::SceneDependent } else { Crop::SceneIndependent },
                fit_to: if fits_to_depth { FitTo::Depth } else { FitTo::Boxes },
                ..Preset::Papers.config()
            };
            let reach = FilterReach { radius_texels, radius_m: None };
            (config, PlannerOptions { depth_clamp, filter_reach: Some(reach), ..PlannerOptions::default() })
        },
    )
}

/// Boxes about the origin, often on a ground of any size, sometimes with one that is very far away.
fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let size = || prop_oneof![4 => 0.05..4.0f64, 1 => Just(0.0), 1 => 10.0..80.0f64];
    let one = ([-30.0..30.0f64, -0.5..8.0, -30.0..30.0], [size(), size(), size()])
        .prop_map(|(at, size)| Aabb::new(DVec3::from(at), DVec3::from(at) + DVec3::from(size)));
    let ground = prop_oneof![1 => Just(None), 3 => (1.0..6.0f64).prop_map(|e| Some(10f64.powf(e)))];
    let far = prop_oneof![3 => Just(None), 1 => (direction(), 4.0..9.0f64, -3.0..0.0f64).prop_map(Some)];
    (prop::collection::vec(one, 1..24), ground, far).prop_map(|(mut boxes, ground, far)| {
        if let Some(half) = ground {
            boxes.push(Aabb::new(DVec3::new(-half, 0.0, -half), DVec3::new(half, 0.0, half)));
        }
        if let Some((direction, distance, size)) = far {
            let (at, half) = (direction.normalize() * 10f64.powf(distance), 10f64.powf(distance + size - 1.0));
            boxes.push(Aabb::new(at - half, at + half));
        }
        boxes
    })
}

fn lens() -> impl Strategy<Value = Frustum> {
    let far = prop_oneof![Just(f64::INFINITY), 20.0..3000.0f64];
    let perspective = (0.05..2.6f64, 0.5..2.5f64, prop_oneof![Just(0.01), 0.01..1.0f64], far)
        .prop_map(|(fov, aspect, near, far)| Frustum::perspective(fov, aspect, near, far).expect("a lens"));
    let orthographic = (5.0..200.0f64, 0.1..10.0f64, 50.0..3000.0f64)
        .prop_map(|(width, near, far)| Frustum::orthographic(width, 0.7 * width, near, far).expect("a lens"));
    (prop_oneof![5 => perspective, 1 => orthographic], any::<bool>()).prop_map(|(lens, off_axis)| match off_axis {
        true => Frustum { left: 0.2 * lens.left, top: 1.3 * lens.top, ..lens },
        false => lens,
    })
}

/// Some frames: a camera that walks, turns or stands, at first along the sun, nearly so, or
/// anywhere.
fn any_case() -> impl Strategy<Value = Case> {
    let off = prop_oneof![Just(0.0), Just(1e-15), Just(1e-9), Just(1e-6), Just(1e-3), Just(1.0)];
    let steps = prop::collection::vec((prop_oneof![Just(0.0), 0.0..3.0f64], -0.3..0.3f64), 0..4);
    let eye = [-40.0..40.0f64, 0.2..30.0, -40.0..40.0];
    let standing = prop_oneof![7 => Just(0u32), 1 => 20..60u32];
    let moves = prop_oneof![Just(DVec3::ZERO), [-0.5..0.5f64, -0.1..0.1, -0.5..0.5].prop_map(DVec3::from)];
    let probe = [-120.0..120.0f64, -2.0..20.0, -120.0..120.0].prop_map(DVec3::from);
    (
        settings(),
        boxes(),
        direction(),
        lens(),
        (eye, direction(), off, any::<bool>()),
        (steps, standing, moves),
        (prop::collection::vec(probe, 12), prop::option::of(any::<[u8; 8]>())),
    )
        .prop_map(
            |(
                (mut settings, options),
                boxes,
                sun,
                lens,
                (eye, look, off, against),
                (steps, standing, moves),
                (probes, parts),
            )| {
                let sun = DirectionalLight::new(sun).expect("a direction");
                let along = if against { -sun.direction() } else { sun.direction() };
                let ahead = (along + off * look).try_normalize().unwrap_or(along);
                let up = if ahead.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
                let mut at = DVec3::from(eye);
                let mut views = vec![View::look_at(at, at + ahead, up, lens).expect("a view")];
                for (step, turn) in steps {
                    at += DVec3::X * step;
                    let ahead = DQuat::from_euler(EulerRot::YXZ, turn, 0.1 * turn, 0.0) * ahead;
                    let up = if ahead.y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
                    views.push(View::look_at(at, at + ahead, up, lens).expect("a view"));
                }
                let is_radial = settings.selection.metric() == SplitMetric::Distance;
                if is_radial && lens.projection == Projection::Orthographic {
                    settings.selection = Selection::VIEW_DEPTH;
                }
                let seen = parts.map(|parts| seen(&boxes, &parts.map(|part| part % 16)));
                Case { settings, options, views, standing, moves, sun, boxes, seen, probes }
            },
        )
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn every_plan_keeps_its_promises(case in any_case()) {
        keeps_its_promises(&case)?;
    }
}
