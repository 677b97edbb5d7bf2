//! The window: events in, controls out, and what happens when a surface or a device is lost.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::ViewportId;
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;
use umbrage::View;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use crate::app::App;
use crate::session::Session;
use crate::{Error, Options, Result};

/// How often a device is opened again, at most, before the viewer ends.
const MOST_DEVICES: u32 = 5;
/// How long a screenshot may take to be complete, at most.
const PATIENCE: Duration = Duration::from_secs(600);
/// Metres, as a share of the distance to what is looked at, from held maps to the eye that looks at
/// them.
const STEP_BACK: f64 = 0.9;

/// Something on another thread is new.
#[derive(Clone, Copy, Debug)]
struct News;

/// Opens the window and shows the scene until it is closed, or until the screenshot is written.
///
/// # Errors
/// [`Error`] if there is no screen, no adapter, or the screenshot cannot be made.
pub fn run(options: Options) -> Result<()> {
    let events = EventLoop::<News>::with_user_event().build().map_err(|error| Error::NoScreen(error.to_string()))?;
    let mut viewer = Viewer::new(options, events.create_proxy());
    events.run_app(&mut viewer).map_err(|error| Error::NoScreen(error.to_string()))?;
    viewer.failure.map_or(Ok(()), Err)
}

/// The viewer in its window.
struct Viewer {
    options: Options,
    app: App,
    ctx: egui::Context,
    shown: Option<Shown>,
    devices: u32,
    begun: Instant,
    last: Instant,
    /// When the controls want to be drawn again by themselves.
    due: Option<Instant>,
    /// [`crate::stage::Stage::id`] of the scene in the window's title.
    titled: Option<u64>,
    /// Whether the maps were held and the eye stepped back, once there was a first picture.
    stepped_back: bool,
    failure: Option<Error>,
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
        options.notes.iter().for_each(|note| session.say(false, note.clone()));
        let mut app = App::new(session, Arc::new(wake));
        app.bare = options.bare;
        app.open(options.request.clone());
        let ctx = context(options.scale);
        let now = Instant::now();
        Self {
            options,
            app,
            ctx,
            shown: None,
            devices: 0,
            begun: now,
            last: now,
            due: None,
            titled: None,
            stepped_back: false,
            failure: None,
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.failure = Some(error);
        events.exit();
    }

    /// One frame of the window.
    fn frame(&mut self, events: &ActiveEventLoop) {
        let now = Instant::now();
        let seconds = now.duration_since(self.last).as_secs_f64();
        self.last = now;
        self.app.step(seconds);
        self.step_back();
        // What comes while the controls are drawn is not in them yet.
        let complete = self.is_complete();
        let Some(shown) = &mut self.shown else { return };
        if let Some(stage) = self.app.session.stage.as_ref().filter(|stage| Some(stage.id) != self.titled) {
            self.titled = Some(stage.id);
            shown.window.set_title(&format!("umbrage: {}", stage.request.scene));
        }
        let input = shown.input.take_egui_input(&shown.window);
        let app = &mut self.app;
        let output = self.ctx.run_ui(input, |ui| app.ui(ui));
        // What the controls changed is ordered at once.
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
        if std::mem::take(&mut self.app.wants_screenshot) {
            self.snap(&triangles, output.pixels_per_point);
        }
        self.end_with_screenshot(events, complete, &triangles, output.pixels_per_point);
    }

    /// Holds the maps of the first view and looks at them from behind, if that was asked for.
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

    /// Opens the window's device again: everything else goes on.
    fn reopen(&mut self, events: &ActiveEventLoop) {
        self.devices += 1;
        let window = self.shown.take().map(|shown| shown.window);
        if self.devices > MOST_DEVICES {
            let again = self.app.command_line();
            let why = format!("it was lost {MOST_DEVICES} times; this shows the same again: {again}");
            return self.fail(events, Error::Lost(why));
        }
        self.app.session.say(false, "the window's graphics device was lost and opened again");
        // What was passed to the former device has to be passed again.
        self.ctx = context(self.options.scale);
        self.app.textures = crate::textures::Textures::default();
        match Shown::open(events, window, &self.options, &self.ctx) {
            Ok(shown) => self.shown = Some(shown),
            Err(error) => self.fail(events, error),
        }
    }

    /// A picture of the window into the working folder.
    fn snap(&mut self, triangles: &[egui::ClippedPrimitive], scale: f32) {
        let Some(shown) = &mut self.shown else { return };
        let written =
            shown.picture(triangles, scale).and_then(|picture| write_new("umbrage-view", "png", &png(&picture)?));
        match written {
            Ok(file) => self.app.session.say(false, format!("wrote {}", file.display())),
            Err(why) => self.app.session.say(true, why),
        }
    }

    /// Whether all that a screenshot should show is there.
    fn is_complete(&self) -> bool {
        let session = &self.app.session;
        session.opening.is_none()
            && session.pictures >= self.options.frames
            && session.is_up_to_date()
            && (!self.options.held || self.stepped_back)
    }

    /// Writes the screenshot of a complete frame and ends.
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
        let Some(shown) = &mut self.shown else { return };
        let wrong = |reason: String| Error::Screenshot { path: path.clone(), reason };
        let written = shown
            .picture(triangles, scale)
            .and_then(|picture| png(&picture))
            .and_then(|bytes| std::fs::write(&path, bytes).map_err(|error| error.to_string()));
        match written {
            Ok(()) => events.exit(),
            Err(why) => self.fail(events, wrong(why)),
        }
    }
}

/// Controls that can be read beside a bright picture.
fn context(scale: f32) -> egui::Context {
    let ctx = egui::Context::default();
    ctx.set_theme(egui::Theme::Dark);
    ctx.set_zoom_factor(scale);
    ctx.all_styles_mut(|style| {
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(11.0));
        style.visuals.override_text_color = Some(egui::Color32::from_gray(222));
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(165));
    });
    ctx
}

/// A view of a view: from behind and above, on what it looks at.
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
        if self.shown.is_some() {
            return;
        }
        match Shown::open(events, None, &self.options, &self.ctx) {
            Ok(shown) => self.shown = Some(shown),
            Err(error) => self.fail(events, error),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: News) {
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

/// What became of a frame.
enum Painted {
    /// It is on the screen.
    Shown,
    /// The window has no pixels now.
    Hidden,
    /// The device is gone.
    Lost,
}

/// A window with what draws into it.
struct Shown {
    window: Arc<Window>,
    input: egui_winit::State,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    painter: egui_wgpu::Renderer,
    lost: Arc<std::sync::atomic::AtomicBool>,
}

impl Shown {
    fn open(
        events: &ActiveEventLoop,
        window: Option<Arc<Window>>,
        options: &Options,
        ctx: &egui::Context,
    ) -> Result<Self> {
        let window = match window {
            Some(window) => window,
            None => {
                let [width, height] = options.request.size;
                let attributes = Window::default_attributes()
                    .with_title(format!("umbrage: {}", options.request.scene))
                    .with_inner_size(PhysicalSize::new(width, height));
                let opened = events.create_window(attributes).map_err(|error| Error::NoWindow(error.to_string()))?;
                Arc::new(opened)
            }
        };
        let display = Box::new(events.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface =
            instance.create_surface(Arc::clone(&window)).map_err(|error| Error::NoWindow(error.to_string()))?;
        let wanted = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&wanted))
            .map_err(|error| Error::NoAdapter(error.to_string()))?;
        let described = wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&described))
            .map_err(|error| Error::NoAdapter(error.to_string()))?;
        let lost = Arc::new(std::sync::atomic::AtomicBool::new(false));
        let is_lost = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, _| is_lost.store(true, std::sync::atomic::Ordering::Relaxed));
        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| Error::NoAdapter("the adapter has no format for this window".to_owned()))?;
        // Controls are mixed as they are displayed.
        config.format = config.format.remove_srgb_suffix();
        let formats = surface.get_capabilities(&adapter).formats;
        if !formats.contains(&config.format) {
            config.format = formats.first().copied().unwrap_or(config.format);
        }
        surface.configure(&device, &config);
        let side = device.limits().max_texture_dimension_2d as usize;
        let scale = window.scale_factor() as f32;
        let input =
            egui_winit::State::new(ctx.clone(), ViewportId::ROOT, events, Some(scale), window.theme(), Some(side));
        let painter = egui_wgpu::Renderer::new(&device, config.format, painter_options());
        window.request_redraw();
        Ok(Self { window, input, surface, config, device, queue, painter, lost })
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        // A minimised window has none.
        if size.width > 0 && size.height > 0 {
            let most = self.device.limits().max_texture_dimension_2d;
            (self.config.width, self.config.height) = (size.width.min(most), size.height.min(most));
            self.surface.configure(&self.device, &self.config);
        }
    }

    /// Draws the controls into the window.
    fn paint(&mut self, triangles: &[egui::ClippedPrimitive], textures: egui::TexturesDelta, scale: f32) -> Painted {
        for (id, deltas) in textures.set.iter() {
            for delta in deltas {
                self.painter.update_texture(&self.device, &self.queue, *id, delta);
            }
        }
        let painted = self.present(triangles, scale);
        for id in &textures.free {
            self.painter.free_texture(id);
        }
        let mut textures = textures;
        textures.clear();
        painted
    }

    fn present(&mut self, triangles: &[egui::ClippedPrimitive], scale: f32) -> Painted {
        if self.lost.load(std::sync::atomic::Ordering::Relaxed) {
            return Painted::Lost;
        }
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Painted::Hidden;
        }
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => frame,
            wgpu::CurrentSurfaceTexture::Occluded => return Painted::Hidden,
            _ => {
                // Outdated or lost: created again, and tried again with the next frame.
                self.surface.configure(&self.device, &self.config);
                self.window.request_redraw();
                return Painted::Hidden;
            }
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(&view, [self.config.width, self.config.height], triangles, scale);
        self.window.pre_present_notify();
        self.queue.present(frame);
        Painted::Shown
    }

    fn draw(&mut self, target: &wgpu::TextureView, size: [u32; 2], triangles: &[egui::ClippedPrimitive], scale: f32) {
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: scale };
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        let before = self.painter.update_buffers(&self.device, &self.queue, &mut encoder, triangles, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("controls"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        let mut pass = pass.forget_lifetime();
        self.painter.render(&mut pass, triangles, &screen);
        drop(pass);
        self.queue.submit(before.into_iter().chain([encoder.finish()]));
    }

    /// The window's content as a picture: drawn once more, where it can be read.
    fn picture(&mut self, triangles: &[egui::ClippedPrimitive], scale: f32) -> Result<RgbaImage, String> {
        let (width, height) = (self.config.width, self.config.height);
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screenshot"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.config.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(&view, [width, height], triangles, scale);
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let back = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("screenshot"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("screenshot") });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        self.queue.submit([encoder.finish()]);
        back.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
        let bytes = back.get_mapped_range(..).map_err(|error| error.to_string())?;
        let swapped =
            matches!(self.config.format, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb);
        Ok(RgbaImage::from_fn(width, height, |x, y| {
            let at = (y * row + 4 * x) as usize;
            let [a, g, c, _] = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
            image::Rgba(if swapped { [c, g, a, 255] } else { [a, g, c, 255] })
        }))
    }
}

/// No noise against bands: a pixel of the picture is that pixel of the window.
fn painter_options() -> egui_wgpu::RendererOptions {
    egui_wgpu::RendererOptions { dithering: false, ..Default::default() }
}

fn png(picture: &RgbaImage) -> Result<Vec<u8>, String> {
    umbrage_lab::picture::png(picture).map_err(|failure| failure.to_string())
}

/// Writes a file that is not there yet into the working folder: `NAME-0001.EXTENSION` and so on.
///
/// # Errors
/// Why it cannot be written, for people.
pub fn write_new(name: &str, extension: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    for number in 1..10_000 {
        let path = PathBuf::from(format!("{name}-{number:04}.{extension}"));
        match std::fs::File::create_new(&path) {
            Ok(mut file) => return file.write_all(bytes).map(|()| path.clone()).map_err(|error| said(&path, &error)),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(said(&path, &error)),
        }
    }
    Err(format!("{name}-0001.{extension} to {name}-9999.{extension} are there already; clear some away"))
}

fn said(path: &Path, error: &std::io::Error) -> String {
    umbrage_lab::failure::Failure::file("write", path, error).to_string()
}
