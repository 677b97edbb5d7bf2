//! A program on a desktop: threads, files, the system's clipboard.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use umbrage::{Light, View};
use umbrage_lab::failure::Failure;
use umbrage_lab::scene_request::SceneRequest;
use umbrage_render::Gpu;
use umbrage_scene::Scene;
use umbrage_truth::{Truth, TruthMask};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event_loop::{EventLoop, OwnedDisplayHandle};
use winit::window::{Window, WindowAttributes};

use super::{Arrival, Wake};
use crate::{Error, Result};

/// True if the renderer of the scene uses the window's device.
pub(crate) const SHARES_DEVICE: bool = false;

/// Type that can be passed to [`spawn`].
pub trait Movable: Send {}
impl<T: Send> Movable for T {}

/// Runs a future to its end on a thread of its own.
pub(crate) fn spawn<F: Future<Output = ()>>(
    name: &str,
    make: impl FnOnce() -> F + Movable + 'static,
) -> std::io::Result<()> {
    std::thread::Builder::new().name(name.to_owned()).spawn(move || pollster::block_on(make())).map(drop)
}

/// Runs a future to its end at once.
pub(crate) fn finish(future: impl Future<Output = ()> + 'static) {
    pollster::block_on(future);
}

/// Lets other tasks run. Threads do so by themselves.
pub(crate) async fn pause() {}

/// Waits for some time, in which other threads go on.
pub(crate) async fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// Opens the graphics interface for a display.
pub(crate) async fn instance(display: OwnedDisplayHandle) -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(Box::new(display)))
}

/// Returns the attributes of the window: its title, and its width and height in pixels.
pub(crate) fn attributes(title: &str, [width, height]: [u32; 2]) -> WindowAttributes {
    Window::default_attributes().with_title(title).with_inner_size(PhysicalSize::new(width, height))
}

/// Makes the error of a missing graphics adapter.
pub(crate) fn no_graphics(reason: String) -> Error {
    Error::NoAdapter(reason)
}

/// Adapts the controls to the platform; a desktop needs no adaptation.
pub(crate) fn adapt(_: &egui::Context) {}

/// Returns false: the studio's thread makes pipelines beside the window.
pub(crate) fn makes_pipelines_slowly(_: &Gpu) -> bool {
    false
}

/// Opens the scene of a request: a world or a file. `bytes` are never given here.
///
/// # Errors
/// [`Failure::Input`] with the file at fault.
pub(crate) async fn scene(request: &SceneRequest, _bytes: Option<Arc<[u8]>>) -> Result<Scene, Failure> {
    Ok(umbrage_scene::open(&request.scene, &request.files)?)
}

/// Traces a mask on every core.
///
/// # Errors
/// As [`Truth::mask_under`].
pub(crate) async fn mask(
    truth: &Truth,
    view: &View,
    light: &Light,
    size: [u32; 2],
    progress: &(dyn Fn(f32) + Sync),
) -> umbrage_truth::Result<TruthMask> {
    truth.mask_under(view, light, size, progress)
}

/// Finds a file of the repository below the working folder, or below a folder around the program.
///
/// # Errors
/// The folders that were searched.
pub(crate) fn shipped(file: &str) -> Result<String, String> {
    let here = std::env::current_dir().ok();
    let program = std::env::current_exe().ok();
    let folders = here.iter().chain(&program).flat_map(|path| path.ancestors());
    let found = folders.map(|folder| folder.join(file)).find(|path| path.is_file());
    found.map(|path| path.display().to_string()).ok_or_else(|| {
        format!(
            "{file}: not found below this folder or the program's; start in umbrage's repository, or drop the file here"
        )
    })
}

/// Writes a new file into the working folder, `NAME-0001.EXTENSION` and so on, and returns its
/// name.
///
/// # Errors
/// The reason why it cannot be written, for users.
pub(crate) fn save(name: &str, extension: &str, bytes: &[u8]) -> Result<String, String> {
    let failed = |path: &Path, error: &std::io::Error| Failure::file("write", path, error).to_string();
    for number in 1..10_000 {
        let path = PathBuf::from(format!("{name}-{number:04}.{extension}"));
        match std::fs::File::create_new(&path) {
            Ok(mut file) => {
                let written = file.write_all(bytes).map(|()| path.display().to_string());
                return written.map_err(|error| failed(&path, &error));
            }
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(failed(&path, &error)),
        }
    }
    Err(format!("{name}-0001.{extension} to {name}-9999.{extension} are there already; clear some away"))
}

/// Returns `None`, because a program has no address.
pub(crate) fn link(_fragment: &str) -> Option<String> {
    None
}

/// Does nothing, because the controls can copy by themselves.
pub(crate) fn take_copies(_: &mut egui::PlatformOutput) {}

/// Does nothing, because no program reads the state.
pub(crate) fn tell(_: impl FnOnce() -> Vec<(&'static str, String)>) {}

/// Does nothing, because [`crate::run`] returns the error.
pub(crate) fn give_up(_: &Error) {}

/// Events from outside of the window; `winit` reports all of them on a desktop.
#[derive(Debug)]
pub(crate) struct Outside;

impl Outside {
    /// Starts listening.
    pub fn listen(_: Wake) -> Self {
        Self
    }

    /// Takes the events that have arrived.
    pub fn arrivals(&self) -> Vec<Arrival> {
        Vec::new()
    }
}

/// Runs the viewer until it ends, and gives it back.
///
/// # Errors
/// [`Error::NoScreen`] if events stop coming.
pub(crate) fn run<T: 'static, V: ApplicationHandler<T>>(events: EventLoop<T>, mut viewer: V) -> Result<Option<V>> {
    events.run_app(&mut viewer).map_err(|error| Error::NoScreen(error.to_string()))?;
    Ok(Some(viewer))
}
