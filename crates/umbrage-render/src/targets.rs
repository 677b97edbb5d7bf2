//! The textures that the eye's passes draw into.

use crate::Gpu;
use crate::formats::{DEPTH_FORMAT, PICTURE_FORMAT};
use crate::forward::Samples;

/// Place of a pass among the passes that draw one target together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    /// True if the pass clears the target.
    pub first: bool,
    /// True if the pass resolves samples. Nothing is kept for a later pass.
    pub last: bool,
    /// True if depth is there already and stays as it is.
    pub has_depth: bool,
}

impl Turn {
    /// Turn of a pass that is the only one.
    pub const ONLY: Self = Self { first: true, last: true, has_depth: false };
    /// Turn of the only pass after one that drew depth.
    pub const OVER_DEPTH: Self = Self { has_depth: true, ..Self::ONLY };
}

/// The textures that a picture is drawn into.
pub(crate) struct PictureTarget {
    /// The resolved picture.
    pub texture: wgpu::Texture,
    resolved: wgpu::TextureView,
    /// Texture with several samples per pixel, which is resolved.
    samples: Option<wgpu::TextureView>,
    pub depth: wgpu::TextureView,
    /// True if depth is kept for later passes.
    pub keeps_depth: bool,
}

impl PictureTarget {
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: Samples) -> Self {
        let texture = target_texture(gpu, "PictureTarget::resolved", size, PICTURE_FORMAT, 1);
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let count = samples.count();
        let several = (count > 1).then(|| target_texture(gpu, "PictureTarget::samples", size, PICTURE_FORMAT, count));
        let depth = target_texture(gpu, "PictureTarget::depth", size, DEPTH_FORMAT, count);
        Self {
            resolved: view(&texture),
            samples: several.as_ref().map(view),
            depth: view(&depth),
            keeps_depth: false,
            texture,
        }
    }

    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        turn: Turn,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let (color, resolve_target) = match &self.samples {
            Some(samples) => (samples, turn.last.then_some(&self.resolved)),
            None => (&self.resolved, None),
        };
        let target = Target { label: "PictureTarget::pass", color, resolve_target, clear: wgpu::Color::BLACK };
        begin(encoder, target, (&self.depth, self.keeps_depth), turn, timestamp_writes)
    }
}

/// The textures that a mask is drawn into.
pub(crate) struct MaskTarget {
    /// The mask.
    pub texture: wgpu::Texture,
    /// View of the mask that passes draw into.
    pub color: wgpu::TextureView,
    /// Depth, which is kept for later passes.
    pub depth: wgpu::TextureView,
}

impl MaskTarget {
    /// Makes the textures. `format` is that of masks, or of other numbers of pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let texture = target_texture(gpu, "MaskTarget::pixels", size, format, 1);
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let depth = target_texture(gpu, "MaskTarget::depth", size, DEPTH_FORMAT, 1);
        Self { color: view(&texture), depth: view(&depth), texture }
    }

    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        turn: Turn,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let clear = wgpu::Color::TRANSPARENT;
        let target = Target { label: "MaskTarget::pass", color: &self.color, resolve_target: None, clear };
        begin(encoder, target, (&self.depth, true), turn, timestamp_writes)
    }
}

fn target_texture(
    gpu: &Gpu,
    label: &str,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let read_back = sample_count == 1 && format != DEPTH_FORMAT;
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: match (read_back, format) {
            (true, _) => usage | wgpu::TextureUsages::COPY_SRC,
            (false, DEPTH_FORMAT) => usage | wgpu::TextureUsages::TEXTURE_BINDING,
            (false, _) => usage,
        },
        view_formats: &[],
    })
}

/// Colour attachment of a pass.
struct Target<'a> {
    label: &'static str,
    color: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
    /// Colour that the attachment is cleared to.
    clear: wgpu::Color,
}

fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    target: Target<'_>,
    (depth, keep_depth): (&wgpu::TextureView, bool),
    turn: Turn,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) -> wgpu::RenderPass<'e> {
    let Target { label, color, resolve_target, clear } = target;
    let keep_samples = if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let keep_depth = if turn.last && !keep_depth { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let load = if turn.first { wgpu::LoadOp::Clear(clear) } else { wgpu::LoadOp::Load };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations { load, store: keep_samples },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: if turn.first && !turn.has_depth { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                store: keep_depth,
            }),
            stencil_ops: None,
        }),
        timestamp_writes,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
