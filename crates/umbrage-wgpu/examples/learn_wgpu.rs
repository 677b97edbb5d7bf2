//! Shadows in a renderer as wgpu tutorials build it: cgmath, `f32` matrices, depth from 0 to 1, a
//! camera in group 1, a light in group 2, instances with a matrix each.
//!
//! `cargo run -p umbrage-wgpu --example learn_wgpu`, with `-- --picture out.png` for one picture.
//! The marks ◐ show the additions for shadows: shadows take group 3, and the renderer's matrices
//! unchanged.

mod support;

use cgmath::{Deg, InnerSpace, Matrix4, Point3, Quaternion, Rotation3, Vector3};
use support::{ATTRIBUTES, Result, Target, cuboid, vertex_buffer};
use umbrage_wgpu::umbrage::{Aabb, DepthConvention, DirectionalLight, Light, View};
use umbrage_wgpu::{CasterPipeline, Inputs, ShadowConfig, Shadows, wgpu};
use wgpu::util::DeviceExt;

/// Converts OpenGL's depth, from -1 to 1, to wgpu's, from 0 to 1.
const OPENGL_TO_WGPU_MATRIX: Matrix4<f32> = Matrix4::new(
    1.0, 0.0, 0.0, 0.0, //
    0.0, 1.0, 0.0, 0.0, //
    0.0, 0.0, 0.5, 0.0, //
    0.0, 0.0, 0.5, 1.0,
);
const INSTANCES_PER_ROW: i32 = 10;
const TO_SUN: Vector3<f32> = Vector3::new(0.6, 0.5, 0.3);

/// Vertex layout of an instance's matrix: four columns.
const INSTANCE: wgpu::VertexBufferLayout<'_> = wgpu::VertexBufferLayout {
    array_stride: 64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4],
};

/// ◐ Casters: the application's instances in its own vertex layout.
const CASTER: &str = include_str!("casters/instance_buffer.wgsl");

const SHADER: &str = "
struct Instance {
    @location(5) x: vec4f,
    @location(6) y: vec4f,
    @location(7) z: vec4f,
    @location(8) w: vec4f,
}

@group(0) @binding(0) var<uniform> tint: vec4f;
@group(1) @binding(0) var<uniform> view_proj: mat4x4f;
@group(2) @binding(0) var<uniform> to_sun: vec4f;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

@vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, row: Instance) -> Varying {
    let model = mat4x4f(row.x, row.y, row.z, row.w);
    let world = (model * vec4f(position, 1.0)).xyz;
    return Varying(view_proj * vec4f(world, 1.0), world, normalize((model * vec4f(normal, 0.0)).xyz));
}

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let diffuse = max(dot(in.normal, to_sun.xyz), 0.0);
    let lit = umbrage_visibility(in.world, in.normal); // ◐
    return vec4f((0.2 + 0.8 * diffuse * lit) * tint.rgb, 1.0);
}";

struct State {
    vertices: wgpu::Buffer,
    instances: wgpu::Buffer,
    bounds: Vec<Aabb>,
    groups: [wgpu::BindGroup; 3],
    camera: wgpu::Buffer,
    pipeline: wgpu::RenderPipeline,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
}

impl State {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let mut vertices = Vec::new();
        let cube = cuboid(&mut vertices, [-0.5; 3].into(), [1.0; 3].into());
        let models = models();
        // ◐ The box of an instance is that of the mesh where the instance's matrix places it.
        let bounds = models.iter().map(|model| cube.transformed(Into::<[[f32; 4]; 4]>::into(*model))).collect();
        let models: Vec<[[f32; 4]; 4]> = models.into_iter().map(Into::into).collect();
        let instances = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&models),
            usage: wgpu::BufferUsages::VERTEX,
        });

        let (tint, tint_layout, tint_group) = support::uniform(device, wgpu::ShaderStages::FRAGMENT, 16);
        let (camera, camera_layout, camera_group) = support::camera(device);
        let (light, light_layout, light_group) = support::uniform(device, wgpu::ShaderStages::FRAGMENT, 16);
        queue.write_buffer(&tint, 0, bytemuck::bytes_of(&[0.9f32, 0.8, 0.7, 1.0]));
        let to_sun: [f32; 4] = TO_SUN.normalize().extend(0.0).into();
        queue.write_buffer(&light, 0, bytemuck::bytes_of(&to_sun));

        // ◐ Shadows in group 3, and their text before the shader.
        let shadows = Shadows::new(device, &ShadowConfig::default())?;
        let buffers = [Some(CasterPipeline::positions(24, &ATTRIBUTES)), Some(INSTANCE)];
        let casters = shadows.caster_pipeline(&CasterPipeline {
            buffers: &buffers,
            wgsl: CASTER,
            ..CasterPipeline::default()
        })?;
        let groups = [Some(&tint_layout), Some(&camera_layout), Some(&light_layout), Some(shadows.bind_group_layout())];
        let text = shadows.receiver_wgsl(3) + SHADER;
        let less = wgpu::CompareFunction::Less;
        let pipeline = support::pipeline_with(device, &text, &groups, &buffers, format, less);
        let (vertices, groups) = (vertex_buffer(device, &vertices), [tint_group, camera_group, light_group]);
        Ok(Self { vertices, instances, bounds, groups, camera, pipeline, shadows, casters })
    }

    fn render(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let aspect = target.size[0] as f32 / target.size[1] as f32;
        let eye =
            Point3::new(12.0 * (0.2 * seconds as f32 + 0.5).sin(), 7.0, 12.0 * (0.2 * seconds as f32 + 0.5).cos());
        let view = Matrix4::look_at_rh(eye, Point3::new(0.0, 0.0, 0.0), Vector3::unit_y());
        let view_proj = OPENGL_TO_WGPU_MATRIX * cgmath::perspective(Deg(45.0), aspect, 0.1, 100.0) * view;
        let view_proj: [[f32; 4]; 4] = view_proj.into();
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&view_proj));

        // ◐ The camera is the matrix that the shader has.
        let view = View::from_clip_from_world(view_proj, DepthConvention::ZeroToOne)?;
        let sun = [Light::from(DirectionalLight::new(-glam::DVec3::new(0.6, 0.5, 0.3))?)];
        let inputs = Inputs {
            casters: &self.bounds,
            receivers: &self.bounds,
            image_size: target.size,
            ..Inputs::new(&view, &sun)
        };
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        for map in frame.maps() {
            let mut pass = map.begin(&mut encoder);
            pass.set_pipeline(&self.casters);
            pass.set_bind_group(0, map.bind_group(), &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_vertex_buffer(1, self.instances.slice(..));
            // Casters are rows of the instance buffer.
            for rows in map.rows().expect("one map a pass, with this layout") {
                pass.draw(0..36, rows);
            }
        }

        let mut pass = target.begin_far(&mut encoder, 1.0);
        pass.set_pipeline(&self.pipeline);
        for (index, group) in self.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.set_bind_group(3, self.shadows.bind_group(), &[]); // ◐
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        pass.draw(0..36, 0..self.bounds.len() as u32);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// A floor, and rows of cubes that turn about their places.
fn models() -> Vec<Matrix4<f32>> {
    let floor =
        Matrix4::from_translation(Vector3::new(0.0, -1.5, 0.0)) * Matrix4::from_nonuniform_scale(60.0, 0.1, 60.0);
    let cube = |i: i32| {
        let (x, z) = (i % INSTANCES_PER_ROW, i / INSTANCES_PER_ROW);
        let place = 1.6 * (Vector3::new(x as f32, 0.0, z as f32) - Vector3::new(4.5, 0.0, 4.5));
        let axis = (place + Vector3::unit_y()).normalize();
        let turned = Quaternion::from_axis_angle(axis, Deg(45.0));
        Matrix4::from_translation(place) * Matrix4::from(turned) * Matrix4::from_scale(0.8)
    };
    std::iter::once(floor).chain((0..INSTANCES_PER_ROW * INSTANCES_PER_ROW).map(cube)).collect()
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("learn_wgpu", arguments, State::new, State::render)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
