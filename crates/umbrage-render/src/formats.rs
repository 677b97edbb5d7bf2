//! Formats of what a frame is drawn to, and of what a probe asks and answers in.

/// What the picture is drawn in before it is resolved; the samples of a pixel share one shading.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Red is visibility, green says that a surface was hit.
pub(crate) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;
/// What the eye's depth is drawn in: reversed, 0 infinitely far away.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Points that a probe asks about, with what answers for them.
pub(crate) const POINTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// What comes back for each point of a probe.
pub(crate) const ANSWERS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
