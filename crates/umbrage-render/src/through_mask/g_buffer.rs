//! Several samples per pixel: surfaces without shadows first, then a mask for each sample, which
//! asks only for what no earlier sample of the pixel shows, then the picture.

use std::borrow::Cow;

use umbrage_wgpu::{MaskFrame, ShadowMask, Shadows};

use crate::attachments::{drawn, drawn_depth, read_later};
use crate::draw_list::{Drawable, Drawn, Show};
use crate::formats::{
    DEPTH_FORMAT, LIGHT_FORMAT, LIT_FORMAT, MARK_FORMAT, NORMALS_FORMAT, PICTURE_FORMAT, QUESTION_FORMAT,
};
use crate::forward::{Bindings, Forward, Samples, shade};
use crate::layouts::{self, UNFILTERED};
use crate::materials::Materials;
use crate::surfaces::{Depth, Recipe, Surface, SurfacePipelines};
use crate::targets::PictureTarget;
use crate::view_list::ViewList;
use crate::{Gpu, Result, shaders};

/// Pipelines, and the textures that they draw to.
pub(crate) struct GBuffer {
    samples: u32,
    surfaces: SurfacePipelines,
    /// Layout of the questions.
    questions_layout: wgpu::BindGroupLayout,
    /// Layout of light and answers.
    shown_layout: wgpu::BindGroupLayout,
    asked: wgpu::RenderPipeline,
    answered: wgpu::RenderPipeline,
    shown: wgpu::RenderPipeline,
    mask: ShadowMask,
    /// Made when a picture is wanted.
    targets: Option<Targets>,
}

struct Targets {
    size: [u32; 2],
    /// Light that shadows leave, light that they may take, and questions, of each sample.
    surfaces: [wgpu::TextureView; 3],
    /// Depth and normals of one sample of each pixel.
    asked: [wgpu::TextureView; 2],
    /// The mask of each sample.
    answers: Vec<wgpu::TextureView>,
    /// Marks of the mask that is drawn.
    marks: wgpu::TextureView,
    questions_group: wgpu::BindGroup,
    asked_group: wgpu::BindGroup,
    shown_group: wgpu::BindGroup,
}

impl GBuffer {
    /// # Errors
    /// [`crate::Error::Shadows`] if the device cannot make a mask.
    pub fn new(
        gpu: &Gpu,
        shadows: &Shadows,
        (forward, materials): (&Forward, &Materials),
        samples: Samples,
    ) -> Result<Self> {
        let device = &gpu.device;
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let questions = [layouts::multisampled(0, wgpu::TextureSampleType::Uint)];
        let questions_layout = layout("GBuffer::questions_layout", &questions);
        let shown = [
            layouts::multisampled(1, UNFILTERED),
            layouts::multisampled(2, UNFILTERED),
            layouts::texture_array(3, UNFILTERED),
        ];
        let shown_layout = layout("GBuffer::shown_layout", &shown);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("GBuffer::shader"),
            source: wgpu::ShaderSource::Wgsl(Cow::Owned(shaders::g_buffer())),
        });
        let surface = |entry| Surface {
            fragment_entry: Some(entry),
            format: Some(LIGHT_FORMAT),
            more: &[LIGHT_FORMAT, QUESTION_FORMAT],
            samples: samples.count(),
            ..Surface::default()
        };
        let [solid, masked] = ["fs_surface_opaque", "fs_surface_masked"].map(surface);
        let masked = Surface { alpha_to_coverage: true, ..masked };
        let surface_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("GBuffer::surface_layout"),
            bind_group_layouts: &[Some(forward.frame_layout()), Some(&materials.layout)],
            immediate_size: 0,
        });
        let constants = vec![("LEAST_COVERAGE", samples.least_coverage())];
        let recipe = Recipe { constants, depth: Depth::Drawn, ..Recipe::new(gpu, surface_layout, module.clone()) };
        let full_screen = |label, entry, group: &wgpu::BindGroupLayout, format: wgpu::TextureFormat, depth, samples| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(forward.frame_layout()), None, Some(group)],
                immediate_size: 0,
            });
            let (depth_format, writes) = depth;
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs_sample"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: depth_format,
                    depth_write_enabled: Some(writes),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let (mask, _) = super::mask(gpu, shadows)?;
        Ok(Self {
            samples: samples.count(),
            // The third is never drawn: what is translucent asks for itself.
            surfaces: recipe.pipelines("GBuffer::surfaces", [solid, masked, solid]),
            asked: full_screen(
                "GBuffer::asked",
                "fs_asked",
                &questions_layout,
                NORMALS_FORMAT,
                (DEPTH_FORMAT, true),
                1,
            ),
            answered: full_screen(
                "GBuffer::answered",
                "fs_answered",
                &questions_layout,
                LIT_FORMAT,
                (MARK_FORMAT, true),
                1,
            ),
            shown: full_screen(
                "GBuffer::shown",
                "fs_shown",
                &shown_layout,
                PICTURE_FORMAT,
                (DEPTH_FORMAT, false),
                samples.count(),
            ),
            questions_layout,
            shown_layout,
            mask,
            targets: None,
        })
    }

    /// Hands the frame's camera over, and makes what is drawn to for pictures of this size.
    ///
    /// # Errors
    /// [`crate::Error::Shadows`] if the camera has no inverse.
    pub fn prepare(&mut self, gpu: &Gpu, frame: &MaskFrame, size: [u32; 2]) -> Result<()> {
        self.mask.prepare(&gpu.queue, frame)?;
        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(self.targets(gpu, size)?);
        }
        Ok(())
    }

    /// Lets go of what belongs to a picture that is made anew.
    pub fn forget_picture(&mut self) {
        self.targets = None;
    }

    fn targets(&self, gpu: &Gpu, size: [u32; 2]) -> Result<Targets> {
        let view = |texture: wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let texture = |label, format, samples| view(read_later(gpu, label, (size, 1), format, samples));
        let surfaces = [
            texture("GBuffer::kept_light", LIGHT_FORMAT, self.samples),
            texture("GBuffer::direct_light", LIGHT_FORMAT, self.samples),
            texture("GBuffer::questions", QUESTION_FORMAT, self.samples),
        ];
        let asked = [texture("GBuffer::depth", DEPTH_FORMAT, 1), texture("GBuffer::normals", NORMALS_FORMAT, 1)];
        let marks = texture("GBuffer::marks", MARK_FORMAT, 1);
        let all = read_later(gpu, "GBuffer::answers", (size, self.samples), LIT_FORMAT, 1);
        let answers = (0..self.samples).map(|sample| {
            all.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: sample,
                array_layer_count: Some(1),
                ..Default::default()
            })
        });
        let answers = answers.collect();
        let group = |label, layout, views: &[(u32, &wgpu::TextureView)]| {
            let entry =
                |&(binding, view)| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
            let entries: Vec<wgpu::BindGroupEntry<'_>> = views.iter().map(entry).collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
        };
        let [kept, direct, questions] = &surfaces;
        let shown = [(1, kept), (2, direct), (3, &view(all))];
        Ok(Targets {
            size,
            questions_group: group("GBuffer::questions_group", &self.questions_layout, &[(0, questions)]),
            shown_group: group("GBuffer::shown_group", &self.shown_layout, &shown),
            asked_group: self.mask.bind_group(&gpu.device, &asked[0], Some(&asked[1]))?,
            surfaces,
            asked,
            answers,
            marks,
        })
    }

    /// Begins the pass for [`GBuffer::draw_surfaces`].
    pub fn begin_surfaces<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        picture: &PictureTarget,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let color: Vec<_> = self.targets.iter().flat_map(|targets| &targets.surfaces).map(drawn).map(Some).collect();
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("GBuffer::surfaces"),
            color_attachments: &color,
            depth_stencil_attachment: Some(drawn_depth(&picture.depth, 0.0)),
            timestamp_writes,
            ..Default::default()
        })
    }

    /// Draws everything solid.
    pub fn draw_surfaces(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        frame: &wgpu::BindGroup,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        pass.set_bind_group(0, frame, &[]);
        shade(pass, drawable, solid, (Show::Surfaces, &self.surfaces))
    }

    /// Begins the pass for [`GBuffer::draw_asked`].
    pub fn begin_asked<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("GBuffer::asked"),
            color_attachments: &[self.targets.as_ref().map(|targets| drawn(&targets.asked[1]))],
            depth_stencil_attachment: self.targets.as_ref().map(|targets| drawn_depth(&targets.asked[0], 0.0)),
            timestamp_writes,
            ..Default::default()
        })
    }

    /// Draws depth and normals of one sample of each pixel.
    pub fn draw_asked(&self, pass: &mut wgpu::RenderPass<'_>, frame: &wgpu::BindGroup, sample: u32) {
        let Some(targets) = &self.targets else { return };
        draw_samples(pass, &self.asked, (frame, &targets.questions_group), sample..sample + 1);
    }

    /// Begins the pass for [`GBuffer::draw_mask`].
    pub fn begin_mask<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        sample: u32,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("GBuffer::mask"),
            color_attachments: &[self.targets.as_ref().map(|targets| drawn(&targets.answers[sample as usize]))],
            depth_stencil_attachment: self.targets.as_ref().map(|targets| drawn_depth(&targets.marks, 1.0)),
            timestamp_writes,
            ..Default::default()
        })
    }

    /// Draws what the first light reaches of one sample of each pixel.
    pub fn draw_mask(&self, pass: &mut wgpu::RenderPass<'_>, frame: &wgpu::BindGroup, shadows: &Shadows, sample: u32) {
        let Some(targets) = &self.targets else { return };
        draw_samples(pass, &self.answered, (frame, &targets.questions_group), sample..sample + 1);
        self.mask.draw(pass, shadows.maps(), &targets.asked_group);
    }

    /// Draws the picture of everything solid.
    pub fn draw_shown(&self, pass: &mut wgpu::RenderPass<'_>, bindings: Bindings<'_>) -> Drawn {
        if let Some(targets) = &self.targets {
            draw_samples(pass, &self.shown, (bindings.frame, &targets.shown_group), 0..self.samples);
        }
        Drawn::default()
    }
}

/// Draws one triangle over the whole picture for each sample.
fn draw_samples(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    (frame, group): (&wgpu::BindGroup, &wgpu::BindGroup),
    samples: std::ops::Range<u32>,
) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, frame, &[]);
    pass.set_bind_group(2, group, &[]);
    pass.draw(0..3, samples);
}
