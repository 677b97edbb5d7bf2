//! Tests of the controls without a window: displayed text, and the effects of keys, pasted text and
//! dropped files.

use std::path::PathBuf;

use egui::epaint::ClippedShape;
use egui::{Event, Key, Modifiers, Pos2, RawInput, Rect, Shape};
use umbrage::ShadowConfig;
use umbrage::config::{Kind, Preset, SETTINGS};

use super::*;
use crate::stage;

struct Desk {
    ctx: egui::Context,
    app: App,
    size: egui::Vec2,
    seconds: f64,
}

impl Desk {
    /// Makes a viewer with the chessboard and no threads.
    fn new() -> Self {
        let mut session = Session::new(ShadowConfig::default(), [640, 480]);
        let request = SceneRequest::new("chessboard", [64, 48]);
        session.enter(pollster::block_on(stage::open(request, None, |_| ())).expect("a world"));
        session.messages.clear();
        let ctx = egui::Context::default();
        ctx.all_styles_mut(|style| style.animation_time = 0.0);
        Self { ctx, app: App::new(session, Arc::new(|| ())), size: egui::vec2(1400.0, 900.0), seconds: 0.0 }
    }

    /// Runs a frame with these events and returns the texts on the screen.
    fn frame(&mut self, events: Vec<Event>) -> Vec<String> {
        self.seconds += 0.1;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size)),
            time: Some(self.seconds),
            focused: true,
            events,
            ..RawInput::default()
        };
        self.run(input)
    }

    fn run(&mut self, input: RawInput) -> Vec<String> {
        let app = &mut self.app;
        let mut output = self.ctx.run_ui(input, |ui| app.ui(ui));
        output.textures_delta.clear();
        let mut texts = Vec::new();
        output.shapes.iter().for_each(|ClippedShape { shape, clip_rect, .. }| collect(shape, *clip_rect, &mut texts));
        texts
    }

    fn press(&mut self, key: Key) -> Vec<String> {
        let event =
            |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
        self.frame(vec![event(true), event(false)])
    }
}

/// Collects the visible texts.
fn collect(shape: &Shape, clip: Rect, into: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, clip, into)),
        Shape::Text(text) if clip.intersects(text.visual_bounding_rect()) => into.push(text.galley.text().to_owned()),
        _ => {}
    }
}

fn has(texts: &[String], wanted: &str) -> bool {
    texts.iter().any(|text| text.contains(wanted))
}

#[test]
fn every_setting_has_a_control_with_its_line_of_help() {
    let mut desk = Desk::new();
    desk.frame(Vec::new());
    for setting in SETTINGS {
        desk.app.fields.search = setting.key.to_owned();
        desk.frame(Vec::new());
        let texts = desk.frame(Vec::new());
        assert!(texts.iter().any(|text| text == setting.key), "{} has no name: {texts:?}", setting.key);
        assert!(has(&texts, setting.help), "{} has no help", setting.key);
        let value = setting.get(&desk.app.session.config);
        let shown = match (&value, setting.kind) {
            (None, _) => has(&texts, "use") || has(&texts, "not used"),
            // A colour and a switch are shown as what they are, and one size stands for all.
            (Some(_), Kind::Colour | Kind::Switch) => true,
            (Some(_), Kind::Texels) => has(&texts, "1024"),
            (Some(value), _) => has(&texts, &value.to_string()),
        };
        assert!(shown, "{} shows no value ({value:?}): {texts:?}", setting.key);
    }
    desk.app.fields.search = "no such setting".to_owned();
    desk.frame(Vec::new());
    let texts = desk.frame(Vec::new());
    assert!(!has(&texts, SETTINGS[0].help), "the search can find nothing");
}

#[test]
fn every_preset_can_be_looked_at() {
    let mut desk = Desk::new();
    for preset in Preset::ALL {
        desk.app.session.set_config(preset.config());
        desk.frame(Vec::new());
        for tab in Tab::ALL {
            desk.app.session.show.tab = Some(tab.0);
            assert!(has(&desk.frame(Vec::new()), preset.word()));
        }
    }
}

#[test]
fn all_can_be_read_at_twice_the_size_in_a_small_window() {
    let mut desk = Desk::new();
    desk.size = egui::vec2(640.0, 400.0);
    desk.frame(Vec::new());
    let texts = desk.frame(Vec::new());
    for wanted in ["Scene", "Shadows", "balanced", "Huge Chessboard", "Help F1"] {
        assert!(has(&texts, wanted), "{wanted} is not to be seen: {texts:?}");
    }
}

#[test]
fn the_picture_keeps_its_size_whatever_the_status_says() {
    let mut desk = Desk::new();
    desk.size = egui::vec2(800.0, 500.0);
    desk.frame(Vec::new());
    desk.frame(Vec::new());
    let size = desk.app.session.size;
    desk.app.session.busy = Some("uploading the scene and building its pipelines, which takes a line of its own");
    desk.app.session.adapter = Some("an adapter with a name that is longer than the window is wide ".repeat(4));
    for _ in 0..5 {
        desk.frame(Vec::new());
    }
    assert_eq!(desk.app.session.size, size);
}

#[test]
fn keys_do_what_the_help_says() {
    let mut desk = Desk::new();
    desk.frame(Vec::new());
    desk.press(Key::F1);
    desk.frame(Vec::new());
    assert!(has(&desk.frame(Vec::new()), "hold the maps of this view"));
    desk.press(Key::Escape);
    assert!(!desk.app.help);
    desk.press(Key::T);
    desk.press(Key::L);
    desk.press(Key::X);
    desk.press(Key::Num2);
    let show = &desk.app.session.show;
    assert!(show.tint && show.frusta && !show.shadows && show.tab == Some(Tab::Planes));
    desk.press(Key::O);
    assert_eq!(desk.app.session.show.overlay, Some(Overlay::Density));
    desk.press(Key::F);
    assert!(desk.app.session.frozen.is_some());
    let before = *desk.app.session.camera.as_ref().expect("a camera").view();
    let held =
        |pressed| Event::Key { key: Key::W, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
    desk.frame(vec![held(true)]);
    desk.frame(Vec::new());
    desk.frame(vec![held(false)]);
    assert_ne!(*desk.app.session.camera.as_ref().expect("a camera").view(), before);
    desk.press(Key::R);
    assert_eq!(desk.app.session.camera.as_ref().expect("a camera").view().eye(), before.eye());
    desk.press(Key::H);
    assert!(!has(&desk.frame(Vec::new()), "Shadows"), "the panels are hidden");
}

#[test]
fn pasted_text_is_taken_over_or_said_to_be_wrong() {
    let mut desk = Desk::new();
    desk.frame(vec![Event::Paste("--preset=fast --filter=pcf7".to_owned())]);
    assert_eq!((desk.app.session.config.filter.word(), desk.app.session.config.splits()), ("pcf7", 3));
    let config = desk.app.session.config.clone();
    desk.frame(vec![Event::Paste("--filter=fog".to_owned())]);
    assert_eq!(desk.app.session.config, config);
    let texts = desk.frame(Vec::new());
    assert!(has(&texts, "fog"), "{texts:?}");
}

#[test]
fn the_command_shows_the_same() {
    let mut desk = Desk::new();
    assert_eq!(desk.app.command_line(), "umbrage view chessboard --preset=balanced");
    desk.app.session.set_config(Preset::Fast.config());
    desk.app.session.show.tint = true;
    desk.app.session.time_s = 2.5;
    desk.press(Key::L);
    let motion = crate::camera::Motion { zoom: 1.0, ..Default::default() };
    desk.app.session.fly(&motion);
    let command = desk.app.command_line();
    for part in ["--eye=", "--target=", "--time=2.5", "--tint", "--preset=fast"] {
        assert!(command.contains(part), "{command}");
    }
    let read = share::read(&command).expect("its own command");
    assert_eq!(read.config, desk.app.session.config);
}

/// A dropped file.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("nobody asks".to_owned())
    }
}

#[test]
fn a_dropped_file_that_is_no_scene_is_said_and_the_scene_stays() {
    let mut desk = Desk::new();
    desk.frame(Vec::new());
    let shown = desk.app.session.stage.as_ref().expect("a scene").id;
    let file = Dropped(PathBuf::from("no-such-terrain.png"));
    let input = RawInput { dropped_files: vec![Arc::new(file)], ..RawInput::default() };
    desk.run(input);
    while desk.app.session.opening.is_some() {
        desk.app.session.tick(0.01);
    }
    assert_eq!(desk.app.session.stage.as_ref().expect("a scene").id, shown);
    desk.frame(Vec::new());
    let texts = desk.frame(Vec::new());
    assert!(has(&texts, "no-such-terrain.png"), "{texts:?}");
}
