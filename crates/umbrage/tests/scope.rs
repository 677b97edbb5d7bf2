//! What is ignored: very far objects, ground beyond all shadows, how far an orthographic camera
//! stands off.

use glam::DVec3;
use umbrage::config::{ExtentSteps, Preset, Range, Selection, SplitScheme, Stability};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, ShadowPlan, View};

const STABILITIES: [Stability; 3] =
    [Stability::tight(), Stability::Exact, Stability::Approximate { steps: ExtentSteps::PerDoubling(24) }];

fn sun() -> DirectionalLight {
    DirectionalLight::new(DVec3::new(-0.5, -0.6, -0.35)).expect("a sun")
}

fn view(near: f64, far: f64) -> View {
    let lens = Frustum::perspective(1.0, 4.0 / 3.0, near, far).expect("a lens");
    View::look_at_upright(DVec3::new(4.0, 5.0, 10.0), DVec3::new(0.0, 0.5, -1.0), lens).expect("a view")
}

/// Boxes of a metre or two within 10 m, sunk into the ground by a hand's breadth, on a flat ground
/// of so many metres.
fn things(half: f64) -> Vec<Aabb> {
    let mut boxes: Vec<Aabb> = (0..14)
        .map(|i| {
            let at = DVec3::new(f64::from(i * 7 % 12) - 6.0, -0.1, f64::from(i * 5 % 13) - 9.0);
            Aabb::new(at, at + DVec3::new(0.6, 1.0 + 0.2 * f64::from(i % 8), 0.7))
        })
        .collect();
    boxes.push(Aabb::new(DVec3::new(-half, 0.0, -half), DVec3::new(half, 0.0, half)));
    boxes
}

fn plan(settings: &ShadowConfig, view: &View, boxes: &[Aabb]) -> ShadowPlan {
    let mut planner = Planner::new(settings).expect("settings");
    planner.plan(view, &sun(), boxes, boxes).expect("a plan").clone()
}

/// The finest map that a shown point asks: edge of its texel, and length of its depth range,
/// metres.
fn texel_at(plan: &ShadowPlan, point: DVec3) -> (f64, f64) {
    let split = plan.splits.iter().find(|split| plan.depth_at(point) < split.far).expect("the point is in range");
    assert!(split.contains(point, split.filter_radius_texels) || split.casters.is_empty(), "{point} in {split:?}");
    (split.texel_m.max_element(), split.depth_far - split.depth_near)
}

#[test]
fn a_ground_of_any_size_leaves_texels_to_what_stands_on_it() {
    // Tight maps that are chosen by what they contain begin with the ground, wherever that does.
    let all = STABILITIES.into_iter().flat_map(|it| [(it.clone(), Preset::Papers), (it, Preset::Balanced)]);
    for (stability, preset) in all.filter(|(it, preset)| *preset == Preset::Papers || *it != Stability::tight()) {
        let settings = ShadowConfig { stability: stability.clone(), ..preset.config() };
        for (near, far) in [(0.01, f64::INFINITY), (1.0, f64::INFINITY), (0.1, 300.0), (1.0, 1e6)] {
            for half in [10.0, 100.0, 2e3, 2e4, 5e5] {
                let plan = plan(&settings, &view(near, far), &things(half));
                for foot in [DVec3::ZERO, DVec3::new(-5.0, 0.0, -8.0), DVec3::new(5.0, 0.0, 3.0)] {
                    let (texel, depth) = texel_at(&plan, foot);
                    assert!(
                        texel < 0.07,
                        "{stability:?} {near}..{far}, {half} m: texels of {texel} m, {:?}",
                        plan.planes
                    );
                    // 32-bit depth is good to a few millimetres.
                    assert!(depth < 2e4, "{stability:?} {near}..{far}, {half} m: {depth} m of depth");
                }
            }
        }
    }
}

#[test]
fn one_very_far_object_changes_nothing() {
    let forward = view(1.0, 10.0).forward();
    for stability in &STABILITIES {
        let settings = ShadowConfig { stability: stability.clone(), ..Preset::Papers.config() };
        for far in [300.0, f64::INFINITY] {
            let view = view(0.1, far);
            let boxes = things(50.0);
            let without = plan(&settings, &view, &boxes);
            for towards in [forward, -forward, DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(-0.9, 0.05, 0.3)] {
                for distance in [1e5, 1e6, 1e7, 1e9] {
                    let at = distance * towards;
                    let mut with = boxes.clone();
                    with.push(Aabb::new(at - 0.5e-3 * distance, at + 0.5e-3 * distance));
                    let with = plan(&settings, &view, &with);
                    let told = format!("{stability:?}, {distance} m towards {towards}, lens to {far}");
                    for (a, b) in with.splits.iter().zip(&without.splits) {
                        let ratio = a.texel_m / b.texel_m;
                        assert!(
                            (ratio - 1.0).abs().max_element() < 1e-6,
                            "{told}: texels of {} for {}",
                            a.texel_m,
                            b.texel_m
                        );
                        assert!(
                            (a.far / b.far - 1.0).abs() < 1e-9,
                            "{told}: {:?} for {:?}",
                            with.planes,
                            without.planes
                        );
                        assert!(a.depth_far - a.depth_near < 1e4, "{told}: {a:?}");
                    }
                    assert_eq!(with.caster_indices, without.caster_indices, "{told}");
                }
            }
        }
    }
}

#[test]
fn an_orthographic_camera_may_stand_off_as_far_as_it_likes() {
    let toward = DVec3::new(1.0, 0.9, 1.0).normalize();
    for stability in &STABILITIES {
        let settings = ShadowConfig { stability: stability.clone(), ..Preset::Papers.config() };
        let texels = [30.0, 300.0, 5000.0].map(|distance| {
            let lens = Frustum::orthographic(24.0, 18.0, 0.1, 2.0 * distance).expect("a lens");
            let view = View::look_at_upright(toward * distance, DVec3::ZERO, lens).expect("a view");
            texel_at(&plan(&settings, &view, &things(40.0)), DVec3::ZERO).0
        });
        assert!(texels[1] < 1.5 * texels[0] && texels[2] < 1.5 * texels[0], "{stability:?}: {texels:?}");
    }
}

#[test]
fn every_direction_of_sight_along_the_sun_has_axes_and_casters() {
    let boxes: Vec<Aabb> = things(40.0).into_iter().chain([Aabb::new(DVec3::splat(-0.5), DVec3::splat(0.5))]).collect();
    for i in 0..200 {
        // Directions all over the sphere, the axes among them.
        let y = 1.0 - (f64::from(i) + 0.5) / 100.0;
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
        let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
        let d = axes.get(i as usize).copied().unwrap_or(DVec3::new(cos, y, sin).normalize());
        for off in [0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-6, 1e-4] {
            let sun = DirectionalLight::new(d + off * DVec3::new(0.6, 0.0, -0.8)).expect("a sun");
            let lens = Frustum::perspective(1.0, 1.5, 0.1, 100.0).expect("a lens");
            let view = View::look_at_upright(-4.0 * d, DVec3::ZERO, lens).expect("a view");
            for stability in &STABILITIES {
                for scheme in [SplitScheme::practical(), SplitScheme::Optimal] {
                    let settings = ShadowConfig { stability: stability.clone(), scheme, ..Preset::Papers.config() };
                    let mut planner = Planner::new(&settings).expect("settings");
                    let plan = planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
                    for split in &plan.splits {
                        let frame = split.u_axis.cross(split.v_axis);
                        assert!(frame.abs_diff_eq(sun.direction(), 1e-10), "{d} {off} {stability:?}: {split:?}");
                        assert!(split.u_axis.dot(split.v_axis).abs() < 1e-10, "{d} {off} {stability:?}: {split:?}");
                    }
                    // The cube before the eye casts a shadow on what lies behind it, and has a
                    // list that says so.
                    assert!(plan.splits.iter().any(|split| !split.casters.is_empty()), "{d} {off} {stability:?}");
                }
            }
        }
    }
}

#[test]
fn a_map_without_casters_does_not_answer_for_a_later_one() {
    let lens = Frustum::perspective(1.0, 1.5, 0.5, 200.0).expect("a lens");
    let view = View::look_at_upright(DVec3::Y * 2.0, DVec3::new(0.0, 1.0, -50.0), lens).expect("a view");
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.0)).expect("a sun");
    let ground = Aabb::new(DVec3::new(-100.0, 0.0, -150.0), DVec3::new(100.0, 0.0, 100.0));
    // The only caster stands far away: the first split has none.
    let caster = Aabb::new(DVec3::new(-3.0, 4.0, -103.0), DVec3::new(3.0, 8.0, -97.0));
    let shaded = DVec3::new(1.5, 0.0, -100.0);
    for selection in [Selection::VIEW_DEPTH, Selection::Map] {
        let settings = ShadowConfig { selection, ..Preset::Papers.config() };
        let mut planner = Planner::new(&settings).expect("settings");
        let plan = planner.plan(&view, &sun, &[caster], &[ground]).expect("a plan");
        assert!(plan.splits[0].casters.is_empty() && plan.splits.iter().any(|split| !split.casters.is_empty()));
        let split = plan.covering_split(shaded).expect("a map answers");
        assert_eq!(plan.casters(split), [0], "{selection:?}");
        if selection == Selection::Map {
            let depths = plan.splits[split].receiver_depths;
            for corner in [DVec3::new(0.0, 0.0, -10.0), DVec3::new(20.0, 0.0, -100.0)] {
                let along = sun.direction().dot(corner);
                assert!((depths.0..=depths.1).contains(&along), "{along} of {depths:?}");
            }
        }
    }
}

#[test]
fn a_slice_that_the_camera_does_not_show_answers_for_nothing() {
    let lens = Frustum::perspective(1.0, 1.5, 0.5, 100.0).expect("a lens");
    let view = View::look_at_upright(DVec3::Y * 2.0, DVec3::new(0.0, 1.0, -50.0), lens).expect("a view");
    let boxes = [
        Aabb::new(DVec3::new(-900.0, 0.0, -900.0), DVec3::new(900.0, 0.0, 900.0)),
        Aabb::new(DVec3::new(-5.0, 5.0, -305.0), DVec3::new(5.0, 9.0, -295.0)),
    ];
    let settings = ShadowConfig { range: Range::Metres { near: 0.5, far: 800.0 }, ..Preset::Papers.config() };
    let mut planner = Planner::new(&settings).expect("settings");
    let sun = DirectionalLight::new(DVec3::new(0.0, -1.0, 0.01)).expect("a sun");
    let plan = planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
    assert_eq!(plan.covering_split(DVec3::new(0.0, 0.0, -300.0)), None, "nobody looked for its casters");
}

#[test]
fn without_receivers_in_view_casters_show_shadows() {
    let boxes = things(50.0);
    let view = view(0.1, 300.0);
    let elsewhere = [Aabb::new(DVec3::splat(900.0), DVec3::splat(901.0))];
    let settings = ShadowConfig { stability: Stability::tight(), ..Preset::Papers.config() };
    let all = plan(&settings, &view, &boxes);
    for receivers in [&[][..], &elsewhere[..]] {
        let mut planner = Planner::new(&settings).expect("settings");
        let plan = planner.plan(&view, &sun(), &boxes, receivers).expect("a plan");
        assert_eq!(plan.splits, all.splits);
    }
}

/// What is very far away is left out by where it begins, and not by how far a shadow falls on what
/// begins near: a roof's shadow on a wide ground, with and without a tiny box far below.
#[test]
fn a_far_object_takes_no_shadow_from_a_ground_that_begins_near() {
    let slope = 0.5939694531055459_f64.atan2(0.8044875939239204).tan();
    let direction = DVec3::new(slope, -1.0, 0.0).normalize();
    let sun = DirectionalLight::new(direction).expect("a sun");
    let lens = Frustum::perspective(2.0, 1.2, 0.01, f64::INFINITY).expect("a lens");
    let eye = DVec3::new(-6.6, 29.6, 11.8);
    let view = View::look_at_upright(eye, eye + direction, lens).expect("a view");
    let roof = Aabb::new(DVec3::new(0.0, 4.4, 29.6), DVec3::new(69.0, 4.4, 84.7));
    let ground = Aabb::new(DVec3::new(-17_700.0, 0.0, -17_700.0), DVec3::new(17_700.0, 0.0, 17_700.0));
    let far = Aabb::new(DVec3::new(-162.0, -164_600.0, -162.0), DVec3::new(162.0, -164_270.0, 162.0));
    // Its shadow lies near, and the range follows the shadows.
    let post = Aabb::new(DVec3::new(-25.45, 0.0, 0.0), DVec3::new(-25.4, 10.0, 0.05));
    let point = DVec3::new(53.4, 0.0, 71.8);
    for boxes in [vec![roof, ground, post], vec![roof, ground, post, far]] {
        let mut planner = Planner::new(&Preset::Papers.config()).expect("settings");
        let plan = planner.plan(&view, &sun, &boxes, &boxes).expect("a plan");
        let (depth, end) = (plan.depth_at(point), plan.planes[plan.splits.len()]);
        assert!(depth < end, "{} boxes: the range ends at {end} m, the roof's shadow lies {depth} m deep", boxes.len());
    }
}
