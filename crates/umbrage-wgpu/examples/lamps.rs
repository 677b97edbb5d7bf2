//! Three lights with shadows: a sun, a spot light that swings, and a point light.
//!
//! `cargo run -p umbrage-wgpu --example lamps`, with `-- --picture out.png` for one picture. A
//! shader samples one light after the other: `UmbrageQuery.light`.

mod support;

use glam::DVec3;
use support::{Result, TO_SUN, Target, Town, walk};
use umbrage_wgpu::umbrage::config::LightKind;
use umbrage_wgpu::umbrage::{DirectionalLight, Light, PointLight, SpotLight};
use umbrage_wgpu::{Inputs, LightMaps, ShadowConfig, Shadows, wgpu};

/// Range of the lamps in metres.
const RANGE: f64 = 40.0;

const FRAGMENT: &str = "
// Position and range of the lamps, as in the program.
const LAMPS = array<vec4f, 2>(vec4f(-6.0, 9.0, 2.0, 40.0), vec4f(9.0, 4.5, 0.5, 40.0));
const COLOURS = array<vec3f, 2>(vec3f(1.0, 0.55, 0.2), vec3f(0.35, 0.6, 1.0));

@fragment fn fragment(in: Varying) -> @location(0) vec4f {
    var query = umbrage_query(in.position, in.normal);
    let sun = 0.25 * max(dot(in.normal, normalize(vec3f(0.6, 0.5, 0.3))), 0.0);
    var light = vec3f(0.04, 0.05, 0.08) + sun * umbrage_shadow(query).visibility;
    for (var i = 0u; i < 2u; i++) {
        let to_lamp = LAMPS[i].xyz - in.position;
        let distance = length(to_lamp);
        let falloff = pow(max(1.0 - distance / LAMPS[i].w, 0.0), 2.0);
        query.light = i + 1u;
        light += COLOURS[i] * falloff * max(dot(in.normal, to_lamp / distance), 0.0)
            * umbrage_shadow(query).visibility;
    }
    return vec4f(light, 1.0);
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
        // Lamps have maps of their own sizes: a spot light one map here, a point light one for each
        // of six faces.
        let lights = [
            LightMaps::from(LightKind::Directional),
            LightMaps::with_sizes(LightKind::Spot, &[1024]),
            LightMaps::with_sizes(LightKind::Point, &[512]),
        ];
        let shadows = Shadows::with_lights(device, &ShadowConfig::default(), &lights)?;
        let casters = town.caster_pipeline(&shadows)?;
        let text = shadows.receiver_wgsl(1) + FRAGMENT;
        let boxes = town.pipeline(device, &text, &[Some(shadows.bind_group_layout())], format);
        Ok(Self { town, shadows, casters, boxes })
    }

    fn draw(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, target: &Target, seconds: f64) -> Result<()> {
        let view = walk(0.2 * seconds, target.size)?;
        self.town.look(queue, 0, &view);

        let aim = DVec3::new(0.5 * (0.7 * seconds).sin(), -0.9, -0.4);
        let lights = [
            Light::from(DirectionalLight::new(-TO_SUN)?),
            Light::from(SpotLight::new(DVec3::new(-6.0, 9.0, 2.0), aim, 50f64.to_radians(), RANGE)?),
            Light::from(PointLight::new(DVec3::new(9.0, 4.5, 0.5), RANGE)?),
        ];
        let inputs = Inputs {
            casters: self.town.casters(),
            receivers: &self.town.bounds,
            image_size: target.size,
            ..Inputs::new(&view, &lights)
        };
        let frame = self.shadows.prepare(queue, &inputs)?;

        let mut encoder = device.create_command_encoder(&Default::default());
        self.town.draw_maps(&mut encoder, frame, &self.casters);
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
    support::run("lamps", arguments, Scene::new, Scene::draw)
}

fn main() -> Result<()> {
    run(&support::arguments())
}
