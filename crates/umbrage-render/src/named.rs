//! Meshes whose triangles maps can name, for exact edges. Every triangle's first corner tells its
//! run, and buffers hold the corners of the runs.

use std::collections::HashMap;

use umbrage_wgpu::{RUN_TRIANGLES, StoredRun};

use crate::{Gpu, Result};

/// Number of triangles in a run.
const RUN: usize = RUN_TRIANGLES as usize;

/// Triangles each of whose first corners belongs to one run.
pub(crate) struct Named {
    /// Positions. Positions with different bits are different, and so are copies of one that is the
    /// first corner in two runs.
    pub positions: Vec<[f32; 3]>,
    /// Run of each position that is a first corner.
    pub runs: Vec<u32>,
    /// Indices of the triangles in the order given, with their corners rotated.
    pub indices: Vec<u32>,
}

impl Named {
    /// Divides triangles into runs, numbered from `first_run` on. A flat output of a vertex shader
    /// is that of a triangle's first corner (<https://www.w3.org/TR/webgpu/#primitive-vertex>). A
    /// corner that is no other run's becomes the first; where there is none, a copy does.
    pub fn of(positions: &[[f32; 3]], indices: &[u32], first_run: u32) -> Self {
        const NOBODY: u32 = u32::MAX;
        let mut numbers = HashMap::with_capacity(positions.len());
        let mut named = Self { positions: Vec::new(), runs: Vec::new(), indices: Vec::with_capacity(indices.len()) };
        let mut copies: HashMap<u32, u32> = HashMap::new();
        for (triangles, run) in indices.chunks(3 * RUN).zip(first_run..) {
            copies.clear();
            for triangle in triangles.chunks_exact(3) {
                let mut corners = [triangle[0], triangle[1], triangle[2]].map(|index| {
                    let position = positions[index as usize];
                    *numbers.entry(position.map(f32::to_bits)).or_insert_with(|| {
                        named.positions.push(position);
                        named.runs.push(NOBODY);
                        named.positions.len() as u32 - 1
                    })
                });
                let of = |run: u32| corners.iter().position(|&corner| named.runs[corner as usize] == run);
                match of(run).or_else(|| of(NOBODY)) {
                    Some(first) => corners.rotate_left(first),
                    None => {
                        corners[0] = *copies.entry(corners[0]).or_insert_with(|| {
                            named.positions.push(named.positions[corners[0] as usize]);
                            named.runs.push(run);
                            named.positions.len() as u32 - 1
                        });
                    }
                }
                named.runs[corners[0] as usize] = run;
                named.indices.extend(corners);
            }
        }
        named.runs.iter_mut().filter(|run| **run == NOBODY).for_each(|run| *run = 0);
        named
    }
}

/// Runs of all meshes on the GPU.
pub(crate) struct NamedRuns {
    /// Run of each position: a vertex buffer beside the positions.
    pub of_vertices: wgpu::Buffer,
    /// Buffer of all [`StoredRun`]s.
    pub stored: wgpu::Buffer,
    /// First run and number of runs of each mesh.
    pub of_meshes: Vec<[u32; 2]>,
}

impl NamedRuns {
    /// Uploads runs. `of_vertices` has a run for each position, `of_meshes` the runs of each mesh.
    pub fn new(gpu: &Gpu, of_vertices: &[u32], of_meshes: &[Vec<StoredRun>]) -> Result<Self> {
        let all: Vec<StoredRun> = of_meshes.concat();
        gpu.check_storage("the runs of triangles", size_of_val(all.as_slice()) as u64)?;
        let buffer = |label, bytes: &[u8], usage| gpu.filled_buffer(label, bytes, usage);
        let mut end = 0;
        Ok(Self {
            of_vertices: buffer(
                "NamedRuns::of_vertices",
                bytemuck::cast_slice(of_vertices),
                wgpu::BufferUsages::VERTEX,
            ),
            stored: buffer("NamedRuns::stored", bytemuck::cast_slice(&all), wgpu::BufferUsages::STORAGE),
            of_meshes: of_meshes
                .iter()
                .map(|runs| {
                    end += runs.len() as u32;
                    [end - runs.len() as u32, runs.len() as u32]
                })
                .collect(),
        })
    }

    pub fn bytes(&self) -> u64 {
        self.of_vertices.size() + self.stored.size()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of quads that share vertices, `across` wide.
    fn grid(across: u32, down: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
        let wide = across + 1;
        let positions = (0..wide * (down + 1)).map(|i| [(i % wide) as f32, 0.0, (i / wide) as f32]).collect();
        let quad = |i: u32| {
            let first = i / across * wide + i % across;
            [first, first + wide, first + 1, first + 1, first + wide, first + wide + 1]
        };
        (positions, (0..across * down).flat_map(quad).collect())
    }

    fn check(positions: &[[f32; 3]], indices: &[u32], first_run: u32) -> Named {
        let named = Named::of(positions, indices, first_run);
        assert_eq!(named.indices.len(), indices.len());
        assert_eq!(named.positions.len(), named.runs.len());
        for (number, (new, old)) in named.indices.chunks(3).zip(indices.chunks(3)).enumerate() {
            assert_eq!(named.runs[new[0] as usize], first_run + (number / RUN) as u32, "triangle {number}");
            let at = |index: u32| named.positions[index as usize].map(f32::to_bits);
            let was = |index: u32| positions[index as usize].map(f32::to_bits);
            let turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
            assert!(
                turns.iter().any(|turn| (0..3).all(|k| at(new[k]) == was(old[turn[k]]))),
                "triangle {number} is another one, or mirrored"
            );
        }
        named
    }

    #[test]
    fn first_corners_tell_their_run() {
        let (positions, indices) = grid(40, 30);
        let named = check(&positions, &indices, 7);
        // Hardly a vertex is there twice.
        assert!(named.positions.len() < positions.len() + positions.len() / 20, "{}", named.positions.len());
        check(&positions, &[], 0);
    }

    /// Every triangle tells its run, even if all triangles share a few vertices.
    #[test]
    fn any_triangles_tell_their_run() {
        // Numbers from a linear congruential generator (Knuth's constants).
        let mut state = 3u64;
        let mut next = |count: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 40) % count) as u32
        };
        let positions: Vec<[f32; 3]> = (0u8..12).map(|i| [f32::from(i % 9), 1.0, 0.0]).collect();
        for _ in 0..200 {
            let triangles = 1 + next(130);
            let indices: Vec<u32> = (0..3 * triangles).map(|_| next(12)).collect();
            let first_run = next(1000);
            check(&positions, &indices, first_run);
        }
    }
}
