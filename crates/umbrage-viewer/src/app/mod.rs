//! The viewer without its window: it connects the session with the tasks beside the window and with
//! the panels.

pub mod panel;

use std::path::Path;
use std::sync::Arc;

use egui::{Key, Modifiers};
use umbrage_lab::scene_request::SceneRequest;
use umbrage_render::Gpu;

use crate::judge::{Judge, Overlay};
use crate::link::{self, Linked};
use crate::platform::{self, Arrival, Wake};
use crate::session::{Session, Tab};
use crate::share;
use crate::stage::Shipped;
use crate::studio::{Order, Studio};
use crate::textures::Textures;
use panel::Fields;

/// Time between two frames of an animation.
const FRAME: std::time::Duration = std::time::Duration::from_millis(16);

/// The viewer without its window.
pub struct App {
    /// State of the viewer.
    pub session: Session,
    /// State of the controls.
    pub fields: Fields,
    /// True if the panels are hidden.
    pub bare: bool,
    /// True if the help is shown.
    pub help: bool,
    /// True if the viewer wants a screenshot of itself in a file of the working folder.
    pub wants_screenshot: bool,
    pub(crate) textures: Textures,
    studio: Option<Studio>,
    judge: Option<Judge>,
    /// Device of the window, where it is shared.
    gpu: Option<Gpu>,
    wake: Wake,
}

impl App {
    /// Makes a viewer of a session. No task runs yet.
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
            gpu: None,
            wake,
        }
    }

    /// Opens a scene in the background. The current one stays until the new one is there.
    pub fn open(&mut self, request: SceneRequest) {
        self.open_with(request, None);
    }

    /// Opens a scene, from the content of its file if `bytes` has it.
    fn open_with(&mut self, request: SceneRequest, bytes: Option<Arc<[u8]>>) {
        let wake = Arc::clone(&self.wake);
        self.session.open(request, bytes, move || wake());
    }

    /// Draws with this device from now on. The window draws with it too.
    pub fn share_device(&mut self, gpu: Gpu) {
        self.gpu = Some(gpu);
        self.session.try_again();
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

    /// Advances time, takes the results of the tasks and gives them new orders.
    pub fn step(&mut self, seconds: f64) {
        self.session.tick(seconds);
        if let Some(studio) = &self.studio {
            studio.news().for_each(|news| self.session.hear(news));
        }
        if let Some(judge) = &self.judge {
            judge.findings().for_each(|finding| self.session.found(finding));
        }
        if let Some(order) = self.session.next_order() {
            let order = Order { gpu: self.gpu.clone(), ..order };
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

    /// Returns whether the controls show the last picture.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.session.drawn.as_ref().is_some_and(|drawn| self.textures.has(drawn))
    }

    /// Returns the share of the rays that are traced, while rays are traced.
    #[must_use]
    pub fn judging(&self) -> Option<f32> {
        self.judge.as_ref().filter(|_| self.session.is_judging()).map(Judge::progress)
    }

    /// Lays out all controls and the picture.
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

    /// Handles dropped files, pasted text and keys that belong to no control.
    fn take_events(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.last().map(|file| file.path().to_owned()));
        if let Some(path) = dropped {
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
                Some(Overlay::Errors) => Some(Overlay::Tests),
                Some(Overlay::Tests) => None,
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

    /// Replaces the config by one read from text.
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

    /// Returns the command that shows the current scene, view and settings.
    #[must_use]
    pub fn command_line(&self) -> String {
        link::command_line(&self.session)
    }

    /// Returns the address that shows the current scene, view and settings, where the viewer has
    /// one. It becomes the page's address.
    pub fn link(&self) -> Option<String> {
        platform::link(&link::fragment(&self.session))
    }

    /// Handles an event from outside of the window.
    pub fn arrive(&mut self, arrival: Arrival) {
        match arrival {
            // Given to the controls: a field may be waiting for it.
            Arrival::Pasted(_) => {}
            Arrival::Dropped { name, bytes } => {
                let files = self.session.stage.as_ref().map(|stage| stage.request.files).unwrap_or_default();
                let request = SceneRequest { files, ..SceneRequest::new(name, self.session.size) };
                self.open_with(request, Some(bytes.into()));
            }
            Arrival::Address(fragment) => {
                let shown = self.session.stage.as_ref().map(|stage| stage.request.scene.clone()).unwrap_or_default();
                match link::read(&fragment, &shown, self.session.size) {
                    Ok(linked) => self.follow(linked),
                    Err(why) => self.session.say(true, why),
                }
            }
            Arrival::Said(is_error, text) => self.session.say(is_error, text),
            Arrival::Lost(why) => self.session.say(true, why),
        }
    }

    /// Shows the scene, view and settings of a link.
    fn follow(&mut self, linked: Linked) {
        linked.notes.into_iter().for_each(|note| self.session.say(false, note));
        self.session.set_config(linked.config);
        self.session.show.tint = linked.tint;
        (self.bare, self.session.playing) = (linked.bare, linked.runs);
        self.open(linked.request);
    }
}

#[cfg(test)]
mod tests;
