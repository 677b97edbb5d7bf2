//! Any camera, sun and scene, and what every plan of them has to keep. The fuzzers of
//! `umbrage-fuzz` include this file too.

use glam::{DVec2, DVec3};
use proptest::{prop_assert, prop_assert_eq, test_runner::TestCaseError};
use umbrage::config::{Range, Selection, ShadowConfig};
use umbrage::{Aabb, DirectionalLight, PlanInputs, Planner, PlannerOptions, ShadowPlan, View};

/// Frames to plan.
#[derive(Clone, Debug)]
pub struct Case {
    /// Settings of the planner.
    pub settings: ShadowConfig,
    /// Its options.
    pub options: PlannerOptions,
    /// A view for each frame.
    pub views: Vec<View>,
    /// Number of further frames of the last view, in which what is held recovers.
    pub standing: u32,
    /// Metres by which the first box moves in each of these frames.
    pub moves: DVec3,
    /// The light.
    pub sun: DirectionalLight,
    /// Casters and receivers.
    pub boxes: Vec<Aabb>,
    /// What an earlier picture showed: parts of some boxes, or none of them.
    pub seen: Option<Vec<Aabb>>,
    /// Points that are asked about, wherever they lie.
    pub probes: Vec<DVec3>,
}

/// Of each box an eighth, or nothing.
pub fn seen(boxes: &[Aabb], parts: &[u8; 8]) -> Vec<Aabb> {
    let part = |(index, bounds): (usize, &Aabb)| {
        let octant = parts[index % 8];
        let side = |axis: u8| f64::from(octant >> axis & 1);
        let begin = bounds.min + DVec3::new(side(0), side(1), side(2)) * bounds.half_extent();
        (octant < 12).then(|| Aabb::new(begin, begin + bounds.half_extent()))
    };
    boxes.iter().enumerate().filter_map(part).collect()
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

fn check(case: &Case, (view, boxes): (&View, &[Aabb]), plan: &ShadowPlan) -> Result<(), TestCaseError> {
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
    for (owner, point) in shown(view, boxes) {
        // The deepest corner of all lies at the range's very end, on either side of it by rounding.
        let end = plan.planes[plan.splits.len()];
        if (plan.depth_at(point) - end).abs() <= 1e-12 * end {
            continue;
        }
        let is_tiny = boxes[owner].half_extent().length() < 0.1 * view.eye().distance(point);
        for (index, bounds) in boxes.iter().enumerate() {
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
        for (index, bounds) in boxes.iter().enumerate() {
            if shaded_from(bounds, point, direction).is_some() {
                let listed = plan.casters(split).contains(&(index as u32));
                prop_assert!(listed, "split {split} answers for {point} without {index}");
            }
        }
    }
    Ok(())
}

/// Plans the frames of a case and checks each plan.
///
/// # Errors
/// The first promise that is broken.
pub fn keeps_its_promises(case: &Case) -> Result<(), TestCaseError> {
    let mut planner = Planner::with_options(&case.settings, case.options)?;
    let mut boxes = case.boxes.clone();
    let standing = case.views.last().into_iter().cycle().take(case.standing as usize);
    for (frame, view) in case.views.iter().chain(standing).enumerate() {
        if let Some(first) = boxes.first_mut().filter(|_| frame >= case.views.len()) {
            *first = Aabb::new(first.min + case.moves, first.max + case.moves);
        }
        let seen = case.seen.as_deref();
        let inputs = PlanInputs { seen, ..PlanInputs::new(view, case.sun, &boxes, &boxes) };
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
        check(case, (view, &boxes), &plan)?;
        // A plan is a function of its inputs and of what is held.
        let (mut held, after) = (before, planner.held().clone());
        let again = umbrage::plan(&case.settings, case.options, &inputs, &mut held)?;
        prop_assert!(again == plan && held == after, "another plan by the same inputs");
        if !case.settings.is_stabilised() {
            prop_assert_eq!(&held, &umbrage::Held::default());
        }
    }
    Ok(())
}
