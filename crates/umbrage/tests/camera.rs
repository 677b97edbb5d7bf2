//! Cameras: labelled points pushed through whole matrices, and matrices read back.

use glam::{DMat4, DVec3, DVec4};
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
        // Rounding in z = A d + B loses far/near digits of the far plane; OpenGL's form loses them in near too.
        let ratio = (frustum.far / frustum.near).min(1e9);
        prop_assert!(close(read.near, frustum.near, frustum.near * (1.0 + 1e-6 * ratio)), "near {} {}", read.near, frustum.near);
        let far_ok = if frustum.far / frustum.near > 1e5 { read.far > 0.5e5 * frustum.near } else { (read.far - frustum.far).abs() <= 1e-9 * ratio * frustum.far };
        prop_assert!(far_ok, "far {} {}", read.far, frustum.far);
    }
}
