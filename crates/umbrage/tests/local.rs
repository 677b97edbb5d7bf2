//! Spot and point lights: no caster lost, every shadowed receiver inside its map, nothing listed
//! that the light cannot show; against brute force, with boxes and slices on both sides of the
//! light's plane.

use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::config::{Choice, Crop, Preset, Range, ShadowConfig, SplitScheme, Stability, Transition};
use umbrage::{
    Aabb, DirectionalLight, Error, FilterReach, Frustum, Light, Planner, PlannerOptions, PointLight, ShadowPlan,
    SpotLight, View, Warp,
};

#[derive(Clone, Debug)]
struct Case {
    settings: ShadowConfig,
    /// Texels that the filter reads from the sample.
    radius_texels: f64,
    view: View,
    light: Light,
    boxes: Vec<Aabb>,
}

fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let size = prop_oneof![5 => 0.1..4.0f64, 1 => Just(0.0), 1 => 10.0..60.0f64];
    let one = (-20.0..20.0f64, -3.0..12.0f64, -20.0..20.0f64, [size.clone(), size.clone(), size])
        .prop_map(|(x, y, z, [w, h, d])| Aabb::new(DVec3::new(x, y, z), DVec3::new(x + w, y + h, z + d)));
    (prop::collection::vec(one, 1..25), any::<bool>()).prop_map(|(mut boxes, ground)| {
        if ground {
            boxes.push(Aabb::new(DVec3::new(-60.0, 0.0, -60.0), DVec3::new(60.0, 0.0, 60.0)));
        }
        boxes
    })
}

fn settings() -> impl Strategy<Value = (ShadowConfig, f64)> {
    let scheme =
        prop_oneof![Just(SplitScheme::Uniform), Just(SplitScheme::Logarithmic), Just(SplitScheme::practical()),];
    let range = prop_oneof![3 => Just(Range::Camera), 1 => Just(Range::Metres { near: 1.0, far: 60.0 })];
    (1usize..=4, scheme, range, any::<[bool; 2]>(), prop_oneof![Just(0.0), 0.0..0.5f64], 0.5..3.0f64).prop_map(
        |(m, scheme, range, [dependent, exact], share, radius_texels)| {
            let config = ShadowConfig {
                map_sizes: vec![256; m],
                scheme,
                range,
                crop: if dependent { Crop::SceneDependent } else { Crop::SceneIndependent },
                stability: if exact { Stability::Exact } else { Stability::tight() },
                transition: Transition::Blend { share },
                ..Preset::Papers.config()
            };
            (config, radius_texels)
        },
    )
}

/// Lights before, beside and behind the eye, at it, on the line of sight; inside boxes and on their
/// faces (grazing), all of it 100 km away now and then.
fn cases() -> impl Strategy<Value = Case> {
    let lens = (0.3..2.2f64, 0.5..2.5f64, any::<bool>()).prop_map(|(fov, aspect, perspective)| {
        if perspective {
            Frustum::perspective(fov, aspect, 0.3, 80.0).expect("valid")
        } else {
            Frustum::orthographic(30.0, 20.0, 0.3, 80.0).expect("valid")
        }
    });
    let eye = (-15.0..15.0f64, 0.5..10.0f64, -15.0..15.0f64);
    let turn = (-3.2..3.2f64, -1.2..0.6f64);
    let beside = prop_oneof![
        3 => (-20.0..20.0f64, -5.0..12.0f64, -30.0..20.0f64),
        1 => (-1.0..1.0f64, -1.0..1.0f64, -2.0..2.0f64),
        1 => Just((0.0, 0.0, -10.0)),
        1 => Just((0.0, 0.0, 8.0)),
        1 => Just((0.0, 0.0, 0.0)),
    ];
    let aim = prop_oneof![
        3 => (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64),
        1 => Just((0.0, -1.0, 0.0)),
        1 => Just((0.0, 0.0, 1.0)),
        1 => Just((1.0, -1e-7, 0.0)),
    ];
    let cone = prop_oneof![3 => 5.0..60.0f64, 1 => 60.0..85.0f64, 1 => Just(0.5f64)];
    let range = prop_oneof![3 => 5.0..50.0f64, 1 => Just(0.5), 1 => Just(500.0)];
    let light = (beside, aim, cone, range, any::<[bool; 2]>());
    (
        settings(),
        boxes(),
        lens,
        eye,
        turn,
        light,
        prop_oneof![3 => Just(DVec3::ZERO), 1 => Just(DVec3::new(1e5, 300.0, -7e4))],
    )
        .prop_map(|((settings, radius_texels), mut boxes, frustum, eye, (yaw, pitch), light, shift)| {
            let (beside, aim, cone, range, [point, grazing]) = light;
            let rotation = DQuat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0);
            let eye = DVec3::from(eye) + shift;
            boxes.iter_mut().for_each(|b| *b = Aabb::new(b.min + shift, b.max + shift));
            let mut position = eye + rotation * DVec3::from(beside);
            if grazing {
                // In the very plane of a box's face.
                position.x = boxes[0].max.x;
            }
            let aim = DVec3::from(aim);
            let aim = if aim.length() > 0.1 { aim } else { DVec3::NEG_Y };
            let light: Light = if point {
                PointLight::new(position, range).expect("valid").into()
            } else {
                SpotLight::new(position, aim, cone.to_radians(), range).expect("valid").into()
            };
            let view = View::look_at(eye, eye + rotation * DVec3::NEG_Z, DVec3::Y, frustum).expect("valid");
            Case { settings, radius_texels, view, light, boxes }
        })
}

/// Points of the boxes' surfaces, and some of the air between, that the view shows and the light
/// reaches: with their view depths.
fn lit_points(case: &Case, plan: &ShadowPlan) -> Vec<(usize, DVec3, f64)> {
    let frustum = case.view.frustum();
    let far = plan.planes.last().copied().expect("a plan has planes").min(frustum.far);
    let near = match case.light {
        Light::Spot(light) => light.near(),
        Light::Point(light) => light.near(),
        Light::Directional(_) => 0.0,
    };
    let mut points = Vec::new();
    for (owner, bounds) in case.boxes.iter().enumerate() {
        for i in 0..7 {
            for j in 0..7 {
                for axis in 0..3 {
                    for side in [bounds.min, bounds.max] {
                        let (s, t) = (f64::from(i) / 6.0, f64::from(j) / 6.0);
                        let mut at = side;
                        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                        at[b] = bounds.min[b] * (1.0 - s) + bounds.max[b] * s;
                        at[c] = bounds.min[c] * (1.0 - t) + bounds.max[c] * t;
                        let in_view = case.view.view_from_world_point(at);
                        let (depth, scale) = (-in_view.z, frustum.scale_at(-in_view.z));
                        let shown = depth >= frustum.near
                            && depth < far
                            && (frustum.left * scale..=frustum.right * scale).contains(&in_view.x)
                            && (frustum.bottom * scale..=frustum.top * scale).contains(&in_view.y);
                        let beyond_near = match case.light {
                            Light::Spot(light) => light.direction().dot(at - light.position()) > near,
                            _ => case.light.position().is_some_and(|p| (at - p).abs().max_element() > near),
                        };
                        if shown && beyond_near && case.light.illuminates(at) {
                            points.push((owner, at, depth));
                        }
                    }
                }
            }
        }
    }
    points
}

/// Where, as shares of the way from the light to `point`, the segment passes through a box, leaving
/// a millimetre before the point.
fn shading(bounds: &Aabb, light: DVec3, point: DVec3) -> Option<(f64, f64)> {
    let way = point - light;
    let (mut enter, mut leave) = (0.0_f64, 1.0 - 1e-3 / way.length());
    for axis in 0..3 {
        if way[axis].abs() < 1e-12 {
            if light[axis] < bounds.min[axis] || light[axis] > bounds.max[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((bounds.min[axis] - light[axis]) / way[axis], (bounds.max[axis] - light[axis]) / way[axis]);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    // A light on the box's own face is touched, not hidden.
    (enter <= leave && leave > 1e-9).then_some((enter, leave))
}

/// The splits that may be asked for a point.
fn splits_of(case: &Case, plan: &ShadowPlan, point: DVec3, depth: f64) -> Vec<usize> {
    let m = case.settings.splits();
    let first = m * case.light.face_of(point);
    let face = &plan.splits[first..first + m];
    let own = face.iter().position(|s| depth < s.far).unwrap_or(m - 1);
    let blended = face[own].blend_begin <= depth && own + 1 < m;
    if blended { vec![first + own, first + own + 1] } else { vec![first + own] }
}

fn planner(case: &Case) -> umbrage::Result<Planner> {
    let reach = FilterReach { radius_texels: case.radius_texels, radius_m: None };
    Planner::with_options(&case.settings, PlannerOptions { filter_reach: Some(reach), ..PlannerOptions::default() })
}

fn planned(case: &Case, planner: &mut Planner) -> Result<ShadowPlan, TestCaseError> {
    match planner.plan(&case.view, &case.light, &case.boxes, &case.boxes) {
        Ok(plan) => Ok(plan.clone()),
        Err(error) => Err(TestCaseError::fail(error.to_string())),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn no_caster_is_lost_and_every_shadowed_receiver_lies_in_its_map(case in cases()) {
        let mut planner = planner(&case)?;
        let plan = planned(&case, &mut planner)?;
        let light = case.light.position().expect("a local light");
        for (owner, point, depth) in lit_points(&case, &plan) {
            for split in splits_of(&case, &plan, point, depth) {
                let s = &plan.splits[split];
                let at = s.map_from_world(point);
                if case.settings.crop == Crop::SceneIndependent && !s.casters.is_empty() {
                    prop_assert!(s.contains(point, case.radius_texels), "{point} at {depth} m lies at {at} in split {split}");
                }
                for (index, bounds) in case.boxes.iter().enumerate() {
                    let Some((enter, leave)) = shading(bounds, light, point).filter(|_| index != owner) else { continue };
                    prop_assert!(plan.casters(split).contains(&(index as u32)), "split {split} lost caster {index}, which shades {point} at {depth} m ({enter} to {leave})");
                    prop_assert!(s.contains(point, case.radius_texels), "{point} at {depth} m lies at {at} in split {split}");
                    // Whatever of the caster lies beyond the light's near distance is stored, at
                    // the place of what it shades and nearer.
                    let caster = light + leave * (point - light);
                    let stored = s.map_from_world(caster);
                    if s.depth_axis.dot(caster - light) > s.depth_near - s.depth_axis.dot(light) {
                        prop_assert!((stored - at).truncate().length() < 1e-4, "{stored} {at}");
                        prop_assert!(stored.z < at.z && stored.z >= 0.0, "caster {index} at {stored}, its receiver at {at}");
                    } else {
                        let near = match case.light {
                            Light::Spot(light) => light.near(),
                            Light::Point(light) => light.near(),
                            Light::Directional(_) => unreachable!("a local light"),
                        };
                        prop_assert!(s.depth_axis.dot(caster - light) < near, "the near plane of split {split} cuts caster {index}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_speck_anywhere_between_the_light_and_what_it_lights_is_listed(case in cases(), shares in prop::collection::vec(0.01..0.999f64, 400)) {
        // Specks put on the very rays: next to the outline of slices and maps, where a wrong plane
        // shows.
        let mut planner = planner(&case)?;
        let plan = planned(&case, &mut planner)?;
        let light = case.light.position().expect("a local light");
        let points = lit_points(&case, &plan);
        let step = points.len().div_ceil(400).max(1);
        let chosen: Vec<_> = points.into_iter().step_by(step).zip(shares).collect();
        let specks: Vec<Aabb> = chosen
            .iter()
            .map(|&((_, point, _), share)| {
                let at = light + share * (point - light);
                Aabb::new(at - 1e-3, at + 1e-3)
            })
            .collect();
        let plan = planner.plan(&case.view, &case.light, &specks, &case.boxes)?.clone();
        for (index, &((_, point, depth), share)) in chosen.iter().enumerate() {
            // A speck may lie below the lowest receiver by its own size, which counts as below all.
            let below = (0..3).any(|axis| (specks[index].center()[axis] - point[axis]).abs() < 2e-3);
            for split in splits_of(&case, &plan, point, depth) {
                let listed = plan.casters(split).contains(&(index as u32));
                prop_assert!(listed || below, "split {split} lost the speck {share} of the way to {point}");
                if listed {
                    prop_assert!(plan.splits[split].contains(point, case.radius_texels));
                }
            }
        }
    }

    #[test]
    fn a_covered_point_has_all_its_casters(case in cases(), points in prop::collection::vec((-20.0..20.0f64, -3.0..15.0f64, -20.0..20.0f64), 60)) {
        let mut planner = planner(&case)?;
        let plan = planned(&case, &mut planner)?;
        let light = case.light.position().expect("a local light");
        for point in points.into_iter().map(|p| DVec3::from(p) + case.view.eye()) {
            let Some(split) = plan.covering_split(point) else { continue };
            for (index, bounds) in case.boxes.iter().enumerate() {
                if shading(bounds, light, point).is_some() {
                    prop_assert!(plan.casters(split).contains(&(index as u32)), "split {split} answers for {point} without caster {index}");
                }
            }
        }
    }

    #[test]
    fn lists_ranges_and_matrices_agree(case in cases()) {
        let mut planner = planner(&case)?;
        let plan = planned(&case, &mut planner)?;
        let (m, light) = (case.settings.splits(), case.light.position().expect("a local light"));
        prop_assert_eq!(plan.splits.len(), m * plan.faces());
        let mut listed = vec![Vec::new(); case.boxes.len()];
        for (i, split) in plan.splits.iter().enumerate() {
            prop_assert!(split.texel_m.min_element() > 0.0 && split.texel_m.is_finite() && split.min_texel.is_finite());
            prop_assert!(split.depth_near < split.depth_far);
            prop_assert!(split.u_axis.cross(split.v_axis).abs_diff_eq(split.depth_axis, 1e-9), "the axes are no right-handed frame");
            if case.settings.stability == Stability::Exact {
                prop_assert_eq!(split.min_texel, split.min_texel.round());
            }
            for &caster in plan.casters(i) {
                listed[caster as usize].push(i);
                let bounds = case.boxes[caster as usize];
                // Not what lies behind the light, nor out of its reach.
                let front = split.depth_axis.dot(bounds.center() - light) + split.depth_axis.abs().dot(bounds.half_extent());
                prop_assert!(front >= 0.0, "caster {caster} of split {i} lies behind the light");
                // A wide cone's map has wide texels, and its margin is some of them.
                let slope = if let Light::Spot(spot) = case.light { spot.outer_angle().tan() } else { 1.0 };
                let nearest = light.clamp(bounds.min, bounds.max).distance(light);
                prop_assert!(nearest <= (1.2 + 0.2 * slope) * case.light.range(), "caster {caster} of split {i} is {nearest} m away");
            }
            // Depths are 0 and 1 at the ends, and w is the depth along the axis.
            let offset = split.depth_axis.dot(light);
            for (depth, z) in [(split.depth_near, 0.0), (split.depth_far, 1.0)] {
                let at = split.map_from_world(light + split.depth_axis * (depth - offset));
                prop_assert!((at.z - z).abs() < 1e-6, "{at} at {depth}");
            }
            prop_assert!(split.map_from_world(light - split.depth_axis).is_nan(), "behind the light there is no place");
        }
        for (caster, splits) in listed.iter().enumerate() {
            let range = splits.first().map(|&first| (first as u8, splits[splits.len() - 1] as u8));
            prop_assert_eq!(plan.split_range[caster], range);
        }
    }

    #[test]
    fn texel_steps_are_the_maps_own(case in cases(), aside in (-0.4..0.4f64, -0.4..0.4f64, 0.05..0.9f64)) {
        let mut planner = planner(&case)?;
        let plan = planned(&case, &mut planner)?;
        let light = case.light.position().expect("a local light");
        for split in &plan.splits {
            let depth = aside.2 * case.light.range();
            let point = light + depth * (split.depth_axis + aside.0 * split.u_axis + aside.1 * split.v_axis);
            let at = split.map_from_world(point);
            let [u, v] = split.texel_axes_m(point);
            // A thousandth of a texel, so that what is left of second order vanishes.
            for (step, across) in [(u, DVec3::X), (v, DVec3::Y)] {
                prop_assert!(step.dot(split.light_direction_at(point)).abs() <= 1e-9 * step.length(), "a step lies across the light");
                let moved = split.map_from_world(point + 1e-3 * step) - at;
                let error = (moved.truncate() - 1e-3 * across.truncate()).length();
                prop_assert!(error < 2e-5 + 1e-11 * at.truncate().length() * light.length(), "{moved} for {across} at {at}");
            }
        }
    }
}

fn room() -> (View, Vec<Aabb>) {
    // Six walls of 20 cm around 8 × 3 × 6 m, a table and a chest.
    let wall = |min: [f64; 3], max: [f64; 3]| Aabb::new(min.into(), max.into());
    let boxes = vec![
        wall([-4.2, -0.2, -3.2], [4.2, 0.0, 3.2]),
        wall([-4.2, 3.0, -3.2], [4.2, 3.2, 3.2]),
        wall([-4.2, 0.0, -3.2], [-4.0, 3.0, 3.2]),
        wall([4.0, 0.0, -3.2], [4.2, 3.0, 3.2]),
        wall([-4.0, 0.0, -3.2], [4.0, 3.0, -3.0]),
        wall([-4.0, 0.0, 3.0], [4.0, 3.0, 3.2]),
        wall([-0.6, 0.7, -1.4], [0.6, 0.75, -0.6]),
        wall([2.0, 0.0, -2.0], [3.0, 0.8, -1.0]),
    ];
    let lens = Frustum::perspective(1.2, 1.3, 0.1, 100.0).expect("valid");
    (View::look_at_upright(DVec3::new(-3.0, 1.7, 2.5), DVec3::new(1.0, 0.8, -1.5), lens).expect("valid"), boxes)
}

#[test]
fn a_lamp_in_a_room_has_the_faces_that_are_seen() {
    let (view, boxes) = room();
    let lamp = PointLight::new(DVec3::new(0.5, 2.4, -0.5), 12.0).expect("valid");
    for stability in [Stability::tight(), Stability::Exact] {
        let settings = ShadowConfig { map_sizes: vec![512], stability, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings).expect("valid");
        let plan = planner.plan(&view, &lamp, &boxes, &boxes).expect("valid");
        assert_eq!(plan.faces(), 6);
        // Down are the table and the chest; nothing stands between the lamp and the ceiling above
        // it.
        assert!(plan.casters(3).contains(&6) && plan.casters(3).contains(&7), "{:?}", plan.casters(3));
        assert!(!plan.casters(2).contains(&6) && !plan.casters(2).contains(&7), "{:?}", plan.casters(2));
        // A lamp's shadows do not fade where the room ends.
        assert_eq!(plan.fade_begin, plan.planes[1]);
        assert!(plan.planes[1] < 20.0, "the room ends long before the camera's far plane: {:?}", plan.planes);
    }
}

#[test]
fn a_light_that_the_view_cannot_see_the_work_of_has_empty_splits() {
    let (view, boxes) = room();
    for (position, range) in [(DVec3::new(0.0, 500.0, 0.0), 20.0), (view.eye() - 50.0 * view.forward(), 30.0)] {
        let plan_of = |light: Light| {
            let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
            planner.plan(&view, &light, &boxes, &boxes).expect("valid").clone()
        };
        let lamp = PointLight::new(position, range).expect("valid");
        let spot = SpotLight::new(position, DVec3::X, 0.5, range).expect("valid");
        for plan in [plan_of(lamp.into()), plan_of(spot.into())] {
            assert!(plan.caster_indices.is_empty(), "{:?}", plan.caster_indices);
            assert!(plan.splits.iter().all(|split| split.warp.is_some_and(|m| m.is_finite())));
        }
    }
}

#[test]
fn boxes_behind_a_spot_light_are_not_listed_and_those_around_it_are() {
    let (view, mut boxes) = room();
    // From behind the chest's wall into the room; the wall at x = 4 contains the light.
    boxes.push(Aabb::new(DVec3::new(5.0, 0.0, -2.0), DVec3::new(6.0, 3.0, 2.0)));
    let behind = boxes.len() as u32 - 1;
    let spot = SpotLight::new(DVec3::new(4.1, 1.5, 0.0), DVec3::NEG_X, 0.7, 15.0).expect("valid");
    let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
    let plan = planner.plan(&view, &spot, &boxes, &boxes).expect("valid");
    let all = &plan.caster_indices;
    assert!(all.contains(&3), "the wall that the light stands in");
    assert!(!all.contains(&behind), "a box behind the light");
}

#[test]
fn a_stabilised_spot_light_keeps_its_texels_while_the_camera_moves() {
    let (view, boxes) = room();
    let spot = SpotLight::new(DVec3::new(0.0, 2.9, 0.0), DVec3::NEG_Y, 1.0, 10.0).expect("valid");
    let settings = ShadowConfig { map_sizes: vec![512; 2], ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("valid");
    let (mut steps, mut last, mut compared) = (0, None::<ShadowPlan>, 0);
    for k in 0..100 {
        let eye = view.eye() + DVec3::new(0.01, 0.0, -0.013) * f64::from(k);
        let moved = View::look_at_upright(eye, DVec3::new(0.3, 0.5, -1.0), *view.frustum()).expect("valid");
        let plan = planner.plan(&moved, &spot, &boxes, &boxes).expect("valid").clone();
        if let Some(last) = &last {
            for (a, b) in last.splits.iter().zip(&plan.splits) {
                let point = DVec3::new(0.4, 0.0, 0.3);
                let (before, after) = (a.map_from_world(point), b.map_from_world(point));
                let by = after - before;
                let whole = (by - by.round()).truncate().abs().max_element() < 1e-6;
                let texel = a.texel_size_m(point) / b.texel_size_m(point);
                if (texel.x - 1.0).abs() < 1e-9 {
                    assert!(whole, "frame {k}: moved by {by} texels");
                    compared += 1;
                } else {
                    steps += 1;
                }
            }
        }
        last = Some(plan);
    }
    assert!(compared > 150 && steps < 40, "{compared} frames stood still, {steps} stepped");
}

#[test]
fn what_is_no_light_is_refused_by_name() {
    let field = |error: Error| match error {
        Error::InvalidLight { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    let (o, down) = (DVec3::ZERO, DVec3::NEG_Y);
    for range in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(PointLight::new(o, range).expect_err("no range")), "range");
        assert_eq!(field(SpotLight::new(o, down, 0.5, range).expect_err("no range")), "range");
    }
    for angle in [0.0, -0.1, 1.55, 3.0, f64::NAN] {
        assert_eq!(field(SpotLight::new(o, down, angle, 5.0).expect_err("no cone")), "outer_angle");
    }
    assert_eq!(field(SpotLight::new(o, DVec3::ZERO, 0.5, 5.0).expect_err("no direction")), "direction");
    assert_eq!(field(PointLight::new(DVec3::new(0.0, f64::NAN, 0.0), 5.0).expect_err("nowhere")), "position");
    let lamp = PointLight::new(o, 5.0).expect("valid");
    for near in [0.0, 5.0, f64::NAN] {
        assert_eq!(field(lamp.with_near(near).expect_err("no distance")), "near");
    }
    assert_eq!(lamp.with_near(0.2).expect("valid").near(), 0.2);

    let (view, boxes) = room();
    let settings =
        ShadowConfig { stability: Stability::Tight { warps: vec![Warp::Lispsm] }, ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("valid");
    let error = planner.plan(&view, &lamp, &boxes, &boxes).expect_err("a warp needs a sun");
    let Error::Conflict(conflict) = error else { panic!("{error}") };
    assert_eq!((conflict.rule.first, conflict.rule.second), (Choice::Warp, Choice::LocalLight));
    let sun = DirectionalLight::new(down).expect("valid");
    assert!(planner.plan(&view, &sun, &boxes, &boxes).is_ok(), "the planner goes on with another light");
}

#[test]
fn faces_are_chosen_by_the_longest_axis() {
    let lamp = Light::from(PointLight::new(DVec3::new(1.0, 2.0, 3.0), 5.0).expect("valid"));
    for (face, axis) in Light::FACE_AXES.into_iter().enumerate() {
        assert_eq!(lamp.face_of(DVec3::new(1.0, 2.0, 3.0) + 2.0 * axis + DVec3::splat(0.3)), face);
    }
    assert_eq!(lamp.to_light(DVec3::new(1.0, 2.0, 8.0)), DVec3::NEG_Z);
    assert!(lamp.illuminates(DVec3::new(1.0, 2.0, 8.0)) && !lamp.illuminates(DVec3::new(1.0, 2.0, 8.1)));
    let spot = Light::from(SpotLight::new(DVec3::ZERO, DVec3::NEG_Y, 0.5, 5.0).expect("valid"));
    assert!(spot.illuminates(DVec3::new(0.5, -1.0, 0.0)) && !spot.illuminates(DVec3::new(0.6, -1.0, 0.0)));
    assert!(!spot.illuminates(DVec3::new(0.0, 1.0, 0.0)), "behind it");
}
