//! The page of a comparison: sheets, tables, plots.

use super::{
    report::{Comparison, DepthMeans, LIMIT, TechniqueReport, ViewReport},
    sheet::{Label, SheetShot},
};
use crate::{
    failure::{Failure, Result},
    page::html::{Best, Cell, Column, Figure, Page, Section, Sheet, Table},
    page::plot::{self, Axis, Chart, Mark, Series, Style},
    picture::png,
};

/// Number of series with colours of their own; further ones are dashed.
const COLOURS: usize = 8;

/// Makes the page's text. `labels` and `sheets` are those of the contact sheet and of the sheet of
/// errors.
///
/// # Errors
/// [`Failure::Other`] if a chart or picture cannot be made, which would be a mistake of ours.
pub fn page(comparison: &Comparison, labels: &[Label], sheets: &[Vec<SheetShot>; 2]) -> Result<String> {
    let [width, height] = comparison.size;
    let counting = comparison.views.iter().filter(|view| view.counts).count();
    let lead = vec![
        format!(
            "Techniques: {}; views: {}, of {width} × {height} pixels, judged by exact rays. Means are over the views whose true shadows \
             have {} edge pixels or more: {counting}.",
            comparison.techniques.len(),
            comparison.views.len(),
            comparison.least_edges
        ),
        "E: share of surface points that face the sun and are decided wrongly (E_fs: dark instead of lit, acne; E_fl: lit instead \
         of dark, leaks). E_log: the same, fair to every depth. D: mean distance of shadow edges from where they should be. m_p: \
         pixels that a texel spans on the screen. F_edge: decisions that flip from frame to frame, per pixel of true edge."
            .to_owned(),
    ];
    let mut sections = vec![pictures(labels, sheets)?, table(comparison)];
    sections.extend(plots(comparison)?);
    sections.push(pairs(comparison));
    sections.push(views(comparison));
    if !comparison.walks.is_empty() {
        sections.push(walks(comparison));
    }
    sections.push(settings(comparison));
    let title = match &comparison.views.first() {
        Some(first) if comparison.views.iter().all(|view| view.scene == first.scene) => {
            format!("Shadows compared: {}", first.scene)
        }
        _ => "Shadows compared".into(),
    };
    let footer = format!("Made by `{}` on {}.", comparison.command.join(" "), comparison.adapter);
    Ok(Page { title, lead, sections, footer }.html())
}

fn pictures(labels: &[Label], sheets: &[Vec<SheetShot>; 2]) -> Result<Section> {
    let [pictures, errors] = sheets;
    let section = Section::new("Shots")
        .text(
            "Rows are techniques, columns shots; the truth is the last row. The inset enlarges the part in which techniques differ most. \
             E and D of each picture are below it.",
        )
        .sheet(&grid(labels, pictures)?)
        .heading("Errors")
        .text(
            "The same shots: wrong decisions on the truth in grey. Leaks (lit instead of dark) are red, acne (dark instead of lit) is \
             blue; what is dimmed is not scored. Along a walk, decisions that flipped since the frame before are yellow.",
        );
    Ok(section.sheet(&grid(labels, errors)?))
}

fn grid(labels: &[Label], shots: &[SheetShot]) -> Result<Sheet> {
    let heading = |shot: &SheetShot| {
        let parts = [std::slice::from_ref(&shot.title), &shot.lines].concat();
        parts.into_iter().chain(shot.warning.clone()).collect::<Vec<_>>().join(", ")
    };
    let rows = labels.iter().enumerate().map(|(row, label)| {
        let figures = shots.iter().map(|shot| {
            let cell = &shot.cells[row];
            let least = if cell.is_best { ", the least" } else { "" };
            let alt = format!("{}, {}", shot.title, label.title);
            Ok(Figure::picture(&png(&cell.picture)?, &alt, format!("{}{least}", cell.caption)))
        });
        Ok((label.title.clone(), figures.collect::<Result<_>>()?))
    });
    Ok(Sheet { columns: shots.iter().map(heading).collect(), rows: rows.collect::<Result<_>>()? })
}

fn percent(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Missing, |value| Cell::Number(100.0 * value, decimals))
}

fn number(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Missing, |value| Cell::Number(value, decimals))
}

/// A column of the table of scores: its heading, and its cell for a technique.
type Figures = (Column, fn(&TechniqueReport) -> Cell);

/// Returns the columns of the table of scores that every comparison has.
fn figures() -> Vec<Figures> {
    let least = |title: &str, of: fn(&TechniqueReport) -> Cell| (Column::best(title, Best::Lowest), of);
    let plain = |column: Column, of: fn(&TechniqueReport) -> Cell| (column, of);
    vec![
        plain(Column::text("technique"), |t| t.label.as_str().into()),
        least("Mtexel", |t| Cell::Number(t.texels as f64 / 1048576.0, 2)),
        least("MiB", |t| Cell::Number(t.bytes as f64 / 1048576.0, 2)),
        least("E %", |t| percent(t.mean.e, 2)),
        least("E_fs %", |t| percent(t.mean.e_false_shadow, 2)),
        least("E_fl %", |t| percent(t.mean.e_false_light, 2)),
        least("acne %", |t| percent(t.mean.acne, 3)),
        least("leak %", |t| percent(t.mean.leak, 3)),
        least("E_log %", |t| percent(t.mean.e_log, 2)),
        least("D px", |t| number(t.mean.edge_distance_px, 2)),
        least("D p95 px", |t| number(t.mean.edge_distance_p95_px, 1)),
        plain(Column::number("seam"), |t| number(t.mean.seam_ratio, 2)),
        least("m_p p50", |t| number(t.mean.texel_px.map(|texel| texel.perspective_p50), 1)),
        least("m_p p99", |t| number(t.mean.texel_px.map(|texel| texel.perspective_p99), 1)),
        least("F_edge %", |t| percent(t.mean.flicker_per_edge, 2)),
        least("F %", |t| percent(t.mean.flicker, 3)),
        least("casters × splits", |t| number(t.mean.caster_split_pairs, 0)),
        least("draws", |t| number(t.mean.draws, 0)),
    ]
}

/// Returns the columns of image metrics.
fn metric_figures() -> [Figures; 2] {
    [(Column::number("FLIP"), |t| number(t.mean.flip, 4)), (Column::number("SSIM"), |t| number(t.mean.ssim, 4))]
}

/// Returns the columns of soft shadows, with `--sun-angle`.
fn soft_figures() -> [Figures; 2] {
    [
        (Column::best("E_soft %", Best::Lowest), |t| percent(t.mean.e_soft, 2)),
        (Column::best("E_pen %", Best::Lowest), |t| percent(t.mean.e_pen, 2)),
    ]
}

/// Returns the columns of exact edges.
fn edge_figures() -> [Figures; 2] {
    [
        (Column::best("undecided %", Best::Lowest), |t| percent(t.mean.undecided, 2)),
        (Column::best("triangles each", Best::Lowest), |t| number(t.mean.triangles_per_undecided, 1)),
    ]
}

fn table(comparison: &Comparison) -> Section {
    let mut figures = figures();
    let metrics = comparison.techniques.iter().any(|technique| technique.mean.ssim.is_some());
    if metrics {
        figures.extend(metric_figures());
    }
    if comparison.techniques.iter().any(|technique| technique.mean.e_soft.is_some()) {
        figures.extend(soft_figures());
    }
    if comparison.techniques.iter().any(|technique| technique.mean.undecided.is_some()) {
        figures.extend(edge_figures());
    }
    let caption = "Means over the views that count; the best of a column in bold. Acne and leak: wrong farther than 2 + 1.5 m pixels from \
         true edges. Seam: E within 2 px of a split's border over the larger E of its sides, pooled over all views; 1 is none, 1.1 the most. Undecided: \
         points that exact edges test against triangles, and how many of these each of them is.";
    let (columns, cells): (Vec<_>, Vec<_>) = figures.into_iter().unzip();
    let table = comparison.techniques.iter().fold(Table::new(caption, columns), |table, technique| {
        table.row(cells.iter().map(|of| of(technique)).collect())
    });
    let mut section = Section::new("Scores").table(&table);
    if metrics {
        section = section.note("FLIP and SSIM compare masks with the truth's on the shots that are shown. They are for information and gate nothing.");
    }
    for family in &comparison.memory_at_half_percent {
        section = section.text(&format!(
            "`{}` comes down to E = {} % with {} {:.2} Mtexel.",
            family.family,
            100.0 * LIMIT,
            family.bound,
            family.texels / 1048576.0
        ));
    }
    section
}

fn plots(comparison: &Comparison) -> Result<Vec<Section>> {
    let style = |number: usize| if number < COLOURS { Style::LineAndPoints } else { Style::Dashed };
    let each = |of: &dyn Fn(&DepthMeans) -> Option<(f64, f64)>, lines: bool| -> Vec<Series> {
        let series = comparison.techniques.iter().enumerate().filter_map(|(number, technique)| {
            let points: Vec<(f64, f64)> = technique.mean.by_depth.iter().filter_map(of).collect();
            let style = if lines { style(number) } else { Style::Points };
            (!points.is_empty()).then(|| Series::new(&technique.label, style, points))
        });
        series.collect()
    };
    let positive = |value: f64| (value > 0.0).then_some(value);
    let mut figures = Vec::new();

    let mut memory = Chart::new("Error against memory", Axis::log("Mtexel of shadow maps"), Axis::log("mean E, %"))
        .mark(Mark::Y(100.0 * LIMIT, "E = 0.5 %".into()));
    memory.series = by_family(&comparison.techniques);
    figures.extend(drawn(&memory, "Techniques that differ in map size only are joined.")?);

    let mut depth = Chart::new("Error against depth", Axis::log("view depth, m"), Axis::log("mean E, %"));
    depth.series = each(&|bin| Some((bin.depth_m, positive(100.0 * bin.e?)?)), true);
    figures.extend(drawn(&depth, "E in eight equal bins of the depth's logarithm; bins without error are left out.")?);

    let mut texels =
        Chart::new("Predicted against measured texels per pixel", Axis::log("predicted"), Axis::log("measured"));
    texels.series =
        each(&|bin| positive(bin.predicted_texels_per_px?).zip(positive(bin.measured_texels_per_px?)), false);
    let values = || texels.series.iter().flat_map(|series| &series.points).flat_map(|point| [point.0, point.1]);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    if low < high {
        texels
            .series
            .insert(0, Series::new("equal", Style::Dashed, vec![(low, low), (high, high)]).colour(plot::Colour::Quiet));
    }
    figures.extend(drawn(
        &texels,
        "Medians in bins of depth, along the worse axis. Predicted: by the planner, from its matrices and the surface's slope. \
         Measured: how far apart the points of neighbouring pixels, as rays found them, fall in the map.",
    )?);
    Ok(if figures.is_empty() { Vec::new() } else { vec![Section::new("Plots").figures(&figures)] })
}

/// Returns one series for each family of techniques, over texels.
fn by_family(techniques: &[TechniqueReport]) -> Vec<Series> {
    let mut series = Vec::new();
    for (number, first) in techniques.iter().enumerate() {
        if techniques[..number].iter().any(|earlier| earlier.family == first.family) {
            continue;
        }
        let family = techniques[number..].iter().filter(|other| other.family == first.family);
        let mut points: Vec<(f64, f64)> = family
            .filter_map(|technique| Some((technique.texels as f64 / 1048576.0, 100.0 * technique.mean.e?)))
            .filter(|point| point.1 > 0.0)
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (name, style) = if points.len() > 1 {
            (format!("{} and larger or smaller", first.label), Style::LineAndPoints)
        } else {
            (first.label.clone(), Style::Points)
        };
        if !points.is_empty() {
            series.push(Series::new(name, style, points));
        }
    }
    series
}

/// Makes a figure of a chart; `None` if there is nothing to draw.
fn drawn(chart: &Chart, caption: &str) -> Result<Option<Figure>> {
    match chart.to_svg() {
        Ok(svg) => Ok(Some(Figure::svg(svg, caption))),
        Err(plot::Error::Empty { .. }) => Ok(None),
        Err(error) => Err(Failure::other(error.to_string())),
    }
}

fn pairs(comparison: &Comparison) -> Section {
    let labels: Vec<&str> = comparison.techniques.iter().map(|technique| technique.label.as_str()).collect();
    let columns = [Column::text("")];
    let columns = columns.into_iter().chain(labels.iter().map(|&label| Column::number(label))).collect();
    let mut table = Table::new(
        "Mean E of the row less that of the column, in % (in how many views the row : the column is better). Below 0 the row is better.",
        columns,
    );
    for row in &labels {
        let cells = labels.iter().map(|column| {
            let pair = |a: &str, b: &str| comparison.pairs.iter().find(|pair| pair.first == a && pair.second == b);
            let (difference, wins, losses) = match (pair(row, column), pair(column, row)) {
                (Some(pair), _) => (pair.mean_difference, pair.first_better, pair.second_better),
                (None, Some(pair)) => (-pair.mean_difference, pair.second_better, pair.first_better),
                _ => return Cell::Missing,
            };
            Cell::Text(format!("{:+.2} ({wins} : {losses})", 100.0 * difference).replace('-', "−"))
        });
        table = table.row([Cell::from(*row)].into_iter().chain(cells).collect());
    }
    Section::new("View by view").table(&table)
}

fn views(comparison: &Comparison) -> Section {
    let mut columns = vec![Column::text("view"), Column::number("edge pixels"), Column::text("counts")];
    columns.extend(comparison.techniques.iter().map(|technique| Column::number(technique.label.as_str())));
    let mut table = Table::new("E in %, of every view.", columns);
    for view in &comparison.views {
        let mut row = vec![
            Cell::Text(name(view)),
            Cell::Number(view.true_edges as f64, 0),
            if view.counts { "yes" } else { "no" }.into(),
        ];
        row.extend(view.scores.iter().map(|scores| percent(scores.e, 2)));
        table = table.row(row);
    }
    Section::new("Every view").table(&table)
}

fn name(view: &ViewReport) -> String {
    let frame = view.frame.map_or(String::new(), |frame| format!(", frame {frame}"));
    format!("{} · {} · {}{frame}", view.scene, view.camera.name, view.sun_name)
}

fn walks(comparison: &Comparison) -> Section {
    let mut columns = vec![Column::text("walk"), Column::number("frames"), Column::text("counts")];
    columns.extend(comparison.techniques.iter().map(|technique| Column::text(technique.label.as_str())));
    let caption = "F_edge in %: decisions that flip between frames, per pixel of true edge; then over points that keep their split, over those \
         whose map takes no step, and how often a map took one instead of moving by whole texels.";
    let mut table = Table::new(caption, columns);
    for walk in &comparison.walks {
        let mut row = vec![
            Cell::Text(format!("{} · {} · {}", walk.scene, walk.camera, walk.sun_name)),
            Cell::Number(walk.frames as f64, 0),
            if walk.counts { "yes" } else { "no" }.into(),
        ];
        row.extend(walk.flicker.iter().map(|flicker| {
            let rate = |value: Option<f64>| value.map_or("–".into(), |value| format!("{:.2}", 100.0 * value));
            let [all, kept, standing] = [flicker.per_edge, flicker.kept_per_edge, flicker.standing_per_edge].map(rate);
            Cell::Text(format!("{all} · {kept} · {standing} · {}", flicker.steps))
        }));
        table = table.row(row);
    }
    Section::new("Flicker").table(&table)
}

fn settings(comparison: &Comparison) -> Section {
    let mut table = Table::new(
        "",
        vec![Column::text("technique"), Column::text("in short"), Column::text("options of `umbrage render`")],
    );
    for technique in &comparison.techniques {
        table = table.row(vec![
            technique.label.as_str().into(),
            format!("`{}`", technique.spec).into(),
            format!("`{}`", technique.options.join(" ")).into(),
        ]);
    }
    let mut section =
        Section::new("Settings").table(&table).text(&format!("Any mask again: `{}`.", comparison.reproduce));
    let views: Vec<String> =
        comparison.views.iter().map(|view| format!("{}: {}", name(view), view.options.join(" "))).collect();
    section = section.folded("Options of the views", &views.join("\n"));
    if !comparison.notes.is_empty() {
        section = section.heading("Notes").list(&comparison.notes);
    }
    section
}
