//! Two players on one screen: two views, one `Shadows`.
//!
//! `cargo run -p umbrage-wgpu --example split_screen`, with `-- --picture out.png` for one picture.
//! Each view has a slot of its own for the state of its stabilised maps. Both use the same maps,
//! one after the other.

mod support;

use glam::DVec3;
use support::{Result, TO_SUN, Target, Town, walk};
use umbrage_wgpu::umbrage::{DirectionalLight, Frustum, Light, View};
use umbrage_wgpu::{Inputs, ShadowConfig, Shadows, wgpu};

const FRAGMENT: &str = "
@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    let sun = max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    let light = sun * umbrage_visibility(in.position, in.normal);
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
        let town = Town::new(device, 2);
        let shadows = Shadows::new(device, &ShadowConfig::default())?;
        let casters = town.caster_pipeline(&shadows)?;
        let text = shadows.receiver_wgsl(1) + FRAGMENT;
        let boxes = town.pipeline(device, &text, &[Some(shadows.bind_group_layout())], format);
        Ok(Self { town, shadows, casters, boxes })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let half = [target.size[0] / 2, target.size[1]];
        let views = [walk(seconds, half)?, from_above(seconds, half)?];
        let sun = [Light::from(DirectionalLight::new(-TO_SUN)?)];
        for (slot, view) in views.iter().enumerate() {
            self.town.look(queue, slot, view);
            let inputs = Inputs {
                casters: self.town.casters(),
                receivers: &self.town.bounds,
                image_size: half,
                view_slot: slot as u32,
                ..Inputs::new(view, &sun)
            };
            let frame = self.shadows.prepare(queue, &inputs)?;
            let mut encoder = device.create_command_encoder(&Default::default());
            self.town.draw_maps(&mut encoder, frame, &self.casters);
            let mut pass = if slot == 0 { target.begin(&mut encoder) } else { target.begin_again(&mut encoder) };
            let left = half[0] * slot as u32;
            pass.set_viewport(left as f32, 0.0, half[0] as f32, half[1] as f32, 0.0, 1.0);
            pass.set_bind_group(1, self.shadows.bind_group(), &[]);
            self.town.draw(&mut pass, slot, &self.boxes);
            drop(pass);
            // Submitted one by one: the next view writes the same uniforms and maps.
            queue.submit([encoder.finish()]);
        }
        Ok(())
    }
}

/// A camera that circles above the boxes.
fn from_above(seconds: f64, [width, height]: [u32; 2]) -> Result<View> {
    let lens = Frustum::perspective(50f64.to_radians(), f64::from(width) / f64::from(height), 0.5, 300.0)?;
    let (sin, cos) = (0.2 * seconds).sin_cos();
    let eye = DVec3::new(35.0 * sin, 30.0, 35.0 * cos - 25.0);
    Ok(View::look_at_upright(eye, DVec3::new(0.0, 0.0, -25.0), lens)?)
}

/// Runs with these arguments.
pub fn run(arguments: &[String]) -> Result<()> {
    support::run("split_screen", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
