//! The plot of error over bytes, and the page of a search.

use super::{
    choice::{Choice, is_still},
    record::{Outcome, Run, figures, scenes, views_of},
};
use crate::{
    failure::{Failure, Result},
    page::html::{Best, Cell, Column, Figure, Page, Section, Table},
    page::plot::{Axis, Chart, Colour, Mark, Series, Style},
};

/// Number of bytes in a MiB.
const MIB: f64 = 1024.0 * 1024.0;

/// Plots error over bytes: every candidate, the Pareto front, the presets, the best.
///
/// # Errors
/// [`Failure::Other`] if the chart cannot be drawn, which would be a mistake of ours.
pub fn plot(run: &Run, outcomes: &[Outcome], choice: &Choice, most: f64) -> Result<String> {
    let point = |outcome: &Outcome| Some((outcome.bytes as f64 / MIB, 100.0 * outcome.e?));
    let points = |of: &mut dyn Iterator<Item = &Outcome>| -> Vec<(f64, f64)> { of.filter_map(point).collect() };
    let preset = |outcome: &&Outcome| run.candidates[outcome.candidate].preset.is_some();
    let tried = || outcomes.iter().filter(|outcome| !preset(outcome));
    let mut series = vec![
        Series::new("candidates", Style::Points, points(&mut tried().filter(|outcome| is_still(outcome, most))))
            .colour(Colour::Series(0)),
        Series::new(
            format!("F_edge above {} %", 100.0 * most),
            Style::Points,
            points(&mut tried().filter(|outcome| !is_still(outcome, most))),
        )
        .colour(Colour::Quiet),
        Series::new("Pareto front", Style::Line, points(&mut choice.front.iter().map(|&index| &outcomes[index])))
            .colour(Colour::Series(0)),
    ];
    for (number, outcome) in outcomes.iter().filter(preset).enumerate() {
        let name = run.candidates[outcome.candidate].preset.as_deref().unwrap_or_default();
        let too_much = if is_still(outcome, most) { "" } else { ", flickers" };
        let series_of =
            Series::new(format!("preset {name}{too_much}"), Style::Points, points(&mut std::iter::once(outcome)));
        series.push(series_of.colour(Colour::Series(1 + number)));
    }
    let best = points(&mut std::iter::once(&outcomes[choice.best]));
    // Its point lies on that of the candidate.
    let also = run.candidates[outcomes[choice.best].candidate].preset.as_ref();
    let name = also.map_or("the best".to_owned(), |preset| format!("the best (preset {preset})"));
    series.push(Series::new(name, Style::Points, best.clone()).colour(Colour::Ink));
    series.retain(|series| !series.points.is_empty());
    let all = || series.iter().flat_map(|series| series.points.iter().copied());
    let range = |of: fn((f64, f64)) -> f64| {
        let (low, high) = all().map(of).fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        (low, high)
    };
    let ((least_bytes, most_bytes), (least_error, most_error)) = (range(|p| p.0), range(|p| p.1));
    let x = Axis::log("MiB of shadow maps").range(0.7 * least_bytes, 1.4 * most_bytes);
    // No logarithm shows a candidate without error.
    let y = if least_error > 0.0 {
        Axis::log("mean E, %").range(0.8 * least_error, 1.25 * most_error)
    } else {
        Axis::linear("mean E, %").from_zero()
    };
    let mut chart = Chart::new(format!("Error over memory: {}", scenes(run).join(", ")), x, y);
    chart.series = series;
    if let Some(&(bytes, error)) = best.first() {
        chart = chart.mark(Mark::Y(error, format!("the best, {error:.3} % at {bytes:.2} MiB")));
    }
    chart.to_svg().map_err(|error| Failure::other(error.to_string()))
}

/// Makes the page's text. `plot` is the result of [`plot`], followed by the best config as a file.
pub fn page(run: &Run, outcomes: &[Outcome], choice: &Choice, most: f64, (plot, toml): (String, &str)) -> String {
    let [width, height] = run.size;
    let best = &outcomes[choice.best];
    let views = views_of(outcomes);
    let counting = views.iter().filter(|view| view.counts).count();
    let lead = vec![
        format!("Best within {}: `{}`. {}", run.budget, run.candidates[best.candidate].label, figures(best)),
        format!(
            "Candidates: {}; views: {}, of {width} × {height} pixels, judged by exact rays. Means are over the {counting} views whose \
             true shadow has {} edge pixels or more. The best has the least mean E of all candidates with F_edge of {} % at most.",
            run.candidates.len(),
            views.len(),
            run.least_edges,
            100.0 * most
        ),
        "E: share of surface points that face the sun and are decided wrongly. E_log: the same, fair to every depth. F_edge: decisions \
         that flip from frame to frame, per pixel of true edge. D: mean distance of shadow edges from where they should be."
            .to_owned(),
    ];
    let caption =
        "No candidate on the front is beaten in both error and bytes. Those that flicker too much are not on it.";
    let sections = vec![
        Section::new("Error over memory").figure(&Figure::svg(plot, caption)),
        Section::new("Candidates").table(&candidates(run, outcomes, choice, most)),
        Section::new("The best config")
            .text("As a file that `umbrage render --config FILE` reads:")
            .folded("Settings", toml),
        Section::new("Views").table(&view_table(run, outcomes, choice)),
        left_out(run),
    ];
    let title = format!("Shadows tuned: {}", scenes(run).join(", "));
    let footer = format!("Made by `umbrage tune`, version {}, on {}.", run.version, run.adapter);
    Page { title, lead, sections, footer }.html()
}

fn percent(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Missing, |value| Cell::Number(100.0 * value, decimals))
}

/// Makes the table of all candidates, the best first.
fn candidates(run: &Run, outcomes: &[Outcome], choice: &Choice, most: f64) -> Table {
    let least = |title: &str| Column::best(title, Best::Lowest);
    let columns = vec![
        Column::text("candidate"),
        Column::text(""),
        Column::text("maps"),
        least("MiB"),
        least("E %"),
        least("F_edge %"),
        least("E_log %"),
        least("D px"),
        least("acne %"),
        least("leak %"),
        least("draws"),
    ];
    let mut order: Vec<usize> = (0..outcomes.len()).collect();
    let error = |index: usize| outcomes[index].e.unwrap_or(f64::INFINITY);
    order.sort_by(|a, b| error(*a).total_cmp(&error(*b)).then(a.cmp(b)));
    let mut table = Table::new("By mean E over the views that count.", columns);
    for index in order {
        let outcome = &outcomes[index];
        let candidate = &run.candidates[outcome.candidate];
        let sizes = &candidate.config.map_sizes;
        let mut words = Vec::new();
        if index == choice.best {
            words.push("the best".to_owned());
        }
        if !is_still(outcome, most) {
            words.push("flickers too much".to_owned());
        }
        if choice.front.contains(&index) {
            words.push("front".to_owned());
        }
        words.extend(candidate.preset.iter().map(|preset| format!("preset {preset}")));
        table = table.row(vec![
            format!("`{}`", candidate.label).into(),
            words.join(", ").into(),
            format!("{} × {}²", sizes.len(), sizes.first().copied().unwrap_or_default()).into(),
            Cell::Number(outcome.bytes as f64 / MIB, 3),
            percent(outcome.e, 3),
            percent(outcome.flicker, 3),
            percent(outcome.e_log, 3),
            outcome.edge_distance_px.map_or(Cell::Missing, |distance| Cell::Number(distance, 2)),
            percent(outcome.acne, 3),
            percent(outcome.leak, 3),
            outcome.draws.map_or(Cell::Missing, |draws| Cell::Number(draws, 0)),
        ]);
    }
    table
}

/// Makes the table of E of the best in every view, beside the presets'.
fn view_table(run: &Run, outcomes: &[Outcome], choice: &Choice) -> Table {
    let preset = |index: &usize| run.candidates[outcomes[*index].candidate].preset.is_some();
    let shown: Vec<usize> = [choice.best]
        .into_iter()
        .chain((0..outcomes.len()).filter(preset).filter(|&index| index != choice.best))
        .collect();
    let mut columns = vec![Column::text("view"), Column::number("edge pixels"), Column::text("counts")];
    columns.extend(shown.iter().map(|&index| Column::number(&run.candidates[outcomes[index].candidate].label)));
    let mut table = Table::new("E in %, of every view: the best, and the presets.", columns);
    for (number, (view, first)) in run.views.iter().zip(views_of(outcomes)).enumerate() {
        let mut row = vec![
            Cell::Text(format!("{} · {} · {}, frame {}", view.scene, view.camera, view.sun, view.frame)),
            Cell::Number(first.edges as f64, 0),
            if first.counts { "yes" } else { "no" }.into(),
        ];
        row.extend(shown.iter().map(|&index| percent(outcomes[index].views.get(number).and_then(|view| view.e), 2)));
        table = table.row(row);
    }
    table
}

/// Makes the section on the axes that were tried and the combinations that were left out.
fn left_out(run: &Run) -> Section {
    let axes: Vec<String> = run.axes.iter().map(|axis| format!("`{}={}`", axis.key, axis.values.join("/"))).collect();
    let with: Vec<String> = run.with.iter().map(|(key, value)| format!("`{key}={value}`")).collect();
    let mut section = Section::new("What was tried").list(&axes);
    if !with.is_empty() {
        section = section.text(&format!("All candidates that do not try others: {}.", with.join(", ")));
    }
    if run.skipped.is_empty() {
        return section.text("No combination was left out.");
    }
    let reasons: Vec<String> = run.skipped.iter().map(|(reason, count)| format!("{count}: {reason}")).collect();
    section.heading("Combinations left out").list(&reasons)
}
