//! Pictures that take the first light's shadows from a mask: depth and normals first, then the
//! mask, then the picture.
//!
//! A forward picture asks for shadows once per fragment, and fragments are run for whole blocks of
//! pixels: where triangles are small, several times per pixel. A mask asks once.

use std::borrow::Cow;

use umbrage::config::{Coordinates, Edges, Layout};
use umbrage_scene::AlphaMode;
use umbrage_wgpu::{MaskFrame, MaskNormals, ShadowMask, Shadows};

use crate::contact::Contact;
use crate::draw_list::{Drawable, Drawn, Show};
use crate::formats::{LIT_FORMAT, MARK_FORMAT, NORMALS_FORMAT, PICTURE_FORMAT};
use crate::forward::{Bindings, Forward, Samples, Shading, bind, pick_pieces};
use crate::materials::{GpuMaterial, Materials};
use crate::surfaces::{Depth, Recipe, Surface, SurfacePipelines, Vertices};
use crate::targets::PictureTarget;
use crate::view_list::ViewList;
use crate::{Gpu, Result, shaders};

/// Pipelines, and what they draw to.
pub(crate) struct ThroughMask {
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

/// Whether pictures can take the first light's shadows from a mask and lose nothing by it: one
/// light, one sample per pixel, and nothing that a pixel's neighbours or vertices have to tell.
pub(crate) fn suits(
    gpu: &Gpu,
    shadows: &Shadows,
    (samples, contact, shading): (Samples, Option<&Contact>, Shading),
) -> bool {
    let (config, maps) = (shadows.config(), shadows.maps());
    shading == Shading::WithShadows
        && samples == Samples::One
        && contact.is_none()
        && gpu.depth_loads()
        && shadows.lights().len() == 1
        && maps.layout() != Layout::Reused
        && maps.edges() == Edges::Sampled
        && config.coordinates != Coordinates::Vertex
        && !config.filter.is_prefiltered()
}

impl ThroughMask {
    /// # Errors
    /// [`crate::Error::Shadows`] if the device cannot make a mask.
    pub fn new(gpu: &Gpu, shadows: &Shadows, forward: &Forward, materials: &Materials) -> Result<Self> {
        let device = &gpu.device;
        let lit_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ThroughMask::lit_layout"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
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
        // Software drivers run what a branch leaves out; on a GPU one draw is less work.
        let in_two_draws = gpu.adapter_info.device_type == wgpu::DeviceType::Cpu;
        let (maps, normals) = (shadows.maps(), MaskNormals::Texture);
        let mask = match in_two_draws {
            true => ShadowMask::in_two_draws(device, maps, LIT_FORMAT, normals, MARK_FORMAT)?,
            false => ShadowMask::new(device, maps, LIT_FORMAT, normals)?,
        };
        // The third of each is never drawn: what is translucent asks for itself.
        Ok(Self {
            facing: recipe("ThroughMask::facing", shaders::facing(), None, Depth::Drawn)
                .pipelines("ThroughMask::facing", [solid, masked, solid]),
            picture: recipe("ThroughMask::picture", text, Some(&lit_layout), Depth::Found).pipelines(
                "ThroughMask::picture",
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
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (normals, lit) = (texture("ThroughMask::normals", NORMALS_FORMAT), texture("ThroughMask::lit", LIT_FORMAT));
        let lit_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("ThroughMask::lit_group"),
            layout: &self.lit_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&lit) }],
        });
        let surfaces = self.mask.bind_group(&gpu.device, &picture.depth, Some(&normals))?;
        let marks = self.in_two_draws.then(|| texture("ThroughMask::marks", MARK_FORMAT));
        Ok(Targets { size, normals, lit, marks, surfaces, lit_group })
    }

    /// Begins the pass for [`ThroughMask::draw_facing`].
    pub fn begin_facing<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        picture: &PictureTarget,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ThroughMask::facing"),
            color_attachments: &[self.attachment(|targets| &targets.normals)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &picture.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
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
        pick_pieces(pass, drawable, solid, &self.facing)
    }

    /// Begins the pass for [`ThroughMask::draw_mask`].
    pub fn begin_mask<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ThroughMask::mask"),
            color_attachments: &[self.attachment(|targets| &targets.lit)],
            depth_stencil_attachment: self.targets.as_ref().and_then(|targets| targets.marks.as_ref()).map(|view| {
                wgpu::RenderPassDepthStencilAttachment {
                    view,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                    stencil_ops: None,
                }
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
        drawable.draw(pass, &solid.runs, Show::Visible, |material: &GpuMaterial, mirrored| {
            (material.alpha != AlphaMode::Blend).then(|| self.picture.of(material, mirrored))
        })
    }

    fn attachment(&self, of: impl Fn(&Targets) -> &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        self.targets.as_ref().map(|targets| wgpu::RenderPassColorAttachment {
            view: of(targets),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })
    }
}
