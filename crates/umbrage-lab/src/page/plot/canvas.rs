//! An SVG to draw on, measured in pixels from the upper left corner.

use plotters::{
    coord::Shift,
    drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea},
    element::{Circle, PathElement, Polygon},
    prelude::SVGBackend,
    style::{
        Color, FontStyle, ShapeStyle, TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::{Colour, Error, Result};
use crate::page::escape::escape;

/// The backend's whole-numbered units in a pixel.
pub(super) const UNIT: f64 = 10.0;
/// `plotters` divides every font size by this on its way into an SVG.
const FONT_FACTOR: f64 = 1.24;
const FONT: &str = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
/// Text that is read first.
pub(super) const LARGE: f64 = 15.0;
/// Labels of ticks and legends.
pub(super) const SMALL: f64 = 13.0;

/// What `plotters` says when drawing fails.
pub(super) type Failed = DrawingAreaErrorKind<std::io::Error>;

/// Pixels to the backend's units.
pub(super) fn units(px: f64) -> i32 {
    (px * UNIT).round() as i32
}

/// A stroke of `width` pixels.
pub(super) fn stroke(colour: Colour, width: f64, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: colour.rgb().mix(opacity), filled: false, stroke_width: units(width).unsigned_abs() }
}

/// A filled shape.
pub(super) fn fill(colour: Colour, opacity: f64) -> ShapeStyle {
    ShapeStyle { color: colour.rgb().mix(opacity), filled: true, stroke_width: 0 }
}

/// Roughly how wide a text is, in pixels. Fonts differ, so leave some room.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let em: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | 'I' => 0.32,
            ' ' | 'f' | 't' | 'r' | '(' | ')' | '-' | '/' => 0.40,
            'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.92,
            'A'..='Z' => 0.68,
            _ => 0.60,
        })
        .sum();
    em * size
}

/// What is drawn on.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Where a text hangs on its point.
pub(super) type Hang = (HPos, VPos);

impl<'a> Canvas<'a> {
    /// For `plotters` to lay a chart on: the rectangle between two corners.
    pub fn part(&self, (x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> DrawingArea<SVGBackend<'a>, Shift> {
        let (width, height) = self.area.dim_in_pixel();
        let (right, bottom) = (width as i32 - units(x1), height as i32 - units(y1));
        self.area.margin(units(y0), bottom, units(x0), right)
    }

    pub fn line(&self, points: &[(f64, f64)], style: ShapeStyle) -> Result<(), Failed> {
        self.area.draw(&PathElement::new(in_units(points), style))
    }

    /// `dash` and `gap` in pixels.
    pub fn dashed(&self, points: &[(f64, f64)], style: ShapeStyle, dash: f64, gap: f64) -> Result<(), Failed> {
        dashes(points, dash, gap).iter().try_for_each(|dash| self.line(dash, style))
    }

    pub fn polygon(&self, points: &[(f64, f64)], style: ShapeStyle) -> Result<(), Failed> {
        self.area.draw(&Polygon::new(in_units(points), style))
    }

    pub fn disc(&self, (x, y): (f64, f64), radius: f64, style: ShapeStyle) -> Result<(), Failed> {
        self.area.draw(&Circle::new((units(x), units(y)), units(radius), style))
    }

    pub fn text(&self, text: &str, at: (f64, f64), size: f64, colour: Colour, hang: Hang) -> Result<(), Failed> {
        self.write(text, at, size, colour, hang, FontStyle::Normal)
    }

    pub fn heading(&self, text: &str, at: (f64, f64)) -> Result<(), Failed> {
        self.write(text, at, LARGE, Colour::Ink, (HPos::Left, VPos::Top), FontStyle::Bold)
    }

    fn write(
        &self,
        text: &str,
        (x, y): (f64, f64),
        size: f64,
        colour: Colour,
        (h, v): Hang,
        weight: FontStyle,
    ) -> Result<(), Failed> {
        let paint = colour.rgb();
        let style = TextStyle::from((FONT, size * FONT_FACTOR * UNIT, weight)).color(&paint).pos(Pos::new(h, v));
        self.area.draw_text(text, &style, (units(x), units(y)))
    }
}

fn in_units(points: &[(f64, f64)]) -> Vec<(i32, i32)> {
    points.iter().map(|&(x, y)| (units(x), units(y))).collect()
}

/// Cuts a line into dashes; the pattern runs on across corners.
pub(super) fn dashes(points: &[(f64, f64)], dash: f64, gap: f64) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = Vec::new();
    let mut piece: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, dash);
    for pair in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length);
            if drawing {
                piece.push(at);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![at];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            piece.push((x1, y1));
        }
    }
    if drawing && piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

/// Draws on a canvas of `width` × `height` pixels and returns the `<svg>`. `title` is also what screen readers say.
pub(super) fn svg(
    title: &str,
    (width, height): (f64, f64),
    draw: impl for<'a> FnOnce(&Canvas<'a>) -> Result<(), Failed>,
) -> Result<String> {
    let failed = |error: Failed| Error::Backend { title: title.into(), reason: error.to_string() };
    let mut drawn = String::new();
    {
        let size = (units(width).unsigned_abs(), units(height).unsigned_abs());
        let canvas = Canvas { area: SVGBackend::with_string(&mut drawn, size).into_drawing_area() };
        draw(&canvas).map_err(failed)?;
        canvas.area.present().map_err(failed)?;
    }
    // The backend's own first line says nothing of titles and has no viewBox that differs from the size.
    let (_, body) = drawn
        .split_once(">\n")
        .ok_or_else(|| Error::Backend { title: title.into(), reason: "the drawing has no first line".into() })?;
    let title = escape(title);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" role=\"img\" aria-label=\"{title}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">\n<title>{title}</title>\n{}",
        units(width),
        units(height),
        body.replace(" opacity=\"1\"", ""),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_the_line() {
        let line: Vec<(f64, f64)> = (0..=100).map(|i| (f64::from(i), 0.0)).collect();
        let pieces = dashes(&line, 6.0, 4.0);
        assert_eq!(pieces.len(), 10);
        let drawn: f64 = pieces.iter().map(|p| p[p.len() - 1].0 - p[0].0).sum();
        assert!((drawn - 60.0).abs() < 1e-9, "{drawn}");
    }

    #[test]
    fn an_svg_is_whole_and_escaped() {
        let svg = svg("a < b & \"c\"", (100.0, 50.0), |canvas| {
            canvas.line(&[(0.0, 0.0), (10.0, 5.0)], stroke(Colour::Ink, 1.5, 1.0))?;
            canvas.text("x < y", (1.0, 2.0), SMALL, Colour::Quiet, (HPos::Left, VPos::Top))
        })
        .expect("drawable");
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{svg}");
        assert!(svg.contains("viewBox=\"0 0 1000 500\"") && svg.contains("width=\"100\""), "{svg}");
        assert!(svg.contains("a &lt; b &amp; &quot;c&quot;") && svg.contains("x &lt; y"), "{svg}");
    }
}
