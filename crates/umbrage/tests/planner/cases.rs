//! Worlds, views and suns to plan for, and what brute force says of them.

use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::config::{
    Crop, ExtentSteps, Preset, Range, Selection, ShadowConfig, SplitMetric, SplitScheme, Stability, Transition,
};
use umbrage::{Aabb, DirectionalLight, FilterReach, Frustum, PlannerOptions, Projection, ShadowPlan, View, Warp};

/// A world of boxes on and around a ground, a view and a sun, biased to the awkward: a sun straight
/// down or level, a view into it, boxes behind the eye, flat boxes, boxes larger than the view.
#[derive(Clone, Debug)]
pub struct Case {
    pub settings: ShadowConfig,
    pub options: PlannerOptions,
    pub view: View,
    pub light: DirectionalLight,
    pub boxes: Vec<Aabb>,
}

pub fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let place = prop_oneof![(-200.0..200.0f64, -200.0..200.0f64), (-20.0..20.0f64, -20.0..20.0f64)];
    let size = prop_oneof![4 => 0.1..10.0f64, 1 => Just(0.0), 1 => 50.0..500.0f64];
    let one = (place, -1.0..30.0f64, [size.clone(), size.clone(), size])
        .prop_map(|((x, z), y, [w, h, d])| Aabb::new(DVec3::new(x, y, z), DVec3::new(x + w, y + h, z + d)));
    (prop::collection::vec(one, 1..40), any::<bool>()).prop_map(|(mut boxes, ground)| {
        if ground {
            boxes.push(Aabb::new(DVec3::new(-600.0, 0.0, -600.0), DVec3::new(600.0, 0.0, 600.0)));
        }
        boxes
    })
}

pub fn settings() -> impl Strategy<Value = (ShadowConfig, PlannerOptions)> {
    let scheme = prop_oneof![
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Logarithmic),
        Just(SplitScheme::Optimal),
        (0.0..=1.0f64).prop_map(|lambda| SplitScheme::Practical { lambda, delta: vec![] })
    ];
    let range = prop_oneof![
        Just(Range::Camera),
        Just(Range::Metres { near: 1.0, far: 300.0 }),
        Just(Range::Metres { near: 5.0, far: 80.0 })
    ];
    let warp = prop_oneof![
        Just(Warp::None),
        Just(Warp::Psm),
        Just(Warp::Lispsm),
        (0.01..0.99f64).prop_map(|focus| Warp::Tsm { focus })
    ];
    let stability = prop_oneof![
        2 => Just(Stability::tight()),
        2 => Just(Stability::Exact),
        1 => Just(Stability::Approximate { steps: ExtentSteps::default() }),
        1 => Just(Stability::Approximate { steps: ExtentSteps::PerDoubling(4) }),
        1 => Just(Stability::Approximate { steps: ExtentSteps::Levels(64) })
    ];
    let warps = prop_oneof![Just(vec![]), prop::collection::vec(warp.clone(), 1), prop::collection::vec(warp, 8)];
    let filter = prop_oneof![
        2 => (0.5..3.0f64).prop_map(|texels| FilterReach { radius_texels: texels, radius_m: None }),
        1 => prop_oneof![Just(0.0), 0.0..0.5f64, 0.5..40.0f64].prop_map(|metres| FilterReach { radius_texels: 16.0, radius_m: Some(metres) })
    ];
    (1usize..=8, scheme, range, any::<[bool; 3]>(), stability, prop_oneof![Just(0.0), 0.0..0.5f64], filter, warps)
        .prop_map(|(m, scheme, range, [dependent, depth_clamp, visible], stability, share, filter_reach, mut warps)| {
            warps.truncate(m);
            let config = ShadowConfig {
                map_sizes: vec![256; m],
                scheme,
                range: if visible && range == Range::Camera { Range::Visible } else { range },
                crop: if dependent { Crop::SceneDependent } else { Crop::SceneIndependent },
                stability: if stability == Stability::tight() { Stability::Tight { warps } } else { stability },
                transition: Transition::Blend { share },
                ..Preset::Papers.config()
            };
            let options = PlannerOptions { depth_clamp, filter_reach: Some(filter_reach), ..PlannerOptions::default() };
            (config, options)
        })
}

pub fn cases() -> impl Strategy<Value = Case> {
    let sun = prop_oneof![
        Just(DVec3::NEG_Y),
        Just(DVec3::new(1.0, -1e-7, 0.0)),
        Just(DVec3::NEG_Z),
        (-1.0..1.0f64, -1.0..-0.02f64, -1.0..1.0f64).prop_map(|(x, y, z)| DVec3::new(x, y, z)),
    ];
    let lens =
        (0.2..2.2f64, 0.5..2.5f64, any::<bool>(), any::<bool>()).prop_map(|(fov, aspect, perspective, off_axis)| {
            let mut frustum = Frustum::perspective(fov, aspect, 0.5, 400.0).expect("valid");
            if !perspective {
                frustum = Frustum::orthographic(80.0, 60.0, 0.5, 400.0).expect("valid");
            }
            if off_axis {
                frustum.left *= 0.2;
                frustum.top *= 1.5;
            }
            frustum
        });
    let eye = (-50.0..50.0f64, 0.5..40.0f64, -50.0..50.0f64);
    let turn = (-3.2..3.2f64, -1.5..0.5f64, any::<bool>());
    (settings(), boxes(), sun, lens, eye, turn).prop_map(
        |((settings, options), boxes, sun, frustum, eye, (yaw, pitch, into_the_light))| {
            let eye = DVec3::from(eye);
            let light = DirectionalLight::new(sun).expect("valid");
            let rotation = DQuat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0);
            let ahead = if into_the_light {
                (-light.direction()).lerp(rotation * DVec3::NEG_Z, 0.05)
            } else {
                rotation * DVec3::NEG_Z
            };
            let up = if ahead.normalize().y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
            let view = View::look_at(eye, eye + ahead, up, frustum).expect("valid");
            Case { settings, options, view, light, boxes }
        },
    )
}

/// Points of the boxes' surfaces that the view shows, as the renderer would find them.
pub fn visible_points(case: &Case, far: f64) -> Vec<(usize, DVec3, f64)> {
    let frustum = case.view.frustum();
    let far = far.min(frustum.far);
    let mut points = Vec::new();
    for (owner, bounds) in case.boxes.iter().enumerate() {
        for i in 0..5 {
            for j in 0..5 {
                for axis in 0..3 {
                    for side in [bounds.min, bounds.max] {
                        let (s, t) = (f64::from(i) / 4.0, f64::from(j) / 4.0);
                        let mut at = bounds.min + (bounds.max - bounds.min) * DVec3::new(s, t, s).with_z(t);
                        at[(axis + 1) % 3] = bounds.min[(axis + 1) % 3] * (1.0 - s) + bounds.max[(axis + 1) % 3] * s;
                        at[(axis + 2) % 3] = bounds.min[(axis + 2) % 3] * (1.0 - t) + bounds.max[(axis + 2) % 3] * t;
                        at[axis] = side[axis];
                        let in_view = case.view.view_from_world_point(at);
                        let (depth, scale) = (-in_view.z, frustum.scale_at(-in_view.z));
                        let shown = depth >= frustum.near
                            && depth <= far
                            && (frustum.left * scale..=frustum.right * scale).contains(&in_view.x)
                            && (frustum.bottom * scale..=frustum.top * scale).contains(&in_view.y);
                        if shown {
                            points.push((owner, at, depth));
                        }
                    }
                }
            }
        }
    }
    points
}

/// Whether the ray from `point` towards the light passes through the box, more than a millimetre
/// away.
pub fn shades(bounds: &Aabb, point: DVec3, direction: DVec3) -> bool {
    shading_end(bounds, point, direction).is_some()
}

/// How far from `point` the ray towards the light leaves a box that it passes through more than a
/// millimetre away.
pub fn shading_end(bounds: &Aabb, point: DVec3, direction: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (1e-3, f64::INFINITY);
    for axis in 0..3 {
        let (p, d) = (point[axis], -direction[axis]);
        if d.abs() < 1e-12 {
            if p < bounds.min[axis] || p > bounds.max[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((bounds.min[axis] - p) / d, (bounds.max[axis] - p) / d);
        enter = f64::max(enter, a.min(b));
        leave = f64::min(leave, a.max(b));
    }
    (enter <= leave).then_some(leave)
}

/// A case with radial bands, where they are possible.
pub fn radial(case: Case) -> Option<Case> {
    let range = if case.settings.range == Range::Visible { Range::Camera } else { case.settings.range };
    let selection = Selection::Interval(SplitMetric::Distance);
    let settings = ShadowConfig { selection, range, ..case.settings };
    (case.view.frustum().projection == Projection::Perspective).then_some(Case { settings, ..case })
}

pub fn splits_of(plan: &ShadowPlan, depth: f64) -> Vec<usize> {
    let m = plan.splits.len();
    let own = plan.splits.iter().position(|s| depth < s.far).unwrap_or(m - 1);
    let blended = plan.splits[own].blend_begin <= depth && own + 1 < m;
    if blended { vec![own, own + 1] } else { vec![own] }
}
