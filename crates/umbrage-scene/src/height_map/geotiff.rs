//! Heights from GeoTIFF. Source: OGC GeoTIFF 1.1 (19-008r4), and the tag for missing data that GDAL
//! writes.

use std::io::Cursor;

use glam::DVec2;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::raster::{Metres, Raster, check_size};

/// Keys of the GeoTIFF key directory.
const MODEL_TYPE: u32 = 1024;
const PROJECTED_LINEAR_UNIT: u32 = 3076;
const VERTICAL_UNIT: u32 = 4099;

/// Values of [`MODEL_TYPE`].
const PROJECTED: u32 = 1;
const GEOGRAPHIC: u32 = 2;

/// Reads the first picture of a TIFF.
pub(super) fn read(bytes: &[u8]) -> Result<Raster, String> {
    let broken = |error: tiff::TiffError| format!("cannot be decoded as TIFF: {error}");
    let mut limits = Limits::default();
    limits.decoding_buffer_size = most_decoded(bytes.len());
    limits.intermediate_buffer_size = limits.decoding_buffer_size.min(256 << 20);
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(broken)?.with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(broken)?;
    let (width, height) = (width as usize, height as usize);
    check_size(width, height, bytes.len())?;
    let color = decoder.colortype().map_err(broken)?;
    let samples = match color {
        ColorType::Gray(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::Multiband { num_samples, .. } => usize::from(num_samples),
        other => return Err(format!("has pixels of the kind {other:?}; give one band of heights")),
    };
    let mut notes = Vec::new();
    if samples > 1 {
        notes.push(format!("the height map has {samples} bands; the first is taken for heights"));
    }
    let missing = missing(&mut decoder);
    let keys = keys(&mut decoder);
    let cell = cell(&mut decoder, &keys, &mut notes)?;
    let unit = match keys.iter().find(|(key, _)| *key == VERTICAL_UNIT) {
        Some((_, unit)) => linear_unit(*unit)
            .ok_or_else(|| format!("has heights in the unit {unit} of EPSG; metres and feet are read"))?,
        None => 1.0,
    };
    let values = values(decoder.read_image().map_err(broken)?);
    let mut values: Vec<f32> = values.into_iter().step_by(samples).collect();
    if values.len() < width * height {
        return Err(format!("has {} values for {width}×{height} posts", values.len()));
    }
    values.truncate(width * height);
    for value in &mut values {
        if missing == Some(*value) || !value.is_finite() {
            *value = f32::NAN;
        }
    }
    Ok(Raster { width, height, values, metres: Some(Metres { unit, offset: 0.0 }), cell, notes })
}

/// Returns the bytes that a file may take while it is decoded: eight for each post that
/// [`check_size`] allows it, and four bands of them. A small file that claims thousands of bands
/// cannot fill the memory.
fn most_decoded(bytes: usize) -> usize {
    bytes.saturating_mul(4 * 8 * 4).saturating_add(32 << 20).min(1 << 30)
}

/// Returns the value that stands for missing data.
fn missing(decoder: &mut Decoder<Cursor<&[u8]>>) -> Option<f32> {
    let text = decoder.get_tag_ascii_string(Tag::GdalNodata).ok()?;
    text.trim_matches(|c: char| c.is_whitespace() || c == '\0').parse::<f64>().ok().map(|value| value as f32)
}

/// Returns the keys with their short values.
fn keys(decoder: &mut Decoder<Cursor<&[u8]>>) -> Vec<(u32, u32)> {
    let directory = decoder.get_tag_u32_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    let entries = directory.get(4..).unwrap_or_default().chunks_exact(4);
    // Location 0: the value itself.
    entries.filter(|entry| entry[1] == 0).map(|entry| (entry[0], entry[3])).collect()
}

/// Returns the metres of a linear unit by its EPSG code: metre, foot, US survey foot.
fn linear_unit(code: u32) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        _ => None,
    }
}

/// Returns the metres between posts; `None` if they are in degrees or unknown.
fn cell(
    decoder: &mut Decoder<Cursor<&[u8]>>,
    keys: &[(u32, u32)],
    notes: &mut Vec<String>,
) -> Result<Option<DVec2>, String> {
    let scale = match decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag) {
        Ok(scale) if scale.len() >= 2 => DVec2::new(scale[0].abs(), scale[1].abs()),
        _ => match decoder.get_tag_f64_vec(Tag::ModelTransformationTag) {
            // Rows and columns may be turned against the axes; a cell is as large.
            Ok(m) if m.len() >= 6 => DVec2::new(m[0].hypot(m[4]), m[1].hypot(m[5])),
            _ => return Ok(None),
        },
    };
    if !(scale.is_finite() && scale.min_element() > 0.0) {
        return Ok(None);
    }
    let key = |wanted: u32| keys.iter().find(|(key, _)| *key == wanted).map(|(_, value)| *value);
    match (key(MODEL_TYPE), key(PROJECTED_LINEAR_UNIT)) {
        (Some(GEOGRAPHIC), _) => {
            notes.push("the height map's posts are degrees apart, not metres".into());
            Ok(None)
        }
        (_, Some(unit)) => match linear_unit(unit) {
            Some(metres) => Ok(Some(scale * metres)),
            None => Err(format!("has posts in the unit {unit} of EPSG; give --metres-per-post")),
        },
        (Some(PROJECTED), None) => Ok(Some(scale)),
        _ => {
            notes.push(format!(
                "nothing says in which unit the height map's posts are {} apart; taken for metres",
                scale.x
            ));
            Ok(Some(scale))
        }
    }
}

/// Converts values of any type to `f32`. Digits beyond single precision are rounded off.
fn values(decoded: DecodingResult) -> Vec<f32> {
    match decoded {
        DecodingResult::U8(list) => list.into_iter().map(f32::from).collect(),
        DecodingResult::I8(list) => list.into_iter().map(f32::from).collect(),
        DecodingResult::U16(list) => list.into_iter().map(f32::from).collect(),
        DecodingResult::I16(list) => list.into_iter().map(f32::from).collect(),
        DecodingResult::U32(list) => list.into_iter().map(|x| x as f32).collect(),
        DecodingResult::I32(list) => list.into_iter().map(|x| x as f32).collect(),
        DecodingResult::U64(list) => list.into_iter().map(|x| x as f32).collect(),
        DecodingResult::I64(list) => list.into_iter().map(|x| x as f32).collect(),
        DecodingResult::F16(list) => list.into_iter().map(f32::from).collect(),
        DecodingResult::F32(list) => list,
        DecodingResult::F64(list) => list.into_iter().map(|x| x as f32).collect(),
    }
}
