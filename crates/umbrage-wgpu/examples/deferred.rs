//! Deferred shading: normals and depth first, then a mask of visibility, then light.
//!
//! `cargo run -p umbrage-wgpu --example deferred`, with `-- --picture out.png` for one picture. The
//! application's shaders do not call the shadows: `ShadowMask` computes visibility for every pixel.

mod support;

use support::{Result, TO_SUN, Target, Town, texture, walk};
use umbrage_wgpu::umbrage::{DirectionalLight, Light, View};
use umbrage_wgpu::{Inputs, MaskFrame, MaskNormals, ShadowConfig, ShadowMask, Shadows, wgpu};

/// A format with a sign, for normals.
const NORMALS: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Red: visibility. Green: 1 where there is a surface.
const MASK: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;

const SURFACES: &str = "
@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    return vec4f(in.normal, 0.0);
}";

const LIGHT: &str = "
@group(0) @binding(0) var normals: texture_2d<f32>;
@group(0) @binding(1) var mask: texture_2d<f32>;

@vertex fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(vec2u((index << 1u) & 2u, index & 2u)) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let lit = textureLoad(mask, pixel, 0).rg;
    if lit.g == 0.0 {
        discard; // the sky
    }
    let normal = textureLoad(normals, pixel, 0).xyz;
    let sun = max(dot(normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0) * lit.r;
    return vec4f(vec3f(0.10, 0.13, 0.2) + sun * vec3f(0.8, 0.72, 0.6), 1.0);
}";

struct Scene {
    town: Town,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
    surfaces: wgpu::RenderPipeline,
    mask: ShadowMask,
    light: wgpu::RenderPipeline,
    light_layout: wgpu::BindGroupLayout,
}

/// Textures drawn before the light, at the size of the image.
struct Buffers {
    normals: wgpu::TextureView,
    mask: wgpu::TextureView,
}

impl Buffers {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let view = |format| texture(device, size, format, usage).create_view(&Default::default());
        Self { normals: view(NORMALS), mask: view(MASK) }
    }
}

impl Scene {
    fn new(device: &wgpu::Device, _: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let town = Town::new(device, 1);
        let shadows = Shadows::new(device, &ShadowConfig::default())?;
        let casters = town.caster_pipeline(&shadows)?;
        let mask = ShadowMask::new(device, shadows.maps(), MASK, MaskNormals::Texture)?;
        let surfaces = town.pipeline(device, SURFACES, &[], NORMALS);
        let light_layout = support::textures(device, 2);
        let light = support::screen_pipeline(device, LIGHT, &light_layout, format);
        Ok(Self { town, shadows, casters, surfaces, mask, light, light_layout })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let view = walk(seconds, target.size)?;
        self.town.look(queue, 0, &view);
        let sun = [Light::from(DirectionalLight::new(-TO_SUN)?)];
        let inputs = Inputs {
            casters: self.town.casters(),
            receivers: &self.town.bounds,
            image_size: target.size,
            ..Inputs::new(&view, &sun)
        };
        self.mask.prepare(queue, &mask_frame(&view, &inputs))?;
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.town.draw_maps(&mut encoder, frame, &self.casters);

        // A renderer keeps these from frame to frame.
        let buffers = Buffers::new(device, target.size);
        let mut pass = target.begin_other(&mut encoder, &buffers.normals);
        self.town.draw(&mut pass, 0, &self.surfaces);
        drop(pass);

        let group = self.mask.bind_group(device, &target.depth, Some(&buffers.normals))?;
        let mut pass = support::screen_pass(&mut encoder, &buffers.mask);
        self.mask.draw(&mut pass, self.shadows.maps(), &group);
        drop(pass);

        let group = support::texture_group(device, &self.light_layout, &[&buffers.normals, &buffers.mask]);
        let mut pass = support::screen_pass(&mut encoder, &target.color);
        pass.set_pipeline(&self.light);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// The camera that drew the depth texture.
fn mask_frame(view: &View, inputs: &Inputs<'_>) -> MaskFrame {
    MaskFrame {
        clip_from_eye: view.clip_from_relative(view.eye()),
        eye: view.eye(),
        forward: view.forward(),
        origin: inputs.origin,
        empty_depth: 0.0,
    }
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("deferred", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
