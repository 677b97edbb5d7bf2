//! Large meshes for the shadow passes, which ask for positions only: vertices that differ in
//! nothing but their surface are one, and runs of triangles have boxes of their own, so that a map
//! draws those parts of a mesh that can shade what it serves.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;
use umbrage::Aabb;

/// Triangles of the smallest clusters.
const LEAF: usize = 8;

/// Triangles that a primitive has at least, or it stays whole.
const LEAST_TRIANGLES: usize = 128;

/// What merging has to save, as a share of the vertices, to be worth indices of its own.
const LEAST_SAVED: f64 = 0.05;

/// Consecutive triangles, in a tree of such runs: a node is followed by the nodes that it consists
/// of.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// Where they lie in the index buffer.
    pub indices: Range<u32>,
    /// How many of the nodes that follow it consists of; 0 for a leaf.
    pub below: u32,
    /// Around their vertices, in the mesh's own space.
    min: Vec3,
    max: Vec3,
}

impl Cluster {
    /// Around their vertices, in the mesh's own space.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.min.as_dvec3(), self.max.as_dvec3())
    }

    /// How many they are.
    pub fn triangles(&self) -> u32 {
        (self.indices.end - self.indices.start) / 3
    }
}

/// Calls `each` with nodes of a tree and where they stand in it, from the root on; what a node
/// consists of follows if the answer is `true`.
pub(crate) fn descend(tree: &[Cluster], mut each: impl FnMut(usize, &Cluster) -> bool) {
    let mut at = 0;
    while let Some(node) = tree.get(at) {
        at += 1 + if each(at, node) { 0 } else { node.below as usize };
    }
}

/// Vertices told apart by their positions alone.
pub(crate) struct Merged {
    /// In the order in which triangles use them, as vertex caches like it.
    pub positions: Vec<[f32; 3]>,
    /// Triangles in the order given.
    pub indices: Vec<u32>,
}

impl Merged {
    /// `None` if that spares too little. Positions count as the same if their bits are, so what is
    /// drawn stays the same to the bit.
    pub fn of(positions: &[[f32; 3]], indices: &[u32]) -> Option<Self> {
        let mut numbers = HashMap::with_capacity(positions.len());
        let mut merged = Self { positions: Vec::new(), indices: Vec::with_capacity(indices.len()) };
        for &index in indices {
            let position = positions[index as usize];
            let number = *numbers.entry(position.map(f32::to_bits)).or_insert_with(|| {
                merged.positions.push(position);
                merged.positions.len() as u32 - 1
            });
            merged.indices.push(number);
        }
        let most = (1.0 - LEAST_SAVED) * positions.len() as f64;
        (merged.positions.len() as f64 <= most).then_some(merged)
    }
}

/// Halves triangles (three indices each, which lie at `first` in the index buffer) in the order in
/// which they stand, down to runs of a few: what is modelled or optimised for a vertex cache lies
/// together, and a whole mesh is drawn as it was. A small mesh is one node.
pub(crate) fn clusters(positions: &[[f32; 3]], indices: &[u32], first: u32) -> Vec<Cluster> {
    let mut tree = Vec::new();
    if !indices.is_empty() {
        let leaf = if indices.len() < 3 * LEAST_TRIANGLES { indices.len() } else { 3 * LEAF };
        halve(positions, indices, first, leaf, &mut tree);
    }
    tree
}

/// Appends the tree of a run of triangles; `leaf` is how many indices the smallest runs have.
fn halve(positions: &[[f32; 3]], indices: &[u32], first: u32, leaf: usize, tree: &mut Vec<Cluster>) {
    let at = tree.len();
    tree.push(Cluster {
        indices: first..first + indices.len() as u32,
        below: 0,
        min: Vec3::INFINITY,
        max: -Vec3::INFINITY,
    });
    let (mut min, mut max) = (Vec3::INFINITY, -Vec3::INFINITY);
    if indices.len() <= leaf {
        for &index in indices {
            let corner = Vec3::from(positions[index as usize]);
            (min, max) = (min.min(corner), max.max(corner));
        }
    } else {
        // All leaves but the last are full.
        let (left, right) = indices.split_at((indices.len() / 2).next_multiple_of(leaf));
        for (begin, half) in [(first, left), (first + left.len() as u32, right)] {
            let node = tree.len();
            halve(positions, half, begin, leaf, tree);
            (min, max) = (min.min(tree[node].min), max.max(tree[node].max));
        }
        tree[at].below = (tree.len() - at - 1) as u32;
    }
    (tree[at].min, tree[at].max) = (min, max);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quads along x that share no vertex.
    fn strip(quads: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
        let quad = |x: f32| [[x, 0.0, 0.0], [x, 0.0, 1.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 0.0, 1.0]];
        let positions = (0..quads).flat_map(|i| quad(i as f32)).collect();
        (positions, (0..quads).flat_map(|i| [0, 1, 2, 2, 1, 3].map(|corner| 4 * i + corner)).collect())
    }

    #[test]
    fn merged_triangles_are_the_same_triangles() {
        let (positions, indices) = strip(1000);
        let merged = Merged::of(&positions, &indices).expect("every inner vertex is there twice");
        assert_eq!(merged.positions.len(), 2002);
        assert_eq!(merged.indices.len(), indices.len());
        for (&new, &old) in merged.indices.iter().zip(&indices) {
            assert_eq!(merged.positions[new as usize], positions[old as usize]);
        }
        assert!(Merged::of(&merged.positions, &merged.indices).is_none(), "there is nothing left to merge");
    }

    #[test]
    fn zeroes_of_either_sign_are_two_positions() {
        let positions = [[0.0, 0.0, 0.0], [-0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let merged = Merged::of(&positions, &[0, 1, 2, 1, 2, 3]).expect("one is spared");
        assert_eq!(merged.indices, [0, 1, 2, 1, 2, 2]);
    }

    #[test]
    fn every_level_of_the_tree_holds_every_triangle_once_and_in_its_box() {
        for quads in [64, 65, 67, 1000, 1021] {
            let (positions, indices) = strip(quads);
            let tree = clusters(&positions, &indices, 30);
            assert_eq!(
                (tree[0].indices.start, tree[0].triangles(), tree[0].below as usize),
                (30, 2 * quads, tree.len() - 1)
            );
            for depth in 0..12 {
                // The nodes of this depth and the leaves above it.
                let (mut end, mut ends) = (30, Vec::new());
                descend(&tree, |_, node| {
                    ends.retain(|&end| end > node.indices.start);
                    ends.push(node.indices.end);
                    let goes_on = ends.len() <= depth && node.below > 0;
                    if !goes_on {
                        assert_eq!(node.indices.start, end, "{quads} quads, depth {depth}");
                        end = node.indices.end;
                    }
                    goes_on
                });
                assert_eq!(end as usize, 30 + indices.len());
            }
            for node in &tree {
                assert!(node.below > 0 || node.triangles() as usize <= LEAF);
                for &index in &indices[node.indices.start as usize - 30..node.indices.end as usize - 30] {
                    let at = Vec3::from(positions[index as usize]).as_dvec3();
                    assert_eq!(node.bounds().including(at), node.bounds());
                }
            }
        }
    }

    #[test]
    fn small_meshes_stay_whole() {
        let (positions, indices) = strip(LEAST_TRIANGLES as u32 / 2 - 1);
        assert_eq!(clusters(&positions, &indices, 0).len(), 1);
        assert!(clusters(&[], &[], 0).is_empty());
    }
}
