//! Meshes whose triangles maps can name, for exact edges: every triangle's first corner tells which
//! run of eight it belongs to, and buffers say where a run's corners are.

use std::collections::HashMap;

use glam::DVec3;
use umbrage_scene::Pose;
use umbrage_wgpu::{Occluder, Occluders, StoredRun, StoredSlot, stored_runs_layout};

use crate::geometry::Geometry;
use crate::{Gpu, Result};

/// Triangles of a run, as [`umbrage_wgpu::stored_runs`] has them.
const RUN: usize = 8;

/// Bytes of a row of the transform and what follows it.
const SLOT_BYTES: u64 = size_of::<StoredSlot>() as u64;

/// Triangles whose first corners belong to one run each.
pub(crate) struct Named {
    /// Told apart by their bits, and by their run where they are first corners of two.
    pub positions: Vec<[f32; 3]>,
    /// The run of each position that is a first corner.
    pub runs: Vec<u32>,
    /// The triangles in the order given, their corners turned around.
    pub indices: Vec<u32>,
}

impl Named {
    /// Triangles as runs `first_run` and so on. A flat output of a vertex shader is that of a
    /// triangle's first corner (<https://www.w3.org/TR/webgpu/#primitive-vertex>); a corner that is
    /// no other run's becomes the first, and where there is none a copy does.
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
    /// The run of each position, a vertex buffer beside the positions.
    pub of_vertices: wgpu::Buffer,
    /// Every [`StoredRun`].
    stored: wgpu::Buffer,
    /// Of each mesh the first of its runs and how many it has.
    of_meshes: Vec<[u32; 2]>,
}

impl NamedRuns {
    /// `of_vertices` has a run for each position, `of_meshes` each mesh's own runs.
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

/// Who has which ids, and where they stand in this frame.
pub(crate) struct Names {
    /// Per object of the pose its mesh and its ids; none for what cannot be asked.
    of_objects: Vec<Option<(usize, Occluder)>>,
    slots: Vec<StoredSlot>,
    buffer: wgpu::Buffer,
}

impl Names {
    /// The binding from which the four buffers follow, in the frame's group.
    pub const BINDING: u32 = 1;

    pub fn new(gpu: &Gpu) -> Self {
        Self { of_objects: Vec::new(), slots: Vec::new(), buffer: slot_buffer(gpu, 64) }
    }

    /// Layout of the four buffers.
    pub fn layout(binding: u32) -> [wgpu::BindGroupLayoutEntry; 4] {
        stored_runs_layout(binding, wgpu::ShaderStages::FRAGMENT)
    }

    /// The four buffers.
    pub fn entries<'a>(&'a self, geometry: &'a Geometry, binding: u32) -> Vec<wgpu::BindGroupEntry<'a>> {
        let Some(runs) = &geometry.named else { return Vec::new() };
        let buffers = [&self.buffer, &runs.stored, &geometry.indices, &geometry.positions];
        let entry = |(buffer, binding): (&'a wgpu::Buffer, u32)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        };
        buffers.into_iter().zip(binding..).map(entry).collect()
    }

    /// Gives ids to what has come, takes those of what has gone, and uploads where all of them
    /// stand. The first value has each object's first id, 0 without one; the second says whether
    /// the buffer is another one.
    pub fn update(
        &mut self,
        gpu: &Gpu,
        occluders: &mut Occluders,
        geometry: &Geometry,
        pose: &Pose,
        origin: DVec3,
    ) -> Result<(Vec<u32>, bool)> {
        let Some(runs) = &geometry.named else { return Ok((Vec::new(), false)) };
        // What is left over is gone.
        let gone = self.of_objects.len().min(pose.objects.len());
        for (_, occluder) in self.of_objects.drain(gone..).flatten() {
            occluders.remove(occluder)?;
        }
        self.of_objects.resize(pose.objects.len(), None);
        let mut first_ids = vec![0; pose.objects.len()];
        for (index, object) in pose.objects.iter().enumerate() {
            let [first_run, count] = runs.of_meshes[object.mesh];
            let own_from_world = object.world_from_local.inverse();
            let can_be_asked = count > 0 && object.skinned.is_none() && own_from_world.is_finite();
            let kept = &mut self.of_objects[index];
            let stale = kept.filter(|(mesh, _)| !can_be_asked || *mesh != object.mesh);
            if let Some((_, occluder)) = stale {
                occluders.remove(occluder)?;
                *kept = None;
            }
            if !can_be_asked {
                continue;
            }
            let (_, occluder) = match *kept {
                Some(there) => there,
                None => *kept.insert((object.mesh, occluders.insert(count)?)),
            };
            first_ids[index] = occluder.first_id();
            self.slots.resize(self.slots.len().max(occluders.slot_count()), StoredSlot::default());
            let own_from_frame = own_from_world * glam::DAffine3::from_translation(origin);
            let (m, t) = (own_from_frame.matrix3, own_from_frame.translation);
            let [row_x, row_y, row_z] =
                [0, 1, 2].map(|i| [m.x_axis[i], m.y_axis[i], m.z_axis[i], t[i]].map(|number| number as f32));
            for (slot, run) in occluder.runs_of_slots() {
                self.slots[slot as usize] =
                    StoredSlot { row_x, row_y, row_z, first_run: first_run + run, ..StoredSlot::default() };
            }
        }
        let needed = self.slots.len() as u64 * SLOT_BYTES;
        let grows = needed > self.buffer.size();
        if grows {
            gpu.check_storage("the slots of casters", needed)?;
            self.buffer = slot_buffer(gpu, self.slots.len().next_power_of_two() as u64);
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&self.slots));
        Ok((first_ids, grows))
    }
}

fn slot_buffer(gpu: &Gpu, count: u64) -> wgpu::Buffer {
    let limits = gpu.device.limits();
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("Names::slots"),
        size: (count * SLOT_BYTES).min(limits.max_buffer_size).min(limits.max_storage_buffer_binding_size),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of quads whose vertices are shared, `across` wide.
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

    /// Even where all triangles share their few vertices.
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
