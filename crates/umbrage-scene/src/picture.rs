//! Pictures: decoded within limits, so that a small file cannot fill the memory.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, ImageReader, Limits};

/// Longest edge of a picture in pixels: what the largest GPUs take. Larger ones are an error, not a surprise.
const MOST_PIXELS_AN_EDGE: u32 = 16_384;

/// Decodes a picture of one of the `formats`. `most_bytes` bounds the memory for its pixels, at four bytes each; the error
/// says what is wrong.
pub(crate) fn decode(bytes: &[u8], formats: &[ImageFormat], most_bytes: u64) -> Result<DynamicImage, String> {
    let format =
        image::guess_format(bytes).map_err(|_| format!("is no picture of a known kind; {formats:?} is read"))?;
    if !formats.contains(&format) {
        return Err(format!("is a picture of the kind {format:?}; only {formats:?} is read"));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MOST_PIXELS_AN_EDGE);
    limits.max_image_height = Some(MOST_PIXELS_AN_EDGE);
    // Decoders also need some room of their own, for a line or two.
    limits.max_alloc = Some(most_bytes.saturating_mul(2));
    let reader = |limits: &Limits| {
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits.clone());
        reader
    };
    let (width, height) = reader(&Limits::no_limits())
        .into_dimensions()
        .map_err(|error| format!("its header cannot be read: {error}"))?;
    if width == 0 || height == 0 {
        return Err(format!("is {width}×{height} pixels"));
    }
    if width.max(height) > MOST_PIXELS_AN_EDGE || u64::from(width) * u64::from(height) * 4 > most_bytes {
        return Err(format!(
            "is {width}×{height} pixels; an edge may have {MOST_PIXELS_AN_EDGE}, and {} MiB are left for its pixels",
            most_bytes >> 20
        ));
    }
    reader(&limits).decode().map_err(|error| format!("cannot be decoded: {error}"))
}
