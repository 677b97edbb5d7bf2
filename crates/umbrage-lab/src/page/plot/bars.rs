//! Horizontal bars, so that there is room for long names beside them.

use kuva::{
    plot::{
        BarPlot,
        annotations::ReferenceLine,
        legend::{LegendEntry, LegendShape},
    },
    render::{
        layout::ComputedLayout,
        plots::Plot,
        render::{Primitive, Scene, TextAnchor},
    },
};

use super::{
    Axis, Colour, Error, Mark, Result, Scale, number,
    svg::{MARK_DASHES, element, layout, mark_entry, render, with_legend, with_plot_height, with_x},
};

/// Width of one bar in pixels.
const BAR: f64 = 15.0;
/// Share of a category that its bars take.
const SHARE: f64 = 0.8;
/// Size in pixels of the numbers behind the bars.
const FIGURES: u32 = 12;

/// A series with one bar per category.
#[derive(Clone, Debug, PartialEq)]
pub struct BarSeries {
    /// Name in the legend.
    pub name: String,
    /// Value of each category; NaN where there is none.
    pub values: Vec<f64>,
    /// Spread of each category's values on both sides, such as a standard deviation; empty to show
    /// none.
    pub spread: Vec<f64>,
    /// Colour; `None` is the palette's next.
    pub colour: Option<Colour>,
}

impl BarSeries {
    /// Makes a series in the palette's next colour.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), values, spread: Vec::new(), colour: None }
    }

    /// Adds whiskers: one spread for each category.
    #[must_use]
    pub fn spread(self, spread: Vec<f64>) -> Self {
        Self { spread, ..self }
    }

    /// Sets the colour.
    #[must_use]
    pub fn colour(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// Bars from zero, grouped by category.
#[derive(Clone, Debug, PartialEq)]
pub struct BarChart {
    /// Description in a few words.
    pub title: String,
    /// Axis of the bars' lengths. It is linear, because the length of a bar on a logarithmic axis
    /// has no meaning.
    pub value: Axis,
    /// Names of the categories, top to bottom.
    pub categories: Vec<String>,
    /// Series of bars in every category, top to bottom.
    pub series: Vec<BarSeries>,
    /// Vertical lines at values ([`Mark::X`]).
    pub marks: Vec<Mark>,
    /// Width in pixels; the height follows from the bars.
    pub width: f64,
}

impl BarChart {
    /// Makes a chart without bars.
    #[must_use]
    pub fn new(title: impl Into<String>, value: Axis, categories: Vec<String>) -> Self {
        Self { title: title.into(), value, categories, series: Vec::new(), marks: Vec::new(), width: 680.0 }
    }

    /// Adds a series.
    #[must_use]
    pub fn series(mut self, series: BarSeries) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a vertical line ([`Mark::X`]).
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    /// Sets the width in pixels.
    #[must_use]
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// Draws the chart as an `<svg>` element.
    ///
    /// # Errors
    /// [`Error::Empty`] without a value, [`Error::Length`] if a series does not have one value per
    /// category, [`Error::Value`] for an infinite value or a logarithmic axis.
    pub fn to_svg(&self) -> Result<String> {
        self.check()?;
        let mut bars = BarPlot::new().with_horizontal(true).with_width(SHARE);
        let (mut errors, mut numbers) = (Vec::new(), Vec::new());
        // The lowest category and series come first.
        for (c, name) in self.categories.iter().enumerate().rev() {
            let of_category = self.series.iter().enumerate().rev().map(|(s, series)| {
                let value = series.values[c];
                errors.push(series.spread.get(c).copied().filter(|spread| spread.is_finite()).unwrap_or(0.0).abs());
                numbers.push(if value.is_nan() { "–".into() } else { number(significant(value)) });
                (if value.is_nan() { 0.0 } else { value }, self.colour(s).hex())
            });
            bars = bars.with_group(name.as_str(), of_category.collect::<Vec<_>>());
        }
        let longest = self.values().fold(0.0, f64::max);
        let whiskers = errors.iter().any(|error| *error > 0.0);
        let bars = if whiskers { bars.with_error(errors.clone()).with_error_color(Colour::Ink.hex()) } else { bars };
        let plots: Vec<Plot> = vec![bars.into()];
        let mut layout = layout(&plots, &self.title, self.width);
        layout = with_x(layout, &self.value, 0.0);
        if self.value.range.is_none() {
            // Room for the number behind the longest bar.
            layout = layout.with_x_axis_max(1.12 * longest.max(f64::MIN_POSITIVE));
        }
        let mut legend = self.legend();
        for mark in &self.marks {
            if let Mark::X(value, label) = mark {
                let line = ReferenceLine::vertical(*value).with_color(Colour::Ink.hex()).with_dasharray(MARK_DASHES);
                layout = layout.with_reference_line(line);
                legend.push(mark_entry(label, Colour::Ink));
            }
        }
        layout = with_legend(layout, legend);
        let rows = (self.series.len() * self.categories.len()) as f64;
        let layout = with_plot_height(layout, BAR * rows / SHARE);
        let computed = ComputedLayout::from_layout(&layout);
        let mut scene = render(plots, layout);
        write_numbers(&mut scene, &computed, &numbers, whiskers.then_some(&errors));
        element(&self.title, scene)
    }

    fn check(&self) -> Result<()> {
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
        if self.value.check(&self.title, self.values())? {
            Ok(())
        } else {
            Err(Error::Empty { title: self.title.clone() })
        }
    }

    /// Iterates over all values and the ends of their whiskers.
    fn values(&self) -> impl Iterator<Item = f64> {
        self.series.iter().flat_map(|series| {
            let spread = series.spread.iter().copied().map(f64::abs).chain(std::iter::repeat(0.0));
            series.values.iter().zip(spread).map(|(value, spread)| value + if spread.is_nan() { 0.0 } else { spread })
        })
    }

    fn colour(&self, index: usize) -> Colour {
        self.series[index].colour.unwrap_or(Colour::Series(index))
    }

    fn legend(&self) -> Vec<LegendEntry> {
        let named = self.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty());
        let entry = |(index, series): (usize, &BarSeries)| LegendEntry {
            label: series.name.clone(),
            color: self.colour(index).hex(),
            shape: LegendShape::Rect,
            dasharray: None,
        };
        named.map(entry).collect()
    }
}

/// Writes each bar's number behind the bar and its whisker. The library draws bars without numbers;
/// they are found by their beginnings.
fn write_numbers(scene: &mut Scene, computed: &ComputedLayout, numbers: &[String], errors: Option<&Vec<f64>>) {
    let zero = computed.map_x(0.0);
    let bottom = computed.height - computed.margin_bottom;
    let is_bar = |x: f64, y: f64| (x - zero).abs() < 0.5 && y > computed.margin_top - 0.5 && y < bottom;
    let bars: Vec<(f64, f64)> = scene
        .elements
        .iter()
        .filter_map(|element| match element {
            Primitive::Rect { x, y, width, height, .. } if is_bar(*x, *y) => Some((x + width, y + 0.5 * height)),
            _ => None,
        })
        .collect();
    if bars.len() != numbers.len() {
        return;
    }
    for (i, ((end, middle), text)) in bars.into_iter().zip(numbers).enumerate() {
        let whisker = errors.map_or(0.0, |errors| computed.map_x(errors[i]) - zero);
        scene.add(Primitive::Text {
            x: end + whisker + 5.0,
            y: middle + 0.35 * f64::from(FIGURES),
            content: text.clone(),
            size: FIGURES,
            anchor: TextAnchor::Start,
            rotate: None,
            bold: false,
            color: Some(Colour::Quiet.hex().into()),
        });
    }
}

/// Rounds to three figures, as many as can be read from the bar.
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
