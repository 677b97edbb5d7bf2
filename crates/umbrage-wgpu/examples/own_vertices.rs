//! Casters with their own shaders: packed vertices, holes from a texture, and bones.
//!
//! `cargo run -p umbrage-wgpu --example own_vertices`, with `-- --picture out.png` for one picture.
//! Nets wave in the wind. Their vertices are 16-bit integers, a texture makes holes in their
//! meshes, and two bones move them, in the maps as in the image.

mod support;

use glam::{DVec3, Mat4, Vec3};
use support::{Result, TO_SUN, Target, Town, pipeline, walk};
use umbrage_wgpu::umbrage::{Aabb, DirectionalLight, Light};
use umbrage_wgpu::{CasterPipeline, Inputs, ShadowConfig, Shadows, wgpu};
use wgpu::util::DeviceExt;

/// Length in metres of the largest 16-bit integer.
const SCALE: f64 = 64.0;
const NETS: usize = 3;
/// Number of rows of quads in a net, from its upper edge to the lower.
const ROWS: usize = 8;
/// Largest displacement of a net by the wind, in metres.
const SWAY: f64 = 1.2;

/// A vertex: position as a share of [`SCALE`], with the weight of the second bone, and texture
/// coordinates.
const LAYOUT: wgpu::VertexBufferLayout<'_> = wgpu::VertexBufferLayout {
    array_stride: 12,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Snorm16x4, 1 => Unorm16x2],
};

/// WGSL shared by casters and receivers: the application's own group, with a placeholder for the
/// group's number.
const SKIN: &str = "
@group(GROUP) @binding(0) var<uniform> bones: array<mat4x4f, 2>;
@group(GROUP) @binding(1) var net: texture_2d<f32>;
@group(GROUP) @binding(2) var repeat: sampler;

fn skinned(packed: vec4f) -> vec3f {
    let rest = vec4f(64.0 * packed.xyz, 1.0);
    return mix((bones[0] * rest).xyz, (bones[1] * rest).xyz, packed.w);
}
";

const CASTER: &str = "
@vertex fn vertex(@location(0) packed: vec4f, @location(1) uv: vec2f, instance: UmbrageInstance) -> UmbrageCast {
    var result = umbrage_cast(skinned(packed), instance);
    result.uv = uv;
    return result;
}

@fragment fn fragment(@builtin(position) at: vec4f, @location(0) uv: vec2f) -> @location(0) UmbrageTexel {
    if textureSample(net, repeat, 8.0 * uv).r < 0.5 {
        discard;
    }
    return umbrage_caster_texel(at, 0u);
}";

const RECEIVER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) uv: vec2f,
}

@vertex fn vertex(@location(0) packed: vec4f, @location(1) uv: vec2f) -> Varying {
    let position = skinned(packed);
    return Varying(clip_from_world * vec4f(position, 1.0), position, uv);
}

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    // The triangle's own normal, turned towards the eye: nets have two sides.
    let normal = normalize(cross(dpdy(in.position), dpdx(in.position)));
    let hole = textureSample(net, repeat, 8.0 * in.uv).r;
    let sun = abs(dot(normal, normalize(vec3f(0.6, 0.5, 0.3))));
    let lit = umbrage_visibility(in.position, normal);
    if hole < 0.5 {
        discard;
    }
    return vec4f((0.25 + 0.75 * sun * lit) * vec3f(0.85, 0.35, 0.2), 1.0);
}";

const TOWN: &str = "
@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = sun * umbrage_visibility(in.position, in.normal);
    return vec4f(vec3f(0.10, 0.13, 0.2) + light * vec3f(0.8, 0.72, 0.6), 1.0);
}";

struct Scene {
    town: Town,
    /// Bounds of the town's casters, followed by those of the nets.
    casters: Vec<Aabb>,
    vertices: wgpu::Buffer,
    bones: wgpu::Buffer,
    skin_group: wgpu::BindGroup,
    camera: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    shadows: Shadows,
    town_casters: wgpu::RenderPipeline,
    town_surfaces: wgpu::RenderPipeline,
    net_casters: wgpu::RenderPipeline,
    net_surfaces: wgpu::RenderPipeline,
}

impl Scene {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let town = Town::new(device, 1);
        let shadows = Shadows::new(device, &ShadowConfig::default())?;
        let (bones, skin_layout, skin_group) = skin(device, queue);

        // The application's own vertices, fragment shader and group, in the pipeline of casters.
        let net_casters = shadows.caster_pipeline(&CasterPipeline {
            buffers: &[Some(LAYOUT)],
            wgsl: &(SKIN.replace("GROUP", "1") + CASTER),
            members: "@location(0) uv: vec2f,",
            discards: true,
            bind_group_layouts: &[Some(&skin_layout)],
            ..CasterPipeline::default()
        })?;
        let (camera, camera_layout, camera_group) = support::camera(device);
        let text = shadows.receiver_wgsl(1) + &SKIN.replace("GROUP", "2") + RECEIVER;
        let groups = [Some(&camera_layout), Some(shadows.bind_group_layout()), Some(&skin_layout)];
        let net_surfaces = pipeline(device, &text, &groups, &[Some(LAYOUT)], format);
        let town_casters = town.caster_pipeline(&shadows)?;
        let text = shadows.receiver_wgsl(1) + TOWN;
        let town_surfaces = town.pipeline(device, &text, &[Some(shadows.bind_group_layout())], format);
        let vertices = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&(0..NETS).flat_map(net).collect::<Vec<[i16; 6]>>()),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let casters = town.casters().iter().copied().chain((0..NETS).map(net_bounds)).collect();
        Ok(Self {
            town,
            casters,
            vertices,
            bones,
            skin_group,
            camera,
            camera_group,
            shadows,
            town_casters,
            town_surfaces,
            net_casters,
            net_surfaces,
        })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let view = walk(0.3 * seconds, target.size)?;
        self.town.look(queue, 0, &view);
        let clip_from_world = view.clip_from_relative(DVec3::ZERO).as_mat4();
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_world));
        let wind = SWAY as f32 * (2.0 * seconds + 1.0).sin() as f32;
        let bones = [Mat4::IDENTITY, Mat4::from_translation(Vec3::new(0.0, 0.0, wind))];
        queue.write_buffer(&self.bones, 0, bytemuck::cast_slice(&bones));

        let sun = [Light::from(DirectionalLight::new(-TO_SUN)?)];
        let receivers = [&self.casters[..], &self.town.bounds[..1]].concat();
        let inputs = Inputs {
            casters: &self.casters,
            receivers: &receivers,
            image_size: target.size,
            ..Inputs::new(&view, &sun)
        };
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        let boxes = self.town.casters().len() as u32;
        for map in frame.maps() {
            let mut pass = self.town.draw_map(&mut encoder, &map, &self.town_casters);
            pass.set_pipeline(&self.net_casters);
            pass.set_bind_group(1, &self.skin_group, &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            for (caster, instances) in map.casters().filter(|(caster, _)| *caster >= boxes) {
                let first = 6 * ROWS as u32 * (caster - boxes);
                pass.draw(first..first + 6 * ROWS as u32, instances);
            }
        }
        let mut pass = target.begin(&mut encoder);
        pass.set_bind_group(1, self.shadows.bind_group(), &[]);
        self.town.draw(&mut pass, 0, &self.town_surfaces);
        pass.set_pipeline(&self.net_surfaces);
        pass.set_bind_group(0, &self.camera_group, &[]);
        pass.set_bind_group(2, &self.skin_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..(6 * ROWS * NETS) as u32, 0..1);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// Upper left corner of a net in metres; a net is 3 m wide and 5 m high.
fn corner(net: usize) -> DVec3 {
    DVec3::new(4.0 * net as f64 - 2.5, 5.2, 13.0 - 1.5 * net as f64)
}

/// The triangles of a net: a column of quads.
fn net(net: usize) -> Vec<[i16; 6]> {
    let vertex = |right: usize, down: usize| {
        let share = down as f64 / ROWS as f64;
        let at = corner(net) + DVec3::new(3.0 * right as f64, -5.0 * share, 0.0);
        let [x, y, z] = (at / SCALE * f64::from(i16::MAX)).round().to_array().map(|value| value as i16);
        // Texture coordinates are unsigned: the same sixteen bits.
        let uv = [right as f64, share].map(|value| (value * f64::from(u16::MAX)) as u16 as i16);
        [x, y, z, (share * f64::from(i16::MAX)) as i16, uv[0], uv[1]]
    };
    let quad = |row: usize| [(0, row), (0, row + 1), (1, row + 1), (0, row), (1, row + 1), (1, row)];
    (0..ROWS).flat_map(quad).map(|(right, down)| vertex(right, down)).collect()
}

/// Bounds of a net over all its positions in the wind.
fn net_bounds(net: usize) -> Aabb {
    let (corner, sway) = (corner(net), DVec3::Z * SWAY);
    Aabb::new(corner - DVec3::Y * 5.0 - sway, corner + DVec3::X * 3.0 + sway)
}

/// The buffer of bones, and the layout and bind group of bones and texture.
fn skin(device: &wgpu::Device, queue: &wgpu::Queue) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    let bones = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 128,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = support::skin_layout(device);
    let (net, repeat) = support::net_texture(device, queue);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: bones.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&net) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&repeat) },
        ],
    });
    (bones, layout, group)
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("own_vertices", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
