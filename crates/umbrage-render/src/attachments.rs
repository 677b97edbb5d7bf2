//! Textures that one pass draws into and later ones read, and their attachments.

use crate::Gpu;

/// Makes a texture that passes draw into and later ones read, of so many layers.
pub(crate) fn read_later(
    gpu: &Gpu,
    label: &str,
    (size, layers): ([u32; 2], u32),
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Attachment of a pass that clears a texture to 0, draws and stores.
pub(crate) fn drawn(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
    }
}

/// Attachment of a pass that clears depth to `empty`, draws and stores it.
pub(crate) fn drawn_depth(view: &wgpu::TextureView, empty: f32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(empty), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}
