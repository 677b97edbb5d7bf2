//! Lines and points over two axes.

use plotters::{
    chart::ChartBuilder,
    style::text_anchor::{HPos, VPos},
};

use super::canvas::{Canvas, Failed, SMALL, fill, stroke, svg, text_width, units};
use super::legend::{Entry, Legend, Look};
use super::scale::Ruler;
use super::{Axis, Colour, Error, Result, clip};

/// Radius of a point, pixels.
const POINT: f64 = 4.0;

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A solid line.
    #[default]
    Line,
    /// A thin dashed line: bounds, references, predictions.
    Dashed,
    /// Points alone.
    Points,
    /// Points on a solid line.
    LineAndPoints,
}

/// What joins the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Nothing.
    None,
    /// An unbroken line.
    Solid,
    /// Dashes.
    Dashed,
}

impl Style {
    pub(super) fn line(self) -> Line {
        match self {
            Self::Line | Self::LineAndPoints => Line::Solid,
            Self::Dashed => Line::Dashed,
            Self::Points => Line::None,
        }
    }

    pub(super) fn has_points(self) -> bool {
        matches!(self, Self::Points | Self::LineAndPoints)
    }

    pub(super) fn width(self) -> f64 {
        if self == Self::Dashed { 1.6 } else { 2.2 }
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// In the legend; a series without a name is not in it.
    pub name: String,
    /// `(x, y)`; a NaN breaks the line.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
    /// `None`: the palette's next.
    pub colour: Option<Colour>,
}

impl Series {
    /// A series in the palette's next colour.
    #[must_use]
    pub fn new(name: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, style, colour: None }
    }

    /// The same series in this colour.
    #[must_use]
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A thin line right across the chart, with a word to it.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// Upright, at a value of x.
    X(f64, String),
    /// Level, at a value of y.
    Y(f64, String),
}

/// A chart of lines and points.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it shows, in a few words.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
    /// Lines across.
    pub marks: Vec<Mark>,
    /// Pixels across.
    pub width: f64,
    /// Pixels down that the plot itself takes; title, legend and labels come on top.
    pub plot_height: f64,
}

impl Chart {
    /// An empty chart of the usual size.
    #[must_use]
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, series: Vec::new(), marks: Vec::new(), width: 680.0, plot_height: 300.0 }
    }

    /// The same chart with one more series.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The same chart with one more line across.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// The same chart, `width` pixels across and its plot `plot_height` pixels high.
    #[must_use]
    pub fn size(self, width: f64, plot_height: f64) -> Self {
        Self { width, plot_height, ..self }
    }

    /// The chart as an `<svg>` element.
    ///
    /// # Errors
    /// [`Error::Empty`] without a finite point, [`Error::Value`] for an infinite one, or one at or below 0 on a logarithmic
    /// axis.
    pub fn to_svg(&self) -> Result<String> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        if !points().any(|(x, y)| !x.is_nan() && !y.is_nan()) {
            return Err(Error::Empty { title: self.title.clone() });
        }
        let x = self.x.ruler(&self.title, points().map(|p| p.0))?;
        let y = self.y.ruler(&self.title, points().map(|p| p.1))?;

        let tick_width = y.labels().map(|label| text_width(&label, SMALL)).fold(0.0, f64::max);
        let (left, right) = (tick_width.ceil() + 16.0, self.width - 22.0);
        let legend = Legend::new(&self.title, self.legend(), 4.0, self.width - 4.0);
        // The label of the y axis stands on top of it, level, where it can be read.
        let top = legend.height + 26.0;
        let bottom = top + self.plot_height;
        let height = bottom + 50.0;
        svg(&self.title, (self.width, height), |canvas| {
            legend.draw(canvas, 4.0)?;
            canvas.text(&self.y.label, (4.0, legend.height + 4.0), SMALL, Colour::Quiet, (HPos::Left, VPos::Top))?;
            let middle = 0.5 * (left + right);
            canvas.text(&self.x.label, (middle, height - 20.0), SMALL, Colour::Quiet, (HPos::Center, VPos::Top))?;
            axes(canvas, (left, top), (right, bottom), &x, &y)?;
            let frame = Frame { x: &x, y: &y, left, right, top, bottom };
            let mut taken = Vec::new();
            let curves: Vec<(f64, f64)> = self.series.iter().flat_map(|series| frame.trace(series)).collect();
            for mark in &self.marks {
                frame.mark(canvas, mark, &curves, &mut taken)?;
            }
            for (index, series) in self.series.iter().enumerate() {
                frame.series(canvas, series, self.colour(index), index)?;
            }
            Ok(())
        })
    }

    fn colour(&self, index: usize) -> Colour {
        let own = |series: &Series| series.colour;
        let earlier = self.series[..index].iter().filter(|series| own(series).is_none()).count();
        own(&self.series[index]).unwrap_or(Colour::Series(earlier))
    }

    fn legend(&self) -> Vec<Entry> {
        self.series
            .iter()
            .enumerate()
            .filter(|(_, series)| !series.name.is_empty())
            .map(|(index, series)| Entry {
                name: series.name.clone(),
                colour: self.colour(index),
                look: Look::Line(series.style, index),
            })
            .collect()
    }
}

/// Grid, axes and the labels of their ticks.
pub(super) fn axes(
    canvas: &Canvas<'_>,
    (left, top): (f64, f64),
    (right, bottom): (f64, f64),
    x: &Ruler,
    y: &Ruler,
) -> Result<(), Failed> {
    let area = canvas.part((0.0, top), (right, bottom));
    let mut chart = ChartBuilder::on(&area);
    chart.set_all_label_area_size(0).margin_left(units(left));
    let mut chart = chart.build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .bold_line_style(stroke(Colour::Grid, 1.1, 1.0))
        .light_line_style(stroke(Colour::Grid, 0.6, 1.0))
        .disable_axes()
        .draw()?;
    let pen = stroke(Colour::Quiet, 1.2, 1.0);
    canvas.line(&[(left, bottom), (right, bottom)], pen)?;
    let mut last_end = f64::NEG_INFINITY;
    for (share, label) in x.ticks() {
        let at = left + share * (right - left);
        canvas.line(&[(at, bottom), (at, bottom + 4.0)], pen)?;
        let half = 0.5 * text_width(&label, SMALL);
        if at - half > last_end + 4.0 {
            canvas.text(&label, (at, bottom + 7.0), SMALL, Colour::Ink, (HPos::Center, VPos::Top))?;
            last_end = at + half;
        }
    }
    let mut last = f64::INFINITY;
    for (share, label) in y.ticks() {
        let at = bottom - share * (bottom - top);
        if last - at > SMALL {
            canvas.text(&label, (left - 8.0, at), SMALL, Colour::Ink, (HPos::Right, VPos::Center))?;
            last = at;
        }
    }
    Ok(())
}

/// A point's sign; shapes differ so that colour is not all that tells series apart.
pub(super) fn marker(canvas: &Canvas<'_>, (x, y): (f64, f64), shape: usize, colour: Colour) -> Result<(), Failed> {
    let ring = |corners: usize, turn: f64, radius: f64| -> Vec<(f64, f64)> {
        (0..corners)
            .map(|i| {
                let angle = std::f64::consts::TAU * (i as f64 + turn) / corners as f64;
                (x + radius * angle.sin(), y - radius * angle.cos())
            })
            .collect()
    };
    let paint = |radius: f64, colour: Colour| match shape % 4 {
        0 => canvas.disc((x, y), radius, fill(colour, 1.0)),
        1 => canvas.polygon(&ring(4, 0.5, radius * 1.25), fill(colour, 1.0)),
        2 => canvas.polygon(&ring(3, 0.0, radius * 1.4), fill(colour, 1.0)),
        _ => canvas.polygon(&ring(4, 0.0, radius * 1.35), fill(colour, 1.0)),
    };
    paint(POINT + 1.2, Colour::Paper)?;
    paint(POINT, colour)
}

/// The plot's rectangle and its rulers.
struct Frame<'a> {
    x: &'a Ruler,
    y: &'a Ruler,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Frame<'_> {
    fn place(&self, (u, v): (f64, f64)) -> (f64, f64) {
        (self.left + u * (self.right - self.left), self.bottom - v * (self.bottom - self.top))
    }

    /// In shares of the frame.
    fn shares(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.x.share(x), self.y.share(y))
    }

    fn series(&self, canvas: &Canvas<'_>, series: &Series, colour: Colour, shape: usize) -> Result<(), Failed> {
        let shares: Vec<(f64, f64)> = series.points.iter().map(|&point| self.shares(point)).collect();
        let pen = stroke(colour, series.style.width(), 1.0);
        if series.style.line() != Line::None {
            for piece in clip::line(&shares) {
                let piece: Vec<_> = piece.into_iter().map(|share| self.place(share)).collect();
                match series.style.line() {
                    Line::Dashed => canvas.dashed(&piece, pen, 7.0, 4.5)?,
                    _ => canvas.line(&piece, pen)?,
                }
            }
        }
        if series.style.has_points() {
            let inside = |share: f64| (-1e-9..=1.0 + 1e-9).contains(&share);
            for &(u, v) in shares.iter().filter(|(u, v)| inside(*u) && inside(*v)) {
                marker(canvas, self.place((u, v)), shape, colour)?;
            }
        }
        Ok(())
    }

    /// Points along a series, in pixels, close enough together to tell where its line passes.
    fn trace(&self, series: &Series) -> Vec<(f64, f64)> {
        const STEPS: u32 = 24;
        let shares: Vec<(f64, f64)> = series.points.iter().map(|&point| self.shares(point)).collect();
        let between = |pair: &[(f64, f64)]| {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            (0..=STEPS).map(move |k| {
                let t = f64::from(k) / f64::from(STEPS);
                (x0 + t * (x1 - x0), y0 + t * (y1 - y0))
            })
        };
        let along: Vec<(f64, f64)> = match series.style.line() {
            Line::None => shares,
            _ => clip::line(&shares).iter().flat_map(|piece| piece.windows(2).flat_map(between)).collect(),
        };
        along.into_iter().map(|share| self.place(share)).collect()
    }

    /// `curves` are points that labels should keep clear of; `taken` holds where labels stand already, so that the next
    /// one moves aside.
    fn mark(
        &self,
        canvas: &Canvas<'_>,
        mark: &Mark,
        curves: &[(f64, f64)],
        taken: &mut Vec<(f64, f64, f64)>,
    ) -> Result<(), Failed> {
        let pen = stroke(Colour::Quiet, 1.1, 1.0);
        match mark {
            Mark::X(value, label) => {
                let share = self.x.share(*value);
                if !(0.0..=1.0).contains(&share) {
                    return Ok(());
                }
                let (x, _) = self.place((share, 0.0));
                canvas.dashed(&[(x, self.bottom), (x, self.top)], pen, 3.0, 3.0)?;
                let width = text_width(label, SMALL);
                let left = if x + 5.0 + width > self.right { x - 5.0 - width } else { x + 5.0 };
                let mut y = self.top + 3.0;
                while taken.iter().any(|&(from, to, at)| left < to && left + width > from && (y - at).abs() < 15.0) {
                    y += 16.0;
                }
                taken.push((left, left + width, y));
                canvas.text(label, (left, y), SMALL, Colour::Quiet, (HPos::Left, VPos::Top))
            }
            Mark::Y(value, label) => {
                let share = self.y.share(*value);
                if !(0.0..=1.0).contains(&share) {
                    return Ok(());
                }
                let (_, y) = self.place((0.0, share));
                canvas.dashed(&[(self.left, y), (self.right, y)], pen, 3.0, 3.0)?;
                let width = text_width(label, SMALL);
                // At one of the line's ends, above or below it: where the fewest points of curves are in the way.
                let ends = [self.right - 3.0 - width, self.left + 4.0];
                let places = ends.into_iter().flat_map(|x| [(x, y - 18.0), (x, y + 3.0)]);
                let best = places
                    .filter(|(_, top)| *top >= self.top && top + 15.0 <= self.bottom)
                    .min_by_key(|&(x, top)| {
                        let hit = |p: &&(f64, f64)| {
                            (x - 2.0..x + width + 2.0).contains(&p.0) && (top..top + 15.0).contains(&p.1)
                        };
                        curves.iter().filter(hit).count()
                    })
                    .unwrap_or((ends[0], y - 18.0));
                canvas.text(label, best, SMALL, Colour::Quiet, (HPos::Left, VPos::Top))
            }
        }
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
