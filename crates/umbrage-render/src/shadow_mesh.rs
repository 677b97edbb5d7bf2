//! Large meshes for the shadow passes, which ask for positions only: vertices that differ in nothing but their surface are one, and
//! runs of triangles have boxes of their own, so that a map draws those parts of a mesh that can shade what it serves.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;
use umbrage::Aabb;

/// Triangles of a cluster at most.
const CLUSTER: usize = 128;

/// Clusters that a primitive has at least, or it stays whole.
const LEAST_CLUSTERS: usize = 3;

/// What merging has to save, as a share of the vertices, to be worth indices of its own.
const LEAST_SAVED: f64 = 0.05;

/// Consecutive triangles.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// Where they lie in the index buffer.
    pub indices: Range<u32>,
    /// Around their vertices, in the mesh's own space.
    pub bounds: Aabb,
}

/// Vertices told apart by their positions alone.
pub(crate) struct Merged {
    /// In the order in which triangles use them, as vertex caches like it.
    pub positions: Vec<[f32; 3]>,
    /// Triangles in the order given.
    pub indices: Vec<u32>,
}

impl Merged {
    /// `None` if that spares too little. Positions count as the same if their bits are, so what is drawn stays the same to the bit.
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

/// Cuts triangles (three indices each, which lie at `first` in the index buffer) into clusters in the order in which they stand: what is
/// modelled or optimised for a vertex cache lies together, and a whole mesh is drawn as it was. One for small meshes.
pub(crate) fn clusters(positions: &[[f32; 3]], indices: &[u32], first: u32) -> Vec<Cluster> {
    let length = if indices.len() < 3 * CLUSTER * LEAST_CLUSTERS { indices.len().max(1) } else { 3 * CLUSTER };
    let cluster = |(i, own): (usize, &[u32])| {
        let begin = first + (i * length) as u32;
        let corners = own.iter().map(|&index| Vec3::from(positions[index as usize]).as_dvec3());
        Cluster { indices: begin..begin + own.len() as u32, bounds: Aabb::from_points(corners) }
    };
    indices.chunks(length).enumerate().map(cluster).collect()
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
    fn clusters_hold_every_triangle_once_and_their_boxes_hold_them() {
        let (positions, indices) = strip(1000);
        let clusters = clusters(&positions, &indices, 30);
        assert_eq!(clusters.len(), 2000_usize.div_ceil(CLUSTER));
        assert_eq!((clusters[0].indices.start, clusters.last().map(|last| last.indices.end)), (30, Some(6030)));
        assert!(clusters.windows(2).all(|pair| pair[0].indices.end == pair[1].indices.start));
        for cluster in &clusters {
            for &index in &indices[cluster.indices.start as usize - 30..cluster.indices.end as usize - 30] {
                let at = Vec3::from(positions[index as usize]).as_dvec3();
                assert_eq!(cluster.bounds.including(at), cluster.bounds);
            }
        }
    }

    #[test]
    fn small_meshes_stay_whole() {
        let (positions, indices) = strip(CLUSTER as u32);
        assert_eq!(clusters(&positions, &indices, 0).len(), 1);
        assert!(clusters(&[], &[], 0).is_empty());
    }
}
