//! Pictures as files: side by side, and as PNG.

use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageFormat, Pixel};

use crate::failure::{Failure, Result};

/// Puts pictures of one height side by side; at least one is given.
#[must_use]
pub fn side_by_side<P: Pixel>(mut pictures: Vec<ImageBuffer<P, Vec<P::Subpixel>>>) -> ImageBuffer<P, Vec<P::Subpixel>> {
    if pictures.len() == 1 {
        return pictures.remove(0);
    }
    let width = pictures.iter().map(ImageBuffer::width).sum();
    let height = pictures.iter().map(ImageBuffer::height).max().unwrap_or(0);
    let mut all = ImageBuffer::new(width, height);
    let mut left = 0;
    for picture in &pictures {
        image::imageops::replace(&mut all, picture, left, 0);
        left += i64::from(picture.width());
    }
    all
}

/// Encodes a picture as PNG.
///
/// # Errors
/// [`Failure::Other`] if the encoder refuses.
pub fn png<I>(picture: &I) -> Result<Vec<u8>>
where
    I: Clone + Into<DynamicImage>,
{
    let mut bytes = Cursor::new(Vec::new());
    let picture: DynamicImage = picture.clone().into();
    picture
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|error| Failure::other(format!("the picture cannot be written as PNG: {error}")))?;
    Ok(bytes.into_inner())
}
