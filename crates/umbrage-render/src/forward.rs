//! The passes that draw the scene as the eye sees it: the picture and the visibility mask.

use std::borrow::Cow;
use std::sync::OnceLock;

use glam::{DVec3, Vec3};
use umbrage::config::{Coordinates, Edges, Layout};
use umbrage::{Light, Projection, View};
use umbrage_scene::AlphaMode;
use umbrage_wgpu::{ShadowMaps, Slice};

use crate::contact::Contact;
use crate::draw_list::{Drawable, Drawn, Run, Show};
use crate::edge_counts::COUNTS_FORMAT;
use crate::formats::{MASK_FORMAT, PICTURE_FORMAT};
use crate::lamps::{Lamp, LampUniform, MOST_LAMPS};
use crate::materials::{GpuMaterial, Materials};
use crate::names::Names;
use crate::surfaces::{Depth, Recipe, Sky, Surface, SurfacePipelines, Vertices};
use crate::view_list::ViewList;
use crate::{Gpu, Result, shaders};

/// Samples per pixel of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Samples {
    /// One sample at the pixel's centre: the cheapest choice, for measurements.
    One,
    /// Four samples, for smooth edges. Every WebGPU device has four for the picture's formats.
    #[default]
    Four,
}

impl Samples {
    pub(crate) fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }

    /// Least coverage at which an alpha-tested pixel is drawn. With several samples the pixel's
    /// coverage decides how many are drawn.
    pub(crate) fn least_coverage(self) -> f64 {
        match self {
            Self::One => 0.5,
            Self::Four => 0.0,
        }
    }
}

/// A `vec3f` of a uniform buffer, which takes the room of four numbers
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
    pub shadow_colour: PaddedVec3,
    pub lamps: [LampUniform; MOST_LAMPS],
}

/// Brightness of the sky without a sun: enough to distinguish corners that no lamp lights.
const NIGHT: f32 = 0.2;

impl FrameUniform {
    /// Makes the uniform of a frame. `slice` is the part of the view that is drawn; `None` draws
    /// all of it.
    pub fn new(
        view: &View,
        lamps: &[Lamp],
        shadow_colour: DVec3,
        origin: DVec3,
        slice: Option<&Slice>,
    ) -> Result<Self> {
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
            shadow_colour: shadow_colour.into(),
            lamps: LampUniform::all(lamps, origin)?,
        })
    }
}

/// Bind groups of a pass over the scene.
#[derive(Clone, Copy)]
pub(crate) struct Bindings<'a> {
    /// Bind group of the frame, or of a slice of it.
    pub frame: &'a wgpu::BindGroup,
    /// Bind group of the shadow maps.
    pub maps: &'a wgpu::BindGroup,
    /// Bind group of the picture's depth, for contact shadows.
    pub contact: Option<&'a wgpu::BindGroup>,
}

/// Choice between a picture with shadows and one without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shading {
    WithShadows,
    /// Shaders that contain no shadow code.
    WithoutShadows,
}

/// Pipelines and the frame's uniforms.
pub(crate) struct Forward {
    uniform: wgpu::Buffer,
    stride: u64,
    frame_layout: wgpu::BindGroupLayout,
    /// Bind groups of the whole frame and then of its slices, where the picture is drawn slice by
    /// slice.
    bind_groups: Vec<wgpu::BindGroup>,
    picture: SurfacePipelines,
    /// Pipelines of the depth pass before shading; `None` where the view is drawn slice by slice.
    picture_depth: Option<SurfacePipelines>,
    mask: SurfacePipelines,
    mask_depth: Option<SurfacePipelines>,
    sky: Sky,
    /// Pipelines of depth alone, for contact shadows.
    depth: SurfacePipelines,
    /// Counts of exact edges: the WGSL, the recipe of the pipelines, and the pipelines once they
    /// are asked for.
    counts: Option<(String, Recipe, OnceLock<SurfacePipelines>)>,
}

impl Forward {
    /// Makes the pipelines. `named` are the buffers of [`Names::entries`]; empty without exact
    /// edges. With `any_filter` they serve every filter that compares depth.
    pub fn new(
        gpu: &Gpu,
        maps: &ShadowMaps,
        materials: &Materials,
        samples: Samples,
        (contact, named): (Option<&Contact>, &[wgpu::BindGroupEntry<'_>]),
        shadows: Shading,
        any_filter: bool,
    ) -> Self {
        let device = &gpu.device;
        let (library, coordinates): (String, Coordinates) = match shadows {
            Shading::WithShadows => {
                let runs = match maps.edges().is_exact() {
                    true => umbrage_wgpu::stored_runs_wgsl(0, Names::BINDING),
                    false => String::new(),
                };
                let any = any_filter.then(|| maps.any_filter_receiver_wgsl(2)).flatten();
                (any.unwrap_or_else(|| maps.receiver_wgsl(2)) + &runs, maps.config().coordinates)
            }
            Shading::WithoutShadows => (shaders::WITHOUT_SHADOWS.to_owned(), Coordinates::World),
        };
        let module = |label, text| {
            let source = wgpu::ShaderSource::Wgsl(Cow::Owned(text));
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let shader = module("Forward::shader", shaders::forward(&library, coordinates, contact.is_some()));
        let frame_layout = frame_layout(device, maps.edges());
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
        let bind_groups = bind_groups(device, &frame_layout, (&uniform, stride), named);
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
        let depth_shader = module("Forward::depth_shader", shaders::depth());
        let sky_shader = module("Forward::sky_shader", shaders::sky());
        let counts = (shadows == Shading::WithShadows && maps.edges().is_exact()).then(|| {
            let library = maps.counting_receiver_wgsl(2) + &umbrage_wgpu::stored_runs_wgsl(0, Names::BINDING);
            shaders::edge_counts(&library, coordinates)
        });
        let samples_per_pixel = samples.count();
        let shading = Recipe {
            constants: vec![("LEAST_COVERAGE", samples.least_coverage()), ("SLICED", f64::from(u8::from(sliced)))],
            unclipped_depth: sliced && device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL),
            // A slice has no depth pass: which pixels belong to it is known only where they are
            // shaded.
            depth: if sliced { Depth::Drawn } else { Depth::Found },
            ..Recipe::new(gpu, surface_layout, shader)
        };
        let unclipped_depth = shading.unclipped_depth;
        let sky = Recipe { unclipped_depth, ..Recipe::new(gpu, sky_layout, sky_shader) };
        let drawn_first = Recipe {
            constants: vec![("LEAST_COVERAGE", samples.least_coverage())],
            ..Recipe::new(gpu, depth_layout, depth_shader)
        };
        // With several samples lavapipe shades hidden pixels all the same: a depth pass does not
        // help. Most such pictures go through a G-buffer instead (docs/notes/cost.md).
        let is_software = gpu.adapter_info.device_type == wgpu::DeviceType::Cpu;
        let early = !(sliced || is_software && samples != Samples::One);
        let shading_pictures = Recipe { depth: if early { Depth::Found } else { Depth::Drawn }, ..shading.clone() };
        let picture = |fragment_entry| Surface {
            vertex: Vertices::Whole,
            fragment_entry: Some(fragment_entry),
            format: Some(PICTURE_FORMAT),
            samples: samples_per_pixel,
            ..Surface::default()
        };
        let mask = |fragment_entry| Surface { format: Some(MASK_FORMAT), samples: 1, ..picture(fragment_entry) };
        let bare = |vertex, fragment_entry, format, samples| Surface {
            vertex,
            fragment_entry,
            format,
            samples,
            writes: false,
            ..Surface::default()
        };
        let before = |masked: &'static str, format: Option<wgpu::TextureFormat>, samples: u32| {
            let solid = bare(Vertices::Positions, format.map(|_| "fs_solid"), format, samples);
            let masked = bare(Vertices::Outlines, Some(masked), format, samples);
            [solid, masked, solid]
        };
        let several = samples != Samples::One;
        let [solid, mut covering, _] = before("fs_coverage", Some(PICTURE_FORMAT), samples_per_pixel);
        covering.alpha_to_coverage = several;
        Self {
            uniform,
            stride,
            frame_layout,
            bind_groups,
            picture_depth: early.then(|| drawn_first.pipelines("Forward::picture_depth", [solid, covering, solid])),
            picture: shading_pictures.pipelines(
                "Forward::picture",
                [
                    picture("fs_picture_opaque"),
                    Surface { alpha_to_coverage: several && !early, ..picture("fs_picture_masked") },
                    Surface { blend: true, ..picture("fs_picture_blend") },
                ],
            ),
            mask_depth: (!sliced)
                .then(|| drawn_first.pipelines("Forward::mask_depth", before("fs_exact", Some(MASK_FORMAT), 1))),
            // The third is never drawn: translucent surfaces are not in the mask.
            mask: shading
                .pipelines("Forward::mask", [mask("fs_mask_opaque"), mask("fs_mask_masked"), mask("fs_mask_opaque")]),
            depth: drawn_first.pipelines("Forward::depth", before("fs_exact", None, 1)),
            counts: counts.map(|text| (text, Recipe { depth: Depth::Drawn, ..shading.clone() }, OnceLock::new())),
            sky: Sky::new(sky, samples_per_pixel),
        }
    }

    /// Binds other buffers of caster ids beside the frames.
    pub fn bind(&mut self, gpu: &Gpu, named: &[wgpu::BindGroupEntry<'_>]) {
        let uniform = (&self.uniform, self.stride);
        self.bind_groups = bind_groups(&gpu.device, &self.frame_layout, uniform, named);
    }

    /// Writes the uniform of the whole frame, `index` 0, or of a slice, 1 and so on.
    pub fn prepare(&self, gpu: &Gpu, index: usize, frame: &FrameUniform) {
        gpu.queue.write_buffer(&self.uniform, index as u64 * self.stride, bytemuck::bytes_of(frame));
    }

    /// Returns the bind group of the uniform that [`Forward::prepare`] wrote at `index`.
    pub fn bind_group(&self, index: usize) -> &wgpu::BindGroup {
        &self.bind_groups[index]
    }

    /// Layout of [`Forward::bind_group`].
    pub fn frame_layout(&self) -> &wgpu::BindGroupLayout {
        &self.frame_layout
    }

    /// Draws the depth of all solid surfaces, for contact shadows.
    pub fn draw_depth(&self, pass: &mut wgpu::RenderPass<'_>, drawable: &Drawable<'_>, solid: &ViewList) -> Drawn {
        pass.set_bind_group(0, self.bind_group(0), &[]);
        draw_pieces(pass, drawable, (solid, Show::Shadows), &self.depth)
    }

    /// Draws all solid surfaces.
    pub fn draw_solid(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        draw_visible(pass, bindings, drawable, solid, (self.picture_depth.as_ref(), &self.picture))
    }

    /// Draws the sky behind all surfaces.
    pub fn draw_sky(&self, pass: &mut wgpu::RenderPass<'_>, bindings: Bindings<'_>) {
        bind(pass, bindings);
        pass.set_pipeline(self.sky.pipeline());
        pass.draw(0..3, 0..1);
    }

    /// Draws translucent surfaces in the order given, which is back to front.
    pub fn draw_translucent(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        translucent: &[Run],
    ) -> Drawn {
        bind(pass, bindings);
        drawable.draw(pass, translucent, Show::Surfaces, |material, mirrored| {
            (material.alpha == AlphaMode::Blend).then(|| self.picture.of(material, mirrored))
        })
    }

    /// Draws the visibility of all solid surfaces.
    pub fn draw_mask(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) -> Drawn {
        draw_visible(pass, bindings, drawable, solid, (self.mask_depth.as_ref(), &self.mask))
    }

    /// Draws the counts of exact edges of all solid surfaces; nothing with sampled edges.
    pub fn draw_counts(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: Bindings<'_>,
        drawable: &Drawable<'_>,
        solid: &ViewList,
    ) {
        let Some((text, recipe, made)) = &self.counts else { return };
        let pipelines = made.get_or_init(|| {
            let module = recipe.gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("Forward::counts"),
                source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(text)),
            });
            let of = |entry| Surface { fragment_entry: Some(entry), format: Some(COUNTS_FORMAT), ..Surface::default() };
            let surfaces = ["fs_counts_opaque", "fs_counts_masked", "fs_counts_opaque"].map(of);
            Recipe { module, ..recipe.clone() }.pipelines("Forward::counts", surfaces)
        });
        draw_visible(pass, bindings, drawable, solid, (None, pipelines));
    }
}

/// Layout of group 0: the frame and, with exact edges, the buffers of caster ids.
fn frame_layout(device: &wgpu::Device, edges: Edges) -> wgpu::BindGroupLayout {
    let mut entries = vec![wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(size_of::<FrameUniform>() as u64),
        },
        count: None,
    }];
    if edges.is_exact() {
        entries.extend(Names::layout(Names::BINDING));
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("Forward::frame_layout"),
        entries: &entries,
    })
}

/// Makes a bind group for each frame of a uniform buffer, and returns them with their distance in
/// the buffer.
fn bind_groups(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    (uniform, stride): (&wgpu::Buffer, u64),
    named: &[wgpu::BindGroupEntry<'_>],
) -> Vec<wgpu::BindGroup> {
    let group = |index| {
        let resource = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: uniform,
            offset: index * stride,
            size: wgpu::BufferSize::new(size_of::<FrameUniform>() as u64),
        });
        let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource }];
        entries.extend_from_slice(named);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Forward::bind_group"),
            layout,
            entries: &entries,
        })
    };
    (0..uniform.size() / stride).map(group).collect()
}

/// Draws depth, if there are pipelines for it, and then the visible surfaces.
fn draw_visible(
    pass: &mut wgpu::RenderPass<'_>,
    bindings: Bindings<'_>,
    drawable: &Drawable<'_>,
    solid: &ViewList,
    (depth, shading): (Option<&SurfacePipelines>, &SurfacePipelines),
) -> Drawn {
    bind(pass, bindings);
    let show = |depth| draw_pieces(pass, drawable, (solid, Show::Shadows), depth);
    let mut drawn = depth.map_or_else(Drawn::default, show);
    drawn += shade(pass, drawable, solid, (if depth.is_some() { Show::Visible } else { Show::Surfaces }, shading));
    drawn
}

/// Shades what is not translucent: over its depth with [`Show::Visible`], or with depth.
pub(crate) fn shade(
    pass: &mut wgpu::RenderPass<'_>,
    drawable: &Drawable<'_>,
    solid: &ViewList,
    (what, shading): (Show, &SurfacePipelines),
) -> Drawn {
    let pick = |material: &GpuMaterial, mirrored: bool| {
        (material.alpha != AlphaMode::Blend).then(|| shading.of(material, mirrored))
    };
    match what {
        Show::Visible => drawable.draw(pass, &solid.runs, what, pick),
        Show::Surfaces | Show::Shadows => drawable.draw(pass, solid.runs.iter().rev(), what, pick),
    }
}

/// Draws what has a depth, near parts first: materials that are not translucent.
pub(crate) fn draw_pieces(
    pass: &mut wgpu::RenderPass<'_>,
    drawable: &Drawable<'_>,
    (solid, what): (&ViewList, Show),
    pipelines: &SurfacePipelines,
) -> Drawn {
    drawable.draw_pieces(pass, &solid.pieces, what, |material, mirrored| {
        (material.alpha != AlphaMode::Blend).then(|| pipelines.of(material, mirrored))
    })
}

pub(crate) fn bind(pass: &mut wgpu::RenderPass<'_>, bindings: Bindings<'_>) {
    pass.set_bind_group(0, bindings.frame, &[]);
    pass.set_bind_group(2, bindings.maps, &[]);
    if let Some(contact) = bindings.contact {
        pass.set_bind_group(3, contact, &[]);
    }
}
