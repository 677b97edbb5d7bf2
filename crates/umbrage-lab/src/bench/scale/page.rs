//! The page of a benchmark over the number of objects: a table and plots.

use super::job::Case;
use super::report::{CaseReport, ScaleReport};
use crate::{
    bench::summary::Summary,
    failure::{Failure, Result},
    page::html::{Cell, Column, Figure, Page, Section, Table},
    page::plot::{Axis, Chart, Series, Style},
};

/// Makes the whole page.
pub fn page(report: &ScaleReport) -> Result<String> {
    let [width, height] = report.size;
    let page = Page {
        title: "What shadows cost as worlds grow".into(),
        lead: vec![
            format!(
                "{} at {width} × {height}, {} frames of each case, {}.",
                report.adapter, report.rounds, report.technique
            ),
            "A forest of ever more trees, equally dense, seen by the camera `middle`. A camera walks at 1.4 m/s and 60 Hz. Frames \
             without shadows are drawn by shaders that never heard of them."
                .into(),
        ],
        sections: vec![plots(report)?, tables(report)],
        footer: "umbrage bench --scale".into(),
    };
    Ok(page.html())
}

fn median(summary: Option<Summary>) -> f64 {
    summary.map_or(f64::NAN, |summary| summary.median)
}

/// Returns the milliseconds of a frame that shadows take.
fn cost(case: &CaseReport) -> f64 {
    median(case.frame_ms) - median(case.frame_without_ms)
}

fn plots(report: &ScaleReport) -> Result<Section> {
    let lines = |title: &str, label: &str, value: &dyn Fn(&CaseReport) -> f64| -> Result<Figure> {
        let mut chart = Chart::new(title, Axis::log("objects"), Axis::log(label));
        for case in Case::ALL {
            let points: Vec<(f64, f64)> = report
                .sizes
                .iter()
                .flat_map(|size| size.cases.iter().map(move |of| (size.objects as f64, of)))
                .filter(|(_, of)| of.case == case)
                .map(|(objects, of)| (objects, value(of)))
                .filter(|(_, y)| *y > 0.0)
                .collect();
            // Nothing at all is no point of a logarithmic axis.
            if !points.is_empty() {
                chart = chart.series(Series::new(case.label(), Style::LineAndPoints, points));
            }
        }
        let svg = chart.to_svg().map_err(|error| Failure::other(error.to_string()))?;
        Ok(Figure::svg(svg, "Median; what is 0 is left out."))
    };
    Ok(Section::new("Over the number of objects").figures(&[
        lines("Planning", "plan, µs", &|case| median(case.plan_us))?,
        lines("Caster-split pairs", "pairs", &|case| median(case.pairs))?,
        lines("Triangles drawn into maps", "triangles", &|case| median(case.triangles))?,
        lines("Time of the maps", "maps, ms", &|case| median(case.shadow_ms))?,
        lines("Frame with shadows less frame without", "ms", &cost)?,
    ]))
}

/// Makes the section on culling on the GPU, number after number.
fn by_gpu(report: &ScaleReport) -> Section {
    let columns = vec![
        Column::number("objects"),
        Column::number("plan, µs"),
        Column::number("compute pass, ms"),
        Column::number("pairs"),
        Column::number("triangles"),
        Column::number("MiB"),
    ];
    let caption = "Instances culled on the GPU; the planner knows of tiles of the ground alone".to_owned();
    let culled = report.sizes.iter().filter_map(|size| size.by_gpu.as_ref().map(|by_gpu| (size.objects, by_gpu)));
    let table = culled.fold(Table::new(caption, columns), |table, (objects, by_gpu)| {
        table.row(vec![
            Cell::Number(objects as f64, 0),
            Cell::Number(median(by_gpu.plan_us), 0),
            Cell::Number(median(by_gpu.cull_ms), 2),
            Cell::Number(by_gpu.pairs as f64, 0),
            Cell::Number(by_gpu.triangles as f64, 0),
            Cell::Number(by_gpu.bytes as f64 / 1_048_576.0, 1),
        ])
    });
    Section::new("Figures").table(&table)
}

fn tables(report: &ScaleReport) -> Section {
    let columns = || {
        vec![
            Column::text("case"),
            Column::number("plan, µs"),
            Column::number("pairs"),
            Column::number("triangles"),
            Column::number("triangles of the first frame"),
            Column::number("maps, ms"),
            Column::number("frame, ms"),
            Column::number("frame without, ms"),
        ]
    };
    let section = by_gpu(report);
    report.sizes.iter().fold(section, |section, size| {
        let caption = format!("{} trees, {} objects, opened in {:.0} ms", size.trees, size.objects, size.open_ms);
        let table = size.cases.iter().fold(Table::new(caption, columns()), |table, case| {
            table.row(vec![
                case.case.label().to_owned().into(),
                Cell::Number(median(case.plan_us), 0),
                Cell::Number(median(case.pairs), 0),
                Cell::Number(median(case.triangles), 0),
                Cell::Number(case.first_triangles as f64, 0),
                Cell::Number(median(case.shadow_ms), 2),
                Cell::Number(median(case.frame_ms), 2),
                Cell::Number(median(case.frame_without_ms), 2),
            ])
        });
        section.table(&table)
    })
}
