//! A fuzzer of plans: any camera, sun and scene against what every plan has to keep. 512 cases in a
//! plain test run; `cargo xtask fuzz` or `UMBRAGE_FUZZ_CASES` asks for more.

use glam::{DQuat, DVec2, DVec3, EulerRot};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use umbrage::config::{
    Crop, ExtentSteps, FitTo, Preset, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Transition,
};
use umbrage::{
    Aabb, DirectionalLight, FilterReach, Frustum, PlanInputs, Planner, PlannerOptions, Projection, ShadowPlan, View,
};

#[derive(Clone, Debug)]
struct Case {
    settings: ShadowConfig,
    options: PlannerOptions,
    views: Vec<View>,
    sun: DirectionalLight,
    boxes: Vec<Aabb>,
    /// What an earlier picture showed: parts of some boxes, or none of them.
    seen: Option<Vec<Aabb>>,
    probes: Vec<DVec3>,
}

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

/// Of each box an eighth, or nothing.
fn seen(boxes: &[Aabb], parts: &[u8; 8]) -> Vec<Aabb> {
    let part = |(index, bounds): (usize, &Aabb)| {
        let octant = parts[index % 8];
        let side = |axis: u8| f64::from(octant >> axis & 1);
        let begin = bounds.min + DVec3::new(side(0), side(1), side(2)) * bounds.half_extent();
        (octant < 12).then(|| Aabb::new(begin, begin + bounds.half_extent()))
    };
    boxes.iter().enumerate().filter_map(part).collect()
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
    let probe = [-120.0..120.0f64, -2.0..20.0, -120.0..120.0].prop_map(DVec3::from);
    (
        settings(),
        boxes(),
        direction(),
        lens(),
        (eye, direction(), off, any::<bool>()),
        steps,
        (prop::collection::vec(probe, 12), prop::option::of(any::<[u8; 8]>())),
    )
        .prop_map(
            |((mut settings, options), boxes, sun, lens, (eye, look, off, against), steps, (probes, parts))| {
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
                Case { settings, options, views, sun, boxes, seen, probes }
            },
        )
}

/// Points of the boxes' surfaces that the view shows.
fn shown(view: &View, boxes: &[Aabb]) -> Vec<(usize, DVec3)> {
    let lens = view.frustum();
    let mut points = Vec::new();
    for (owner, bounds) in boxes.iter().enumerate() {
        for k in 0..27 {
            let share = DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) / 2.0;
            let inside = bounds.min.clamp(view.eye() - 60.0, view.eye() + 60.0);
            let point = inside + share * (bounds.max.clamp(view.eye() - 60.0, view.eye() + 60.0) - inside);
            let at = view.view_from_world_point(point.clamp(bounds.min, bounds.max));
            let (depth, scale) = (-at.z, lens.scale_at(-at.z));
            if (lens.near..=lens.far).contains(&depth)
                && (lens.left * scale..=lens.right * scale).contains(&at.x)
                && (lens.bottom * scale..=lens.top * scale).contains(&at.y)
            {
                points.push((owner, point.clamp(bounds.min, bounds.max)));
            }
        }
    }
    points
}

/// A sheet less than 2 mm above a receiver may count as touching it: bounds are rounded.
const TOUCHES: f64 = 2e-3;

/// Where the ray from `point` towards the light leaves a box, if it passes through it more than a
/// millimetre away, and the box is no sheet that the point touches.
fn shaded_from(bounds: &Aabb, point: DVec3, direction: DVec3) -> Option<DVec3> {
    let is_flat = |axis: usize| bounds.max[axis] - bounds.min[axis] <= TOUCHES;
    if (0..3).any(|axis| is_flat(axis) && (point[axis] - bounds.min[axis]).abs() <= TOUCHES) {
        return None;
    }
    let (mut enter, mut leave) = (1e-3, f64::INFINITY);
    for axis in 0..3 {
        let (p, d) = (point[axis], -direction[axis]);
        if d.abs() < 1e-13 {
            if p < bounds.min[axis] || p > bounds.max[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((bounds.min[axis] - p) / d, (bounds.max[axis] - p) / d);
        (enter, leave) = (f64::max(enter, a.min(b)), f64::min(leave, a.max(b)));
    }
    (enter <= leave).then_some(point - direction * leave)
}

/// The splits whose maps are asked about a shown point, as the shader chooses them; `None` beyond
/// the range.
fn asked(plan: &ShadowPlan, point: DVec3) -> Option<Vec<usize>> {
    let depth = plan.depth_at(point);
    if depth > plan.planes[plan.splits.len()] {
        return None;
    }
    if plan.selection == Selection::Map {
        let holds = |i: &usize| {
            let split = &plan.splits[*i];
            !split.casters.is_empty() && split.contains(point, split.filter_radius_texels)
        };
        return Some((0..plan.splits.len()).find(holds).into_iter().collect());
    }
    let own = plan.splits.iter().position(|split| depth < split.far).unwrap_or(plan.splits.len() - 1);
    let blends = plan.splits[own].blend_begin <= depth && own + 1 < plan.splits.len();
    Some((own..=own + usize::from(blends)).collect())
}

fn check(case: &Case, view: &View, plan: &ShadowPlan) -> Result<(), TestCaseError> {
    let direction = case.sun.direction();
    prop_assert_eq!(plan.splits.len(), case.settings.splits());
    prop_assert!(plan.planes.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", plan.planes);
    for split in &plan.splits {
        prop_assert!(split.u_axis.is_normalized() && split.v_axis.is_normalized(), "{split:?}");
        prop_assert!(
            split.u_axis.dot(direction).abs() < 1e-10 && split.v_axis.dot(direction).abs() < 1e-10,
            "{split:?}"
        );
        prop_assert!(split.u_axis.cross(split.v_axis).abs_diff_eq(split.depth_axis, 1e-10), "no right-handed frame");
        prop_assert!(split.texel_m.is_finite() && split.texel_m.min_element() > 0.0, "{split:?}");
        prop_assert!(split.min_texel.is_finite() && split.depth_near < split.depth_far, "{split:?}");
        prop_assert!(split.shadow_from_world().is_finite(), "{split:?}");
        if case.settings.is_stabilised() {
            prop_assert_eq!(split.min_texel.fract(), DVec2::ZERO);
        }
    }
    for (owner, point) in shown(view, &case.boxes) {
        // The deepest corner of all lies at the range's very end, on either side of it by rounding.
        let end = plan.planes[plan.splits.len()];
        if (plan.depth_at(point) - end).abs() <= 1e-12 * end {
            continue;
        }
        let is_tiny = case.boxes[owner].half_extent().length() < 0.1 * view.eye().distance(point);
        for (index, bounds) in case.boxes.iter().enumerate() {
            let Some(hit) = shaded_from(bounds, point, direction).filter(|_| index != owner) else { continue };
            // What is too small and too far away to be seen may have no range.
            let Some(splits) = asked(plan, point) else {
                // A range that was given may end before anything.
                if matches!(case.settings.range, Range::Metres { .. }) {
                    continue;
                }
                prop_assert!(is_tiny, "{point} is beyond the range, and {index} shades it: {:?}", plan.planes);
                continue;
            };
            // Maps end with what can be seen, before planes do.
            if splits.is_empty() && is_tiny {
                continue;
            }
            prop_assert!(!splits.is_empty(), "no map holds {point}, which {index} shades");
            for split in splits {
                let map = &plan.splits[split];
                // Planes may reach as far as it does, while maps end with what can be seen.
                if is_tiny && !map.contains(point, map.filter_radius_texels) {
                    continue;
                }
                prop_assert!(
                    plan.casters(split).contains(&(index as u32)),
                    "split {split} lacks {index}, which shades {point}"
                );
                prop_assert!(
                    map.contains(point, map.filter_radius_texels),
                    "{point} lies at {} of split {split}",
                    map.map_from_world(point)
                );
                prop_assert!(plan.casts_into(split, bounds), "caster {index} of split {split} is refused");
                let (along, first) = (direction.dot(point), direction.dot(hit));
                prop_assert!(
                    (map.receiver_depths.0..=map.receiver_depths.1).contains(&along),
                    "{along} of {:?}",
                    map.receiver_depths
                );
                prop_assert!(case.options.depth_clamp || map.depth_near <= first, "near cuts {index} over {point}");
            }
        }
    }
    for &point in &case.probes {
        let Some(split) = plan.covering_split(point) else { continue };
        for (index, bounds) in case.boxes.iter().enumerate() {
            if shaded_from(bounds, point, direction).is_some() {
                let listed = plan.casters(split).contains(&(index as u32));
                prop_assert!(listed, "split {split} answers for {point} without {index}");
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn every_plan_keeps_its_promises(case in any_case()) {
        let mut planner = Planner::with_options(&case.settings, case.options)?;
        for view in &case.views {
            let seen = case.seen.as_deref();
            let inputs = PlanInputs { seen, ..PlanInputs::new(view, case.sun, &case.boxes, &case.boxes) };
            let before = planner.held().clone();
            let plan = match planner.plan_frame(&inputs) {
                Ok(plan) => plan.clone(),
                // A range may have no room for eight planes. Nothing has happened then.
                Err(umbrage::Error::InvalidSetting { .. }) => {
                    prop_assert_eq!(planner.held(), &before);
                    continue;
                }
                Err(other) => return Err(TestCaseError::fail(other.to_string())),
            };
            check(&case, view, &plan)?;
            // A plan is a function of its inputs and of what is held.
            let (mut held, after) = (before, planner.held().clone());
            let again = umbrage::plan(&case.settings, case.options, &inputs, &mut held)?;
            prop_assert!(again == plan && held == after, "another plan by the same inputs");
            if !case.settings.is_stabilised() {
                prop_assert_eq!(&held, &umbrage::Held::default());
            }
        }
    }
}
