//! The demo's page: one file, pictures inside, no script.

use std::{fmt::Write, io::Cursor, path::Path};

use anyhow::{Context, Result};
use base64::{Engine, engine::general_purpose::STANDARD};
use image::{DynamicImage, Rgba, codecs::jpeg::JpegEncoder};
use serde_json::Value;

use crate::demo::{Section, Shot};

const STYLE: &str = include_str!("page.css");
/// Good enough to see shadow edges, small enough for a page with forty pictures.
const JPEG_QUALITY: u8 = 90;
/// Longest edge of a shadow map on the page, pixels.
const MAP_EDGE: u32 = 320;
/// Where a mask hits nothing.
const SKY: [u8; 3] = [186, 207, 232];

/// The whole page.
pub fn html(adapter: &str, sections: &[(Section, Vec<Shot>)]) -> Result<String> {
    let mut nav = String::new();
    let mut body = String::new();
    for (section, shots) in sections {
        writeln!(nav, "<a href=\"#{}\">{}</a>", section.id, escape(section.title))?;
        writeln!(body, "<section id=\"{}\">\n<h2>{}</h2>", section.id, escape(section.title))?;
        writeln!(body, "<p class=\"quiet\">{}</p>", escape(section.about))?;
        for shot in shots {
            write_shot(&mut body, section, shot).with_context(|| format!("{}, {}", section.title, shot.name))?;
        }
        body.push_str("</section>\n");
    }
    Ok(format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>umbrage: what it draws</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <header>\n<h1>umbrage</h1>\n\
         <p>Parallel-split shadow maps over large worlds. Each shot below was drawn with the default settings: the picture, \
         the same coloured by split, its visibility mask, the splits' shadow maps, and what they cost.</p>\n\
         <p class=\"quiet\">Drawn by <code>cargo xtask demo</code> with {adapter}. Times are this machine's; counts and \
         bytes are the same on every one.</p>\n</header>\n<nav>\n{nav}</nav>\n{body}\
         <footer>The pictures of the city are made from a work under CC-BY-SA-4.0 and are under the same licence; see \
         assets/README.md. Full-size pictures, masks and maps lie in <code>out/demo/shots</code>.</footer>\n\
         </main>\n</body>\n</html>\n",
        adapter = escape(adapter),
    ))
}

fn write_shot(page: &mut String, section: &Section, shot: &Shot) -> Result<()> {
    writeln!(page, "<article id=\"{}-{}\">\n<h3>{}</h3>", section.id, shot.name, escape(&capitalised(shot.name)))?;
    writeln!(page, "<p>{}</p>", escape(shot.caption))?;
    writeln!(page, "<p><code>{}</code></p>", escape(&shot.command))?;
    page.push_str("<div class=\"pair\">\n");
    write_figure(page, &picture(&shot.picture)?, "The picture.")?;
    write_figure(page, &picture(&shot.tint)?, "The same, coloured by the split that answers.")?;
    page.push_str("</div>\n<div class=\"maps\">\n");
    write_figure(page, &small(&shot.mask)?, "Visibility: white lit, black shadowed, blue nothing there.")?;
    for (split, map) in shot.maps.iter().enumerate() {
        write_figure(page, &small(map)?, &format!("Map of split {split}, as the light sees it."))?;
    }
    page.push_str("</div>\n");
    write_report(page, &shot.report)?;
    page.push_str("</article>\n");
    Ok(())
}

fn write_figure(page: &mut String, picture: &str, caption: &str) -> Result<()> {
    let caption = escape(caption);
    writeln!(
        page,
        "<figure><img loading=\"lazy\" src=\"{picture}\" alt=\"{caption}\"><figcaption>{caption}</figcaption></figure>"
    )?;
    Ok(())
}

/// The splits as a table, the rest as a line, and all of it unabridged to unfold.
fn write_report(page: &mut String, report: &Value) -> Result<()> {
    page.push_str(
        "<div class=\"scroll\"><table>\n<tr><th>split</th><th>from, m</th><th>to, m</th><th>texel, m</th><th>casters</th>\
         <th>draws</th><th>triangles</th><th>map</th></tr>\n",
    );
    let splits = report["splits"].as_array().map(Vec::as_slice).unwrap_or_default();
    for (index, split) in splits.iter().enumerate() {
        writeln!(
            page,
            "<tr><td>{index}</td><td>{:.2}</td><td>{:.2}</td><td>{:.4}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            number(&split["near"]),
            number(&split["far"]),
            number(&split["texel_m"]),
            split["casters"],
            split["draws"],
            split["triangles"],
            bytes(&split["bytes"]),
        )?;
    }
    page.push_str("</table></div>\n");
    let times = &report["times_ms"];
    writeln!(
        page,
        "<p class=\"quiet\">Plan {:.2} ms, shadows {:.1} ms, frame {:.1} ms; maps {}; filter {}, fit {}, stabilised: {}.</p>",
        number(&times["plan"]),
        number(&times["shadow"]),
        number(&times["frame"]),
        bytes(&report["bytes"]),
        text(&report["filter"]),
        text(&report["fit"]),
        text(&report["stabilize"]),
    )?;
    let notes = report["notes"].as_array().map(Vec::as_slice).unwrap_or_default();
    if !notes.is_empty() {
        page.push_str("<ul class=\"notes\">\n");
        for note in notes {
            writeln!(page, "<li>{}</li>", text(note))?;
        }
        page.push_str("</ul>\n");
    }
    let all = escape(&serde_json::to_string_pretty(report)?);
    writeln!(page, "<details><summary>The whole report</summary><pre>{all}</pre></details>")?;
    Ok(())
}

/// A picture at full size, as a data URI.
fn picture(path: &Path) -> Result<String> {
    data_uri(&open(path)?)
}

/// A mask or map, made smaller, as a data URI. What is transparent becomes the colour of the sky.
fn small(path: &Path) -> Result<String> {
    let picture = open(path)?.thumbnail(MAP_EDGE, MAP_EDGE);
    if !picture.color().has_alpha() {
        return data_uri(&DynamicImage::ImageLuma8(picture.to_luma8()));
    }
    let mut over_sky = picture.to_rgba8();
    for Rgba([red, green, blue, alpha]) in over_sky.pixels_mut() {
        for (channel, sky) in [red, green, blue].into_iter().zip(SKY) {
            let mixed = u32::from(*channel) * u32::from(*alpha) + u32::from(sky) * u32::from(u8::MAX - *alpha);
            *channel = u8::try_from(mixed / u32::from(u8::MAX)).unwrap_or(u8::MAX);
        }
    }
    data_uri(&DynamicImage::ImageRgba8(over_sky))
}

fn open(path: &Path) -> Result<DynamicImage> {
    image::open(path).with_context(|| format!("cannot read {}", path.display()))
}

fn data_uri(picture: &DynamicImage) -> Result<String> {
    let mut jpeg = Cursor::new(Vec::new());
    let encoder = JpegEncoder::new_with_quality(&mut jpeg, JPEG_QUALITY);
    match picture {
        DynamicImage::ImageLuma8(grey) => grey.write_with_encoder(encoder)?,
        other => other.to_rgb8().write_with_encoder(encoder)?,
    }
    Ok(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg.into_inner())))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn text(value: &Value) -> String {
    escape(value.as_str().unwrap_or_default())
}

/// Bytes in KiB or MiB.
fn bytes(value: &Value) -> String {
    match value.as_u64() {
        Some(bytes) if bytes >= 1 << 20 => format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20)),
        Some(bytes) => format!("{:.0} KiB", bytes as f64 / 1024.0),
        None => "?".into(),
    }
}

fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_typed_becomes_markup() {
        assert_eq!(escape("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
    }

    #[test]
    fn sizes_are_readable() {
        assert_eq!(bytes(&Value::from(1024 * 1024 * 4)), "4.00 MiB");
        assert_eq!(bytes(&Value::from(2048)), "2 KiB");
    }
}
