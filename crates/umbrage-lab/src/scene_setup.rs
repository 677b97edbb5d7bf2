//! The scene of a request, opened and posed, with its views and its lights, for `render`, `probe`
//! and `truth`.

use glam::DQuat;
use umbrage::{DirectionalLight, Frustum, Light, Projection, SunFade, View};
use umbrage_render::{Frame, Lamp};
use umbrage_scene::{CameraPath, Pose, Scene};

use crate::{
    choose::{named, several},
    failure::{Failure, Result},
    lights::{self, NamedLight},
    notes, open,
    report::{CameraReport, ShotReport, SunShown},
    scene_request::{CameraChoice, DEFAULT_FAR, DEFAULT_FOV, DEFAULT_NEAR, SceneRequest},
};

/// A scene at one moment, with its views and lights.
#[derive(Debug)]
pub struct SceneSetup {
    /// The scene.
    pub scene: Scene,
    /// Pose of the scene at `--time`.
    pub pose: Pose,
    /// Lights, at least one. Masks and probes are computed for the first.
    pub lights: Vec<NamedLight>,
    /// All lights but the first, for the renderer.
    pub more_lights: Vec<Lamp>,
    /// Shots: one, or one per frame.
    pub shots: Vec<Shot>,
    /// Notes of the loader, and on invented defaults.
    pub notes: Vec<String>,
    /// Number of the only frame that is shown, which is the last one of `shots`.
    only_frame: Option<u32>,
}

/// The camera of a frame, before its light is known.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameView {
    /// Number that the frame's files get.
    pub frame: Option<u32>,
    /// Name of the view's camera.
    pub camera: String,
    /// The view.
    pub view: View,
    /// Views beside the view, with the names of their cameras.
    pub beside: Vec<(String, View)>,
}

/// One view of the scene under its lights.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Number that the shot's files get.
    pub frame: Option<u32>,
    /// Name of the view's camera.
    pub camera: String,
    /// The view.
    pub view: View,
    /// Views beside the view, of the same moment, with the names of their cameras.
    pub beside: Vec<(String, View)>,
    /// The first light in this frame.
    pub light: Light,
    /// Suns whose shadows are shown, if the light is a sun: that sun, or one or two that follow it
    /// in steps.
    pub shown: Option<SunFade>,
}

impl Shot {
    /// Returns the view and those beside it, from left to right.
    pub fn views(&self) -> impl Iterator<Item = (&str, &View)> {
        let beside = self.beside.iter().map(|(camera, view)| (camera.as_str(), view));
        [(self.camera.as_str(), &self.view)].into_iter().chain(beside)
    }

    /// Returns the light whose maps are made.
    #[must_use]
    pub fn shown_light(&self) -> Light {
        self.shown.map_or(self.light, |fade| fade.to.into())
    }
}

impl SceneSetup {
    /// Opens the scene of a request, for subcommands that look through one camera.
    ///
    /// # Errors
    /// [`Failure::Input`] with the file or option at fault.
    pub fn open(request: &SceneRequest) -> Result<Self> {
        let setup = Self::open_views(request)?;
        if let Some(shot) = setup.shots.iter().find(|shot| !shot.beside.is_empty()) {
            let cameras: Vec<&str> = shot.views().map(|(camera, _)| camera).collect();
            return Err(Failure::input(format!(
                "--camera {}: only render and truth show several cameras beside each other; name one",
                cameras.join(",")
            )));
        }
        Ok(setup)
    }

    /// Opens the scene of a request, for subcommands that show several cameras side by side.
    ///
    /// # Errors
    /// [`Failure::Input`] with the file or option at fault.
    pub fn open_views(request: &SceneRequest) -> Result<Self> {
        let path = match &request.camera {
            CameraChoice::Path { file, .. } => Some(CameraPath::load(file)?),
            _ => None,
        };
        let scene = open::open(&request.scene, &request.files, request.move_scene)?;
        // At once, for they may say why what follows fails.
        notes::say(&scene.notes);
        let pose = scene.pose(request.time_s)?;
        let mut notes = scene.notes.clone();
        let frame_views = frame_views(request, &scene, &pose, path.as_ref(), &mut notes)?;
        let lights = lights::chosen(request, &scene, &pose, path.as_ref(), &mut notes)?;
        notes::say(&notes);
        let mut shots = under_the_light(request, frame_views, &lights)?;
        let views = shots.iter().flat_map(|shot| shot.views().map(|(_, view)| view));
        let pose = open::pose_seen(&scene, request.time_s, views, request.size)?.unwrap_or(pose);
        if let Some(only) = request.only_frame {
            let frames = shots.len();
            shots.truncate(only as usize + 1);
            if shots.last().is_none_or(|last| last.frame != request.only_frame) {
                return Err(Failure::input(format!(
                    "the report is of frame {only}, but its options ask for {frames}, from 0; give --frames {} or more",
                    u64::from(only) + 1
                )));
            }
        }
        Ok(Self { only_frame: request.only_frame, ..Self::new(scene, pose, lights, shots, notes) })
    }

    /// Makes a setup from its parts; `lights` has at least one.
    #[must_use]
    pub fn new(scene: Scene, pose: Pose, lights: Vec<NamedLight>, shots: Vec<Shot>, notes: Vec<String>) -> Self {
        let more_lights = lights.iter().skip(1).map(|light| light.lamp).collect();
        Self { scene, pose, lights, more_lights, shots, notes, only_frame: None }
    }

    /// Returns whether a shot is shown, and not drawn only for the frames after it.
    #[must_use]
    pub fn is_wanted(&self, shot: &Shot) -> bool {
        self.only_frame.is_none_or(|only| shot.frame == Some(only))
    }

    /// Returns the number that the files of a shot get, if several are shown.
    #[must_use]
    pub fn file_number(&self, shot: &Shot) -> Option<u32> {
        shot.frame.filter(|_| self.only_frame.is_none())
    }

    /// Makes a renderer's frame of one view of a shot.
    #[must_use]
    pub fn frame<'s>(&'s self, shot: &Shot, view: &'s View, shadows_on: bool, tint: bool) -> Frame<'s> {
        let light = Lamp { light: shot.light, ..self.lights[0].lamp };
        Frame { pose: &self.pose, moved: Some(&[]), view, light, more_lights: &self.more_lights, shadows_on, tint }
    }

    /// Makes the part of a report about scene, camera and sun.
    #[must_use]
    pub fn report(&self, request: &SceneRequest, shot: &Shot) -> ShotReport {
        ShotReport {
            scene: request.scene.clone(),
            options: request.options.clone(),
            time_s: request.time_s,
            frame: shot.frame,
            size: request.size,
            camera: camera_report(&shot.camera, &shot.view),
            sun: match shot.light {
                Light::Directional(sun) => Some(sun.direction().to_array()),
                Light::Spot(_) | Light::Point(_) => None,
            },
            lights: self.lights.iter().map(NamedLight::report).collect(),
            sun_shown: shot.shown.filter(|_| request.sun_travel.is_some()).map(|shown| SunShown {
                from: shown.from.direction().to_array(),
                to: shown.to.direction().to_array(),
                weight: shown.weight,
            }),
        }
    }
}

/// Makes every frame's views with their light. A moving sun keeps a single view over all frames.
fn under_the_light(
    request: &SceneRequest,
    mut frame_views: Vec<FrameView>,
    lights: &[NamedLight],
) -> Result<Vec<Shot>> {
    let first = lights[0].lamp.light;
    let shot =
        |FrameView { frame, camera, view, beside }, light, shown| Shot { frame, camera, view, beside, light, shown };
    let (travel, sun) = match (&request.sun_travel, first) {
        (Some(travel), Light::Directional(sun)) => (travel, sun),
        (Some(_), Light::Spot(_) | Light::Point(_)) => {
            return Err(Failure::input(format!(
                "--sun-to moves a sun, but --light {} is a spot or point light; give only one of the two",
                lights[0].name
            )));
        }
        (None, Light::Directional(sun)) => {
            let shown = Some(SunFade { from: sun, to: sun, weight: 1.0 });
            return Ok(frame_views.into_iter().map(|view| shot(view, first, shown)).collect());
        }
        (None, Light::Spot(_) | Light::Point(_)) => {
            return Ok(frame_views.into_iter().map(|view| shot(view, first, None)).collect());
        }
    };
    if let [only] = &frame_views[..] {
        frame_views = (0..travel.frames).map(|k| FrameView { frame: Some(k), ..only.clone() }).collect();
    }
    let turn = DQuat::from_rotation_arc(sun.direction(), travel.to.normalize());
    let last = frame_views.len().saturating_sub(1).max(1) as f64;
    let mut steps = travel.steps;
    let shots = (0..).zip(frame_views).map(|(k, view)| {
        let turned = DQuat::IDENTITY.slerp(turn, f64::from(k) / last) * sun.direction();
        let sun = DirectionalLight::new(turned)?;
        let shown = match &mut steps {
            Some(steps) => steps.follow(&sun, 1.0)?,
            None => SunFade { from: sun, to: sun, weight: 1.0 },
        };
        Ok(shot(view, sun.into(), Some(shown)))
    });
    shots.collect()
}

/// Makes the report of a camera.
#[must_use]
pub fn camera_report(name: &str, view: &View) -> CameraReport {
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

/// Returns the views that a request asks for.
///
/// # Errors
/// [`Failure::Input`] with the option or camera at fault.
pub fn frame_views(
    request: &SceneRequest,
    scene: &Scene,
    pose: &Pose,
    path: Option<&CameraPath>,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameView>> {
    let single = |camera: String, view: View| Ok(vec![FrameView { frame: None, camera, view, beside: Vec::new() }]);
    match (&request.camera, path) {
        (CameraChoice::LookAt { eye, target }, _) => {
            single("--eye, --target".into(), View::look_at_upright(*eye, *target, frustum(request)?)?)
        }
        (CameraChoice::Path { file, frames, eye_height }, Some(path)) => {
            let count = frames.unwrap_or(1);
            (0..count)
                .map(|k| {
                    let (eye, target) = path.pose_at(k as usize, count as usize, *eye_height)?;
                    Ok(FrameView {
                        frame: frames.map(|_| k),
                        camera: file.display().to_string(),
                        view: View::look_at_upright(eye, target, frustum(request)?)?,
                        beside: Vec::new(),
                    })
                })
                .collect()
        }
        (CameraChoice::Named(wanted), _) => {
            let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
            let views = several("--camera", "camera", wanted, &names)?.into_iter();
            let views = views.map(|i| Ok((named(names[i], i), scene_camera(request, scene, pose, i)?)));
            let mut views = views.collect::<Result<Vec<_>>>()?;
            let (camera, view) = views.remove(0);
            Ok(vec![FrameView { frame: None, camera, view, beside: views }])
        }
        _ if scene.cameras.is_empty() => {
            notes.push("the scene has no camera and none was given: invented one that sees all of it".into());
            let fov = request.fov.unwrap_or(DEFAULT_FOV).to_radians();
            single(
                "invented".into(),
                umbrage_scene::invented_view(pose, fov, request.aspect(), request.near, request.far)?,
            )
        }
        _ => {
            let name = named(&scene.cameras[0].name, 0);
            notes.push(format!("no camera was chosen: took the scene's first, {name}"));
            single(name, scene_camera(request, scene, pose, 0)?)
        }
    }
}

/// Makes a projection from the options alone.
fn frustum(request: &SceneRequest) -> Result<Frustum> {
    let fov = request.fov.unwrap_or(DEFAULT_FOV).to_radians();
    Ok(Frustum::perspective(
        fov,
        request.aspect(),
        request.near.unwrap_or(DEFAULT_NEAR),
        request.far.unwrap_or(DEFAULT_FAR),
    )?)
}

/// Returns the view of a camera of the scene, with the projection as changed by the options.
fn scene_camera(request: &SceneRequest, scene: &Scene, pose: &Pose, index: usize) -> Result<View> {
    let view = umbrage_scene::camera_view(scene, pose, index, request.aspect(), request.near, request.far)?;
    let (frustum, Some(fov)) = (view.frustum(), request.fov) else { return Ok(view) };
    if frustum.projection == Projection::Orthographic {
        return Err(Failure::input("--fov: the chosen camera is orthographic and has no angle; omit --fov"));
    }
    Ok(view.with_frustum(Frustum::perspective(fov.to_radians(), request.aspect(), frustum.near, frustum.far)?)?)
}
