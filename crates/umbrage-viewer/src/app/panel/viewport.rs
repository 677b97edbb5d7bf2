//! The picture, the drawings over it, and the gestures that move the camera.

use std::sync::Arc;

use egui::{
    Align2, CentralPanel, Color32, CursorIcon, FontId, Frame, Key, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2,
};
use glam::{DVec2, DVec3};

use super::{picked, split_colour};
use crate::app::App;
use crate::camera::Motion;
use crate::lines::{self, Segment};
use crate::session::project;
use crate::studio::Drawn;

/// Points that a wheel scrolls in one notch.
const POINTS_PER_NOTCH: f32 = 50.0;
/// Factor of the speed while Shift is held.
const HASTE: f64 = 4.0;
/// Half the width of the wipe's handle in points.
const HANDLE: f32 = 6.0;
/// Picture heights by which an arrow key turns the camera in a second.
const TURN_PER_S: f64 = 0.6;

const WHOLE: Rect = Rect { min: Pos2::ZERO, max: Pos2 { x: 1.0, y: 1.0 } };

/// Lays out the picture.
pub fn viewport(app: &mut App, ui: &mut Ui) {
    CentralPanel::no_frame().frame(Frame::NONE.fill(Color32::from_gray(24))).show(ui, |ui| {
        let scale = ui.pixels_per_point();
        let room = ui.available_rect_before_wrap();
        // Pixels of the picture are pixels of the window.
        let snap = |v: f32| (v * scale).round() / scale;
        let rect = Rect::from_min_max(
            Pos2::new(snap(room.min.x), snap(room.min.y)),
            Pos2::new(snap(room.max.x), snap(room.max.y)),
        );
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels of a window")]
        let pixels = |points: f32| (points * scale).round().max(1.0) as u32;
        app.session.resize([pixels(rect.width()), pixels(rect.height())]);
        app.fields.card_at = rect.left_bottom() + Vec2::new(12.0, -230.0);
        picture(app, ui, rect);
        if ui.input(|input| !input.raw.hovered_files.is_empty()) {
            let painter = ui.painter_at(rect);
            painter.rect_stroke(rect.shrink(6.0), 6.0, Stroke::new(3.0, Color32::WHITE), egui::StrokeKind::Inside);
            shadowed(&painter, rect.center(), Align2::CENTER_CENTER, "Let go to open it", 22.0);
        }
        hands(app, ui, &response);
        messages(app, ui, rect);
        picked::picked(app, ui);
    });
}

fn picture(app: &mut App, ui: &mut Ui, rect: Rect) {
    let Some(drawn) = app.session.drawn.clone() else {
        waiting(app, ui, rect);
        return;
    };
    let pictures: Vec<egui::TextureId> =
        app.textures.pictures(ui.ctx(), &drawn).iter().map(|texture| texture.id()).collect();
    let painter = ui.painter_at(rect);
    if let Some(&first) = pictures.first() {
        painter.image(first, rect, WHOLE, Color32::WHITE);
    }
    if let Some(laid) = app.session.fitting_overlay().cloned() {
        painter.image(app.textures.overlay(ui.ctx(), &laid), rect, WHOLE, Color32::WHITE);
    }
    if let (Some(&second), true) = (pictures.get(1), app.session.other.is_some()) {
        wipe(app, ui, rect, second);
    }
    world_lines(app, ui, rect, &drawn);
}

/// Draws the message in place of a picture that is not there yet.
fn waiting(app: &App, ui: &mut Ui, rect: Rect) {
    let text = match (&app.session.opening, app.session.busy, &app.session.stage) {
        (Some(opening), ..) => format!("{}: {} …", opening.spec, opening.step().text()),
        (None, Some(busy), _) => format!("{busy} …"),
        (None, None, Some(_)) => "drawing the first picture …".to_owned(),
        (None, None, None) => "Drop a scene here, or choose one on the left.".to_owned(),
    };
    ui.painter_at(rect).text(
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(18.0),
        Color32::from_gray(200),
    );
}

/// Draws the second picture to the right of a line that can be dragged.
fn wipe(app: &mut App, ui: &mut Ui, rect: Rect, second: egui::TextureId) {
    let x = rect.left() + rect.width() * app.session.show.wipe;
    let handle = Rect::from_min_max(Pos2::new(x - HANDLE, rect.top()), Pos2::new(x + HANDLE, rect.bottom()));
    let response = ui
        .interact(handle, ui.scope_id().with("wipe"), Sense::drag())
        .on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    if response.dragged() {
        let moved = app.session.show.wipe + response.drag_delta().x / rect.width().max(1.0);
        app.session.show.wipe = moved.clamp(0.0, 1.0);
    }
    let share = app.session.show.wipe;
    let right = Rect::from_min_max(Pos2::new(x, rect.top()), rect.max);
    let painter = ui.painter_at(rect);
    painter.image(second, right, Rect::from_min_max(Pos2::new(share, 0.0), Pos2::new(1.0, 1.0)), Color32::WHITE);
    painter.vline(x, rect.y_range(), Stroke::new(2.0, Color32::WHITE));
    painter.circle_filled(Pos2::new(x, rect.center().y), HANDLE, Color32::WHITE);
    for (at, anchor, text) in
        [(x - 10.0, Align2::RIGHT_BOTTOM, "the settings"), (x + 10.0, Align2::LEFT_BOTTOM, "compared with")]
    {
        shadowed(&painter, Pos2::new(at, rect.bottom() - 10.0), anchor, text, 14.0);
    }
}

/// Draws text that is readable on any picture.
fn shadowed(painter: &egui::Painter, at: Pos2, anchor: Align2, text: &str, size: f32) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(size), Color32::WHITE);
    let room = anchor.anchor_size(at, galley.size()).expand2(Vec2::new(5.0, 2.0));
    painter.rect_filled(room, 3.0, Color32::from_black_alpha(150));
    painter.galley(room.min + Vec2::new(5.0, 2.0), galley, Color32::WHITE);
}

/// Draws frusta, the outlined caster and the clicked point.
fn world_lines(app: &mut App, ui: &mut Ui, rect: Rect, drawn: &Arc<Drawn>) {
    let view = &drawn.shot.view;
    let painter = ui.painter_at(rect);
    let place = |at: DVec2| rect.min + rect.size() * egui::vec2(at.x as f32, at.y as f32);
    let draw = |segments: &[Segment], stroke: Stroke| {
        for [a, b] in segments.iter().filter_map(|segment| lines::on_screen(view, *segment)) {
            painter.line_segment([place(a), place(b)], stroke);
        }
    };
    if app.session.show.frusta
        && let Some(taken) = drawn.taken.first()
    {
        let planned = drawn.shot.planned_for.as_ref().unwrap_or(view);
        for lines in lines::frusta(&taken.stats.plan, planned) {
            let colour = split_colour(lines.split);
            draw(&lines.map, Stroke::new(1.0, colour.gamma_multiply(0.75)));
            draw(&lines.slice, Stroke::new(4.0, Color32::from_black_alpha(110)));
            draw(&lines.slice, Stroke::new(2.5, colour));
        }
    }
    let outlined = app.fields.hovered_caster.take().or(app.session.show.outlined);
    if let Some(object) = outlined.and_then(|object| drawn.pose.objects.get(object)) {
        draw(&lines::edges(&object.bounds), Stroke::new(2.0, Color32::WHITE));
    }
    let surface = app.session.picked.as_ref().and_then(|picked| picked.surface.as_ref());
    if let Some((at, _)) = surface.and_then(|surface| project(view, surface.position)) {
        painter.circle_stroke(place(at), 6.0, Stroke::new(3.0, Color32::from_black_alpha(140)));
        painter.circle_stroke(place(at), 6.0, Stroke::new(1.5, Color32::WHITE));
    }
}

/// Handles mouse, touch and keys.
fn hands(app: &mut App, ui: &mut Ui, response: &Response) {
    let rect = response.rect;
    let height = f64::from(rect.height().max(1.0));
    let per_height = |points: Vec2| DVec2::new(f64::from(points.x), f64::from(points.y)) / height;
    if response.clicked() || response.drag_started() {
        // Keys belong to the picture again.
        ui.memory_mut(|memory| memory.stop_text_input());
        if let Some(focused) = ui.memory(|memory| memory.focused()) {
            ui.memory_mut(|memory| memory.surrender_focus(focused));
        }
    }
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        let at = (at - rect.min) / rect.size();
        app.session.pick(DVec2::new(f64::from(at.x), f64::from(at.y)));
    }
    let mut motion = Motion { haste: 1.0, ..Motion::default() };
    let modifiers = ui.input(|input| input.modifiers);
    let touches = ui.input(|input| input.multi_touch());
    match touches {
        Some(touch) => motion.pan = per_height(touch.translation_delta),
        None if response.dragged() => {
            let drag = per_height(response.drag_delta());
            if response.dragged_by(egui::PointerButton::Primary) && modifiers.command {
                app.session.drag_sun(drag);
            } else if response.dragged_by(egui::PointerButton::Primary) && !modifiers.shift {
                motion.turn = -drag;
            } else {
                motion.pan = drag;
            }
        }
        None => {}
    }
    if response.contains_pointer() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
        motion.zoom = f64::from(scroll.y / POINTS_PER_NOTCH) + f64::from(pinch.max(1e-3).ln()) / 0.128;
        if scroll.x != 0.0 {
            motion.turn.x -= f64::from(scroll.x) / height;
        }
    }
    if !ui.ctx().egui_wants_keyboard_input() {
        keys(ui, &mut motion);
    }
    app.session.fly(&motion);
}

/// Adds the motion of keys that are held.
fn keys(ui: &Ui, motion: &mut Motion) {
    ui.input(|input| {
        if input.modifiers.command || input.modifiers.alt {
            return;
        }
        let axis = |more: Key, less: Key| f64::from(i8::from(input.key_down(more)) - i8::from(input.key_down(less)));
        motion.walk = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
        motion.seconds = f64::from(input.stable_dt.min(0.1));
        motion.haste = if input.modifiers.shift { HASTE } else { 1.0 };
        let turn = DVec2::new(axis(Key::ArrowRight, Key::ArrowLeft), axis(Key::ArrowDown, Key::ArrowUp));
        motion.turn += turn * TURN_PER_S * motion.seconds;
    });
}

/// Lays out messages, each with a button that removes it.
fn messages(app: &mut App, ui: &mut Ui, rect: Rect) {
    if app.session.messages.is_empty() || app.bare {
        return;
    }
    let mut gone = None;
    egui::Area::new(ui.scope_id().with("messages")).fixed_pos(rect.min + Vec2::splat(8.0)).show(ui.ctx(), |ui| {
        ui.set_max_width((rect.width() - 24.0).clamp(120.0, 520.0));
        for (index, message) in app.session.messages.iter().enumerate().rev() {
            let frame = Frame::popup(ui.style());
            frame.show(ui, |ui| {
                ui.horizontal(|ui| {
                    if ui.small_button("×").on_hover_text("Remove this line").clicked() {
                        gone = Some(index);
                    }
                    let colour = if message.is_error { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
                    ui.add(egui::Label::new(egui::RichText::new(&message.text).color(colour)).wrap());
                });
            });
        }
    });
    if let Some(index) = gone {
        app.session.messages.remove(index);
    }
}
