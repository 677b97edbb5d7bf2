//! Maps with a pipeline that draws triangles into them, and points that are asked.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use umbrage::ShadowPlan;
use umbrage::config::ShadowConfig;
use umbrage_wgpu::{FrameOptions, LightMaps, ShadowMaps};

use super::{Gpu, SUN, with};

/// A point that is asked: position relative to the frame's origin and normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Ask {
    position: [f32; 4],
    normal: [f32; 4],
}

impl Ask {
    pub fn position(&self) -> Vec3 {
        Vec3::from_slice(&self.position)
    }

    /// With numbers of the test's own beside position and normal.
    pub fn with(mut self, beside_position: f32, beside_normal: f32) -> Self {
        (self.position[3], self.normal[3]) = (beside_position, beside_normal);
        self
    }
}

pub fn ask(position: Vec3, normal: Vec3) -> Ask {
    Ask { position: position.extend(0.0).to_array(), normal: normal.extend(0.0).to_array() }
}

/// What `umbrage_shadow` answered, and splits 0 and 1 alone.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Answer {
    pub visibility: f32,
    pub split: i32,
    pub in_split: [f32; 2],
    pub tint: [f32; 3],
    pub short: f32,
}

/// Visibility in one split alone, for any shader that asks.
pub const IN_SPLIT: &str = "
fn in_split(position: vec3f, normal: vec3f, split: i32) -> f32 {
    var query = umbrage_query(position, normal);
    query.split = split;
    return umbrage_shadow(query).visibility;
}
";

pub const ASK: &str = "
struct Ask { position: vec4f, normal: vec4f }
struct Answer { visibility: f32, split: i32, in_split: vec2f, tint: vec3f, short: f32 }
@group(0) @binding(0) var<storage, read> asks: array<Ask>;
@group(0) @binding(1) var<storage, read_write> answers: array<Answer>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let p = asks[id.x].position.xyz;
    let n = asks[id.x].normal.xyz;
    let shadow = umbrage_shadow(umbrage_query(p, n));
    var query = umbrage_query(p, n);
    query.split = 0;
    let first = umbrage_shadow(query).visibility;
    query.split = 1;
    let in_split = vec2f(first, umbrage_shadow(query).visibility);
    answers[id.x] = Answer(shadow.visibility, shadow.split, in_split, shadow.tint, umbrage_visibility(p, n));
}";

const CASTER: &str = "
@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(position, instance);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) f32 {
    return umbrage_caster_depth(at);
}";

/// Triangles that maps name in runs of eight that [`NAMED`] has; those that follow have no name.
pub const NAMED: usize = 80;

const NAMED_CASTER: &str = "
@vertex fn vertex(
    @location(0) position: vec3f,
    @builtin(vertex_index) corner: u32,
    instance: UmbrageInstance,
) -> UmbrageCast {
    let first = select(1u, 0u, corner >= 240u);
    return umbrage_named(umbrage_cast(position, instance), umbrage_caster_id(first, corner / 24u));
}
@fragment fn fragment(
    @builtin(position) at: vec4f,
    @location(14) @interpolate(flat, first) id: u32,
) -> @location(0) UmbrageTexel {
    return umbrage_caster_texel(at, id);
}";

/// Maps, and a pipeline that draws triangles into them.
pub struct World {
    pub gpu: Gpu,
    pub maps: ShadowMaps,
    pipeline: wgpu::RenderPipeline,
}

impl World {
    pub fn new(gpu: Gpu, config: &ShadowConfig) -> Self {
        Self::of_lights(gpu, config, &SUN)
    }

    pub fn of_lights<L: Clone + Into<LightMaps>>(gpu: Gpu, config: &ShadowConfig, lights: &[L]) -> Self {
        let (maps, pipeline) = gpu.checked(|| {
            let maps = ShadowMaps::new(&gpu.device, config, lights).expect("a valid config");
            let source = maps.caster_wgsl(0) + if maps.edges().is_exact() { NAMED_CASTER } else { CASTER };
            let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("Test::caster"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("Test::caster"),
                layout: Some(&gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("Test::caster"),
                    bind_group_layouts: &[Some(maps.caster_layout())],
                    immediate_size: 0,
                })),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vertex"),
                    compilation_options: Default::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: 12,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                    })],
                },
                primitive: maps.caster_primitive(),
                depth_stencil: Some(maps.caster_depth_stencil()),
                multisample: maps.caster_multisample(),
                fragment: (!maps.caster_targets().is_empty()).then(|| wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fragment"),
                    compilation_options: Default::default(),
                    targets: maps.caster_targets(),
                }),
                multiview_mask: maps.caster_multiview_mask(),
                cache: None,
            });
            (maps, pipeline)
        });
        Self { gpu, maps, pipeline }
    }

    /// Puts settings that need no other maps over the config.
    pub fn set(&mut self, settings: &str) {
        let config = with(self.maps.config().clone(), settings);
        self.maps.set_config(&config).expect("settings of a frame");
    }

    /// Draws `triangles` (three corners each, relative to the options' origin) into every map.
    pub fn draw(&mut self, plan: &ShadowPlan, options: &FrameOptions, triangles: &[Vec3]) {
        self.draw_all(&[plan], options, triangles);
    }

    /// Draws the maps of several lights.
    pub fn draw_all(&mut self, plans: &[&ShadowPlan], options: &FrameOptions, triangles: &[Vec3]) {
        self.maps.prepare_lights(&self.gpu.queue, plans, options).expect("valid plans");
        self.gpu.checked(|| {
            let vertices = self.gpu.buffer_with(bytemuck::cast_slice(triangles), wgpu::BufferUsages::VERTEX);
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            for (index, map_pass) in self.maps.passes().iter().enumerate() {
                let mut pass = self.maps.begin_pass(&mut encoder, index, None);
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, self.maps.caster_bind_group(index), &[]);
                pass.set_vertex_buffer(0, vertices.slice(..));
                pass.draw(0..triangles.len() as u32, map_pass.instances(u8::MAX));
            }
            self.maps.prefilter(&mut encoder);
            self.gpu.queue.submit([encoder.finish()]);
        });
    }

    /// Draws each split's casters alone: `casters[i]` are the triangles of the plan's caster `i`.
    pub fn draw_listed(&mut self, plan: &ShadowPlan, options: &FrameOptions, casters: &[Vec<Vec3>]) {
        self.maps.prepare(&self.gpu.queue, plan, options).expect("a valid plan");
        let mut begins = vec![0u32];
        begins.extend(casters.iter().scan(0, |end, triangles| {
            *end += triangles.len() as u32;
            Some(*end)
        }));
        self.gpu.checked(|| {
            let vertices = self.gpu.buffer_with(bytemuck::cast_slice(&casters.concat()), wgpu::BufferUsages::VERTEX);
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            for (index, map_pass) in self.maps.passes().iter().enumerate() {
                let mut pass = self.maps.begin_pass(&mut encoder, index, None);
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, self.maps.caster_bind_group(index), &[]);
                pass.set_vertex_buffer(0, vertices.slice(..));
                for (caster, instances) in map_pass.casters(plan) {
                    pass.draw(begins[caster as usize]..begins[caster as usize + 1], instances);
                }
            }
            self.maps.prefilter(&mut encoder);
            self.gpu.queue.submit([encoder.finish()]);
        });
    }

    pub fn ask(&self, asks: &[Ask]) -> Vec<Answer> {
        self.gpu.compute(&(self.maps.receiver_wgsl(1) + ASK), asks, Some(&self.maps))
    }

    /// The texels of a D32Float map, row after row.
    pub fn texels(&self, split: usize) -> Vec<f32> {
        let size = self.maps.map_size(split);
        let row = (4 * size).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = self.gpu.checked(|| {
            let back = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("Test::texels"),
                size: u64::from(row * self.maps.map_texture(split).height()),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let edge = self.maps.map_texture(split).width();
            assert_eq!(edge, size, "a copy takes whole layers of a depth texture");
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    texture: self.maps.map_texture(split),
                    mip_level: 0,
                    origin: wgpu::Origin3d { x: 0, y: 0, z: split as u32 },
                    aspect: wgpu::TextureAspect::DepthOnly,
                },
                wgpu::TexelCopyBufferInfo {
                    buffer: &back,
                    layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
                },
                wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: 1 },
            );
            self.gpu.queue.submit([encoder.finish()]);
            self.gpu.read(&back)
        });
        bytes
            .chunks(row as usize)
            .take(size as usize)
            .flat_map(|r| bytemuck::pod_collect_to_vec::<u8, f32>(&r[..4 * size as usize]))
            .collect()
    }
}
