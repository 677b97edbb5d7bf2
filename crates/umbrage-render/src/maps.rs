//! A split's depth map as a picture.

use image::{GrayImage, Luma};
use umbrage::config::DepthFormat;

/// Draws depths stretched from 0 (nearest to the light) to 230 (farthest); texels without a caster
/// are white. The map is a square of `size` texels at `corner` of a layer with rows of `row`
/// texels.
pub(crate) fn picture_of(depths: &[f32], row: u32, corner: [u32; 2], size: u32) -> GrayImage {
    const FARTHEST: f32 = 230.0;
    let at = |x: u32, y: u32| depths[((corner[1] + y) * row + corner[0] + x) as usize];
    let stored = || (0..size * size).map(|i| at(i % size, i / size)).filter(|&depth| depth < 1.0);
    let (least, most) = (stored().fold(f32::INFINITY, f32::min), stored().fold(f32::NEG_INFINITY, f32::max));
    let range = most - least;
    GrayImage::from_fn(size, size, |x, y| {
        let depth = at(x, y);
        let gray = match depth < 1.0 {
            true if range > 0.0 => ((depth - least) / range * FARTHEST).round() as u8,
            true => 0,
            false => u8::MAX,
        };
        Luma([gray])
    })
}

/// Reads depths in \[0,1\] from a map's bytes.
pub(crate) fn depths_of(bytes: &[u8], format: DepthFormat) -> Vec<f32> {
    match format {
        DepthFormat::D32Float | DepthFormat::R32Float => bytemuck::pod_collect_to_vec(bytes),
        DepthFormat::D16Unorm => bytemuck::pod_collect_to_vec::<u8, u16>(bytes)
            .into_iter()
            .map(|depth| f32::from(depth) / f32::from(u16::MAX))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_stretched_and_emptiness_is_white() {
        let picture = picture_of(&[0.4, 0.5, 0.6, 1.0], 2, [0; 2], 2);
        assert_eq!(picture.as_raw(), &[0, 115, 230, 255]);
        let corner = picture_of(&[0.4, 0.5, 1.0, 0.6, 1.0, 1.0, 1.0, 1.0, 1.0], 3, [0; 2], 2);
        assert_eq!(corner.as_raw(), &[0, 115, 230, 255]);
        let tile = picture_of(&[0.1, 0.1, 0.1, 0.1, 0.4, 0.5, 0.1, 0.6, 1.0], 3, [1, 1], 2);
        assert_eq!(tile.as_raw(), &[0, 115, 230, 255]);
    }

    #[test]
    fn a_flat_or_empty_map_is_no_division_by_zero() {
        assert_eq!(picture_of(&[0.5, 1.0, 1.0, 0.5], 2, [0; 2], 2).as_raw(), &[0, 255, 255, 0]);
        assert_eq!(picture_of(&[1.0], 1, [0; 2], 1).as_raw(), &[255]);
    }

    #[test]
    fn sixteen_bits_reach_one() {
        assert_eq!(depths_of(&[255, 255, 0, 0], DepthFormat::D16Unorm), [1.0, 0.0]);
    }
}
