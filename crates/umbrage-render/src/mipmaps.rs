//! Smaller versions of a texture, averaged in linear light and, where alpha is used, weighted by
//! it.

use std::sync::LazyLock;

use umbrage_scene::Texture;

/// Returns the number of mip levels down to 1×1.
pub(crate) fn level_count(width: u32, height: u32) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// Use of a texture's alpha in a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Alpha {
    /// Alpha is ignored: every texel is visible.
    Ignored,
    /// Alpha is the opacity of a texel.
    Used,
}

/// Computes all levels of a texture, level 0 first, each as tightly packed sRGB bytes. Where alpha
/// is used, invisible texels get the colour of the visible ones around them, so that a sample
/// between both keeps its colour. Alpha is never changed in level 0.
pub(crate) fn all_levels(texture: &Texture, alpha: Alpha) -> Vec<Vec<u8>> {
    let (mut width, mut height) = (texture.width as usize, texture.height as usize);
    let mut levels = vec![texture.rgba.clone()];
    for _ in 1..level_count(texture.width, texture.height) {
        let (next_width, next_height) = ((width / 2).max(1), (height / 2).max(1));
        let previous = &levels[levels.len() - 1];
        levels.push(halved(previous, [width, height], [next_width, next_height], alpha));
        (width, height) = (next_width, next_height);
    }
    if alpha == Alpha::Used {
        fill_unseen(&mut levels, texture.width as usize, texture.height as usize);
    }
    levels
}

/// Gives every texel of alpha 0 the colour at its place in the next smaller level, from the
/// smallest level up.
fn fill_unseen(levels: &mut [Vec<u8>], width: usize, height: usize) {
    let size = |level: usize| [(width >> level).max(1), (height >> level).max(1)];
    for level in (0..levels.len().saturating_sub(1)).rev() {
        let ([columns, rows], [fewer_columns, fewer_rows]) = (size(level), size(level + 1));
        let [this, smaller, ..] = &mut levels[level..] else { return };
        for (index, texel) in this.chunks_exact_mut(4).enumerate().filter(|(_, texel)| texel[3] == 0) {
            let (x, y) = (index % columns * fewer_columns / columns, index / columns * fewer_rows / rows);
            texel[..3].copy_from_slice(&smaller[4 * (y * fewer_columns + x)..][..3]);
        }
    }
}

/// Computes one level from the one before. Every texel is the mean of the area that it covers, so
/// odd sizes do not shift the image. Where alpha is used, colours are weighted by it, so that the
/// colour of invisible texels does not bleed into visible ones.
fn halved(source: &[u8], from: [usize; 2], to: [usize; 2], use_of_alpha: Alpha) -> Vec<u8> {
    let (columns, rows) = (footprints(from[0], to[0]), footprints(from[1], to[1]));
    let mut target = Vec::with_capacity(to[0] * to[1] * 4);
    for row in &rows {
        for column in &columns {
            let (mut color, mut plain, mut alpha) = ([0.0_f32; 3], [0.0_f32; 3], 0.0);
            for &(y, weight_y) in row {
                for &(x, weight_x) in column {
                    let weight = weight_x * weight_y;
                    let texel = &source[4 * (y * from[0] + x)..][..4];
                    let opacity = f32::from(texel[3]) / 255.0;
                    alpha += weight * opacity;
                    for channel in 0..3 {
                        let linear = LINEAR_FROM_SRGB[usize::from(texel[channel])];
                        color[channel] += weight * opacity * linear;
                        plain[channel] += weight * linear;
                    }
                }
            }
            let mean = if alpha > 0.0 && use_of_alpha == Alpha::Used { color.map(|c| c / alpha) } else { plain };
            target.extend(mean.map(srgb_from_linear));
            target.push((alpha * 255.0).round() as u8);
        }
    }
    target
}

/// Lists, for each target texel, the source texels under it with their shares, which add up to 1.
fn footprints(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let scale = from as f32 / to as f32;
    (0..to)
        .map(|i| {
            let (begin, end) = (i as f32 * scale, (i + 1) as f32 * scale);
            let last = (end.ceil() as usize).min(from);
            (begin as usize..last)
                .map(|x| (x, (end.min((x + 1) as f32) - begin.max(x as f32)) / scale))
                .filter(|&(_, share)| share > 0.0)
                .collect()
        })
        .collect()
}

/// The sRGB transfer function (IEC 61966-2-1) for all 8-bit values.
static LINEAR_FROM_SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let encoded = byte as f32 / 255.0;
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    })
});

fn srgb_from_linear(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, height: u32, rgba: Vec<u8>) -> Texture {
        Texture { width, height, rgba, wrap: Default::default(), filter: Default::default() }
    }

    #[test]
    fn a_plain_texture_stays_plain_at_every_level() {
        let color = [13, 200, 77, 129];
        for alpha in [Alpha::Used, Alpha::Ignored] {
            let levels = all_levels(&texture(7, 5, color.repeat(35)), alpha);
            assert_eq!(levels.len(), 3, "7, 3, 1");
            for (level, bytes) in levels.iter().enumerate() {
                assert!(bytes.chunks(4).all(|texel| texel == color), "level {level}");
            }
            assert_eq!(levels[1].len(), 3 * 2 * 4);
        }
    }

    #[test]
    fn black_and_white_average_in_linear_light() {
        let levels = all_levels(&texture(2, 1, vec![0, 0, 0, 255, 255, 255, 255, 255]), Alpha::Used);
        assert_eq!(levels[1], [188, 188, 188, 255], "half the light is 188 in sRGB, not 128");
    }

    #[test]
    fn invisible_colour_does_not_bleed() {
        let levels = all_levels(&texture(2, 1, vec![255, 0, 0, 0, 0, 255, 0, 255]), Alpha::Used);
        assert_eq!(levels, [vec![0, 255, 0, 0, 0, 255, 0, 255], vec![0, 255, 0, 128]]);
        // A green leaf in the middle of white nothing, sizes odd: green everywhere at every level,
        // alpha as it was.
        let mut leaf = [255, 255, 255, 0].repeat(9 * 7);
        leaf[4 * (3 * 9 + 4)..][..4].copy_from_slice(&[20, 180, 40, 255]);
        let alpha_of = |bytes: &[u8]| bytes.chunks(4).map(|texel| texel[3]).collect::<Vec<_>>();
        let levels = all_levels(&texture(9, 7, leaf.clone()), Alpha::Used);
        assert_eq!(alpha_of(&levels[0]), alpha_of(&leaf));
        let colours: Vec<_> = levels.iter().flatten().copied().collect();
        assert!(colours.chunks(4).all(|texel| texel[..3] == [20, 180, 40]), "{colours:?}");
    }

    #[test]
    fn colour_counts_as_it_is_where_alpha_is_ignored() {
        let source = vec![255, 255, 255, 0, 0, 0, 0, 255];
        let levels = all_levels(&texture(2, 1, source.clone()), Alpha::Ignored);
        assert_eq!(levels, [source, vec![188, 188, 188, 128]]);
    }

    #[test]
    fn footprints_cover_everything_once() {
        for from in 1..40_usize {
            let to = (from / 2).max(1);
            let mut covered = vec![0.0; from];
            for taps in footprints(from, to) {
                assert!((taps.iter().map(|tap| tap.1).sum::<f32>() - 1.0).abs() < 1e-5, "{from} -> {to}");
                for (x, share) in taps {
                    covered[x] += share * from as f32 / to as f32;
                }
            }
            assert!(covered.iter().all(|share| (share - 1.0).abs() < 1e-4), "{from} -> {to}: {covered:?}");
        }
    }
}
