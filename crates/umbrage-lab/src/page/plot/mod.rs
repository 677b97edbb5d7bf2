//! Charts and diagrams as SVG text, from plain data.
//!
//! [`Chart`] draws lines and points over two axes, linear or logarithmic; [`BarChart`] draws bars;
//! [`Diagram`] draws shapes to scale. The output is one `<svg>` element for a page of
//! [`super::html`]. It is complete, so it can be a file too. Colours are plain attributes in the
//! light palette; [`dark_style`] is the CSS that repaints them for dark pages.
//!
//! `kuva` draws axes, ticks, legends and the SVG itself. The palette, the checks of data and the
//! shapes to scale, which no library of charts has, are ours.

mod axis;
mod bars;
mod chart;
mod colour;
mod diagram;
mod svg;

pub use axis::{Axis, Scale, number};
pub use bars::{BarChart, BarSeries};
pub use chart::{Chart, Mark, Series, Style};
pub use colour::{Colour, dark_style};
pub use diagram::{Anchor, Diagram, Shape, Stroke, convex_hull};

/// [`std::result::Result`] with this module's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why a chart could not be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No series has a finite point.
    #[error("chart {title:?} has no finite value to draw; omit the chart, or give it data")]
    Empty {
        /// Title of the chart.
        title: String,
    },
    /// The axis cannot show a value.
    #[error("chart {title:?}, axis {axis:?}: {value} cannot be shown; {remedy}")]
    Value {
        /// Title of the chart.
        title: String,
        /// Label of the axis.
        axis: String,
        /// Value at fault.
        value: f64,
        /// Remedy: what to give instead.
        remedy: &'static str,
    },
    /// Lists that should have one length differ.
    #[error("chart {title:?}, series {series:?}: {got} values for {expected} categories; give one for each")]
    Length {
        /// Title of the chart.
        title: String,
        /// Name of the series.
        series: String,
        /// Number of values given.
        got: usize,
        /// Number of values expected.
        expected: usize,
    },
    /// The drawing library failed.
    #[error("cannot draw {title:?}: {reason}")]
    Backend {
        /// Title of the chart.
        title: String,
        /// Message of the library.
        reason: String,
    },
}
