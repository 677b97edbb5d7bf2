//! Controls that explain a shadow: switches, overlays with their legends, comparisons.

use egui::{Align2, Color32, Pos2, ProgressBar, Rect, Sense, TextStyle, Ui, Vec2};
use umbrage::config::Preset;
use umbrage_render::{EdgeCause, EdgeCounts, EdgeSums};

use crate::app::App;
use crate::judge::{ERROR_COLOURS, Overlay, Sums, density_colour};
use crate::session::Session;

/// Lays out the switches.
pub(super) fn look(app: &mut App, ui: &mut Ui) {
    let judging = app.judging();
    let session = &mut app.session;
    ui.checkbox(&mut session.show.shadows, "shadows").on_hover_text("With or without, to see what they do (X)");
    ui.checkbox(&mut session.show.tint, "each split in a colour")
        .on_hover_text("Which shadow map is used where: red is the nearest (T)");
    ui.checkbox(&mut session.show.frusta, "frusta of splits and maps")
        .on_hover_text("The slices of the view and the boxes that their maps cover, as lines (L)");
    let mut held = session.frozen.is_some();
    let hold = ui.checkbox(&mut held, "hold the maps, fly on");
    if hold.on_hover_text("The maps of this view are kept while you look at them from elsewhere (F)").changed() {
        session.freeze(held);
    }
    ui.add_space(4.0);
    ui.label("Over the picture:");
    for (overlay, text, help) in [
        (None, "nothing", "The picture alone"),
        (
            Some(Overlay::Density),
            "texels per pixel",
            "How coarse the maps are for what is seen; rays are traced while nothing moves",
        ),
        (
            Some(Overlay::Errors),
            "errors",
            "Each pixel against the exact shadow: acne, leaks, and what an edge's resolution explains; rays are traced while \
             nothing moves",
        ),
        (
            Some(Overlay::Tests),
            "tests of triangles",
            "Where texels disagree and exact edges ask the triangles that they name; the stronger, the more were tested",
        ),
    ] {
        if ui.radio(session.show.overlay == overlay, text).on_hover_text(help).clicked() {
            session.show.overlay = overlay;
        }
    }
    if let Some(progress) = judging {
        let text = if progress > 0.0 {
            format!("tracing rays, {:.0} %", 100.0 * progress)
        } else {
            "sorting triangles".to_owned()
        };
        ui.add(ProgressBar::new(progress).text(text).animate(true));
    }
    if session.show.overlay.is_some() {
        legend(session, ui);
    }
    ui.add_space(4.0);
    compare(session, ui);
}

/// Lays out the legend of the overlay's colours, and its numbers.
fn legend(session: &Session, ui: &mut Ui) {
    let sums = session.fitting_overlay().map(|laid| laid.sums);
    match session.show.overlay {
        Some(Overlay::Density) => {
            scale(ui);
            if let Some(Sums::Density { median, lowest }) = sums {
                ui.label(format!("median {median:.2}, lowest hundredth {lowest:.2} texels per pixel"));
                ui.weak("Below 1 the map's texels show at edges.");
            }
        }
        Some(Overlay::Errors) => {
            let shares = match sums {
                Some(Sums::Errors { acne, leak, at_edges, .. }) => [Some(acne), Some(leak), Some(at_edges)],
                _ => [None; 3],
            };
            let texts = ["acne: should be lit", "leak: should be dark", "edge: resolution"];
            for ((text, [r, g, b]), share) in texts.into_iter().zip(ERROR_COLOURS).zip(shares) {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(Vec2::splat(10.0), Sense::hover());
                    ui.painter().rect_filled(rect, 2.0, Color32::from_rgb(r, g, b));
                    let share = share.map_or(String::new(), |share| format!(" {:.3} %", 100.0 * share));
                    ui.label(format!("{text}{share}"));
                });
            }
            if let Some(Sums::Errors { pixels, .. }) = sums {
                ui.weak(format!("of {pixels} pixels that face the light"));
            }
        }
        Some(Overlay::Tests) => {
            let sums = match sums {
                Some(Sums::Tests(sums)) => sums,
                _ => EdgeSums::default(),
            };
            let share = |count: u64| 100.0 * count as f64 / sums.points.max(1) as f64;
            let causes = [
                ("lit: none is hit", EdgeCause::Missed),
                ("dark: one is hit", EdgeCause::Hit),
                ("no name: the filter", EdgeCause::Filter),
            ];
            for ((text, cause), [r, g, b]) in causes.into_iter().zip(EdgeCounts::COLOURS) {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(Vec2::splat(10.0), Sense::hover());
                    ui.painter().rect_filled(rect, 2.0, Color32::from_rgb(r, g, b));
                    ui.label(format!("{text} {:.2} %", share(sums.of(cause))));
                });
            }
            let each = sums.triangles as f64 / sums.tested().max(1) as f64;
            ui.weak(format!("{:.2} % of {} pixels, {each:.1} triangles each", share(sums.tested()), sums.points));
        }
        None => {}
    }
}

/// Lays out the colours of texels per pixel with their numbers, on a logarithmic scale.
fn scale(ui: &mut Ui) {
    const STEPS: u8 = 48;
    let size = Vec2::new(ui.available_width().min(220.0), 28.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let bar = Rect::from_min_size(rect.min, Vec2::new(rect.width(), 12.0));
    let at = |share: f32| bar.left() + share * bar.width();
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| f32::from(step) / f32::from(STEPS));
        let [r, g, b] = density_colour(2f64.powf(f64::from(from) * 6.0 - 3.0));
        let part = Rect::from_x_y_ranges(at(from)..=at(to), bar.y_range());
        ui.painter().rect_filled(part, 0.0, Color32::from_rgb(r, g, b));
    }
    let font = TextStyle::Small.resolve(ui.style());
    for (share, align, text) in
        [(0.0, Align2::LEFT_TOP, "1/8"), (0.5, Align2::CENTER_TOP, "1"), (1.0, Align2::RIGHT_TOP, "8")]
    {
        ui.painter().text(
            Pos2::new(at(share), bar.bottom() + 2.0),
            align,
            text,
            font.clone(),
            ui.visuals().text_color(),
        );
    }
}

/// Lays out the comparison of two configs.
fn compare(session: &mut Session, ui: &mut Ui) {
    ui.label("Compare with:");
    ui.horizontal_wrapped(|ui| {
        if ui.selectable_label(session.other.is_none(), "nothing").clicked() {
            session.other = None;
        }
        let these =
            ui.button("these settings").on_hover_text("Keeps them on the right of the wipe while you change the left");
        if these.clicked() {
            session.other = Some(session.config.clone());
        }
        for preset in Preset::ALL {
            let config = preset.config();
            let chosen = session.other.as_ref() == Some(&config);
            let help = Preset::WORDS.iter().find(|word| word.word == preset.word()).map_or("", |word| word.help);
            if ui.selectable_label(chosen, preset.word()).on_hover_text(help).clicked() {
                session.other = Some(config);
            }
        }
    });
    if session.other.is_some() {
        ui.horizontal(|ui| {
            ui.weak("left: the settings");
            if ui.button("swap").clicked()
                && let Some(other) = session.other.take()
            {
                session.other = Some(session.config.clone());
                session.set_config(other);
            }
        });
    }
}
