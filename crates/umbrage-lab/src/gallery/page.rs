//! The gallery's page.

use std::io::Cursor;

use image::{DynamicImage, Rgba, codecs::jpeg::JpegEncoder};

use super::{drawn::Drawn, scenes::Scene};
use crate::{
    failure::{Failure, Result},
    page::html::{Cell, Column, Figure, Page, Section, Table},
    report::{Report, to_json},
};

/// Quality of JPEG pictures: good enough to show shadow edges, small enough for a page with forty
/// pictures.
const JPEG_QUALITY: u8 = 90;
/// Longest edge of a mask or shadow map on the page, in pixels.
const SMALL_EDGE: u32 = 320;
/// Colour of pixels where a mask has no surface.
const SKY: [u8; 3] = [186, 207, 232];

/// Makes the whole page.
pub(super) fn page(adapter: &str, sections: Vec<Section>) -> String {
    let page = Page {
        title: "umbrage: what it draws".into(),
        lead: vec![
            "Parallel-split shadow maps over large worlds. Each shot below was drawn with the default settings: the picture, the same \
             coloured by split, its visibility mask, the splits' shadow maps, and what they cost."
                .into(),
            format!("Drawn with {adapter}. Times are this machine's; counts and bytes are the same on every one."),
        ],
        sections,
        footer: "Written by `umbrage gallery`. Full-size pictures, masks, maps and reports lie beside this page in `shots`.".into(),
    };
    page.html()
}

/// Makes the section of one scene with its shots.
pub(super) fn section(scene: &Scene, shots: &[Drawn]) -> Result<Section> {
    let mut section = Section::new(scene.title).note(scene.about);
    for drawn in shots {
        let alt = |what: &str| format!("{}, {}: {what}", scene.title, drawn.shot.name);
        let large = [
            (&drawn.picture, "the picture", "The picture."),
            (&drawn.tint, "the splits", "The same, coloured by the split that answers."),
        ];
        let large = large.map(|(picture, what, caption)| {
            Ok(Figure::picture(&jpeg(&DynamicImage::from(picture.clone()))?, &alt(what), caption))
        });
        let mask = jpeg(&small(&DynamicImage::from(drawn.mask.clone())))?;
        let caption = "Visibility: white lit, black shadowed, blue nothing there.";
        let mut small_ones = vec![Figure::picture(&mask, &alt("the mask"), caption)];
        for (split, map) in drawn.maps.iter().enumerate() {
            let caption = format!("Map of split {split}, as the light sees it.");
            small_ones.push(Figure::picture(&jpeg(&small(map))?, &alt(&format!("map {split}")), caption));
        }
        section = section
            .heading(&capitalised(drawn.shot.name))
            .text(drawn.shot.caption)
            .text(&format!("`{}`", drawn.command))
            .figures(&large.into_iter().collect::<Result<Vec<_>>>()?)
            .small_figures(&small_ones)
            .table(&splits(&drawn.report))
            .note(&costs(&drawn.report));
        if !drawn.report.notes.is_empty() {
            section = section.list(&drawn.report.notes);
        }
        section = section.folded("The whole report", &String::from_utf8_lossy(&to_json(&drawn.report)?));
    }
    Ok(section)
}

fn splits(report: &Report) -> Table {
    let columns = ["split", "from, m", "to, m", "texel, m", "casters", "draws", "triangles", "map"].map(Column::number);
    report.splits.iter().enumerate().fold(Table::new("", columns.to_vec()), |table, (index, split)| {
        let count = |count: u64| Cell::Number(count as f64, 0);
        table.row(vec![
            count(index as u64),
            Cell::Number(split.near, 2),
            Cell::Number(split.far, 2),
            Cell::Number(split.texel_m, 4),
            count(split.casters),
            count(split.draws),
            count(split.triangles),
            bytes(split.bytes).into(),
        ])
    })
}

fn costs(report: &Report) -> String {
    let times = report.times_ms;
    format!(
        "Plan {:.2} ms, shadows {:.1} ms, frame {:.1} ms; maps {}; filter {}, fit {}, stabilised: {}.",
        times.plan,
        times.shadow,
        times.frame,
        bytes(report.bytes),
        report.filter,
        report.fit,
        report.stabilize,
    )
}

/// Scales a mask or map down. Transparent pixels get the colour of the sky.
fn small(picture: &DynamicImage) -> DynamicImage {
    let picture = picture.thumbnail(SMALL_EDGE, SMALL_EDGE);
    if !picture.color().has_alpha() {
        return DynamicImage::ImageLuma8(picture.to_luma8());
    }
    let mut over_sky = picture.to_rgba8();
    for Rgba([red, green, blue, alpha]) in over_sky.pixels_mut() {
        for (channel, sky) in [red, green, blue].into_iter().zip(SKY) {
            let mixed = u32::from(*channel) * u32::from(*alpha) + u32::from(sky) * u32::from(u8::MAX - *alpha);
            *channel = u8::try_from(mixed / u32::from(u8::MAX)).unwrap_or(u8::MAX);
        }
    }
    DynamicImage::ImageRgba8(over_sky)
}

fn jpeg(picture: &DynamicImage) -> Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    let encoder = JpegEncoder::new_with_quality(&mut file, JPEG_QUALITY);
    let written = match picture {
        DynamicImage::ImageLuma8(grey) => grey.write_with_encoder(encoder),
        other => other.to_rgb8().write_with_encoder(encoder),
    };
    written.map_err(|error| Failure::other(format!("the picture cannot be written as JPEG: {error}")))?;
    Ok(file.into_inner())
}

/// Formats bytes in KiB or MiB.
fn bytes(count: u64) -> String {
    if count >= 1 << 20 {
        format!("{:.2} MiB", count as f64 / f64::from(1 << 20))
    } else {
        format!("{:.0} KiB", count as f64 / 1024.0)
    }
}

fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use image::{GrayAlphaImage, LumaA};

    use super::*;

    #[test]
    fn sizes_are_readable() {
        assert_eq!(bytes(1024 * 1024 * 4), "4.00 MiB");
        assert_eq!(bytes(2048), "2 KiB");
    }

    #[test]
    fn a_mask_shows_sky_where_nothing_was_hit() {
        let mask = GrayAlphaImage::from_fn(2, 1, |x, _| if x == 0 { LumaA([0, 0]) } else { LumaA([255, 255]) });
        let shown = small(&DynamicImage::from(mask)).to_rgb8();
        assert!(shown.width() >= 2);
        assert_eq!(shown.get_pixel(0, 0).0, SKY);
        assert_eq!(shown.get_pixel(shown.width() - 1, 0).0, [255; 3]);
    }
}
