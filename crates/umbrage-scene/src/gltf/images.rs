//! Pictures: decoded within limits, so that a small file cannot fill the memory.

use std::collections::HashMap;
use std::rc::Rc;

use image::ImageFormat;

use super::{Document, buffers, uri};
use crate::error::element;
use crate::picture::decode;
use crate::{Error, Result};

/// Most bytes of all decoded pictures of a scene together, at four bytes a pixel.
const MOST_BYTES: u64 = 512 << 20;

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
        let left = MOST_BYTES.saturating_sub(self.bytes);
        let rgba = decode(bytes, &[ImageFormat::Png, ImageFormat::Jpeg], left).map_err(failed)?.into_rgba8();
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
