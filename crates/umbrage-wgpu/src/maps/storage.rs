//! Where each map lies: which layer of which size, and which part of it.

use crate::{Error, Result, Storage};

/// Where one map lies, in texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    /// Layer of the texture.
    pub layer: u32,
    /// Upper left corner in the layer.
    pub corner: [u32; 2],
    /// Width and height of the layer.
    pub layer_texels: [u32; 2],
}

/// Where all maps lie, and the texture that holds them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Arrangement {
    /// One for each split.
    pub tiles: Vec<Tile>,
    /// Layers of the texture.
    pub layers: u32,
    /// Width and height of each in texels.
    pub layer_texels: [u32; 2],
}

impl Arrangement {
    /// For maps of these edges, on a device whose textures are at most `largest` texels wide.
    pub fn new(storage: Storage, sizes: &[u32], largest: u32) -> Result<Self> {
        match storage {
            Storage::Auto | Storage::Array => Ok(Self::array(sizes)),
            Storage::Atlas => Self::atlas(sizes, largest),
        }
    }

    fn array(sizes: &[u32]) -> Self {
        let layer_texels = [sizes.iter().copied().max().unwrap_or(0); 2];
        let tiles = (0..sizes.len() as u32).map(|layer| Tile { layer, corner: [0; 2], layer_texels }).collect();
        Self { tiles, layers: sizes.len() as u32, layer_texels }
    }

    fn atlas(sizes: &[u32], largest: u32) -> Result<Self> {
        let Some((corners, layer_texels)) = packed(sizes, largest) else {
            return Err(Error::AtlasTooLarge { sizes: sizes.to_vec(), limit: largest });
        };
        let tiles = corners.into_iter().map(|corner| Tile { layer: 0, corner, layer_texels }).collect();
        Ok(Self { tiles, layers: 1, layer_texels })
    }
}

/// Corners of squares that do not overlap, in the order of their edges, and the width and height of the rectangle around them: the
/// smallest that we find, none if it would be more than `largest` wide or high.
///
/// Crates that pack rectangles fill a rectangle of a given size; here there are eight squares at most and the size is what is
/// looked for. So every width that is a sum of some edges is tried, with the largest square first and each as high up and then as far to
/// the left as there is room (B. Baker et al., "Orthogonal packings in two dimensions", 1980).
fn packed(sizes: &[u32], largest: u32) -> Option<(Vec<[u32; 2]>, [u32; 2])> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(sizes[i]));
    let most = sizes.iter().copied().max()?;
    let sum_of = |subset: u32| {
        sizes.iter().enumerate().filter(|(i, _)| subset & (1 << i) != 0).map(|(_, &s)| u64::from(s)).sum()
    };
    let mut widths: Vec<u64> = (1..1u32 << sizes.len()).map(sum_of).collect();
    widths.retain(|&width| width >= u64::from(most) && width <= u64::from(largest));
    widths.sort_unstable();
    widths.dedup();
    let candidates = widths.into_iter().filter_map(|width| {
        let corners = placed(sizes, &order, width as u32);
        let end = |axis: usize| corners.iter().zip(sizes).map(|(corner, size)| corner[axis] + size).max().unwrap_or(0);
        let texels = [end(0), end(1)];
        (texels[1] <= largest).then_some((corners, texels))
    });
    // Among equal areas the one nearest to a square, whose longer side is the shortest.
    candidates.min_by_key(|(_, [w, h])| (u64::from(*w) * u64::from(*h), *w.max(h)))
}

/// Corners of squares in a strip of a given width, no narrower than the largest.
fn placed(sizes: &[u32], order: &[usize], width: u32) -> Vec<[u32; 2]> {
    let mut corners = vec![[0; 2]; sizes.len()];
    for (count, &i) in order.iter().enumerate() {
        let before = &order[..count];
        // The highest and leftmost place touches an edge of another square, or of the strip, on both axes.
        let ends = |axis: usize| before.iter().map(|&j| corners[j][axis] + sizes[j]).chain([0]).collect::<Vec<_>>();
        let (lefts, mut tops) = (ends(0), ends(1));
        tops.sort_unstable();
        let is_free = |[x, y]: [u32; 2]| {
            let apart = |a: u32, a_size: u32, b: u32, b_size: u32| a + a_size <= b || b + b_size <= a;
            x + sizes[i] <= width
                && before.iter().all(|&j| {
                    let [bx, by] = corners[j];
                    apart(x, sizes[i], bx, sizes[j]) || apart(y, sizes[i], by, sizes[j])
                })
        };
        let place =
            tops.iter().find_map(|&y| lefts.iter().map(|&x| [x, y]).filter(|&at| is_free(at)).min_by_key(|at| at[0]));
        corners[i] = place.expect("below everything the strip is empty");
    }
    corners
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn atlas(sizes: &[u32]) -> [u32; 2] {
        Arrangement::new(Storage::Atlas, sizes, 16384).expect("it fits").layer_texels
    }

    #[test]
    fn maps_that_fill_a_rectangle_do() {
        assert_eq!(atlas(&[1024]), [1024, 1024]);
        assert_eq!(atlas(&[1024; 4]), [2048, 2048]);
        assert_eq!(atlas(&[512; 6]).iter().product::<u32>(), 6 * 512 * 512);
        assert_eq!(atlas(&[1024, 512, 512]).iter().product::<u32>(), 1024 * 1024 + 2 * 512 * 512);
        assert_eq!(atlas(&[256, 512, 512, 1024, 256, 256, 256]).iter().product::<u32>(), 1024 * 1024 * 7 / 4);
    }

    #[test]
    fn an_atlas_beyond_the_device_is_refused() {
        let error = Arrangement::new(Storage::Atlas, &[1024; 5], 2048).expect_err("five do not fit");
        assert_eq!(error, Error::AtlasTooLarge { sizes: vec![1024; 5], limit: 2048 });
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn tiles_lie_inside_and_apart(sizes in prop::collection::vec(prop_oneof![1u32..600, (0u32..4).prop_map(|i| 128 << i)], 1..=8)) {
            let it = Arrangement::new(Storage::Atlas, &sizes, 16384).expect("it fits");
            let squares: Vec<_> = it.tiles.iter().zip(&sizes).collect();
            for (i, (a, size)) in squares.iter().enumerate() {
                prop_assert!((0..2).all(|axis| a.corner[axis] + *size <= it.layer_texels[axis]));
                for (b, other) in &squares[..i] {
                    let apart = (0..2).any(|axis| {
                        a.corner[axis] + *size <= b.corner[axis] || b.corner[axis] + *other <= a.corner[axis]
                    });
                    prop_assert!(apart, "{a:?} of {size} and {b:?} of {other}");
                }
            }
            // Never worse than all in a row.
            let (sum, most) = (sizes.iter().sum::<u32>(), sizes.iter().max().copied().unwrap_or(0));
            prop_assert!(it.layer_texels[0] * it.layer_texels[1] <= sum * most);
        }
    }
}
