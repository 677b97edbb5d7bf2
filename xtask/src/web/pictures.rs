//! Comparison of pictures pixel by pixel.

use std::path::Path;

use anyhow::{Context, Result, bail};
use image::RgbaImage;

/// Largest difference of a channel between pixels that count as the same.
const MOST_DIFFERENCE: u8 = 8;

/// Reads a picture.
pub fn read(path: &Path) -> Result<RgbaImage> {
    Ok(image::open(path).with_context(|| format!("{} cannot be read", path.display()))?.into_rgba8())
}

/// Returns the share of pixels in which two pictures of one size differ.
pub fn difference(a: &RgbaImage, b: &RgbaImage) -> Result<f64> {
    if a.dimensions() != b.dimensions() {
        bail!("the pictures are {:?} and {:?} pixels large", a.dimensions(), b.dimensions());
    }
    let differs = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).take(3).any(|(a, b)| a.abs_diff(b) > MOST_DIFFERENCE)
    };
    let count = a.pixels().zip(b.pixels()).filter(|&pair| differs(pair)).count();
    Ok(count as f64 / (a.width() * a.height()).max(1) as f64)
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;

    #[test]
    fn a_pixel_counts_once_it_differs_by_more_than_eight() {
        let grey = RgbaImage::from_pixel(10, 10, Rgba([100, 100, 100, 255]));
        let mut other = grey.clone();
        other.put_pixel(0, 0, Rgba([108, 92, 100, 255]));
        assert_eq!(difference(&grey, &other).expect("one size"), 0.0);
        other.put_pixel(1, 0, Rgba([100, 100, 109, 255]));
        other.put_pixel(2, 0, Rgba([0, 0, 0, 255]));
        assert_eq!(difference(&grey, &other).expect("one size"), 0.02);
        assert!(difference(&grey, &RgbaImage::new(10, 9)).is_err());
    }
}
