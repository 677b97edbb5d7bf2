//! Tabs below the picture: maps, planes, times, casters.

use std::sync::Arc;

use egui::{Color32, Grid, Image, RichText, Sense, Stroke, Ui, Vec2};
use egui_plot::{Corner, GridInput, GridMark, Legend, Line, LineStyle, Plot, PlotPoints, VLine};
use umbrage::{ShadowPlan, Split};

use super::{bytes, metres, object_name, split_colour};
use crate::app::App;
use crate::lines;
use crate::session::Session;
use crate::studio::{Drawn, Taken};

/// Number of samples of a curve over one split.
const SAMPLES: u32 = 64;

fn first(drawn: &Drawn) -> Option<&Taken> {
    drawn.taken.first()
}

/// Returns the view that maps were planned for.
fn planned(drawn: &Drawn) -> &umbrage::View {
    drawn.shot.planned_for.as_ref().unwrap_or(&drawn.shot.view)
}

/// Lays out the maps as pictures.
pub(super) fn maps(app: &mut App, drawn: &Arc<Drawn>, ui: &mut Ui) {
    let Some(taken) = first(drawn) else { return };
    let outlined = app.session.show.outlined;
    if drawn.wants.maps && taken.maps.is_empty() {
        ui.weak(
            "There are no pictures of these maps: shadows are off, or a texel holds several samples of depth (msaa).",
        );
        return;
    }
    let height = (ui.available_height() - 40.0).max(60.0);
    let maps = app.textures.maps(ui.ctx(), drawn);
    if maps.is_empty() {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label("the maps come once nothing moves");
        });
        return;
    }
    ui.horizontal_top(|ui| {
        for (index, (map, split)) in maps.iter().zip(&taken.stats.plan.splits).enumerate() {
            ui.vertical(|ui| {
                ui.set_width(height.max(210.0));
                let image = Image::new((map.texture.id(), Vec2::splat(height))).sense(Sense::hover());
                let response = ui.add(image);
                let painter = ui.painter_at(response.rect);
                outline_slice(&painter, response.rect, (drawn, split), split_colour(index));
                outline_casters(&painter, response.rect, (drawn, taken, index, split), outlined);
                let texel = split.texel_m.max_element();
                ui.label(
                    RichText::new(format!("split {index}: {} to {}", metres(split.near), metres(split.far)))
                        .color(split_colour(index)),
                );
                ui.small(format!("{}², texel {}, {:.0} % filled", split.size, metres(texel), 100.0 * map.filled));
            });
        }
    });
}

fn on_map(split: &Split, rect: egui::Rect, point: glam::DVec3) -> Option<egui::Pos2> {
    let at = split.map_from_world(point);
    let share = at / f64::from(split.size);
    (at.is_finite() && share.abs().max_element() < 1e4)
        .then(|| rect.min + rect.size() * egui::vec2(share.x as f32, share.y as f32))
}

/// Draws the slice of the view that the map is for.
fn outline_slice(painter: &egui::Painter, rect: egui::Rect, (drawn, split): (&Drawn, &Split), colour: Color32) {
    for segment in lines::slice(planned(drawn), split.near, split.far) {
        if let [Some(a), Some(b)] = segment.map(|point| on_map(split, rect, point)) {
            painter.line_segment([a, b], Stroke::new(1.5, colour));
        }
    }
}

/// Draws the boxes of casters, the outlined one stronger.
fn outline_casters(
    painter: &egui::Painter,
    rect: egui::Rect,
    (drawn, taken, index, split): (&Drawn, &Taken, usize, &Split),
    outlined: Option<usize>,
) {
    for &caster in taken.stats.plan.casters(index) {
        let Some(&object) = taken.casters.get(caster as usize) else { continue };
        let Some(object_there) = drawn.pose.objects.get(object) else { continue };
        let stroke = if outlined == Some(object) {
            Stroke::new(2.0, Color32::WHITE)
        } else {
            Stroke::new(0.7, Color32::from_rgba_unmultiplied(20, 20, 20, 70))
        };
        for segment in lines::edges(&object_there.bounds) {
            if let [Some(a), Some(b)] = segment.map(|point| on_map(split, rect, point)) {
                painter.line_segment([a, b], stroke);
            }
        }
    }
}

/// Returns grid lines of a logarithmic axis: decades and their parts.
fn decades(input: GridInput) -> Vec<GridMark> {
    let (from, to) = input.bounds;
    #[expect(clippy::cast_possible_truncation, reason = "exponents of lengths")]
    let (first, last) = (from.floor() as i32, to.ceil() as i32);
    let marks = (first..=last).flat_map(|decade| {
        (1..10).map(move |part| GridMark {
            value: f64::from(decade) + f64::from(part).log10(),
            step_size: if part == 1 { 1.0 } else { 0.1 },
        })
    });
    marks.collect()
}

fn round(value: f64) -> String {
    if value >= 100.0 { format!("{value:.0}") } else { format!("{}", (value * 100.0).round() / 100.0) }
}

/// Lays out the split planes on a logarithmic axis, with predicted aliasing.
pub(super) fn planes(drawn: &Drawn, ui: &mut Ui) {
    let Some(taken) = first(drawn) else { return };
    let plan = &taken.stats.plan;
    let compared = drawn.taken.get(1).map(|taken| &taken.stats.plan);
    let planes: Vec<String> = plan.planes.iter().map(|plane| metres(*plane)).collect();
    let text = format!(
        "Planes at {}. Above the dashed line a texel is larger than a pixel and shows at edges.",
        planes.join(", ")
    );
    ui.add(egui::Label::new(text).truncate());
    let height = drawn.shot.size[1];
    Plot::new("planes")
        .legend(Legend::default().position(Corner::RightTop))
        .allow_scroll(false)
        .x_axis_label("view depth, m")
        .y_axis_label("pixels per texel")
        .x_grid_spacer(decades)
        .y_grid_spacer(decades)
        .x_axis_formatter(|mark, _| if mark.step_size >= 1.0 { round(10f64.powf(mark.value)) } else { String::new() })
        .y_axis_formatter(|mark, _| if mark.step_size >= 1.0 { round(10f64.powf(mark.value)) } else { String::new() })
        .label_formatter(|at| {
            let (egui_plot::HoverPosition::NearDataPoint { position, .. }
            | egui_plot::HoverPosition::Elsewhere { position }) = at;
            Some(format!("{} m\n{} pixels per texel", round(10f64.powf(position.x)), round(10f64.powf(position.y))))
        })
        .show(ui, |plot| {
            let nothing = Color32::from_gray(130);
            let range =
                [plan.planes.first(), plan.planes.last()].map(|plane| plane.copied().unwrap_or(1.0).max(1e-3).log10());
            plot.line(
                Line::new("", PlotPoints::from(vec![[range[0], 0.0], [range[1], 0.0]]))
                    .color(nothing)
                    .style(LineStyle::dashed_loose()),
            );
            for plane in plan.planes.iter().filter(|plane| **plane > 0.0) {
                plot.vline(VLine::new("", plane.log10()).color(nothing).width(1.0));
            }
            for (index, points) in aliasing(plan, planned(drawn), height) {
                plot.line(
                    Line::new(format!("split {index}"), PlotPoints::from(points)).color(split_colour(index)).width(2.5),
                );
            }
            if let Some(other) = compared {
                for (_, points) in aliasing(other, planned(drawn), height) {
                    let line = Line::new("compared", PlotPoints::from(points)).color(Color32::from_gray(170));
                    plot.line(line.style(LineStyle::dashed_dense()));
                }
            }
        });
}

/// Returns pixels per texel over the depths of each split of the first face, both as logarithms.
fn aliasing(plan: &ShadowPlan, view: &umbrage::View, height: u32) -> Vec<(usize, Vec<[f64; 2]>)> {
    let per_face = plan.splits.len() / plan.faces().max(1);
    let of = |(index, split): (usize, &Split)| {
        let (near, far) = (split.near.max(1e-3), split.far.max(1e-3));
        let sample = |step: u32| {
            let depth = near * (far / near).powf(f64::from(step) / f64::from(SAMPLES));
            [depth.log10(), split.pixels_per_texel(view, height, depth).max(1e-6).log10()]
        };
        let points: Vec<[f64; 2]> =
            (0..=SAMPLES).map(sample).filter(|point| point.iter().all(|v| v.is_finite())).collect();
        (index, points)
    };
    plan.splits.iter().take(per_face).enumerate().filter(|(_, split)| !split.casters.is_empty()).map(of).collect()
}

/// Lays out the times of the last pictures and the cost of each split.
pub(super) fn times(session: &Session, drawn: &Drawn, ui: &mut Ui) {
    let Some(taken) = first(drawn) else { return };
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| costs(drawn, taken, ui));
        let curve = |of: fn(&crate::session::Times) -> f64| {
            let points = session.times.iter().enumerate().map(|(at, times)| [at as f64, of(times)]).collect::<Vec<_>>();
            PlotPoints::from(points)
        };
        Plot::new("times")
            .legend(Legend::default().position(Corner::RightTop))
            .allow_scroll(false)
            .allow_drag(false)
            .allow_zoom(false)
            .include_y(0.0)
            .x_axis_label("pictures")
            .y_axis_label("ms")
            .show(ui, |plot| {
                plot.line(Line::new("planning, CPU", curve(|times| times.plan)).color(Color32::from_rgb(240, 180, 60)));
                plot.line(Line::new("maps, GPU", curve(|times| times.maps)).color(Color32::from_rgb(80, 150, 255)));
                plot.line(Line::new("view, GPU", curve(|times| times.view)).color(Color32::from_rgb(90, 200, 110)));
                plot.line(Line::new("order to picture", curve(|times| times.wall)).color(Color32::from_gray(150)));
            });
    });
}

fn costs(drawn: &Drawn, taken: &Taken, ui: &mut Ui) {
    let stats = &taken.stats;
    Grid::new("costs").striped(true).num_columns(6).show(ui, |ui| {
        for heading in ["split", "GPU", "texel", "casters", "draws", "triangles"] {
            ui.strong(heading);
        }
        ui.end_row();
        for (index, split) in stats.splits.iter().enumerate() {
            ui.label(RichText::new(index.to_string()).color(split_colour(index)));
            ui.label(split.gpu_ms.map_or_else(|| "—".to_owned(), |ms| format!("{ms:.2} ms")));
            ui.label(metres(split.texel_m));
            ui.label(split.casters.to_string());
            ui.label(split.draws.to_string());
            ui.label(split.triangles.to_string());
            ui.end_row();
        }
    });
    ui.label(format!(
        "view: {:.2} ms, {} draws, {} triangles",
        stats.frame_ms - stats.shadow_ms,
        stats.view_draws,
        stats.view_triangles
    ));
    ui.label(format!(
        "planning: {:.2} ms; {} of maps, {}, {}",
        stats.plan_ms,
        bytes(stats.bytes),
        stats.storage,
        stats.generation
    ));
    if let Some(other) = drawn.taken.get(1) {
        let other = &other.stats;
        ui.label(format!(
            "compared: maps {:.2} ms, view {:.2} ms, {}",
            other.shadow_ms,
            other.frame_ms - other.shadow_ms,
            bytes(other.bytes)
        ));
    }
    for note in &taken.notes {
        ui.weak(note);
    }
}

/// Lays out the casters of each split.
pub(super) fn casters(app: &mut App, drawn: &Drawn, ui: &mut Ui) {
    let Some(taken) = first(drawn) else { return };
    let mut hovered = None;
    let mut at = None;
    let plan = &taken.stats.plan;
    ui.horizontal_top(|ui| {
        for (index, split) in taken.stats.splits.iter().enumerate() {
            ui.vertical(|ui| {
                ui.set_width(230.0);
                let title = format!("split {index}: {} casters, {} triangles", split.casters, split.triangles);
                ui.label(RichText::new(title).color(split_colour(index)));
                if split.casters == 0 {
                    ui.weak("nothing casts a shadow here: lit without a lookup");
                }
                let mut objects: Vec<usize> = plan
                    .casters(index)
                    .iter()
                    .filter_map(|&caster| taken.casters.get(caster as usize).copied())
                    .collect();
                let size = |object: &usize| {
                    drawn.pose.objects.get(*object).map_or(0.0, |there| (there.bounds.max - there.bounds.min).length())
                };
                objects.sort_by(|a, b| size(b).total_cmp(&size(a)));
                for object in objects {
                    let name = object_name(&drawn.stage, &drawn.pose, object);
                    let label = ui.selectable_label(
                        app.session.show.outlined == Some(object),
                        format!("{name}  {}", metres(size(&object))),
                    );
                    if label.hovered() {
                        hovered = Some(object);
                    }
                    if label.on_hover_text("Its box is drawn in the picture; click to keep it").clicked() {
                        at = Some(object);
                    }
                }
            });
            ui.separator();
        }
    });
    let show = &mut app.session.show.outlined;
    if at.is_some() {
        *show = if *show == at { None } else { at };
    } else if hovered.is_some() {
        app.fields.hovered_caster = hovered;
    }
}
