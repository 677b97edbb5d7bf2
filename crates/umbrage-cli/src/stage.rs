//! The scene of a job, opened and posed, with its views and its sun: what `render`, `probe` and `truth` have in common.

use glam::{DQuat, DVec3};
use umbrage::{DirectionalLight, Frustum, Projection, SunFade, View};
use umbrage_scene::{CameraPath, HeightMapOptions, LightKind, Pose, Scene};

use crate::{
    failure::{Failure, Result},
    job::{CameraChoice, DEFAULT_FAR, DEFAULT_FOV, DEFAULT_NEAR, SceneJob, SunChoice},
    report::{CameraReport, ShotReport, SunShown},
};

/// A scene at one moment, with everything that is to be looked at.
#[derive(Debug)]
pub struct Stage {
    /// The scene.
    pub scene: Scene,
    /// Posed at `--time`.
    pub pose: Pose,
    /// One, or one per frame.
    pub shots: Vec<Shot>,
    /// What the loader left out, and which defaults were invented.
    pub notes: Vec<String>,
}

/// Where the eye is in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// The number that its files get.
    pub frame: Option<u32>,
    /// Where the view comes from.
    pub camera: String,
    /// The view.
    pub view: View,
}

/// One view of the scene under its sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The number that its files get.
    pub frame: Option<u32>,
    /// Where the view comes from.
    pub camera: String,
    /// The view.
    pub view: View,
    /// Where the sun stands.
    pub sun: DirectionalLight,
    /// The suns whose shadows are shown: the same, or one or two that follow it in steps.
    pub shown: SunFade,
}

impl Stage {
    /// Reads the files that the job names.
    ///
    /// # Errors
    /// [`Failure::Input`] naming the file or option at fault.
    pub fn open(job: &SceneJob) -> Result<Self> {
        let height_map = HeightMapOptions {
            metres_per_post: job.metres_per_post,
            metres_per_unit: job.metres_per_unit,
            height_offset: job.height_offset,
        };
        let path = match &job.camera {
            CameraChoice::Path { file, .. } => Some(CameraPath::load(file)?),
            _ => None,
        };
        let scene = umbrage_scene::open(&job.scene, &height_map)?;
        let pose = scene.pose(job.time_s)?;
        let mut notes = scene.notes.clone();
        let places = places(job, &scene, &pose, path.as_ref(), &mut notes)?;
        let direction = sun(job, &scene, &pose, path.as_ref(), &mut notes)?;
        Ok(Self { shots: under_the_sun(job, places, direction)?, scene, pose, notes })
    }

    /// The part of a report that says what was looked at.
    #[must_use]
    pub fn report(&self, job: &SceneJob, shot: &Shot) -> ShotReport {
        ShotReport {
            scene: job.scene.clone(),
            time_s: job.time_s,
            frame: shot.frame,
            size: job.size,
            camera: camera_report(&shot.camera, &shot.view),
            sun: shot.sun.direction().to_array(),
            sun_shown: job.sun_travel.is_some().then(|| SunShown {
                from: shot.shown.from.direction().to_array(),
                to: shot.shown.to.direction().to_array(),
                weight: shot.shown.weight,
            }),
        }
    }
}

/// Every frame's view with its sun. A moving sun takes a single view along over all frames.
fn under_the_sun(job: &SceneJob, mut places: Vec<Place>, direction: DVec3) -> Result<Vec<Shot>> {
    let first = DirectionalLight::new(direction)?;
    let Some(travel) = &job.sun_travel else {
        let shown = SunFade { from: first, to: first, weight: 1.0 };
        let shot = |Place { frame, camera, view }| Shot { frame, camera, view, sun: first, shown };
        return Ok(places.into_iter().map(shot).collect());
    };
    if let [only] = &places[..] {
        places = (0..travel.frames).map(|k| Place { frame: Some(k), ..only.clone() }).collect();
    }
    let turn = DQuat::from_rotation_arc(first.direction(), travel.to.normalize());
    let last = places.len().saturating_sub(1).max(1) as f64;
    let mut steps = travel.steps;
    let shots = (0..).zip(places).map(|(k, Place { frame, camera, view })| {
        let turned = DQuat::IDENTITY.slerp(turn, f64::from(k) / last) * first.direction();
        let sun = DirectionalLight::new(turned)?;
        let shown = match &mut steps {
            Some(steps) => steps.follow(&sun, 1.0)?,
            None => SunFade { from: sun, to: sun, weight: 1.0 },
        };
        Ok(Shot { frame, camera, view, sun, shown })
    });
    shots.collect()
}

/// The eye, for a report.
pub(crate) fn camera_report(name: &str, view: &View) -> CameraReport {
    let frustum = view.frustum();
    CameraReport {
        name: name.to_owned(),
        eye: view.eye().to_array(),
        forward: view.forward().to_array(),
        up: view.world_from_view_rotation().y_axis.to_array(),
        fov: (frustum.projection == Projection::Perspective)
            .then(|| (frustum.top.atan() - frustum.bottom.atan()).to_degrees()),
        near: frustum.near,
        far: frustum.far.is_finite().then_some(frustum.far),
    }
}

/// The views that a job asks for.
pub(crate) fn places(
    job: &SceneJob,
    scene: &Scene,
    pose: &Pose,
    path: Option<&CameraPath>,
    notes: &mut Vec<String>,
) -> Result<Vec<Place>> {
    let single = |camera: String, view: View| Ok(vec![Place { frame: None, camera, view }]);
    match (&job.camera, path) {
        (CameraChoice::LookAt { eye, target }, _) => {
            single("--eye, --target".into(), View::look_at_upright(*eye, *target, frustum(job)?)?)
        }
        (CameraChoice::Path { file, frames, eye_height }, Some(path)) => {
            let count = frames.unwrap_or(1);
            (0..count)
                .map(|k| {
                    let (eye, target) = path.pose_at(k as usize, count as usize, *eye_height)?;
                    Ok(Place {
                        frame: frames.map(|_| k),
                        camera: file.display().to_string(),
                        view: View::look_at_upright(eye, target, frustum(job)?)?,
                    })
                })
                .collect()
        }
        (CameraChoice::Named(wanted), _) => {
            let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
            let index = select("--camera", "camera", wanted, &names)?;
            single(named(names[index], index), scene_camera(job, scene, pose, index)?)
        }
        _ if scene.cameras.is_empty() => {
            notes.push("the scene has no camera and none was given: invented one that sees all of it".into());
            let fov = job.fov.unwrap_or(DEFAULT_FOV).to_radians();
            single("invented".into(), umbrage_scene::invented_view(pose, fov, job.aspect(), job.near, job.far)?)
        }
        _ => {
            let name = named(&scene.cameras[0].name, 0);
            notes.push(format!("no camera was chosen: took the scene's first, {name}"));
            single(name, scene_camera(job, scene, pose, 0)?)
        }
    }
}

/// What the options alone say about the lens.
fn frustum(job: &SceneJob) -> Result<Frustum> {
    let fov = job.fov.unwrap_or(DEFAULT_FOV).to_radians();
    Ok(Frustum::perspective(fov, job.aspect(), job.near.unwrap_or(DEFAULT_NEAR), job.far.unwrap_or(DEFAULT_FAR))?)
}

/// A camera of the scene, with what the options change about its lens.
fn scene_camera(job: &SceneJob, scene: &Scene, pose: &Pose, index: usize) -> Result<View> {
    let view = umbrage_scene::camera_view(scene, pose, index, job.aspect(), job.near, job.far)?;
    let (frustum, Some(fov)) = (view.frustum(), job.fov) else { return Ok(view) };
    if frustum.projection == Projection::Orthographic {
        return Err(Failure::input("--fov: the chosen camera is orthographic and has no angle; leave --fov away"));
    }
    Ok(view.with_frustum(Frustum::perspective(fov.to_radians(), job.aspect(), frustum.near, frustum.far)?)?)
}

/// The way light travels.
pub(crate) fn sun(
    job: &SceneJob,
    scene: &Scene,
    pose: &Pose,
    path: Option<&CameraPath>,
    notes: &mut Vec<String>,
) -> Result<DVec3> {
    if let SunChoice::Given(direction) = job.sun {
        return Ok(direction);
    }
    if let SunChoice::Named(wanted) = &job.sun {
        let names: Vec<&str> = scene.lights.iter().map(|light| light.name.as_str()).collect();
        let index = select("--light", "light", wanted, &names)?;
        if scene.lights[index].kind != LightKind::Directional {
            return Err(Failure::input(format!(
                "--light {wanted}: only directional lights throw shadows here; choose one, or give --sun X,Y,Z"
            )));
        }
        return Ok(umbrage_scene::light_direction(scene, pose, index)?);
    }
    if let Some(to_light) = path.and_then(|path| path.sun_direction_to_light) {
        return Ok(-to_light);
    }
    match scene.lights.iter().position(|light| light.kind == LightKind::Directional) {
        Some(index) => Ok(umbrage_scene::light_direction(scene, pose, index)?),
        None => {
            let direction = umbrage_scene::invented_sun();
            notes.push(format!(
                "the scene has no directional light and no --sun was given: invented one that travels {:.3},{:.3},{:.3}",
                direction.x, direction.y, direction.z
            ));
            Ok(direction)
        }
    }
}

/// The index of the thing called `wanted`, or with that number.
fn select(option: &str, kind: &str, wanted: &str, names: &[&str]) -> Result<usize> {
    let by_name = names.iter().position(|name| *name == wanted);
    let by_index = || wanted.parse().ok().filter(|index| *index < names.len());
    by_name.or_else(by_index).ok_or_else(|| {
        let there = match names {
            [] => format!("the scene has no {kind}"),
            _ => {
                let list: Vec<String> = names.iter().enumerate().map(|(i, name)| named(name, i)).collect();
                format!("there is no {kind} of that name or number; there are {}", list.join(", "))
            }
        };
        Failure::input(format!("{option} {wanted}: {there}"))
    })
}

/// A name for people, for things that may have none.
fn named(name: &str, index: usize) -> String {
    if name.is_empty() { index.to_string() } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_before_numbers() {
        let names = ["front", "0", ""];
        assert_eq!(select("--camera", "camera", "front", &names), Ok(0));
        assert_eq!(select("--camera", "camera", "0", &names), Ok(1));
        assert_eq!(select("--camera", "camera", "2", &names), Ok(2));
        let error = select("--camera", "camera", "3", &names).expect_err("there is no fourth").to_string();
        assert!(error.contains("--camera 3") && error.contains("front, 0, 2"), "{error}");
        assert!(select("--camera", "camera", "-1", &names).is_err());
        assert!(select("--light", "light", "0", &[]).is_err());
    }
}
