//! One sample per pixel: depth and normals first, then the mask, then the picture.

use std::borrow::Cow;

use umbrage::config::Coordinates;
use umbrage_wgpu::{MaskFrame, ShadowMask, Shadows};

use crate::attachments::{drawn, drawn_depth, read_later};
use crate::draw_list::{Drawable, Drawn, Show};
use crate::formats::{LIT_FORMAT, MARK_FORMAT, NORMALS_FORMAT, PICTURE_FORMAT};
use crate::forward::{Bindings, Forward, Samples, bind, draw_pieces, shade};
use crate::layouts::{self, UNFILTERED};
use crate::materials::Materials;
use crate::surfaces::{Depth, Recipe, Surface, SurfacePipelines, Vertices};
use crate::targets::PictureTarget;
use crate::view_list::ViewList;
use crate::{Gpu, Result, shaders};

/// Pipelines, and what they draw to.
pub(crate) struct PerPixel {
    facing: SurfacePipelines,
    picture: SurfacePipelines,
    lit_layout: wgpu::BindGroupLayout,
    mask: ShadowMask,
    in_two_draws: bool,
    /// Made for a picture's depth, when a picture is wanted.
    targets: Option<Targets>,
}

struct Targets {
    size: [u32; 2],
    normals: wgpu::TextureView,
    lit: wgpu::TextureView,
    /// Marks of a mask in two draws.
    marks: Option<wgpu::TextureView>,
    /// Depth and normals, for the mask.
    surfaces: wgpu::BindGroup,
    /// The mask, for the picture.
    lit_group: wgpu::BindGroup,
}

impl PerPixel {
    /// # Errors
    /// [`crate::Error::Shadows`] if the device cannot make a mask.
    pub fn new(gpu: &Gpu, shadows: &Shadows, forward: &Forward, materials: &Materials) -> Result<Self> {
        let device = &gpu.device;
        let lit_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("PerPixel::lit_layout"),
            entries: &[layouts::texture(0, UNFILTERED)],
        });
        let recipe = |label, text: String, lit: Option<&wgpu::BindGroupLayout>, depth| {
            let groups = [Some(forward.frame_layout()), Some(&materials.layout), lit];
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &groups[..if lit.is_some() { 3 } else { 2 }],
                immediate_size: 0,
            });
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(Cow::Owned(text)),
            });
            let constants = vec![("LEAST_COVERAGE", Samples::One.least_coverage())];
            Recipe { constants, depth, ..Recipe::new(gpu, layout, module) }
        };
        let facing = |entry| Surface {
            vertex: Vertices::Facing,
            fragment_entry: Some(entry),
            format: Some(NORMALS_FORMAT),
            ..Surface::default()
        };
        let picture =
            |entry| Surface { fragment_entry: Some(entry), format: Some(PICTURE_FORMAT), ..Surface::default() };
        let [solid, masked] = ["fs_facing", "fs_facing_masked"].map(facing);
        let text = shaders::forward(shaders::LIT, Coordinates::World, false);
        let (mask, in_two_draws) = super::mask(gpu, shadows)?;
        // The third of each is never drawn: what is translucent asks for itself.
        Ok(Self {
            facing: recipe("PerPixel::facing", shaders::facing(), None, Depth::Drawn)
                .pipelines("PerPixel::facing", [solid, masked, solid]),
            picture: recipe("PerPixel::picture", text, Some(&lit_layout), Depth::Found).pipelines(
                "PerPixel::picture",
                ["fs_picture_opaque", "fs_picture_masked", "fs_picture_opaque"].map(picture),
            ),
            mask,
            in_two_draws,
            lit_layout,
            targets: None,
        })
    }

    /// Hands the frame's camera over, and makes what is drawn to for pictures of this size.
    ///
    /// # Errors
    /// [`crate::Error::Shadows`] if the camera has no inverse.
    pub fn prepare(&mut self, gpu: &Gpu, frame: &MaskFrame, size: [u32; 2], picture: &PictureTarget) -> Result<()> {
        self.mask.prepare(&gpu.queue, frame)?;
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(self.targets(gpu, size, picture)?);
        }
        Ok(())
    }

    /// Lets go of what belongs to a picture that is made anew.
    pub fn forget_picture(&mut self) {
        self.targets = None;
    }

    fn targets(&self, gpu: &Gpu, size: [u32; 2], picture: &PictureTarget) -> Result<Targets> {
        let texture = |label, format| {
            read_later(gpu, label, (size, 1), format, 1).create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (normals, lit) = (texture("PerPixel::normals", NORMALS_FORMAT), texture("PerPixel::lit", LIT_FORMAT));
        let lit_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("PerPixel::lit_group"),
            layout: &self.lit_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&lit) }],
        });
        let surfaces = self.mask.bind_group(&gpu.device, &picture.depth, Some(&normals))?;
        let marks = self.in_two_draws.then(|| texture("PerPixel::marks", MARK_FORMAT));
        Ok(Targets { size, normals, lit, marks, surfaces, lit_group })
    }

    /// Begins the pass for [`PerPixel::draw_facing`].
    pub fn begin_facing<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        picture: &PictureTarget,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("PerPixel::facing"),
            color_attachments: &[self.targets.as_ref().map(|targets| drawn(&targets.normals))],
            depth_stencil_attachment: Some(drawn_depth(&picture.depth, 0.0)),
            timestamp_writes,
            ..Default::default()
        })
    }

    /// Draws depth and normals of everything solid.
    pub fn draw_facing(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        frame: &wgpu::BindGroup,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        pass.set_bind_group(0, frame, &[]);
        draw_pieces(pass, drawable, (solid, Show::Surfaces), &self.facing)
    }

    /// Begins the pass for [`PerPixel::draw_mask`].
    pub fn begin_mask<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("PerPixel::mask"),
            color_attachments: &[self.targets.as_ref().map(|targets| drawn(&targets.lit))],
            depth_stencil_attachment: self.targets.as_ref().and_then(|targets| {
                let marks = targets.marks.as_ref()?;
                Some(drawn_depth(marks, 1.0))
            }),
            timestamp_writes,
            ..Default::default()
        })
    }

    /// Draws what the first light reaches.
    pub fn draw_mask(&self, pass: &mut wgpu::RenderPass<'_>, shadows: &Shadows) {
        if let Some(targets) = &self.targets {
            self.mask.draw(pass, shadows.maps(), &targets.surfaces);
        }
    }

    /// Draws everything solid in a pass that has its depth.
    pub fn draw_solid(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        let Some(targets) = &self.targets else { return Drawn::default() };
        bind(pass, Bindings { maps: &targets.lit_group, ..bindings });
        shade(pass, drawable, solid, (Show::Visible, &self.picture))
    }
}
