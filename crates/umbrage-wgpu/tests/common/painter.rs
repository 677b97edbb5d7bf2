//! An application with boxes for casters behind the front door, and what its frames come to.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use umbrage::{Aabb, View};
use umbrage_wgpu::{CasterPipeline, Inputs, ShadowConfig, Shadows};

use super::{Gpu, cuboid};

/// Vertices of a box.
const CORNERS: u32 = 36;

/// Points of a mask, across and down.
const POINTS: [u32; 2] = [64, 48];

/// What a frame came to.
pub struct Painted {
    /// The texels of each map that answers.
    pub maps: Vec<Vec<f32>>,
    /// Visibility of the ground, ray by ray of the view.
    pub mask: Vec<f32>,
    /// Whether each split waits for its texels.
    pub handed_on: Vec<bool>,
    /// Triangles drawn into maps and what is kept of them.
    pub triangles: u64,
}

/// Shadows, and the pipelines that draw and ask.
pub struct Painter {
    pub shadows: Shadows,
    casters: wgpu::RenderPipeline,
    asks: Asks,
}

impl Painter {
    pub fn new(gpu: &Gpu, config: &ShadowConfig) -> Self {
        gpu.checked(|| {
            let shadows = Shadows::new(&gpu.device, config).expect("a valid config");
            let casters = shadows.caster_pipeline(&CasterPipeline::default()).expect("a pipeline");
            let asks = Asks::new(gpu, &shadows);
            Self { shadows, casters, asks }
        })
    }

    /// Draws a frame of `boxes` by key, and reads everything back.
    pub fn paint(&mut self, gpu: &Gpu, inputs: &Inputs<'_>, boxes: &BTreeMap<u32, Aabb>) -> Painted {
        let corner = |at: DVec3| (at - inputs.origin).as_vec3();
        let corners: Vec<Vec3> = boxes.values().flat_map(|it| cuboid(corner(it.min), corner(it.max))).collect();
        let first: BTreeMap<u32, u32> = boxes.keys().copied().zip((0..).step_by(CORNERS as usize)).collect();
        self.shadows.prepare(&gpu.queue, inputs).expect("a frame");
        let mut triangles = 0;
        gpu.checked(|| {
            let vertices = gpu.buffer_with(bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            for map in self.shadows.frame().maps() {
                let mut pass = map.begin(&mut encoder);
                pass.set_pipeline(&self.casters);
                pass.set_bind_group(0, map.bind_group(), &[]);
                pass.set_vertex_buffer(0, vertices.slice(..));
                for (caster, instances) in map.casters() {
                    triangles += u64::from(CORNERS / 3);
                    pass.draw(first[&caster]..first[&caster] + CORNERS, instances);
                }
            }
            self.shadows.prefilter(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
        });
        let plan = self.shadows.frame().shared_plan(0);
        let answers = |&split: &usize| !plan.splits[split].casters.is_empty();
        Painted {
            maps: (0..plan.splits.len()).filter(answers).map(|split| texels(gpu, &self.shadows, split)).collect(),
            mask: self.asks.mask(gpu, &self.shadows, inputs.view, inputs.origin),
            handed_on: (0..plan.splits.len()).map(|split| plan.is_handed_on(split)).collect(),
            triangles,
        }
    }
}

/// The texels of a split's map in a layer of its own.
pub fn texels(gpu: &Gpu, shadows: &Shadows, split: usize) -> Vec<f32> {
    let (maps, size) = (shadows.maps(), shadows.maps().map_size(split));
    let texture = maps.map_texture(split);
    let (layer, corner) = maps.map_place(split);
    let edge = texture.width();
    let row = (4 * edge).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = gpu.checked(|| {
        let back = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Test::texels"),
            size: u64::from(row * texture.height()),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
                aspect: wgpu::TextureAspect::DepthOnly,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &back,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            wgpu::Extent3d { width: edge, height: texture.height(), depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        gpu.read(&back)
    });
    let rows = bytes.chunks(row as usize).skip(corner[1] as usize).take(size as usize);
    let begin = 4 * corner[0] as usize;
    rows.flat_map(|row| bytemuck::pod_collect_to_vec::<u8, f32>(&row[begin..begin + 4 * size as usize])).collect()
}

/// Asks the maps where rays through the view meet the ground.
struct Asks {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

const SHADER: &str = "
@group(0) @binding(0) var<storage, read> asks: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> answers: array<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    answers[id.x] = umbrage_visibility(asks[id.x].xyz, vec3f(0.0, 1.0, 0.0));
}";

impl Asks {
    fn new(gpu: &Gpu, shadows: &Shadows) -> Self {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Test::asks"),
            source: wgpu::ShaderSource::Wgsl((shadows.receiver_wgsl(1) + SHADER).into()),
        });
        let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Test::asks"),
            entries: &[storage(0, true), storage(1, false)],
        });
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Test::asks"),
            bind_group_layouts: &[Some(&layout), Some(shadows.bind_group_layout())],
            immediate_size: 0,
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("Test::asks"),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        });
        Self { pipeline, layout }
    }

    fn mask(&self, gpu: &Gpu, shadows: &Shadows, view: &View, origin: DVec3) -> Vec<f32> {
        let asks = ground(view, origin);
        let bytes = (4 * asks.len()) as u64;
        gpu.checked(|| {
            let input = gpu.buffer_with(bytemuck::cast_slice(&asks), wgpu::BufferUsages::STORAGE);
            let output =
                gpu.buffer_with(&vec![0; bytes as usize], wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
            let back = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("Test::mask"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Test::asks"),
                layout: &self.layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
                ],
            });
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.set_bind_group(1, shadows.bind_group(), &[]);
                pass.dispatch_workgroups((asks.len() as u32).div_ceil(64), 1, 1);
            }
            encoder.copy_buffer_to_buffer(&output, 0, &back, 0, bytes);
            gpu.queue.submit([encoder.finish()]);
            bytemuck::pod_collect_to_vec(&gpu.read(&back))
        })
    }
}

/// Where rays through the view's pixels meet the ground, relative to the origin.
fn ground(view: &View, origin: DVec3) -> Vec<[f32; 4]> {
    let lens = view.frustum();
    let mut asks = Vec::new();
    for y in 0..POINTS[1] {
        for x in 0..POINTS[0] {
            let [u, v] = [(x, POINTS[0]), (y, POINTS[1])].map(|(at, of)| (f64::from(at) + 0.5) / f64::from(of));
            let across =
                DVec3::new(lens.left + (lens.right - lens.left) * u, lens.bottom + (lens.top - lens.bottom) * v, -1.0);
            let ray = view.world_from_view_point(across) - view.eye();
            let along = -view.eye().y / ray.y;
            if along > 0.0 && along < 85.0 {
                asks.push((view.eye() + along * ray - origin).as_vec3().extend(0.0).to_array());
            }
        }
    }
    asks
}
