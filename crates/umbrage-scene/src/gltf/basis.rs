//! Pictures of KHR_texture_basisu: KTX 2.0 files of Basis Universal. Source of the header: the KTX
//! 2.0 specification, section 3.

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use image::{DynamicImage, RgbaImage};

use crate::picture::{self, MOST_PIXELS_AN_EDGE};

const MAGIC: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";

/// Largest number of pixels of a picture. Ours: 8192².
const MOST_PIXELS: u64 = 1 << 26;

/// Largest number of bytes of a level once a general-purpose compression is undone: a byte for each
/// pixel and some to spare.
const MOST_LEVEL_BYTES: u64 = 2 * MOST_PIXELS;

/// Returns whether bytes begin as a KTX 2.0 file does.
pub(super) fn is_ktx(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Reads width and height from the header.
pub(super) fn size(bytes: &[u8]) -> Result<[u32; 2], String> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let long = |at: usize| Some(u64::from(word(at)?) | u64::from(word(at + 4)?) << 32);
    let header = || Some(([word(20)?, word(24)?], word(40)?));
    let ([width, height], levels) = header().ok_or("is a KTX file that is cut short")?;
    // Each entry of the index of levels: offset, length, length once decompressed.
    let largest = (0..levels.min(32) as usize).filter_map(|level| long(80 + 24 * level + 16)).max().unwrap_or(0);
    if width.max(height) > MOST_PIXELS_AN_EDGE || u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!("is {width}×{height} pixels; {MOST_PIXELS} are the most of a KTX file"));
    }
    if largest > MOST_LEVEL_BYTES {
        return Err(format!("has a level of {largest} bytes; {MOST_LEVEL_BYTES} are the most"));
    }
    if width == 0 || height == 0 { Err(format!("is {width}×{height} pixels")) } else { Ok([width, height]) }
}

/// Decodes the picture with its edges halved `halvings` times: the level of that size, or one made
/// of the smallest there is.
pub(super) fn decode(bytes: &[u8], halvings: u32) -> Result<RgbaImage, String> {
    let broken = |error: basisu::Error| format!("is a KTX file that cannot be transcoded: {error:?}");
    let transcoder = Transcoder::new(bytes).map_err(broken)?;
    let level = halvings.min(transcoder.level_count().saturating_sub(1));
    let info = transcoder.image_level_info(level).map_err(broken)?;
    let rgba = transcoder.transcode(level, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(broken)?;
    let pixels =
        RgbaImage::from_raw(info.width, info.height, rgba).ok_or("is a KTX file whose pixels do not fit its size")?;
    Ok(picture::halved(DynamicImage::ImageRgba8(pixels), halvings - level))
}
