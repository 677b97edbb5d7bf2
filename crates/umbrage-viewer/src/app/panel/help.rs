//! The help window of the key F1.

use egui::{Grid, RichText, Ui, Window};

use crate::app::App;

/// Keys and gestures with their effects.
const KEYS: &[(&str, &str)] = &[
    ("drag", "look around; in orbit, go around what you clicked last"),
    ("right drag, Shift + drag, two fingers", "move sideways"),
    ("wheel, pinch", "move forwards and back"),
    ("Ctrl + drag", "move the sun: sideways its bearing, up and down its height"),
    ("click", "show why this pixel is lit or dark"),
    ("W A S D, Q E", "fly; down and up. Shift is faster, + and − change the speed"),
    ("arrows", "look around"),
    ("R", "back to the first view"),
    ("Space", "run or stop the time"),
    ("X", "shadows on or off"),
    ("T", "each split in a colour"),
    ("L", "frusta of splits and of their maps, as lines"),
    ("F", "hold the maps of this view and fly on: see what they cover"),
    ("O", "overlay: none, texels per pixel, errors, tests of triangles"),
    ("1 2 3 4", "maps, planes, times, casters below the picture"),
    ("H", "hide the panels"),
    ("Ctrl + C, Ctrl + V", "copy the command that shows this; paste settings (Rust, TOML, a command)"),
    ("Ctrl + and Ctrl −", "larger and smaller text"),
    ("Tab, Space, Esc", "go from control to control, press one, leave it"),
    ("F12", "a picture of this window, into the working folder"),
];

/// Lays out the window of the help.
pub fn help(app: &mut App, ui: &mut Ui) {
    let mut open = app.help;
    let room = ui.ctx().content_rect().size();
    Window::new("What can be done here").open(&mut open).collapsible(false).vscroll(true).default_width((0.7 * room.x).min(640.0)).default_height(0.75 * room.y).max_height(0.8 * room.y).show(ui.ctx(), |ui| {
        ui.label(
            "umbrage draws sunlight shadows over large worlds with a few shadow maps, each for one split (slice) of the \
             view. Everything about them can be changed on the right while you look; what the picture is made of can be seen \
             on the left and below.",
        );
        ui.add_space(6.0);
        Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
            let drop = format!("open a {}", umbrage_scene::EXTENSIONS);
            for (keys, what) in KEYS.iter().chain(&[("drop a file", drop.as_str())]) {
                ui.label(RichText::new(*keys).strong());
                ui.label(*what);
                ui.end_row();
            }
        });
    });
    app.help = open;
}
