//! The status line at the bottom: the adapter, the times, and the running task.

use egui::{Panel, Ui};

use super::bytes;
use crate::app::App;

/// Lays out the status line.
pub fn status(app: &mut App, ui: &mut Ui) {
    // One line always: a line that wraps would resize the picture, which would be drawn again and
    // change the line.
    let height = ui.spacing().interact_size.y + 8.0;
    Panel::bottom("status").exact_size(height).show(ui, |ui| {
        ui.horizontal_centered(|ui| {
            if ui.selectable_label(app.help, "Help F1").clicked() {
                app.help = !app.help;
            }
            ui.separator();
            let session = &app.session;
            if let Some(busy) = session.busy {
                ui.spinner();
                ui.label(format!("{busy} …"));
                ui.separator();
            }
            let taken = session.drawn.as_ref().and_then(|drawn| Some((drawn, drawn.taken.first()?)));
            if let Some((drawn, taken)) = taken {
                let [width, height] = drawn.shot.size;
                let coarse = if drawn.shot.size == session.size { "" } else { ", coarse while it moves" };
                ui.label(format!("{width} × {height}{coarse}"));
                ui.separator();
                let (maps, all) = (taken.stats.shadow_ms, taken.stats.frame_ms);
                // WebGL2 measures nothing.
                let (times, of) = match all > 0.0 {
                    true => (format!("maps {maps:.1} ms, view {:.1} ms", all - maps), "On the graphics device"),
                    false => (format!("drawn in {:.0} ms", drawn.wall_ms), "From the order to the picture"),
                };
                ui.label(times).on_hover_text(format!("{of}, of the last picture"));
                ui.separator();
                ui.label(format!("{} of maps", bytes(taken.stats.bytes)));
                ui.separator();
                ui.label(format!(
                    "{} draws, {} triangles into maps",
                    taken.stats.shadow_draws, taken.stats.shadow_triangles
                ));
                ui.separator();
            }
            let adapter = session.adapter.as_deref().unwrap_or("no graphics device yet");
            ui.add(egui::Label::new(egui::RichText::new(adapter).weak()).truncate());
        });
    });
}
