//! Lines and points over two axes.

use kuva::{
    plot::{
        LinePlot, ScatterPlot,
        annotations::ReferenceLine,
        legend::{LegendEntry, LegendShape},
        scatter::MarkerShape,
    },
    render::plots::Plot,
};

use super::{
    Axis, Colour, Error, Result,
    svg::{MARK_DASHES, element, layout, mark_entry, render, with_legend, with_plot_height, with_x, with_y},
};

/// Radius of a point in pixels.
const POINT: f64 = 4.0;
/// Markers of points. Their shapes differ, so that series differ not by colour alone.
const MARKERS: [MarkerShape; 4] =
    [MarkerShape::Circle, MarkerShape::Square, MarkerShape::Triangle, MarkerShape::Diamond];
/// The pattern of dashed lines.
const DASHES: &str = "7 4.5";

/// Style of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A solid line.
    #[default]
    Line,
    /// A thin dashed line: bounds, references, predictions.
    Dashed,
    /// Points without lines.
    Points,
    /// Points on a solid line.
    LineAndPoints,
}

impl Style {
    fn has_line(self) -> bool {
        self != Self::Points
    }

    fn has_points(self) -> bool {
        matches!(self, Self::Points | Self::LineAndPoints)
    }

    fn dashes(self) -> Option<&'static str> {
        (self == Self::Dashed).then_some(DASHES)
    }

    fn width(self) -> f64 {
        if self == Self::Dashed { 1.6 } else { 2.2 }
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; a series without a name is not in it.
    pub name: String,
    /// Points `(x, y)`; a NaN breaks the line.
    pub points: Vec<(f64, f64)>,
    /// Style of the series.
    pub style: Style,
    /// Colour; `None` is the palette's next.
    pub colour: Option<Colour>,
}

impl Series {
    /// Makes a series in the palette's next colour.
    #[must_use]
    pub fn new(name: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, style, colour: None }
    }

    /// Sets the colour.
    #[must_use]
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A thin line across the whole chart, with a label.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A vertical line at a value of x.
    X(f64, String),
    /// A horizontal line at a value of y.
    Y(f64, String),
}

/// A chart of lines and points.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Description in a few words.
    pub title: String,
    /// Axis to the right.
    pub x: Axis,
    /// Axis upwards.
    pub y: Axis,
    /// Series, the last on top.
    pub series: Vec<Series>,
    /// Lines across the chart.
    pub marks: Vec<Mark>,
    /// Width in pixels.
    pub width: f64,
    /// Height in pixels of the plot itself, without title, legend and labels.
    pub plot_height: f64,
}

impl Chart {
    /// Makes an empty chart of the usual size.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, series: Vec::new(), marks: Vec::new(), width: 680.0, plot_height: 300.0 }
    }

    /// Adds a series.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a line across the chart.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// Sets the width in pixels, and the height of the plot itself.
    #[must_use]
    pub fn size(self, width: f64, plot_height: f64) -> Self {
        Self { width, plot_height, ..self }
    }

    /// Draws the chart as an `<svg>` element.
    ///
    /// # Errors
    /// [`Error::Empty`] without a finite point, [`Error::Value`] for an infinite one, or one at or
    /// below 0 on a logarithmic axis.
    pub fn to_svg(&self) -> Result<String> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let any = points().any(|(x, y)| !x.is_nan() && !y.is_nan());
        if !any
            || !self.x.check(&self.title, points().map(|p| p.0))?
            || !self.y.check(&self.title, points().map(|p| p.1))?
        {
            return Err(Error::Empty { title: self.title.clone() });
        }
        let plots: Vec<Plot> = (0..self.series.len()).flat_map(|index| self.plots(index)).collect();
        let lowest = |of: fn(&(f64, f64)) -> f64| points().map(of).fold(f64::INFINITY, f64::min);
        let mut layout = layout(&plots, &self.title, self.width);
        layout = with_x(layout, &self.x, lowest(|p| p.0));
        layout = with_y(layout, &self.y, lowest(|p| p.1));
        let mut legend = self.legend();
        for mark in &self.marks {
            let (line, label) = match mark {
                Mark::X(value, label) => (ReferenceLine::vertical(*value), label),
                Mark::Y(value, label) => (ReferenceLine::horizontal(*value), label),
            };
            layout = layout.with_reference_line(line.with_color(Colour::Quiet.hex()).with_dasharray(MARK_DASHES));
            legend.push(mark_entry(label, Colour::Quiet));
        }
        layout = with_legend(layout, legend);
        element(&self.title, render(plots, with_plot_height(layout, self.plot_height)))
    }

    /// Returns a line for each run of points without a gap, and the points themselves.
    fn plots(&self, index: usize) -> Vec<Plot> {
        let series = &self.series[index];
        let (style, colour) = (series.style, self.colour(index).hex());
        let mut plots = Vec::new();
        for run in series.points.split(|(x, y)| x.is_nan() || y.is_nan()).filter(|run| !run.is_empty()) {
            if style.has_line() {
                let line = LinePlot::new().with_data(run.iter().copied()).with_color(colour.as_str());
                let line = line.with_stroke_width(style.width());
                let dashes = style.dashes().map(|dashes| kuva::plot::line::LineStyle::Custom(dashes.into()));
                plots.push(line.with_line_style(dashes.unwrap_or_default()).into());
            }
            if style.has_points() {
                let points = ScatterPlot::new().with_data(run.iter().copied()).with_color(colour.as_str());
                plots.push(points.with_size(POINT).with_marker(MARKERS[index % MARKERS.len()]).into());
            }
        }
        plots
    }

    fn colour(&self, index: usize) -> Colour {
        let own = |series: &Series| series.colour;
        let earlier = self.series[..index].iter().filter(|series| own(series).is_none()).count();
        own(&self.series[index]).unwrap_or(Colour::Series(earlier))
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let named = self.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty());
        let entry = |(index, series): (usize, &Series)| LegendEntry {
            label: series.name.clone(),
            color: self.colour(index).hex(),
            shape: match series.style {
                Style::Line | Style::Dashed => LegendShape::Line,
                Style::Points | Style::LineAndPoints => LegendShape::Marker(MARKERS[index % MARKERS.len()]),
            },
            dasharray: series.style.dashes().map(str::to_owned),
        };
        named.map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<(f64, f64)>) -> Chart {
        Chart::new("A chart", Axis::linear("x, m"), Axis::linear("y, ms")).series(Series::new(
            "first",
            Style::LineAndPoints,
            points,
        ))
    }

    #[test]
    fn everything_named_is_in_the_svg() {
        let svg = chart(vec![(0.0, 1.0), (1.0, 3.0)]).mark(Mark::Y(2.0, "limit".into())).to_svg().expect("drawable");
        for text in ["A chart", "first", "x, m", "y, ms", "limit"] {
            assert!(svg.contains(text), "{text} is missing");
        }
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn a_chart_without_data_is_an_error() {
        assert_eq!(chart(vec![]).to_svg(), Err(Error::Empty { title: "A chart".into() }));
        assert_eq!(chart(vec![(f64::NAN, 1.0)]).to_svg(), Err(Error::Empty { title: "A chart".into() }));
        assert!(matches!(chart(vec![(1.0, f64::INFINITY)]).to_svg(), Err(Error::Value { .. })));
    }
}
