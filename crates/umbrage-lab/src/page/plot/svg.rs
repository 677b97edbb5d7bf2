//! The theme of all drawings, and the `<svg>` element around them.

use kuva::{
    Theme,
    backend::svg::SvgBackend,
    plot::legend::{LegendEntry, LegendPosition, LegendShape},
    render::{
        layout::{ComputedLayout, Layout, TickFormat},
        plots::Plot,
        render::{Primitive, Scene, TextAnchor, render_multiple},
    },
};
use maud::{PreEscaped, html};
use std::sync::Arc;

use super::{Axis, Colour, Error, Result, Scale, number};

/// Fonts of all text, the reader's own first.
const FONT: &str = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
/// Left edge of titles in pixels.
pub(super) const HEADING_LEFT: f64 = 4.0;
/// Margin in pixels on the right of a chart, for half of the last tick's label.
const RIGHT: f64 = 16.0;
/// Dash pattern of lines across a chart.
pub(super) const MARK_DASHES: &str = "3 3";
/// Size of a title in pixels.
pub(super) const LARGE: u32 = 15;
/// Size of labels, legends and ticks in pixels.
pub(super) const SMALL: u32 = 13;

/// Makes a layout in the page's colours. The caller adds axes and sizes.
pub(super) fn layout(plots: &[Plot], title: &str, width: f64) -> Layout {
    let theme = Theme {
        background: "none".into(),
        axis_color: Colour::Quiet.hex(),
        grid_color: Colour::Grid.hex(),
        tick_color: Colour::Quiet.hex(),
        text_color: Colour::Ink.hex(),
        legend_bg: "none".into(),
        legend_border: Colour::Grid.hex(),
        ..Theme::light()
    };
    Layout::auto_from_plots(plots)
        .with_theme(theme)
        .with_title(title)
        .with_width(width - RIGHT)
        .with_title_size(LARGE)
        .with_label_size(SMALL)
        .with_body_size(SMALL)
        .with_tick_size(SMALL)
        .with_legend_box(false)
        .with_tick_format(TickFormat::Custom(Arc::new(number)))
}

/// Adds the horizontal axis to a layout.
pub(super) fn with_x(layout: Layout, axis: &Axis, lowest: f64) -> Layout {
    let layout = if axis.scale == Scale::Log { layout.with_log_x() } else { layout };
    let layout = match axis.range {
        Some((from, to)) => layout.with_x_axis_min(from).with_x_axis_max(to),
        None if axis.from_zero && lowest >= 0.0 => layout.with_x_axis_min(0.0),
        None => layout,
    };
    layout.with_x_label(axis.label.as_str())
}

/// Adds the vertical axis to a layout.
pub(super) fn with_y(layout: Layout, axis: &Axis, lowest: f64) -> Layout {
    let layout = if axis.scale == Scale::Log { layout.with_log_y() } else { layout };
    let layout = match axis.range {
        Some((from, to)) => layout.with_y_axis_min(from).with_y_axis_max(to),
        None if axis.from_zero && lowest >= 0.0 => layout.with_y_axis_min(0.0),
        None => layout,
    };
    layout.with_y_label(axis.label.as_str())
}

/// Adds a legend below the plot, if there are entries.
pub(super) fn with_legend(layout: Layout, entries: Vec<LegendEntry>) -> Layout {
    if entries.is_empty() {
        return layout;
    }
    layout.with_legend_entries(entries).with_legend_position(LegendPosition::OutsideBottomColumns)
}

/// Makes the legend's entry of a line across the chart. Its label is in the legend, where no curve
/// is in the way.
pub(super) fn mark_entry(label: &str, colour: Colour) -> LegendEntry {
    LegendEntry {
        label: label.to_owned(),
        color: colour.hex(),
        shape: LegendShape::Line,
        dasharray: Some(MARK_DASHES.to_owned()),
    }
}

/// Sets the height of a layout so that the plot itself takes `plot_height` pixels.
pub(super) fn with_plot_height(layout: Layout, plot_height: f64) -> Layout {
    let computed = ComputedLayout::from_layout(&layout);
    layout.with_height(plot_height + computed.margin_top + computed.margin_bottom)
}

/// Draws plots with the layout of [`layout`].
pub(super) fn render(plots: Vec<Plot>, layout: Layout) -> Scene {
    let mut scene = render_multiple(plots, layout);
    scene.width += RIGHT;
    scene
}

/// Writes the `<svg>` element of a scene. Screen readers read `title`.
pub(super) fn element(title: &str, mut scene: Scene) -> Result<String> {
    // Titles stand where those of the page do: on the left, bold.
    for element in &mut scene.elements {
        if let Primitive::Text { x, content, anchor, bold, .. } = element
            && content == title
        {
            (*x, *anchor, *bold) = (HEADING_LEFT, TextAnchor::Start, true);
        }
    }
    let (width, height) = (scene.width.ceil(), scene.height.ceil());
    let view_box = format!("0 0 {width} {height}");
    let (mut body, mut part) = (String::new(), Vec::new());
    for element in scene.elements {
        match element {
            // A drawing inside the drawing cuts what lies outside of it, without a name to refer
            // to.
            Primitive::ClipStart { x, y, width, height, .. } => {
                body += &markup(title, std::mem::take(&mut part))?;
                let corners = format!("{x:.2} {y:.2} {width:.2} {height:.2}");
                body += &format!(
                    "<svg x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" viewBox=\"{corners}\">"
                );
            }
            Primitive::ClipEnd => {
                body += &markup(title, std::mem::take(&mut part))?;
                body += "</svg>";
            }
            other => part.push(other),
        }
    }
    body += &markup(title, part)?;
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" class="plot" role="img" aria-label=(title) width=(width) height=(height)
            viewBox=(view_box) stroke-linejoin="round" {
            title { (title) }
            g fill=(Colour::Ink.hex()) font-family=(FONT) { (PreEscaped(body)) }
        }
    };
    Ok(svg.into_string())
}

/// Writes primitives with the library's SVG writer, without its outermost tags.
fn markup(title: &str, elements: Vec<Primitive>) -> Result<String> {
    let scene = Scene { background_color: None, elements, ..Scene::new(0.0, 0.0) };
    let drawn = SvgBackend::new().render_scene(&scene);
    let body = drawn.split_once('>').and_then(|(_, body)| body.trim_end().strip_suffix("</svg>"));
    let body = body.ok_or_else(|| Error::Backend { title: title.into(), reason: "it is no svg element".to_owned() })?;
    // The library's name and version stand in a comment before all else.
    let comment = body.strip_prefix("<!--").and_then(|rest| rest.split_once("-->"));
    Ok(comment.map_or(body, |(_, rest)| rest).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_svg_is_whole_and_escaped() {
        let mut scene = Scene::new(100.0, 50.0);
        scene.add(Primitive::Text {
            x: 1.0,
            y: 2.0,
            content: "x < y".into(),
            size: SMALL,
            anchor: TextAnchor::Start,
            rotate: None,
            bold: false,
            color: None,
        });
        scene.add(Primitive::ClipStart { x: 1.0, y: 2.0, width: 30.0, height: 40.0, id: String::new() });
        scene.add(Primitive::ClipEnd);
        let svg = element("a < b & \"c\"", scene).expect("drawable");
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"), "{svg}");
        assert_eq!((svg.matches("<svg").count(), svg.matches("</svg>").count()), (2, 2));
        assert!(svg.contains("viewBox=\"1.00 2.00 30.00 40.00\"") && !svg.contains("url("), "{svg}");
        assert!(svg.contains("viewBox=\"0 0 100 50\"") && svg.contains("width=\"100\""), "{svg}");
        assert!(svg.contains("a &lt; b &amp; &quot;c&quot;") && svg.contains("x &lt; y"), "{svg}");
    }
}
