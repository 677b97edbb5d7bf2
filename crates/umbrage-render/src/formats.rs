//! Formats of what a frame is drawn to.

/// What the picture is drawn in before it is resolved; the samples of a pixel share one shading.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Red is visibility, green says that a surface was hit.
pub(crate) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;
/// Unit normals for a mask. Sixteen bits would turn planes by a millimetre within a texel.
pub(crate) const NORMALS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// What the first light reaches, for a picture.
pub(crate) const LIT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
/// What the eye's depth is drawn in: reversed, 0 infinitely far away.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
