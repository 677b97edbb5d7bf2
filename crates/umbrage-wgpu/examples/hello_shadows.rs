//! Shadows in a small wgpu program: boxes on a plain, and a camera that walks around them.
//!
//! `cargo run -p umbrage-wgpu --example hello_shadows` opens a window; `cargo run -p umbrage-wgpu
//! --example hello_shadows -- --picture out.png` writes one picture. The marks ◐ show the additions
//! for shadows, in `Scene::new`, `Scene::draw` and the two shaders.

mod support;

use std::error::Error;

use glam::{DVec3, Vec3};
use support::{Target, cuboid, pipeline, vertex_buffer};
use umbrage_wgpu::umbrage::{Aabb, DirectionalLight, Frustum, Light, View};
use umbrage_wgpu::{CasterPipeline, Inputs, ShadowConfig, Shadows, wgpu};

/// Direction towards the sun.
const TO_SUN: DVec3 = DVec3::new(0.6, 0.5, 0.3);

/// The application's own shader, which is appended to the receiver text.
const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Varying {
    return Varying(clip_from_world * vec4f(position, 1.0), position, normal);
}

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = sun * umbrage_visibility(in.position, in.normal); // ◐
    return vec4f(vec3f(0.10, 0.13, 0.2) + light * vec3f(0.8, 0.72, 0.6), 1.0);
}";

/// The scene, and the resources that draw it.
struct Scene {
    vertices: wgpu::Buffer,
    vertex_count: u32,
    /// Bounds of each box; the first one is the plain. Each has 36 vertices.
    bounds: Vec<Aabb>,
    camera: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    boxes: wgpu::RenderPipeline,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
}

impl Scene {
    fn new(device: &wgpu::Device, _: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self, Box<dyn Error>> {
        let (vertices, bounds) = world();
        let vertex_layout = CasterPipeline::positions(24, &support::ATTRIBUTES);

        // ◐ Shadows, and a pipeline that draws casters from the application's own vertices.
        let shadows = Shadows::new(device, &ShadowConfig::default())?;
        let casters = shadows.caster_pipeline(&CasterPipeline {
            buffers: &[Some(vertex_layout.clone())],
            ..CasterPipeline::default()
        })?;

        // The application's pipeline, with the shadows' text before its own shader and their layout
        // in group 1.
        let (camera, camera_layout, camera_group) = support::camera(device);
        let text = shadows.receiver_wgsl(1) + SHADER;
        let groups = [Some(&camera_layout), Some(shadows.bind_group_layout())];
        let boxes = pipeline(device, &text, &groups, &[Some(vertex_layout)], format);
        Ok(Self {
            vertex_count: vertices.len() as u32,
            vertices: vertex_buffer(device, &vertices),
            bounds,
            camera,
            camera_group,
            boxes,
            shadows,
            casters,
        })
    }

    /// Draws the world `seconds` after the beginning.
    fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target: &Target,
        seconds: f64,
    ) -> Result<(), Box<dyn Error>> {
        let view = camera_at(seconds, target.size)?;
        let clip_from_world = view.clip_from_relative(DVec3::ZERO).as_mat4();
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_world));

        // ◐ The frame's light and boxes. Every box but the plain casts a shadow, and all show
        // them.
        let sun = [Light::from(DirectionalLight::new(-TO_SUN)?)];
        let inputs = Inputs {
            casters: &self.bounds[1..],
            receivers: &self.bounds,
            image_size: target.size,
            ..Inputs::new(&view, &sun)
        };
        let frame = self.shadows.prepare(queue, &inputs)?;

        // ◐ Every map is drawn with its casters.
        let mut encoder = device.create_command_encoder(&Default::default());
        for map in frame.maps() {
            let mut pass = map.begin(&mut encoder);
            pass.set_pipeline(&self.casters);
            pass.set_bind_group(0, map.bind_group(), &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            for (caster, instances) in map.casters() {
                let first = 36 * (caster + 1);
                pass.draw(first..first + 36, instances);
            }
        }
        self.shadows.prefilter(&mut encoder);

        // The application's own pass, with the maps bound.
        let mut pass = target.begin(&mut encoder);
        pass.set_pipeline(&self.boxes);
        pass.set_bind_group(0, &self.camera_group, &[]);
        pass.set_bind_group(1, self.shadows.bind_group(), &[]); // ◐
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.vertex_count, 0..1);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// A plain and boxes of many heights on it, as vertices (a position and a normal each) and as
/// bounds.
fn world() -> (Vec<[Vec3; 2]>, Vec<Aabb>) {
    let mut vertices = Vec::new();
    let plain = cuboid(&mut vertices, DVec3::new(-400.0, -1.0, -400.0), DVec3::new(800.0, 1.0, 800.0));
    let mut bounds = vec![plain];
    for row in -20..2 {
        for column in -8..8 {
            let (i, k) = (f64::from(column), f64::from(row));
            let corner = DVec3::new(9.0 * i + 3.0 * (k * 1.7).sin(), 0.0, 11.0 * k + 3.0 * (i * 2.3).sin());
            let size = DVec3::new(1.5 + (i + k).cos().abs(), 1.0 + 5.0 * (i * 3.1 + k).sin().powi(2), 2.0);
            bounds.push(cuboid(&mut vertices, corner, size));
        }
    }
    (vertices, bounds)
}

/// A camera that walks forwards and looks around.
fn camera_at(seconds: f64, [width, height]: [u32; 2]) -> Result<View, Box<dyn Error>> {
    let aspect = f64::from(width) / f64::from(height);
    let lens = Frustum::perspective(60f64.to_radians(), aspect, 0.1, 500.0)?;
    let eye = DVec3::new(6.0, 7.0, 24.0 - 3.0 * (seconds % 30.0));
    let ahead = DVec3::new(0.4 * (0.3 * seconds).sin() - 0.17, -0.2, -1.0);
    Ok(View::look_at_upright(eye, eye + ahead, lens)?)
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    support::run("hello_shadows", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<(), Box<dyn Error>> {
    run(&support::arguments())
}
