//! The camera: it flies freely or orbits a point.

use glam::{DQuat, DVec2, DVec3};
use umbrage::{Aabb, Frustum, Projection, View};

/// Largest angle in radians at which a camera looks up or down. Straight up has no upright.
const STEEPEST: f64 = 89.5 * std::f64::consts::PI / 180.0;
/// Rotation in radians while the pointer crosses the picture's height.
const TURN_PER_HEIGHT: f64 = 1.6;
/// Share of the distance to the pivot that one notch of a wheel covers.
const ZOOM_PER_NOTCH: f64 = 0.12;
/// Least distance to the pivot in metres.
const LEAST_DISTANCE_M: f64 = 0.05;
/// Seconds to cross a new scene at its default speed.
const CROSSING_S: f64 = 25.0;
/// Range of speeds in metres per second.
pub const SPEEDS_M_S: std::ops::RangeInclusive<f64> = 0.1..=2000.0;

/// Effect of dragging the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Turns the camera.
    #[default]
    Fly,
    /// Moves the camera around the pivot.
    Orbit,
}

/// Motion of the camera in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Rotation by dragging, in picture heights: right and down.
    pub turn: DVec2,
    /// Translation by dragging, in picture heights: right and down. The picture moves along.
    pub pan: DVec2,
    /// Wheel notches towards the pivot.
    pub zoom: f64,
    /// Walking direction: right, up and forwards, −1 to 1 each.
    pub walk: DVec3,
    /// Duration of the walk in seconds.
    pub seconds: f64,
    /// Factor of the walking speed.
    pub haste: f64,
}

impl Motion {
    /// Returns whether the motion is empty.
    #[must_use]
    pub fn is_still(&self) -> bool {
        (self.turn, self.pan, self.zoom, self.walk) == (DVec2::ZERO, DVec2::ZERO, 0.0, DVec3::ZERO)
    }
}

/// A view that the user moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    view: View,
    /// Distance to the pivot in metres.
    distance: f64,
    /// Effect of dragging.
    pub mode: Mode,
    /// Speed in metres per second.
    pub speed: f64,
}

impl Camera {
    /// Makes a camera at a view of a scene with these bounds.
    #[must_use]
    pub fn new(view: View, bounds: Option<Aabb>) -> Self {
        let across = bounds.map_or(100.0, |bounds| (bounds.max - bounds.min).length());
        let mut camera = Self {
            view,
            distance: 1.0,
            mode: Mode::default(),
            speed: (across / CROSSING_S).clamp(*SPEEDS_M_S.start(), *SPEEDS_M_S.end()),
        };
        let to_middle = bounds.map_or(10.0, |bounds| (bounds.center() - view.eye()).dot(view.forward()));
        camera.distance = to_middle.abs().clamp(0.05 * across.max(1.0), across.max(1.0));
        camera
    }

    /// Returns the view.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Moves the camera to a view. Speed and mode stay.
    pub fn jump(&mut self, view: View) {
        self.view = view;
    }

    /// Returns the pivot: the point that the camera orbits.
    #[must_use]
    pub fn pivot(&self) -> DVec3 {
        self.view.eye() + self.view.forward() * self.distance
    }

    /// Sets the pivot, if the point lies in front of the eye.
    pub fn set_pivot(&mut self, point: DVec3) {
        let depth = self.view.view_depth(point);
        if depth > LEAST_DISTANCE_M {
            self.distance = depth;
        }
    }

    /// Moves the camera. A motion that leads to no valid view has no effect.
    pub fn apply(&mut self, motion: &Motion) {
        if motion.is_still() {
            return;
        }
        let pivot = self.pivot();
        let axes = self.view.world_from_view_rotation();
        let mut eye = self.view.eye();
        let mut forward = self.view.forward();
        if motion.turn != DVec2::ZERO {
            forward = turned(forward, motion.turn * TURN_PER_HEIGHT * if self.mode == Mode::Fly { 0.6 } else { 1.0 });
            if self.mode == Mode::Orbit {
                eye = pivot - forward * self.distance;
            }
        }
        let lens = self.view.frustum();
        let height_m = (lens.top - lens.bottom) * lens.scale_at(self.distance);
        eye += (axes.y_axis * motion.pan.y - axes.x_axis * motion.pan.x) * height_m;
        if motion.zoom != 0.0 {
            let nearer = self.distance * (1.0 - ZOOM_PER_NOTCH).powf(motion.zoom);
            let nearer = nearer.max(LEAST_DISTANCE_M);
            match lens.projection {
                Projection::Perspective => {
                    eye += forward * (self.distance - nearer);
                    // A bird's pivot flies before it; it would be stuck at a point otherwise.
                    if self.mode == Mode::Orbit {
                        self.distance = nearer;
                    }
                }
                Projection::Orthographic => self.zoom_lens(nearer / self.distance),
            }
        }
        if motion.walk != DVec3::ZERO {
            let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(axes.x_axis);
            let way = right * motion.walk.x + DVec3::Y * motion.walk.y + forward * motion.walk.z;
            eye += way.clamp_length_max(1.0) * self.speed * motion.haste.max(0.0) * motion.seconds.max(0.0);
        }
        if let Ok(view) = View::look_at_upright(eye, eye + forward, *self.view.frustum()) {
            self.view = view;
        }
    }

    /// Widens an orthographic projection by a factor.
    fn zoom_lens(&mut self, by: f64) {
        let lens = *self.view.frustum();
        let wider = Frustum {
            left: lens.left * by,
            right: lens.right * by,
            bottom: lens.bottom * by,
            top: lens.top * by,
            ..lens
        };
        if let Ok(view) = self.view.with_frustum(wider) {
            self.view = view;
        }
    }

    /// Adapts the projection to a picture of this width over height. The vertical extent stays.
    pub fn set_aspect(&mut self, aspect: f64) {
        let lens = *self.view.frustum();
        let (middle, half) = (0.5 * (lens.left + lens.right), 0.5 * (lens.top - lens.bottom) * aspect);
        let fitted = Frustum { left: middle - half, right: middle + half, ..lens };
        let same = (fitted.left - lens.left).abs() + (fitted.right - lens.right).abs() <= 1e-12 * half;
        if let (false, Ok(view)) = (same, self.view.with_frustum(fitted)) {
            self.view = view;
        }
    }

    /// Returns the full vertical angle in degrees of a perspective projection.
    #[must_use]
    pub fn fov_degrees(&self) -> Option<f64> {
        let lens = self.view.frustum();
        (lens.projection == Projection::Perspective).then(|| (lens.top.atan() - lens.bottom.atan()).to_degrees())
    }

    /// Sets the full vertical angle in degrees.
    pub fn set_fov_degrees(&mut self, degrees: f64) {
        let lens = *self.view.frustum();
        let aspect = (lens.right - lens.left) / (lens.top - lens.bottom);
        let wanted = Frustum::perspective(degrees.to_radians(), aspect, lens.near, lens.far);
        if let Ok(view) = wanted.and_then(|lens| self.view.with_frustum(lens)) {
            self.view = view;
        }
    }
}

/// Rotates a direction right and down by angles in radians, but never over the top.
fn turned(forward: DVec3, by: DVec2) -> DVec3 {
    let pitch = forward.y.clamp(-1.0, 1.0).asin();
    let level = DVec3::new(forward.x, 0.0, forward.z).try_normalize().unwrap_or(DVec3::NEG_Z);
    let level = DQuat::from_rotation_y(-by.x) * level;
    let (sine, cosine) = (pitch - by.y).clamp(-STEEPEST, STEEPEST).sin_cos();
    level * cosine + DVec3::Y * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(mode: Mode) -> Camera {
        let lens = Frustum::perspective(1.0, 1.5, 0.5, 500.0).expect("valid");
        let view = View::look_at_upright(DVec3::new(0.0, 5.0, 20.0), DVec3::new(0.0, 5.0, 0.0), lens).expect("valid");
        let bounds = Aabb::new(DVec3::splat(-10.0), DVec3::splat(10.0));
        Camera { mode, ..Camera::new(view, Some(bounds)) }
    }

    #[test]
    fn a_bird_turns_its_head_and_stays() {
        let mut bird = camera(Mode::Fly);
        let eye = bird.view().eye();
        bird.apply(&Motion { turn: DVec2::new(0.2, 0.0), ..Motion::default() });
        assert_eq!(bird.view().eye(), eye);
        assert!(bird.view().forward().x > 0.1, "to the right: {}", bird.view().forward());
        bird.apply(&Motion { turn: DVec2::new(0.0, 50.0), ..Motion::default() });
        assert!(bird.view().forward().y < -0.99 && bird.view().forward().is_finite());
    }

    #[test]
    fn going_around_keeps_the_pivot() {
        let mut orbit = camera(Mode::Orbit);
        let (pivot, eye) = (orbit.pivot(), orbit.view().eye());
        for turn in [DVec2::new(0.3, 0.1), DVec2::new(-1.0, 0.4), DVec2::new(0.0, -5.0)] {
            orbit.apply(&Motion { turn, ..Motion::default() });
            assert!(orbit.pivot().distance(pivot) < 1e-9 && orbit.view().eye() != eye);
        }
        orbit.apply(&Motion { zoom: 3.0, ..Motion::default() });
        assert!(orbit.pivot().distance(pivot) < 1e-9 && orbit.view().eye().distance(pivot) < eye.distance(pivot));
        orbit.apply(&Motion { zoom: 1e6, ..Motion::default() });
        assert!(orbit.view().eye().is_finite() && orbit.pivot().distance(pivot) < 1e-6);
    }

    #[test]
    fn steps_go_where_the_eye_looks() {
        let mut bird = camera(Mode::Fly);
        let before = bird.view().eye();
        let step = Motion { walk: DVec3::Z, seconds: 0.5, haste: 2.0, ..Motion::default() };
        bird.apply(&step);
        let moved = bird.view().eye() - before;
        assert!((moved - DVec3::NEG_Z * bird.speed).length() < 1e-9, "{moved}");
        bird.apply(&Motion { walk: DVec3::X, seconds: f64::NAN, haste: 1.0, ..Motion::default() });
        assert!(bird.view().eye().is_finite());
    }

    #[test]
    fn a_wider_window_shows_more_beside() {
        let mut bird = camera(Mode::Fly);
        let lens = *bird.view().frustum();
        bird.set_aspect(3.0);
        let wide = *bird.view().frustum();
        assert_eq!((wide.top, wide.bottom), (lens.top, lens.bottom));
        assert!((wide.right - 2.0 * lens.right).abs() < 1e-12);
        bird.set_aspect(f64::NAN);
        assert_eq!(*bird.view().frustum(), wide, "a window without height changes nothing");
        bird.set_fov_degrees(90.0);
        assert!((bird.fov_degrees().expect("perspective") - 90.0).abs() < 1e-9);
        bird.set_fov_degrees(400.0);
        assert!((bird.fov_degrees().expect("perspective") - 90.0).abs() < 1e-9);
    }
}
