//! The planner's promises, against brute force: no caster lost, every receiver inside its map,
//! lists no longer than needed.

mod cases;

use glam::DVec3;
use proptest::prelude::*;
use umbrage::DepthConvention::{MinusOneToOne, ZeroToOne};
use umbrage::config::{
    Crop, Filter, FitTo, Preset, Range, Selection, ShadowConfig, SplitScheme, Stability, Transition,
};
use umbrage::{Aabb, DirectionalLight, Frustum, PlanInputs, Planner, Projection, ShadowPlan, View};

use cases::*;

#[test]
fn parts_beside_and_below_what_a_split_serves_do_not_reach_it() {
    let frustum = Frustum::perspective(1.0, 1.0, 0.5, 100.0).expect("valid");
    let view = View::look_at(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 2.0, -1.0), DVec3::Y, frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::NEG_Y).expect("valid");
    let settings = ShadowConfig {
        map_sizes: vec![512; 2],
        scheme: SplitScheme::Uniform,
        range: Range::Metres { near: 0.5, far: 40.5 },
        ..Preset::Papers.config()
    };
    // A tower block along the view, through both slices, on a flat ground.
    let ground = Aabb::new(DVec3::new(-50.0, 0.0, -50.0), DVec3::new(50.0, 0.0, 50.0));
    let block = Aabb::new(DVec3::new(-0.5, 3.0, -40.0), DVec3::new(0.5, 8.0, -1.0));
    let mut planner = Planner::new(&settings).expect("valid");
    let plan = planner.plan(&view, &light, &[block], &[ground]).expect("valid");
    assert_eq!((plan.casters(0), plan.casters(1)), (&[0][..], &[0][..]));
    let part = |y: f64, z: f64| Aabb::new(DVec3::new(-0.5, y, z), DVec3::new(0.5, y + 1.0, z + 1.0));
    assert!(plan.casts_into(0, &part(3.0, -10.0)) && !plan.casts_into(1, &part(3.0, -10.0)), "before the second slice");
    assert!(plan.casts_into(1, &part(3.0, -36.0)) && !plan.casts_into(0, &part(3.0, -36.0)), "behind the first slice");
    assert!(plan.casts_into(0, &part(500.0, -10.0)), "however high");
    assert!(!plan.casts_into(0, &part(-5.0, -10.0)), "under the ground");
}

#[test]
fn parts_with_no_surface_behind_them_do_not_reach_a_split_that_knows_its_surfaces() {
    let frustum = Frustum::perspective(1.0, 1.0, 0.5, 100.0).expect("valid");
    let view = View::look_at(DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 2.0, -1.0), DVec3::Y, frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.0)).expect("valid");
    let settings =
        ShadowConfig { map_sizes: vec![512], range: Range::Metres { near: 0.5, far: 60.5 }, ..Preset::Papers.config() };
    // Two pillars are one object; between them there is nothing.
    let pillar = |z: f64| Aabb::new(DVec3::new(-1.0, -20.0, z), DVec3::new(1.0, 1.0, z + 2.0));
    let pillars = [pillar(-50.0), pillar(-10.0)];
    let block = Aabb::new(DVec3::new(-4.0, 3.0, -52.0), DVec3::new(4.0, 4.0, -5.0));
    let mut planner = Planner::new(&settings).expect("valid");
    let whole = [pillars[0].union(pillars[1])];
    let inputs = PlanInputs::new(&view, light, std::slice::from_ref(&block), &whole);
    let part = |x: f64, z: f64| Aabb::new(DVec3::new(x, 3.0, z), DVec3::new(x + 0.5, 4.0, z + 0.5));
    let plan = planner.plan_frame(&inputs).expect("valid");
    assert!(plan.casts_into(0, &part(-1.5, -30.0)), "between the pillars, as far as their common box tells");
    let plan = planner.plan_frame(&PlanInputs { receiver_clusters: Some(&pillars), ..inputs }).expect("valid");
    assert!(!plan.casts_into(0, &part(-1.5, -30.0)), "between the pillars");
    assert!(plan.casts_into(0, &part(-1.5, -9.0)) && plan.casts_into(0, &part(-1.5, -49.0)), "over a pillar");
    assert!(plan.casts_into(0, &part(-3.5, -9.0)), "beside it, where the sun stands");
    assert!(!plan.casts_into(0, &part(3.5, -9.0)), "beside it, on the far side");
    let bad = PlanInputs { receiver_clusters: Some(&[Aabb::EMPTY]), ..inputs };
    let error = planner.plan_frame(&bad).expect_err("no box");
    assert!(matches!(error, umbrage::Error::InvalidBounds { list: "receiver_clusters", index: 0, .. }), "{error}");
    let plan = planner.plan_frame(&inputs).expect("valid");
    assert!(plan.casts_into(0, &part(-1.5, -30.0)), "a new plan knows no clusters yet");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_caster_is_lost_and_every_shadowed_receiver_lies_in_its_map(case in cases(), [by_distance, tells_parts] in any::<[bool; 2]>()) {
        let case = if by_distance { radial(case.clone()).unwrap_or(case) } else { case };
        let mut planner = Planner::with_options(&case.settings, case.options)?;
        let receiver_clusters = tells_parts.then_some(&case.boxes[..]);
        let inputs = PlanInputs::new(&case.view, case.light, &case.boxes, &case.boxes);
        let plan = match planner.plan_frame(&PlanInputs { receiver_clusters, ..inputs }) {
            Ok(plan) => plan.clone(),
            // A short range before an endless one may leave no room for eight planes; that is an
            // answer too.
            Err(umbrage::Error::InvalidSetting { .. }) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        let direction = case.light.direction();
        for (owner, point, _) in visible_points(&case, plan.planes[plan.splits.len()]) {
            let depth = plan.depth_at(point);
            if depth > plan.planes[plan.splits.len()] {
                continue;
            }
            for split in splits_of(&plan, depth) {
                let s = &plan.splits[split];
                if let Some(warp) = s.warp {
                    prop_assert!((warp * point.extend(1.0)).w > 0.0, "{point} at {depth} m lies behind the warp of split {split}");
                    let inside = case.settings.crop == Crop::SceneDependent || s.contains(point, s.filter_radius_texels);
                    prop_assert!(inside, "{point} at {depth} m lies at {} in split {split}", s.map_from_world(point));
                }
                for (index, bounds) in case.boxes.iter().enumerate() {
                    // A box does not count as shading its own skin, nor does a touching one: what
                    // lies less than a millimetre under the point is the point's own surface.
                    let Some(end) = shading_end(bounds, point, direction).filter(|_| index != owner) else { continue };
                    prop_assert!(plan.casters(split).contains(&(index as u32)), "split {split} lost caster {index}, which shades {point} at {depth} m");
                    let (at, reach) = (point - direction * end, 0.02 * (bounds.max - bounds.min));
                    let part = Aabb::new((at - reach).max(bounds.min), (at + reach).min(bounds.max));
                    prop_assert!(!part.is_valid() || plan.casts_into(split, &part), "split {split} leaves out {part:?} of caster {index}, which shades {point}");
                    prop_assert!(s.contains(point, s.filter_radius_texels), "{point} at {depth} m lies at {} in split {split}", s.map_from_world(point));
                    let along = s.depth_axis.dot(point);
                    prop_assert!((s.receiver_depths.0..=s.receiver_depths.1).contains(&along), "{point} at {along} m along the light, outside {:?}", s.receiver_depths);
                    let caster_begin = direction.dot(point - direction * end);
                    prop_assert!(case.options.depth_clamp || s.depth_near <= caster_begin, "the near plane cuts caster {index}");
                    if s.warp.is_some() {
                        let (at, caster) = (s.map_from_world(point), s.map_from_world(point - direction * end));
                        prop_assert!((at - caster).truncate().length() < 1e-3, "split {split} shows {point} at {at}, caster {index} at {caster}");
                        prop_assert!((0.0..at.z).contains(&caster.z), "caster {index} lies at {caster}, the point that it shades at {at}");
                    }
                }
            }
        }
    }

    #[test]
    fn lists_ranges_and_matrices_agree(case in cases()) {
        let mut planner = Planner::with_options(&case.settings, case.options)?;
        let Ok(plan) = planner.plan(&case.view, &case.light, &case.boxes, &case.boxes) else { return Ok(()) };
        let plan = plan.clone();
        prop_assert_eq!(plan.splits.len(), case.settings.splits());
        let mut listed = vec![Vec::new(); case.boxes.len()];
        for (i, split) in plan.splits.iter().enumerate() {
            prop_assert!(split.near < split.far && split.texel_m.min_element() > 0.0 && split.texel_m.is_finite());
            prop_assert!(split.depth_near < split.depth_far && split.min_texel.is_finite());
            // A kernel of known width has its room, and no map gives away more.
            let reach = case.options.filter_reach.expect("a reach");
            let most = reach.radius_texels;
            let asked = reach.radius_m.map_or(most, |m| m / split.texel_m.min_element() + 1.0);
            let reach = if split.warp.is_some() { most } else { asked.max(4.0).min(most) };
            prop_assert!((split.filter_radius_texels - reach).abs() < 1e-6 * reach || split.warp.is_none() && split.filter_radius_texels == most, "{} for {asked}", split.filter_radius_texels);
            prop_assert!(split.u_axis.cross(split.v_axis).abs_diff_eq(split.depth_axis, 1e-9), "the axes are no right-handed frame");
            for &caster in plan.casters(i) {
                listed[caster as usize].push(i);
                prop_assert!(plan.casts_into(i, &case.boxes[caster as usize]), "caster {caster} is in the list of split {i}");
            }
            // The matrix says what the texels say.
            let point = case.view.eye() + DVec3::new(3.0, -2.0, 5.0);
            let (at, ndc) = (split.map_from_world(point), split.shadow_from_world().project_point3(point));
            let size = f64::from(split.size);
            if at.is_nan() {
                prop_assert!(split.warp.is_some_and(|warp| (warp * point.extend(1.0)).w <= 0.0), "{split:?}");
                continue;
            }
            prop_assert!((ndc.x - (2.0 * at.x / size - 1.0)).abs() < 1e-9 * (1.0 + ndc.x.abs()));
            prop_assert!((ndc.y - (1.0 - 2.0 * at.y / size)).abs() < 1e-9 * (1.0 + ndc.y.abs()));
            prop_assert!((ndc.z - at.z).abs() < 1e-9 * (1.0 + ndc.z.abs()));
            // What an engine of either kind makes of its matrix is what it looks up: OpenGL's
            // viewport and depth range turn NDC into coordinates by (1 + ndc)/2 in all three, the
            // others' turn y and leave z.
            for (convention, [flip, depth]) in [(ZeroToOne, [-1.0, 0.0]), (MinusOneToOne, [1.0, 0.5])] {
                let ndc = split.shadow_from_world_in(convention).project_point3(point);
                let drawn = DVec3::new(0.5 + 0.5 * ndc.x, 0.5 + 0.5 * flip * ndc.y, depth + (1.0 - depth) * ndc.z);
                let asked = split.texture_from_world(convention).project_point3(point);
                prop_assert!((drawn - asked).abs().max_element() < 1e-9 * (1.0 + asked.abs().max_element()), "{drawn} {asked}");
                let v = if flip < 0.0 { at.y } else { size - at.y };
                prop_assert!((asked * size - DVec3::new(at.x, v, at.z * size)).abs().max_element() < 1e-9 * size * (1.0 + asked.abs().max_element()));
            }
        }
        for (caster, splits) in listed.iter().enumerate() {
            let range = splits.first().map(|&first| (first as u8, splits[splits.len() - 1] as u8));
            prop_assert_eq!(plan.split_range[caster], range);
        }
    }

    #[test]
    fn the_first_map_that_contains_a_point_has_all_its_casters(case in cases()) {
        let stability = match &case.settings.stability {
            Stability::Tight { .. } => Stability::tight(),
            still => still.clone(),
        };
        let settings = ShadowConfig { selection: Selection::Map, stability, ..case.settings.clone() };
        let mut planner = Planner::with_options(&settings, case.options)?;
        let Ok(plan) = planner.plan(&case.view, &case.light, &case.boxes, &case.boxes) else { return Ok(()) };
        let plan = plan.clone();
        let direction = case.light.direction();
        for (owner, point, depth) in visible_points(&case, plan.planes[plan.splits.len()]) {
            let holders: Vec<usize> = (0..plan.splits.len())
                .filter(|&i| !plan.splits[i].casters.is_empty() && plan.splits[i].contains(point, plan.splits[i].filter_radius_texels))
                .collect();
            // Along a map's edge the next one is asked too.
            let in_band = holders.first().is_some_and(|&first| {
                let band = 0.5 * plan.blend * f64::from(plan.splits[first].size);
                !plan.splits[first].contains(point, plan.splits[first].filter_radius_texels + band)
            });
            let asked = if in_band { 2 } else { 1 };
            for (index, bounds) in case.boxes.iter().enumerate() {
                let Some(end) = shading_end(bounds, point, direction).filter(|_| index != owner) else { continue };
                prop_assert!(!holders.is_empty(), "no map contains {point} at {depth} m, which {index} shades");
                for &split in holders.iter().take(asked) {
                    let s = &plan.splits[split];
                    prop_assert!(plan.casters(split).contains(&(index as u32)), "split {split} of {holders:?} has no caster {index} for {point}");
                    let begin = direction.dot(point - direction * end);
                    prop_assert!(case.options.depth_clamp || s.depth_near <= begin, "the near plane cuts caster {index}");
                    prop_assert!(s.depth_near <= direction.dot(point), "the near plane lies behind {point}");
                }
            }
        }
    }

    #[test]
    fn a_range_fitted_to_what_is_visible_holds_all_of_it_that_is_shaded(case in cases()) {
        let settings = ShadowConfig { range: Range::Visible, ..case.settings.clone() };
        let mut planner = Planner::with_options(&settings, case.options)?;
        let Ok(plan) = planner.plan(&case.view, &case.light, &case.boxes, &case.boxes) else { return Ok(()) };
        let (first, last) = (plan.planes[0], plan.planes[plan.splits.len()]);
        let frustum = case.view.frustum();
        prop_assert!(frustum.near * (1.0 - 0.01) <= first && last <= frustum.far, "{first}..{last}");
        // A range much longer than where it begins ends with the shadows, and one without any at
        // once.
        let is_shaded = |owner: usize, point: DVec3| {
            let mut others = case.boxes.iter().enumerate().filter(|&(i, _)| i != owner);
            others.any(|(_, bounds)| shades(bounds, point, case.light.direction()))
        };
        let points: Vec<_> = visible_points(&case, f64::INFINITY).into_iter().collect();
        let has_shadows = points.iter().any(|&(owner, point, _)| is_shaded(owner, point));
        for (owner, point, depth) in points {
            let ends = !has_shadows || last > 100.0 * first && !is_shaded(owner, point);
            // The deepest corner of all lies at the range's very end, on either side of it by
            // rounding.
            let is_end = (depth - last).abs() <= 1e-12 * last;
            let is_held = (first..=last).contains(&depth) || is_end || depth > last && ends;
            prop_assert!(is_held, "{first}..{last} leaves out {point} at {depth}");
        }
    }

    #[test]
    fn a_covered_point_has_all_its_casters(case in cases(), points in prop::collection::vec((-300.0..300.0f64, -5.0..40.0f64, -300.0..300.0f64), 50)) {
        let mut planner = Planner::with_options(&case.settings, case.options)?;
        let Ok(plan) = planner.plan(&case.view, &case.light, &case.boxes, &case.boxes) else { return Ok(()) };
        let plan = plan.clone();
        for point in points.into_iter().map(DVec3::from) {
            let Some(split) = plan.covering_split(point) else { continue };
            for (index, bounds) in case.boxes.iter().enumerate() {
                if shades(bounds, point, case.light.direction()) {
                    prop_assert!(plan.casters(split).contains(&(index as u32)), "split {split} answers for {point} without caster {index}");
                }
            }
        }
    }
}

fn robots(count: usize) -> Vec<Aabb> {
    // A regular scatter that no test tunes: the golden ratio's sequence over the plane.
    (0..count)
        .map(|i| {
            let (x, z) = ((i as f64 * 0.754_877_666_2).fract(), (i as f64 * 0.569_840_290_998).fract());
            let at = DVec3::new(1200.0 * x - 600.0, 0.0, 1200.0 * z - 600.0);
            Aabb::new(at + DVec3::new(-3.0, 0.0, -3.0), at + DVec3::new(3.0, 10.0, 3.0))
        })
        .collect()
}

#[test]
fn lists_are_short_and_a_flat_ground_throws_no_shadow() {
    let mut world = robots(160);
    world.push(Aabb::new(DVec3::new(-600.0, 0.0, -600.0), DVec3::new(600.0, 0.0, 600.0)));
    let settings = ShadowConfig {
        map_sizes: vec![512; 4],
        range: Range::Metres { near: 1.0, far: 800.0 },
        transition: Transition::Hard,
        far_fade: 0.0,
        filter: Filter::Hard,
        ..Preset::Papers.config()
    };
    let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 1.0, 800.0).expect("valid");
    let light = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("valid");
    for stability in [Stability::tight(), Stability::Exact] {
        let mut planner = Planner::new(&ShadowConfig { stability, ..settings.clone() }).expect("valid");
        for eye in [DVec3::new(0.0, 15.0, 0.0), DVec3::new(550.0, 30.0, 500.0), DVec3::new(-300.0, 3.0, 300.0)] {
            let view = View::look_at_upright(eye, DVec3::new(0.1, 5.0, -0.2), frustum).expect("valid");
            let plan = planner.plan(&view, &light, &world, &world).expect("valid");
            assert!(plan.caster_indices.len() <= 200, "{} caster-split pairs from {eye}", plan.caster_indices.len());
            assert!(!plan.caster_indices.contains(&160), "the ground is listed as a caster");
        }
    }
}

#[test]
fn a_dependent_fit_is_never_larger() {
    let mut world = robots(160);
    world.push(Aabb::new(DVec3::new(-600.0, 0.0, -600.0), DVec3::new(600.0, 0.0, 600.0)));
    let frustum = Frustum::perspective(1.0, 1.5, 1.0, 800.0).expect("valid");
    let light = DirectionalLight::new(DVec3::new(-0.6, -1.0, 0.4)).expect("valid");
    let view = View::look_at_upright(DVec3::new(100.0, 20.0, 300.0), DVec3::ZERO, frustum).expect("valid");
    let areas = |crop| {
        let settings = ShadowConfig { crop, stability: Stability::tight(), ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings).expect("valid");
        let plan = planner.plan(&view, &light, &world, &world).expect("valid");
        plan.splits.iter().map(|s| s.texel_m.x * s.texel_m.y).collect::<Vec<_>>()
    };
    for (dependent, independent) in areas(Crop::SceneDependent).iter().zip(areas(Crop::SceneIndependent)) {
        assert!(*dependent <= independent * (1.0 + 1e-9), "{dependent} > {independent}");
    }
}

#[test]
fn a_visible_range_is_as_tight_as_the_boxes_and_steps_where_maps_stand_still() {
    let frustum = Frustum::perspective(1.0, 1.5, 0.1, 1000.0).expect("valid");
    let view =
        |z: f64| View::look_at_upright(DVec3::new(0.0, 1.0, z), DVec3::new(0.0, 1.0, z - 1.0), frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.1)).expect("valid");
    // One at 20 to 22 m, one at 60 to 64 m, one beside and one behind the view.
    let boxed = |x: f64, from: f64, to: f64| Aabb::new(DVec3::new(x, 0.0, -to), DVec3::new(x + 2.0, 2.0, -from));
    let world = [boxed(0.0, 20.0, 22.0), boxed(-1.0, 60.0, 64.0), boxed(40.0, 5.0, 9.0), boxed(0.0, -30.0, -8.0)];
    let settings = ShadowConfig { range: Range::Visible, stability: Stability::tight(), ..Preset::Papers.config() };
    let mut tight = Planner::new(&settings).expect("valid");
    let ends = |plan: &ShadowPlan| (plan.planes[0], plan.planes[4]);
    let (first, last) = ends(tight.plan(&view(0.0), &light, &world, &world).expect("valid"));
    assert!((19.99..20.0).contains(&first) && (64.0..64.02).contains(&last), "{first}..{last}");

    let mut still = Planner::new(&ShadowConfig { stability: Stability::Exact, ..settings.clone() }).expect("valid");
    let mut ranges: Vec<(f64, f64)> = (0..100)
        .map(|i| ends(still.plan(&view(-0.05 * f64::from(i)), &light, &world, &world).expect("valid")))
        .collect();
    ranges.dedup();
    assert!(ranges.len() <= 3, "five metres of walking move the range in steps: {ranges:?}");

    let both = [("shadow-range", "1..50"), ("range-fit", "visible")].map(|(key, value)| (key.into(), value.into()));
    let message = Preset::Papers.config().apply(&both).expect_err("two ranges").to_string();
    assert!(message.contains("shadow-range and range-fit"), "{message}");
    let nothing = tight.plan(&view(-500.0), &light, &world, &world).expect("an empty view");
    assert!(nothing.planes[4] > nothing.planes[0]);
}

#[test]
fn a_range_without_end_stops_at_the_scene() {
    let frustum = Frustum::perspective(1.0, 1.5, 0.1, f64::INFINITY).expect("valid");
    assert_eq!(frustum.projection, Projection::Perspective);
    let view = View::look_at_upright(DVec3::Y, DVec3::new(0.0, 1.0, -1.0), frustum).expect("valid");
    let light = DirectionalLight::new(DVec3::NEG_Y).expect("valid");
    let world = [Aabb::new(DVec3::new(-5.0, 0.0, -70.0), DVec3::new(5.0, 1.0, 10.0))];
    let planes_of = |stability| {
        let mut planner = Planner::new(&ShadowConfig { stability, ..Preset::Papers.config() }).expect("valid");
        planner.plan(&view, &light, &world, &world).expect("valid").planes.clone()
    };
    let tight = planes_of(Stability::tight());
    assert_eq!(tight[0], 0.1);
    assert!((tight[4] - 70.0).abs() < 1e-9, "{tight:?}");
    // The inner planes are the same; the last one lies where turning and some walking do not move
    // it: the farthest corner, 70.4 m away, and half a step more.
    let still = planes_of(Stability::Exact);
    assert_eq!(still[..4], tight[..4]);
    assert!((still[4] / (70.0f64.powi(2) + 26.0).sqrt() - 2f64.powf(1.0 / 16.0)).abs() < 1e-9, "{still:?}");
}

#[test]
fn what_was_seen_counts_for_maps_that_are_fitted_to_it_alone() {
    let boxes = robots(2000);
    let seen: Vec<Aabb> = boxes.iter().step_by(3).map(|it| Aabb::new(it.min, 0.5 * (it.min + it.max))).collect();
    let lens = Frustum::perspective(1.0, 4.0 / 3.0, 0.1, 500.0).unwrap();
    let view = View::look_at_upright(DVec3::new(-5.0, 2.0, -8.0), DVec3::new(20.0, 0.0, 30.0), lens).unwrap();
    let sun = DirectionalLight::new(DVec3::new(0.3, -0.6, 0.5)).unwrap();
    let plan = |fit_to, seen| {
        let config = ShadowConfig { fit_to, ..ShadowConfig::default() };
        let inputs = PlanInputs { seen, ..PlanInputs::new(&view, sun, &boxes, &boxes) };
        Planner::new(&config).unwrap().plan_frame(&inputs).unwrap().clone()
    };
    assert!(plan(FitTo::Boxes, Some(&seen)) == plan(FitTo::Boxes, None));
    assert!(plan(FitTo::Depth, Some(&seen)) != plan(FitTo::Depth, None));
    // Maps that stand exactly still show whole slices, so they cannot be asked to be fitted to it.
    let still = ShadowConfig { fit_to: FitTo::Depth, ..Preset::Still.config() };
    let told = Planner::new(&still).unwrap_err().to_string();
    assert!(told.contains("fit-to depth") && told.contains("stabilize exact"), "{told}");
}

/// A flat box that the sun runs along, before an eye that looks into the sun: no slice has a cost.
#[test]
fn optimal_planes_rise_where_nothing_tells_them_apart() {
    let boxes = [Aabb::new(
        DVec3::new(11.090_098_818_047_199, 3.826_762_684_421_987, -14.797_194_115_257_29),
        DVec3::new(37.152_999_571_978_1, 77.800_685_747_368_69, -14.797_194_115_257_29),
    )];
    let mut lens = Frustum::perspective(1.0, 1.0, 0.01, f64::INFINITY).unwrap();
    (lens.left, lens.right) = (-0.952_232_912_830_234_1, 0.952_232_912_830_234_1);
    (lens.bottom, lens.top) = (-0.406_651_069_227_589_65, 0.406_651_069_227_589_65);
    let eye = DVec3::new(-10.696_849_041_235_982, 22.660_893_468_366_33, 0.0);
    let view = View::look_at(eye, eye + DVec3::Y, DVec3::X, lens).unwrap();
    let config = ShadowConfig {
        map_sizes: vec![256; 4],
        scheme: SplitScheme::Optimal,
        range: Range::Visible,
        transition: Transition::Blend { share: 0.0 },
        crop: Crop::SceneIndependent,
        stability: Stability::tight(),
        ..Preset::Papers.config()
    };
    let options = umbrage::PlannerOptions {
        filter_reach: Some(umbrage::FilterReach { radius_texels: 0.5, radius_m: None }),
        ..Default::default()
    };
    let mut planner = Planner::with_options(&config, options).unwrap();
    let sun = DirectionalLight::new(DVec3::NEG_Y).unwrap();
    let plan = planner.plan(&view, &sun, &boxes, &boxes).unwrap();
    assert!(plan.planes.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", plan.planes);
}
