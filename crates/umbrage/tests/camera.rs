//! Cameras: labelled points pushed through whole matrices, and matrices read back.

use glam::{DMat4, DVec3, DVec4, EulerRot, dcamera};
use proptest::prelude::*;
use umbrage::{DepthConvention, Error, Frustum, Projection, View};

fn ndc(m: DMat4, p: DVec3) -> DVec3 {
    let clip = m * p.extend(1.0);
    clip.truncate() / clip.w
}

#[test]
fn right_is_right_up_is_up_and_depth_is_reversed() {
    let frustum = Frustum::perspective(1.0, 4.0 / 3.0, 0.5, 100.0).expect("valid");
    let eye = DVec3::new(1e5, 20.0, -3e4);
    let view = View::look_at(eye, eye + DVec3::NEG_Z, DVec3::Y, frustum).expect("valid");
    let clip = view.clip_from_relative(eye);
    let at = |x, y, d: f64| ndc(clip, DVec3::new(x, y, -d));
    assert!(at(0.0, 0.0, 10.0).abs_diff_eq(DVec3::new(0.0, 0.0, at(0.0, 0.0, 10.0).z), 1e-12), "ahead is the centre");
    assert!(at(1.0, 0.0, 10.0).x > 0.0, "right goes right");
    assert!(at(0.0, 1.0, 10.0).y > 0.0, "up goes up");
    assert!((at(0.0, 0.0, 0.5).z - 1.0).abs() < 1e-12, "near is 1");
    assert!(at(0.0, 0.0, 100.0).z.abs() < 1e-12, "far is 0");
}

#[test]
fn a_ray_through_a_pixel_projects_onto_it() {
    let frustum = Frustum {
        left: -0.3,
        right: 0.9,
        bottom: -0.2,
        top: 0.7,
        ..Frustum::perspective(1.0, 1.0, 0.1, 50.0).expect("valid")
    };
    let eye = DVec3::new(3.0, 4.0, 5.0);
    let view = View::look_at_upright(eye, DVec3::new(-2.0, 1.0, 0.5), frustum).expect("valid");
    for (x, y) in [(0.0, 0.0), (0.25, 0.75), (1.0, 0.5)] {
        let (origin, direction) = view.ray_through(x, y);
        let point = origin + 7.0 * direction;
        assert!((view.view_depth(point) - 7.0).abs() < 1e-12, "a unit of the ray is a metre of view depth");
        let at = ndc(view.clip_from_relative(eye), point - eye);
        assert!((at.x - (2.0 * x - 1.0)).abs() < 1e-12 && (at.y - (1.0 - 2.0 * y)).abs() < 1e-12, "{at}");
    }
}

#[test]
fn looking_straight_down_has_north_on_top() {
    let frustum = Frustum::perspective(1.0, 1.0, 0.1, 50.0).expect("valid");
    let view = View::look_at_upright(DVec3::Y, DVec3::ZERO, frustum).expect("valid");
    assert!(ndc(view.clip_from_relative(DVec3::ZERO), DVec3::new(0.0, 0.0, -0.1)).y > 0.0, "−Z is up");
}

#[test]
fn bad_cameras_are_named() {
    let good = Frustum::perspective(1.0, 1.0, 1.0, 2.0).expect("valid");
    let field = |error: Error| match error {
        Error::InvalidCamera { field, .. } => field,
        other => panic!("another error: {other}"),
    };
    let lens = |fov, aspect, near, far| field(Frustum::perspective(fov, aspect, near, far).expect_err("not a lens"));
    assert_eq!(lens(0.0, 1.0, 1.0, 2.0), "fov");
    assert_eq!(lens(f64::NAN, 1.0, 1.0, 2.0), "fov");
    assert_eq!(lens(3.2, 1.0, 1.0, 2.0), "fov");
    assert_eq!(lens(1.0, 0.0, 1.0, 2.0), "aspect");
    assert_eq!(lens(1.0, f64::INFINITY, 1.0, 2.0), "aspect");
    assert_eq!(lens(1.0, 1.0, 0.0, 2.0), "near");
    assert_eq!(lens(1.0, 1.0, -1.0, 2.0), "near");
    assert_eq!(lens(1.0, 1.0, 2.0, 2.0), "far");
    assert_eq!(lens(1.0, 1.0, 2.0, 1.0), "far");
    assert_eq!(lens(1.0, 1.0, 1.0, f64::NAN), "far");
    assert_eq!(field(Frustum::orthographic(1.0, 0.0, 0.0, 1.0).expect_err("flat")), "height");
    assert_eq!(field(Frustum::orthographic(-1.0, 1.0, 0.0, 1.0).expect_err("inverted")), "width");
    assert_eq!(field(Frustum::orthographic(1.0, 1.0, 0.0, f64::INFINITY).expect_err("endless")), "far");
    let look = |eye, target, up| field(View::look_at(eye, target, up, good).expect_err("no view"));
    assert_eq!(look(DVec3::ONE, DVec3::ONE, DVec3::Y), "target");
    assert_eq!(look(DVec3::ZERO, DVec3::Y, DVec3::Y), "up");
    assert_eq!(look(DVec3::NAN, DVec3::Y, DVec3::X), "eye");
    assert_eq!(look(DVec3::ZERO, DVec3::INFINITY, DVec3::X), "target");
    let strange = DMat4::from_cols(DVec4::new(1.0, 0.5, 0.0, 0.0), DVec4::Y, DVec4::Z, DVec4::W);
    assert_eq!(
        field(Frustum::from_projection_matrix(strange, DepthConvention::ZeroToOne).expect_err("sheared")),
        "projection matrix"
    );
    let nan = DMat4::NAN;
    assert_eq!(
        field(Frustum::from_projection_matrix(nan, DepthConvention::ZeroToOne).expect_err("NaN")),
        "projection matrix"
    );
}

/// Frusta of every sort, biased to the awkward: off-axis, thin, nearly flat, infinite.
fn frusta() -> impl Strategy<Value = Frustum> {
    let side = prop_oneof![Just(1.0), 0.01..4.0f64];
    let far = prop_oneof![Just(f64::INFINITY), 1.001..1.1f64, 2.0..1e6f64];
    (any::<bool>(), side.clone(), side.clone(), side.clone(), side, 1e-3..10.0f64, far).prop_map(
        |(perspective, l, r, b, t, near, ratio)| Frustum {
            projection: if perspective { Projection::Perspective } else { Projection::Orthographic },
            left: -l,
            right: r,
            bottom: -b,
            top: t,
            near,
            far: if perspective || ratio.is_finite() { near * ratio } else { near * 50.0 },
        },
    )
}

proptest! {
    #[test]
    fn projection_matrices_are_read_back(frustum in frusta(), opengl in any::<bool>()) {
        let reversed = frustum.clip_from_view();
        // OpenGL: NDC depth −1 at near, 1 at far, so z' = w − 2 z of the reversed form.
        let flip = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, -2.0, 0.0), DVec4::new(0.0, 0.0, 1.0, 1.0));
        let (matrix, depth) = if opengl { (flip * reversed, DepthConvention::MinusOneToOne) } else { (reversed, DepthConvention::ZeroToOne) };
        let read = Frustum::from_projection_matrix(matrix, depth)?;
        let close = |a: f64, b: f64, scale: f64| a == b || (a - b).abs() <= 1e-9 * scale.abs().max(b.abs());
        prop_assert_eq!(read.projection, frustum.projection);
        let size = (frustum.right - frustum.left).max(frustum.top - frustum.bottom);
        prop_assert!(close(read.left, frustum.left, size) && close(read.right, frustum.right, size));
        prop_assert!(close(read.bottom, frustum.bottom, size) && close(read.top, frustum.top, size));
        // Rounding in z = A d + B loses far/near digits of the far plane; OpenGL's form loses them
        // in near too.
        let ratio = (frustum.far / frustum.near).min(1e9);
        prop_assert!(close(read.near, frustum.near, frustum.near * (1.0 + 1e-6 * ratio)), "near {} {}", read.near, frustum.near);
        let far_ok = if frustum.far / frustum.near > 1e5 { read.far > 0.5e5 * frustum.near } else { (read.far - frustum.far).abs() <= 1e-9 * ratio * frustum.far };
        prop_assert!(far_ok, "far {} {}", read.far, frustum.far);
    }
}

/// A camera's matrices, as engines of every kind have them.
#[derive(Clone, Copy, Debug)]
struct Engine {
    world_from_view: DMat4,
    clip_from_view: DMat4,
    convention: DepthConvention,
    is_left_handed: bool,
    /// Where it looks, in the world.
    forward: DVec3,
}

/// Off-axis, reversed, endless, orthographic, left-handed and mirrored cameras.
fn engines() -> impl Strategy<Value = Engine> {
    let sides = [0.1..1.5f64, 0.1..1.5, 0.1..1.5, 0.1..1.5];
    let turn = [-3.0..3.0f64, -1.5..1.5, -3.0..3.0];
    let at = [-50.0..50.0f64, -50.0..50.0, -50.0..50.0];
    (sides, 0.1..2.0f64, prop_oneof![Just(f64::INFINITY), 20.0..500.0f64], turn, at, any::<[bool; 5]>()).prop_map(
        |([l, r, b, t], near, far, [yaw, pitch, roll], at, [reversed, opengl, left_handed, mirrored, perspective])| {
            let far = if perspective { far } else { far.min(500.0) };
            let (low, high) = if opengl { (-1.0, 1.0) } else { (0.0, 1.0) };
            let (at_near, at_far) = if reversed { (high, low) } else { (low, high) };
            // z/w = a + b/d, or a d + b.
            let (a, b_depth) = match (perspective, far.is_finite()) {
                (true, true) => {
                    let b_depth = (at_near - at_far) / (1.0 / near - 1.0 / far);
                    (at_near - b_depth / near, b_depth)
                }
                (true, false) => (at_far, (at_near - at_far) * near),
                (false, _) => {
                    let a = (at_far - at_near) / (far - near);
                    (a, at_near - a * near)
                }
            };
            // Rows in a view space that looks down −Z; mirrored: x to the left.
            let x = if mirrored { -1.0 } else { 1.0 };
            let (sx, ox, sy, oy) = (2.0 / (l + r), (l - r) / (l + r), 2.0 / (b + t), (b - t) / (b + t));
            let rows = if perspective {
                [
                    DVec4::new(x * sx, 0.0, -ox, 0.0),
                    DVec4::new(0.0, sy, -oy, 0.0),
                    DVec4::new(0.0, 0.0, -a, b_depth),
                    DVec4::new(0.0, 0.0, -1.0, 0.0),
                ]
            } else {
                [
                    DVec4::new(x * sx, 0.0, 0.0, ox),
                    DVec4::new(0.0, sy, 0.0, oy),
                    DVec4::new(0.0, 0.0, -a, b_depth),
                    DVec4::W,
                ]
            };
            let clip_from_view = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
            let rotation = DMat4::from_euler(EulerRot::YXZ, yaw, pitch, roll);
            let world_from_view = DMat4::from_translation(at.into()) * rotation;
            let flip = |x: f64, z: f64| DMat4::from_diagonal(DVec4::new(x, 1.0, z, 1.0));
            let side = if left_handed { flip(1.0, -1.0) } else { DMat4::IDENTITY };
            // A mirrored transform undoes a mirrored projection, or not.
            let other = if mirrored && reversed { flip(-1.0, 1.0) } else { DMat4::IDENTITY };
            let convention = if opengl { DepthConvention::MinusOneToOne } else { DepthConvention::ZeroToOne };
            Engine {
                world_from_view: world_from_view * side * other,
                clip_from_view: clip_from_view * side,
                convention,
                is_left_handed: left_handed,
                forward: world_from_view.transform_vector3(DVec3::NEG_Z),
            }
        },
    )
}

/// Whether a view shows a point, and whether that is beyond doubt.
fn shows(view: &View, point: DVec3) -> bool {
    let (at, lens) = (view.view_from_world_point(point), view.frustum());
    let scale = lens.scale_at(-at.z);
    (lens.near..=lens.far).contains(&-at.z)
        && (lens.left * scale..=lens.right * scale).contains(&at.x)
        && (lens.bottom * scale..=lens.top * scale).contains(&at.y)
}

proptest! {
    #[test]
    fn a_camera_shows_what_its_matrices_show(
        engine in engines(), single in any::<bool>(), points in prop::collection::vec([-0.98..0.98f64, -0.98..0.98, 0.02..0.98f64], 8),
    ) {
        let clip_from_world = engine.clip_from_view * engine.world_from_view.inverse();
        let perspective = engine.clip_from_view.row(3).w == 0.0;
        let is_left_handed = engine.is_left_handed;
        let read = |matrix: umbrage::Matrix| if perspective {
            View::from_clip_from_world(matrix, engine.convention)
        } else {
            let alone = View::from_clip_from_world(matrix, engine.convention);
            assert_eq!(alone, Err(Error::OrthographicDirection));
            // Any vector that is roughly ahead says the side.
            let aside = engine.forward.any_orthonormal_vector();
            let across = View::from_orthographic(matrix, 1e-9 * engine.forward + aside, engine.convention);
            assert!(matches!(across, Err(Error::InvalidCamera { field: "forward", .. })), "{across:?}");
            View::from_orthographic(matrix, engine.forward + 2.0 * aside, engine.convention)
        };
        let views = [
            if single { read(clip_from_world.as_mat4().into()) } else { read(clip_from_world.into()) },
            View::from_matrices(engine.world_from_view, engine.clip_from_view, engine.convention),
        ];
        for view in views {
            let view = view?;
            // Where view depth grows: splits are counted along it.
            let ahead = view.forward().dot(engine.forward);
            prop_assert!((ahead - 1.0).abs() < 1e-5, "{} instead of {}", view.forward(), engine.forward);
            let rotation = view.world_from_view_rotation();
            prop_assert!((rotation.determinant() - 1.0).abs() < 1e-6, "{rotation}");
            for &[x, y, share] in &points {
                for aside in [1.0, 1.05] {
                    let low = if engine.convention == DepthConvention::MinusOneToOne { -1.0 } else { 0.0 };
                    let ndc = DVec3::new(x, y, low + share * (1.0 - low));
                    let ndc = if aside > 1.0 { ndc.with_x(1.05 * x.signum()) } else { ndc };
                    let point = clip_from_world.inverse().project_point3(ndc);
                    // What f32 leaves of an endless range is not worth asking.
                    if point.is_finite() && point.length() < 1e4 {
                        prop_assert_eq!(shows(&view, point), aside == 1.0, "{} of {:?} at {}", point, view, ndc);
                    }
                }
            }
        }
        if is_left_handed {
            let error = Frustum::from_projection_matrix(engine.clip_from_view, engine.convention).expect_err("left-handed");
            prop_assert!(error.to_string().contains("left-handed"), "{error}");
        }
    }

    #[test]
    fn a_projection_in_f32_is_read_with_its_rounding(fov in 0.1..2.5f32, aspect in 0.3..3.0f32, yaw in -3.0..3.0f32, noise in -1.0..1.0f32) {
        // An engine that multiplies its projection by a jitter and a near-identity in f32.
        let near_one = glam::Mat4::from_cols_array(&[
            1.0, 1e-8 * noise, 0.0, 0.0, -1e-8, 1.0, 2e-8 * noise, 0.0, 0.0, 1e-8, 1.0, 1e-8 * noise, 0.0, 0.0, 1e-9, 1.0,
        ]);
        let lens = Frustum::perspective(f64::from(fov), f64::from(aspect), 0.1, f64::INFINITY)?;
        let projection = lens.clip_from_view().as_mat4() * near_one;
        let view = View::from_matrices(glam::Mat4::from_rotation_y(yaw), projection, DepthConvention::ZeroToOne)?;
        let expected = Frustum::perspective(f64::from(fov), f64::from(aspect), 0.1, 1e3)?;
        prop_assert!((view.frustum().top / expected.top - 1.0).abs() < 1e-5 && (view.frustum().right / expected.right - 1.0).abs() < 1e-5);
        prop_assert!((view.frustum().near - 0.1).abs() < 1e-6);
    }
}

/// An orthographic range that begins behind the eye leaves open which way a camera looks.
#[test]
fn orthographic_ranges_on_both_sides_of_the_eye_are_refused() {
    let depth = DepthConvention::ZeroToOne;
    let at = DVec3::new(3.0, 4.0, 5.0);
    let ahead = DVec3::new(1.0, -0.5, 2.0).normalize();
    let left_handed = dcamera::lh::view::look_to_mat4(at, ahead, DVec3::Y);
    let right_handed = dcamera::rh::view::look_to_mat4(at, ahead, DVec3::Y);
    for (near, far) in [(0.0, 50.0), (2.0, 50.0), (-10.0, 50.0)] {
        for (world_to_view, lens) in [
            (left_handed, dcamera::lh::proj::directx::orthographic(-4.0, 4.0, -3.0, 3.0, near, far)),
            (left_handed, dcamera::lh::proj::directx::orthographic(-4.0, 4.0, -3.0, 3.0, far, near)),
            (right_handed, dcamera::rh::proj::directx::orthographic(-4.0, 4.0, -3.0, 3.0, near, far)),
            (right_handed, dcamera::rh::proj::directx::orthographic(-4.0, 4.0, -3.0, 3.0, far, near)),
        ] {
            let view = View::from_matrices(world_to_view.inverse(), lens, depth);
            let view = if near < 0.0 {
                let error = view.expect_err("either way");
                assert_eq!(error, Error::OrthographicDirection);
                assert!(error.to_string().contains("left-handed"), "{error}");
                View::from_orthographic(lens * world_to_view, ahead, depth).expect("a view")
            } else {
                let view = view.expect("a view");
                assert!(view.eye().distance(at) < 1e-9);
                view
            };
            assert!(view.forward().distance(ahead) < 1e-9, "{view:?}");
            let [first, last] = [near, far].map(|metres| view.view_depth(at + metres * ahead));
            assert!((first - view.frustum().near).abs() < 1e-9 && (last - view.frustum().far).abs() < 1e-9);
        }
    }
}

#[test]
fn matrices_that_are_no_camera_are_refused() {
    let skewed = DMat4::from_cols(DVec4::X, DVec4::new(0.7, 1.0, 0.0, 0.0), DVec4::Z, DVec4::W);
    for matrix in [DMat4::ZERO, DMat4::from_diagonal(DVec4::new(1.0, 1.0, 0.0, 1.0)), skewed, DMat4::NAN] {
        let error = View::from_orthographic(matrix, DVec3::Z, DepthConvention::ZeroToOne).expect_err("no camera");
        assert!(error.to_string().contains("view-projection"), "{error}");
        let error = View::from_clip_from_world(matrix, DepthConvention::ZeroToOne).expect_err("no camera");
        assert!(error == Error::OrthographicDirection || error.to_string().contains("view-projection"), "{error}");
    }
}
