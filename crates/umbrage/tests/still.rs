//! Stillness: spheres that hold every slice, and maps that move in whole texels only.

use glam::{DQuat, DVec2, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::config::{Crop, ExtentSteps, Preset, Range, Stability};
use umbrage::{
    Aabb, DirectionalLight, Frustum, Planner, Projection, ShadowConfig, ShadowPlan, Split, View, slice_sphere,
};

proptest! {
    #[test]
    fn the_sphere_holds_the_slice_and_no_smaller_one_does(
        l in 0.05..3.0f64, r in 0.05..3.0f64, b in 0.05..3.0f64, t in 0.05..3.0f64, symmetric in any::<bool>(),
        perspective in any::<bool>(), near in 0.01..10.0f64, ratio in prop_oneof![1.0001..1.01f64, 1.01..1000.0f64],
    ) {
        let (l, b) = if symmetric { (r, t) } else { (l, b) };
        let projection = if perspective { Projection::Perspective } else { Projection::Orthographic };
        let frustum = Frustum { projection, left: -l, right: r, bottom: -b, top: t, near, far: near * ratio };
        let sphere = slice_sphere(&frustum, near, near * ratio);
        let corners: Vec<DVec3> = frustum.corners_at(near).into_iter().chain(frustum.corners_at(near * ratio)).collect();
        let reach = |center: DVec3| corners.iter().map(|c| c.distance(center)).fold(0.0, f64::max);
        prop_assert!(reach(sphere.center) <= sphere.radius * (1.0 + 1e-9));
        // The least radius is where no step improves it: the radius about a centre is convex, so
        // local is global.
        for step in [1e-2, 1e-4] {
            for axis in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
                prop_assert!(reach(sphere.center + axis * step * sphere.radius) >= sphere.radius * (1.0 - 1e-9));
            }
        }
    }

    /// Any two poses, 0, 10 and 100 km from the world's origin, with any rotation.
    #[test]
    fn maps_move_in_whole_texels(
        place in place(), eye in prop::array::uniform3(-50.0..50.0f64), turns in prop::array::uniform2(prop::array::uniform3(-3.0..3.0f64)),
        step in prop::array::uniform3(-2.0..2.0f64), sun in sun(), crop in crop(),
    ) {
        let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, crop, stability: Stability::Exact, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings)?;
        let world = [Aabb::new(place - 400.0, place + 400.0)];
        let eye = place + DVec3::from(eye);
        let first = planner.plan(&turned_view(eye, turns[0])?, &sun, &world, &world)?.clone();
        let second = planner.plan(&turned_view(eye + DVec3::from(step), turns[1])?, &sun, &world, &world)?;
        for (a, b) in first.splits.iter().zip(&second.splits) {
            let shift = b.texels_moved_since(a);
            prop_assert!(shift.is_some(), "{a:?} {b:?}");
            prop_assert_eq!((a.min_texel.fract(), b.min_texel.fract()), (DVec2::ZERO, DVec2::ZERO));
            // The matrices say the same: one linear part, apart by whole texels.
            let (a, b) = (a.shadow_from_world(), b.shadow_from_world());
            prop_assert_eq!([a.x_axis, a.y_axis, a.z_axis], [b.x_axis, b.y_axis, b.z_axis]);
        }
    }

    /// The approximate kind likewise has no other places than whole texels of a grid that is the
    /// light's and the step's alone.
    #[test]
    fn approximate_maps_move_in_whole_texels_and_seldom_take_a_step(
        place in place(), eye in prop::array::uniform3(-50.0..50.0f64), turn in prop::array::uniform3(-3.0..3.0f64),
        walk in prop::array::uniform3(-0.2..0.2f64), sun in sun(), crop in crop(),
        steps in prop_oneof![Just(ExtentSteps::default()), (4u32..64).prop_map(ExtentSteps::PerDoubling), Just(ExtentSteps::Levels(64))],
    ) {
        let stability = Stability::Approximate { steps };
        let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, crop, stability, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings)?;
        let world = [Aabb::new(place - 400.0, place + 400.0)];
        let mut before: Option<ShadowPlan> = None;
        for k in 0..30 {
            let eye = place + DVec3::from(eye) + f64::from(k) * DVec3::from(walk);
            let plan = planner.plan(&turned_view(eye, turn)?, &sun, &world, &world)?;
            for (i, split) in plan.splits.iter().enumerate() {
                prop_assert_eq!(split.min_texel.fract(), DVec2::ZERO);
                if let Some(before) = &before
                    && crop == Crop::SceneIndependent
                {
                    // What a slice measures does not change while the eye walks, so no step is
                    // taken at all.
                    prop_assert!(split.texels_moved_since(&before.splits[i]).is_some(), "frame {k}, split {i}");
                }
            }
            before = Some(plan.clone());
        }
    }

    /// Between the tightest map and 2^(2/24) of it, always inside the exact one's.
    #[test]
    fn approximate_maps_are_nearly_tight(
        place in place(), turns in prop::collection::vec(prop::array::uniform3(-3.0..3.0f64), 1..6), sun in sun(), crop in crop(),
    ) {
        let of = |stability| {
            let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, crop, stability, ..Preset::Papers.config() };
            Planner::new(&settings)
        };
        let (mut held, mut exact) = (of(Stability::Approximate { steps: ExtentSteps::default() })?, of(Stability::Exact)?);
        let world = [Aabb::new(place - 400.0, place + 400.0)];
        for turn in turns {
            let view = turned_view(place, turn)?;
            let plan = held.plan(&view, &sun, &world, &world)?;
            // The tightest map turns with the view, so its rectangle can be smaller by what 2.8
            // degrees are worth.
            let mut tight = of(Stability::tight())?;
            let tight = tight.plan(&view, &sun, &world, &world)?;
            let sphere = exact.plan(&view, &sun, &world, &world)?;
            for ((a, t), s) in plan.splits.iter().zip(&tight.splits).zip(&sphere.splits) {
                let area = |split: &Split| split.texel_m.x * split.texel_m.y;
                prop_assert!(area(a) >= 0.9 * area(t), "{} below {}", area(a), area(t));
                prop_assert!(area(a) <= 2f64.powf(4.0 / 24.0) * 1.1 * area(t), "{} above {}", area(a), area(t));
                prop_assert!(area(a) <= area(s), "{} above the sphere's {}", area(a), area(s));
            }
        }
    }

    /// Zooming, turning and walking back and forth by less than a step settles: what comes round
    /// again changes nothing any more.
    #[test]
    fn back_and_forth_settles(
        place in place(), first in 0.3..1.2f64, base in 0.3..1.2f64, pose in prop::array::uniform3(-3.0..3.0f64),
        waves in prop::collection::vec([0.0..1.0f64, -1.0..1.0, -1.0..1.0], 2..12), sun in sun(),
        (stability, step) in prop_oneof![
            Just((Stability::Exact, 1.0)),
            Just((Stability::Approximate { steps: ExtentSteps::PerDoubling(8) }, 1.0)),
            Just((Stability::Approximate { steps: ExtentSteps::default() }, 8.0 / 24.0)),
        ],
    ) {
        let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, crop: Crop::SceneIndependent, stability, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings)?;
        let world = [Aabb::new(place - 400.0, place + 400.0)];
        let mut splits = |fov: f64, turn: f64, walk: f64| -> Result<Vec<Split>, TestCaseError> {
            let lens = Frustum::perspective(fov, 1.5, 0.1, 1000.0)?;
            let eye = place + DVec3::X * walk;
            let view = turned_view(eye, [pose[0] + turn, pose[1], pose[2]])?.with_frustum(lens)?;
            Ok(planner.plan(&view, &sun, &world, &world)?.splits.clone())
        };
        let mut before = splits(first, 0.0, 0.0)?;
        for round in 0..4 {
            for [zoom, turn, walk] in &waves {
                // Half a degree and 2 % of the angle of view are worth less than a step of 9 %.
                let now = splits(base * (1.0 + 0.02 * step * zoom), 0.009 * step * turn, 3.0 * walk)?;
                for (i, (a, b)) in before.iter().zip(&now).enumerate() {
                    prop_assert!(round < 2 || b.texels_moved_since(a).is_some(), "round {round}, split {i}");
                }
                before = now;
            }
        }
    }

    /// A long zoom takes one change for each step of 19 % between the narrowest and the widest
    /// lens, and the map always holds the slice.
    #[test]
    fn a_long_zoom_changes_the_texel_in_steps(place in place(), from in 0.3..1.2f64, to in 0.3..1.2f64) {
        let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, stability: Stability::Exact, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings)?;
        let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
        let (mut changes, mut held) = (0, None);
        for k in 0..120 {
            let fov = from + (to - from) * f64::from(k) / 119.0;
            let view = View::look_at_upright(place, place + DVec3::NEG_Z, Frustum::perspective(fov, 1.5, 0.1, 1000.0)?)?;
            let texel = planner.plan(&view, &sun, &[], &[])?.splits[3].texel_m.x;
            let tight = Planner::new(&settings)?.plan(&view, &sun, &[], &[])?.splits[3].texel_m.x;
            prop_assert!(texel >= tight * (1.0 - 1e-12), "the map no longer holds the slice");
            prop_assert!(texel <= tight * 2f64.powf(2.0 / 4.0) * (1.0 + 1e-9), "{texel} is much larger than {tight}");
            changes += i32::from(held.is_some_and(|held| held != texel));
            held = Some(texel);
        }
        let steps = (((0.5 * to).tan() / (0.5 * from).tan()).log2().abs() * 4.0).ceil();
        prop_assert!(f64::from(changes) <= steps + 1.0, "{changes} changes over {steps} steps");
    }

    /// The far end of the range is the scene's; for exactly stabilised maps it is held in steps,
    /// too, while the eye walks to and fro.
    #[test]
    fn the_range_is_held(
        place in place(), yaw in -3.0..3.0f64, walks in prop::collection::vec(0.0..1.0f64, 4..40), approximate in any::<bool>(),
    ) {
        let stability = if approximate { Stability::Approximate { steps: ExtentSteps::default() } } else { Stability::Exact };
        let mut planner = Planner::new(&ShadowConfig { stability, ..Preset::Papers.config() })?;
        let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
        let world = [Aabb::new(place - DVec3::new(200.0, 1.0, 200.0), place + DVec3::new(200.0, 9.0, 200.0))];
        let (mut far, mut changes) = (0.0, -1);
        for walk in walks {
            // 10 m of 200 m or more: less than a step.
            let view = turned_view(place + DQuat::from_rotation_y(yaw) * DVec3::Z * (10.0 * walk - 5.0), [yaw, -0.1, 0.0])?;
            let plan = planner.plan(&view, &sun, &world, &world)?;
            // Turning an exactly stabilised camera changes little, so its range may end with the
            // farthest point in any direction.
            let far_end = plan.planes[4] / (1.0 - 1e-9);
            let greatest = |end: &dyn Fn(DVec3) -> f64| world[0].corners().map(end).into_iter().fold(0.0, f64::max);
            let deepest = greatest(&|corner| view.view_depth(corner));
            let most = if approximate { deepest } else { greatest(&|corner| view.eye().distance(corner)) };
            prop_assert!(far_end >= deepest, "{far_end} m for a scene of {deepest} m");
            let room = if approximate { 1.0 + 1e-9 } else { 2f64.powf(2.0 / 8.0) };
            prop_assert!(plan.planes[4] <= most * room, "{far_end} m for a scene of {most} m");
            changes += i32::from(!approximate && plan.planes[4] != far);
            far = plan.planes[4];
        }
        prop_assert!(changes <= 2, "{changes}");
    }
}

/// Turning and walking about a scene, without a range of one's own: the far end changes rarely, and
/// only the last map with it, which does not move at all while it shows the whole scene.
#[test]
fn turning_and_walking_about_a_scene_leave_all_maps_alone() {
    let place = DVec3::new(1e4, 0.0, -1e4);
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a direction");
    let world = [Aabb::new(place - DVec3::new(200.0, 1.0, 200.0), place + DVec3::new(200.0, 9.0, 200.0))];
    for (fov, whole) in [(1.2, true), (0.4, false)] {
        let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
        let (mut before, mut stretches, mut steps): (Option<ShadowPlan>, _, _) = (None, 0, 0);
        for k in 0..600 {
            let yaw = 0.003 * f64::from(k);
            let ahead = DQuat::from_rotation_y(yaw) * DVec3::NEG_Z * (0.05 * f64::from(k));
            let lens = Frustum::perspective(fov, 4.0 / 3.0, 0.1, 1000.0).expect("a lens");
            let view = turned_view(place + DVec3::new(0.0, 2.0, 140.0) + ahead, [yaw, -0.1, 0.0]).expect("valid");
            let view = view.with_frustum(lens).expect("valid");
            let plan = planner.plan(&view, &sun, &world, &world).expect("a plan");
            let farthest = world[0].corners().map(|corner| view.eye().distance(corner)).into_iter().fold(0.0, f64::max);
            assert!(plan.planes[4] >= farthest, "frame {k}: {:?} for {farthest} m", plan.planes);
            if let Some(before) = &before {
                assert_eq!(plan.planes[..4], before.planes[..4], "frame {k}");
                stretches += u32::from(plan.planes[4] != before.planes[4]);
                for (i, (new, old)) in plan.splits.iter().zip(&before.splits).enumerate() {
                    let moved = new.texels_moved_since(old);
                    steps += u32::from(moved.is_none());
                    assert!(moved.is_some() || i == 3 && plan.planes[4] != before.planes[4], "frame {k}, split {i}");
                    assert!(!whole || i < 3 || moved == Some(DVec2::ZERO), "frame {k}: the last map moved");
                }
            }
            before = Some(plan.clone());
        }
        assert!(stretches <= 2 && steps == if whole { 0 } else { stretches }, "{stretches} stretches, {steps} steps");
    }
}

proptest! {
    /// A map is along each axis as long as its slice's sphere or the whole scene asks for,
    /// whichever is less, and shows all of the slice that is in the scene.
    #[test]
    fn no_map_exceeds_the_scene(
        place in place(), eye in prop::array::uniform3(-300.0..300.0f64), turn in prop::array::uniform3(-3.0..3.0f64), sun in sun(),
        half in prop_oneof![Just(1.0), 1.0..300.0f64], points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 30),
    ) {
        let settings = Preset::Papers.config();
        let mut planner = Planner::new(&settings)?;
        let world = [Aabb::new(place - half, place + half), Aabb::new(place, place + DVec3::new(2.0 * half, 0.0, 0.0))];
        let view = turned_view(place + DVec3::from(eye), turn)?;
        let plan = planner.plan(&view, &sun, &world, &world)?;
        let (u, v) = sun.map_axes();
        let extent = |axis: DVec3| {
            let along = world.iter().flat_map(|b| b.corners()).map(|corner| axis.dot(corner));
            along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
        };
        let whole = DVec2::new(extent(u), extent(v));
        let whole = whole.max(DVec2::splat(1e-3 * whole.max_element()));
        for split in &plan.splits {
            let sphere = slice_sphere(view.frustum(), split.coverage.0, split.coverage.1);
            let served = split.texel_m * (f64::from(split.size) - 2.0 * (settings.filter.radius_texels() + 1.5) - 1.0);
            let least = whole.min(DVec2::splat(2.0 * sphere.radius));
            prop_assert!((served / least).abs_diff_eq(DVec2::ONE, 1e-6), "{served} m for {least} m");
            for point in &points {
                let point = place + half * DVec3::from(*point);
                if (split.coverage.0..=split.coverage.1).contains(&view.view_depth(point)) && in_frustum(&view, point) {
                    prop_assert!(split.contains(point, settings.filter.radius_texels()), "{point} lies at {}", split.map_from_world(point));
                }
            }
        }
    }
}

fn in_frustum(view: &View, point: DVec3) -> bool {
    let (at, lens) = (view.view_from_world_point(point), view.frustum());
    (lens.left * -at.z..=lens.right * -at.z).contains(&at.x) && (lens.bottom * -at.z..=lens.top * -at.z).contains(&at.y)
}

/// 0, 10 and 100 km from the world's origin.
fn place() -> impl Strategy<Value = DVec3> {
    prop_oneof![Just(0.0), Just(1e4), Just(1e5)].prop_map(|distance| DVec3::new(distance, 0.0, -distance))
}

fn sun() -> impl Strategy<Value = DirectionalLight> {
    let direction =
        prop_oneof![Just(DVec3::NEG_Y), (-1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, z)| DVec3::new(x, -0.5, z))];
    direction.prop_map(|direction| DirectionalLight::new(direction).expect("a direction"))
}

fn crop() -> impl Strategy<Value = Crop> {
    prop_oneof![Just(Crop::SceneIndependent), Just(Crop::SceneDependent)]
}

/// Yaw, pitch, roll.
fn turned_view(eye: DVec3, [yaw, pitch, roll]: [f64; 3]) -> Result<View, umbrage::Error> {
    let rotation = DQuat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
    let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.1, 1000.0)?;
    View::look_at(eye, eye + rotation * DVec3::NEG_Z, rotation * DVec3::Y, frustum)
}

/// The comparison can say no: tight maps share no grid.
#[test]
fn tight_maps_do_not_stand_still() {
    let settings = ShadowConfig {
        range: Range::Metres { near: 1.0, far: 300.0 },
        stability: Stability::tight(),
        ..Preset::Papers.config()
    };
    let mut planner = Planner::new(&settings).expect("valid");
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let world = [Aabb::new(DVec3::splat(-400.0), DVec3::splat(400.0))];
    let mut plan = |x| {
        let view = turned_view(DVec3::new(x, 2.0, 0.0), [0.0; 3]).expect("valid");
        planner.plan(&view, &sun, &world, &world).expect("valid").clone()
    };
    let (a, b) = (plan(0.0), plan(0.15));
    assert!(a.splits.iter().zip(&b.splits).all(|(a, b)| b.texels_moved_since(a).is_none()));
}

/// Into a zoom of a third and out again, as slowly and as often as one likes: what a map shows is
/// the same, and comes back the same.
#[test]
fn a_zoom_of_a_third_and_back_changes_nothing() {
    let mut planner = Planner::new(&Preset::Papers.config()).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let world = [Aabb::new(DVec3::splat(-400.0), DVec3::splat(400.0))];
    let mut splits = |zoom: f64| {
        let mut lens = Frustum::perspective(0.9, 1.5, 0.1, 1000.0).expect("valid");
        for edge in [&mut lens.left, &mut lens.right, &mut lens.bottom, &mut lens.top] {
            *edge /= zoom;
        }
        let view = View::look_at_upright(DVec3::ZERO, DVec3::NEG_Z, lens).expect("valid");
        planner.plan(&view, &light, &world, &world).expect("valid").splits.clone()
    };
    let first = splits(1.0);
    for k in 0..600 {
        let zoom = 1.0 + 0.35 * (0.05 * f64::from(k)).sin().powi(2);
        for (split, first) in splits(zoom).iter().zip(&first) {
            assert!(split.texels_moved_since(first).is_some(), "at {zoom}");
        }
    }
    let beyond = splits(1.5);
    assert!(beyond[0].texel_m.x < first[0].texel_m.x / 1.2, "a long zoom does get finer texels");
}

#[test]
fn a_small_zoom_back_and_forth_changes_nothing() {
    let settings = ShadowConfig { range: Range::Metres { near: 1.0, far: 300.0 }, ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("valid");
    let light = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let mut texel = |fov: f64| {
        let view = View::look_at_upright(
            DVec3::ZERO,
            DVec3::NEG_Z,
            Frustum::perspective(fov, 1.5, 0.1, 1000.0).expect("valid"),
        )
        .expect("valid");
        planner.plan(&view, &light, &[], &[]).expect("valid").splits[2].texel_m.x
    };
    let _ = texel(0.8);
    let held = texel(1.0);
    for fov in [0.97, 1.0, 0.95, 0.99, 1.0] {
        assert_eq!(texel(fov), held, "at {fov}");
    }
    assert!(texel(0.5) < held, "a long zoom does get finer texels");
}
