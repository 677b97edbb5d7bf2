//! The passes that draw the scene as the eye sees it: the picture and the visibility mask.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use umbrage::config::{Coordinates, Layout};
use umbrage::{Light, Projection, View};
use umbrage_scene::AlphaMode;
use umbrage_wgpu::{ShadowMaps, Slice};

use crate::contact::Contact;
use crate::draw_list::{Drawable, Drawn, Run, Show, vertex_layouts};
use crate::lamps::{Lamp, LampUniform, MOST_LAMPS};
use crate::materials::{GpuMaterial, Materials};
use crate::{Gpu, Result, shaders};

/// What the picture is drawn in before it is resolved; the samples of a pixel share one shading.
pub(crate) const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Red is visibility, green says that a surface was hit.
pub(crate) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;
/// What the eye's depth is drawn in: reversed, 0 infinitely far away.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Samples per pixel of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Samples {
    /// The pixel's centre alone: the cheapest, for measurements.
    One,
    /// Smooth edges; every WebGPU device has 4 for the picture's formats.
    #[default]
    Four,
}

impl Samples {
    fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }

    /// Least coverage at which an alpha-tested pixel is drawn: with several samples its coverage decides how many.
    fn least_coverage(self) -> f64 {
        match self {
            Self::One => 0.5,
            Self::Four => 0.0,
        }
    }
}

/// A `vec3f` of a uniform buffer: it takes the room of four numbers
/// (<https://www.w3.org/TR/WGSL/#alignment-and-size>).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct PaddedVec3 {
    value: [f32; 3],
    padding: f32,
}

impl From<DVec3> for PaddedVec3 {
    fn from(value: DVec3) -> Self {
        Self { value: value.as_vec3().to_array(), padding: 0.0 }
    }
}

/// `Frame` in `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FrameUniform {
    pub clip_from_eye: [[f32; 4]; 4],
    pub eye: [f32; 3],
    pub is_orthographic: f32,
    pub forward: [f32; 3],
    pub lamp_count: u32,
    pub to_sun: [f32; 3],
    pub daylight: f32,
    pub ray_center: [f32; 3],
    pub near: f32,
    pub ray_right: [f32; 3],
    pub far: f32,
    pub ray_up: PaddedVec3,
    pub lamps: [LampUniform; MOST_LAMPS],
}

/// How bright the sky is without a sun: enough to tell corners apart where no lamp shines.
const NIGHT: f32 = 0.2;

impl FrameUniform {
    /// `slice` is the part of the view that is drawn, if not all of it is.
    pub fn new(view: &View, lamps: &[Lamp], origin: DVec3, slice: Option<&Slice>) -> Result<Self> {
        let clip = view.clip_from_relative(view.eye());
        let sun = lamps.iter().find_map(|lamp| match lamp.light {
            Light::Directional(sun) => Some(sun.direction()),
            Light::Spot(_) | Light::Point(_) => None,
        });
        let frustum = view.frustum();
        let axes = view.world_from_view_rotation();
        let (center, half) = match frustum.projection {
            Projection::Perspective => {
                let [x, y] = [frustum.left + frustum.right, frustum.bottom + frustum.top].map(|sum| 0.5 * sum);
                let half = [frustum.right - frustum.left, frustum.top - frustum.bottom].map(|size| 0.5 * size);
                (axes * DVec3::new(x, y, -1.0), half)
            }
            Projection::Orthographic => (view.forward(), [0.0; 2]),
        };
        let eye: Vec3 = (view.eye() - origin).as_vec3();
        Ok(Self {
            clip_from_eye: slice.map_or(clip, |slice| slice.clip_from(clip)).as_mat4().to_cols_array_2d(),
            eye: eye.to_array(),
            is_orthographic: f32::from(u8::from(frustum.projection == Projection::Orthographic)),
            forward: view.forward().as_vec3().to_array(),
            lamp_count: lamps.len() as u32,
            to_sun: (-sun.unwrap_or(DVec3::ZERO)).as_vec3().to_array(),
            daylight: if sun.is_some() { 1.0 } else { NIGHT },
            ray_center: center.as_vec3().to_array(),
            near: frustum.near as f32,
            ray_right: (axes.x_axis * half[0]).as_vec3().to_array(),
            far: frustum.far as f32,
            ray_up: (axes.y_axis * half[1]).into(),
            lamps: LampUniform::all(lamps, origin)?,
        })
    }
}

/// Pipelines of one target, by what the material and the transform ask for.
struct SurfacePipelines([[[wgpu::RenderPipeline; 2]; 2]; 3]);

impl SurfacePipelines {
    fn of(&self, material: &GpuMaterial, mirrored: bool) -> &wgpu::RenderPipeline {
        let alpha = match material.alpha {
            AlphaMode::Opaque => 0,
            AlphaMode::Mask { .. } => 1,
            AlphaMode::Blend => 2,
        };
        &self.0[alpha][usize::from(material.double_sided)][usize::from(mirrored)]
    }
}

/// What a pass over the scene is bound to.
#[derive(Clone, Copy)]
pub(crate) struct Bindings<'a> {
    /// The frame, or a slice of it.
    pub frame: &'a wgpu::BindGroup,
    /// The shadow maps that it may ask.
    pub maps: &'a wgpu::BindGroup,
    /// The picture's depth, for contact shadows.
    pub contact: Option<&'a wgpu::BindGroup>,
}

/// Pipelines and the frame's uniforms.
pub(crate) struct Forward {
    uniform: wgpu::Buffer,
    stride: u64,
    /// The whole frame, then its slices where the picture is drawn slice by slice.
    bind_groups: Vec<wgpu::BindGroup>,
    picture: SurfacePipelines,
    mask: SurfacePipelines,
    sky: wgpu::RenderPipeline,
    depth: Option<SurfacePipelines>,
}

impl Forward {
    pub fn new(
        gpu: &Gpu,
        maps: &ShadowMaps,
        materials: &Materials,
        samples: Samples,
        contact: Option<&Contact>,
    ) -> Self {
        let device = &gpu.device;
        let coordinates: Coordinates = maps.config().coordinates;
        let library = maps.receiver_wgsl(2);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Forward::shader"),
            source: wgpu::ShaderSource::Wgsl(Cow::Owned(shaders::forward(&library, coordinates, contact.is_some()))),
        });
        let frame_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Forward::frame_layout"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: wgpu::BufferSize::new(size_of::<FrameUniform>() as u64),
                },
                count: None,
            }],
        });
        let sliced = maps.layout() == Layout::Reused;
        let count = if sliced { 1 + maps.splits() } else { 1 };
        let stride = (size_of::<FrameUniform>() as u64)
            .next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment));
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Forward::frame"),
            size: stride * count as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind_group = |index| {
            let resource = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &uniform,
                offset: index as u64 * stride,
                size: wgpu::BufferSize::new(size_of::<FrameUniform>() as u64),
            });
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Forward::bind_group"),
                layout: &frame_layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
            })
        };
        let bind_groups = (0..count).map(bind_group).collect();
        let surface_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Forward::surface_layout"),
            bind_group_layouts: &[
                Some(&frame_layout),
                Some(&materials.layout),
                Some(maps.receiver_layout()),
                contact.map(|contact| contact.shadows.layout()),
            ][..if contact.is_some() { 4 } else { 3 }],
            immediate_size: 0,
        });
        let depth_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Forward::depth_layout"),
            bind_group_layouts: &[Some(&frame_layout), Some(&materials.layout)],
            immediate_size: 0,
        });
        let sky_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Forward::sky_layout"),
            bind_group_layouts: &[Some(&frame_layout)],
            immediate_size: 0,
        });
        let unclipped_depth = sliced && device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL);
        let builder = Builder { device, module: &module, layout: &surface_layout, samples, sliced, unclipped_depth };
        let picture = builder.pipelines([
            builder.surface("Forward::picture_opaque", "fs_picture_opaque", PICTURE_FORMAT),
            Surface {
                alpha_to_coverage: samples != Samples::One,
                ..builder.surface("Forward::picture_masked", "fs_picture_masked", PICTURE_FORMAT)
            },
            Surface { blend: true, ..builder.surface("Forward::picture_blend", "fs_picture_blend", PICTURE_FORMAT) },
        ]);
        // The third is never drawn: translucent surfaces are not in the mask.
        let opaque =
            || Surface { samples: 1, ..builder.surface("Forward::mask_opaque", "fs_mask_opaque", MASK_FORMAT) };
        let mask = builder.pipelines([
            opaque(),
            Surface { samples: 1, ..builder.surface("Forward::mask_masked", "fs_mask_masked", MASK_FORMAT) },
            opaque(),
        ]);
        let sky = Builder { layout: &sky_layout, ..builder }.sky();
        let depth = contact.map(|_| {
            let bare = Surface {
                label: "Forward::depth",
                vertex_entry: "vs_depth",
                fragment_entry: None,
                format: None,
                samples: 1,
                alpha_to_coverage: false,
                blend: false,
            };
            let masked = Surface { fragment_entry: Some("fs_depth_masked"), ..bare };
            Builder { layout: &depth_layout, ..builder }.pipelines([bare, masked, bare])
        });
        Self { uniform, stride, bind_groups, picture, mask, sky, depth }
    }

    /// Writes the uniform of the whole frame, `index` 0, or of a slice, 1 and so on.
    pub fn prepare(&self, gpu: &Gpu, index: usize, frame: &FrameUniform) {
        gpu.queue.write_buffer(&self.uniform, index as u64 * self.stride, bytemuck::bytes_of(frame));
    }

    /// The bind group of what [`Forward::prepare`] wrote.
    pub fn bind_group(&self, index: usize) -> &wgpu::BindGroup {
        &self.bind_groups[index]
    }

    /// Draws the depth of everything solid; nothing without contact shadows.
    pub fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>, drawable: &Drawable<'_>, solid: &[Run]) -> Drawn {
        let Some(depth) = &self.depth else { return Drawn::default() };
        pass.set_bind_group(0, self.bind_group(0), &[]);
        drawable.draw(pass, solid, Show::Surfaces, |m, mirrored| {
            (m.alpha != AlphaMode::Blend).then(|| depth.of(m, mirrored))
        })
    }

    /// Draws everything solid.
    pub fn draw_solid(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &[Run],
    ) -> Drawn {
        bind(pass, bindings);
        let pick = |material: &GpuMaterial, mirrored| self.picture.of(material, mirrored);
        drawable
            .draw(pass, solid, Show::Surfaces, |m, mirrored| (m.alpha != AlphaMode::Blend).then(|| pick(m, mirrored)))
    }

    /// Draws the sky where nothing else is.
    pub fn draw_sky(&self, pass: &mut wgpu::RenderPass<'_>, bindings: Bindings<'_>) {
        bind(pass, bindings);
        pass.set_pipeline(&self.sky);
        pass.draw(0..3, 0..1);
    }

    /// Draws what is translucent, in the order given: from back to front.
    pub fn draw_translucent(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        translucent: &[Run],
    ) -> Drawn {
        bind(pass, bindings);
        let pick = |material: &GpuMaterial, mirrored| self.picture.of(material, mirrored);
        drawable.draw(pass, translucent, Show::Surfaces, |m, mirrored| {
            (m.alpha == AlphaMode::Blend).then(|| pick(m, mirrored))
        })
    }

    /// Draws everything solid as bare visibility.
    pub fn draw_mask(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &[Run],
    ) -> Drawn {
        bind(pass, bindings);
        drawable.draw(pass, solid, Show::Surfaces, |m, mirrored| {
            (m.alpha != AlphaMode::Blend).then(|| self.mask.of(m, mirrored))
        })
    }
}

fn bind(pass: &mut wgpu::RenderPass<'_>, bindings: Bindings<'_>) {
    pass.set_bind_group(0, bindings.frame, &[]);
    pass.set_bind_group(2, bindings.maps, &[]);
    if let Some(contact) = bindings.contact {
        pass.set_bind_group(3, contact, &[]);
    }
}

/// Where a pass stands among the passes that draw one target together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    /// Clears what was there.
    pub first: bool,
    /// Resolves samples; nothing is kept for a later pass.
    pub last: bool,
}

impl Turn {
    /// The only pass.
    pub const ONLY: Self = Self { first: true, last: true };
}

/// The textures that a picture is drawn into.
pub(crate) struct PictureTarget {
    /// The resolved picture.
    pub texture: wgpu::Texture,
    resolved: wgpu::TextureView,
    /// Several samples a pixel, to be resolved.
    samples: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
}

impl PictureTarget {
    pub fn new(gpu: &Gpu, size: [u32; 2], samples: Samples) -> Self {
        let texture = target_texture(gpu, "PictureTarget::resolved", size, PICTURE_FORMAT, 1);
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let count = samples.count();
        let several = (count > 1).then(|| target_texture(gpu, "PictureTarget::samples", size, PICTURE_FORMAT, count));
        let depth = target_texture(gpu, "PictureTarget::depth", size, DEPTH_FORMAT, count);
        Self { resolved: view(&texture), samples: several.as_ref().map(view), depth: view(&depth), texture }
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
        begin(encoder, target, (&self.depth, false), turn, timestamp_writes)
    }
}

/// The textures that a mask is drawn into.
pub(crate) struct MaskTarget {
    /// The mask.
    pub texture: wgpu::Texture,
    /// What draws it.
    pub color: wgpu::TextureView,
    /// Kept, for passes that come after.
    pub depth: wgpu::TextureView,
}

impl MaskTarget {
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let texture = target_texture(gpu, "MaskTarget::visibility", size, MASK_FORMAT, 1);
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
            (false, DEPTH_FORMAT) if sample_count == 1 => usage | wgpu::TextureUsages::TEXTURE_BINDING,
            (false, _) => usage,
        },
        view_formats: &[],
    })
}

/// The colours that a pass draws.
struct Target<'a> {
    label: &'static str,
    color: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
    /// What is there before anything is drawn.
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
                load: if turn.first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                store: keep_depth,
            }),
            stencil_ops: None,
        }),
        timestamp_writes,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// What makes one surface pipeline differ from another.
#[derive(Clone, Copy)]
struct Surface {
    label: &'static str,
    vertex_entry: &'static str,
    fragment_entry: Option<&'static str>,
    format: Option<wgpu::TextureFormat>,
    samples: u32,
    alpha_to_coverage: bool,
    blend: bool,
}

struct Builder<'a> {
    device: &'a wgpu::Device,
    module: &'a wgpu::ShaderModule,
    layout: &'a wgpu::PipelineLayout,
    samples: Samples,
    /// The picture is drawn slice by slice.
    sliced: bool,
    unclipped_depth: bool,
}

impl Builder<'_> {
    fn surface(&self, label: &'static str, fragment_entry: &'static str, format: wgpu::TextureFormat) -> Surface {
        let samples = self.samples.count();
        let (fragment_entry, format) = (Some(fragment_entry), Some(format));
        Surface {
            label,
            vertex_entry: "vs_main",
            fragment_entry,
            format,
            samples,
            alpha_to_coverage: false,
            blend: false,
        }
    }

    fn pipelines(&self, surfaces: [Surface; 3]) -> SurfacePipelines {
        SurfacePipelines(surfaces.map(|surface| {
            [Some(wgpu::Face::Back), None].map(|cull_mode| {
                [wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw].map(|front_face| {
                    let unclipped_depth = self.unclipped_depth;
                    let primitive =
                        wgpu::PrimitiveState { front_face, cull_mode, unclipped_depth, ..Default::default() };
                    self.pipeline(&surface, &vertex_layouts(), primitive, wgpu::CompareFunction::Greater)
                })
            })
        }))
    }

    /// Only where nothing is: infinitely far away is depth 0.
    fn sky(&self) -> wgpu::RenderPipeline {
        let surface = Surface { vertex_entry: "vs_sky", ..self.surface("Forward::sky", "fs_sky", PICTURE_FORMAT) };
        self.pipeline(&surface, &[], Default::default(), wgpu::CompareFunction::GreaterEqual)
    }

    fn pipeline(
        &self,
        surface: &Surface,
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        primitive: wgpu::PrimitiveState,
        depth_compare: wgpu::CompareFunction,
    ) -> wgpu::RenderPipeline {
        let constants =
            [("LEAST_COVERAGE", self.samples.least_coverage()), ("SLICED", f64::from(u8::from(self.sliced)))];
        let targets = [surface.format.map(|format| wgpu::ColorTargetState {
            format,
            blend: surface.blend.then_some(wgpu::BlendState::ALPHA_BLENDING),
            // A picture is opaque: what a shader calls alpha there is coverage.
            write_mask: if format == PICTURE_FORMAT { wgpu::ColorWrites::COLOR } else { wgpu::ColorWrites::ALL },
        })];
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(surface.label),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(surface.vertex_entry),
                compilation_options: Default::default(),
                buffers,
            },
            primitive,
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(!surface.blend),
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
                module: self.module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets: &targets[..usize::from(surface.format.is_some())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
