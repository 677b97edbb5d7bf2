//! Bars, lying, so that long names can stand beside them.

use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{SMALL, fill, stroke, svg, text_width};
use super::legend::{Entry, Legend, Look};
use super::scale::Scale;
use super::{Axis, Colour, Error, Mark, Result, number};

/// Pixels across one bar.
const BAR: f64 = 15.0;
/// Pixels between the bars of two categories.
const GAP: f64 = 13.0;

/// One bar per category.
#[derive(Clone, Debug, PartialEq)]
pub struct BarSeries {
    /// In the legend.
    pub name: String,
    /// One value per category; NaN where there is none.
    pub values: Vec<f64>,
    /// How far the values scatter on both sides (a standard deviation, say), one per category; empty if that is not shown.
    pub spread: Vec<f64>,
    /// `None`: the palette's next.
    pub colour: Option<Colour>,
}

impl BarSeries {
    /// A series in the palette's next colour.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), values, spread: Vec::new(), colour: None }
    }

    /// The same series with whiskers.
    #[must_use]
    pub fn spread(self, spread: Vec<f64>) -> Self {
        Self { spread, ..self }
    }

    /// The same series in this colour.
    #[must_use]
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// Bars from zero, grouped by category.
#[derive(Clone, Debug, PartialEq)]
pub struct BarChart {
    /// What it shows, in a few words.
    pub title: String,
    /// What the bars' lengths are. Linear, as the length of a bar on a logarithmic axis says nothing.
    pub value: Axis,
    /// Names, top to bottom.
    pub categories: Vec<String>,
    /// One bar each in every category, top to bottom.
    pub series: Vec<BarSeries>,
    /// Upright lines at values ([`Mark::X`]).
    pub marks: Vec<Mark>,
    /// Pixels across; the height follows from the bars.
    pub width: f64,
}

impl BarChart {
    /// A chart without bars.
    #[must_use]
    pub fn new(title: impl Into<String>, value: Axis, categories: Vec<String>) -> Self {
        Self { title: title.into(), value, categories, series: Vec::new(), marks: Vec::new(), width: 680.0 }
    }

    /// The same chart with one more series.
    #[must_use]
    pub fn series(mut self, series: BarSeries) -> Self {
        self.series.push(series);
        self
    }

    /// The same chart with an upright line.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// The same chart, `width` pixels across.
    #[must_use]
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// The chart as an `<svg>` element.
    ///
    /// # Errors
    /// [`Error::Empty`] without a value, [`Error::Length`] if a series has not one value per category, [`Error::Value`] for an
    /// infinite value or a logarithmic axis.
    pub fn to_svg(&self) -> Result<String> {
        for series in &self.series {
            for list in [Some(&series.values), Some(&series.spread).filter(|s| !s.is_empty())].into_iter().flatten() {
                if list.len() != self.categories.len() {
                    return Err(Error::Length {
                        title: self.title.clone(),
                        series: series.name.clone(),
                        got: list.len(),
                        expected: self.categories.len(),
                    });
                }
            }
        }
        if self.value.scale == Scale::Log {
            return Err(Error::Value {
                title: self.title.clone(),
                axis: self.value.label.clone(),
                value: 0.0,
                remedy: "bars start at 0; give them a linear axis",
            });
        }
        let reach = |series: &BarSeries, i: usize| {
            let spread = series.spread.get(i).copied().unwrap_or(0.0).abs();
            [series.values[i], series.values[i] + spread, series.values[i] - spread.min(series.values[i].abs())]
        };
        let values = self.series.iter().flat_map(|s| (0..s.values.len()).flat_map(move |i| reach(s, i)));
        let ruler = self.value.clone().from_zero().ruler(&self.title, values)?;

        let names = self.categories.iter().map(|name| text_width(name, SMALL)).fold(0.0, f64::max);
        let left = (names + 16.0).min(0.5 * self.width).ceil();
        // Room for the number behind the longest bar.
        let right = self.width - 58.0;
        let legend = Legend::new(&self.title, self.legend(), 4.0, self.width - 4.0);
        let top = legend.height + 8.0;
        let row = BAR * self.series.len() as f64 + GAP;
        let bottom = top + row * self.categories.len() as f64;
        let height = bottom + 50.0;
        let along = |value: f64| left + ruler.share(value).clamp(0.0, 1.0) * (right - left);
        svg(&self.title, (self.width, height), |canvas| {
            legend.draw(canvas, 4.0)?;
            let middle = 0.5 * (left + right);
            canvas.text(&self.value.label, (middle, height - 20.0), SMALL, Colour::Quiet, (HPos::Center, VPos::Top))?;
            for (share, label) in ruler.ticks() {
                let x = left + share * (right - left);
                canvas.line(&[(x, top), (x, bottom)], stroke(Colour::Grid, 1.1, 1.0))?;
                canvas.text(&label, (x, bottom + 6.0), SMALL, Colour::Ink, (HPos::Center, VPos::Top))?;
            }
            for (c, name) in self.categories.iter().enumerate() {
                let begin = top + row * c as f64 + 0.5 * GAP;
                let centre = begin + 0.5 * BAR * self.series.len() as f64;
                canvas.text(name, (left - 8.0, centre), SMALL, Colour::Ink, (HPos::Right, VPos::Center))?;
                for (s, series) in self.series.iter().enumerate() {
                    let (value, y) = (series.values[c], begin + BAR * s as f64);
                    let centre = y + 0.5 * BAR;
                    if value.is_nan() {
                        canvas.text("–", (left + 5.0, centre), SMALL, Colour::Quiet, (HPos::Left, VPos::Center))?;
                        continue;
                    }
                    let (zero, end) = (along(0.0), along(value));
                    let bar = [(zero, y + 1.0), (end, y + 1.0), (end, y + BAR - 1.0), (zero, y + BAR - 1.0)];
                    canvas.polygon(&bar, fill(self.colour(s), 1.0))?;
                    let [_, high, low] = reach(series, c);
                    if high != low {
                        let pen = stroke(Colour::Ink, 1.2, 1.0);
                        canvas.line(&[(along(low), centre), (along(high), centre)], pen)?;
                        for x in [along(low), along(high)] {
                            canvas.line(&[(x, centre - 3.0), (x, centre + 3.0)], pen)?;
                        }
                    }
                    let behind = along(high).max(zero) + 5.0;
                    let said = number(significant(value));
                    canvas.text(&said, (behind, centre), 12.0, Colour::Quiet, (HPos::Left, VPos::Center))?;
                }
            }
            canvas.line(&[(along(0.0), top), (along(0.0), bottom)], stroke(Colour::Quiet, 1.2, 1.0))?;
            for mark in &self.marks {
                if let Mark::X(value, label) = mark {
                    let x = along(*value);
                    canvas.dashed(&[(x, top), (x, bottom)], stroke(Colour::Ink, 1.2, 1.0), 3.0, 3.0)?;
                    canvas.text(label, (x + 4.0, top - 8.0), 12.0, Colour::Quiet, (HPos::Left, VPos::Center))?;
                }
            }
            Ok(())
        })
    }

    fn colour(&self, index: usize) -> Colour {
        self.series[index].colour.unwrap_or(Colour::Series(index))
    }

    fn legend(&self) -> Vec<Entry> {
        let entry = |(index, series): (usize, &BarSeries)| Entry {
            name: series.name.clone(),
            colour: self.colour(index),
            look: Look::Area(1.0),
        };
        self.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty()).map(entry).collect()
    }
}

/// Three figures: all that can be told from the bar.
fn significant(value: f64) -> f64 {
    if value == 0.0 {
        return value;
    }
    let factor = 10f64.powf(2.0 - value.abs().log10().floor());
    (value * factor).round() / factor
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> BarChart {
        BarChart::new("Times", Axis::linear("ms"), vec!["ssm:1024".into(), "pssm:4:512".into()])
    }

    #[test]
    fn bars_have_names_and_numbers() {
        let svg = chart()
            .series(BarSeries::new("median", vec![1.2345, 0.0]).spread(vec![0.2, 0.0]))
            .series(BarSeries::new("", vec![f64::NAN, 7.0]))
            .to_svg()
            .expect("drawable");
        for text in ["ssm:1024", "pssm:4:512", "1.23", "median", "Times"] {
            assert!(svg.contains(text), "{text} is missing");
        }
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn what_makes_no_bars_is_refused() {
        assert!(matches!(chart().to_svg(), Err(Error::Empty { .. })));
        let short = chart().series(BarSeries::new("a", vec![1.0]));
        assert!(matches!(short.to_svg(), Err(Error::Length { got: 1, expected: 2, .. })));
        let log = BarChart { value: Axis::log("ms"), ..chart().series(BarSeries::new("a", vec![1.0, 2.0])) };
        assert!(matches!(log.to_svg(), Err(Error::Value { .. })));
    }
}
