//! Shapes to scale: maps, sections, wireframes.

use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Canvas, Failed, SMALL, fill, stroke, svg};
use super::legend::{Entry, Legend, Look};
use super::scale::nice_step;
use super::{Colour, Error, Result, Style, clip, number};

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Pixels across.
    pub width: f64,
    /// In dashes.
    pub dashed: bool,
}

impl Stroke {
    /// A solid line.
    #[must_use]
    pub fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }

    /// A dashed line.
    #[must_use]
    pub fn dashed(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashed: true }
    }
}

/// Which side of its point a text stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the sides")]
pub enum Anchor {
    Left,
    Right,
    Above,
    Below,
    Centre,
}

/// What is drawn; positions in the diagram's own unit, y up.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A closed outline.
    Polygon {
        /// Its corners in order.
        corners: Vec<(f64, f64)>,
        /// Colour and opacity inside.
        fill: Option<(Colour, f64)>,
        /// Its outline.
        outline: Option<Stroke>,
    },
    /// An open line.
    Line {
        /// Its corners in order.
        points: Vec<(f64, f64)>,
        /// How it is drawn.
        stroke: Stroke,
        /// Whether its end has a head.
        arrow: bool,
    },
    /// A word.
    Text {
        /// Its point.
        at: (f64, f64),
        /// What it says.
        text: String,
        /// Its colour.
        colour: Colour,
        /// Where it stands about its point.
        anchor: Anchor,
    },
}

/// A drawing in which one unit is as long in every direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// What it shows, in a few words.
    pub title: String,
    /// Drawn in this order.
    pub shapes: Vec<Shape>,
    /// Names of colours; dashed lines, or filled with the opacity given.
    pub legend: Vec<(String, Colour, Option<f64>)>,
    /// The unit of lengths, for the scale bar; `None`: no bar.
    pub unit: Option<String>,
    /// Pixels across.
    pub width: f64,
    /// What is shown, as two corners, and where shapes are cut; `None`: everything.
    pub frame: Option<((f64, f64), (f64, f64))>,
}

impl Diagram {
    /// An empty diagram.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), shapes: Vec::new(), legend: Vec::new(), unit: None, width: 680.0, frame: None }
    }

    /// The diagram as an `<svg>` element.
    ///
    /// # Errors
    /// [`Error::Empty`] without a shape, [`Error::Value`] where a corner is not finite.
    pub fn to_svg(&self) -> Result<String> {
        let points = self.shapes.iter().flat_map(|shape| match shape {
            Shape::Polygon { corners: points, .. } | Shape::Line { points, .. } => points.as_slice(),
            Shape::Text { at, .. } => std::slice::from_ref(at),
        });
        let ((mut x0, mut y0), (mut x1, mut y1)) =
            ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for &(x, y) in points {
            if let Some(value) = [x, y].into_iter().find(|v| !v.is_finite()) {
                return Err(Error::Value {
                    title: self.title.clone(),
                    axis: "position".into(),
                    value,
                    remedy: "give finite positions",
                });
            }
            (x0, y0, x1, y1) = (x0.min(x), y0.min(y), x1.max(x), y1.max(y));
        }
        if let Some((lo, hi)) = self.frame {
            ((x0, y0), (x1, y1)) = (lo, hi);
        }
        // A frame without area (or turned over) shows nothing.
        if !(x1 > x0 && y1 > y0) {
            return Err(Error::Empty { title: self.title.clone() });
        }
        let edge = 14.0;
        let scale = (self.width - 2.0 * edge) / (x1 - x0);
        let entries = self.legend.iter().map(|(name, colour, area)| Entry {
            name: name.clone(),
            colour: *colour,
            look: area.map_or(Look::Line(Style::Dashed, 0), Look::Area),
        });
        let legend = Legend::new(&self.title, entries.collect(), 4.0, self.width - 4.0);
        let top = legend.height + edge;
        let bottom = top + scale * (y1 - y0);
        let bar = if self.unit.is_some() { 34.0 } else { edge };
        // Shares of the frame, in which shapes are cut, and pixels.
        let share = |&(x, y): &(f64, f64)| ((x - x0) / (x1 - x0), (y - y0) / (y1 - y0));
        let place = |(u, v): (f64, f64)| (edge + u * (x1 - x0) * scale, bottom - v * (y1 - y0) * scale);
        svg(&self.title, (self.width, bottom + bar), |canvas| {
            legend.draw(canvas, 4.0)?;
            for shape in &self.shapes {
                draw(canvas, shape, &share, &place)?;
            }
            if let Some(unit) = &self.unit {
                let length = nice_step(0.16 * (x1 - x0));
                let (from, y) = (edge, bottom + 20.0);
                let to = from + length * scale;
                let pen = stroke(Colour::Quiet, 1.4, 1.0);
                canvas.line(&[(from, y), (to, y)], pen)?;
                for x in [from, to] {
                    canvas.line(&[(x, y - 4.0), (x, y + 4.0)], pen)?;
                }
                let said = format!("{} {unit}", number(length));
                canvas.text(&said, (to + 8.0, y), SMALL, Colour::Quiet, (HPos::Left, VPos::Center))?;
            }
            Ok(())
        })
    }
}

fn draw(
    canvas: &Canvas<'_>,
    shape: &Shape,
    share: &impl Fn(&(f64, f64)) -> (f64, f64),
    place: &impl Fn((f64, f64)) -> (f64, f64),
) -> Result<(), Failed> {
    let shares = |points: &[(f64, f64)]| -> Vec<(f64, f64)> { points.iter().map(share).collect() };
    let placed = |shares: Vec<(f64, f64)>| -> Vec<(f64, f64)> { shares.into_iter().map(place).collect() };
    let cut = |points: &[(f64, f64)], pen: Stroke| {
        clip::line(points).into_iter().try_for_each(|piece| line(canvas, &placed(piece), pen))
    };
    match shape {
        Shape::Polygon { corners, fill: inside, outline } => {
            let mut ring = shares(corners);
            if let Some((colour, opacity)) = inside {
                let inside = clip::polygon(&ring);
                if !inside.is_empty() {
                    canvas.polygon(&placed(inside), fill(*colour, *opacity))?;
                }
            }
            ring.extend(ring.first().copied());
            outline.map_or(Ok(()), |pen| cut(&ring, pen))
        }
        Shape::Line { points, stroke: pen, arrow } => {
            let path = shares(points);
            cut(&path, *pen)?;
            match placed(path)[..] {
                [.., from, to] if *arrow => head(canvas, from, to, *pen),
                _ => Ok(()),
            }
        }
        Shape::Text { at, text, colour, anchor } => {
            let (x, y) = place(share(at));
            let (at, hang) = match anchor {
                Anchor::Left => ((x - 5.0, y), (HPos::Right, VPos::Center)),
                Anchor::Right => ((x + 5.0, y), (HPos::Left, VPos::Center)),
                Anchor::Above => ((x, y - 4.0), (HPos::Center, VPos::Bottom)),
                Anchor::Below => ((x, y + 4.0), (HPos::Center, VPos::Top)),
                Anchor::Centre => ((x, y), (HPos::Center, VPos::Center)),
            };
            canvas.text(text, at, SMALL, *colour, hang)
        }
    }
}

fn line(canvas: &Canvas<'_>, points: &[(f64, f64)], pen: Stroke) -> Result<(), Failed> {
    let style = stroke(pen.colour, pen.width, 1.0);
    if pen.dashed { canvas.dashed(points, style, 6.0, 4.0) } else { canvas.line(points, style) }
}

fn head(canvas: &Canvas<'_>, from: (f64, f64), to: (f64, f64), pen: Stroke) -> Result<(), Failed> {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    if length == 0.0 {
        return Ok(());
    }
    let (x, y) = ((to.0 - from.0) / length, (to.1 - from.1) / length);
    let (long, half) = (4.0 + 3.0 * pen.width, 2.0 + 1.4 * pen.width);
    let foot = (to.0 - long * x, to.1 - long * y);
    let tip = (to.0 + 0.5 * pen.width * x, to.1 + 0.5 * pen.width * y);
    canvas.polygon(
        &[tip, (foot.0 - half * y, foot.1 + half * x), (foot.0 + half * y, foot.1 - half * x)],
        fill(pen.colour, 1.0),
    )
}

/// The corners of the smallest convex outline around `points`, counter-clockwise (Andrew's monotone chain).
#[must_use]
pub fn convex_hull(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let turn = |o: (f64, f64), a: (f64, f64), b: (f64, f64)| (a.0 - o.0) * (b.1 - o.1) - (a.1 - o.1) * (b.0 - o.0);
    let chain = |points: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut chain: Vec<(f64, f64)> = Vec::new();
        for point in points {
            while let [.., o, a] = chain[..] {
                if turn(o, a, point) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_keeps_the_corners_alone() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let mut points = square.to_vec();
        points.extend([(0.5, 0.5), (0.5, 0.0), (0.0, 0.0), (0.25, 0.75)]);
        assert_eq!(convex_hull(&points), square);
        assert_eq!(convex_hull(&[(1.0, 2.0), (1.0, 2.0)]), [(1.0, 2.0)]);
    }

    #[test]
    fn lengths_are_equal_in_both_directions() {
        let mut diagram = Diagram::new("d");
        diagram.width = 228.0;
        let corners = vec![(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (0.0, 5.0)];
        diagram.shapes.push(Shape::Polygon { corners, fill: Some((Colour::Split(0), 0.5)), outline: None });
        let svg = diagram.to_svg().expect("drawable");
        // 200 pixels across, 100 down, in tenths.
        assert!(svg.contains("points=\"140,1430 2140,1430 2140,430 140,430"), "{svg}");
    }

    #[test]
    fn a_diagram_without_extent_is_an_error() {
        assert!(matches!(Diagram::new("d").to_svg(), Err(Error::Empty { .. })));
        let mut bad = Diagram::new("d");
        bad.shapes.push(Shape::Text {
            at: (f64::NAN, 0.0),
            text: String::new(),
            colour: Colour::Ink,
            anchor: Anchor::Left,
        });
        assert!(matches!(bad.to_svg(), Err(Error::Value { .. })));
    }
}
