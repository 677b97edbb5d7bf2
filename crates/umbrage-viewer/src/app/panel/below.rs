//! The tabs below the picture: maps, planes, times, casters.

use egui::{Panel, ScrollArea, Ui};

use super::plots;
use crate::app::App;
use crate::session::Tab;

/// Lays out the tabs, and the one that is open.
pub fn below(app: &mut App, ui: &mut Ui) {
    Panel::bottom("tabs").show(ui, |ui| {
        ui.horizontal(|ui| {
            for (number, (tab, name)) in (1..).zip(Tab::ALL) {
                let open = app.session.show.tab == Some(tab);
                if ui.selectable_label(open, format!("{name} {number}")).on_hover_text(about(tab)).clicked() {
                    app.session.show.tab = (!open).then_some(tab);
                }
            }
            if app.session.show.tab.is_none() {
                ui.weak("what the picture is made of");
            }
        });
    });
    let Some(tab) = app.session.show.tab else { return };
    Panel::bottom("tab").default_size(230.0).size_range(120.0..=600.0).resizable(true).show(ui, |ui| {
        // A panel is as high as what is in it, and what is in it here is as high as the panel.
        ui.take_available_height();
        let Some(drawn) = app.session.drawn.clone() else {
            ui.weak("nothing is drawn yet");
            return;
        };
        match tab {
            Tab::Maps => {
                ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| plots::maps(app, &drawn, ui));
            }
            Tab::Planes => plots::planes(&drawn, ui),
            Tab::Times => plots::times(&app.session, &drawn, ui),
            Tab::Casters => {
                ScrollArea::both().auto_shrink(false).show(ui, |ui| plots::casters(app, &drawn, ui));
            }
        }
    });
}

fn about(tab: Tab) -> &'static str {
    match tab {
        Tab::Maps => {
            "Each shadow map as the light sees it, with the outlines of its casters and of its slice of the view"
        }
        Tab::Planes => "Where the planes between splits are, and how many pixels a texel covers at each depth",
        Tab::Times => "How long the last pictures took, and what each split costs",
        Tab::Casters => "What casts shadows in each split",
    }
}
