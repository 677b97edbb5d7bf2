//! Camera paths: a line through a scene, walked at eye height.

use std::path::Path;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::read_file;
use crate::{Error, Result};

/// Distance in metres along the path from the eye to the target of a walker. Given by the command's
/// contract.
const LOOK_AHEAD_M: f64 = 20.0;

/// A polyline in the world, and the sun that its author gave the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    /// Direction towards the sun, as the file has it (not normalised); `None` if the file has none.
    pub sun_direction_to_light: Option<DVec3>,
    file: String,
    points: Vec<DVec3>,
    /// Metres along the path to each point; one more entry for the way back to the first if the
    /// path is closed.
    reached: Vec<f64>,
    closed: bool,
    /// Target for each point; empty if the path looks ahead.
    targets: Vec<DVec3>,
}

/// JSON of a path. Other keys are ignored.
#[derive(Deserialize, Serialize)]
struct PathFile {
    points: Vec<[f64; 3]>,
    #[serde(default)]
    closed: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sun_direction_to_light: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    targets: Vec<[f64; 3]>,
}

impl CameraPath {
    /// Reads a path: JSON with `points` (metres, on the ground), `closed` (default false),
    /// `sun_direction_to_light` and `targets` (see [`CameraPath::with_targets`]).
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Malformed`] if it is not such JSON, and as [`CameraPath::new`] and
    /// [`CameraPath::with_targets`].
    pub fn load(path: &Path) -> Result<Self> {
        Self::from_slice(&path.display().to_string(), &read_file(path)?)
    }

    /// Reads a path from memory. `name` stands for the file.
    ///
    /// # Errors
    /// As [`CameraPath::load`], but for [`Error::Read`].
    pub fn from_slice(name: &str, bytes: &[u8]) -> Result<Self> {
        let json: PathFile = serde_json::from_slice(bytes).map_err(|error| Error::Malformed {
            file: name.to_owned(),
            reason: format!("is not a camera path: {error}"),
        })?;
        let sun = json.sun_direction_to_light.map(DVec3::from);
        let path = Self::new(name, json.points.into_iter().map(DVec3::from).collect(), json.closed, sun)?;
        if json.targets.is_empty() {
            return Ok(path);
        }
        path.with_targets(json.targets.into_iter().map(DVec3::from).collect())
    }

    /// Gives each point a target of its own. Between points, the path looks at a point in between
    /// instead of ahead. Targets are as far above or below the path's points as the eye would be
    /// above or below its target.
    ///
    /// # Errors
    /// [`Error::CameraPath`] unless there is one finite target for each point.
    pub fn with_targets(self, targets: Vec<DVec3>) -> Result<Self> {
        let wrong = |element: String, reason: String| Error::CameraPath { file: self.file.clone(), element, reason };
        if targets.len() != self.points.len() {
            let reason = format!("there are {} for {} points; give one for each", targets.len(), self.points.len());
            return Err(wrong("targets".into(), reason));
        }
        if let Some(bad) = targets.iter().position(|target| !target.is_finite()) {
            return Err(wrong(format!("targets[{bad}]"), "holds a number that is not finite".into()));
        }
        Ok(Self { targets, ..self })
    }

    /// Writes the path as JSON that [`CameraPath::load`] reads.
    ///
    /// # Errors
    /// [`Error::CameraPath`] if the writer fails, which no valid path causes.
    pub fn to_json(&self) -> Result<String> {
        let file = PathFile {
            points: self.points.iter().map(DVec3::to_array).collect(),
            closed: self.closed,
            sun_direction_to_light: self.sun_direction_to_light.map(|sun| sun.to_array()),
            targets: self.targets.iter().map(DVec3::to_array).collect(),
        };
        let failed = |error: serde_json::Error| Error::CameraPath {
            file: self.file.clone(),
            element: "path".into(),
            reason: format!("cannot be written: {error}"),
        };
        serde_json::to_string(&file).map_err(failed)
    }

    /// Makes a path through `points`, back to the first if it is `closed`. `name` stands for the
    /// file in messages.
    ///
    /// # Errors
    /// [`Error::CameraPath`] if there are fewer than two different points, or numbers are not
    /// finite, or the sun has no direction.
    pub fn new(name: &str, points: Vec<DVec3>, closed: bool, sun_direction_to_light: Option<DVec3>) -> Result<Self> {
        let wrong = |element: String, reason: &str| Error::CameraPath {
            file: name.to_owned(),
            element,
            reason: reason.to_owned(),
        };
        if let Some(bad) = points.iter().position(|point| !point.is_finite()) {
            return Err(wrong(format!("points[{bad}]"), "holds a number that is not finite"));
        }
        if points.len() < 2 {
            return Err(wrong("points".into(), "there are fewer than 2; a path needs 2 or more"));
        }
        if sun_direction_to_light.is_some_and(|sun| !sun.is_finite() || sun == DVec3::ZERO) {
            return Err(wrong(
                "sun_direction_to_light".into(),
                "has no direction; give three finite numbers, not all 0",
            ));
        }
        let mut reached = vec![0.0];
        let behind = points[1..].iter().chain(closed.then_some(&points[0]));
        for (from, to) in points.iter().zip(behind) {
            reached.push(reached[reached.len() - 1] + from.distance(*to));
        }
        let path = Self { sun_direction_to_light, file: name.to_owned(), points, reached, closed, targets: Vec::new() };
        if !(path.length() > 0.0 && path.length().is_finite()) {
            return Err(wrong("points".into(), "all coincide, or lie too far apart; the path has no length"));
        }
        Ok(path)
    }

    /// Returns the length of the whole path in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.reached[self.reached.len() - 1]
    }

    /// Returns whether the path leads back to its first point.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Returns the points of the path, in metres.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Returns the point `distance` metres along the path. A closed path goes round and round. An
    /// open one goes straight on behind its last point and before its first.
    #[must_use]
    pub fn point_at(&self, distance: f64) -> DVec3 {
        self.between(&self.points, distance)
    }

    /// Interpolates values that belong to the path's points at `distance` metres along the path.
    fn between(&self, values: &[DVec3], distance: f64) -> DVec3 {
        let distance = if self.closed { distance.rem_euclid(self.length()) } else { distance };
        // The last segment that starts at or before the distance; segments of no length never
        // qualify for extrapolation.
        let segments = self.reached.len() - 1;
        let has_length = |s: &usize| self.reached[s + 1] > self.reached[*s];
        let segment = (0..segments)
            .filter(has_length)
            .take_while(|&s| s == 0 || self.reached[s] <= distance)
            .last()
            .or_else(|| (0..segments).find(has_length))
            .expect("a path has length, so some segment has");
        let (from, to) = (values[segment], values[(segment + 1) % values.len()]);
        let share = (distance - self.reached[segment]) / (self.reached[segment + 1] - self.reached[segment]);
        from.lerp(to, share)
    }

    /// Returns eye and target of frame `frame` of `frames`, `eye_height` metres above the path. The
    /// frames are spread evenly over its length: from the first point to the last, or once round
    /// without coming back to the first. The target is the point 20 m further on, at the same
    /// height above the path, or the path's own target ([`CameraPath::with_targets`]), raised
    /// likewise.
    ///
    /// # Errors
    /// [`Error::NoSuchElement`] if the frame is not below `frames`; [`Error::CameraPath`] if
    /// `eye_height` is not finite, the point 20 m further on is the very same (a closed path of 20
    /// m, for one), or either lies too far away for a number.
    pub fn pose_at(&self, frame: usize, frames: usize, eye_height: f64) -> Result<(DVec3, DVec3)> {
        if frame >= frames {
            return Err(Error::NoSuchElement { kind: "frame", index: frame, count: frames });
        }
        let wrong = |element: String, reason: String| Error::CameraPath { file: self.file.clone(), element, reason };
        if !eye_height.is_finite() {
            return Err(wrong("eye height".into(), format!("is {eye_height}; it has to be a finite number of metres")));
        }
        let steps = if self.closed { frames } else { (frames - 1).max(1) };
        let distance = self.length() * frame as f64 / steps as f64;
        let above = DVec3::Y * eye_height;
        let seen = match &self.targets[..] {
            [] => self.point_at(distance + LOOK_AHEAD_M),
            targets => self.between(targets, distance),
        };
        let (eye, target) = (self.point_at(distance) + above, seen + above);
        if !(eye.is_finite() && target.is_finite()) {
            let reason = "its eye or its target lies too far away for a number".to_owned();
            return Err(wrong(format!("frame {frame}"), reason));
        }
        if eye.distance(target) < 1e-9 * (1.0 + eye.length()) {
            let reason = match &self.targets[..] {
                [] => format!("the point {LOOK_AHEAD_M} m further on is the same, so the eye has nowhere to look"),
                _ => "its target is where the eye is, so the eye has nowhere to look".to_owned(),
            };
            return Err(wrong(format!("frame {frame}"), reason));
        }
        Ok((eye, target))
    }
}
