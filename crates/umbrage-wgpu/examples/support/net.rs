//! A texture of a net, and the bind group layout for it and the bones.

use umbrage_wgpu::wgpu;
use wgpu::util::{DeviceExt, TextureDataOrder};

use super::texture_descriptor;

/// Number of texels along an edge of the texture.
const EDGE: u32 = 32;

/// Bind group layout: bones for vertices; a texture and its sampler for fragments.
pub fn skin_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let bones = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            entry(0, wgpu::ShaderStages::VERTEX, bones),
            entry(1, wgpu::ShaderStages::FRAGMENT, texture),
            entry(2, wgpu::ShaderStages::FRAGMENT, sampler),
        ],
    })
}

/// One mesh of a net, cords along its edges, and a sampler that repeats it.
pub fn net_texture(device: &wgpu::Device, queue: &wgpu::Queue) -> (wgpu::TextureView, wgpu::Sampler) {
    let is_cord = |i: u32| !(4..EDGE - 4).contains(&i);
    let texel = |i: u32| if is_cord(i % EDGE) || is_cord(i / EDGE) { 255 } else { 0 };
    let texels: Vec<u8> = (0..EDGE * EDGE).map(texel).collect();
    let usage = wgpu::TextureUsages::TEXTURE_BINDING;
    let descriptor = texture_descriptor([EDGE, EDGE], wgpu::TextureFormat::R8Unorm, usage);
    let texture = device.create_texture_with_data(queue, &descriptor, TextureDataOrder::LayerMajor, &texels);
    let repeat = device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    (texture.create_view(&Default::default()), repeat)
}
