//! Pictures of textures: found, measured, and decoded at a size that the budget allows.

use std::borrow::Cow;

use image::{ImageFormat, RgbaImage};

use super::budget::Part;
use super::{Document, accessors, basis, uri};
use crate::error::element;
use crate::picture;
use crate::{Error, Result};

/// Image formats of textures.
const FORMATS: [ImageFormat; 3] = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP];

/// Largest number of bytes of one decoded picture as the file has it. Ours: a JPEG of 16384 × 8192
/// pixels fits.
const MOST_BYTES: u64 = 384 << 20;

/// Encoding of a picture.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Plain(ImageFormat),
    /// Basis Universal (KHR_texture_basisu).
    Basis,
}

/// A picture whose header has been read.
#[derive(Clone, Debug)]
pub(super) struct Image {
    pub(super) index: usize,
    /// Name of the element, for messages.
    pub(super) element: String,
    kind: Kind,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    /// Size in bytes as encoded.
    pub(super) encoded: u64,
}

impl Image {
    /// Finds and measures `images[index]`.
    pub(super) fn open(document: &Document<'_>, index: usize, user: &str) -> Result<Self> {
        let image = document.get(&document.root.images, index, "images", user)?;
        let element = element("images", index, image.name.as_deref().unwrap_or_default());
        let bytes = bytes(document, index, &element)?;
        let failed = |reason| failed(document, &element, reason);
        let measured = if basis::is_ktx(&bytes) {
            basis::size(&bytes).map(|size| (Kind::Basis, size))
        } else {
            picture::format(&bytes, &FORMATS)
                .and_then(|format| picture::size(&bytes, format).map(|size| (Kind::Plain(format), size)))
        };
        let (kind, size) = measured.map_err(failed)?;
        let encoded = bytes.len() as u64;
        Ok(Self { index, element, kind, size, encoded })
    }

    /// Returns the number of halvings until no edge is longer than `longest` pixels.
    pub(super) fn halvings(&self, longest: u32) -> u32 {
        let edge = self.size[0].max(self.size[1]);
        (0..32).find(|halvings| edge.div_ceil(1 << halvings) <= longest).unwrap_or(31)
    }

    /// Returns the bytes of the pixels after `halvings` halvings of the edges, at four bytes each.
    pub(super) fn pixel_bytes(&self, halvings: u32) -> u64 {
        let [width, height] = self.size.map(|edge| u64::from(edge.div_ceil(1 << halvings)));
        4 * width * height
    }

    /// Decodes to 8-bit sRGB RGBA pixels, with each edge halved `halvings` times.
    pub(super) fn decode(&self, document: &Document<'_>, halvings: u32) -> Result<RgbaImage> {
        let pixels = u64::from(self.size[0]) * u64::from(self.size[1]);
        document.count(Part::Pixel, pixels, &self.element).map_err(|error| match error {
            Error::Invalid { reason, .. } => failed(document, &self.element, reason),
            other => other,
        })?;
        let bytes = bytes(document, self.index, &self.element)?;
        let decoded = match self.kind {
            Kind::Plain(format) => picture::decode(&bytes, format, MOST_BYTES).map(|p| picture::halved(p, halvings)),
            Kind::Basis => basis::decode(&bytes, halvings),
        };
        decoded.map_err(|reason| failed(document, &self.element, reason))
    }
}

fn failed(document: &Document<'_>, element: &str, reason: String) -> Error {
    Error::Image { file: document.file.to_owned(), element: element.to_owned(), reason }
}

/// Returns the encoded picture.
fn bytes<'d>(document: &'d Document<'_>, index: usize, element: &str) -> Result<Cow<'d, [u8]>> {
    let image = document.get(&document.root.images, index, "images", element)?;
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) => uri::read(document, element, uri).map(Cow::Owned),
        (None, Some(view)) => Ok(Cow::Borrowed(accessors::view(document, view.value(), element)?.0)),
        (None, None) => Err(document.invalid(element, "has neither a URI nor a buffer view")),
    }
}
