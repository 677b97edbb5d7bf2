//! Draws the decision of `lib/bias.wesl`: the class of a texel, over its offset and the depth that
//! it stores. `cargo run -p umbrage-shaders --example bias -- docs/images/bias.svg`

use std::fmt::Write as _;

use umbrage_shaders::twin::bias::{Receiver, tolerance};

/// Edge of a panel in pixels; number of cells on each axis.
const EDGE: f32 = 420.0;
const CELLS: u16 = 210;

/// Texels shown to either side of the receiver.
const REACH: f32 = 5.0;

/// Colour and text of each class of texels.
const KEY: [(&str, &str); 5] = [
    ("#dfe9f5", "behind the receiver: does not shade"),
    ("#a9cf9b", "A. same_surface: the receiver's own, does not shade"),
    ("#f6dd8c", "B. another surface: does not shade if it meets the receiver"),
    ("#e9b872", "B. another surface, past the plane: may round off before the receiver"),
    ("#5b5566", "another surface, too steep to be continued: shades"),
];

/// Class of the texel at `offset` texels that stores `stored`.
fn category(at: &Receiver, offset: f32, stored: f32) -> usize {
    let offset = [offset, 0.0];
    // A surface whose next texels are so deep that it arrives behind any receiver: `meets_receiver`
    // is then a question of steepness alone.
    let continued = at.meets_receiver(offset, stored, [stored - 1e6; 2]);
    match () {
        () if at.lies_behind(offset, stored) => 0,
        () if at.same_surface(offset, stored) => 1,
        () if at.is_past(offset, stored) => 3,
        () if continued => 2,
        () => 4,
    }
}

/// Draws one panel: a receiver with this tangent between its normal and the light, in a map of
/// texels of 1 m; `span` metres of depth.
fn panel(svg: &mut String, left: f32, tangent: f32, span: f32, title: &str) {
    let range_m = 1000.0;
    let receiver = Receiver {
        depth: 0.5 - 0.25 / range_m,
        slope: [tangent / range_m, 0.0],
        texel_m: [1.0; 2],
        range_m,
        tolerance: tolerance(tangent, [1.0; 2], range_m),
        ..Receiver::default()
    };
    let cell = EDGE / f32::from(CELLS);
    let offset_at = |column: u16| REACH * (2.0 * (f32::from(column) + 0.5) / f32::from(CELLS) - 1.0);
    let metres_at = |row: u16| span * (2.0 * (f32::from(row) + 0.5) / f32::from(CELLS) - 1.0);
    let mut paths = vec![String::new(); KEY.len()];
    for column in 0..CELLS {
        let kind = |row| category(&receiver, offset_at(column), 0.5 + metres_at(row) / range_m);
        let mut begin = 0;
        for row in 1..=CELLS {
            if row == CELLS || kind(row) != kind(begin) {
                let (x, y, height) = (f32::from(column) * cell, f32::from(begin) * cell, f32::from(row - begin) * cell);
                let _ = write!(paths[kind(begin)], "M{x} {y}h{cell}v{height}h-{cell}z");
                begin = row;
            }
        }
    }
    let _ = writeln!(svg, "<g transform=\"translate({left} 40)\">");
    for ((colour, _), path) in KEY.iter().zip(paths) {
        let _ = writeln!(svg, "<path fill=\"{colour}\" shape-rendering=\"crispEdges\" d=\"{path}\"/>");
    }
    // The receiver's plane, cut at the panel's edges, and the receiver.
    let end = REACH.min(span / tangent);
    let x = |offset: f32| EDGE * (0.5 + 0.5 * offset / REACH);
    let y = |metres: f32| EDGE * (0.5 + 0.5 * metres / span);
    let (from, to) = ([x(-end), y(-end * tangent)], [x(end), y(end * tangent)]);
    let _ = writeln!(
        svg,
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#1d4d1d\" stroke-width=\"2\"/>\
         <circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"#b3261e\"/>\
         <text x=\"{}\" y=\"-14\" text-anchor=\"middle\" font-weight=\"bold\">{title}</text>\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">offset of the texel, −{REACH} to {REACH} texels</text>\
         <text transform=\"translate(-12 {}) rotate(-90)\" text-anchor=\"middle\">\
         stored depth, light at the top, ±{span} texels</text>",
        from[0],
        from[1],
        to[0],
        to[1],
        EDGE / 2.0,
        EDGE / 2.0,
        EDGE / 2.0,
        EDGE / 2.0,
        EDGE + 22.0,
        EDGE / 2.0,
    );
    svg.push_str("</g>\n");
}

fn main() -> std::io::Result<()> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "bias.svg".to_owned());
    let (width, height) = (2.0 * EDGE + 130.0, EDGE + 210.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"14\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    panel(&mut svg, 40.0, 1.0, 8.0, "Light at 45° to the surface");
    panel(&mut svg, EDGE + 100.0, 8.0, 60.0, "Light 7° above the surface");
    for (i, (colour, name)) in KEY.iter().enumerate() {
        let y = EDGE + 84.0 + 22.0 * i as f32;
        let _ = writeln!(
            svg,
            "<rect x=\"40\" y=\"{y}\" width=\"26\" height=\"15\" fill=\"{colour}\" stroke=\"#777\"/>\
             <text x=\"76\" y=\"{}\">{name}</text>",
            y + 13.0
        );
    }
    let y = EDGE + 84.0;
    let x = EDGE + 140.0;
    let _ = writeln!(
        svg,
        "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"#b3261e\"/><text x=\"{x}\" y=\"{}\">the receiver</text>\
         <line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#1d4d1d\" stroke-width=\"2\"/>\
         <text x=\"{x}\" y=\"{}\">its plane</text>\n</svg>",
        x - 20.0,
        y + 8.0,
        y + 13.0,
        x - 30.0,
        y + 30.0,
        x - 8.0,
        y + 30.0,
        y + 35.0,
    );
    std::fs::write(path, svg)
}
