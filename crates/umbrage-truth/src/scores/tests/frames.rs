//! Frames made by hand.

use glam::DVec3;
use image::{GrayAlphaImage, LumaA};

use crate::scores::{Answers, Domain};
use crate::{Hit, TruthMask};

pub const RANGE: (f64, f64) = (1.0, 1000.0);

/// A mask whose pixels face the light; `of` answers depth and truth.
pub fn mask(size: [usize; 2], of: impl Fn(usize, usize) -> Option<(f64, bool)>) -> TruthMask {
    let hits = (0..size[0] * size[1]).map(|i| {
        let (x, y) = (i % size[0], i / size[0]);
        of(x, y).map(|(depth, lit)| Hit {
            position: DVec3::new(x as f64, y as f64, -depth),
            normal: DVec3::Y,
            depth,
            object: 0,
            triangle: 0,
            lit,
        })
    });
    TruthMask::from_hits(size, DVec3::Y, hits.collect()).unwrap()
}

/// A flat receiver at depth 10, in shadow left of `edge`.
pub fn edge_at(size: [usize; 2], edge: usize) -> TruthMask {
    mask(size, |x, _| Some((10.0, x >= edge)))
}

pub fn domain(mask: &TruthMask) -> Domain {
    Domain::new(mask, RANGE).unwrap()
}

/// The truth itself as an answer.
pub fn answers(mask: &TruthMask) -> Answers {
    Answers::from_mask(&mask.to_image())
}

pub fn inverted(mask: &TruthMask) -> Answers {
    let mut image = mask.to_image();
    for pixel in image.pixels_mut() {
        pixel.0[0] = 255 - pixel.0[0];
    }
    Answers::from_mask(&image)
}

/// An image in which nothing was drawn.
pub fn nothing(size: [usize; 2]) -> Answers {
    Answers::from_mask(&GrayAlphaImage::from_pixel(size[0] as u32, size[1] as u32, LumaA([0, 0])))
}
