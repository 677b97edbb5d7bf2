//! A page in a browser: tasks in place of threads, addresses in place of files.

mod outside;
mod page;
mod tasks;

use std::sync::Arc;
use std::time::Duration;

use umbrage::{Light, View};
use umbrage_lab::failure::Failure;
use umbrage_lab::scene_request::SceneRequest;
use umbrage_render::Gpu;
use umbrage_scene::Scene;
use umbrage_scene::procedural::World;
use umbrage_truth::{Truth, TruthMask};
use wasm_bindgen::JsCast;
use web_time::Instant;
use winit::application::ApplicationHandler;
use winit::event_loop::{EventLoop, OwnedDisplayHandle};
use winit::platform::web::{EventLoopExtWebSys, WindowAttributesExtWebSys};
use winit::window::{Window, WindowAttributes};

pub(crate) use self::outside::Outside;
pub(crate) use self::page::{first_address, give_up, link, save, take_copies, tell};
pub use self::tasks::Movable;
pub(crate) use self::tasks::{finish, pause, sleep, spawn};
use crate::{Error, Result};

/// True if the renderer of the scene uses the window's device.
pub(crate) const SHARES_DEVICE: bool = true;

/// Longest time for which rays are traced before the page may go on.
const TRACED_AT_ONCE: Duration = Duration::from_millis(40);

/// Opens WebGPU, or WebGL2 where that is missing.
pub(crate) async fn instance(display: OwnedDisplayHandle) -> wgpu::Instance {
    let wanted = wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display));
    let backends = match page::query("api").as_deref() {
        Some("webgl2") => wgpu::Backends::GL,
        _ => wgpu::Backends::BROWSER_WEBGPU | wgpu::Backends::GL,
    };
    wgpu::util::new_instance_with_webgpu_detection(wgpu::InstanceDescriptor { backends, ..wanted }).await
}

/// Returns the page's canvas as a window.
pub(crate) fn attributes(_title: &str, _size: [u32; 2]) -> WindowAttributes {
    let canvas = page::element(page::CANVAS).and_then(|element| element.dyn_into().ok());
    // What the page keeps from the browser is chosen key by key: see `outside`.
    Window::default_attributes().with_canvas(canvas).with_prevent_default(false)
}

/// Makes the error of a missing graphics interface.
pub(crate) fn no_graphics(reason: String) -> Error {
    Error::NoInterface(reason)
}

/// Adapts the controls to a browser: its zoom keys stay its own, and only those of `egui`'s fonts
/// are there that the controls use.
pub(crate) fn adapt(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    let agent = page::window().and_then(|window| window.navigator().user_agent().ok());
    ctx.set_os(egui::os::OperatingSystem::from_user_agent(&agent.unwrap_or_default()));
}

/// Returns the fonts of the controls: one face for letters, code among them, and one for signs. A
/// face of its own for code is 150 kB to load, for one field.
fn fonts() -> egui::FontDefinitions {
    let faces =
        [("Ubuntu-Light", epaint_default_fonts::UBUNTU_LIGHT), ("egui-icons", epaint_default_fonts::EGUI_ICONS)];
    let mut fonts = egui::FontDefinitions::empty();
    for (name, bytes) in faces {
        fonts.font_data.insert(name.to_owned(), Arc::new(egui::FontData::from_static(bytes)));
    }
    for family in [egui::FontFamily::Proportional, egui::FontFamily::Monospace] {
        fonts.families.insert(family, faces.map(|(name, _)| name.to_owned()).to_vec());
    }
    fonts
}

/// Returns whether pipelines are worth making before they are needed: browsers check and translate
/// what they are given for WebGPU before a driver compiles it.
pub(crate) fn makes_pipelines_slowly(gpu: &Gpu) -> bool {
    gpu.adapter_info.backend == wgpu::Backend::BrowserWebGpu
}

/// Opens the scene of a request: a world, bytes that were dropped, or an address of the page's own
/// server.
///
/// # Errors
/// [`Failure::Input`] with the address or the file at fault.
pub(crate) async fn scene(request: &SceneRequest, bytes: Option<Arc<[u8]>>) -> Result<Scene, Failure> {
    // The page shows what it is about to do.
    pause().await;
    if bytes.is_none() && World::from_name(&request.scene).is_some() {
        return Ok(umbrage_scene::open(&request.scene, &request.files)?);
    }
    let bytes = match bytes {
        Some(bytes) => bytes,
        None => page::fetched(&request.scene).await.map_err(Failure::input)?.into(),
    };
    Ok(umbrage_scene::open_slice(&request.scene, &bytes, &request.files)?)
}

/// Traces a mask in pieces, between which the page can go on.
///
/// # Errors
/// As [`Truth::begin_mask`].
pub(crate) async fn mask(
    truth: &Truth,
    view: &View,
    light: &Light,
    size: [u32; 2],
    progress: &(dyn Fn(f32) + Sync),
) -> umbrage_truth::Result<TruthMask> {
    let mut tracing = truth.begin_mask(view, light, size)?;
    let mut since = Instant::now();
    loop {
        let done = tracing.advance();
        progress(done);
        if done >= 1.0 {
            return Ok(tracing.finish().expect("all rows are traced"));
        }
        if since.elapsed() > TRACED_AT_ONCE {
            pause().await;
            since = Instant::now();
        }
    }
}

/// Returns the address of a file of the repository: below the page, where `cargo xtask web` puts
/// it.
///
/// # Errors
/// None here. A missing file is an error when it is fetched.
pub(crate) fn shipped(file: &str) -> Result<String, String> {
    Ok(file.to_owned())
}

/// Starts the viewer, which goes on after this function has returned.
#[expect(clippy::unnecessary_wraps, reason = "as events may stop coming")]
pub(crate) fn run<T: 'static, V: ApplicationHandler<T> + 'static>(
    events: EventLoop<T>,
    viewer: V,
) -> Result<Option<V>> {
    events.spawn_app(viewer);
    Ok(None)
}

/// Shows panics on the page, where there is no viewer to show them.
pub(crate) fn say_panics() {
    std::panic::set_hook(Box::new(|panic| {
        give_up(&Error::Defect(panic.to_string()));
    }));
}
