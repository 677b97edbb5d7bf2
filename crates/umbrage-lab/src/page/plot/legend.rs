//! Titles and legends: what stands above a chart.

use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Canvas, Failed, LARGE, SMALL, fill, stroke, text_width};
use super::chart::{Style, marker};
use super::{Colour, Result};

const ROW: f64 = 21.0;
const SWATCH: f64 = 24.0;
const GAP: f64 = 20.0;

/// A name and how it looks.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub name: String,
    pub colour: Colour,
    pub look: Look,
}

/// How an entry's sign looks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Look {
    /// A piece of a line, with a point of shape `.1`.
    Line(Style, usize),
    /// A filled square of this opacity.
    Area(f64),
}

/// Entries in rows, left to right.
pub(super) struct Legend {
    placed: Vec<(f64, f64, Entry)>,
    title: String,
    /// Pixels that title and legend take.
    pub height: f64,
}

impl Legend {
    pub fn new(title: &str, entries: Vec<Entry>, left: f64, right: f64) -> Self {
        let mut top = if title.is_empty() { 4.0 } else { LARGE + 14.0 };
        let mut x = left;
        let mut placed = Vec::new();
        let empty = entries.is_empty();
        for entry in entries {
            let width = SWATCH + 6.0 + text_width(&entry.name, SMALL);
            if x > left && x + width > right {
                (x, top) = (left, top + ROW);
            }
            placed.push((x, top, entry));
            x += width + GAP;
        }
        Self { placed, title: title.into(), height: if empty { top } else { top + ROW + 4.0 } }
    }

    pub fn draw(&self, canvas: &Canvas<'_>, left: f64) -> Result<(), Failed> {
        if !self.title.is_empty() {
            canvas.heading(&self.title, (left, 4.0))?;
        }
        for (x, y, entry) in &self.placed {
            let middle = y + 0.5 * ROW;
            match entry.look {
                Look::Line(style, shape) => {
                    let ends = [(*x, middle), (x + SWATCH, middle)];
                    let pen = stroke(entry.colour, style.width(), 1.0);
                    match style.line() {
                        super::chart::Line::None => {}
                        super::chart::Line::Solid => canvas.line(&ends, pen)?,
                        super::chart::Line::Dashed => canvas.dashed(&ends, pen, 5.0, 4.0)?,
                    }
                    if style.has_points() {
                        marker(canvas, (x + 0.5 * SWATCH, middle), shape, entry.colour)?;
                    }
                }
                Look::Area(opacity) => {
                    let (x0, x1, y0, y1) = (x + 5.0, x + 19.0, middle - 6.5, middle + 6.5);
                    let square = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
                    canvas.polygon(&square, fill(entry.colour, opacity))?;
                    if opacity < 1.0 {
                        let outline = [square[0], square[1], square[2], square[3], square[0]];
                        canvas.line(&outline, stroke(entry.colour, 1.2, 1.0))?;
                    }
                }
            }
            canvas.text(&entry.name, (x + SWATCH + 6.0, middle), SMALL, Colour::Ink, (HPos::Left, VPos::Center))?;
        }
        Ok(())
    }
}
