//! `umbrage view` in a real window: under Xvfb, by the command itself.
#![cfg(feature = "view")]

mod common;

use std::io::Read as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use image::RgbaImage;

/// A screen of its own, ended with the test.
struct Screen {
    server: Child,
    display: String,
}

impl Screen {
    /// `None`, said loudly, where there is no Xvfb; `UMBRAGE_REQUIRE_SCREEN=1` turns that into a
    /// failure.
    fn open() -> Option<Self> {
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match server {
            Ok(server) => server,
            Err(error) if std::env::var("UMBRAGE_REQUIRE_SCREEN").is_ok_and(|value| value == "1") => {
                panic!("Xvfb: {error}")
            }
            Err(error) => {
                eprintln!("SKIPPED: no Xvfb: {error}");
                return None;
            }
        };
        let mut number = Vec::new();
        let mut out = server.stdout.take().expect("a pipe");
        let mut byte = [0];
        // A line with the number of the display, once the screen is there.
        while out.read(&mut byte).is_ok_and(|read| read == 1) && byte != *b"\n" {
            number.push(byte[0]);
        }
        let number = String::from_utf8(number).expect("a number");
        assert!(!number.is_empty(), "Xvfb opened no display");
        Some(Self { server, display: format!(":{number}") })
    }

    /// `umbrage view` with these arguments: whether it succeeded, and what it printed as errors.
    fn view(&self, arguments: &[&str]) -> (bool, String) {
        let output = Command::new(common::UMBRAGE)
            .arg("view")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .expect("the command runs");
        (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        drop(self.server.kill());
        drop(self.server.wait());
    }
}

fn picture(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgba8()
}

/// Share of the pixels that differ by more than 8 of 255 in some channel.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| (0..3).any(|i| a.0[i].abs_diff(b.0[i]) > 8);
    a.pixels().zip(b.pixels()).filter(differs).count() as f64 / f64::from(a.width() * a.height())
}

#[test]
fn the_window_shows_what_the_command_draws() {
    let Some(screen) = Screen::open().filter(|_| common::has_adapter()) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let (seen, drawn, tinted) =
        (folder.path().join("seen.png"), folder.path().join("drawn.png"), folder.path().join("t.png"));
    let config = ["--size", "320x240", "--preset", "fast", "--camera", "middle"];
    let shot = |path: &Path, more: &[&str]| {
        let path = path.display().to_string();
        let arguments = [&["chessboard", "--bare", "--screenshot", &path], &config[..], more].concat();
        let (success, errors) = screen.view(&arguments);
        assert!(success, "{errors}");
    };
    shot(&seen, &[]);
    shot(&tinted, &["--tint"]);
    let path = drawn.display().to_string();
    common::Folder::new().succeed(&format!("render chessboard -o {path} {}", config.join(" ")));
    let (seen, drawn, tinted) = (picture(&seen), picture(&drawn), picture(&tinted));
    assert!(difference(&seen, &drawn) <= 0.005, "{}", difference(&seen, &drawn));
    assert!(difference(&tinted, &drawn) > 0.2, "the comparison can say no: {}", difference(&tinted, &drawn));
}

#[test]
fn everything_can_be_shown_at_once() {
    let Some(screen) = Screen::open().filter(|_| common::has_adapter()) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("all.png");
    let text = path.display().to_string();
    let (success, errors) = screen.view(&[
        "chessboard",
        "--size",
        "900x600",
        "--preset=fast",
        "--show",
        "tint,held,errors,maps",
        "--compare",
        "papers",
        "--frames",
        "2",
        "--screenshot",
        &text,
    ]);
    assert!(success, "{errors}");
    let all = picture(&path);
    assert_eq!(all.dimensions(), (900, 600));
    let colours: std::collections::BTreeSet<[u8; 4]> = all.pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 500, "{} colours are no picture", colours.len());
}

#[test]
fn a_scene_that_cannot_be_shown_ends_a_screenshot_with_its_reason() {
    let Some(screen) = Screen::open().filter(|_| common::has_adapter()) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("none.png");
    let (success, errors) = screen.view(&["no-such-scene.glb", "--screenshot", &path.display().to_string()]);
    assert!(!success && errors.contains("no-such-scene.glb"), "{errors}");
    assert!(!path.exists());
}

#[test]
fn without_a_screen_the_command_says_what_to_do() {
    let output = Command::new(common::UMBRAGE)
        .args(["view", "chessboard"])
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the command runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains("xvfb-run"), "{errors}");
}

#[test]
fn options_that_lead_nowhere_are_refused() {
    for (arguments, word) in [
        (&["view", "--frames", "3"][..], "--screenshot"),
        (&["view", "--sun-to", "1,-1,0", "--frames", "3", "--screenshot", "x.png"], "--sun-to"),
        (&["view", "--show", "fog"], "fog"),
        (&["view", "--scale", "9"], "--scale"),
        (&["view", "--compare", "best"], "--compare"),
        (&["view", "--screenshot", "no-such-folder/x.png"], "no-such-folder"),
    ] {
        let output = Command::new(common::UMBRAGE).args(arguments).output().expect("the command runs");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(errors.contains(word), "{arguments:?}: {errors}");
    }
}
