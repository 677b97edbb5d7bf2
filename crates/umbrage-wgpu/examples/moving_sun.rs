//! A sun that moves in steps, with a fade from each to the next, so that no shadow edge crawls.
//!
//! `cargo run -p umbrage-wgpu --example moving_sun`, with `-- --picture out.png` for one picture.
//! The sun that is faded out and the one that is faded in are two lights with maps of their own;
//! the first one's maps are drawn only during a fade.

mod support;

use glam::DVec3;
use support::{Result, Target, Town, walk};
use umbrage_wgpu::umbrage::config::LightKind;
use umbrage_wgpu::umbrage::{DirectionalLight, Light, SteppedSun};
use umbrage_wgpu::{Inputs, ShadowConfig, Shadows, wgpu};

const FRAGMENT: &str = "
struct Sun { toward: vec3f, weight: f32 }
@group(2) @binding(0) var<uniform> sun: Sun;

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    var query = umbrage_query(in.position, in.normal);
    query.light = 1u;
    var visibility = umbrage_shadow(query).visibility;
    if sun.weight < 1.0 {
        query.light = 0u;
        visibility = mix(umbrage_shadow(query).visibility, visibility, sun.weight);
    }
    let light = max(dot(in.normal, sun.toward), 0.0) * visibility;
    return vec4f(vec3f(0.10, 0.13, 0.2) + light * vec3f(0.8, 0.72, 0.6), 1.0);
}";

struct Scene {
    town: Town,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
    boxes: wgpu::RenderPipeline,
    sun: wgpu::Buffer,
    sun_group: wgpu::BindGroup,
    stepped: SteppedSun,
    seconds: f64,
}

impl Scene {
    fn new(device: &wgpu::Device, _: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let town = Town::new(device, 1);
        let shadows = Shadows::with_lights(device, &ShadowConfig::default(), &[LightKind::Directional; 2])?;
        let casters = town.caster_pipeline(&shadows)?;
        let (sun, sun_layout, sun_group) = support::uniform(device, wgpu::ShaderStages::FRAGMENT, 16);
        let text = shadows.receiver_wgsl(1) + FRAGMENT;
        let groups = [Some(shadows.bind_group_layout()), Some(&sun_layout)];
        let boxes = town.pipeline(device, &text, &groups, format);
        // Steps of half a degree, each faded over two seconds.
        let stepped = SteppedSun::new(0.5f64.to_radians(), 2.0)?;
        Ok(Self { town, shadows, casters, boxes, sun, sun_group, stepped, seconds: 0.0 })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let view = walk(0.0, target.size)?;
        self.town.look(queue, 0, &view);

        // An hour of the day in thirty seconds: half a degree a second.
        let angle = (35.0 + 0.5 * (seconds % 200.0)).to_radians();
        let toward = DVec3::new(angle.cos(), angle.sin(), 0.4).normalize();
        let fade = self.stepped.follow(&DirectionalLight::new(-toward)?, seconds - self.seconds)?;
        self.seconds = seconds;
        let uniform = toward.as_vec3().extend(fade.weight as f32);
        queue.write_buffer(&self.sun, 0, bytemuck::bytes_of(&uniform));

        let suns = [Light::from(fade.from), Light::from(fade.to)];
        let inputs = Inputs {
            casters: self.town.casters(),
            receivers: &self.town.bounds,
            image_size: target.size,
            ..Inputs::new(&view, &suns)
        };
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        for map in frame.maps().filter(|map| map.light() == 1 || fade.is_fading()) {
            self.town.draw_map(&mut encoder, &map, &self.casters);
        }
        let mut pass = target.begin(&mut encoder);
        pass.set_bind_group(1, self.shadows.bind_group(), &[]);
        pass.set_bind_group(2, &self.sun_group, &[]);
        self.town.draw(&mut pass, 0, &self.boxes);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("moving_sun", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
