//! Deferred shadows: a mask of visibility from the image's depth.

mod normals;

pub use normals::MaskNormals;

use std::borrow::Cow;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3};
#[cfg(doc)]
use umbrage::config::Edges;
use umbrage::config::{Coordinates, ShadowConfig};

use umbrage_shaders::MaskText;

use crate::{Error, Result, ShadowMaps};

/// The camera that drew the depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskFrame {
    /// Matrix from positions relative to the camera, along the world's axes, to the clip space in
    /// which the depth was drawn. Any depth convention of a GPU, including reversed and infinite
    /// ones.
    pub clip_from_eye: DMat4,
    /// Position of the camera in world metres.
    pub eye: DVec3,
    /// Viewing direction of the camera, a unit vector.
    pub forward: DVec3,
    /// World point to which positions in the shaders are relative, as
    /// [`crate::FrameOptions::origin`].
    pub origin: DVec3,
    /// Clear value of the depth: 0 for reversed depth, otherwise 1.
    pub empty_depth: f32,
}

/// `UmbrageMask` in `shaders/pass/mask.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct Uniform {
    eye_from_clip: [[f32; 4]; 4],
    eye: [f32; 3],
    empty_depth: f32,
    forward: [f32; 3],
    perspective: f32,
}

impl Uniform {
    fn new(frame: &MaskFrame) -> Result<Self> {
        let bad = |field, expected| Err(Error::InvalidFrameOption { field, value: f64::NAN, expected });
        let inverse = frame.clip_from_eye.inverse();
        if !(frame.clip_from_eye.is_finite() && inverse.is_finite()) {
            return bad("clip_from_eye", "a finite matrix that has an inverse");
        }
        if !((frame.eye - frame.origin).is_finite() && frame.forward.is_normalized()) {
            return bad("eye", "finite, with a unit vector for forward");
        }
        let perspective = frame.clip_from_eye.row(3).truncate().length() > 0.0;
        Ok(Self {
            eye_from_clip: inverse.as_mat4().to_cols_array_2d(),
            eye: (frame.eye - frame.origin).as_vec3().to_array(),
            empty_depth: frame.empty_depth,
            forward: frame.forward.as_vec3().to_array(),
            perspective: f32::from(u8::from(perspective)),
        })
    }
}

/// A pass that samples [`ShadowMaps`] for every pixel of an image whose depth is already drawn, for
/// applications that shade later. Red is the first light's visibility (1 where nothing was drawn),
/// green is 1 where something was drawn.
///
/// Positions are reconstructed from depth with one sample per pixel; they agree with those of the
/// surfaces up to rounding (`docs/notes/coordinates.md`). Not available on GL and WebGL2, which
/// cannot load from a depth texture.
#[derive(Debug)]
pub struct ShadowMask {
    /// One, or that of pixels that bounds decide and then that of the others.
    pipelines: Vec<wgpu::RenderPipeline>,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    normals: MaskNormals,
}

/// Access of a mask to the triangles of casters, for exact edges.
#[derive(Clone, Copy, Debug)]
pub struct MaskRuns<'a> {
    /// The two functions `umbrage_run` and `umbrage_corner`, with bindings in group 2:
    /// [`crate::stored_runs_wgsl`]`(2, …)`, or the application's own.
    pub wgsl: &'a str,
    /// Layout of group 2.
    pub layout: &'a wgpu::BindGroupLayout,
}

impl ShadowMask {
    /// A pass for masks of `format` (`R8Unorm` stores visibility, `Rg8Unorm` also where something
    /// was drawn).
    ///
    /// # Errors
    /// [`Error::MaskNeedsDepthLoads`] if depth textures cannot be loaded from, [`Error::Config`]
    /// with [`umbrage::config::Layout::Reused`], whose maps are overwritten by the time the image's
    /// depth is complete, [`Error::MaskNeedsRuns`] with [`Edges::Exact`].
    pub fn new(
        device: &wgpu::Device,
        maps: &ShadowMaps,
        format: wgpu::TextureFormat,
        normals: MaskNormals,
    ) -> Result<Self> {
        if maps.edges().is_exact() {
            return Err(Error::MaskNeedsRuns);
        }
        Self::with(device, maps, (format, None), normals, None)
    }

    /// [`ShadowMask::new`] for a pass that also has a depth target, of `depth_format`. The answers
    /// are equal. Clear that depth to 1. Pixels in which the application then draws a depth of 0
    /// keep the answers that it drew with it.
    ///
    /// A first draw answers the pixels that bounds over the filter's kernel decide, which are most,
    /// and marks them in depth. The early depth test then keeps the second draw, which has the
    /// whole filter, from all others. It is quicker where a branch that a pixel does not take costs
    /// nearly as much as one that it takes: on software drivers. Kernels that are no square of
    /// texels ([`umbrage::config::Filter::Disc`] and the like) have no bounds, and one draw.
    ///
    /// # Errors
    /// As [`ShadowMask::new`], and [`Error::MaskDepth`] if the format is no depth format.
    pub fn in_two_draws(
        device: &wgpu::Device,
        maps: &ShadowMaps,
        format: wgpu::TextureFormat,
        normals: MaskNormals,
        depth_format: wgpu::TextureFormat,
    ) -> Result<Self> {
        if maps.edges().is_exact() {
            return Err(Error::MaskNeedsRuns);
        }
        if !depth_format.has_depth_aspect() {
            return Err(Error::MaskDepth { format: depth_format });
        }
        Self::with(device, maps, (format, Some(depth_format)), normals, None)
    }

    /// [`ShadowMask::new`] for exact edges: set bind group 2 in the pass before
    /// [`ShadowMask::draw`]. With [`Edges::Sampled`] the group is not used.
    ///
    /// # Errors
    /// As [`ShadowMask::new`].
    pub fn with_runs(
        device: &wgpu::Device,
        maps: &ShadowMaps,
        format: wgpu::TextureFormat,
        normals: MaskNormals,
        runs: MaskRuns<'_>,
    ) -> Result<Self> {
        Self::with(device, maps, (format, None), normals, maps.edges().is_exact().then_some(runs))
    }

    fn with(
        device: &wgpu::Device,
        maps: &ShadowMaps,
        (format, depth_format): (wgpu::TextureFormat, Option<wgpu::TextureFormat>),
        normals: MaskNormals,
        runs: Option<MaskRuns<'_>>,
    ) -> Result<Self> {
        if device.adapter_info().backend == wgpu::Backend::Gl {
            return Err(Error::MaskNeedsDepthLoads);
        }
        // Where one map is used again and again, all but the last are gone when the picture's depth
        // is complete.
        ShadowConfig { coordinates: Coordinates::Deferred, ..maps.config().clone() }.validate()?;
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let texture = |binding, sample_type| {
            let view_dimension = wgpu::TextureViewDimension::D2;
            let ty = wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
            entry(binding, wgpu::ShaderStages::FRAGMENT, ty)
        };
        let mut entries = vec![
            entry(
                0,
                wgpu::ShaderStages::VERTEX,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<Uniform>() as u64),
                },
            ),
            texture(1, wgpu::TextureSampleType::Depth),
        ];
        if normals.has_texture() {
            entries.push(texture(2, wgpu::TextureSampleType::Float { filterable: false }));
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("ShadowMask::layout"),
            entries: &entries,
        });
        let footprint = runs.is_some() && maps.edges().samples().is_some_and(|samples| samples > 1);
        let turns = normals == MaskNormals::Texture;
        let choices = MaskText { normals: normals.has_texture(), turns, footprint, bounds: false };
        let whole = maps.receiver_wgsl(1) + runs.map_or("", |runs| runs.wgsl) + &umbrage_shaders::mask(0, choices);
        let first = maps.bounds_receiver_wgsl(1).filter(|_| depth_format.is_some());
        let first = first.map(|text| text + &umbrage_shaders::mask(0, MaskText { bounds: true, ..choices }));
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("ShadowMask::pipeline_layout"),
            bind_group_layouts: &[Some(&layout), Some(maps.receiver_layout()), runs.map(|runs| runs.layout)]
                [..if runs.is_some() { 3 } else { 2 }],
            immediate_size: 0,
        });
        // Depth is 1 where nobody has answered, and 0, that of the triangle, where somebody has.
        let pipeline = |text| {
            let depth_stencil = depth_format.map(|format| wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            });
            pipeline(device, text, &pipeline_layout, format, depth_stencil)
        };
        let pipelines = first.into_iter().chain([whole]).map(pipeline).collect();
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("ShadowMask::uniform"),
            size: size_of::<Uniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Ok(Self { pipelines, layout, uniform, normals })
    }

    /// Writes a frame's camera to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the wrong field. Nothing has been written then.
    pub fn prepare(&self, queue: &wgpu::Queue, frame: &MaskFrame) -> Result<()> {
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&Uniform::new(frame)?));
        Ok(())
    }

    /// The bind group for [`ShadowMask::draw`]: the image's depth and, with
    /// [`MaskNormals::Texture`] or [`MaskNormals::TextureAsIs`], its normals.
    ///
    /// # Errors
    /// [`Error::MaskNormals`] if normals are missing or not needed.
    pub fn bind_group(
        &self,
        device: &wgpu::Device,
        depth: &wgpu::TextureView,
        normals: Option<&wgpu::TextureView>,
    ) -> Result<wgpu::BindGroup> {
        if normals.is_some() != self.normals.has_texture() {
            return Err(Error::MaskNormals { normals: self.normals, given: normals.is_some() });
        }
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(depth) },
        ];
        entries.extend(
            normals.map(|view| wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(view) }),
        );
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("ShadowMask::bind_group"),
            layout: &self.layout,
            entries: &entries,
        }))
    }

    /// Draws the mask into a pass with one colour target and, with [`ShadowMask::in_two_draws`]
    /// alone, a depth target. Changes bind groups 0 and 1; with [`MaskRuns`] the application sets
    /// group 2.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, maps: &ShadowMaps, group: &wgpu::BindGroup) {
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, maps.receiver_bind_group(), &[]);
        for pipeline in &self.pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
    }
}

/// A pipeline that draws one triangle over the whole picture.
fn pipeline(
    device: &wgpu::Device,
    text: String,
    layout: &wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
    depth_stencil: Option<wgpu::DepthStencilState>,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("ShadowMask::shader"),
        source: wgpu::ShaderSource::Wgsl(Cow::Owned(text)),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("ShadowMask::pipeline"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("umbrage_mask_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("umbrage_mask_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
