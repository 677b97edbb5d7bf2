//! Contact shadows: the picture's depth is drawn before every pass that looks them up.

use glam::DVec3;
use umbrage::{ShadowConfig, View};
use umbrage_wgpu::{ContactFrame, ContactOptions, ContactShadows};

use crate::attachments::{drawn_depth, read_later};
use crate::formats::DEPTH_FORMAT;
use crate::{Gpu, Result};

/// GPU objects of contact shadows.
pub(crate) struct Contact {
    /// Uniform buffer and layout of the contact shadows.
    pub shadows: ContactShadows,
    /// Bind group for the passes that look up contact shadows.
    pub bind_group: wgpu::BindGroup,
    options: ContactOptions,
    depth: wgpu::TextureView,
    height: u32,
}

impl Contact {
    /// Makes the contact shadows if the config asks for them and the device can load depth texels.
    pub fn wanted(gpu: &Gpu, config: &ShadowConfig, size: [u32; 2]) -> Option<Self> {
        (config.look.contact && gpu.depth_loads()).then(|| Self::new(gpu, size, ContactOptions::default()))
    }

    /// Makes the contact shadows of pictures of `size` pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2], options: ContactOptions) -> Self {
        let shadows = ContactShadows::new(&gpu.device);
        let texture = read_later(gpu, "Contact::depth", (size, 1), DEPTH_FORMAT, 1);
        let depth = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bind_group = shadows.bind_group(&gpu.device, &depth);
        Self { shadows, bind_group, options, depth, height: size[1] }
    }

    /// Uploads the view and the origin of a frame.
    pub fn prepare(&self, gpu: &Gpu, view: &View, origin: DVec3) -> Result<()> {
        let frame = ContactFrame {
            clip_from_eye: view.clip_from_relative(view.eye()),
            eye: view.eye(),
            forward: view.forward(),
            origin,
            height: self.height,
        };
        Ok(self.shadows.prepare(&gpu.queue, &frame, &self.options)?)
    }

    /// Begins the pass that draws the depth.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("Contact::pass"),
            color_attachments: &[],
            depth_stencil_attachment: Some(drawn_depth(&self.depth, 0.0)),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}
