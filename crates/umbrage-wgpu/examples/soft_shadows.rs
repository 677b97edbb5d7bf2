//! Soft shadows from moments: maps are blurred once, and a pixel needs one look-up.
//!
//! `cargo run -p umbrage-wgpu --example soft_shadows`, with `-- --picture out.png` for one picture.
//! The differences from `hello_shadows` are the config, `Shadows::prefilter`, and a query with the
//! pixel's footprint.

mod support;

use support::{Result, TO_SUN, Target, Town, walk};
use umbrage_wgpu::umbrage::config::{Filter, MomentKind, Moments};
use umbrage_wgpu::umbrage::{DirectionalLight, Light};
use umbrage_wgpu::{Inputs, ShadowConfig, Shadows, wgpu};

const FRAGMENT: &str = "
@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    // Derivatives choose the level of the blurred maps, as with any other texture.
    let query = umbrage_fragment_query(in.position, in.normal, dpdx(in.position), dpdy(in.position), in.clip.xy);
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = sun * umbrage_shadow(query).visibility;
    return vec4f(vec3f(0.10, 0.13, 0.2) + light * vec3f(0.8, 0.72, 0.6), 1.0);
}";

struct Scene {
    town: Town,
    shadows: Shadows,
    casters: wgpu::RenderPipeline,
    boxes: wgpu::RenderPipeline,
}

impl Scene {
    fn new(device: &wgpu::Device, _: &wgpu::Queue, format: wgpu::TextureFormat) -> Result<Self> {
        let town = Town::new(device, 1);
        let moments = Moments { width_m: Some(0.6), ..Moments::new(MomentKind::Evsm4) };
        let config = ShadowConfig { filter: Filter::Moments(moments), ..ShadowConfig::default() };
        let shadows = Shadows::new(device, &config)?;
        let casters = town.caster_pipeline(&shadows)?;
        let text = shadows.receiver_wgsl(1) + FRAGMENT;
        let boxes = town.pipeline(device, &text, &[Some(shadows.bind_group_layout())], format);
        Ok(Self { town, shadows, casters, boxes })
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
        let frame = self.shadows.prepare(queue, &inputs)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.town.draw_maps(&mut encoder, frame, &self.casters);
        // From depth to blurred moments. Without a moment filter this does nothing.
        self.shadows.prefilter(&mut encoder);
        let mut pass = target.begin(&mut encoder);
        pass.set_bind_group(1, self.shadows.bind_group(), &[]);
        self.town.draw(&mut pass, 0, &self.boxes);
        drop(pass);
        queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("soft_shadows", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
