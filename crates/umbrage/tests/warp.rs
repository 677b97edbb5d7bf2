//! Warps by property: receivers stay inside, order along the light stays, and the published
//! parameters mean what they say.

use glam::{DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use umbrage::{DirectionalLight, Frustum, View, Warp, WarpTarget};

fn view(eye: DVec3, ahead: DVec3) -> View {
    let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 1.0, 400.0).expect("valid");
    let up = if ahead.normalize().y.abs() > 0.99 { DVec3::X } else { DVec3::Y };
    View::look_at(eye, eye + ahead, up, frustum).expect("valid")
}

fn warps() -> impl Strategy<Value = Warp> {
    prop_oneof![
        Just(Warp::None),
        Just(Warp::Psm),
        Just(Warp::Lispsm),
        (0.05..0.9f64).prop_map(|focus| Warp::Tsm { focus })
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn receivers_land_inside_and_casters_keep_their_order(
        warp in warps(),
        eye in (-50.0..50.0f64, 1.0..50.0f64, -50.0..50.0f64), yaw in -3.1..3.1f64, pitch in -1.4..0.6f64,
        sun in (-1.0..1.0f64, -1.0..-0.05f64, -1.0..1.0f64), dueling in prop_oneof![3 => Just(None), 1 => (0.0..1e-3f64).prop_map(Some)],
        slice in prop_oneof![Just((1.0, 300.0)), Just((1.0, 10.0)), Just((50.0, 120.0))],
        picks in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64, 0.0..200.0f64), 20),
    ) {
        let light = DirectionalLight::new(DVec3::from(sun))?.direction();
        let ahead = match dueling {
            Some(off) => -light + DVec3::new(off, 0.0, off),
            None => DQuat::from_euler(EulerRot::YXZ, yaw, pitch, 0.0) * DVec3::NEG_Z,
        };
        let view = view(DVec3::from(eye), ahead);
        let receivers = view.slice_corners(slice.0, slice.1);
        let inside = |(x, y, z): (f64, f64, f64)| {
            let d = slice.0 + z * (slice.1 - slice.0);
            let corners = view.slice_corners(d, d + 1.0);
            corners[0] + (corners[1] - corners[0]) * x + (corners[2] - corners[0]) * y
        };
        let shaded: Vec<(DVec3, DVec3)> = picks.iter().map(|&(x, y, z, up)| { let p = inside((x, y, z)); (p, p - light * up) }).collect();
        let casters: Vec<DVec3> = shaded.iter().map(|&(_, caster)| caster).collect();
        let target = WarpTarget { view: &view, slice, light, receivers: &receivers, casters: &casters, margin: 0.01 };
        let matrix = warp.shadow_from_world(&target).expect("a slice has extent");
        for (receiver, caster) in shaded {
            let (r, c) = (matrix * receiver.extend(1.0), matrix * caster.extend(1.0));
            prop_assert!(r.w > 0.0 && c.w > 0.0, "{warp:?}: w {} {}", r.w, c.w);
            let (r, c) = (r.truncate() / r.w, c.truncate() / c.w);
            let room = 1e-6;
            prop_assert!(r.x.abs() <= 0.99 + room && r.y.abs() <= 0.99 + room && r.z <= 1.0 + room, "{warp:?}: {r}");
            prop_assert!(c.z >= -room, "{warp:?}: a caster lies before the near plane at {c}");
            prop_assert!((r.x - c.x).abs() < 1e-5 && (r.y - c.y).abs() < 1e-5, "{warp:?}: light is not along depth: {r} {c}");
            prop_assert!(c.z <= r.z + room, "{warp:?}: the caster lies behind its receiver: {c} {r}");
        }
    }
}

#[test]
fn the_trapezoids_focus_line_lands_at_four_fifths() {
    let view = view(DVec3::new(0.0, 10.0, 0.0), DVec3::NEG_Z);
    let light = DVec3::NEG_Y;
    let (near, far, focus) = (1.0, 300.0, 0.2);
    let receivers = view.slice_corners(near, far);
    let target =
        WarpTarget { view: &view, slice: (near, far), light, receivers: &receivers, casters: &[], margin: 0.0 };
    let matrix = Warp::Tsm { focus }.shadow_from_world(&target).expect("a slice has extent");
    let y = |d: f64| matrix.project_point3(view.eye() + view.forward() * d).y;
    let share = (y(near + focus * (far - near)) - y(near)) / (y(far) - y(near));
    assert!((share - 0.8).abs() < 1e-9, "{share}");
}

#[test]
fn light_spaces_distance_is_wimmers() {
    // A perspective about a centre n before the slice gives it texels as 1/w²: the ratio of
    // densities tells n.
    for angle in [90.0f64, 40.0, 10.0] {
        let view = view(DVec3::new(0.0, 100.0, 0.0), DVec3::NEG_Z);
        let radians = angle.to_radians();
        let light = DVec3::new(0.0, -radians.sin(), radians.cos());
        let (near, far) = (1.0, 300.0);
        let receivers = view.slice_corners(near, far);
        let target =
            WarpTarget { view: &view, slice: (near, far), light, receivers: &receivers, casters: &[], margin: 0.0 };
        let matrix = Warp::Lispsm.shadow_from_world(&target).expect("a slice has extent");
        let ahead = (view.forward() - view.forward().dot(light) * light).normalize();
        let along = |p: DVec3| ahead.dot(p);
        let (lo, hi) = receivers.iter().map(|&p| along(p)).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        let w = |at: f64| {
            let p = ahead * at;
            (matrix * p.extend(1.0)).w
        };
        let n = (hi - lo) * w(lo) / (w(hi) - w(lo));
        let expected = (near + (near * far).sqrt()) / radians.sin();
        assert!((n / expected - 1.0).abs() < 1e-9, "{n} is not {expected} at {angle} degrees");
    }
}

#[test]
fn warps_fade_to_the_plain_map_when_the_frusta_duel() {
    let view = view(DVec3::new(0.0, 100.0, 0.0), DVec3::NEG_Z);
    let (near, far) = (1.0, 300.0);
    let receivers = view.slice_corners(near, far);
    let spread = |warp: Warp, angle: f64| {
        let light = DVec3::new(0.0, -angle.sin(), angle.cos());
        let target =
            WarpTarget { view: &view, slice: (near, far), light, receivers: &receivers, casters: &[], margin: 0.0 };
        let matrix = warp.shadow_from_world(&target).expect("a slice has extent");
        let w: Vec<f64> = receivers.iter().map(|&p| (matrix * p.extend(1.0)).w).collect();
        w.iter().copied().fold(f64::MIN, f64::max) / w.iter().copied().fold(f64::MAX, f64::min)
    };
    for warp in [Warp::Psm, Warp::Lispsm, Warp::Tsm { focus: 0.3 }] {
        let spreads: Vec<f64> = [1.5, 0.3, 0.03, 3e-3, 3e-4, 3e-5, 0.0].map(|angle| spread(warp, angle)).to_vec();
        assert!(spreads[0] > 2.0, "{warp:?} does not warp at all: {spreads:?}");
        assert!(spreads.last().is_some_and(|s| (s - 1.0).abs() < 1e-6), "{warp:?}: {spreads:?}");
        assert!(spreads.windows(2).all(|s| s[1] <= s[0] + 1e-9), "{warp:?} does not fade steadily: {spreads:?}");
    }
}
