//! The world of the examples: a plain with boxes on it, and a camera that walks among them. The
//! example `hello_shadows` explains how it is drawn.

use glam::{DVec3, Mat4};
use umbrage_wgpu::umbrage::{Aabb, Frustum, View};
use umbrage_wgpu::{CasterPipeline, ShadowFrame, ShadowMap, Shadows, wgpu};

use super::{ATTRIBUTES, Result, camera, cuboid, pipeline, vertex_buffer};

/// Direction towards the sun.
pub const TO_SUN: DVec3 = DVec3::new(0.6, 0.5, 0.3);

/// The vertex shader of the town's pipelines.
const VERTEX: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Varying {
    return Varying(clip_from_world * vec4f(position, 1.0), position, normal);
}
";

/// A plain and boxes, on the device.
pub struct Town {
    /// Bounds of each box; the first one is the plain. Each has 36 vertices.
    pub bounds: Vec<Aabb>,
    vertices: wgpu::Buffer,
    vertex_count: u32,
    /// One camera for each view.
    cameras: Vec<wgpu::Buffer>,
    groups: Vec<wgpu::BindGroup>,
    layout: wgpu::BindGroupLayout,
}

impl Town {
    /// A town that is seen by as many cameras as `views`.
    pub fn new(device: &wgpu::Device, views: usize) -> Self {
        let mut vertices = Vec::new();
        let plain = cuboid(&mut vertices, DVec3::new(-200.0, -1.0, -200.0), DVec3::new(400.0, 1.0, 400.0));
        let mut bounds = vec![plain];
        for (row, column) in (-12..3).flat_map(|row| (-7..7).map(move |column| (row, column))) {
            let (i, k) = (f64::from(column), f64::from(row));
            let corner = DVec3::new(7.0 * i + 2.0 * (k * 1.7).sin(), 0.0, 8.0 * k + 2.0 * (i * 2.3).sin());
            let size = DVec3::new(1.2 + (i + k).cos().abs(), 1.0 + 4.0 * (i * 3.1 + k).sin().powi(2), 1.6);
            bounds.push(cuboid(&mut vertices, corner, size));
        }
        let (mut cameras, mut groups) = (Vec::new(), Vec::new());
        let (_, layout, _) = camera(device);
        for _ in 0..views {
            let (buffer, _, group) = camera(device);
            cameras.push(buffer);
            groups.push(group);
        }
        let vertex_count = vertices.len() as u32;
        Self { bounds, vertices: vertex_buffer(device, &vertices), vertex_count, cameras, groups, layout }
    }

    /// Bounds of the casters: all boxes but the plain.
    pub fn casters(&self) -> &[Aabb] {
        &self.bounds[1..]
    }

    /// A pipeline that draws the town into maps.
    pub fn caster_pipeline(&self, shadows: &Shadows) -> Result<wgpu::RenderPipeline> {
        let buffers = &[Some(CasterPipeline::positions(24, &ATTRIBUTES))];
        Ok(shadows.caster_pipeline(&CasterPipeline { buffers, ..CasterPipeline::default() })?)
    }

    /// A pipeline that draws the town into images. `text` has a fragment shader of a `Varying`;
    /// `groups` are its bind groups from group 1 on.
    pub fn pipeline(
        &self,
        device: &wgpu::Device,
        text: &str,
        groups: &[Option<&wgpu::BindGroupLayout>],
        format: wgpu::TextureFormat,
    ) -> wgpu::RenderPipeline {
        let groups: Vec<_> = [Some(&self.layout)].into_iter().chain(groups.iter().copied()).collect();
        let vertices = [Some(CasterPipeline::positions(24, &ATTRIBUTES))];
        pipeline(device, &(VERTEX.to_owned() + text), &groups, &vertices, format)
    }

    /// Draws the casters of every map of a frame.
    pub fn draw_maps(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: ShadowFrame<'_>,
        casters: &wgpu::RenderPipeline,
    ) {
        for map in frame.maps() {
            self.draw_map(encoder, &map, casters);
        }
    }

    /// Draws the town's casters into one map; more may be drawn in the returned pass.
    pub fn draw_map<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        map: &ShadowMap<'_>,
        casters: &wgpu::RenderPipeline,
    ) -> wgpu::RenderPass<'e> {
        let mut pass = map.begin(encoder);
        pass.set_pipeline(casters);
        pass.set_bind_group(0, map.bind_group(), &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        let count = self.casters().len() as u32;
        for (caster, instances) in map.casters().filter(|(caster, _)| *caster < count) {
            let first = 36 * (caster + 1);
            pass.draw(first..first + 36, instances);
        }
        pass
    }

    /// Writes the camera of view `index`.
    pub fn look(&self, queue: &wgpu::Queue, index: usize, view: &View) {
        let clip_from_world: Mat4 = view.clip_from_relative(DVec3::ZERO).as_mat4();
        queue.write_buffer(&self.cameras[index], 0, bytemuck::bytes_of(&clip_from_world));
    }

    /// Draws the town as view `index` sees it, with a pipeline of [`Town::pipeline`].
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, index: usize, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.groups[index], &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.vertex_count, 0..1);
    }
}

/// A camera that walks among the boxes, for images of this size.
pub fn walk(seconds: f64, [width, height]: [u32; 2]) -> Result<View> {
    let aspect = f64::from(width) / f64::from(height);
    let lens = Frustum::perspective(60f64.to_radians(), aspect, 0.1, 300.0)?;
    let eye = DVec3::new(4.0, 6.0, 22.0 - 2.0 * (seconds % 30.0));
    let ahead = DVec3::new(0.4 * (0.3 * seconds).sin() - 0.17, -0.25, -1.0);
    Ok(View::look_at_upright(eye, eye + ahead, lens)?)
}
