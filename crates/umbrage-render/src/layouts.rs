//! Entries of bind group layouts that several passes share.

/// A two-dimensional texture of fragment shaders.
pub(crate) fn texture(binding: u32, sample_type: wgpu::TextureSampleType) -> wgpu::BindGroupLayoutEntry {
    texture_of(binding, sample_type, wgpu::TextureViewDimension::D2, false)
}

/// A texture of fragment shaders with several samples per texel.
pub(crate) fn multisampled(binding: u32, sample_type: wgpu::TextureSampleType) -> wgpu::BindGroupLayoutEntry {
    texture_of(binding, sample_type, wgpu::TextureViewDimension::D2, true)
}

/// A texture array of fragment shaders.
pub(crate) fn texture_array(binding: u32, sample_type: wgpu::TextureSampleType) -> wgpu::BindGroupLayoutEntry {
    texture_of(binding, sample_type, wgpu::TextureViewDimension::D2Array, false)
}

/// Sample type of textures that are loaded from and never filtered.
pub(crate) const UNFILTERED: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };

fn texture_of(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
    multisampled: bool,
) -> wgpu::BindGroupLayoutEntry {
    fragment(binding, wgpu::BindingType::Texture { sample_type, view_dimension, multisampled })
}

/// A resource of fragment shaders.
pub(crate) fn fragment(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None }
}
