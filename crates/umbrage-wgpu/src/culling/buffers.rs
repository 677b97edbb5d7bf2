//! GPU buffers for culling.

use umbrage::glam::Vec4;
use umbrage::{CasterMask, CasterTest};
use umbrage_shaders::layout::{CullDraw, CullFrame, CullMesh as Places, CullSplit};

use super::CullMesh;
use crate::{Error, Result, device};

/// Number of storage buffers that the shader binds.
pub(super) const STORAGE_BUFFERS: u32 = 7;

/// Most half spaces of a split's test: those of a swept slice, two along each direction of the
/// planner's fan, and one along depth.
const MOST_PLANES: usize = 18 + 2 * 32 + 1;

/// Number of cells of a mask.
const CELLS: usize = CasterMask::EDGE * CasterMask::EDGE;

/// The buffers, bound in this order, beginning with the frame's. The boxes, which are the
/// application's, are bound at 4, after `lowest`.
#[derive(Debug)]
pub(super) struct Buffers {
    frame: wgpu::Buffer,
    splits: wgpu::Buffer,
    planes: wgpu::Buffer,
    lowest: wgpu::Buffer,
    meshes: wgpu::Buffer,
    pub draws: wgpu::Buffer,
    pub ids: wgpu::Buffer,
    /// Number of places in each split.
    pub room: u32,
    /// Range of places of each mesh.
    places: Vec<Places>,
}

impl Buffers {
    pub fn new(device: &wgpu::Device, splits: usize, meshes: &[CullMesh]) -> Result<Self> {
        use wgpu::BufferUsages as Usage;
        let (mut first, mut room) = (Vec::with_capacity(meshes.len()), 0_u32);
        for mesh in meshes {
            first.push(room);
            room += mesh.instances;
        }
        let places: Vec<Places> =
            first.iter().zip(meshes).map(|(&first, mesh)| Places { first, room: mesh.instances }).collect();
        let limit = device.limits().max_storage_buffer_binding_size.min(device.limits().max_buffer_size);
        let buffer = |label, bytes: usize, usage| {
            let bytes = bytes as u64;
            // A device without compute shaders may bind no storage buffer at all.
            if super::can_compute(device) && bytes > limit {
                return Err(Error::CullingTooLarge { what: label, bytes, limit });
            }
            Ok(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage: usage | Usage::COPY_DST,
                mapped_at_creation: false,
            }))
        };
        let storage = if super::can_compute(device) { Usage::STORAGE } else { Usage::empty() };
        let indirect = if super::can_compute(device) { Usage::INDIRECT } else { Usage::empty() };
        let draws = splits * meshes.len() * size_of::<CullDraw>();
        let own = Self {
            frame: buffer("InstanceCulling::frame", size_of::<CullFrame>(), Usage::UNIFORM)?,
            splits: buffer("InstanceCulling::splits", splits * size_of::<CullSplit>(), storage)?,
            planes: buffer("InstanceCulling::planes", splits * MOST_PLANES * size_of::<Vec4>(), storage)?,
            lowest: buffer("InstanceCulling::lowest", splits * CELLS * size_of::<f32>(), storage)?,
            meshes: buffer("InstanceCulling::meshes", size_of_val(places.as_slice()), storage)?,
            draws: buffer("InstanceCulling::draws", draws, storage | indirect | Usage::COPY_SRC)?,
            ids: buffer(
                "InstanceCulling::ids",
                splits * room as usize * size_of::<u32>(),
                storage | Usage::VERTEX | Usage::COPY_SRC,
            )?,
            room,
            places,
        };
        Ok(own)
    }

    /// Writes a frame.
    pub fn write(
        &self,
        queue: &wgpu::Queue,
        frame: &CullFrame,
        tests: &[CasterTest],
        draws: &[CullDraw],
    ) -> Result<()> {
        let (mut splits, mut planes) = (Vec::with_capacity(tests.len()), Vec::<Vec4>::new());
        for (index, test) in tests.iter().enumerate() {
            let first_plane = planes.len() as u32;
            planes.extend(&test.planes);
            splits.push(split(test, first_plane));
            if let Some(mask) = &test.mask {
                let offset = (index * CELLS * size_of::<f32>()) as u64;
                device::write(queue, &self.lowest, offset, bytemuck::cast_slice(&mask.lowest))?;
            }
        }
        let planes: Vec<[f32; 4]> = planes.iter().map(Vec4::to_array).collect();
        device::write(queue, &self.frame, 0, bytemuck::bytes_of(frame))?;
        device::write(queue, &self.splits, 0, bytemuck::cast_slice(&splits))?;
        device::write(queue, &self.planes, 0, bytemuck::cast_slice(&planes))?;
        device::write(queue, &self.meshes, 0, bytemuck::cast_slice(&self.places))?;
        self.write_draws(queue, draws)
    }

    /// Writes the arguments of all draws.
    pub fn write_draws(&self, queue: &wgpu::Queue, draws: &[CullDraw]) -> Result<()> {
        device::write(queue, &self.draws, 0, bytemuck::cast_slice(draws))
    }

    /// Byte offset at which the numbers of a mesh's instances begin in a split.
    pub fn offset(&self, split: usize, mesh: usize) -> u64 {
        let place = split as u64 * u64::from(self.room) + u64::from(self.places[mesh].first);
        place * size_of::<u32>() as u64
    }

    /// Memory of all buffers in bytes.
    pub fn bytes(&self) -> u64 {
        let all = [&self.frame, &self.splits, &self.planes, &self.lowest, &self.meshes, &self.draws, &self.ids];
        all.map(wgpu::Buffer::size).iter().sum()
    }

    /// Bind group layout of the shader.
    pub fn layout(&self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let storage = |binding, read_only| entry(binding, wgpu::BufferBindingType::Storage { read_only });
        let mut entries = vec![entry(0, wgpu::BufferBindingType::Uniform)];
        entries.extend((1..=STORAGE_BUFFERS).map(|binding| storage(binding, binding < 6)));
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("InstanceCulling::layout"),
            entries: &entries,
        })
    }

    /// The bind group with the application's boxes.
    pub fn group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        boxes: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let bound =
            [&self.frame, &self.splits, &self.planes, &self.lowest, boxes, &self.meshes, &self.draws, &self.ids];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(bound)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("InstanceCulling::group"),
            layout,
            entries: &entries,
        })
    }
}

/// A test in the form that the shader reads, without its half spaces and its mask's cells.
fn split(test: &CasterTest, first_plane: u32) -> CullSplit {
    let mut split =
        CullSplit { first_plane, plane_count: test.planes.len() as u32, mask_axis: 3, ..Default::default() };
    if let Some(below) = &test.below {
        split.has_receivers = 1;
        split.direction = below.direction.to_array();
        split.receivers_min = below.min.to_array();
        split.receivers_max = below.max.to_array();
        (split.slack, split.margin) = (below.slack, below.margin);
    }
    if let Some(mask) = &test.mask {
        (split.mask_axis, split.mask_sign) = (mask.axis, mask.sign);
        split.mask_begin = mask.begin.to_array();
        split.mask_cell = mask.cell.to_array();
        split.mask_slope = mask.slope.to_array();
    }
    split
}
