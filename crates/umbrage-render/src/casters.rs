//! The pipelines that draw casters into the maps of a pass.

use std::borrow::Cow;

use umbrage::config::Translucent;
use umbrage_scene::AlphaMode;
use umbrage_wgpu::ShadowMaps;

use crate::draw_list::{Drawable, Drawn, Run, Show, vertex_layouts};
use crate::materials::Materials;
use crate::{Gpu, shaders};

/// Pipelines of the shadow passes.
pub(crate) struct Casters {
    opaque: wgpu::RenderPipeline,
    masked: wgpu::RenderPipeline,
    dithered: Option<wgpu::RenderPipeline>,
}

impl Casters {
    pub fn new(gpu: &Gpu, maps: &ShadowMaps, materials: &Materials, translucent: Translucent) -> Self {
        let module = |source| {
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("Casters::shader"),
                source: wgpu::ShaderSource::Wgsl(Cow::Owned(source)),
            })
        };
        let is_named = maps.edges().is_exact();
        let opaque = module(match is_named {
            true => shaders::named_casters(&maps.caster_wgsl(0)),
            false => shaders::casters(&maps.caster_wgsl(0)),
        });
        let masked = module(shaders::masked_casters(&maps.caster_wgsl_with(0, shaders::MASKED_MEMBERS)));
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Casters::layout"),
            bind_group_layouts: &[Some(maps.caster_layout()), Some(&materials.layout)],
            immediate_size: 0,
        });
        let vertex_layouts = vertex_layouts();
        let [positions, instances, .., runs] = vertex_layouts.clone();
        let with_runs = [positions, instances, None, None, runs];
        let pipeline = |label, module: &wgpu::ShaderModule, entry_points: [&str; 2], buffers, fragment: bool| {
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some(entry_points[0]),
                    compilation_options: Default::default(),
                    buffers,
                },
                primitive: maps.caster_primitive(),
                depth_stencil: Some(maps.caster_depth_stencil()),
                multisample: maps.caster_multisample(),
                fragment: fragment.then_some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry_points[1]),
                    compilation_options: Default::default(),
                    targets: maps.caster_targets(),
                }),
                multiview_mask: maps.caster_multiview_mask(),
                cache: None,
            })
        };
        // Maps that are colours, and ids, are written by a fragment shader.
        let colour = !maps.caster_targets().is_empty();
        let buffers = &vertex_layouts;
        let dithered = (translucent == Translucent::Dithered).then(|| {
            let module = module(shaders::dithered_casters(&maps.caster_wgsl_with(0, shaders::DITHERED_MEMBERS)));
            pipeline("Casters::dithered", &module, ["vs_dithered", "fs_dithered"], &buffers[..3], true)
        });
        Self {
            opaque: match is_named {
                true => pipeline("Casters::named", &opaque, ["vs_named", "fs_named"], &with_runs[..], true),
                false => pipeline("Casters::opaque", &opaque, ["vs_opaque", "fs_opaque"], &buffers[..2], colour),
            },
            masked: pipeline("Casters::masked", &masked, ["vs_masked", "fs_masked"], &buffers[..3], true),
            dithered,
        }
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
            AlphaMode::Opaque => Some(&self.opaque),
            AlphaMode::Mask { .. } => Some(&self.masked),
            AlphaMode::Blend => self.dithered.as_ref(),
        })
    }
}
