//! Opening scenes in the background. The current scene stays until the next one is there.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use umbrage::View;
use umbrage_lab::failure::Failure;
use umbrage_lab::gallery::{SCENES, Scene as Exhibit};
use umbrage_lab::lights::{self, NamedLight};
use umbrage_lab::scene_request::{CameraChoice, SceneRequest};
use umbrage_lab::scene_setup::frame_views;
use umbrage_scene::{CameraPath, Pose, Scene};
use web_time::Instant;

use crate::path::Following;
use crate::platform::{self, Movable};

/// Name of the gallery view that a scene of the menu begins with.
const FIRST_SHOT: &str = "middle";

/// A scene that was opened, with its first view and its lights.
#[derive(Debug)]
pub struct Stage {
    /// Number that tells one opened scene from another.
    pub id: u64,
    /// Request that opened the scene.
    pub request: SceneRequest,
    /// The scene.
    pub scene: Scene,
    /// Pose of the scene at the request's time.
    pub pose: Arc<Pose>,
    /// First view.
    pub view: View,
    /// Lights at the request's time.
    pub lights: Vec<NamedLight>,
    /// Camera path, if the request has one.
    pub path: Option<CameraPath>,
    /// Remarks of the loader on parts that it left out.
    pub notes: Vec<String>,
}

impl Stage {
    /// Returns whether the scene has animations.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        !self.scene.animations.is_empty()
    }

    /// Returns the seconds until the longest clip starts again.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.scene.animations.iter().map(|clip| clip.duration).fold(0.0, f64::max)
    }

    /// Returns the path of the request, to be followed from its beginning.
    #[must_use]
    pub fn following(&self) -> Option<Following> {
        match (&self.request.camera, &self.path) {
            (CameraChoice::Path { eye_height, .. }, Some(path)) => Some(Following::new(path.clone(), *eye_height)),
            _ => None,
        }
    }

    /// Returns the view of a camera of the scene.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn camera_view(&self, index: usize, aspect: f64) -> Result<View, String> {
        umbrage_scene::camera_view(&self.scene, &self.pose, index, aspect, self.request.near, self.request.far)
            .map_err(|error| error.to_string())
    }
}

/// Progress of opening a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The file is being read, or the world built.
    Reading,
    /// The scene is being posed, and its cameras and lights are looked up.
    Posing,
    /// The scene is open.
    Done,
}

impl Step {
    const ALL: [Self; 3] = [Self::Reading, Self::Posing, Self::Done];

    /// Describes the step for users.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Reading => "reading the scene",
            Self::Posing => "posing the scene",
            Self::Done => "done",
        }
    }

    /// Returns the share of the steps that are done.
    #[must_use]
    pub fn share(self) -> f32 {
        match self {
            Self::Reading => 0.1,
            Self::Posing => 0.8,
            Self::Done => 1.0,
        }
    }
}

/// A scene that is being opened.
#[derive(Debug)]
pub struct Opening {
    /// Name of the scene.
    pub spec: String,
    begun: Instant,
    step: Arc<AtomicU8>,
    result: Receiver<Result<Stage, String>>,
}

impl Opening {
    /// Starts to open a scene, from `bytes` if given. `wake` is called when there is progress.
    pub fn start(request: SceneRequest, bytes: Option<Arc<[u8]>>, wake: impl Fn() + Movable + 'static) -> Self {
        let (sender, result) = channel();
        let step = Arc::new(AtomicU8::new(0));
        let at = Arc::clone(&step);
        let spec = request.scene.clone();
        let work = async move || {
            let enter = |step: Step| {
                at.store(step as u8, Ordering::Relaxed);
                wake();
            };
            // The window may have gone meanwhile.
            drop(sender.send(open(request, bytes, enter).await.map_err(|failure| failure.to_string())));
            enter(Step::Done);
        };
        // What could not begin ends without a result, which `poll` says.
        drop(platform::spawn("open", work));
        Self { spec, begun: Instant::now(), step, result }
    }

    /// Returns the current step.
    #[must_use]
    pub fn step(&self) -> Step {
        Step::ALL[usize::from(self.step.load(Ordering::Relaxed)).min(2)]
    }

    /// Returns the time since the start.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Returns the result, once there is one.
    pub fn poll(&self) -> Option<Result<Stage, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err(format!("{}: opening it ended without a result; please report this file", self.spec)))
            }
        }
    }
}

/// Opens the scene of a request, from `bytes` if given.
///
/// # Errors
/// [`Failure::Input`] with the file or option at fault.
pub async fn open(request: SceneRequest, bytes: Option<Arc<[u8]>>, enter: impl Fn(Step)) -> Result<Stage, Failure> {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    enter(Step::Reading);
    let path = match &request.camera {
        CameraChoice::Path { file, .. } => Some(CameraPath::load(file)?),
        _ => None,
    };
    let scene = platform::scene(&request, bytes).await?;
    let scene = match request.move_scene {
        Some(by) => scene.moved(by),
        None => scene,
    };
    enter(Step::Posing);
    let pose = scene.pose(request.time_s)?;
    let mut notes = scene.notes.clone();
    // Which camera and which sun were taken can be seen and changed in the window.
    let mut seen = Vec::new();
    let views = frame_views(&request, &scene, &pose, path.as_ref(), &mut seen)?;
    let lights = lights::chosen(&request, &scene, &pose, path.as_ref(), &mut seen)?;
    let first = views.into_iter().next().ok_or_else(|| Failure::input("--frames 0 asks for no frame"))?;
    if !first.beside.is_empty() {
        notes.push("one view at a time is shown: the first of the cameras".to_owned());
    }
    let id = NEXT.fetch_add(1, Ordering::Relaxed);
    Ok(Stage { id, request, scene, pose: Arc::new(pose), view: first.view, lights, path, notes })
}

/// A scene of the menu.
#[derive(Clone, Copy, Debug)]
pub struct Shipped(&'static Exhibit);

/// Iterates over the scenes of the menu: the worlds, and the city.
pub fn shipped() -> impl Iterator<Item = Shipped> {
    SCENES.iter().map(Shipped)
}

impl Shipped {
    /// Returns the title of the scene.
    #[must_use]
    pub fn title(&self) -> &'static str {
        self.0.title
    }

    /// Returns a sentence about the scene.
    #[must_use]
    pub fn about(&self) -> &'static str {
        self.0.about
    }

    /// Returns whether a request opened this scene.
    #[must_use]
    pub fn is_shown_by(&self, request: &SceneRequest) -> bool {
        Path::new(&request.scene).ends_with(self.0.scene)
    }

    /// Returns the request that opens the scene.
    ///
    /// # Errors
    /// The folders that were searched, if the scene is a file that is missing.
    pub fn request(&self, size: [u32; 2]) -> Result<SceneRequest, String> {
        let shots = self.0.shots;
        let shot =
            shots.iter().find(|shot| shot.name == FIRST_SHOT).or(shots.first()).ok_or("the scene has no view")?;
        let request = self.0.request(shot, size).map_err(|failure| failure.to_string())?;
        let is_file = self.0.scene.contains('/');
        let scene = if is_file { platform::shipped(self.0.scene)? } else { self.0.scene.to_owned() };
        Ok(SceneRequest { scene, ..request })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_scene_can_be_asked_for() {
        assert_eq!(shipped().count(), SCENES.len());
        for shipped in shipped() {
            let request = shipped.request([320, 200]).unwrap_or_else(|why| panic!("{}: {why}", shipped.title()));
            assert!(shipped.is_shown_by(&request), "{}", request.scene);
            assert_eq!(self::shipped().filter(|other| other.is_shown_by(&request)).count(), 1);
        }
    }

    #[test]
    fn scenes_open_beside_and_say_what_was_wrong() {
        let wait = |request| {
            let opening = Opening::start(request, None, || ());
            loop {
                if let Some(result) = opening.poll() {
                    return result;
                }
                std::thread::yield_now();
            }
        };
        let stage = wait(SceneRequest::new("chessboard", [64, 48])).expect("a world");
        assert!(stage.is_animated() && stage.duration_s() > 0.0 && stage.lights.len() == 1);
        assert!(stage.camera_view(0, 2.0).is_ok() && stage.camera_view(99, 2.0).is_err());
        let error = wait(SceneRequest::new("no-such.glb", [64, 48])).expect_err("no file");
        assert!(error.contains("no-such.glb"), "{error}");
    }
}
