//! The viewer as a page: what its address asks for.

use umbrage_lab::scene_request::SceneRequest;

use crate::link::{self, Linked};
use crate::{Options, platform};

/// What is shown if the address names no scene: the smallest world.
const FIRST_SCENE: &str = "chessboard";
/// Pixels until the canvas has said how many it has.
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
