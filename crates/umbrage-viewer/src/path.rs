//! Camera paths: recorded in flight, followed again here and by `umbrage render --path`.

use glam::DVec3;
use umbrage::{Frustum, View};
use umbrage_scene::CameraPath;

/// Height of the eye over a path's points in metres, the default of the command's `--eye-height`.
pub const EYE_HEIGHT_M: f64 = 2.0;
/// Distance in metres from the eye to its target.
const TARGET_M: f64 = 20.0;
/// Least distance between two points in metres.
const LEAST_STEP_M: f64 = 0.05;
/// Number of steps over the whole of a path that is followed.
const STEPS: usize = 1 << 20;

/// A path that is being recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    points: Vec<DVec3>,
    targets: Vec<DVec3>,
}

impl Recording {
    /// Records the position of the eye, if it has moved.
    pub fn pass(&mut self, view: &View) {
        let below = DVec3::Y * EYE_HEIGHT_M;
        let point = view.eye() - below;
        let target = point + view.forward() * TARGET_M;
        match (self.points.last(), self.targets.last_mut()) {
            // Who stands and turns looks elsewhere from the same point.
            (Some(last), Some(looked)) if last.distance(point) < LEAST_STEP_M => *looked = target,
            _ => {
                self.points.push(point);
                self.targets.push(target);
            }
        }
    }

    /// Returns the number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the path, with the sun whose light travels along `sun_travel`.
    ///
    /// # Errors
    /// If the camera has not moved.
    pub fn finish(self, sun_travel: Option<DVec3>) -> Result<CameraPath, String> {
        if self.len() < 2 {
            return Err("nothing was recorded: the camera has not moved".to_owned());
        }
        let path = CameraPath::new("recorded", self.points, false, sun_travel.map(|travel| -travel));
        path.and_then(|path| path.with_targets(self.targets)).map_err(|error| error.to_string())
    }
}

/// A path that is being followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Following {
    path: CameraPath,
    eye_height: f64,
    /// Share of the path that is behind the eye, 0 to 1.
    pub share: f64,
}

impl Following {
    /// Starts at the beginning of a path, `eye_height` metres above its points.
    #[must_use]
    pub fn new(path: CameraPath, eye_height: f64) -> Self {
        Self { path, eye_height, share: 0.0 }
    }

    /// Advances along the path. An open path ends, a closed one begins again. Returns false at the
    /// end.
    pub fn advance(&mut self, metres: f64) -> bool {
        let next = self.share + metres.max(0.0) / self.path.length();
        let goes_on = self.path.is_closed() || next < 1.0;
        self.share = if self.path.is_closed() { next.rem_euclid(1.0) } else { next.min(1.0) };
        goes_on
    }

    /// Returns the view at the current position through a projection; `None` where the path gives
    /// no direction.
    #[must_use]
    pub fn view(&self, lens: Frustum) -> Option<View> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of the steps")]
        let step = (self.share.clamp(0.0, 1.0) * (STEPS - 1) as f64) as usize;
        let (eye, target) = self.path.pose_at(step, STEPS, self.eye_height).ok()?;
        View::look_at_upright(eye, target, lens).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens() -> Frustum {
        Frustum::perspective(1.0, 1.5, 0.5, 500.0).expect("valid")
    }

    fn look(eye: DVec3, target: DVec3) -> View {
        View::look_at_upright(eye, target, lens()).expect("valid")
    }

    #[test]
    fn a_flight_is_followed_as_it_was_flown() {
        let views = [
            look(DVec3::new(0.0, 5.0, 0.0), DVec3::new(10.0, 5.0, 0.0)),
            look(DVec3::new(10.0, 5.0, 0.0), DVec3::new(10.0, 2.0, -10.0)),
            look(DVec3::new(10.0, 8.0, -20.0), DVec3::new(0.0, 0.0, -20.0)),
        ];
        let mut recording = Recording::default();
        views.iter().for_each(|view| recording.pass(view));
        assert_eq!(recording.len(), 3);
        let path = recording.finish(Some(DVec3::new(1.0, -1.0, 0.0))).expect("a path");
        assert_eq!(path.sun_direction_to_light, Some(DVec3::new(-1.0, 1.0, 0.0)));
        let mut following = Following::new(path, EYE_HEIGHT_M);
        let first = following.view(lens()).expect("a view");
        assert!(first.eye().distance(views[0].eye()) < 1e-9 && first.forward().distance(views[0].forward()) < 1e-9);
        assert!(!following.advance(1e9), "the path ends");
        let last = following.view(lens()).expect("a view");
        assert!(last.eye().distance(views[2].eye()) < 1e-9 && last.forward().distance(views[2].forward()) < 1e-9);
    }

    #[test]
    fn who_stands_records_nothing() {
        let mut recording = Recording::default();
        assert!(recording.clone().finish(None).is_err() && recording.is_empty());
        for turn in 0..5 {
            recording.pass(&look(DVec3::Y, DVec3::new(f64::from(turn), 1.0, -5.0)));
        }
        assert_eq!(recording.len(), 1);
        assert!(recording.finish(None).expect_err("no path").contains("has not moved"));
    }
}
