//! The left side: scene, camera, time and sun.

use egui::{Panel, ProgressBar, ScrollArea, Slider, TextEdit, Ui};

use super::{look, side, sun};
use crate::app::App;
use crate::camera::{Mode, SPEEDS_M_S};
use crate::path::Recording;
use crate::session::Session;
use crate::stage::shipped;

/// Widest field for a file, in points. A field that took all the room would push the panel wider
/// with every frame.
const FIELD: f32 = 170.0;

/// Lays out the left side.
pub fn scene(app: &mut App, ui: &mut Ui) {
    side(Panel::left("scene"), 250.0, ui).show(ui, |ui| {
        ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            ui.heading("Scene");
            open(app, ui);
            ui.add_space(8.0);
            ui.heading("Look closer");
            look::look(app, ui);
            ui.add_space(8.0);
            ui.heading("Sun");
            sun::sun(&mut app.session, ui);
            if app.session.stage.as_ref().is_some_and(|stage| stage.is_animated()) {
                ui.add_space(8.0);
                ui.heading("Time");
                time(&mut app.session, ui);
            }
            ui.add_space(8.0);
            ui.heading("Camera");
            camera(app, ui);
        });
    });
}

fn open(app: &mut App, ui: &mut Ui) {
    for shipped in shipped() {
        let is_shown = app.session.stage.as_ref().is_some_and(|stage| shipped.is_shown_by(&stage.request));
        if ui.selectable_label(is_shown, shipped.title()).on_hover_text(shipped.about()).clicked() {
            app.open_shipped(shipped);
        }
    }
    ui.horizontal(|ui| {
        let field = TextEdit::singleline(&mut app.fields.file)
            .hint_text("a file, or drop one here")
            .desired_width((ui.available_width() - 60.0).clamp(60.0, FIELD));
        let typed = ui.add(field);
        let entered = typed.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let can = !app.fields.file.trim().is_empty();
        if (ui.add_enabled(can, egui::Button::new("Open")).clicked() || entered) && can {
            let path = app.fields.file.trim().to_owned();
            app.open_file(path.as_ref());
        }
    });
    if let Some(opening) = &app.session.opening {
        let step = opening.step();
        let text = format!("{}, {:.1} s", step.text(), opening.elapsed().as_secs_f64());
        ui.label(&opening.spec);
        ui.add(ProgressBar::new(step.share()).text(text).animate(true));
    }
}

fn time(session: &mut Session, ui: &mut Ui) {
    let duration = session.stage.as_ref().map_or(1.0, |stage| stage.duration_s()).max(1e-3);
    ui.horizontal(|ui| {
        let text = if session.playing { "stand still" } else { "let it run" };
        if ui.button(text).on_hover_text("Space").clicked() {
            session.playing = !session.playing;
        }
        let mut within = session.time_s.rem_euclid(duration);
        if ui.add(Slider::new(&mut within, 0.0..=duration).suffix(" s").fixed_decimals(1)).changed() {
            session.time_s = within;
        }
    });
}

fn camera(app: &mut App, ui: &mut Ui) {
    let session = &mut app.session;
    let aspect = f64::from(session.size[0]) / f64::from(session.size[1].max(1));
    let mut wanted = None;
    if let Some(stage) = &session.stage {
        ui.horizontal_wrapped(|ui| {
            if ui.button("first").on_hover_text("R").clicked() {
                wanted = Some(Ok(stage.view));
            }
            for (index, camera) in stage.scene.cameras.iter().enumerate() {
                let name = if camera.name.is_empty() { index.to_string() } else { camera.name.clone() };
                if ui.button(name).clicked() {
                    wanted = Some(stage.camera_view(index, aspect));
                }
            }
        });
    }
    match wanted {
        Some(Ok(view)) => session.jump(view),
        Some(Err(why)) => session.say(true, why),
        None => {}
    }
    let Some(camera) = &mut session.camera else { return };
    ui.horizontal(|ui| {
        ui.selectable_value(&mut camera.mode, Mode::Fly, "fly").on_hover_text("Dragging turns the head");
        ui.selectable_value(&mut camera.mode, Mode::Orbit, "orbit")
            .on_hover_text("Dragging goes around what you clicked last");
    });
    ui.add(Slider::new(&mut camera.speed, SPEEDS_M_S).logarithmic(true).suffix(" m/s").text("speed"))
        .on_hover_text("+ and −; Shift is four times as fast");
    if let Some(mut fov) = camera.fov_degrees()
        && ui.add(Slider::new(&mut fov, 5.0..=120.0).suffix("°").text("angle")).changed()
    {
        camera.set_fov_degrees(fov);
    }
    paths(session, ui);
}

/// Lays out the controls that record and follow camera paths.
fn paths(session: &mut Session, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        match &session.recording {
            None => {
                let record = ui.button("record a path");
                if record.on_hover_text("Records where you fly, for `umbrage render --path`").clicked() {
                    session.recording = Some(Recording::default());
                }
            }
            Some(recording) => {
                if ui.button(format!("save the path ({} points)", recording.len())).clicked() {
                    save(session);
                }
            }
        }
        let own = session.stage.as_ref().and_then(|stage| stage.following());
        if let Some(own) = own {
            let following = session.following.is_some();
            if ui.selectable_label(following, "follow the path").clicked() {
                session.following = (!following).then_some(own);
            }
        }
    });
}

/// Writes the recorded path into the working folder, beside earlier ones.
fn save(session: &mut Session) {
    let Some(recording) = session.recording.take() else { return };
    let sun = session.shown_sun().map(|sun| sun.direction());
    let written = recording.finish(sun).and_then(|path| {
        let text = path.to_json().map_err(|error| error.to_string())?;
        crate::platform::save("umbrage-path", "json", text.as_bytes())
    });
    match written {
        Ok(file) => session.say(
            false,
            format!("wrote {file}; draw it with `umbrage render SCENE --path {file} --frames 60 -o picture.png`"),
        ),
        Err(why) => session.say(true, why),
    }
}
