//! Arrangement of the maps in textures: the layers, their size, and each map's part of a layer.

use umbrage::config::{Generation, Storage};

use super::passes::MapPass;
use crate::{Error, Result};

/// Part of a layer that one map takes, in texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    /// Layer of the texture, face of the cube, or the texture itself.
    pub layer: u32,
    /// Upper left corner in the layer.
    pub corner: [u32; 2],
    /// Width and height of the layer.
    pub layer_texels: [u32; 2],
}

/// Arrangement of all maps, and the texture that contains them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Arrangement {
    /// The tile of each split's map.
    pub tiles: Vec<Tile>,
    /// Number of layers of the texture; for separate textures, number of textures.
    pub layers: u32,
    /// Width and height of each layer in texels; for separate textures, those of the largest.
    pub layer_texels: [u32; 2],
}

impl Arrangement {
    /// The arrangement of maps of these edges drawn in these passes, on a device whose textures are
    /// at most `largest` texels wide.
    pub fn new(
        storage: Storage,
        generation: Generation,
        passes: &[MapPass],
        sizes: &[u32],
        largest: u32,
    ) -> Result<Self> {
        // Multiview draws as many layers in every pass; the last pass may have some to spare.
        let layers = passes.iter().map(MapPass::views).sum::<usize>() as u32;
        match (storage, generation) {
            (Storage::Atlas, _) => Self::tiles(sizes, 1, largest),
            (_, Generation::Mixed) => Self::tiles(sizes, layers, largest),
            (Storage::Array, _) => Ok(Self::layers(sizes, layers)),
            (Storage::Cube, _) => Ok(Self::layers(sizes, 6)),
            (Storage::Reused, _) => {
                let mut it = Self::layers(sizes, 1);
                it.tiles.iter_mut().for_each(|tile| tile.layer = 0);
                Ok(it)
            }
            (Storage::Separate, _) => {
                let mut it = Self::layers(sizes, layers);
                it.tiles.iter_mut().zip(sizes).for_each(|(tile, &size)| tile.layer_texels = [size; 2]);
                Ok(it)
            }
        }
    }

    /// Arranges one map in each layer, in its upper left corner.
    fn layers(sizes: &[u32], layers: u32) -> Self {
        let layer_texels = [sizes.iter().copied().max().unwrap_or(0); 2];
        let tiles = (0..sizes.len() as u32).map(|layer| Tile { layer, corner: [0; 2], layer_texels }).collect();
        Self { tiles, layers, layer_texels }
    }

    /// Arranges split `t · layers + v` as tile `t` of layer `v`.
    fn tiles(sizes: &[u32], layers: u32, largest: u32) -> Result<Self> {
        let mut tiles = vec![Tile { layer: 0, corner: [0; 2], layer_texels: [0; 2] }; sizes.len()];
        let mut layer_texels = [0; 2];
        for layer in 0..layers as usize {
            let here: Vec<usize> = (layer..sizes.len()).step_by(layers as usize).collect();
            let edges: Vec<u32> = here.iter().map(|&split| sizes[split]).collect();
            let Some((corners, texels)) = packed(&edges, largest) else {
                return Err(Error::AtlasTooLarge { sizes: sizes.to_vec(), limit: largest });
            };
            for (&split, corner) in here.iter().zip(corners) {
                (tiles[split].layer, tiles[split].corner) = (layer as u32, corner);
            }
            layer_texels = [0, 1].map(|axis| layer_texels[axis].max(texels[axis]));
        }
        tiles.iter_mut().for_each(|tile| tile.layer_texels = layer_texels);
        Ok(Self { tiles, layers, layer_texels })
    }
}

/// Corners of squares that do not overlap, in the order of `sizes`, and the width and height of the
/// rectangle around them: the smallest rectangle found, or `None` if it would be more than
/// `largest` wide or high.
///
/// Crates that pack rectangles fill a rectangle of a given size; here there are eight squares at
/// most and the size is the unknown. Therefore every width that is a sum of some edges is tried,
/// with the largest square first, and each square as high up and then as far to the left as there
/// is room (B. Baker et al., "Orthogonal packings in two dimensions", 1980).
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
        // The highest and leftmost place touches an edge of another square, or of the strip, on
        // both axes.
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
    use crate::maps::choose::Abilities;

    fn arranged(storage: Storage, generation: Generation, sizes: &[u32]) -> Arrangement {
        let passes = MapPass::all(
            generation,
            sizes.len(),
            Abilities { views: 6, clip_distances: true, leads: false, depth_loads: true },
        );
        Arrangement::new(storage, generation, &passes, sizes, 16384).expect("it fits")
    }

    fn atlas(sizes: &[u32]) -> [u32; 2] {
        arranged(Storage::Atlas, Generation::PerSplit, sizes).layer_texels
    }

    #[test]
    fn mixed_layers_hold_two_tiles() {
        let it = arranged(Storage::Array, Generation::Mixed, &[512, 512, 512, 512]);
        assert_eq!((it.layers, it.layer_texels[0] * it.layer_texels[1]), (2, 2 * 512 * 512));
        assert_eq!(it.tiles.iter().map(|tile| tile.layer).collect::<Vec<_>>(), [0, 1, 0, 1]);
        assert_eq!(arranged(Storage::Array, Generation::Mixed, &[512]).layers, 1);
    }

    #[test]
    fn one_map_is_used_again_and_again() {
        let it = arranged(Storage::Reused, Generation::Multipass, &[256, 512, 128]);
        assert_eq!((it.layers, it.layer_texels), (1, [512, 512]));
        assert!(it.tiles.iter().all(|tile| tile.layer == 0 && tile.corner == [0; 2]));
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
        let passes = MapPass::all(Generation::PerSplit, 5, Abilities::default());
        let error = Arrangement::new(Storage::Atlas, Generation::PerSplit, &passes, &[1024; 5], 2048)
            .expect_err("five do not fit");
        assert_eq!(error, Error::AtlasTooLarge { sizes: vec![1024; 5], limit: 2048 });
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn tiles_lie_inside_and_apart(sizes in prop::collection::vec(prop_oneof![1u32..600, (0u32..4).prop_map(|i| 128 << i)], 1..=8)) {
            let it = arranged(Storage::Atlas, Generation::PerSplit, &sizes);
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
