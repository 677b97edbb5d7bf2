//! Bind groups: the splits for casters; the frame and the maps for receivers.

use umbrage::config::{Filter, Storage};
use umbrage_shaders::layout;

use super::passes::MapPass;
use super::targets::Targets;
use crate::moments::Moments;
use crate::options::sampler_mode;
use crate::{Result, device};

/// Uniforms of one kind in one buffer, each with its bind group.
#[derive(Debug)]
pub(super) struct Uniforms {
    buffer: wgpu::Buffer,
    stride: u64,
    pub layout: wgpu::BindGroupLayout,
    pub groups: Vec<wgpu::BindGroup>,
}

impl Uniforms {
    /// Uniforms of each pass for casters.
    pub fn of_casters(device: &wgpu::Device, passes: &[MapPass]) -> Self {
        let alone = passes.iter().all(MapPass::is_alone);
        let bytes = if alone { size_of::<layout::Split>() } else { size_of::<layout::CasterPass>() } as u64;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ShadowMaps::caster"),
            entries: &[uniform_entry(bytes, wgpu::ShaderStages::VERTEX_FRAGMENT)],
        });
        Self::new(device, "ShadowMaps::caster", layout, bytes, passes.len(), Vec::new())
    }

    /// Uniforms of each region of kept maps for casters, in the layout of a pass of one split.
    pub fn of_regions(device: &wgpu::Device, layout: wgpu::BindGroupLayout, count: usize) -> Self {
        let bytes = size_of::<layout::Split>() as u64;
        Self::new(device, "KeptMaps::caster", layout, bytes, count, Vec::new())
    }

    /// Uniforms and maps for receivers: the frames, once for all splits, and once more for each
    /// split if one map is reused; and the maps.
    pub fn of_receivers(device: &wgpu::Device, it: &Received, targets: &Targets, moments: Option<&Moments>) -> Self {
        let count = if it.storage == Storage::Reused { 1 + it.maps } else { 1 };
        let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let bytes = (it.frames * size_of::<layout::Frame>()) as u64;
        if let Some(moments) = moments {
            return Self::of_moments(device, moments, visibility, bytes);
        }
        let bindings = MapBindings::new(device, it, targets);
        let mut entries = vec![uniform_entry(bytes, visibility)];
        let types = bindings.list.iter().map(|(binding, ty, _)| (*binding, *ty));
        entries.extend(types.map(|(binding, ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }));
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ShadowMaps::receiver"),
            entries: &entries,
        });
        let resources = bindings.list.iter().map(|(binding, _, bound)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: match bound {
                Bound::View(view) => wgpu::BindingResource::TextureView(view),
                Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
            },
        });
        Self::new(device, "ShadowMaps::receiver", layout, bytes, count, resources.collect())
    }

    /// Layout of the bind group for maps of moments.
    fn of_moments(device: &wgpu::Device, moments: &Moments, visibility: wgpu::ShaderStages, bytes: u64) -> Self {
        let mut entries = vec![uniform_entry(bytes, visibility)];
        entries.extend(moments.receiver_entries(visibility));
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ShadowMaps::receiver"),
            entries: &entries,
        });
        let buffer = uniform_buffer(device, "ShadowMaps::receiver", bytes);
        let groups = vec![moments.receiver_bind_group(device, &layout, &buffer)];
        Self { buffer, stride: bytes, layout, groups }
    }

    fn new(
        device: &wgpu::Device,
        label: &str,
        layout: wgpu::BindGroupLayout,
        bytes: u64,
        count: usize,
        resources: Vec<wgpu::BindGroupEntry<'_>>,
    ) -> Self {
        let stride = bytes.next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment));
        let buffer = uniform_buffer(device, label, stride * count as u64);
        let groups = (0..count as u64)
            .map(|index| {
                let uniform = wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &buffer,
                        offset: index * stride,
                        size: wgpu::BufferSize::new(bytes),
                    }),
                };
                let entries: Vec<_> = std::iter::once(uniform).chain(resources.iter().cloned()).collect();
                let layout = &layout;
                device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
            })
            .collect();
        Self { buffer, stride, layout, groups }
    }

    /// Writes the uniforms of group `index`.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`].
    pub fn write<T: bytemuck::NoUninit>(&self, queue: &wgpu::Queue, index: usize, uniforms: &[T]) -> Result<()> {
        device::write(queue, &self.buffer, index as u64 * self.stride, bytemuck::cast_slice(uniforms))
    }
}

/// Resources of receivers, and the way in which they read them.
pub(super) struct Received {
    pub filter: Filter,
    pub storage: Storage,
    /// True if maps are colour textures and not depth textures.
    pub is_colour: bool,
    /// True if shaders can load from depth textures.
    pub loads: bool,
    /// Number of faces of all lights.
    pub frames: usize,
    /// Number of maps of all lights.
    pub maps: usize,
}

enum Bound {
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

/// The maps as `shaders/maps` of `umbrage-shaders` bind them.
struct MapBindings {
    list: Vec<(u32, wgpu::BindingType, Bound)>,
}

impl MapBindings {
    fn new(device: &wgpu::Device, it: &Received, targets: &Targets) -> Self {
        use wgpu::TextureViewDimension::{Cube, D2, D2Array};
        let (colour, loads) = (it.is_colour, it.loads);
        let sample_type = match colour {
            true => wgpu::TextureSampleType::Float { filterable: false },
            false => wgpu::TextureSampleType::Depth,
        };
        let map = |binding, map: usize, view_dimension| {
            let view = targets.maps[map].create_view(&wgpu::TextureViewDescriptor {
                label: Some("ShadowMaps::maps"),
                dimension: Some(view_dimension),
                ..Default::default()
            });
            let ty = wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
            (binding, ty, Bound::View(view))
        };
        // Behind the maps: `UMBRAGE_IDS_BINDING` of `umbrage_shaders::receiver`.
        let (first, view_dimension) = match it.storage {
            Storage::Separate => (3 + targets.maps.len() as u32, D2),
            Storage::Cube => (4, D2Array),
            _ => (3, D2Array),
        };
        let ids = targets.ids.iter().zip(first..).map(|(ids, binding)| {
            let view = ids.create_view(&wgpu::TextureViewDescriptor {
                label: Some("ShadowMaps::ids"),
                dimension: Some(view_dimension),
                ..Default::default()
            });
            let sample_type = wgpu::TextureSampleType::Uint;
            let ty = wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
            (binding, ty, Bound::View(view))
        });
        let mut list: Vec<_> = match it.storage {
            Storage::Separate => (0..targets.maps.len()).map(|index| map(3 + index as u32, index, D2)).collect(),
            Storage::Cube if loads && !colour => vec![map(1, 0, Cube), map(3, 0, D2Array)],
            Storage::Cube => vec![map(1, 0, Cube)],
            _ => vec![map(1, 0, D2Array)],
        };
        let sampler = match (colour, it.storage) {
            (false, _) => Some(wgpu::SamplerBindingType::Comparison),
            (true, Storage::Cube) => Some(wgpu::SamplerBindingType::NonFiltering),
            (true, _) => None,
        };
        if let Some(kind) = sampler {
            list.push((2, wgpu::BindingType::Sampler(kind), Bound::Sampler(self::sampler(device, &it.filter, kind))));
        }
        list.extend(ids);
        Self { list }
    }
}

fn sampler(device: &wgpu::Device, filter: &Filter, kind: wgpu::SamplerBindingType) -> wgpu::Sampler {
    let compares = kind == wgpu::SamplerBindingType::Comparison;
    let filter = if compares { sampler_mode(filter) } else { wgpu::FilterMode::Nearest };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("ShadowMaps::sampler"),
        address_mode_u: wgpu::AddressMode::ClampToEdge,
        address_mode_v: wgpu::AddressMode::ClampToEdge,
        mag_filter: filter,
        min_filter: filter,
        compare: compares.then_some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    })
}

fn uniform_buffer(device: &wgpu::Device, label: &str, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Layout entry of a uniform at binding 0.
fn uniform_entry(bytes: u64, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(bytes),
        },
        count: None,
    }
}
