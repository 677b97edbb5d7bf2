//! The pass that draws a split's casters into its map.

use std::borrow::Cow;

use umbrage_scene::AlphaMode;
use umbrage_wgpu::ShadowMaps;

use crate::draw_list::{Drawable, Drawn, Run, vertex_layouts};
use crate::materials::Materials;
use crate::{Gpu, shaders};

/// Pipelines of the shadow passes.
pub(crate) struct Casters {
    opaque: wgpu::RenderPipeline,
    masked: wgpu::RenderPipeline,
}

impl Casters {
    pub fn new(gpu: &Gpu, maps: &ShadowMaps, materials: &Materials) -> Self {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Casters::shader"),
            source: wgpu::ShaderSource::Wgsl(Cow::Owned(shaders::casters(&maps.caster_wgsl(0)))),
        });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Casters::layout"),
            bind_group_layouts: &[Some(maps.caster_layout()), Some(&materials.layout)],
            immediate_size: 0,
        });
        let vertex_layouts = vertex_layouts();
        let pipeline = |label, vertex_entry, buffers, fragment| {
            gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex_entry),
                    compilation_options: Default::default(),
                    buffers,
                },
                primitive: maps.caster_primitive(),
                depth_stencil: Some(maps.caster_depth_stencil()),
                multisample: maps.caster_multisample(),
                fragment,
                multiview_mask: None,
                cache: None,
            })
        };
        let masked_fragment = wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_masked"),
            compilation_options: Default::default(),
            targets: &[],
        };
        Self {
            opaque: pipeline("Casters::opaque", "vs_opaque", &vertex_layouts[..2], None),
            masked: pipeline("Casters::masked", "vs_masked", &vertex_layouts[..3], Some(masked_fragment)),
        }
    }

    /// Draws into a pass that [`ShadowMaps::begin_split`] began. Translucent primitives throw no shadow.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        maps: &ShadowMaps,
        split: usize,
        drawable: &Drawable<'_>,
        runs: &[Run],
    ) -> Drawn {
        pass.set_bind_group(0, maps.caster_bind_group(split), &[]);
        drawable.draw(pass, runs, |material, _| match material.alpha {
            AlphaMode::Opaque => Some(&self.opaque),
            AlphaMode::Mask { .. } => Some(&self.masked),
            AlphaMode::Blend => None,
        })
    }
}
