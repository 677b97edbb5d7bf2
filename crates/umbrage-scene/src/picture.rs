//! Decoding of pictures within limits, so that a small file cannot fill the memory.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, ImageReader, Limits, RgbaImage};

/// Longest edge of a picture in pixels, which is the limit of the largest GPUs. Larger pictures are
/// an error.
pub(crate) const MOST_PIXELS_AN_EDGE: u32 = 16_384;

/// Returns the format of a picture, which must be one of `formats`.
pub(crate) fn format(bytes: &[u8], formats: &[ImageFormat]) -> Result<ImageFormat, String> {
    let format =
        image::guess_format(bytes).map_err(|_| format!("is not a picture of a known format; {formats:?} is read"))?;
    if formats.contains(&format) {
        Ok(format)
    } else {
        Err(format!("is a picture of the kind {format:?}; only {formats:?} is read"))
    }
}

/// Reads width and height from the header.
pub(crate) fn size(bytes: &[u8], format: ImageFormat) -> Result<[u32; 2], String> {
    let reader = ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader.into_dimensions().map_err(|error| format!("its header cannot be read: {error}"))?;
    if width == 0 || height == 0 {
        return Err(format!("is {width}×{height} pixels"));
    }
    if width.max(height) > MOST_PIXELS_AN_EDGE {
        return Err(format!("is {width}×{height} pixels; an edge may have {MOST_PIXELS_AN_EDGE}"));
    }
    Ok([width, height])
}

/// Decodes a picture. `most_bytes` bounds the memory of its pixels as the file has them. The error
/// says what is wrong.
pub(crate) fn decode(bytes: &[u8], format: ImageFormat, most_bytes: u64) -> Result<DynamicImage, String> {
    let [width, height] = size(bytes, format)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MOST_PIXELS_AN_EDGE);
    limits.max_image_height = Some(MOST_PIXELS_AN_EDGE);
    // Decoders also need some room of their own, for a line or two.
    limits.max_alloc = Some(most_bytes.saturating_add(16 << 20));
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let too_large =
        || format!("is {width}×{height} pixels; {} MiB is the most that a picture may take", most_bytes >> 20);
    if u64::from(width) * u64::from(height) > most_bytes {
        return Err(too_large());
    }
    reader.decode().map_err(|error| match error {
        image::ImageError::Limits(_) => too_large(),
        error => format!("cannot be decoded: {error}"),
    })
}

/// Halves each edge of a picture `halvings` times, rounding up, by averaging squares of pixels.
/// Colours are averaged in linear light and weighted by alpha, so that a hidden colour does not
/// show.
pub(crate) fn halved(picture: DynamicImage, halvings: u32) -> RgbaImage {
    if halvings == 0 {
        return picture.into_rgba8();
    }
    match picture {
        DynamicImage::ImageLuma8(p) => {
            shrunk(p.as_raw(), p.width(), p.height(), halvings, |&[l]: &[u8; 1]| [l, l, l, 255])
        }
        DynamicImage::ImageLumaA8(p) => {
            shrunk(p.as_raw(), p.width(), p.height(), halvings, |&[l, a]: &[u8; 2]| [l, l, l, a])
        }
        DynamicImage::ImageRgb8(p) => {
            shrunk(p.as_raw(), p.width(), p.height(), halvings, |&[r, g, b]: &[u8; 3]| [r, g, b, 255])
        }
        other => {
            let p = other.into_rgba8();
            shrunk(p.as_raw(), p.width(), p.height(), halvings, |&rgba: &[u8; 4]| rgba)
        }
    }
}

fn shrunk<const N: usize>(
    pixels: &[u8],
    width: u32,
    height: u32,
    halvings: u32,
    rgba: impl Fn(&[u8; N]) -> [u8; 4],
) -> RgbaImage {
    let tables = Tables::new();
    let (edge, width, height) = (1_usize << halvings, width as usize, height as usize);
    let (pixels, _) = pixels.as_chunks::<N>();
    RgbaImage::from_fn(width.div_ceil(edge) as u32, height.div_ceil(edge) as u32, |x, y| {
        let (x, y) = (x as usize * edge, y as usize * edge);
        let rows = (y..(y + edge).min(height)).map(|y| &pixels[y * width + x..y * width + (x + edge).min(width)]);
        let (mut plain, mut weighted, mut alpha, mut count) = ([0_u64; 3], [0_u64; 3], 0_u64, 0_u64);
        for pixel in rows.flatten() {
            let [r, g, b, a] = rgba(pixel);
            for (i, channel) in [r, g, b].into_iter().enumerate() {
                let linear = u64::from(tables.linear[usize::from(channel)]);
                plain[i] += linear;
                weighted[i] += linear * u64::from(a);
            }
            alpha += u64::from(a);
            count += 1;
        }
        let [r, g, b] =
            std::array::from_fn(|i| tables.encoded(weighted[i].checked_div(alpha).unwrap_or(plain[i] / count)));
        image::Rgba([r, g, b, ((alpha + count / 2) / count) as u8])
    })
}

/// Tables of sRGB: 8 bits to 16 linear bits and back (IEC 61966-2-1).
struct Tables {
    linear: [u16; 256],
    /// Greatest linear value that rounds to each 8-bit value.
    last: [u16; 256],
}

impl Tables {
    fn new() -> Self {
        let linear = |encoded: f64| {
            let c = encoded / 255.0;
            let light = if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
            (light * 65_535.0).round() as u16
        };
        Self {
            linear: std::array::from_fn(|i| linear(i as f64)),
            last: std::array::from_fn(|i| linear((i as f64 + 0.5).min(255.0))),
        }
    }

    fn encoded(&self, linear: u64) -> u8 {
        self.last.partition_point(|&last| u64::from(last) < linear).min(255) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage, Rgba};

    #[test]
    fn halving_keeps_flat_colours_and_mixes_light() {
        for value in 0..=255 {
            let flat = DynamicImage::ImageRgb8(RgbImage::from_pixel(5, 3, Rgb([value, 7, 200])));
            let small = halved(flat, 1);
            assert_eq!(small.dimensions(), (3, 2));
            assert!(small.pixels().all(|p| p.0 == [value, 7, 200, 255]));
        }
        // Half the light of white is 188 in sRGB.
        let stripes = RgbImage::from_fn(4, 4, |x, _| Rgb([if x % 2 == 0 { 255 } else { 0 }; 3]));
        let small = halved(DynamicImage::ImageRgb8(stripes), 2);
        assert_eq!((small.dimensions(), small.get_pixel(0, 0).0), ((1, 1), [188, 188, 188, 255]));
    }

    #[test]
    fn what_cannot_be_seen_does_not_tint() {
        let leaf = RgbaImage::from_fn(2, 2, |x, _| if x == 0 { Rgba([0, 255, 0, 255]) } else { Rgba([255, 0, 0, 0]) });
        assert_eq!(halved(DynamicImage::ImageRgba8(leaf), 1).get_pixel(0, 0).0, [0, 255, 0, 128]);
    }
}
