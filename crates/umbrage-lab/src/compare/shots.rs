//! Views of a comparison: cameras × suns, along paths or a few steps, scene by scene.

use std::path::Path;

use glam::{DQuat, DVec3};
use umbrage::{DirectionalLight, Light, Projection, View};
use umbrage_render::Lamp;
use umbrage_scene::{CameraPath, Pose, Scene};

use crate::{
    failure::{Failure, Result},
    lights::{self, NamedLight},
    notes, open,
    scene_request::{CameraChoice, SceneRequest},
    scene_setup,
};

/// Default elevation of `into` in degrees.
const INTO_ELEVATION: f64 = 11.0;

/// Elevations of the suns of `metrics` in degrees.
const METRICS_ELEVATIONS: [f64; 2] = [43.0, 11.0];

/// One value of `--suns`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunSpec {
    /// The scene's own sun, or the one that `--sun` or `--light` chooses.
    Own,
    /// A sun at this elevation, at a bearing from north by east or at the own sun's, in degrees.
    At {
        /// Elevation above the horizon in degrees.
        elevation: f64,
        /// Bearing in degrees; north is −Z, east is +X.
        bearing: Option<f64>,
    },
    /// A sun ahead of the camera at this elevation in degrees, so that light and eye nearly meet.
    Into(f64),
    /// Two suns for every camera, and one view into the light for each scene.
    Metrics,
}

/// Reads a value of `--suns`: `own`, `43`, `43@120`, `into`, `into@30`, `metrics`.
pub fn sun_spec(text: &str) -> Result<SunSpec, String> {
    let text = text.trim();
    let number = |text: &str, what: &str, range: std::ops::RangeInclusive<f64>| match text.trim().parse::<f64>() {
        Ok(value) if range.contains(&value) => Ok(value),
        Ok(value) => Err(format!("{what} {value} is out of range; give {} to {} degrees", range.start(), range.end())),
        Err(_) => Err(format!("{text:?} is not a {what} in degrees; give own, 43, 43@120, into, into@30 or metrics")),
    };
    let elevation = |text: &str| number(text, "elevation", 0.1..=90.0);
    match (text, text.split_once('@')) {
        ("own", _) => Ok(SunSpec::Own),
        ("metrics", _) => Ok(SunSpec::Metrics),
        ("into", _) => Ok(SunSpec::Into(INTO_ELEVATION)),
        (_, Some(("into", up))) => Ok(SunSpec::Into(elevation(up)?)),
        (_, Some((up, bearing))) => {
            Ok(SunSpec::At { elevation: elevation(up)?, bearing: Some(number(bearing, "bearing", -360.0..=360.0)?) })
        }
        _ => Ok(SunSpec::At { elevation: elevation(text)?, bearing: None }),
    }
}

/// A scene with all its views.
#[derive(Debug)]
pub struct SceneShots {
    /// Scene as it was named.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// Pose of the scene at `--time`.
    pub pose: Pose,
    /// Cameras under suns.
    pub series: Vec<Series>,
    /// Notes of the loader, and on invented defaults.
    pub notes: Vec<String>,
}

impl SceneShots {
    /// Returns all views, each under its light.
    #[must_use]
    pub fn views(&self) -> Vec<(&View, Light)> {
        self.series.iter().flat_map(|series| series.views.iter().map(|view| (view, series.light.light))).collect()
    }
}

/// One camera under one sun: a single view, or the frames of a walk.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name of the camera.
    pub camera: String,
    /// Sun in words, such as `own sun, 31° up`; the name of another light.
    pub sun_name: String,
    /// The light.
    pub light: Lamp,
    /// Views of the frames in order; one for a single view.
    pub views: Vec<View>,
    /// Options of `umbrage render` that show the views. For a walk along a path they show all
    /// frames at once.
    pub options: Vec<Vec<String>>,
}

/// A camera before the sun is chosen.
struct Walk {
    camera: String,
    views: Vec<View>,
    options: Vec<Vec<String>>,
}

/// Motion from frame to frame of a camera without a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stride {
    /// Metres forward per frame.
    pub metres: f64,
    /// Rotation per frame in degrees to the left, about the world's vertical.
    pub turn: f64,
    /// Factor of magnification per frame.
    pub zoom: f64,
    /// Number of frames.
    pub frames: u32,
}

impl Stride {
    /// Returns the view of frame `k`; `before` is the frame before.
    fn onwards(&self, before: &View) -> Result<View> {
        let eye = before.eye() + before.forward() * self.metres;
        let turn = DQuat::from_rotation_y(self.turn.to_radians());
        let mut lens = *before.frustum();
        for edge in [&mut lens.left, &mut lens.right, &mut lens.bottom, &mut lens.top] {
            *edge /= self.zoom;
        }
        let up = turn * before.world_from_view_rotation().y_axis;
        Ok(View::look_at(eye, eye + turn * before.forward(), up, lens)?)
    }
}

/// Request for the views of each scene, with a preset's defaults filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotRequest {
    /// Part that all views share. The scene and its camera are filled in one after the other.
    pub base: SceneRequest,
    /// Cameras; empty for all that the scene has.
    pub cameras: Vec<CameraChoice>,
    /// Suns that every camera is seen under; `None` for the scene's own.
    pub suns: Option<Vec<SunSpec>>,
    /// Motion of cameras without a path.
    pub stride: Option<Stride>,
}

impl ShotRequest {
    fn request(&self, scene: &str, camera: &CameraChoice) -> Result<SceneRequest> {
        SceneRequest { scene: scene.to_owned(), ..self.base.clone() }.with_camera(camera.clone())
    }

    /// Returns the path that a camera moves along.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.cameras.iter().find_map(|camera| match camera {
            CameraChoice::Path { file, .. } => Some(file.as_path()),
            _ => None,
        })
    }

    /// Opens a scene and finds its views.
    ///
    /// # Errors
    /// [`Failure::Input`] with the file or option at fault.
    pub fn open(&self, name: &str) -> Result<SceneShots> {
        let path = self.path().map(CameraPath::load).transpose()?;
        let scene = open::open(name, &self.base.files, self.base.move_scene)?;
        let pose = scene.pose(self.base.time_s)?;
        let mut notes = scene.notes.clone();
        let mut walks = Vec::new();
        for choice in self.cameras_of(&scene) {
            walks.push(self.walk(name, &choice, &scene, &pose, path.as_ref(), &mut notes)?);
        }
        let any = self.request(name, &CameraChoice::Default)?;
        let own = self.own_light(&lights::chosen(&any, &scene, &pose, path.as_ref(), &mut notes)?)?;
        let mut series = Vec::new();
        for (number, walk) in walks.iter().enumerate() {
            let Light::Directional(sun) = own.lamp.light else {
                let mut options = walk.options.clone();
                options.iter_mut().for_each(|frame| frame.push(format!("--light={}", own.name)));
                series.push(Series {
                    camera: walk.camera.clone(),
                    sun_name: own.name.clone(),
                    light: own.lamp,
                    views: walk.views.clone(),
                    options,
                });
                continue;
            };
            for (sun_name, travel) in self.suns_of(sun.direction(), walk, number == 0) {
                let mut options = walk.options.clone();
                for frame in &mut options {
                    frame.push(format!("--sun={},{},{}", travel.x, travel.y, travel.z));
                }
                series.push(Series {
                    camera: walk.camera.clone(),
                    sun_name,
                    light: DirectionalLight::new(travel)?.into(),
                    views: walk.views.clone(),
                    options,
                });
            }
        }
        notes::say(&notes);
        let views = series.iter().flat_map(|series| &series.views);
        let pose = open::pose_seen(&scene, self.base.time_s, views, self.base.size)?.unwrap_or(pose);
        Ok(SceneShots { name: name.to_owned(), scene, pose, series, notes })
    }

    /// Returns the one light that techniques are judged under.
    fn own_light(&self, lights: &[NamedLight]) -> Result<NamedLight> {
        let [own] = lights else {
            let names: Vec<&str> = lights.iter().map(|light| light.name.as_str()).collect();
            return Err(Failure::input(format!(
                "--light {}: techniques are judged under one light at a time; name one",
                names.join(",")
            )));
        };
        if own.lamp.light.position().is_some() && self.suns.is_some() {
            return Err(Failure::input(format!(
                "--suns turns a sun, but --light {} is a spot or point light; give only one of the two",
                own.name
            )));
        }
        Ok(own.clone())
    }

    fn cameras_of(&self, scene: &Scene) -> Vec<CameraChoice> {
        let mut choices = self.cameras.clone();
        if choices.is_empty() {
            for (number, camera) in scene.cameras.iter().enumerate() {
                // Cameras without a name of their own are called by their number.
                let taken = scene.cameras[..number].iter().any(|other| other.name == camera.name);
                let name = if camera.name.is_empty() || taken { number.to_string() } else { camera.name.clone() };
                choices.push(CameraChoice::Named(name));
            }
        }
        if choices.is_empty() {
            choices.push(CameraChoice::Default);
        }
        choices
    }

    fn walk(
        &self,
        name: &str,
        choice: &CameraChoice,
        scene: &Scene,
        pose: &Pose,
        path: Option<&CameraPath>,
        notes: &mut Vec<String>,
    ) -> Result<Walk> {
        let request = self.request(name, choice)?;
        let shots = scene_setup::frame_views(&request, scene, pose, path, notes)?;
        let camera = match choice {
            CameraChoice::Path { .. } => "path".to_owned(),
            CameraChoice::Named(name) => name.clone(),
            _ => shots[0].camera.clone(),
        };
        let is_path = matches!(choice, CameraChoice::Path { .. });
        let mut common = vec![name.to_owned(), format!("--size={}x{}", request.size[0], request.size[1])];
        let numbers = [
            ("time", (request.time_s != 0.0).then_some(request.time_s)),
            ("fov", request.fov.filter(|_| is_path || self.stride.is_none())),
            ("near", request.near),
            ("far", request.far),
            ("metres-per-post", request.files.height_map.metres_per_post),
            ("metres-per-unit", request.files.height_map.metres_per_unit),
            ("height-offset", request.files.height_map.height_offset),
        ];
        common.extend(numbers.iter().filter_map(|(option, value)| value.map(|value| format!("--{option}={value}"))));
        let vector = |option: &str, v: DVec3| format!("--{option}={},{},{}", v.x, v.y, v.z);
        common.extend(request.move_scene.map(|by| vector("move-scene", by)));
        let with = |more: Vec<String>| common.iter().cloned().chain(more).collect::<Vec<_>>();
        if let CameraChoice::Path { file, frames, eye_height } = choice {
            let path = [
                format!("--path={}", file.display()),
                format!("--frames={}", frames.unwrap_or(1)),
                format!("--eye-height={eye_height}"),
            ];
            let options = vec![with(path.to_vec()); shots.len()];
            return Ok(Walk { camera, views: shots.into_iter().map(|shot| shot.view).collect(), options });
        }
        let first = shots[0].view;
        let Some(stride) = self.stride else {
            let options = match choice {
                CameraChoice::Named(name) => vec![format!("--camera={name}")],
                CameraChoice::LookAt { eye, target } => vec![vector("eye", *eye), vector("target", *target)],
                _ => Vec::new(),
            };
            return Ok(Walk { camera, views: vec![first], options: vec![with(options)] });
        };
        let mut views = vec![first];
        for _ in 1..stride.frames {
            views.push(stride.onwards(&views[views.len() - 1])?);
        }
        let options = views.iter().map(|view| {
            let frustum = view.frustum();
            let mut own = vec![vector("eye", view.eye()), vector("target", view.eye() + view.forward())];
            if frustum.projection == Projection::Perspective {
                own.push(format!("--fov={}", (frustum.top.atan() - frustum.bottom.atan()).to_degrees()));
            }
            // A camera of the scene has its own lens, which has to be said of another eye.
            if request.near.is_none() {
                own.push(format!("--near={}", frustum.near));
            }
            if request.far.is_none() {
                own.push(format!("--far={}", frustum.far));
            }
            with(own)
        });
        let options = options.collect();
        Ok(Walk { camera, views, options })
    }

    /// Returns names and light directions of the suns that a camera is seen under.
    fn suns_of(&self, own_travel: DVec3, walk: &Walk, first: bool) -> Vec<(String, DVec3)> {
        let to_own = -own_travel;
        let ahead = walk.views[0].forward();
        let at = |elevation: f64, towards: DVec3| -sun_at(elevation, towards);
        let own_elevation = to_own.y.clamp(-1.0, 1.0).asin().to_degrees();
        let into = |elevation: f64| (format!("into the sun, {elevation}° up"), at(elevation, ahead));
        let mut suns = Vec::new();
        for spec in self.suns.as_deref().unwrap_or(&[SunSpec::Own]) {
            match *spec {
                SunSpec::Own => suns.push((format!("own sun, {own_elevation:.0}° up"), own_travel)),
                SunSpec::At { elevation, bearing: None } => {
                    suns.push((format!("sun {elevation}° up"), at(elevation, to_own)));
                }
                SunSpec::At { elevation, bearing: Some(bearing) } => {
                    let radians = bearing.to_radians();
                    let towards = DVec3::new(radians.sin(), 0.0, -radians.cos());
                    suns.push((format!("sun {elevation}° up at {bearing}°"), at(elevation, towards)));
                }
                SunSpec::Into(elevation) => suns.push(into(elevation)),
                SunSpec::Metrics => {
                    suns.extend(METRICS_ELEVATIONS.map(|up| (format!("sun {up}° up"), at(up, to_own))));
                    if first {
                        suns.push(into(INTO_ELEVATION));
                    }
                }
            }
        }
        suns
    }
}

/// Returns the unit vector to a sun at an elevation in degrees, in the horizontal direction of
/// `towards`.
fn sun_at(elevation: f64, towards: DVec3) -> DVec3 {
    let across = DVec3::new(towards.x, 0.0, towards.z).try_normalize().unwrap_or_else(|| {
        // Straight above or below: as the invented sun stands.
        let invented = -umbrage_scene::invented_sun();
        DVec3::new(invented.x, 0.0, invented.z).normalize()
    });
    let (sine, cosine) = elevation.to_radians().sin_cos();
    across * cosine + DVec3::Y * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suns_are_read() {
        assert_eq!(sun_spec("own"), Ok(SunSpec::Own));
        assert_eq!(sun_spec(" 43 "), Ok(SunSpec::At { elevation: 43.0, bearing: None }));
        assert_eq!(sun_spec("11@-30"), Ok(SunSpec::At { elevation: 11.0, bearing: Some(-30.0) }));
        assert_eq!(sun_spec("into"), Ok(SunSpec::Into(11.0)));
        assert_eq!(sun_spec("into@30"), Ok(SunSpec::Into(30.0)));
        assert_eq!(sun_spec("metrics"), Ok(SunSpec::Metrics));
        for bad in ["", "noon", "0", "-5", "91", "nan", "into@", "into@x", "43@", "43@500", "@5"] {
            let message = sun_spec(bad).expect_err(bad);
            assert!(message.contains("degrees"), "{bad}: {message}");
        }
    }

    #[test]
    fn suns_stand_where_they_should() {
        let sun = sun_at(43.0, DVec3::new(3.0, 9.0, 0.0));
        assert!((sun.length() - 1.0).abs() < 1e-12 && sun.z.abs() < 1e-12 && sun.x > 0.0);
        assert!((sun.y.asin().to_degrees() - 43.0).abs() < 1e-9);
        assert!(sun_at(11.0, DVec3::NEG_Y).is_finite(), "a sun straight above has no bearing, one is invented");
    }

    #[test]
    fn strides_walk_turn_and_zoom() {
        let lens = umbrage::Frustum::perspective(1.0, 1.5, 0.5, 90.0).expect("a lens");
        let view =
            View::look_at(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 1.0, -7.0), DVec3::new(0.2, 1.0, 0.0), lens)
                .expect("a view");
        let stride = Stride { metres: 2.5, turn: 0.0, zoom: 1.0, frames: 2 };
        let moved = stride.onwards(&view).expect("moved");
        assert!((moved.eye() - view.eye() - 2.5 * view.forward()).length() < 1e-12);
        assert!((moved.world_from_view_rotation().y_axis - view.world_from_view_rotation().y_axis).length() < 1e-12);
        assert_eq!(moved.frustum(), view.frustum());
        let turned = Stride { metres: 0.0, turn: 30.0, zoom: 2.0, frames: 2 }.onwards(&view).expect("turned");
        assert_eq!(turned.eye(), view.eye());
        assert!((turned.forward().y - view.forward().y).abs() < 1e-12, "the pitch stays");
        let bearing = |view: &View| (-view.forward().x).atan2(-view.forward().z).to_degrees();
        assert!((bearing(&turned) - bearing(&view) - 30.0).abs() < 1e-9, "to the left");
        assert!((turned.frustum().top - 0.5 * lens.top).abs() < 1e-12);
    }
}
