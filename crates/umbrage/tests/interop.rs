//! What an application has, as plain arrays and in the types of `mint`, is what `glam` would say.

use umbrage::glam::{DMat4, DVec3, Mat4};
use umbrage::{Aabb, DepthConvention, DirectionalLight, Error, Frustum, Matrix, View};

/// A matrix of which every entry is another number that `f32` holds.
fn matrix() -> DMat4 {
    DMat4::from_cols_array(&std::array::from_fn(|i| 0.25 + 1.5 * i as f64))
}

#[test]
fn arrays_are_columns() {
    let (wide, narrow) = (matrix(), matrix().as_mat4());
    let same = [
        Matrix::from(wide),
        Matrix::from(narrow),
        Matrix::from(wide.to_cols_array()),
        Matrix::from(wide.to_cols_array_2d()),
        Matrix::from(narrow.to_cols_array()),
        Matrix::from(narrow.to_cols_array_2d()),
    ];
    assert!(same.iter().all(|it| it.0 == wide), "{same:?}");
    // The comparison says no to rows.
    assert_ne!(Matrix::from(wide.transpose().to_cols_array()).0, wide);
}

#[test]
fn lights_and_boxes_are_made_of_arrays() {
    let sun = DirectionalLight::new(DVec3::new(0.5, -1.0, 0.25));
    assert_eq!(DirectionalLight::try_from([0.5_f64, -1.0, 0.25]), sun);
    assert_eq!(DirectionalLight::try_from([0.5_f32, -1.0, 0.25]), sun);
    assert_eq!(DirectionalLight::try_from(DVec3::new(0.5, -1.0, 0.25)), sun);
    assert!(matches!(DirectionalLight::try_from([0.0_f32; 3]), Err(Error::InvalidLight { .. })));
    let bounds = Aabb::new(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(3.0, 4.5, 5.0));
    assert_eq!(Aabb::from([[-1.0_f32, 0.0, 2.0], [3.0, 4.5, 5.0]]), bounds);
    assert_eq!(Aabb::from([[-1.0_f64, 0.0, 2.0], [3.0, 4.5, 5.0]]), bounds);
}

#[test]
fn a_view_of_f32_arrays_is_that_of_its_matrices() {
    let lens = Frustum::perspective(1.0, 1.5, 0.125, 512.0).expect("a lens");
    let (eye, target) = (DVec3::new(3.0, 2.0, 8.0), DVec3::new(0.0, 1.0, 0.0));
    let view = View::look_at_upright(eye, target, lens).expect("a view");
    let world_from_view = view.view_from_relative(DVec3::ZERO).inverse().as_mat4();
    let clip_from_view = lens.clip_from_view().as_mat4();
    let depth = DepthConvention::ZeroToOne;
    let of_glam = View::from_matrices(world_from_view, clip_from_view, depth).expect("a view");
    let of_arrays =
        View::from_matrices(world_from_view.to_cols_array_2d(), clip_from_view.to_cols_array(), depth).expect("a view");
    assert_eq!(of_glam, of_arrays);
    assert!(of_arrays.eye().distance(eye) < 1e-5, "{:?}", of_arrays.eye());
    let turned = Mat4::from_cols_array_2d(&clip_from_view.to_cols_array_2d()).transpose();
    assert_ne!(View::from_matrices(world_from_view, turned, depth), Ok(of_arrays), "rows are another projection");
}

#[cfg(feature = "mint")]
mod of_mint {
    use mint::{ColumnMatrix4, Point3, RowMatrix4, Vector3};

    use super::*;

    #[test]
    fn columns_and_rows_are_told_apart() {
        let wide = matrix();
        let rows = wide.transpose().to_cols_array();
        let narrow = rows.map(|entry| entry as f32);
        let same = [
            Matrix::from(ColumnMatrix4::<f64>::from(wide.to_cols_array())),
            Matrix::from(RowMatrix4::<f64>::from(rows)),
            Matrix::from(ColumnMatrix4::<f32>::from(wide.as_mat4().to_cols_array())),
            Matrix::from(RowMatrix4::<f32>::from(narrow)),
        ];
        assert!(same.iter().all(|it| it.0 == wide), "{same:?}");
        assert_ne!(Matrix::from(RowMatrix4::<f64>::from(wide.to_cols_array())).0, wide);
        // And back: what the planner answers is `glam`'s.
        assert_eq!(ColumnMatrix4::<f64>::from(wide), ColumnMatrix4::from(wide.to_cols_array()));
        assert_eq!(ColumnMatrix4::<f32>::from(wide.as_mat4()), ColumnMatrix4::from(wide.as_mat4().to_cols_array()));
    }

    #[test]
    fn lights_boxes_and_views_are_made_of_mint() {
        let sun = DirectionalLight::new(DVec3::new(0.5, -1.0, 0.25));
        assert_eq!(DirectionalLight::try_from(Vector3 { x: 0.5_f64, y: -1.0, z: 0.25 }), sun);
        assert_eq!(DirectionalLight::try_from(Vector3 { x: 0.5_f32, y: -1.0, z: 0.25 }), sun);
        let corners = [Point3 { x: -1.0_f32, y: 0.0, z: 2.0 }, Point3 { x: 3.0, y: 4.5, z: 5.0 }];
        assert_eq!(Aabb::from(corners), Aabb::new(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(3.0, 4.5, 5.0)));
        let lens = Frustum::perspective(1.0, 1.5, 0.125, 512.0).expect("a lens");
        let view = View::look_at_upright(DVec3::new(3.0, 2.0, 8.0), DVec3::ZERO, lens).expect("a view");
        let clip_from_world = view.clip_from_relative(DVec3::ZERO);
        let depth = DepthConvention::ZeroToOne;
        let of_mint = View::from_clip_from_world(ColumnMatrix4::<f64>::from(clip_from_world), depth);
        assert_eq!(of_mint, View::from_clip_from_world(clip_from_world, depth));
        assert!(of_mint.is_ok());
        let corner = Point3::<f64>::from(view.eye());
        assert_eq!(DVec3::from(corner), view.eye());
    }
}
