//! The card of the clicked pixel, which explains why it is lit or dark.

use egui::{RichText, Ui, Window};
use umbrage_render::ProbeAnswer;

use super::{metres, object_name, split_colour};
use crate::app::App;
use crate::judge::{MapLook, Picked, Surface};
use crate::session::Session;

/// Lays out the card, and closes it if the user asks for that.
pub(super) fn picked(app: &mut App, ui: &mut Ui) {
    let Some(picked) = app.session.picked.clone() else { return };
    let answer = answer(&app.session, &picked);
    let mut open = true;
    Window::new("This pixel")
        .open(&mut open)
        .collapsible(true)
        .resizable(false)
        .default_pos(app.fields.card_at)
        // It covers none of the controls around the picture.
        .constrain_to(ui.max_rect())
        .default_width(300.0)
        .show(ui.ctx(), |ui| match &picked.surface {
            None => {
                ui.label("The sky: nothing to shade.");
            }
            Some(surface) => card(&picked, surface, answer, ui),
        });
    if !open {
        app.session.picked = None;
    }
}

/// Returns the answer of the maps, if it belongs to the picture that was clicked.
fn answer(session: &Session, picked: &Picked) -> Option<ProbeAnswer> {
    let drawn = session.drawn.as_ref().filter(|drawn| drawn.shot == picked.drawn.shot)?;
    drawn.wants.probe?;
    drawn.taken.first()?.answer
}

fn card(picked: &Picked, surface: &Surface, answer: Option<ProbeAnswer>, ui: &mut Ui) {
    let name = |object| object_name(&picked.drawn.stage, &picked.drawn.pose, object);
    let p = surface.position;
    ui.label(RichText::new(name(surface.object)).strong());
    ui.weak(format!("{:.2}, {:.2}, {:.2}; {} from the eye", p.x, p.y, p.z, metres(surface.depth)));
    ui.separator();
    let Some(answer) = answer else {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("reading the maps");
        });
        return;
    };
    ui.label(sentence(surface, answer.visibility));
    match (&surface.blocker, surface.lit) {
        (Some((object, away)), _) => {
            ui.label(format!("In truth in front of the light: {}, {} away.", name(*object), metres(*away)));
        }
        (None, false) => {
            ui.label("The surface is turned away from the light.");
        }
        (None, true) => {
            ui.label("In truth nothing is in front of the light.");
        }
    }
    ui.separator();
    let Ok(split) = usize::try_from(answer.split) else {
        ui.label("No map covers this point: it is beyond the shadowed range, so it counts as lit.");
        return;
    };
    ui.label(RichText::new(format!("Split {split} decided.")).color(split_colour(split)).strong());
    match surface.maps.iter().find(|look| look.split == split) {
        Some(look) => map(look, &name, ui),
        None => {
            ui.label("Nothing casts a shadow into this split, so its map was not read.");
        }
    }
}

/// Describes the answer beside the truth in a sentence.
fn sentence(surface: &Surface, visibility: f32) -> String {
    let percent = 100.0 * visibility;
    let right = (visibility >= 0.5) == surface.lit;
    match (right, surface.lit) {
        (true, true) => format!("Lit, {percent:.0} % of the light, and rightly so."),
        (true, false) => format!("In shadow, {percent:.0} % of the light, and rightly so."),
        (false, true) => {
            format!("In shadow, {percent:.0} % of the light, but it should be lit: acne, or too near an edge.")
        }
        (false, false) => {
            format!("Lit, {percent:.0} % of the light, but it should be dark: a leak, or too near an edge.")
        }
    }
}

fn map(look: &MapLook, name: &impl Fn(usize) -> String, ui: &mut Ui) {
    let texel = look.texel.floor();
    ui.label(format!(
        "Texel {}, {} of its map, {} × {} there.",
        texel.x,
        texel.y,
        metres(look.texel_m.x),
        metres(look.texel_m.y)
    ));
    let slope = look.bias.depth_per_texel.abs().max_element();
    ui.label(format!(
        "Bias {} towards the light, and {} of depth for each texel aside along the surface's plane.",
        metres(look.bias.constant_m),
        metres(slope)
    ));
    match look.stored {
        None => {
            ui.label("The texel is empty: nothing in front of the light.");
        }
        Some((object, before)) if before > look.bias.constant_m => {
            ui.label(format!(
                "The texel's centre sees {}, {} before this surface: a caster.",
                name(object),
                metres(before)
            ));
        }
        Some((object, _)) => {
            ui.label(format!("The texel's centre sees {} at this surface's depth: no caster.", name(object)));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_sentence_says_who_is_right() {
        let surface = |lit| Surface {
            position: DVec3::ZERO,
            normal: DVec3::Y,
            depth: 1.0,
            object: 0,
            lit,
            blocker: None,
            maps: Vec::new(),
        };
        let texts = [(true, 0.9, "rightly"), (false, 0.1, "rightly"), (true, 0.2, "acne"), (false, 0.8, "leak")];
        for (lit, visibility, word) in texts {
            let text = super::sentence(&surface(lit), visibility);
            assert!(text.contains(word), "{text}");
        }
    }
}
