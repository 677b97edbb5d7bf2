//! Shadows fade where something can be seen beyond them, and only there.

use glam::DVec3;
use umbrage::config::{Preset, Range};
use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, View};

fn fade_and_end(range: Range, camera_far: f64) -> (f64, f64) {
    let settings = ShadowConfig { range, far_fade: 0.25, ..Preset::Papers.config() };
    let frustum = Frustum::perspective(1.0, 1.5, 1.0, camera_far).expect("valid");
    let view = View::look_at_upright(DVec3::Y * 5.0, DVec3::new(0.0, 0.0, -50.0), frustum).expect("valid");
    let ground = [Aabb::new(DVec3::new(-400.0, -1.0, -400.0), DVec3::new(400.0, 0.0, 400.0))];
    let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("valid");
    let mut planner = Planner::new(&settings).expect("valid");
    let plan = planner.plan(&view, &sun, &ground, &ground).expect("valid");
    (plan.fade_begin, *plan.planes.last().expect("planes"))
}

#[test]
fn a_range_that_ends_in_sight_fades() {
    let range = Range::Metres { near: 1.0, far: 101.0 };
    assert_eq!(fade_and_end(range, 800.0), (76.0, 101.0));
    assert_eq!(fade_and_end(range, f64::INFINITY), (76.0, 101.0));
}

#[test]
fn a_range_with_nothing_to_be_seen_behind_it_stays_dark_to_the_end() {
    for (range, camera_far) in [
        (Range::Camera, 100.0),
        (Range::Camera, 5000.0),
        (Range::Camera, f64::INFINITY),
        (Range::Metres { near: 1.0, far: 100.0 }, 100.0),
        (Range::Metres { near: 1.0, far: 300.0 }, 100.0),
    ] {
        let (fade_begin, end) = fade_and_end(range, camera_far);
        assert_eq!(fade_begin, end, "{range:?} and a camera that sees {camera_far} m");
    }
}
