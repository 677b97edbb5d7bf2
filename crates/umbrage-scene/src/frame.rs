//! Cameras and suns of a scene: its own, or invented ones.

use glam::DVec3;
use umbrage::{DirectionalLight, Frustum, Light, PointLight, SpotLight, View};

use crate::error::element;
use crate::{Error, Lens, LightKind, Pose, Result, Scene};

/// Size of an invented view relative to the scene. Ours: it leaves a border of a few pixels.
const FRAMING_MARGIN: f64 = 1.04;

/// Least near distance of an invented view, as a share of its far distance. Ours: a ten-thousandth
/// leaves room for a logarithmic split and precision for a 32-bit depth buffer.
const LEAST_NEAR_SHARE: f64 = 1e-4;

/// Makes the view of a camera of the scene, for a picture of `aspect` (width over height).
///
/// The vertical angle (or height) of the lens is kept and the width follows the picture. `near` and
/// `far` in metres take precedence over the camera's own; without either, far is infinite for a
/// perspective camera.
///
/// # Errors
/// [`Error::NoSuchElement`], [`Error::Camera`] if its node is flat, or [`Error::View`] if the
/// distances are not usable.
pub fn camera_view(
    scene: &Scene,
    pose: &Pose,
    index: usize,
    aspect: f64,
    near: Option<f64>,
    far: Option<f64>,
) -> Result<View> {
    let count = scene.cameras.len();
    let missing = || Error::NoSuchElement { kind: "camera", index, count };
    let camera = scene.cameras.get(index).ok_or_else(missing)?;
    let world_from_view = pose.world_from_node.get(camera.node).ok_or_else(missing)?;
    let frustum = match camera.lens {
        Lens::Perspective { yfov, znear, zfar, .. } => {
            Frustum::perspective(yfov, aspect, near.unwrap_or(znear), far.or(zfar).unwrap_or(f64::INFINITY))?
        }
        Lens::Orthographic { ymag, znear, zfar, .. } => {
            Frustum::orthographic(2.0 * ymag * aspect, 2.0 * ymag, near.unwrap_or(znear), far.unwrap_or(zfar))?
        }
    };
    View::from_world_from_view((*world_from_view).into(), frustum).map_err(|error| Error::Camera {
        scene: scene.name.clone(),
        camera: element("cameras", index, &camera.name),
        reason: format!(
            "{error}; check the transform of {}, or choose another camera",
            scene.node_element(camera.node)
        ),
    })
}

/// Returns the direction in which a light of the scene travels along its axis, as a unit vector in
/// the world.
///
/// # Errors
/// [`Error::NoSuchElement`], or [`Error::Light`] if it shines from a point to all sides or its node
/// has no direction.
pub fn light_direction(scene: &Scene, pose: &Pose, index: usize) -> Result<DVec3> {
    let count = scene.lights.len();
    let missing = || Error::NoSuchElement { kind: "light", index, count };
    let light = scene.lights.get(index).ok_or_else(missing)?;
    let world_from_light = pose.world_from_node.get(light.node).ok_or_else(missing)?;
    let unusable = |reason: &str| light_error(scene, index, reason);
    if light.kind == LightKind::Point {
        return Err(unusable("shines to all sides; choose a directional light, or give the sun's direction"));
    }
    let axis = world_from_light.matrix3.z_axis;
    // A scale may be tiny or huge; only a direction is wanted.
    (-axis / axis.abs().max_element())
        .try_normalize()
        .ok_or_else(|| unusable("stands on a node without a direction (its scale is 0)"))
}

/// Returns a light of the scene for the planner, in the world and at the moment of the pose: a
/// directional light along its node's −Z, a spot light with its outer cone, or a point light.
/// glTF's lights keep their range whatever their node's scale is. A light of unlimited range gets
/// the distance to the farthest corner of the posed objects.
///
/// # Errors
/// [`Error::NoSuchElement`]; [`Error::Light`] if its node has no direction, or if the light cannot
/// cast shadows (a cone wider than the planner takes).
pub fn scene_light(scene: &Scene, pose: &Pose, index: usize) -> Result<Light> {
    let count = scene.lights.len();
    let missing = || Error::NoSuchElement { kind: "light", index, count };
    let light = scene.lights.get(index).ok_or_else(missing)?;
    let position = pose.world_from_node.get(light.node).ok_or_else(missing)?.translation;
    let farthest = || {
        let corners = pose.bounds.map(|bounds| bounds.corners()).into_iter().flatten();
        corners.map(|corner| corner.distance(position)).fold(1.0, f64::max)
    };
    let range = light.range.unwrap_or_else(farthest);
    let made = match light.kind {
        LightKind::Directional => DirectionalLight::new(light_direction(scene, pose, index)?).map(Light::from),
        LightKind::Point => PointLight::new(position, range).map(Light::from),
        LightKind::Spot { outer, .. } => {
            SpotLight::new(position, light_direction(scene, pose, index)?, outer, range).map(Light::from)
        }
    };
    made.map_err(|error| light_error(scene, index, error.to_string()))
}

fn light_error(scene: &Scene, index: usize, reason: impl Into<String>) -> Error {
    let name = scene.lights.get(index).map_or("", |light| light.name.as_str());
    Error::Light { scene: scene.name.clone(), light: element("lights", index, name), reason: reason.into() }
}

/// Returns the direction in which the light of an invented sun travels, as a unit vector: from the
/// south-west, 45° up.
///
/// An invented view looks from the south-east, so shadows fall to the right, away from the eye.
#[must_use]
pub fn invented_sun() -> DVec3 {
    let (across, turn) = (std::f64::consts::FRAC_1_SQRT_2, 35_f64.to_radians());
    DVec3::new(across * turn.sin(), -across, -across * turn.cos())
}

/// Invents a view for scenes without a camera: from the south-east and a bit above, with the whole
/// scene in the picture.
///
/// `fov_y` is the full vertical angle in radians. `near` and `far` in metres follow from the scene
/// where they are `None`. A scene without triangles is looked at from 10 m away.
///
/// # Errors
/// [`Error::View`] if an angle, the aspect or a distance is out of range.
pub fn invented_view(pose: &Pose, fov_y: f64, aspect: f64, near: Option<f64>, far: Option<f64>) -> Result<View> {
    let (center, corners) = match pose.bounds {
        Some(bounds) => (bounds.center(), bounds.corners()),
        None => (DVec3::ZERO, [DVec3::ZERO; 8]),
    };
    // Checked before its sides are used.
    let lens = Frustum::perspective(fov_y, aspect, 1.0, 2.0)?;
    let back = DVec3::new(0.62, 0.45, 0.85).normalize();
    let axes = View::look_at_upright(center + back, center, lens)?.world_from_view_rotation();

    // The nearest eye on the line along `back` from which no corner lies outside a side of the
    // frustum.
    let mut distance: f64 = 0.0;
    let mut reach: f64 = 0.0;
    for corner in corners {
        let in_view = axes.transpose() * (corner - center);
        let outside = (in_view.x.abs() / lens.right).max(in_view.y.abs() / lens.top);
        distance = distance.max(outside * FRAMING_MARGIN + in_view.z);
        reach = reach.max(in_view.z.abs());
    }
    if distance <= 0.0 {
        distance = 10.0;
    }
    let farthest = (distance + reach) * 1.1;
    let far = far.unwrap_or(farthest);
    let nearest = (0.5 * (distance - reach)).max(farthest * LEAST_NEAR_SHARE);
    // A given far distance may end before the scene begins; the picture is then empty, not an
    // error.
    let near = near.unwrap_or(if nearest < far { nearest } else { far * 0.01 });
    let lens = Frustum::perspective(fov_y, aspect, near, far)?;
    Ok(View::look_at_upright(center + back * distance, center, lens)?)
}
