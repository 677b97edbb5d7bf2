//! Views and suns, invented or the scene's own, and camera paths.

use std::path::PathBuf;

use glam::{DAffine3, DQuat, DVec3, dvec3};
use proptest::prelude::*;
use umbrage::{Aabb, Light, Projection};
use umbrage_scene::{
    Animation, CameraPath, Channel, Error, Interpolation, Keys, Lens, LightKind, Node, Pose, Scene, SceneCamera,
    SceneLight, Trs, camera_view, invented_sun, invented_view, light_direction, scene_light,
};

fn pose_of(bounds: Option<Aabb>) -> Pose {
    Pose { bounds, ..Pose::default() }
}

fn placed(lens: Lens, kind: LightKind, local: Trs) -> Scene {
    Scene {
        nodes: vec![Node { local, ..Node::default() }],
        cameras: vec![SceneCamera { name: "eye".into(), node: 0, lens }],
        lights: vec![SceneLight { name: "lamp".into(), node: 0, kind, color: [1.0; 3], intensity: 1.0, range: None }],
        ..Scene::default()
    }
}

const LENS: Lens = Lens::Perspective { yfov: 1.0, aspect: Some(9.0), znear: 0.5, zfar: None };

#[test]
fn a_scenes_own_camera_and_light() {
    // Looking along −Z turned by 90° about Y: along −X. Mirrored and scaled, as nodes may be.
    let local = Trs {
        translation: dvec3(1.0, 2.0, 3.0),
        rotation: DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2),
        scale: dvec3(-2.0, 3.0, 0.001),
    };
    let scene = placed(LENS, LightKind::Directional, local);
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    let view = camera_view(&scene, &pose, 0, 2.0, None, None).unwrap_or_else(|error| panic!("{error}"));
    assert!(view.forward().distance(DVec3::NEG_X) < 1e-12 && view.eye() == dvec3(1.0, 2.0, 3.0));
    let frustum = view.frustum();
    assert!((frustum.top - 0.5_f64.tan()).abs() < 1e-12 && (frustum.right / frustum.top - 2.0).abs() < 1e-12);
    assert_eq!((frustum.near, frustum.far), (0.5, f64::INFINITY));
    let view = camera_view(&scene, &pose, 0, 2.0, Some(2.0), Some(50.0)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((view.frustum().near, view.frustum().far), (2.0, 50.0));
    let direction = light_direction(&scene, &pose, 0).unwrap_or_else(|error| panic!("{error}"));
    assert!(direction.distance(DVec3::NEG_X) < 1e-12);

    let flat = Lens::Orthographic { xmag: 4.0, ymag: 3.0, znear: 0.0, zfar: 9.0 };
    let scene = placed(flat, LightKind::Directional, Trs::IDENTITY);
    let view = camera_view(&scene, &pose, 0, 1.5, None, None).unwrap_or_else(|error| panic!("{error}"));
    let frustum = view.frustum();
    assert_eq!(frustum.projection, Projection::Orthographic);
    assert_eq!((frustum.top, frustum.right, frustum.near, frustum.far), (3.0, 4.5, 0.0, 9.0));
}

#[test]
fn spot_and_point_lights_go_with_their_nodes() {
    let local = Trs { scale: DVec3::splat(50.0), ..Trs::IDENTITY };
    let mut scene = placed(LENS, LightKind::Spot { inner: 0.1, outer: 0.6 }, local);
    scene.lights[0].range = Some(7.0);
    scene.animations.push(Animation {
        name: String::new(),
        channels: vec![Channel {
            node: 0,
            times: vec![0.0, 2.0],
            values: Keys::Translation(vec![[0.0; 3], [4.0, 0.0, 0.0]]),
            interpolation: Interpolation::Linear,
        }],
        duration: 2.0,
    });
    let pose = scene.pose(1.0).unwrap_or_else(|error| panic!("{error}"));
    let light = scene_light(&scene, &pose, 0).unwrap_or_else(|error| panic!("{error}"));
    let Light::Spot(spot) = light else { panic!("{light:?} is no spot light") };
    assert_eq!((spot.position(), spot.direction()), (dvec3(2.0, 0.0, 0.0), DVec3::NEG_Z));
    assert_eq!((spot.outer_angle(), spot.range()), (0.6, 7.0), "a scale changes neither");

    // Without a range it shines as far as there is something.
    let scene = placed(LENS, LightKind::Point, Trs::IDENTITY);
    let pose = Pose {
        world_from_node: vec![DAffine3::from_translation(DVec3::X)],
        ..pose_of(Some(Aabb::new(DVec3::ZERO, dvec3(4.0, 4.0, 0.0))))
    };
    let light = scene_light(&scene, &pose, 0).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((light.position(), light.range()), (Some(DVec3::X), 5.0));

    let wide = placed(LENS, LightKind::Spot { inner: 0.0, outer: std::f64::consts::FRAC_PI_2 }, Trs::IDENTITY);
    let error = scene_light(&wide, &wide.pose(0.0).unwrap_or_else(|error| panic!("{error}")), 0).expect_err("too wide");
    assert!(matches!(&error, Error::Light { .. }) && error.to_string().contains("outer_angle"), "{error}");
    assert!(matches!(scene_light(&wide, &pose, 1), Err(Error::NoSuchElement { kind: "light", .. })));
}

#[test]
fn cameras_and_lights_that_cannot_be() {
    let scene = placed(LENS, LightKind::Point, Trs::IDENTITY);
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(camera_view(&scene, &pose, 1, 1.0, None, None), Err(Error::NoSuchElement { kind: "camera", .. })));
    assert!(matches!(light_direction(&scene, &pose, 1), Err(Error::NoSuchElement { kind: "light", .. })));
    assert!(matches!(light_direction(&scene, &pose, 0), Err(Error::Light { .. })));
    for (near, far) in [(Some(0.0), None), (Some(f64::NAN), None), (Some(9.0), Some(9.0)), (None, Some(0.25))] {
        assert!(matches!(camera_view(&scene, &pose, 0, 1.0, near, far), Err(Error::View(_))), "{near:?} {far:?}");
    }
    for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(camera_view(&scene, &pose, 0, aspect, None, None), Err(Error::View(_))), "{aspect}");
    }
    let nowhere = placed(LENS, LightKind::Directional, Trs { scale: DVec3::ZERO, ..Trs::IDENTITY });
    let pose = nowhere.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(light_direction(&nowhere, &pose, 0), Err(Error::Light { .. })));
    let error = camera_view(&nowhere, &pose, 0, 1.0, None, None).expect_err("its node is flat");
    assert!(matches!(error, Error::Camera { .. }) && error.to_string().contains("cameras[0]"), "{error}");
    // A pose of another scene.
    assert!(camera_view(&nowhere, &Pose::default(), 0, 1.0, None, None).is_err());
}

#[test]
fn the_invented_sun_stands_half_way_up() {
    let sun = invented_sun();
    assert!((sun.length() - 1.0).abs() < 1e-12);
    assert!((sun.y + 45_f64.to_radians().sin()).abs() < 1e-12, "it comes down at 45°");
}

#[test]
fn empty_scenes_and_points_have_views() {
    for bounds in [None, Some(Aabb::new(DVec3::ONE, DVec3::ONE))] {
        let view = invented_view(&pose_of(bounds), 1.0, 1.0, None, None).unwrap_or_else(|error| panic!("{error}"));
        let target = bounds.map_or(DVec3::ZERO, Aabb::center);
        assert!((view.view_depth(target) - 10.0).abs() < 1e-9);
        let frustum = view.frustum();
        assert!(frustum.near < 10.0 && frustum.far > 10.0);
    }
    let empty = pose_of(None);
    assert!(invented_view(&empty, 0.0, 1.0, None, None).is_err());
    assert!(invented_view(&empty, 1.0, f64::NAN, None, None).is_err());
    assert!(invented_view(&empty, 1.0, 1.0, Some(-1.0), None).is_err());
    assert!(invented_view(&empty, 1.0, 1.0, Some(5.0), Some(5.0)).is_err());
    let infinite = invented_view(&empty, 1.0, 1.0, None, Some(f64::INFINITY)).unwrap_or_else(|error| panic!("{error}"));
    assert!(infinite.frustum().near < 10.0);
}

proptest! {
    /// From props of a centimetre to terrain of 100 km, anywhere, flat or not: all in the picture,
    /// most of it filled.
    #[test]
    fn invented_views_show_the_whole_scene(
        center in prop::array::uniform3(-1e5..1e5),
        exponents in prop::array::uniform3(prop_oneof![4 => -2.0..5.0, 1 => Just(f64::NEG_INFINITY)]),
        aspect in 0.3..3.0, fov in 0.2..2.0,
    ) {
        let half = DVec3::from(exponents.map(|e: f64| 10_f64.powf(e)));
        prop_assume!(half.max_element() > 0.0);
        let bounds = Aabb::new(DVec3::from(center) - half, DVec3::from(center) + half);
        let view = invented_view(&pose_of(Some(bounds)), fov, aspect, None, None).unwrap_or_else(|error| panic!("{error}"));
        let frustum = view.frustum();
        let mut most: f64 = 0.0;
        for corner in bounds.corners() {
            let p = view.view_from_world_point(corner);
            let depth = -p.z;
            prop_assert!(depth > frustum.near && depth < frustum.far, "{depth} {frustum:?}");
            let share = (p.x / depth / frustum.right).abs().max((p.y / depth / frustum.top).abs());
            prop_assert!(share < 1.0, "{share}");
            most = most.max(share);
        }
        prop_assert!(most > 0.9, "the scene fills {most} of the picture");
        // From the south-east, above.
        let from = view.eye() - bounds.center();
        prop_assert!(from.x > 0.0 && from.y > 0.0 && from.z > 0.0);
    }
}

fn square(closed: bool) -> CameraPath {
    let points = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]].map(|[x, z]| dvec3(x, 1.0, z));
    CameraPath::new("square", points.to_vec(), closed, None).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn assert_near(a: DVec3, b: DVec3) {
    assert!(a.distance(b) < 1e-9, "{a} is not {b}");
}

#[test]
fn frames_are_spread_evenly_and_look_ahead() {
    let closed = square(true);
    assert_eq!((closed.length(), square(false).length()), (400.0, 300.0));
    let at = |path: &CameraPath, k, n| path.pose_at(k, n, 2.0).unwrap_or_else(|error| panic!("{error}"));
    for (k, eye, target) in [
        (0, [0.0, 3.0, 0.0], [20.0, 3.0, 0.0]),
        (1, [50.0, 3.0, 0.0], [70.0, 3.0, 0.0]),
        (2, [100.0, 3.0, 0.0], [100.0, 3.0, 20.0]),
        (7, [0.0, 3.0, 50.0], [0.0, 3.0, 30.0]),
    ] {
        let (e, t) = at(&closed, k, 8);
        assert_near(e, eye.into());
        assert_near(t, target.into());
    }
    // Round the corner, and over the seam.
    assert_near(at(&closed, 39, 40).1, dvec3(10.0, 3.0, 0.0));
    assert_near(at(&closed, 9, 40).1, dvec3(100.0, 3.0, 10.0));
    let open = square(false);
    assert_near(at(&open, 0, 4).0, dvec3(0.0, 3.0, 0.0));
    assert_near(at(&open, 3, 4).0, dvec3(0.0, 3.0, 100.0));
    assert_near(at(&open, 3, 4).1, dvec3(-20.0, 3.0, 100.0));
    assert_near(at(&open, 0, 1).0, dvec3(0.0, 3.0, 0.0));
}

#[test]
fn paths_that_lead_nowhere() {
    let path = |points: &[[f64; 3]], closed, sun| {
        CameraPath::new("lane", points.iter().map(|p| DVec3::from(*p)).collect(), closed, sun)
    };
    let wrong = [
        path(&[], false, None),
        path(&[[1.0; 3]], true, None),
        path(&[[1.0; 3], [1.0; 3]], true, None),
        path(&[[1.0; 3], [f64::NAN; 3]], false, None),
        path(&[[1.0; 3], [f64::INFINITY; 3]], false, None),
        path(&[[-1e308; 3], [1e308; 3]], false, None),
        path(&[[0.0; 3], [1.0; 3]], false, Some(DVec3::ZERO)),
        path(&[[0.0; 3], [1.0; 3]], false, Some(DVec3::NAN)),
    ];
    for result in wrong {
        let error = result.expect_err("this is no path");
        assert!(matches!(error, Error::CameraPath { .. }) && error.to_string().contains("lane"), "{error}");
    }
    let square = square(true);
    for (k, n) in [(0, 0), (5, 5), (6, 5)] {
        assert!(matches!(square.pose_at(k, n, 2.0), Err(Error::NoSuchElement { kind: "frame", .. })));
    }
    assert!(square.pose_at(0, 1, f64::NAN).is_err());
    // Once round is 20 m: the point ahead is the eye itself.
    let tiny = path(&[[0.0; 3], [10.0, 0.0, 0.0]], true, None).unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(tiny.pose_at(0, 4, 2.0), Err(Error::CameraPath { .. })));

    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("lane.json");
    assert!(matches!(CameraPath::load(&file), Err(Error::Read { .. })));
    for text in ["", "{}", "{\"points\": 3}", "{\"points\": [[1, 2]]}", "{\"points\": [[1, 2, null], [1, 2, 3]]}", "[]"]
    {
        std::fs::write(&file, text).expect("a file");
        let error = CameraPath::load(&file).expect_err(text);
        assert!(matches!(error, Error::Malformed { .. }) && error.to_string().contains("lane.json"), "{error}");
    }
}

#[test]
fn a_recorded_path_looks_where_it_was_looked() {
    let targets = [[0.0, 0.0], [100.0, 50.0], [50.0, 100.0], [50.0, 50.0]].map(|[x, z]| dvec3(x, 9.0, z - 30.0));
    let path = square(false).with_targets(targets.to_vec()).expect("a target for each point");
    let at = |path: &CameraPath, k, n| path.pose_at(k, n, 2.0).unwrap_or_else(|error| panic!("{error}"));
    for (k, eye, target) in [
        (0, [0.0, 3.0, 0.0], [0.0, 11.0, -30.0]),
        (1, [50.0, 3.0, 0.0], [50.0, 11.0, -5.0]),
        (4, [100.0, 3.0, 100.0], [50.0, 11.0, 70.0]),
        (6, [0.0, 3.0, 100.0], [50.0, 11.0, 20.0]),
    ] {
        let (e, t) = at(&path, k, 7);
        assert_near(e, eye.into());
        assert_near(t, target.into());
    }
    assert_ne!(at(&path, 1, 7).1, at(&square(false), 1, 7).1, "the path ahead is something else");

    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("recorded.json");
    for path in [path.clone(), square(true)] {
        std::fs::write(&file, path.to_json().expect("JSON")).expect("a file");
        let read = CameraPath::load(&file).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((read.points(), read.is_closed()), (path.points(), path.is_closed()));
        assert_eq!(at(&read, 2, 7), at(&path, 2, 7));
    }

    assert!(square(false).with_targets(targets[..3].to_vec()).is_err(), "one for each point");
    assert!(square(false).with_targets(vec![DVec3::NAN; 4]).is_err(), "finite");
    let own = square(false);
    let itself = own.points().to_vec();
    let error = own.with_targets(itself).expect("finite").pose_at(0, 7, 2.0).expect_err("nowhere to look");
    assert!(error.to_string().contains("its target is where the eye is"), "{error}");
}

#[test]
fn the_authors_path() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/city_candela.path.json");
    let path = CameraPath::load(&path).unwrap_or_else(|error| panic!("{error}"));
    assert!(path.is_closed());
    assert_eq!(path.points().len(), 172);
    let sun = path.sun_direction_to_light.expect("the author gave one");
    assert!((sun.length() - 1.0).abs() < 1e-3 && sun.y > 0.0);
    for k in 0..50 {
        let (eye, target) = path.pose_at(k, 50, 2.0).unwrap_or_else(|error| panic!("{error}"));
        assert!(eye.distance(target) < 20.0 + 1e-9);
    }
}

proptest! {
    /// Arc length against walking the path in small steps.
    #[test]
    fn points_lie_as_far_along_as_they_say(
        points in prop::collection::vec(prop::array::uniform3(prop_oneof![3 => -50.0..50.0, 1 => Just(0.0)]), 2..8),
        closed in any::<bool>(), share in 0.0..1.0,
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        let Ok(path) = CameraPath::new("any", points, closed, None) else { return Ok(()) };
        let steps = 4000_u32;
        let mut walked: f64 = 0.0;
        let end: f64 = share * path.length();
        for i in 0..steps {
            let at = |i: u32| path.point_at(end * f64::from(i) / f64::from(steps));
            walked += at(i).distance(at(i + 1));
        }
        // Corners are cut by at most a step each.
        prop_assert!((walked - end).abs() <= 10.0 * end / f64::from(steps) + 1e-9, "{walked} {end}");
    }
}

#[test]
fn poses_place_what_they_are_given() {
    // The transforms of the pose count, not those of the scene at rest.
    let scene = placed(LENS, LightKind::Directional, Trs::IDENTITY);
    let moved = Pose { world_from_node: vec![DAffine3::from_translation(DVec3::X)], ..Pose::default() };
    let view = camera_view(&scene, &moved, 0, 1.0, None, None).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(view.eye(), DVec3::X);
}
