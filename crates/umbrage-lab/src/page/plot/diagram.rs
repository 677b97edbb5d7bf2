//! Shapes to scale: maps, sections, wireframes.

use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

use super::{
    Colour, Error, Result,
    axis::nice_step,
    number,
    svg::{HEADING_LEFT, LARGE, SMALL, element},
};

/// Margin around the drawing in pixels.
const EDGE: f64 = 14.0;
/// Height of a row of the legend in pixels.
const ROW: f64 = 21.0;
/// Width in pixels of a legend's sign and the room behind it.
const SWATCH: f64 = 30.0;
/// Distance in pixels between two entries of a legend.
const GAP: f64 = 20.0;

/// Style of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour of the line.
    pub colour: Colour,
    /// Width in pixels.
    pub width: f64,
    /// True if the line is dashed.
    pub dashed: bool,
}

impl Stroke {
    /// Makes a solid line.
    #[must_use]
    pub fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }

    /// Makes a dashed line.
    #[must_use]
    pub fn dashed(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashed: true }
    }
}

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the sides")]
pub enum Anchor {
    Left,
    Right,
    Above,
    Below,
    Centre,
}

/// A shape; positions are in the diagram's own unit, y up.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A closed outline.
    Polygon {
        /// Corners in order.
        corners: Vec<(f64, f64)>,
        /// Colour and opacity of the inside.
        fill: Option<(Colour, f64)>,
        /// Style of the outline.
        outline: Option<Stroke>,
    },
    /// An open line.
    Line {
        /// Corners in order.
        points: Vec<(f64, f64)>,
        /// Style of the line.
        stroke: Stroke,
        /// True if the line ends in an arrowhead.
        arrow: bool,
    },
    /// A text.
    Text {
        /// Point beside which the text is written.
        at: (f64, f64),
        /// Content of the text.
        text: String,
        /// Colour of the text.
        colour: Colour,
        /// Position of the text relative to its point.
        anchor: Anchor,
    },
}

/// A drawing to scale: one unit has the same length in every direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// Description in a few words.
    pub title: String,
    /// Shapes, drawn in this order.
    pub shapes: Vec<Shape>,
    /// Entries of the legend: a name, a colour, and the opacity of a filled sign; `None` is a
    /// dashed line.
    pub legend: Vec<(String, Colour, Option<f64>)>,
    /// Unit of lengths for the scale bar; `None` draws no bar.
    pub unit: Option<String>,
    /// Width in pixels.
    pub width: f64,
    /// Visible part as two corners, at which shapes are cut; `None` shows everything.
    pub frame: Option<((f64, f64), (f64, f64))>,
}

impl Diagram {
    /// Makes an empty diagram.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), shapes: Vec::new(), legend: Vec::new(), unit: None, width: 680.0, frame: None }
    }

    /// Draws the diagram as an `<svg>` element.
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
        let scale = (self.width - 2.0 * EDGE) / (x1 - x0);
        let legend = self.legend_places();
        let top = legend.last().map_or(f64::from(LARGE) + 14.0, |(_, y)| y + ROW) + EDGE;
        let bottom = top + scale * (y1 - y0);
        let place = |&(x, y): &(f64, f64)| (EDGE + (x - x0) * scale, bottom - (y - y0) * scale);
        let mut scene = Scene::new(self.width, bottom + if self.unit.is_some() { 34.0 } else { EDGE });
        let heading = (HEADING_LEFT, 4.0 + f64::from(LARGE));
        scene.add(text(&self.title, heading, TextAnchor::Start, Colour::Ink, LARGE));
        self.draw_legend(&mut scene, &legend);
        let (width, height) = (self.width - 2.0 * EDGE, bottom - top);
        scene.add(Primitive::ClipStart { x: EDGE, y: top, width, height, id: String::new() });
        self.shapes.iter().for_each(|shape| draw(&mut scene, shape, &place));
        scene.add(Primitive::ClipEnd);
        self.shapes.iter().for_each(|shape| write(&mut scene, shape, &place));
        if let Some(unit) = &self.unit {
            let length = nice_step(0.16 * (x1 - x0));
            let (from, y) = (EDGE, bottom + 20.0);
            let to = from + length * scale;
            let pen = Stroke::new(Colour::Quiet, 1.4);
            for ends in [[(from, y), (to, y)], [(from, y - 4.0), (from, y + 4.0)], [(to, y - 4.0), (to, y + 4.0)]] {
                scene.add(line(ends.to_vec(), pen));
            }
            let said = format!("{} {unit}", number(length));
            scene.add(text(&said, (to + 8.0, y + 0.35 * f64::from(SMALL)), TextAnchor::Start, Colour::Quiet, SMALL));
        }
        element(&self.title, scene)
    }

    /// Returns the positions of the entries of the legend: in rows, from left to right.
    fn legend_places(&self) -> Vec<(f64, f64)> {
        let (mut x, mut y) = (4.0, f64::from(LARGE) + 14.0);
        let place = |(name, _, _): &(String, Colour, Option<f64>)| {
            let width = SWATCH + text_width(name);
            if x > 4.0 && x + width > self.width - 4.0 {
                (x, y) = (4.0, y + ROW);
            }
            let at = (x, y);
            x += width + GAP;
            at
        };
        self.legend.iter().map(place).collect()
    }

    fn draw_legend(&self, scene: &mut Scene, places: &[(f64, f64)]) {
        for ((name, colour, area), (x, y)) in self.legend.iter().zip(places) {
            let middle = y + 0.5 * ROW;
            match area {
                None => scene.add(line(vec![(*x, middle), (x + 24.0, middle)], Stroke::dashed(*colour, 1.6))),
                Some(opacity) => {
                    let (x0, x1, y0, y1) = (x + 5.0, x + 19.0, middle - 6.5, middle + 6.5);
                    let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
                    let outline = (*opacity < 1.0).then_some(Stroke::new(*colour, 1.2));
                    area_of(scene, &corners, Some((*colour, *opacity)), outline);
                }
            }
            let at = (x + SWATCH, middle + 0.35 * f64::from(SMALL));
            scene.add(text(name, at, TextAnchor::Start, Colour::Ink, SMALL));
        }
    }
}

/// Draws a shape, clipped to the frame.
fn draw(scene: &mut Scene, shape: &Shape, place: &impl Fn(&(f64, f64)) -> (f64, f64)) {
    match shape {
        Shape::Polygon { corners, fill, outline } => {
            let corners: Vec<(f64, f64)> = corners.iter().map(place).collect();
            area_of(scene, &corners, *fill, *outline);
        }
        Shape::Line { points, stroke, arrow } => {
            let points: Vec<(f64, f64)> = points.iter().map(place).collect();
            if let ([.., from, to], true) = (&points[..], *arrow) {
                head(scene, *from, *to, *stroke);
            }
            scene.add(line(points, *stroke));
        }
        Shape::Text { .. } => {}
    }
}

/// Writes the text of a shape, which may extend over the frame's edge.
fn write(scene: &mut Scene, shape: &Shape, place: &impl Fn(&(f64, f64)) -> (f64, f64)) {
    if let Shape::Text { at, text: said, colour, anchor } = shape {
        let (x, y) = place(at);
        let (height, middle) = (f64::from(SMALL), 0.35 * f64::from(SMALL));
        let (at, hang) = match anchor {
            Anchor::Left => ((x - 5.0, y + middle), TextAnchor::End),
            Anchor::Right => ((x + 5.0, y + middle), TextAnchor::Start),
            Anchor::Above => ((x, y - 6.0), TextAnchor::Middle),
            Anchor::Below => ((x, y + 4.0 + height), TextAnchor::Middle),
            Anchor::Centre => ((x, y + middle), TextAnchor::Middle),
        };
        scene.add(text(said, at, hang, *colour, SMALL));
    }
}

fn text(said: &str, (x, y): (f64, f64), anchor: TextAnchor, colour: Colour, size: u32) -> Primitive {
    let color = Some(colour.hex().into());
    Primitive::Text { x, y, content: said.to_owned(), size, anchor, rotate: None, bold: size == LARGE, color }
}

fn line(points: Vec<(f64, f64)>, pen: Stroke) -> Primitive {
    Primitive::PolyLine {
        points,
        stroke: pen.colour.hex().into(),
        stroke_width: pen.width,
        stroke_dasharray: pen.dashed.then(|| "6 4".to_owned()),
    }
}

/// Draws a filled area and its outline, each with an opacity of its own.
fn area_of(scene: &mut Scene, corners: &[(f64, f64)], fill: Option<(Colour, f64)>, outline: Option<Stroke>) {
    let mut path: String = corners
        .iter()
        .enumerate()
        .map(|(i, (x, y))| format!("{}{x:.2} {y:.2}", if i == 0 { "M" } else { "L" }))
        .collect();
    path.push('Z');
    let shape = |fill: Option<Colour>, stroke: Option<Stroke>, opacity| {
        Primitive::Path(Box::new(PathData {
            d: path.clone(),
            fill: Some(fill.map_or("none".into(), |colour| colour.hex().into())),
            stroke: stroke.map_or("none".into(), |pen| pen.colour.hex().into()),
            stroke_width: stroke.map_or(0.0, |pen| pen.width),
            opacity,
            stroke_dasharray: stroke.and_then(|pen| pen.dashed.then(|| "6 4".to_owned())),
        }))
    };
    if let Some((colour, opacity)) = fill {
        scene.add(shape(Some(colour), None, Some(opacity)));
    }
    if outline.is_some() {
        scene.add(shape(None, outline, None));
    }
}

/// Draws the head of an arrow.
fn head(scene: &mut Scene, from: (f64, f64), to: (f64, f64), pen: Stroke) {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    if length == 0.0 {
        return;
    }
    let (x, y) = ((to.0 - from.0) / length, (to.1 - from.1) / length);
    let (long, half) = (4.0 + 3.0 * pen.width, 2.0 + 1.4 * pen.width);
    let foot = (to.0 - long * x, to.1 - long * y);
    let tip = (to.0 + 0.5 * pen.width * x, to.1 + 0.5 * pen.width * y);
    let corners = [tip, (foot.0 - half * y, foot.1 + half * x), (foot.0 + half * y, foot.1 - half * x)];
    area_of(scene, &corners, Some((pen.colour, 1.0)), None);
}

/// Estimates the width of a small text in pixels; fonts differ.
fn text_width(text: &str) -> f64 {
    0.56 * f64::from(SMALL) * text.chars().count() as f64
}

/// Returns the corners of the convex hull of `points`, counter-clockwise (Andrew's monotone chain).
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
        // 200 pixels across, 100 down.
        assert!(svg.contains("M14.00 143.00L214.00 143.00L214.00 43.00L14.00 43.00Z"), "{svg}");
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
