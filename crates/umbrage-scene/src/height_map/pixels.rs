//! Heights from pictures: grey in any format, or metres packed into colours.

use image::{DynamicImage, ImageFormat};

use super::HeightEncoding;
use super::raster::{Metres, Raster, check_size};
use crate::picture;

/// Largest mean step between neighbours of terrain, in metres. Ours: coarse maps of whole mountain
/// chains have some 100 m, pictures of anything else thousands.
const ROUGHEST: f64 = 300.0;

/// Reds of Terrarium heights from −11,264 to 9,216 m. Nothing on Earth is deeper or higher.
const TERRARIUM_RED: std::ops::RangeInclusive<u8> = 84..=163;

/// Reds of Mapbox heights from −10,000 to 16,214 m.
const MAPBOX_RED: std::ops::RangeInclusive<u8> = 0..=3;

/// Reads a PNG or WebP.
pub(super) fn read(bytes: &[u8], encoding: Option<HeightEncoding>) -> Result<Raster, String> {
    let format = picture::format(bytes, &[ImageFormat::Png, ImageFormat::WebP])?;
    let [width, height] = picture::size(bytes, format)?.map(|edge| edge as usize);
    check_size(width, height, bytes.len())?;
    // Eight bytes a pixel are the most that formats have.
    let pixels = picture::decode(bytes, format, 8 * (width * height) as u64)?;
    let mut raster = Raster { width, height, ..Raster::default() };
    let colors = match pixels {
        DynamicImage::ImageLuma8(grey) => {
            raster.values = grey.into_raw().into_iter().map(f32::from).collect();
            return Ok(raster);
        }
        DynamicImage::ImageLuma16(grey) => {
            raster.values = grey.into_raw().into_iter().map(f32::from).collect();
            return Ok(raster);
        }
        DynamicImage::ImageLumaA8(p) => spread(p.into_raw().as_chunks::<2>().0, |&[l, a]| [l, l, l, a].map(u16::from)),
        DynamicImage::ImageLumaA16(p) => spread(p.into_raw().as_chunks::<2>().0, |&[l, a]| [l, l, l, a]),
        DynamicImage::ImageRgb8(p) => {
            spread(p.into_raw().as_chunks::<3>().0, |&[r, g, b]| [r, g, b, 255].map(u16::from))
        }
        DynamicImage::ImageRgba8(p) => spread(p.into_raw().as_chunks::<4>().0, |rgba| rgba.map(u16::from)),
        DynamicImage::ImageRgb16(p) => spread(p.into_raw().as_chunks::<3>().0, |&[r, g, b]| [r, g, b, 65_535]),
        DynamicImage::ImageRgba16(p) => spread(p.into_raw().as_chunks::<4>().0, |rgba| *rgba),
        other => return Err(format!("has pixels of the kind {:?}; give a PNG of 8 or 16 bits", other.color())),
    };
    let is_grey = colors.iter().all(|[r, g, b, _]| r == g && g == b);
    let chosen = match encoding {
        Some(chosen) => chosen,
        None if is_grey => HeightEncoding::Grey,
        None => recognized(&colors, width).ok_or(
            "has colours, but neither in the way of Terrarium nor of Mapbox; give a grey PNG, or say which they are with \
             --height-encoding",
        )?,
    };
    if encoding.is_none() && chosen != HeightEncoding::Grey {
        raster.notes.push(format!(
            "colours were taken for {chosen:?} heights, as their values fit; --height-encoding says otherwise"
        ));
    }
    raster.metres = metres(chosen);
    raster.values = colors.iter().map(|&color| value(chosen, color)).collect();
    clear_transparent(&mut raster, &colors);
    Ok(raster)
}

fn spread<const N: usize, T>(pixels: &[[T; N]], rgba: impl Fn(&[T; N]) -> [u16; 4]) -> Vec<[u16; 4]> {
    pixels.iter().map(rgba).collect()
}

/// Clears the data of transparent pixels, unless the picture is transparent everywhere.
fn clear_transparent(raster: &mut Raster, colors: &[[u16; 4]]) {
    let clear = colors.iter().filter(|color| color[3] == 0).count();
    if clear == colors.len() {
        raster.notes.push("the height map is transparent everywhere; its alpha is ignored".into());
    } else if clear > 0 {
        for (value, color) in raster.values.iter_mut().zip(colors) {
            if color[3] == 0 {
                *value = f32::NAN;
            }
        }
    }
}

/// Returns the conversion of an encoding's values to metres.
fn metres(encoding: HeightEncoding) -> Option<Metres> {
    match encoding {
        HeightEncoding::Grey => None,
        HeightEncoding::Terrarium => Some(Metres { unit: 1.0 / 256.0, offset: -32_768.0 }),
        HeightEncoding::Mapbox => Some(Metres { unit: 0.1, offset: -10_000.0 }),
    }
}

/// Returns the value of a pixel: 24 bits of colour, which are exact in `f32`, or grey.
fn value(encoding: HeightEncoding, [r, g, b, _]: [u16; 4]) -> f32 {
    match encoding {
        HeightEncoding::Grey if r == g && g == b => f32::from(r),
        HeightEncoding::Grey => (f32::from(r) + f32::from(g) + f32::from(b)) / 3.0,
        HeightEncoding::Terrarium | HeightEncoding::Mapbox => {
            (u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b)) as f32
        }
    }
}

/// Returns the encoding whose heights are possible on Earth and as smooth as terrain.
fn recognized(colors: &[[u16; 4]], width: usize) -> Option<HeightEncoding> {
    let seen = || colors.iter().filter(|color| color[3] != 0);
    [(HeightEncoding::Terrarium, TERRARIUM_RED), (HeightEncoding::Mapbox, MAPBOX_RED)].into_iter().find_map(
        |(encoding, reds)| {
            let is_possible = seen().all(|[r, _, _, _]| u8::try_from(*r).is_ok_and(|r| reds.contains(&r)));
            let metres = metres(encoding)?;
            let height = |color: &[u16; 4]| metres.height(value(encoding, *color));
            let steps =
                colors.chunks(width).flat_map(|row| row.windows(2)).filter(|pair| pair.iter().all(|c| c[3] != 0));
            let (sum, count) = steps.fold((0.0, 0.0), |(sum, count), pair| {
                (sum + (height(&pair[1]) - height(&pair[0])).abs(), count + 1.0)
            });
            (is_possible && sum <= ROUGHEST * count).then_some(encoding)
        },
    )
}
