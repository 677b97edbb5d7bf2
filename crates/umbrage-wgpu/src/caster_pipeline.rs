//! A pipeline that draws casters, for the common case.

use crate::device::made;
use crate::{Error, Result, ShadowMaps, Shadows};

/// Options of a pipeline that draws casters.
///
/// The default draws triangle lists of `vec3f` positions, in metres relative to the frame's origin,
/// at location 0 of tightly packed vertices, and both faces.
///
/// ```no_run
/// # use umbrage_wgpu::{CasterPipeline, Shadows, wgpu};
/// # fn example(shadows: &Shadows) -> umbrage_wgpu::Result<wgpu::RenderPipeline> {
/// shadows.caster_pipeline(&CasterPipeline {
///     buffers: &[Some(CasterPipeline::positions(24, &wgpu::vertex_attr_array![0 => Float32x3]))],
///     front_face: wgpu::FrontFace::Cw,
///     ..CasterPipeline::default()
/// })
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CasterPipeline<'a> {
    /// Label of the pipeline and its shader module.
    pub label: Option<&'a str>,
    /// Vertex buffers, as in the application's own pipelines.
    pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    /// WGSL with an entry point `vertex`, and `fragment` if [`CasterPipeline::discards`]. It is
    /// appended to [`Shadows::caster_wgsl`] of group 0.
    pub wgsl: &'a str,
    /// Members of the struct `UmbrageCast`, which `vertex` passes to `fragment`.
    pub members: &'a str,
    /// True if `wgsl` has an entry point `fragment`, which discards. It returns a `UmbrageTexel` at
    /// location 0, `umbrage_caster_texel(at, 0u)` of its `@builtin(position)`: the depth for maps
    /// that are colour textures, and with exact edges the id 0, because the caster's triangles
    /// cannot be tested.
    pub discards: bool,
    /// The application's own bind groups, from group 1 on.
    pub bind_group_layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    /// Primitive topology: lists or strips.
    pub topology: wgpu::PrimitiveTopology,
    /// Format of indices, for strips only.
    pub strip_index_format: Option<wgpu::IndexFormat>,
    /// Winding order of front faces.
    pub front_face: wgpu::FrontFace,
    /// Faces to cull. With `None`, single-sided walls cast shadows from both sides.
    pub cull_mode: Option<wgpu::Face>,
    /// The application's own cache of compiled pipelines, if it has one (Vulkan).
    pub cache: Option<&'a wgpu::PipelineCache>,
}

/// A vertex shader for positions relative to the frame's origin.
const POSITIONS: &str = "@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position, instance);
}";

/// Fragment shader that writes the depth into colour maps, for casters that discard nothing.
const DEPTH: &str = "
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) f32 {
    return umbrage_caster_depth(at);
}";

/// Fragment shader that writes ids, for casters that discard nothing: 0 unless the vertex shader
/// has set one.
const ID: &str = "
@fragment fn fragment(@location(14) @interpolate(flat, first) id: u32) -> @location(0) u32 {
    return id;
}";

/// Vertex attribute of tightly packed positions.
const PACKED: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];

impl Default for CasterPipeline<'_> {
    fn default() -> Self {
        const BUFFERS: &[Option<wgpu::VertexBufferLayout<'static>>] = &[Some(CasterPipeline::positions(12, &PACKED))];
        Self {
            label: Some("Shadows::casters"),
            buffers: BUFFERS,
            wgsl: POSITIONS,
            members: "",
            discards: false,
            bind_group_layouts: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            strip_index_format: None,
            front_face: wgpu::FrontFace::Ccw,
            cull_mode: None,
            cache: None,
        }
    }
}

impl CasterPipeline<'_> {
    /// Layout of a vertex buffer with vertices `stride` bytes apart.
    #[must_use]
    pub const fn positions(stride: u64, attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
        wgpu::VertexBufferLayout { array_stride: stride, step_mode: wgpu::VertexStepMode::Vertex, attributes }
    }
}

impl Shadows {
    /// A pipeline that draws casters into every map of [`crate::ShadowFrame::maps`], with
    /// [`crate::ShadowMap::bind_group`] in group 0. Valid until [`Shadows::set_config`] or
    /// [`Shadows::set_lights`] returns [`umbrage::config::Rebuilds::Pipelines`].
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device refuses shader or states,
    /// [`crate::Error::CasterWithoutId`] for a fragment shader that does not write the id that
    /// exact edges need, [`crate::Error::DeviceLost`].
    pub fn caster_pipeline(&self, options: &CasterPipeline<'_>) -> Result<wgpu::RenderPipeline> {
        let maps = self.maps();
        // wgpu takes a fragment shader that leaves a target as it was.
        if options.discards && maps.edges().is_exact() && !options.wgsl.contains("UmbrageTexel") {
            return Err(Error::CasterWithoutId { label: options.label.unwrap_or("casters").to_owned() });
        }
        made(maps.device(), "making a pipeline for casters", || Ok(pipeline(maps, options)))
    }
}

fn pipeline(maps: &ShadowMaps, options: &CasterPipeline<'_>) -> wgpu::RenderPipeline {
    let device = maps.device();
    let own_fragment = match () {
        () if options.discards || maps.caster_targets().is_empty() => "",
        () if maps.edges().is_exact() => ID,
        () => DEPTH,
    };
    let text = maps.caster_wgsl_with(0, options.members) + options.wgsl + own_fragment;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: options.label,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let groups: Vec<_> =
        std::iter::once(Some(maps.caster_layout())).chain(options.bind_group_layouts.iter().copied()).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: options.label,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: options.label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: options.buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: options.topology,
            strip_index_format: options.strip_index_format,
            front_face: options.front_face,
            cull_mode: options.cull_mode,
            ..maps.caster_primitive()
        },
        depth_stencil: Some(maps.caster_depth_stencil()),
        multisample: maps.caster_multisample(),
        fragment: (options.discards || !own_fragment.is_empty()).then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: maps.caster_targets(),
        }),
        multiview_mask: maps.caster_multiview_mask(),
        cache: options.cache,
    })
}
