//! A wood of 10,000 trees whose shadows cost nothing while nothing moves.
//!
//! `cargo run -p umbrage-wgpu --example large_world`, with `-- --picture out.png` for one picture.
//! Trees are a `CasterSet`, so that planning looks only at trees in view; with `cache kept` each
//! part of a map is drawn once. A cart drives through the wood and is drawn in every frame.

mod support;

use glam::{DVec3, Vec4};
use support::{ATTRIBUTES, Result, TO_SUN, Target, cuboid, pipeline, vertex_buffer};
use umbrage_wgpu::umbrage::config::{Cache, Preset, Selection, SplitMetric};
use umbrage_wgpu::umbrage::{Aabb, Caster, CasterHandle, CasterSet, DirectionalLight, Frustum, Light, Motion, View};
use umbrage_wgpu::{CasterPipeline, Inputs, ShadowConfig, Shadows, wgpu};
use wgpu::util::DeviceExt;

const TREES: u32 = 10_000;
/// Edge of the wood in metres.
const EDGE: f64 = 1000.0;

/// Vertex ranges of the meshes, one after the other.
const TREE: std::ops::Range<u32> = 0..72;
const CART: std::ops::Range<u32> = 72..108;
const PLAIN: std::ops::Range<u32> = 108..144;

const CASTER: &str = "
@vertex fn vertex(@location(0) local: vec3f, @location(2) place: vec4f, instance: UmbrageInstance) -> UmbrageCast {
    return umbrage_cast(place.xyz + place.w * local, instance);
}";

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) green: f32,
}

@vertex fn vertex(@location(0) local: vec3f, @location(1) normal: vec3f, @location(2) place: vec4f) -> Varying {
    let position = place.xyz + place.w * local;
    let green = clamp(0.5 * local.y, 0.15, 1.0);
    return Varying(clip_from_world * vec4f(position, 1.0), position, normal, green);
}

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = vec3f(0.2, 0.25, 0.35) + sun * umbrage_visibility(in.position, in.normal) * vec3f(0.9, 0.8, 0.65);
    return vec4f(light * mix(vec3f(0.5, 0.42, 0.3), vec3f(0.25, 0.5, 0.2), in.green), 1.0);
}";

struct Scene {
    vertices: wgpu::Buffer,
    /// Position and size of each tree, and last those of the cart and of the plain.
    rows: wgpu::Buffer,
    camera: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    surfaces: wgpu::RenderPipeline,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
    set: CasterSet,
    cart: CasterHandle,
}

impl Scene {
    fn new(device: &wgpu::Device, _: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let mut vertices = Vec::new();
        cuboid(&mut vertices, DVec3::new(-0.1, 0.0, -0.1), DVec3::new(0.2, 1.0, 0.2));
        cuboid(&mut vertices, DVec3::new(-0.6, 1.0, -0.6), DVec3::new(1.2, 2.0, 1.2));
        cuboid(&mut vertices, DVec3::new(-1.0, 0.4, -1.6), DVec3::new(2.0, 1.0, 3.2));
        let plain = cuboid(&mut vertices, DVec3::new(-EDGE, -1.0, -EDGE), DVec3::new(2.0 * EDGE, 1.0, 2.0 * EDGE));

        // Keys are rows of the instance buffer.
        let places: Vec<Vec4> = (0..TREES).map(tree).collect();
        let mut set = CasterSet::new();
        set.insert_all(places.iter().zip(0..).map(|(place, key)| Caster::new(tree_bounds(*place), key)))?;
        let cart = set.insert(Caster { motion: Motion::Moving, ..Caster::new(cart_bounds(cart_at(0.0)), TREES) })?;
        set.insert(Caster { casts: false, ..Caster::new(plain, TREES + 1) })?;
        let places: Vec<Vec4> = places.into_iter().chain([Vec4::W, Vec4::W]).collect();

        // What is kept needs maps that stand exactly still, and splits chosen by view depth.
        let selection = Selection::Interval(SplitMetric::ViewDepth);
        let config = ShadowConfig { cache: Cache::Kept, selection, ..Preset::Still.config() };
        let shadows = Shadows::new(device, &config)?;
        let places_layout = wgpu::VertexBufferLayout {
            array_stride: 16,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![2 => Float32x4],
        };
        let buffers = [Some(CasterPipeline::positions(24, &ATTRIBUTES)), Some(places_layout)];
        let casters = shadows.caster_pipeline(&CasterPipeline {
            buffers: &buffers,
            wgsl: CASTER,
            ..CasterPipeline::default()
        })?;
        let (camera, camera_layout, camera_group) = support::camera(device);
        let groups = [Some(&camera_layout), Some(shadows.bind_group_layout())];
        let surfaces = pipeline(device, &(shadows.receiver_wgsl(1) + SHADER), &groups, &buffers, format);
        let rows = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&places),
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        });
        let vertices = vertex_buffer(device, &vertices);
        Ok(Self { vertices, rows, camera, camera_group, surfaces, shadows, casters, set, cart })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let view = camera_at(seconds, target.size)?;
        let clip_from_world = view.clip_from_relative(DVec3::ZERO).as_mat4();
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_world));

        // Only what moves is told to the set.
        let cart = cart_at(seconds);
        self.set.set_bounds(self.cart, cart_bounds(cart))?;
        queue.write_buffer(&self.rows, u64::from(TREES) * 16, bytemuck::bytes_of(&cart.as_vec3().extend(1.0)));

        let sun = [Light::from(DirectionalLight::new(-TO_SUN)?)];
        let inputs = Inputs { set: Some(&self.set), image_size: target.size, ..Inputs::new(&view, &sun) };
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        // Regions of maps that are new, and maps that have something moving over them: often none.
        for map in frame.maps() {
            let mut pass = map.begin(&mut encoder);
            pass.set_pipeline(&self.casters);
            pass.set_bind_group(0, map.bind_group(), &[]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_vertex_buffer(1, self.rows.slice(..));
            for rows in map.rows().expect("one map a pass, with this layout") {
                let trees = rows.start..rows.end.min(TREES);
                if !trees.is_empty() {
                    pass.draw(TREE, trees);
                }
                if rows.contains(&TREES) {
                    pass.draw(CART, TREES..TREES + 1);
                }
            }
        }

        let mut pass = target.begin(&mut encoder);
        pass.set_pipeline(&self.surfaces);
        pass.set_bind_group(0, &self.camera_group, &[]);
        pass.set_bind_group(1, self.shadows.bind_group(), &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.rows.slice(..));
        pass.draw(TREE, 0..TREES);
        pass.draw(CART, TREES..TREES + 1);
        pass.draw(PLAIN, TREES + 1..TREES + 2);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// Position and size of a tree; none stands on the path.
fn tree(index: u32) -> Vec4 {
    let [x, z, size] = [0.754_877_67, 0.569_840_29, 0.381_966_01].map(|step| (f64::from(index) * step).fract());
    let beside = EDGE * (x - 0.5);
    let x = beside + 6.0 * beside.signum();
    DVec3::new(x, 0.0, EDGE * (z - 0.5)).as_vec3().extend(2.0 + 3.0 * size as f32)
}

fn tree_bounds(place: Vec4) -> Aabb {
    let (at, size) = (place.truncate().as_dvec3(), f64::from(place.w));
    Aabb::new(at - size * DVec3::new(0.6, 0.0, 0.6), at + size * DVec3::new(0.6, 3.0, 0.6))
}

fn cart_at(seconds: f64) -> DVec3 {
    DVec3::new(1.5, 0.0, -14.0 - 4.0 * (seconds % 60.0))
}

fn cart_bounds(at: DVec3) -> Aabb {
    Aabb::new(at + DVec3::new(-1.0, 0.4, -1.6), at + DVec3::new(1.0, 1.4, 1.6))
}

/// A camera that walks along the path.
fn camera_at(seconds: f64, [width, height]: [u32; 2]) -> Result<View> {
    let lens = Frustum::perspective(60f64.to_radians(), f64::from(width) / f64::from(height), 0.1, 800.0)?;
    let eye = DVec3::new(-2.0, 2.5, -1.4 * (seconds % 120.0));
    Ok(View::look_at_upright(eye, eye + DVec3::new(0.1 * (0.2 * seconds).sin(), -0.06, -1.0), lens)?)
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("large_world", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
