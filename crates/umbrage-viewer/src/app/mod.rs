//! The viewer between the session and the controls: threads on one side, panels on the other.

use std::path::Path;
use std::sync::Arc;

use egui::{Key, Modifiers};
use umbrage_lab::scene_request::SceneRequest;

use crate::judge::{Judge, Overlay};
use crate::panel::{self, Fields};
use crate::session::{Session, Tab};
use crate::share::{self, Spelled};
use crate::stage::Shipped;
use crate::studio::Studio;
use crate::textures::Textures;

/// Called, from any thread, when there is something new to show.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Time between two frames of what moves by itself.
const FRAME: std::time::Duration = std::time::Duration::from_millis(16);

/// The viewer without its window.
pub struct App {
    /// What it knows.
    pub session: Session,
    /// What stands in its controls.
    pub fields: Fields,
    /// Whether the panels are hidden.
    pub bare: bool,
    /// Whether the help is shown.
    pub help: bool,
    /// Whether it wants a picture of itself in a file of the working folder.
    pub wants_screenshot: bool,
    pub(crate) textures: Textures,
    studio: Option<Studio>,
    judge: Option<Judge>,
    wake: Wake,
}

impl App {
    /// A viewer of a session; nothing runs yet.
    #[must_use]
    pub fn new(session: Session, wake: Wake) -> Self {
        Self {
            session,
            fields: Fields::default(),
            bare: false,
            help: false,
            wants_screenshot: false,
            textures: Textures::default(),
            studio: None,
            judge: None,
            wake,
        }
    }

    /// Opens a scene beside the one that is shown.
    pub fn open(&mut self, request: SceneRequest) {
        let wake = Arc::clone(&self.wake);
        self.session.open(request, move || wake());
    }

    /// Opens a scene of the menu.
    pub fn open_shipped(&mut self, shipped: Shipped) {
        match shipped.request(self.session.size) {
            Ok(request) => self.open(request),
            Err(why) => self.session.say(true, why),
        }
    }

    /// Opens a file, with the options that the last one was opened with.
    pub fn open_file(&mut self, path: &Path) {
        let files = self.session.stage.as_ref().map(|stage| stage.request.files).unwrap_or_default();
        let request = SceneRequest { files, ..SceneRequest::new(path.display().to_string(), self.session.size) };
        self.open(request);
    }

    /// Lets time go by, hears the threads and gives them what is next.
    pub fn step(&mut self, seconds: f64) {
        self.session.tick(seconds);
        if let Some(studio) = &self.studio {
            studio.news().for_each(|news| self.session.hear(news));
        }
        if let Some(judge) = &self.judge {
            judge.findings().for_each(|finding| self.session.found(finding));
        }
        if let Some(order) = self.session.next_order() {
            let started = match &self.studio {
                Some(studio) => studio.order(order.clone()),
                None => false,
            };
            if !started {
                let wake = Arc::clone(&self.wake);
                let studio = Studio::start(move || wake());
                match studio {
                    Ok(studio) if studio.order(order) => self.studio = Some(studio),
                    _ => self.session.order_lost("there is no thread to draw on; close something and change a setting"),
                }
            }
        }
        if let Some(question) = self.session.next_question() {
            let asked = self.judge.as_ref().is_some_and(|judge| judge.ask(question.clone()));
            if !asked {
                let wake = Arc::clone(&self.wake);
                match Judge::start(move || wake()) {
                    Ok(judge) if judge.ask(question) => self.judge = Some(judge),
                    _ => {
                        self.session.question_lost("there is no thread to trace rays on; close something and ask again")
                    }
                }
            }
        }
    }

    /// Whether the controls have been given the last picture.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.session.drawn.as_ref().is_some_and(|drawn| self.textures.has(drawn))
    }

    /// Share of the rays that are traced, while they are.
    #[must_use]
    pub fn judging(&self) -> Option<f32> {
        self.judge.as_ref().filter(|_| self.session.is_judging()).map(Judge::progress)
    }

    /// All controls and the picture.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.take_events(ui.ctx());
        if !self.bare {
            panel::status(self, ui);
            panel::scene(self, ui);
            panel::settings(self, ui);
            panel::below(self, ui);
        }
        panel::viewport(self, ui);
        panel::help(self, ui);
        if self.session.is_moving() {
            ui.ctx().request_repaint_after(FRAME);
        } else if self.session.opening.is_some() || self.session.is_judging() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(100));
        }
    }

    /// Dropped files, pasted text and keys that belong to no control.
    fn take_events(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        if let Some(file) = dropped.last() {
            let path = file.path().to_owned();
            self.open_file(&path);
        }
        let help = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1));
        self.help ^= help;
        if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F12)) {
            self.wants_screenshot = true;
        }
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        let (pasted, copies) = ctx.input(|input| {
            let pasted = input.events.iter().find_map(|event| match event {
                egui::Event::Paste(text) => Some(text.clone()),
                _ => None,
            });
            (pasted, input.events.iter().any(|event| matches!(event, egui::Event::Copy)))
        });
        if let Some(text) = pasted {
            self.paste(&text);
        }
        if copies {
            ctx.copy_text(self.command_line());
            self.session.say(false, "copied the command line that shows this");
        }
        self.take_keys(ctx);
    }

    fn take_keys(&mut self, ctx: &egui::Context) {
        let pressed = |key| ctx.input(|input| input.modifiers.is_none() && input.key_pressed(key));
        let session = &mut self.session;
        if pressed(Key::Escape) && self.help {
            self.help = false;
        }
        for (key, toggled) in [
            (Key::T, &mut session.show.tint),
            (Key::L, &mut session.show.frusta),
            (Key::X, &mut session.show.shadows),
            (Key::H, &mut self.bare),
            (Key::Space, &mut session.playing),
        ] {
            *toggled ^= pressed(key);
        }
        if pressed(Key::F) {
            let hold = session.frozen.is_none();
            session.freeze(hold);
        }
        if pressed(Key::O) {
            session.show.overlay = match session.show.overlay {
                None => Some(Overlay::Density),
                Some(Overlay::Density) => Some(Overlay::Errors),
                Some(Overlay::Errors) => None,
            };
        }
        for (key, (tab, _)) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().zip(Tab::ALL) {
            if pressed(key) {
                session.show.tab = (session.show.tab != Some(tab)).then_some(tab);
            }
        }
        if pressed(Key::R)
            && let Some(view) = session.stage.as_ref().map(|stage| stage.view)
        {
            session.jump(view);
        }
        if let Some(camera) = &mut session.camera {
            let faster = if pressed(Key::Plus) || pressed(Key::Equals) { 1.25 } else { 1.0 };
            let slower = if pressed(Key::Minus) { 0.8 } else { 1.0 };
            camera.speed = (camera.speed * faster * slower)
                .clamp(*crate::camera::SPEEDS_M_S.start(), *crate::camera::SPEEDS_M_S.end());
        }
    }

    /// Takes over a config from text.
    pub fn paste(&mut self, text: &str) {
        match share::read(text) {
            Ok(pasted) => {
                let kinds = self.session.light_kinds();
                if let Err(error) = pasted.config.validate_shared(&kinds) {
                    self.session.say(true, error.to_string());
                    return;
                }
                pasted.notes.into_iter().for_each(|note| self.session.say(false, note));
                self.session.set_config(pasted.config);
                self.session.say(false, "applied the pasted settings");
            }
            Err(why) => self.session.say(true, format!("nothing was pasted: {why}")),
        }
    }

    /// The command that shows what is shown.
    #[must_use]
    pub fn command_line(&self) -> String {
        let vector = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let mut command = "umbrage view".to_owned();
        if let (Some(stage), Some(camera)) = (&self.session.stage, &self.session.camera) {
            let scene = &stage.request.scene;
            command += &if scene.contains(char::is_whitespace) { format!(" '{scene}'") } else { format!(" {scene}") };
            let view = camera.view();
            if *view != stage.view {
                command += &format!(" --eye={} --target={}", vector(view.eye()), vector(camera.pivot()));
                command += &camera.fov_degrees().map(|fov| format!(" --fov={fov}")).unwrap_or_default();
                command += &format!(" --near={} --far={}", view.frustum().near, view.frustum().far);
            }
            if self.session.time_s != 0.0 {
                command += &format!(" --time={}", self.session.time_s);
            }
            let own = self.session.sun == crate::sun::Sun::OfScene;
            let given = matches!(stage.request.light, umbrage_lab::scene_request::LightChoice::Given(_));
            if let (true, Some(sun)) = (!own || given, self.session.shown_sun()) {
                command += &format!(" --sun={}", vector(sun.direction()));
            }
        }
        if self.session.show.tint {
            command += " --tint";
        }
        format!("{command} {}", Spelled::of(&self.session.config).command_line())
    }
}

#[cfg(test)]
mod tests;
