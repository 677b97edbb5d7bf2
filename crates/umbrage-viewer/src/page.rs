//! The viewer as a page, opened by the page's address.

use umbrage_lab::scene_request::SceneRequest;

use crate::link::{self, Linked};
use crate::{Options, platform};

/// Scene that is shown if the address names none: the smallest world.
const FIRST_SCENE: &str = "chessboard";
/// Size in pixels until the canvas reports its own.
const FIRST_SIZE: [u32; 2] = [800, 600];

/// Opens the viewer on the page's canvas.
pub fn open() {
    platform::say_panics();
    let (scene, fragment) = platform::first_address();
    let scene = scene.as_deref().unwrap_or(FIRST_SCENE);
    let read = link::read(&fragment, scene, FIRST_SIZE);
    let wrong = read.as_ref().err().cloned();
    let linked = read.unwrap_or_else(|_| Linked {
        request: SceneRequest::new(scene, FIRST_SIZE),
        config: umbrage::ShadowConfig::default(),
        tint: false,
        bare: false,
        runs: false,
        notes: Vec::new(),
    });
    let options = Options::of_link(linked, wrong);
    if let Err(error) = crate::run(options) {
        platform::give_up(&error);
    }
}
