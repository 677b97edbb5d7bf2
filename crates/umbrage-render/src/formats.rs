//! Formats of the textures that a frame is drawn to, and of a probe's.

/// Format of the picture before it is resolved. The samples of a pixel share one shading.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Format of masks: red is visibility, green is 1 where a surface was hit.
pub(crate) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;
/// Format of unit normals for a mask. Sixteen bits would tilt the planes of receivers.
pub(crate) const NORMALS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of the mask that a picture takes its shadows from: red is visibility.
pub(crate) const LIT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
/// Format of light in the G-buffer of a picture with several samples per pixel.
pub(crate) const LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the G-buffer's questions: a normal and the bits of a depth.
pub(crate) const QUESTION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Uint;
/// Format of the depth target in which such a mask marks the pixels that are decided.
pub(crate) const MARK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Format of the eye's depth: reversed, 0 infinitely far away.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of a probe's points and their responders.
pub(crate) const POINTS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of a probe's answers.
pub(crate) const ANSWERS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
