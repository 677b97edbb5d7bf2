//! The scene of a job, opened and posed, with its views and its lights: what `render`, `probe` and `truth` have in common.

use glam::DQuat;
use umbrage::{DirectionalLight, Frustum, Light, Projection, SunFade, View};
use umbrage_render::{Frame, Lamp};
use umbrage_scene::{CameraPath, Pose, Scene};

use crate::{
    failure::{Failure, Result},
    lights::{self, NamedLight},
    notes,
    report::{CameraReport, ShotReport, SunShown},
    scene_job::{CameraChoice, DEFAULT_FAR, DEFAULT_FOV, DEFAULT_NEAR, SceneJob},
};

/// A scene at one moment, with everything that is to be looked at.
#[derive(Debug)]
pub struct Stage {
    /// The scene.
    pub scene: Scene,
    /// Posed at `--time`.
    pub pose: Pose,
    /// The lights, one at least; masks and probes are of the first.
    pub lights: Vec<NamedLight>,
    /// All but the first, as the renderer takes them.
    pub more_lights: Vec<Lamp>,
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
    /// Views beside it, with their cameras.
    pub beside: Vec<(String, View)>,
}

/// One view of the scene under its lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// The number that its files get.
    pub frame: Option<u32>,
    /// Where the view comes from.
    pub camera: String,
    /// The view.
    pub view: View,
    /// Views beside it, of the same moment: the cameras that they come from, and they.
    pub beside: Vec<(String, View)>,
    /// The first light in this frame.
    pub light: Light,
    /// If it is a sun, the suns whose shadows are shown: the same, or one or two that follow it in steps.
    pub shown: Option<SunFade>,
}

impl Shot {
    /// The view and those beside it, from left to right.
    pub fn views(&self) -> impl Iterator<Item = (&str, &View)> {
        let beside = self.beside.iter().map(|(camera, view)| (camera.as_str(), view));
        [(self.camera.as_str(), &self.view)].into_iter().chain(beside)
    }

    /// The light whose maps are made.
    #[must_use]
    pub fn shown_light(&self) -> Light {
        self.shown.map_or(self.light, |fade| fade.to.into())
    }
}

impl Stage {
    /// Reads the files that the job names, for subcommands that look through one camera.
    ///
    /// # Errors
    /// [`Failure::Input`] naming the file or option at fault.
    pub fn open(job: &SceneJob) -> Result<Self> {
        let stage = Self::open_views(job)?;
        if let Some(shot) = stage.shots.iter().find(|shot| !shot.beside.is_empty()) {
            let cameras: Vec<&str> = shot.views().map(|(camera, _)| camera).collect();
            return Err(Failure::input(format!(
                "--camera {}: only render and truth show several cameras beside each other; name one",
                cameras.join(",")
            )));
        }
        Ok(stage)
    }

    /// The same for those that show several cameras side by side.
    ///
    /// # Errors
    /// [`Failure::Input`] naming the file or option at fault.
    pub fn open_views(job: &SceneJob) -> Result<Self> {
        let path = match &job.camera {
            CameraChoice::Path { file, .. } => Some(CameraPath::load(file)?),
            _ => None,
        };
        let scene = umbrage_scene::open(&job.scene, &job.open_options())?;
        // At once, for they may say why what follows fails.
        notes::say(&scene.notes);
        let scene = match job.move_scene {
            Some(by) => scene.moved(by),
            None => scene,
        };
        let pose = scene.pose(job.time_s)?;
        let mut notes = scene.notes.clone();
        let places = places(job, &scene, &pose, path.as_ref(), &mut notes)?;
        let lights = lights::chosen(job, &scene, &pose, path.as_ref(), &mut notes)?;
        notes::say(&notes);
        let shots = under_the_light(job, places, &lights)?;
        Ok(Self::new(scene, pose, lights, shots, notes))
    }

    /// A stage from its parts; `lights` has one at least.
    #[must_use]
    pub fn new(scene: Scene, pose: Pose, lights: Vec<NamedLight>, shots: Vec<Shot>, notes: Vec<String>) -> Self {
        let more_lights = lights.iter().skip(1).map(|light| light.lamp).collect();
        Self { scene, pose, lights, more_lights, shots, notes }
    }

    /// What the renderer is told about one view of a shot.
    #[must_use]
    pub fn frame<'s>(&'s self, shot: &Shot, view: &'s View, shadows_on: bool, tint: bool) -> Frame<'s> {
        let light = Lamp { light: shot.light, ..self.lights[0].lamp };
        Frame { pose: &self.pose, view, light, more_lights: &self.more_lights, shadows_on, tint }
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
            sun: match shot.light {
                Light::Directional(sun) => Some(sun.direction().to_array()),
                Light::Spot(_) | Light::Point(_) => None,
            },
            lights: self.lights.iter().map(NamedLight::report).collect(),
            sun_shown: shot.shown.filter(|_| job.sun_travel.is_some()).map(|shown| SunShown {
                from: shown.from.direction().to_array(),
                to: shown.to.direction().to_array(),
                weight: shown.weight,
            }),
        }
    }
}

/// Every frame's views with their light. A moving sun takes a single view along over all frames.
fn under_the_light(job: &SceneJob, mut places: Vec<Place>, lights: &[NamedLight]) -> Result<Vec<Shot>> {
    let first = lights[0].lamp.light;
    let shot = |Place { frame, camera, view, beside }, light, shown| Shot { frame, camera, view, beside, light, shown };
    let (travel, sun) = match (&job.sun_travel, first) {
        (Some(travel), Light::Directional(sun)) => (travel, sun),
        (Some(_), Light::Spot(_) | Light::Point(_)) => {
            return Err(Failure::input(format!(
                "--sun-to moves a sun, but --light {} is a spot or point light; leave one of them away",
                lights[0].name
            )));
        }
        (None, Light::Directional(sun)) => {
            let shown = Some(SunFade { from: sun, to: sun, weight: 1.0 });
            return Ok(places.into_iter().map(|place| shot(place, first, shown)).collect());
        }
        (None, Light::Spot(_) | Light::Point(_)) => {
            return Ok(places.into_iter().map(|place| shot(place, first, None)).collect());
        }
    };
    if let [only] = &places[..] {
        places = (0..travel.frames).map(|k| Place { frame: Some(k), ..only.clone() }).collect();
    }
    let turn = DQuat::from_rotation_arc(sun.direction(), travel.to.normalize());
    let last = places.len().saturating_sub(1).max(1) as f64;
    let mut steps = travel.steps;
    let shots = (0..).zip(places).map(|(k, place)| {
        let turned = DQuat::IDENTITY.slerp(turn, f64::from(k) / last) * sun.direction();
        let sun = DirectionalLight::new(turned)?;
        let shown = match &mut steps {
            Some(steps) => steps.follow(&sun, 1.0)?,
            None => SunFade { from: sun, to: sun, weight: 1.0 },
        };
        Ok(shot(place, sun.into(), Some(shown)))
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
    let single = |camera: String, view: View| Ok(vec![Place { frame: None, camera, view, beside: Vec::new() }]);
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
                        beside: Vec::new(),
                    })
                })
                .collect()
        }
        (CameraChoice::Named(wanted), _) => {
            let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
            let views = several("--camera", "camera", wanted, &names)?.into_iter();
            let views = views.map(|i| Ok((named(names[i], i), scene_camera(job, scene, pose, i)?)));
            let mut views = views.collect::<Result<Vec<_>>>()?;
            let (camera, view) = views.remove(0);
            Ok(vec![Place { frame: None, camera, view, beside: views }])
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

/// The indices of one thing called `wanted`, whatever is in its name, or of several between commas; one at least.
pub(crate) fn several(option: &str, kind: &str, wanted: &str, names: &[&str]) -> Result<Vec<usize>> {
    if names.contains(&wanted) || !wanted.contains(',') {
        return Ok(vec![select(option, kind, wanted, names)?]);
    }
    let mut indices = Vec::new();
    for part in wanted.split(',') {
        let index = select(option, kind, part, names)?;
        if indices.contains(&index) {
            return Err(Failure::input(format!(
                "{option} {wanted}: {part} is in the list twice; leave one of them away"
            )));
        }
        indices.push(index);
    }
    Ok(indices)
}

/// The index of the thing called `wanted`, or with that number.
pub(crate) fn select(option: &str, kind: &str, wanted: &str, names: &[&str]) -> Result<usize> {
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
pub(crate) fn named(name: &str, index: usize) -> String {
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
        assert_eq!(several("--camera", "camera", "front,2", &names), Ok(vec![0, 2]));
        assert_eq!(several("--camera", "camera", "a,b", &["b", "a,b"]), Ok(vec![1]), "a name may have a comma");
        let error = several("--camera", "camera", "front,2,front", &names).expect_err("twice").to_string();
        assert!(error.contains("front is in the list twice"), "{error}");
    }
}
