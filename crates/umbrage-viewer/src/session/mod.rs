//! State and decisions of the viewer, without a window: what is opened, drawn, judged and shown
//! next.

mod orders;
mod show;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use glam::{DVec2, DVec3};
use umbrage::config::{Layout, LightKind};
use umbrage::{DirectionalLight, Light, ShadowConfig, View};
use umbrage_lab::lights;
use umbrage_lab::scene_request::SceneRequest;

use crate::camera::{Camera, Motion};
use crate::judge::{Laid, Overlay, Picked};
use crate::path::{Following, Recording};
use crate::platform::Movable;
use crate::stage::{Opening, Stage};
use crate::studio::{Drawn, Shot};
use crate::sun::{SkyPoint, Sun};
pub use show::{Message, Show, Tab, Times};

/// Number of pictures whose times are kept.
const HISTORY: usize = 240;
/// Largest number of messages; older ones are dropped.
const MESSAGES: usize = 6;
/// Time of a picture in milliseconds above which pictures have half the size while something moves.
const SLOW_MS: f64 = 120.0;
/// Number of pictures of one view after which slow ones are not drawn again while maps recover in
/// small steps.
const MOST_SLOW_REPEATS: u32 = 2;
/// Seconds without motion after which the viewer is at rest.
const REST_S: f64 = 0.3;

/// State of the viewer.
#[derive(Debug)]
pub struct Session {
    /// Scene that is shown.
    pub stage: Option<Arc<Stage>>,
    /// Scene that is being opened.
    pub opening: Option<Opening>,
    /// Camera; `None` before there is a scene.
    pub camera: Option<Camera>,
    /// Technique of the shadows.
    pub config: ShadowConfig,
    /// Technique to compare with.
    pub other: Option<ShadowConfig>,
    /// Choice of the sun.
    pub sun: Sun,
    /// Time of the animations in seconds.
    pub time_s: f64,
    /// True if time runs.
    pub playing: bool,
    /// Display options.
    pub show: Show,
    /// View that maps are held for.
    pub frozen: Option<View>,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Last picture.
    pub drawn: Option<Arc<Drawn>>,
    /// Overlay of a picture.
    pub laid: Option<Laid>,
    /// Point that was clicked last.
    pub picked: Option<Picked>,
    /// Messages, oldest first.
    pub messages: VecDeque<Message>,
    /// Name of the task that takes a moment.
    pub busy: Option<&'static str>,
    /// Name of the adapter that draws.
    pub adapter: Option<String>,
    /// Times of the last pictures, oldest first.
    pub times: VecDeque<Times>,
    /// Number of pictures so far.
    pub pictures: u64,
    /// Camera path that is recorded.
    pub recording: Option<Recording>,
    /// Camera path that is followed.
    pub following: Option<Following>,
    last_sun: Option<DirectionalLight>,
    in_flight: bool,
    failed: Option<Shot>,
    settled: bool,
    /// Number of pictures of the current shot after its first.
    repeats: u32,
    judging: Option<(Shot, Option<Overlay>)>,
    click: Option<DVec2>,
    since_moved: f64,
}

impl Session {
    /// Makes a session without a scene.
    #[must_use]
    pub fn new(config: ShadowConfig, size: [u32; 2]) -> Self {
        Self {
            stage: None,
            opening: None,
            camera: None,
            config,
            other: None,
            sun: Sun::default(),
            time_s: 0.0,
            playing: false,
            show: Show::default(),
            frozen: None,
            size,
            drawn: None,
            laid: None,
            picked: None,
            messages: VecDeque::new(),
            busy: None,
            adapter: None,
            times: VecDeque::new(),
            pictures: 0,
            recording: None,
            following: None,
            last_sun: None,
            in_flight: false,
            failed: None,
            settled: false,
            repeats: 0,
            judging: None,
            click: None,
            since_moved: f64::INFINITY,
        }
    }

    /// Adds a message.
    pub fn say(&mut self, is_error: bool, text: impl Into<String>) {
        let message = Message { is_error, text: text.into() };
        if self.messages.contains(&message) {
            return;
        }
        self.messages.push_back(message);
        while self.messages.len() > MESSAGES {
            self.messages.pop_front();
        }
    }

    /// Opens a scene in the background. A scene that is still being opened is given up. `bytes` are
    /// the content of its file, if it was read already.
    pub fn open(&mut self, request: SceneRequest, bytes: Option<Arc<[u8]>>, wake: impl Fn() + Movable + 'static) {
        self.opening = Some(Opening::start(request, bytes, wake));
    }

    /// Draws a failed picture again, because there is another device.
    pub fn try_again(&mut self) {
        self.failed = None;
    }

    /// Returns whether all is drawn and nothing moves.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.opening.is_none() && !self.in_flight && self.settled && !self.is_moving() && self.is_up_to_date()
    }

    /// Shows a scene that was opened.
    pub fn enter(&mut self, stage: Stage) {
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1].max(1));
        let mode = self.camera.as_ref().map(|camera| camera.mode);
        let mut camera = Camera::new(stage.view, stage.pose.bounds);
        camera.mode = mode.unwrap_or_default();
        camera.set_aspect(aspect);
        for note in &stage.notes {
            self.say(false, note.clone());
        }
        self.time_s = stage.request.time_s;
        self.camera = Some(camera);
        self.stage = Some(Arc::new(stage));
        self.sun = Sun::OfScene;
        (self.frozen, self.picked, self.laid, self.last_sun, self.click) = (None, None, None, None, None);
        (self.recording, self.following, self.failed) = (None, None, None);
        self.show.outlined = None;
        self.times.clear();
        let (config, given_way) = self.config.for_lights(&self.light_kinds());
        if config != self.config {
            given_way.into_iter().for_each(|note| self.say(false, note));
            self.config = config;
        }
    }

    /// Returns the kinds of the scene's lights.
    #[must_use]
    pub fn light_kinds(&self) -> Vec<LightKind> {
        let of_stage = self.stage.as_ref().map(|stage| lights::kinds(&stage.lights));
        of_stage.unwrap_or_else(|| vec![LightKind::Directional])
    }

    /// Returns the sun of the scene as it was last drawn, if its first light is a sun.
    #[must_use]
    pub fn shown_sun(&self) -> Option<DirectionalLight> {
        let drawn = self.drawn.as_ref().filter(|drawn| self.is_of_stage(&drawn.shot));
        let lights = drawn.map(|drawn| &drawn.lights).or(self.stage.as_ref().map(|stage| &stage.lights))?;
        match lights.first()?.lamp.light {
            Light::Directional(sun) => Some(sun),
            Light::Spot(_) | Light::Point(_) => None,
        }
    }

    fn is_of_stage(&self, shot: &Shot) -> bool {
        self.stage.as_ref().is_some_and(|stage| stage.id == shot.stage)
    }

    /// Advances time: animations, paths, scenes that have been opened.
    pub fn tick(&mut self, seconds: f64) {
        let seconds = seconds.clamp(0.0, 1.0);
        self.since_moved += seconds;
        if let Some(result) = self.opening.as_ref().and_then(Opening::poll) {
            self.opening = None;
            match result {
                Ok(stage) => self.enter(stage),
                Err(why) => self.say(true, why),
            }
        }
        if self.playing && self.stage.as_ref().is_some_and(|stage| stage.is_animated()) {
            self.time_s += seconds;
            self.since_moved = 0.0;
        }
        if let (Some(following), Some(camera)) = (&mut self.following, &mut self.camera) {
            let goes_on = following.advance(camera.speed * seconds);
            if let Some(view) = following.view(*camera.view().frustum()) {
                camera.jump(view);
                self.since_moved = 0.0;
            }
            if !goes_on {
                self.following = None;
            }
        }
        if let (Some(recording), Some(camera)) = (&mut self.recording, &self.camera) {
            recording.pass(camera.view());
        }
    }

    /// Returns whether frames follow each other without input.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        let animated = self.playing && self.stage.as_ref().is_some_and(|stage| stage.is_animated());
        animated || self.following.is_some() || self.since_moved < REST_S
    }

    /// Moves the camera.
    pub fn fly(&mut self, motion: &Motion) {
        let Some(camera) = &mut self.camera else { return };
        if !motion.is_still() {
            camera.apply(motion);
            self.following = None;
            self.since_moved = 0.0;
        }
    }

    /// Moves the camera to a view.
    pub fn jump(&mut self, view: View) {
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1].max(1));
        if let Some(camera) = &mut self.camera {
            camera.jump(view);
            camera.set_aspect(aspect);
            self.following = None;
        }
    }

    /// Moves the sun by a drag of so many picture heights to the right and down.
    pub fn drag_sun(&mut self, by: DVec2) {
        let from = match self.sun {
            Sun::ByHand(point) => Some(point),
            Sun::OfScene | Sun::ByDate(_) => self.shown_sun().map(|sun| SkyPoint::of_travel(sun.direction())),
        };
        match from {
            Some(point) => {
                self.sun = Sun::ByHand(point.dragged(by));
                self.since_moved = 0.0;
            }
            None => self.say(false, "the first light of this scene is a lamp; there is no sun to drag"),
        }
    }

    /// Changes the size of the picture.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size == self.size || size.contains(&0) {
            return;
        }
        self.size = size;
        if let Some(camera) = &mut self.camera {
            camera.set_aspect(f64::from(size[0]) / f64::from(size[1]));
        }
    }

    /// Holds the maps for the current view, or releases them.
    pub fn freeze(&mut self, hold: bool) {
        let reused = |config: &ShadowConfig| config.layout == Layout::Reused;
        if hold && (reused(&self.config) || self.other.as_ref().is_some_and(reused)) {
            self.say(
                false,
                "storage reused draws the picture slice by slice and cannot hold its maps for another view; choose another storage",
            );
            return;
        }
        self.frozen = self.camera.as_ref().filter(|_| hold).map(|camera| *camera.view());
        if hold {
            self.show.frusta = true;
        }
    }

    /// Changes the config.
    pub fn set_config(&mut self, config: ShadowConfig) {
        if config.layout == Layout::Reused && self.frozen.take().is_some() {
            self.say(false, "maps are no longer held: storage reused has one map at a time");
        }
        self.config = config;
    }

    /// Asks for the surface at a point of the picture.
    pub fn pick(&mut self, at: DVec2) {
        self.click = Some(at);
    }

    /// Returns the time that the scene being opened has taken so far.
    #[must_use]
    pub fn opening_for(&self) -> Option<Duration> {
        self.opening.as_ref().map(Opening::elapsed)
    }
}

/// Projects a world point to a view: its position in shares of the picture, and its view depth in
/// metres; `None` outside of the view.
#[must_use]
pub fn project(view: &View, point: DVec3) -> Option<(DVec2, f64)> {
    let at = view.view_from_world_point(point);
    let depth = -at.z;
    let lens = view.frustum();
    let scale = lens.scale_at(depth);
    let x = (at.x / scale - lens.left) / (lens.right - lens.left);
    let y = (lens.top - at.y / scale) / (lens.top - lens.bottom);
    let inside = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y) && depth >= lens.near;
    inside.then_some((DVec2::new(x, y), depth))
}

#[cfg(test)]
mod tests;
