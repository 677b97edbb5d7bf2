//! Ids of the objects of a frame, for exact edges, with the objects' transforms.

use glam::DVec3;
use umbrage_scene::Pose;
use umbrage_wgpu::{Occluder, Occluders, StoredSlot, stored_runs_layout};

use crate::geometry::Geometry;
use crate::{Gpu, Result};

/// Bytes of one object's slot in the buffer: its transform and the numbers after it.
const SLOT_BYTES: u64 = size_of::<StoredSlot>() as u64;

/// Ids and transforms of the objects of a frame.
pub(crate) struct Names {
    /// Mesh and ids of each object of the pose; `None` for an object without ids.
    of_objects: Vec<Option<(usize, Occluder)>>,
    slots: Vec<StoredSlot>,
    buffer: wgpu::Buffer,
}

impl Names {
    /// Binding of the first of the four buffers in the frame's group.
    pub const BINDING: u32 = 1;

    pub fn new(gpu: &Gpu) -> Self {
        Self { of_objects: Vec::new(), slots: Vec::new(), buffer: slot_buffer(gpu, 64) }
    }

    /// Returns the layout of the four buffers.
    pub fn layout(binding: u32) -> [wgpu::BindGroupLayoutEntry; 4] {
        stored_runs_layout(binding, wgpu::ShaderStages::FRAGMENT)
    }

    /// Returns the bindings of the four buffers.
    pub fn entries<'a>(&'a self, geometry: &'a Geometry, binding: u32) -> Vec<wgpu::BindGroupEntry<'a>> {
        let Some(runs) = &geometry.named else { return Vec::new() };
        let buffers = [&self.buffer, &runs.stored, &geometry.indices, &geometry.positions];
        let entry = |(buffer, binding): (&'a wgpu::Buffer, u32)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        };
        buffers.into_iter().zip(binding..).map(entry).collect()
    }

    /// Returns the layout of a group of the four buffers alone, for masks.
    pub fn layout_of_mask(gpu: &Gpu) -> wgpu::BindGroupLayout {
        gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Names::layout"),
            entries: &Self::layout(0),
        })
    }

    /// Makes a group of the four buffers alone; `None` without exact edges.
    pub fn group_of_mask(&self, gpu: &Gpu, geometry: &Geometry) -> Option<wgpu::BindGroup> {
        let entries = self.entries(geometry, 0);
        (!entries.is_empty()).then(|| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Names::group"),
                layout: &Self::layout_of_mask(gpu),
                entries: &entries,
            })
        })
    }

    /// Assigns ids to new objects, frees those of removed objects and uploads the table of
    /// transforms. Returns each object's first id (0 without one), and whether the buffer was
    /// replaced.
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
