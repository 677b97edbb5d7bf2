//! The window: event handling, and the recovery from a lost surface or device.

mod shown;

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use egui::ViewportId;
use image::RgbaImage;
use umbrage::View;
use web_time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use self::shown::{Painted, Shown};
use crate::app::App;
use crate::platform::{self, Arrival, Outside, Wake};
use crate::session::Session;
use crate::{Error, Options, Result};

/// Number of times that a device is opened again before the viewer ends.
const MOST_DEVICES: u32 = 5;
/// Longest time until a screenshot is complete.
const PATIENCE: Duration = Duration::from_secs(600);
/// Distance from held maps' eye to the eye that looks at them, as a share of the distance to the
/// pivot.
const STEP_BACK: f64 = 0.9;

/// Event that a task sends when it has news.
#[derive(Clone, Copy, Debug)]
pub(crate) struct News;

/// Opens the window and shows the scene until the window is closed or the screenshot is written. In
/// a browser it returns at once, and the viewer goes on.
///
/// # Errors
/// [`Error`] if there is no screen, no adapter, or the screenshot cannot be made.
pub fn run(options: Options) -> Result<()> {
    let events = EventLoop::<News>::with_user_event().build().map_err(|error| Error::NoScreen(error.to_string()))?;
    let viewer = Viewer::new(options, events.create_proxy());
    let viewer = platform::run(events, viewer)?;
    viewer.and_then(|viewer| viewer.failure).map_or(Ok(()), Err)
}

/// Use of a screenshot.
#[derive(Clone)]
enum Purpose {
    /// Saves it; the viewer goes on.
    Keep,
    /// Writes it to this path; the viewer ends.
    End(PathBuf),
}

/// Operations that were begun and will be ready some time, in a browser not at once.
#[derive(Default)]
struct Pending {
    opened: Option<Result<Shown>>,
    pictures: Vec<(Purpose, Result<RgbaImage, String>)>,
}

/// The viewer in its window.
pub(crate) struct Viewer {
    options: Options,
    app: App,
    ctx: egui::Context,
    shown: Option<Shown>,
    /// Window while its device is being opened.
    opening: Option<Arc<Window>>,
    pending: Rc<RefCell<Pending>>,
    outside: Outside,
    wake: Wake,
    devices: u32,
    begun: Instant,
    last: Instant,
    /// True if the controls were laid out, so that the size of the picture is known.
    is_laid_out: bool,
    /// Time at which the controls want to be drawn again by themselves.
    due: Option<Instant>,
    /// Id of the scene in the window's title: [`crate::stage::Stage::id`].
    titled: Option<u64>,
    /// True once the maps were held and the eye stepped back, after the first picture.
    stepped_back: bool,
    /// Error that ended the viewer, if it did not do what it was asked for.
    pub failure: Option<Error>,
}

impl Viewer {
    fn new(options: Options, proxy: EventLoopProxy<News>) -> Self {
        let proxy = Arc::new(std::sync::Mutex::new(proxy));
        let wake = move || {
            let proxy = proxy.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            // The loop has ended once the window is closed; nobody is to be woken then.
            let _closed = proxy.send_event(News);
        };
        let mut session = Session::new(options.config.clone(), options.request.size);
        session.show = options.show.clone();
        session.other = options.other.clone();
        session.playing = options.runs;
        options.notes.iter().for_each(|note| session.say(false, note.clone()));
        let wake: Wake = Arc::new(wake);
        let mut app = App::new(session, Arc::clone(&wake));
        app.bare = options.bare;
        app.open(options.request.clone());
        let ctx = context(options.scale);
        let now = Instant::now();
        Self {
            options,
            app,
            ctx,
            shown: None,
            opening: None,
            pending: Rc::default(),
            outside: Outside::listen(Arc::clone(&wake)),
            wake,
            devices: 0,
            begun: now,
            last: now,
            is_laid_out: false,
            due: None,
            titled: None,
            stepped_back: false,
            failure: None,
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        // The page's address shows the same again.
        if self.app.session.stage.is_some() {
            self.app.link();
        }
        platform::give_up(&error);
        self.failure = Some(error);
        events.exit();
    }

    /// Ends because there is no device any more, with the command that shows the same again.
    fn fail_lost(&mut self, events: &ActiveEventLoop, why: &str) {
        let again = self.app.command_line();
        self.fail(events, Error::Lost { why: why.to_owned(), again });
    }

    /// Opens a device for the window, and the window if there is none.
    fn open(&mut self, events: &ActiveEventLoop, window: Option<Arc<Window>>) {
        let request = &self.options.request;
        let window = match window {
            Some(window) => window,
            None => match events.create_window(platform::attributes(&title(&request.scene), request.size)) {
                Ok(window) => Arc::new(window),
                Err(error) => return self.fail(events, Error::NoWindow(error.to_string())),
            },
        };
        self.opening = Some(Arc::clone(&window));
        let (pending, wake) = (Rc::clone(&self.pending), Arc::clone(&self.wake));
        let opened = Shown::open(window, events.owned_display_handle(), self.ctx.clone(), Arc::clone(&self.wake));
        platform::finish(async move {
            let opened = opened.await;
            pending.borrow_mut().opened = Some(opened);
            wake();
        });
        self.take_pending(events);
    }

    /// Takes over the operations that are ready.
    fn take_pending(&mut self, events: &ActiveEventLoop) {
        let Pending { opened, pictures } = std::mem::take(&mut *self.pending.borrow_mut());
        match opened {
            None => {}
            Some(Ok(shown)) => {
                self.opening = None;
                if platform::SHARES_DEVICE {
                    self.app.share_device(shown.gpu.clone());
                }
                shown.window.request_redraw();
                self.shown = Some(shown);
            }
            Some(Err(error)) if self.devices > 0 => self.fail_lost(events, &error.to_string()),
            Some(Err(error)) => self.fail(events, error),
        }
        for (purpose, picture) in pictures {
            match purpose {
                Purpose::Keep => self.keep(picture),
                Purpose::End(path) => self.end(events, path, picture),
            }
        }
    }

    /// Runs one frame of the window.
    fn frame(&mut self, events: &ActiveEventLoop) {
        let now = Instant::now();
        let seconds = now.duration_since(self.last).as_secs_f64();
        self.last = now;
        if self.is_laid_out {
            self.app.step(seconds);
        }
        self.step_back();
        // What comes while the controls are drawn is not in them yet.
        let complete = self.is_complete();
        let arrivals = self.outside.arrivals();
        if let Some(Arrival::Lost(why)) = arrivals.iter().find(|arrival| matches!(arrival, Arrival::Lost(_))) {
            return self.fail_lost(events, why);
        }
        let Some(shown) = &mut self.shown else { return };
        if let Some(stage) = self.app.session.stage.as_ref().filter(|stage| Some(stage.id) != self.titled) {
            self.titled = Some(stage.id);
            shown.window.set_title(&title(&stage.request.scene));
        }
        let mut input = shown.input.take_egui_input(&shown.window);
        let app = &mut self.app;
        for arrival in arrivals {
            if let Arrival::Pasted(text) = &arrival {
                input.events.push(egui::Event::Paste(text.clone()));
            }
            app.arrive(arrival);
        }
        let mut output = self.ctx.run_ui(input, |ui| app.ui(ui));
        platform::take_copies(&mut output.platform_output);
        // What the controls changed is ordered at once. Before they were laid out, nobody knew how
        // large the picture is.
        self.is_laid_out = true;
        app.step(0.0);
        shown.input.handle_platform_output(&shown.window, output.platform_output);
        let delay =
            output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |viewport| viewport.repaint_delay);
        self.due = now.checked_add(delay);
        let triangles = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let painted = shown.paint(&triangles, output.textures_delta, output.pixels_per_point);
        match painted {
            Painted::Shown | Painted::Hidden => {}
            Painted::Lost => return self.reopen(events),
        }
        platform::tell(|| told(&self.app));
        if std::mem::take(&mut self.app.wants_screenshot) {
            self.snap(Purpose::Keep, &triangles, output.pixels_per_point);
        }
        self.end_with_screenshot(events, complete, &triangles, output.pixels_per_point);
        self.take_pending(events);
    }

    /// Holds the maps of the first view and looks at them from behind, if asked for.
    fn step_back(&mut self) {
        let session = &mut self.app.session;
        if !self.options.held || self.stepped_back || session.drawn.is_none() {
            return;
        }
        self.stepped_back = true;
        session.freeze(true);
        let back = session.camera.as_ref().and_then(|camera| from_behind(camera.view(), camera.pivot()));
        if let Some(view) = back {
            session.jump(view);
        }
    }

    /// Opens the window's device again. All else goes on.
    fn reopen(&mut self, events: &ActiveEventLoop) {
        self.devices += 1;
        let window = self.shown.take().map(|shown| shown.window);
        if self.devices > MOST_DEVICES {
            return self.fail_lost(events, &format!("it was lost {MOST_DEVICES} times"));
        }
        self.app.session.say(false, "the window's graphics device was lost and opened again");
        // What was passed to the former device has to be passed again.
        self.ctx = context(self.options.scale);
        self.app.textures = crate::textures::Textures::default();
        self.open(events, window);
    }

    /// Takes a screenshot of the window.
    fn snap(&mut self, purpose: Purpose, triangles: &[egui::ClippedPrimitive], scale: f32) {
        let Some(shown) = &mut self.shown else { return };
        let picture = shown.picture(triangles, scale);
        let (pending, wake) = (Rc::clone(&self.pending), Arc::clone(&self.wake));
        platform::finish(async move {
            let picture = picture.await;
            pending.borrow_mut().pictures.push((purpose, picture));
            wake();
        });
    }

    /// Saves a screenshot of the window.
    fn keep(&mut self, picture: Result<RgbaImage, String>) {
        let kept = picture.and_then(|picture| platform::save("umbrage-view", "png", &png(&picture)?));
        match kept {
            Ok(file) => self.app.session.say(false, format!("wrote {file}")),
            Err(why) => self.app.session.say(true, why),
        }
    }

    /// Writes the screenshot and ends.
    fn end(&mut self, events: &ActiveEventLoop, path: PathBuf, picture: Result<RgbaImage, String>) {
        let written = picture
            .and_then(|picture| png(&picture))
            .and_then(|bytes| std::fs::write(&path, bytes).map_err(|error| error.to_string()));
        match written {
            Ok(()) => events.exit(),
            Err(reason) => self.fail(events, Error::Screenshot { path, reason }),
        }
    }

    /// Returns whether all that a screenshot should show is there.
    fn is_complete(&self) -> bool {
        let session = &self.app.session;
        session.opening.is_none()
            && session.pictures >= self.options.frames
            // While time runs there is always a newer picture.
            && (session.is_up_to_date() || self.options.runs)
            && (!self.options.held || self.stepped_back)
    }

    /// Takes the screenshot of a complete frame.
    fn end_with_screenshot(
        &mut self,
        events: &ActiveEventLoop,
        complete: bool,
        triangles: &[egui::ClippedPrimitive],
        scale: f32,
    ) {
        let Some(path) = self.options.screenshot.clone() else { return };
        let session = &self.app.session;
        let error = session.messages.iter().find(|message| message.is_error).map(|message| message.text.clone());
        if let (Some(why), None) = (error, &session.opening) {
            return self.fail(events, Error::NotShown(why));
        }
        if self.begun.elapsed() > PATIENCE {
            let why = format!("the scene was not shown within {} s", PATIENCE.as_secs());
            return self.fail(events, Error::NotShown(why));
        }
        if !complete || !self.app.is_shown() {
            return;
        }
        self.snap(Purpose::End(path), triangles, scale);
    }
}

/// Returns the window's title.
fn title(scene: &str) -> String {
    format!("umbrage: {scene}")
}

/// Returns the state of the viewer, for programs that read it. Where there is an address, it is
/// updated to the current view.
fn told(app: &App) -> Vec<(&'static str, String)> {
    let session = &app.session;
    let errors: Vec<&str> =
        session.messages.iter().filter(|message| message.is_error).map(|message| message.text.as_str()).collect();
    let is_all_shown = session.is_settled() && app.is_shown();
    let mut told = vec![
        ("adapter", session.adapter.clone().unwrap_or_default()),
        ("pictures", session.pictures.to_string()),
        ("shown", if is_all_shown { "all" } else { "" }.to_owned()),
        ("errors", errors.join("\n")),
    ];
    told.extend(session.drawn.as_ref().map(|drawn| ("wall", format!("{:.0}", drawn.wall_ms))));
    if is_all_shown {
        told.push(("command", app.command_line()));
        app.link();
    }
    told
}

/// Makes the context of controls that are readable beside a bright picture.
fn context(scale: f32) -> egui::Context {
    let ctx = egui::Context::default();
    platform::adapt(&ctx);
    ctx.set_theme(egui::Theme::Dark);
    ctx.set_zoom_factor(scale);
    ctx.all_styles_mut(|style| {
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(11.0));
        style.visuals.override_text_color = Some(egui::Color32::from_gray(222));
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(165));
    });
    ctx
}

/// Returns a view of a view: from behind and above, towards its pivot.
fn from_behind(view: &View, pivot: glam::DVec3) -> Option<View> {
    let distance = view.eye().distance(pivot).max(1.0);
    let axes = view.world_from_view_rotation();
    let eye = view.eye() - view.forward() * distance * STEP_BACK
        + glam::DVec3::Y * distance * 0.7
        + axes.x_axis * distance * 0.5;
    View::look_at_upright(eye, view.eye() + view.forward() * distance * 0.5, *view.frustum()).ok()
}

impl ApplicationHandler<News> for Viewer {
    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(shown)) = (cause, &self.shown) {
            shown.window.request_redraw();
        }
    }

    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() && self.opening.is_none() {
            self.open(events, None);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, _: News) {
        self.take_pending(events);
        if let Some(shown) = &self.shown {
            shown.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        if event == WindowEvent::RedrawRequested {
            return self.frame(events);
        }
        let response = shown.input.on_window_event(&shown.window, &event);
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => shown.resize(size),
            _ => {}
        }
        if response.repaint {
            shown.window.request_redraw();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let flow = match self.due {
            Some(due) if due <= Instant::now() => {
                self.due = None;
                if let Some(shown) = &self.shown {
                    shown.window.request_redraw();
                }
                ControlFlow::Wait
            }
            Some(due) => ControlFlow::WaitUntil(due),
            None => ControlFlow::Wait,
        };
        events.set_control_flow(flow);
    }
}

fn png(picture: &RgbaImage) -> Result<Vec<u8>, String> {
    umbrage_lab::picture::png(picture).map_err(|failure| failure.to_string())
}
