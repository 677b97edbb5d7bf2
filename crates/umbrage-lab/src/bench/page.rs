//! The page of a benchmark: tables and plots of the measurements, and the theory.

use super::report::{CrowdReport, Report, Row, SceneReport};
use super::summary::Summary;
use crate::{
    failure::{Failure, Result},
    page::html::{Best, Cell, Column, Figure, Page, Section, Table},
    page::plot::{Axis, BarChart, BarSeries, Chart, Series, Style},
    theory,
};

/// Makes the whole page.
pub fn page(report: &Report) -> Result<String> {
    let mut sections = Vec::new();
    if !report.scenes.is_empty() {
        sections.push(overview(&report.scenes)?);
    }
    sections.extend(report.scenes.iter().map(scene));
    if !report.crowds.is_empty() {
        sections.push(crowds(&report.crowds)?);
    }
    let theory = theory::sections(&theory::Setting::default()).map_err(|error| Failure::other(error.to_string()))?;
    sections.extend(theory);
    let [width, height] = report.size;
    let page = Page {
        title: "What shadows cost".into(),
        lead: vec![
            format!(
                "{} at {width} × {height}, {} sample(s) a pixel, {} rounds; all techniques with {}.",
                report.adapter, report.samples, report.rounds, report.with
            ),
            "In each round every technique is drawn once, and after each the picture without shadows by shaders that never heard of \
             them: what shadows cost is the difference. A ratio is taken within its round; the table shows the median of the \
             rounds and, after ±, the standard deviation."
                .into(),
        ],
        sections,
        footer: "umbrage bench".into(),
    };
    Ok(page.html())
}

fn drawn(svg: crate::page::plot::Result<String>) -> Result<String> {
    svg.map_err(|error| Failure::other(error.to_string()))
}

fn median(summary: Option<Summary>) -> f64 {
    summary.map_or(f64::NAN, |summary| summary.median)
}

fn spread(summary: Option<Summary>, decimals: usize) -> Cell {
    match summary {
        Some(Summary { median, deviation, .. }) => Cell::Text(format!("{median:.decimals$} ± {deviation:.decimals$}")),
        None => Cell::Missing,
    }
}

/// Makes Figure 7 as ratios: frame time over the baseline's, per scene.
fn overview(scenes: &[SceneReport]) -> Result<Section> {
    let names = scenes.iter().map(|scene| scene.scene.clone()).collect();
    let baseline = scenes[0].rows.first().map_or("", |row| row.technique.as_str());
    let axis = Axis::linear(format!("frame time / {baseline}")).from_zero();
    let mut chart = BarChart::new("Frame time against the baseline", axis, names);
    for index in 0..scenes[0].rows.len() {
        let of =
            |f: &dyn Fn(&Row) -> f64| scenes.iter().map(|scene| scene.rows.get(index).map_or(f64::NAN, f)).collect();
        let deviations = of(&|row| row.frame_ratio.map_or(0.0, |ratio| ratio.deviation));
        let series = BarSeries::new(scenes[0].rows[index].technique.clone(), of(&|row| median(row.frame_ratio)));
        chart = chart.series(series.spread(deviations));
    }
    let figure = Figure::svg(
        drawn(chart.to_svg())?,
        "Median over the rounds; the whiskers are one standard deviation. The paper's Table 1 and Figure 7 as ratios.",
    );
    Ok(Section::new("All scenes").figure(&figure))
}

fn scene(report: &SceneReport) -> Section {
    let of = format!("{}, camera {}, {} triangles", report.scene, report.camera, report.triangles);
    let section = Section::new(report.scene.clone()).table(&table(of, &report.rows));
    if report.paths.is_empty() {
        return section;
    }
    let caption = format!("{}: the same maps by every pair of generation and storage", report.scene);
    section.table(&table(caption, &report.paths))
}

fn table(caption: String, rows: &[Row]) -> Table {
    let columns = vec![
        Column::text("technique"),
        Column::text("path"),
        Column::best("frame / baseline", Best::Lowest),
        Column::number("in the paper"),
        Column::number("frame, ms"),
        Column::number("maps, ms"),
        Column::number("with − without, ms"),
        Column::number("wall, ms"),
        Column::number("CPU, ms"),
        Column::number("first picture, CPU ms"),
        Column::number("plan, µs"),
        Column::number("samples / fragment"),
        Column::number("picture's fragments"),
        Column::number("pairs"),
        Column::number("draws"),
        Column::number("vertices"),
        Column::number("primitives"),
        Column::number("fragments"),
        Column::number("map MiB"),
    ];
    rows.iter().fold(Table::new(caption, columns), |table, row| {
        let count = |f: fn(&super::report::Counts) -> u64| {
            row.shadow_counts.as_ref().map_or(Cell::Missing, |counts| Cell::Number(f(counts) as f64, 0))
        };
        table.row(vec![
            row.technique.clone().into(),
            format!("{}, {}", row.generation, row.storage).into(),
            Cell::Number(median(row.frame_ratio), 2),
            row.paper_ratio.map_or(Cell::Missing, |ratio| Cell::Number(ratio, 2)),
            spread(row.frame_ms, 2),
            spread(row.shadow_ms, 2),
            spread(row.cost_ms, 2),
            spread(row.wall_ms, 1),
            spread(row.cpu_ms, 1),
            Cell::Number(row.first_picture_cpu_ms, 0),
            spread(row.plan_us, 0),
            Cell::Number(f64::from(row.samples), 0),
            row.view_counts.map_or(Cell::Missing, |counts| Cell::Number(counts.fragments as f64, 0)),
            Cell::Number(row.pairs as f64, 0),
            Cell::Number(row.draws as f64, 0),
            count(|counts| counts.vertices),
            count(|counts| counts.primitives),
            count(|counts| counts.fragments),
            Cell::Number(row.map_bytes as f64 / 1_048_576.0, 2),
        ])
    })
}

/// Makes GPU Gems' Figure 10-9: time and counts over the number of objects.
fn crowds(crowds: &[CrowdReport]) -> Result<Section> {
    let lines = |title: &str, label: &str, value: &dyn Fn(&Row) -> f64| -> Result<Figure> {
        let mut chart = Chart::new(title, Axis::log("objects"), Axis::log(label));
        for index in 0..crowds[0].rows.len() {
            let points = crowds
                .iter()
                .filter_map(|crowd| Some((f64::from(crowd.objects), value(crowd.rows.get(index)?))))
                .filter(|(_, y)| *y > 0.0)
                .collect();
            let name = crowds[0].rows[index].technique.clone();
            chart = chart.series(Series::new(name, Style::LineAndPoints, points));
        }
        Ok(Figure::svg(drawn(chart.to_svg())?, ""))
    };
    let frame = lines("Frame time over the number of objects", "frame, ms", &|row| median(row.frame_ms))?;
    let maps = lines("Time of the maps over the number of objects", "maps, ms", &|row| median(row.shadow_ms))?;
    let draws = lines("Draws over the number of objects", "draws", &|row| row.draws as f64)?;
    let vertices = lines("Vertices over the number of objects", "vertices", &|row| {
        row.shadow_counts.map_or(f64::NAN, |counts| counts.vertices as f64)
    })?;
    Ok(Section::new("Over the number of objects")
        .text("GPU Gems 3, Figure 10-9, with four splits: robots on a plane that grows with their number.")
        .figures(&[frame, maps, draws, vertices]))
}
