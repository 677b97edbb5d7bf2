//! Charts and diagrams as SVG text, from plain data.
//!
//! [`Chart`] draws lines and points over two axes, linear or logarithmic; [`BarChart`] draws bars;
//! [`Diagram`] draws shapes to scale. What comes out is one `<svg>` element for a page of
//! [`super::html`], complete in itself: it can be read as a file too. Colours are plain attributes
//! in the light palette; [`dark_style`] is the CSS that repaints them for dark pages.
//!
//! `kuva` draws them: axes, ticks, legends and the SVG itself are its own. What is ours is the
//! palette, what is refused, and shapes to scale, which no library of charts has.

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

/// Why a chart could not be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No finite point in any series.
    #[error("chart {title:?} has no finite value to draw; omit the chart, or give it data")]
    Empty {
        /// The chart's title.
        title: String,
    },
    /// A value that its axis cannot show.
    #[error("chart {title:?}, axis {axis:?}: {value} cannot be shown; {remedy}")]
    Value {
        /// The chart's title.
        title: String,
        /// The axis' label.
        axis: String,
        /// The value.
        value: f64,
        /// What to give instead.
        remedy: &'static str,
    },
    /// Lists that should be of one length are not.
    #[error("chart {title:?}, series {series:?}: {got} values for {expected} categories; give one for each")]
    Length {
        /// The chart's title.
        title: String,
        /// The series.
        series: String,
        /// Values given.
        got: usize,
        /// Values expected.
        expected: usize,
    },
    /// The drawing library refused.
    #[error("cannot draw {title:?}: {reason}")]
    Backend {
        /// The chart's title.
        title: String,
        /// What it said.
        reason: String,
    },
}
