//! Large meshes for the shadow passes, which read positions only. Vertices that differ in nothing
//! but their surface are one vertex. Runs of triangles have boxes of their own, so that a map draws
//! only the parts of a mesh that can shade its receivers.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;
use umbrage::Aabb;

/// Number of triangles in the smallest clusters.
const LEAF: usize = 8;

/// Fewest triangles of a primitive that is divided.
const LEAST_TRIANGLES: usize = 128;

/// Least saving of merging, as a share of the vertices, that is worth separate indices.
const LEAST_SAVED: f64 = 0.05;

/// Consecutive triangles: a node in a tree of such runs. Its child nodes follow it in the list.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// Range of the triangles in the index buffer.
    pub indices: Range<u32>,
    /// Number of the following nodes that lie below this one; 0 for a leaf.
    pub below: u32,
    /// Least corner of the box around the vertices, in the mesh's own space.
    min: Vec3,
    max: Vec3,
}

impl Cluster {
    /// Returns the box around the vertices, in the mesh's own space.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.min.as_dvec3(), self.max.as_dvec3())
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> u32 {
        (self.indices.end - self.indices.start) / 3
    }
}

/// Calls `each` with nodes of a tree and their indices, from the root on. The nodes below a node
/// follow if `each` returns `true`.
pub(crate) fn descend(tree: &[Cluster], mut each: impl FnMut(usize, &Cluster) -> bool) {
    let mut at = 0;
    while let Some(node) = tree.get(at) {
        at += 1 + if each(at, node) { 0 } else { node.below as usize };
    }
}

/// Vertices that are told apart by their positions alone.
pub(crate) struct Merged {
    /// Positions in the order in which triangles use them, which suits vertex caches.
    pub positions: Vec<[f32; 3]>,
    /// Indices of the triangles in the order given.
    pub indices: Vec<u32>,
}

impl Merged {
    /// Merges vertices; `None` if that saves too little. Positions are equal if their bits are, so
    /// the drawn result stays the same to the bit.
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

/// Divides triangles (three indices each, at `first` in the index buffer) by halving their list
/// down to runs of a few. The order stays as modelled or as optimised for a vertex cache:
/// neighbours in the list lie together, and a whole mesh is drawn unchanged. A small mesh is one
/// node.
pub(crate) fn clusters(positions: &[[f32; 3]], indices: &[u32], first: u32) -> Vec<Cluster> {
    let mut tree = Vec::new();
    if !indices.is_empty() {
        let leaf = if indices.len() < 3 * LEAST_TRIANGLES { indices.len() } else { 3 * LEAF };
        halve(positions, indices, first, leaf, &mut tree);
    }
    tree
}

/// Appends the tree of a run of triangles. `leaf` is the number of indices in the smallest runs.
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
