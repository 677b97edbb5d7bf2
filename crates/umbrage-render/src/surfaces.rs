//! Pipelines that draw surfaces, made when they are first needed. A scene needs only a few of the
//! possible ones.

use std::sync::OnceLock;

use umbrage_scene::AlphaMode;

use crate::Gpu;
use crate::draw_list::vertex_layouts;
use crate::formats::{DEPTH_FORMAT, PICTURE_FORMAT};
use crate::materials::GpuMaterial;

/// Vertex attributes that a pipeline reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Vertices {
    /// Position alone.
    Positions,
    /// Position, texture coordinates and alpha.
    Outlines,
    /// All attributes but colour, for the normals of a mask.
    Facing,
    /// All attributes.
    #[default]
    Whole,
}

impl Vertices {
    const fn entry(self) -> &'static str {
        match self {
            Self::Positions => "vs_solid",
            Self::Outlines => "vs_outline",
            Self::Facing => "vs_facing",
            Self::Whole => "vs_main",
        }
    }

    /// Returns the number of buffers of [`vertex_layouts`] that are read.
    const fn buffers(self) -> usize {
        match self {
            Self::Positions => 2,
            Self::Outlines => 3,
            Self::Facing | Self::Whole => 4,
        }
    }
}

/// Use of depth in a pass over solid surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Depth {
    /// The pass draws depth: the nearest surface stays.
    Drawn,
    /// Depth was drawn before: surfaces at exactly that depth are shaded.
    Found,
}

/// Properties by which one surface pipeline differs from another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub vertex: Vertices,
    pub fragment_entry: Option<&'static str>,
    pub format: Option<wgpu::TextureFormat>,
    /// Formats of further targets.
    pub more: &'static [wgpu::TextureFormat],
    /// True if the colour is written.
    pub writes: bool,
    pub samples: u32,
    pub alpha_to_coverage: bool,
    pub blend: bool,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            vertex: Vertices::default(),
            fragment_entry: None,
            format: None,
            more: &[],
            writes: true,
            samples: 1,
            alpha_to_coverage: false,
            blend: false,
        }
    }
}

/// Properties that the pipelines of a pass share.
#[derive(Clone)]
pub(crate) struct Recipe {
    pub gpu: Gpu,
    pub layout: wgpu::PipelineLayout,
    pub module: wgpu::ShaderModule,
    pub constants: Vec<(&'static str, f64)>,
    pub unclipped_depth: bool,
    pub depth: Depth,
}

/// Pipelines of one target, by material and transform.
pub(crate) struct SurfacePipelines {
    label: &'static str,
    recipe: Recipe,
    surfaces: [Surface; 3],
    made: [[[OnceLock<wgpu::RenderPipeline>; 2]; 2]; 3],
}

impl SurfacePipelines {
    pub fn of(&self, material: &GpuMaterial, mirrored: bool) -> &wgpu::RenderPipeline {
        let alpha = match material.alpha {
            AlphaMode::Opaque => 0,
            AlphaMode::Mask { .. } => 1,
            AlphaMode::Blend => 2,
        };
        let two_sided = material.double_sided;
        self.made[alpha][usize::from(two_sided)][usize::from(mirrored)].get_or_init(|| {
            let primitive = wgpu::PrimitiveState {
                front_face: if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                cull_mode: (!two_sided).then_some(wgpu::Face::Back),
                unclipped_depth: self.recipe.unclipped_depth,
                ..Default::default()
            };
            let surface = &self.surfaces[alpha];
            let compare = match self.recipe.depth {
                Depth::Found if !surface.blend => wgpu::CompareFunction::Equal,
                _ => wgpu::CompareFunction::Greater,
            };
            let buffers = &vertex_layouts()[..surface.vertex.buffers()];
            self.recipe.pipeline(self.label, surface, surface.vertex.entry(), buffers, primitive, compare)
        })
    }
}

/// Sky behind all surfaces.
pub(crate) struct Sky {
    recipe: Recipe,
    samples: u32,
    made: OnceLock<wgpu::RenderPipeline>,
}

impl Sky {
    pub fn new(recipe: Recipe, samples: u32) -> Self {
        Self { recipe, samples, made: OnceLock::new() }
    }

    pub fn pipeline(&self) -> &wgpu::RenderPipeline {
        self.made.get_or_init(|| {
            let surface = Surface {
                fragment_entry: Some("fs_sky"),
                format: Some(PICTURE_FORMAT),
                samples: self.samples,
                ..Surface::default()
            };
            // Only where nothing is: infinitely far away is depth 0.
            let compare = wgpu::CompareFunction::GreaterEqual;
            self.recipe.pipeline("Forward::sky", &surface, "vs_sky", &[], Default::default(), compare)
        })
    }
}

impl Recipe {
    pub fn new(gpu: &Gpu, layout: wgpu::PipelineLayout, module: wgpu::ShaderModule) -> Self {
        let (gpu, constants) = (gpu.clone(), Vec::new());
        Self { gpu, layout, module, constants, unclipped_depth: false, depth: Depth::Drawn }
    }

    /// Pipelines of opaque, alpha-tested and translucent surfaces, none of them made yet.
    pub fn pipelines(&self, label: &'static str, surfaces: [Surface; 3]) -> SurfacePipelines {
        SurfacePipelines { label, recipe: self.clone(), surfaces, made: Default::default() }
    }

    fn pipeline(
        &self,
        label: &'static str,
        surface: &Surface,
        vertex_entry: &str,
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        primitive: wgpu::PrimitiveState,
        depth_compare: wgpu::CompareFunction,
    ) -> wgpu::RenderPipeline {
        let write_mask = match surface.format {
            _ if !surface.writes => wgpu::ColorWrites::empty(),
            // A picture is opaque: what a shader calls alpha there is coverage.
            Some(PICTURE_FORMAT) => wgpu::ColorWrites::COLOR,
            _ => wgpu::ColorWrites::ALL,
        };
        let first = surface.format.map(|format| wgpu::ColorTargetState {
            format,
            blend: surface.blend.then_some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask,
        });
        let more = surface.more.iter().map(|&format| format.into());
        let targets: Vec<Option<wgpu::ColorTargetState>> = first.into_iter().chain(more).map(Some).collect();
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex_entry),
                compilation_options: Default::default(),
                buffers,
            },
            primitive,
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(self.depth == Depth::Drawn && !surface.blend),
                depth_compare: Some(depth_compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: surface.samples,
                alpha_to_coverage_enabled: surface.alpha_to_coverage,
                ..Default::default()
            },
            fragment: surface.fragment_entry.map(|entry| wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &self.constants,
                    ..Default::default()
                },
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
