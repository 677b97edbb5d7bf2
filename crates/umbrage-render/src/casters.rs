//! The pipelines that draw casters into the maps of a pass.

use std::borrow::Cow;
use std::num::NonZeroU32;
use std::sync::OnceLock;

use umbrage::config::Translucent;
use umbrage_scene::AlphaMode;
use umbrage_wgpu::ShadowMaps;

use crate::draw_list::{Drawable, Drawn, Run, Show, vertex_layouts};
use crate::materials::Materials;
use crate::{Gpu, shaders};

/// Pipelines of the shadow passes, made when they are first needed.
pub(crate) struct Casters {
    gpu: Gpu,
    recipe: Recipe,
    layout: wgpu::PipelineLayout,
    opaque: OnceLock<wgpu::RenderPipeline>,
    masked: OnceLock<wgpu::RenderPipeline>,
    dithered: OnceLock<wgpu::RenderPipeline>,
}

/// Everything that the pipelines depend on.
#[derive(PartialEq)]
struct Recipe {
    /// True if triangles are named.
    is_named: bool,
    /// WGSL of opaque casters, of casters with holes, and of translucent casters if they cast.
    opaque: String,
    masked: String,
    dithered: Option<String>,
    primitive: wgpu::PrimitiveState,
    depth_stencil: wgpu::DepthStencilState,
    multisample: wgpu::MultisampleState,
    targets: Vec<Option<wgpu::ColorTargetState>>,
    multiview_mask: Option<NonZeroU32>,
}

impl Recipe {
    fn new(maps: &ShadowMaps, translucent: Translucent) -> Self {
        let is_named = maps.edges().is_exact();
        let is_dithered = translucent == Translucent::Dithered;
        Self {
            is_named,
            opaque: match is_named {
                true => shaders::named_casters(&maps.caster_wgsl(0)),
                false => shaders::casters(&maps.caster_wgsl(0)),
            },
            masked: shaders::masked_casters(&maps.caster_wgsl_with(0, shaders::MASKED_MEMBERS)),
            dithered: is_dithered
                .then(|| shaders::dithered_casters(&maps.caster_wgsl_with(0, shaders::DITHERED_MEMBERS))),
            primitive: maps.caster_primitive(),
            depth_stencil: maps.caster_depth_stencil(),
            multisample: maps.caster_multisample(),
            targets: maps.caster_targets().to_vec(),
            multiview_mask: maps.caster_multiview_mask(),
        }
    }
}

impl Casters {
    pub fn new(gpu: &Gpu, maps: &ShadowMaps, materials: &Materials, translucent: Translucent) -> Self {
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Casters::layout"),
            bind_group_layouts: &[Some(maps.caster_layout()), Some(&materials.layout)],
            immediate_size: 0,
        });
        let (recipe, [opaque, masked, dithered]) = (Recipe::new(maps, translucent), Default::default());
        Self { gpu: gpu.clone(), recipe, layout, opaque, masked, dithered }
    }

    /// Returns whether the pipelines draw casters into these maps too.
    pub fn suits(&self, maps: &ShadowMaps, translucent: Translucent) -> bool {
        self.recipe == Recipe::new(maps, translucent)
    }

    fn opaque(&self) -> &wgpu::RenderPipeline {
        self.opaque.get_or_init(|| {
            let buffers = vertex_layouts();
            let [positions, instances, .., runs] = buffers.clone();
            let text = &self.recipe.opaque;
            match self.recipe.is_named {
                true => {
                    let with_runs = [positions, instances, None, None, runs];
                    self.pipeline("Casters::named", text, ["vs_named", "fs_named"], &with_runs, true)
                }
                // Maps that are colours are written by a fragment shader.
                false => {
                    let colour = !self.recipe.targets.is_empty();
                    self.pipeline("Casters::opaque", text, ["vs_opaque", "fs_opaque"], &buffers[..2], colour)
                }
            }
        })
    }

    fn masked(&self) -> &wgpu::RenderPipeline {
        self.masked.get_or_init(|| {
            let (text, buffers) = (&self.recipe.masked, &vertex_layouts()[..3]);
            self.pipeline("Casters::masked", text, ["vs_masked", "fs_masked"], buffers, true)
        })
    }

    /// Returns the pipeline of translucent casters; `None` if they cast no shadows.
    fn dithered(&self) -> Option<&wgpu::RenderPipeline> {
        let text = self.recipe.dithered.as_ref()?;
        Some(self.dithered.get_or_init(|| {
            let buffers = &vertex_layouts()[..3];
            self.pipeline("Casters::dithered", text, ["vs_dithered", "fs_dithered"], buffers, true)
        }))
    }

    fn pipeline(
        &self,
        label: &str,
        text: &str,
        entry_points: [&str; 2],
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        fragment: bool,
    ) -> wgpu::RenderPipeline {
        let (device, recipe) = (&self.gpu.device, &self.recipe);
        let module = &device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(entry_points[0]),
                compilation_options: Default::default(),
                buffers,
            },
            primitive: recipe.primitive,
            depth_stencil: Some(recipe.depth_stencil.clone()),
            multisample: recipe.multisample,
            fragment: fragment.then_some(wgpu::FragmentState {
                module,
                entry_point: Some(entry_points[1]),
                compilation_options: Default::default(),
                targets: &recipe.targets,
            }),
            multiview_mask: recipe.multiview_mask,
            cache: None,
        })
    }

    /// Draws casters into a map whose pass has begun. Translucent primitives cast a shadow only if
    /// they are dithered.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        map: &wgpu::BindGroup,
        drawable: &Drawable<'_>,
        runs: &[Run],
    ) -> Drawn {
        pass.set_bind_group(0, map, &[]);
        drawable.draw(pass, runs, Show::Shadows, |material, _| match material.alpha {
            AlphaMode::Opaque => Some(self.opaque()),
            AlphaMode::Mask { .. } => Some(self.masked()),
            AlphaMode::Blend => self.dithered(),
        })
    }
}
