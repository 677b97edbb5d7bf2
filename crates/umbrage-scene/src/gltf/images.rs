//! Pictures: decoded within limits, so that a small file cannot fill the memory.

use std::collections::HashMap;
use std::io::Cursor;
use std::rc::Rc;

use image::{DynamicImage, ImageFormat, ImageReader, Limits};

use super::{Document, buffers, uri};
use crate::error::element;
use crate::{Error, Result};

/// Longest edge of a picture in pixels: what the largest GPUs take. Larger ones are an error, not a surprise.
pub(crate) const MOST_PIXELS_AN_EDGE: u32 = 16_384;

/// Most bytes of all decoded pictures of a scene together, at four bytes a pixel.
const MOST_BYTES: u64 = 512 << 20;

/// Decodes a PNG or JPEG. `most_bytes` bounds the memory for it; the error says what is wrong.
pub(crate) fn decode(bytes: &[u8], most_bytes: u64) -> Result<DynamicImage, String> {
    let format = image::guess_format(bytes).map_err(|_| "is neither a PNG nor a JPEG".to_owned())?;
    if !matches!(format, ImageFormat::Png | ImageFormat::Jpeg) {
        return Err(format!("is a {format:?} picture; only PNG and JPEG are read"));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MOST_PIXELS_AN_EDGE);
    limits.max_image_height = Some(MOST_PIXELS_AN_EDGE);
    limits.max_alloc = Some(most_bytes);
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

/// 8-bit sRGB RGBA pixels.
pub(super) struct Pixels {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) rgba: Vec<u8>,
}

/// The pictures of a document, each decoded when first asked for.
#[derive(Default)]
pub(super) struct Images {
    decoded: HashMap<usize, Rc<Pixels>>,
    bytes: u64,
}

impl Images {
    /// The pixels of `images[index]`.
    pub(super) fn get(&mut self, document: &Document<'_>, index: usize, user: &str) -> Result<Rc<Pixels>> {
        let image = document.get(&document.root.images, index, "images", user)?;
        if let Some(pixels) = self.decoded.get(&index) {
            return Ok(Rc::clone(pixels));
        }
        let name = element("images", index, image.name.as_deref().unwrap_or_default());
        let fetched;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                fetched = uri::read(document, &name, uri)?;
                fetched.as_slice()
            }
            (None, Some(view)) => buffers::view(document, view.value(), &name)?.0,
            (None, None) => return Err(document.invalid(name, "has neither a URI nor a buffer view")),
        };
        let failed = |reason| Error::Image { file: document.file.to_owned(), element: name.clone(), reason };
        let rgba = decode(bytes, MOST_BYTES.saturating_sub(self.bytes)).map_err(failed)?.into_rgba8();
        let pixels = Rc::new(Pixels { width: rgba.width(), height: rgba.height(), rgba: rgba.into_raw() });
        self.charge(document, user, pixels.rgba.len())?;
        self.decoded.insert(index, Rc::clone(&pixels));
        Ok(pixels)
    }

    /// Counts bytes against the limit of the whole scene.
    pub(super) fn charge(&mut self, document: &Document<'_>, user: &str, bytes: usize) -> Result<()> {
        self.bytes += bytes as u64;
        if self.bytes <= MOST_BYTES {
            return Ok(());
        }
        let reason = format!("takes the pictures of this file over {} MiB", MOST_BYTES >> 20);
        Err(Error::Image { file: document.file.to_owned(), element: user.to_owned(), reason })
    }
}
