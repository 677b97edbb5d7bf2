//! Bevy's cameras as the planner takes them.

use bevy_camera::{Camera, Projection};
use bevy_ecs::entity::Entity;
use bevy_math::{Mat4, Vec4};
use bevy_transform::components::GlobalTransform;
use umbrage::glam::{DMat4, DVec3};
use umbrage::{DepthConvention, Frustum, View};

use crate::Error;

/// By what share a camera's axes may be longer or shorter than 1: rounding of chained transforms.
const MOST_SCALE: f32 = 1e-3;

/// The farthest that the planner looks, metres. A camera that sees farther is endless.
const FARTHEST: f32 = 1e12;

/// Share of an orthographic camera's range that the planner's eye is kept before its near plane.
const STANDOFF: f64 = 0.01;

/// Pixels of a camera whose target is not known yet.
const USUAL_SIZE: [u32; 2] = [1920, 1080];

/// A camera as the planner takes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlannerView {
    pub view: View,
    /// Metres that the planner's eye stands behind Bevy's: what Bevy calls view depth is that much
    /// less than the planner's. 0 for a perspective camera. An orthographic one may see what lies
    /// behind its eye; planes begin at positive depths.
    pub standoff: f64,
    /// Width and height of the viewport in pixels.
    pub image_size: [u32; 2],
}

impl PlannerView {
    /// The camera as it is drawn: with its sub-view, by the matrix that the renderer uses.
    ///
    /// # Errors
    /// [`Error::ScaledCamera`], and [`Error::Camera`] for a projection that is neither perspective
    /// nor orthographic.
    pub fn new(
        entity: Entity,
        (camera, projection, transform): (&Camera, &Projection, &GlobalTransform),
    ) -> Result<Self, Error> {
        check_scale(entity, transform)?;
        let refused = |reason| Error::Camera { camera: entity, reason };
        let matrix = plain(clip_from_view(camera, projection), projection);
        let mut frustum =
            Frustum::from_projection_matrix(matrix.to_cols_array_2d(), DepthConvention::ZeroToOne).map_err(refused)?;
        // Bevy's perspective has no far plane; meshes beyond this are not drawn.
        let far = f64::from(projection.far());
        if projection.far() <= FARTHEST && far > frustum.near {
            frustum.far = frustum.far.min(far);
        }
        let is_perspective = frustum.projection == umbrage::Projection::Perspective;
        let standoff = if is_perspective { 0.0 } else { STANDOFF * (frustum.far - frustum.near) - frustum.near };
        frustum.near += standoff;
        frustum.far += standoff;
        let matrix = transform.to_matrix().to_cols_array().map(f64::from);
        let world_from_eye = DMat4::from_cols_array(&matrix) * DMat4::from_translation(DVec3::new(0.0, 0.0, standoff));
        let view = View::from_world_from_view(world_from_eye, frustum).map_err(refused)?;
        let image_size = camera.physical_viewport_size().map_or(USUAL_SIZE, |size| size.to_array());
        Ok(Self { view, standoff, image_size: image_size.map(|pixels| pixels.max(1)) })
    }
}

/// The matrix that the renderer uses, or will use once the target is known.
fn clip_from_view(camera: &Camera, projection: &Projection) -> Mat4 {
    if camera.computed.target_info.is_some() {
        return camera.clip_from_view();
    }
    match &camera.sub_camera_view {
        Some(part) => projection.get_clip_from_view_for_sub(part),
        None => projection.get_clip_from_view(),
    }
}

/// The matrix without an oblique near plane, which only takes away from what is seen.
fn plain(mut matrix: Mat4, projection: &Projection) -> Mat4 {
    let is_oblique = matrix.x_axis.z != 0.0 || matrix.y_axis.z != 0.0;
    if let (true, Projection::Perspective(lens)) = (is_oblique, projection) {
        matrix.x_axis.z = 0.0;
        matrix.y_axis.z = 0.0;
        matrix.z_axis.z = 0.0;
        matrix.w_axis = Vec4::new(matrix.w_axis.x, matrix.w_axis.y, lens.near, 0.0);
    }
    matrix
}

fn check_scale(camera: Entity, transform: &GlobalTransform) -> Result<(), Error> {
    let axes = transform.affine().matrix3;
    let scales = [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.length());
    match scales.into_iter().max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())) {
        Some(scale) if scale.is_nan() || (scale - 1.0).abs() > MOST_SCALE => Err(Error::ScaledCamera { camera, scale }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use bevy_camera::{OrthographicProjection, PerspectiveProjection, SubCameraView};
    use bevy_math::{Rect, UVec2, Vec2, Vec3};
    use bevy_transform::components::Transform;

    use super::*;

    fn seen(camera: &Camera, projection: &Projection, transform: Transform) -> Result<PlannerView, Error> {
        PlannerView::new(Entity::PLACEHOLDER, (camera, projection, &transform.into()))
    }

    fn at() -> Transform {
        Transform::from_xyz(3.0, 2.0, 9.0).looking_at(Vec3::new(-1.0, 0.5, 0.0), Vec3::Y)
    }

    /// Where Bevy draws a point, in NDC, and its view depth.
    fn drawn(projection: &Projection, transform: &Transform, point: Vec3) -> (Vec2, f32) {
        let in_view = transform.to_matrix().inverse().transform_point3(point);
        (projection.get_clip_from_view().project_point3(in_view).truncate(), -in_view.z)
    }

    fn agrees(projection: &Projection, planned: &PlannerView, point: Vec3) -> bool {
        let (ndc, depth) = drawn(projection, &at(), point);
        let place = DVec3::new(point.x.into(), point.y.into(), point.z.into());
        let own = planned.view.clip_from_relative(DVec3::ZERO).project_point3(place);
        let off = Vec2::new(own.x as f32, own.y as f32).distance(ndc);
        let depth_off = planned.view.view_depth(place) - planned.standoff - f64::from(depth);
        off < 1e-4 && depth_off.abs() < 1e-4
    }

    #[test]
    fn perspective_and_orthographic_cameras_see_what_bevy_draws() {
        let area = Rect::new(-4.0, -3.0, 5.0, 2.0);
        let flat = |near| {
            Projection::from(OrthographicProjection { area, near, far: 50.0, ..OrthographicProjection::default_3d() })
        };
        let lens = PerspectiveProjection { aspect_ratio: 1.7, ..Default::default() };
        for projection in [lens.into(), flat(0.0), flat(-20.0), flat(3.0)] {
            let planned = seen(&Camera::default(), &projection, at()).expect("it is a camera");
            for point in [Vec3::ZERO, Vec3::new(1.0, 0.3, -4.0), Vec3::new(-2.0, 1.0, 3.0)] {
                assert!(agrees(&projection, &planned, point), "{projection:?} {point}");
            }
            assert!(planned.view.frustum().near > 0.0);
            // The comparison sees a camera that is turned by a thousandth.
            let turned = at().with_rotation(at().rotation * bevy_math::Quat::from_rotation_y(1e-3));
            let turned = seen(&Camera::default(), &projection, turned).expect("it is a camera");
            assert!(!agrees(&projection, &turned, Vec3::new(1.0, 0.3, -4.0)));
        }
    }

    #[test]
    fn far_is_that_of_the_projection_though_its_matrix_has_none() {
        let lens = PerspectiveProjection { far: 345.0, ..Default::default() };
        let planned = seen(&Camera::default(), &lens.into(), at()).expect("it is a camera");
        assert_eq!(planned.view.frustum().far, 345.0);
        let lens = PerspectiveProjection { far: f32::INFINITY, ..Default::default() };
        let planned = seen(&Camera::default(), &lens.into(), at()).expect("it is a camera");
        assert_eq!(planned.view.frustum().far, f64::INFINITY);
    }

    #[test]
    fn a_sub_view_is_that_part_of_the_whole() {
        let whole = Projection::from(PerspectiveProjection { aspect_ratio: 2.0, ..Default::default() });
        let part = SubCameraView {
            full_size: UVec2::new(200, 100),
            offset: Vec2::new(100.0, 0.0),
            size: UVec2::new(100, 100),
        };
        let camera = Camera { sub_camera_view: Some(part), ..Camera::default() };
        let planned = seen(&camera, &whole, at()).expect("it is a camera");
        let all = seen(&Camera::default(), &whole, at()).expect("it is a camera");
        let (part, all) = (planned.view.frustum(), all.view.frustum());
        assert!(part.left.abs() < 1e-6 && (part.right - all.right).abs() < 1e-6, "{part:?}");
    }

    #[test]
    fn an_oblique_near_plane_and_a_mirror_are_taken() {
        let mut lens = PerspectiveProjection::default();
        lens.near_clip_plane = Vec3::new(0.3, -0.5, -0.8).normalize().extend(-2.0);
        let straight = seen(&Camera::default(), &PerspectiveProjection::default().into(), at());
        assert_eq!(seen(&Camera::default(), &lens.into(), at()), straight);
        let mirrored = at().with_scale(Vec3::new(-1.0, 1.0, 1.0));
        assert!(seen(&Camera::default(), &PerspectiveProjection::default().into(), mirrored).is_ok());
    }

    #[test]
    fn a_scaled_camera_and_a_foreign_projection_are_refused() {
        let scaled = at().with_scale(Vec3::splat(2.0));
        let lens: Projection = PerspectiveProjection::default().into();
        assert!(
            matches!(seen(&Camera::default(), &lens, scaled), Err(Error::ScaledCamera { scale, .. }) if scale == 2.0)
        );
        let broken = PerspectiveProjection { fov: f32::NAN, ..Default::default() };
        assert!(matches!(seen(&Camera::default(), &broken.into(), at()), Err(Error::Camera { .. })));
    }
}
