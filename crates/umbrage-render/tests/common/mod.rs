//! Scenes with closed-form shadows, and a device that every test of a file shares.
#![allow(dead_code, reason = "each test file uses its own part of this module")]

use std::sync::OnceLock;

use glam::{DQuat, DVec3};
use image::GrayAlphaImage;
use umbrage::config::{Filter, Preset, Range, ShadowConfig, Stability, Transition};
use umbrage::{DirectionalLight, Frustum, View};
use umbrage_render::{Frame, Gpu, GpuOptions, Outputs, RenderSettings, Rendered, Renderer, Samples};
use umbrage_scene::{Material, Mesh, Node, Pose, Primitive, Scene, Trs};

/// The device, or `None` (said loudly) where there is no adapter. `UMBRAGE_REQUIRE_GPU=1` turns
/// that into a failure.
pub fn gpu() -> Option<Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    GPU.get_or_init(|| match Gpu::new(&GpuOptions::default()) {
        Ok(gpu) => Some(gpu),
        Err(error) if std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|value| value == "1") => panic!("{error}"),
        Err(error) => {
            eprintln!("SKIPPED: no adapter: {error}");
            None
        }
    })
    .clone()
}

pub const SIZE: [u32; 2] = [160, 120];

/// Two maps of 512², hard, unstabilised: small and exact enough for closed forms.
pub fn settings() -> RenderSettings {
    RenderSettings { size: SIZE, samples: Samples::Four, config: config(), ..RenderSettings::default() }
}

/// The shadows of [`settings`].
pub fn config() -> ShadowConfig {
    ShadowConfig {
        map_sizes: vec![512; 2],
        transition: Transition::Hard,
        far_fade: 0.0,
        range: Range::Metres { near: 1.0, far: 60.0 },
        stability: Stability::tight(),
        filter: Filter::Hard,
        ..Preset::Papers.config()
    }
}

/// The settings with another config.
pub fn configured(config: ShadowConfig) -> RenderSettings {
    RenderSettings { config, ..settings() }
}

pub fn look(eye: DVec3, target: DVec3) -> View {
    let frustum = Frustum::perspective(60_f64.to_radians(), 4.0 / 3.0, 0.5, 200.0).expect("a valid frustum");
    View::look_at_upright(eye, target, frustum).expect("a valid view")
}

pub fn sun(direction: DVec3) -> DirectionalLight {
    DirectionalLight::new(direction).expect("a direction")
}

/// A box from `min` to `max` with outward faces, 12 triangles, flat normals.
pub fn cuboid(min: DVec3, max: DVec3) -> Primitive {
    let mut primitive = Primitive::default();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let normal = axes[axis] * sign;
            let (a, b) = (axes[(axis + 1) % 3], axes[(axis + 2) % 3] * sign);
            quad(&mut primitive, center + normal * half, a * half, b * half, normal);
        }
    }
    primitive
}

/// A rectangle around `center`, seen from where `a × b` points.
pub fn quad(into: &mut Primitive, center: DVec3, a: DVec3, b: DVec3, normal: DVec3) {
    let first = into.positions.len() as u32;
    for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        into.positions.push((center + a * s + b * t).as_vec3().to_array());
        into.normals.push(normal.as_vec3().to_array());
        into.uvs.push([(0.5 + 0.5 * s) as f32, (0.5 + 0.5 * t) as f32]);
    }
    into.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
}

/// A horizontal square of half edge `half`, seen from above.
pub fn ground(y: f64, half: f64) -> Primitive {
    let mut primitive = Primitive::default();
    quad(&mut primitive, DVec3::Y * y, DVec3::X * half, DVec3::NEG_Z * half, DVec3::Y);
    primitive
}

/// A sphere of 64 by 32 facets.
pub fn sphere(center: DVec3, radius: f64) -> Primitive {
    let mut primitive = Primitive::default();
    for i in 0..=32_u32 {
        for j in 0..=64_u32 {
            let (polar, around) = (f64::from(i) / 32.0, f64::from(j) / 32.0);
            let (sin, cos) = (polar * std::f64::consts::PI).sin_cos();
            let (y, x) = (around * std::f64::consts::PI).sin_cos();
            let normal = DVec3::new(sin * x, cos, -sin * y);
            primitive.positions.push((center + normal * radius).as_vec3().to_array());
            primitive.normals.push(normal.as_vec3().to_array());
        }
    }
    for i in 0..32 {
        for j in 0..64 {
            let at = i * 65 + j;
            primitive.indices.extend([at, at + 65, at + 66, at, at + 66, at + 1]);
        }
    }
    primitive
}

/// A scene of one node per primitive, all of one white material.
pub fn scene(primitives: Vec<Primitive>) -> Scene {
    let mut scene = Scene { name: "test".to_owned(), materials: vec![Material::default()], ..Default::default() };
    for primitive in primitives {
        scene.nodes.push(Node { mesh: Some(scene.meshes.len()), ..Default::default() });
        scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
    }
    scene
}

pub fn moved(scene: &Scene, by: DVec3) -> Scene {
    let mut scene = scene.clone();
    for node in scene.nodes.iter_mut().filter(|node| node.parent.is_none()) {
        node.local.translation += by;
    }
    scene
}

pub fn trs(translation: DVec3, rotation: DQuat, scale: DVec3) -> Trs {
    Trs { translation, rotation, scale }
}

/// A scene on the device with its pose.
pub struct Stage {
    pub renderer: Renderer,
    pub pose: Pose,
}

impl Stage {
    pub fn new(gpu: &Gpu, scene: &Scene, settings: &RenderSettings) -> Self {
        let pose = scene.pose(0.0).expect("a pose");
        Self { renderer: Renderer::new(gpu, scene, settings).expect("a renderer"), pose }
    }

    pub fn frame<'a>(pose: &'a Pose, view: &'a View, sun: DirectionalLight) -> Frame<'a> {
        Frame { pose, moved: None, view, light: sun.into(), more_lights: &[], shadows_on: true, tint: false }
    }

    pub fn render(&mut self, view: &View, sun: DirectionalLight, outputs: Outputs) -> Rendered {
        self.renderer.render(&Self::frame(&self.pose, view, sun), outputs).expect("a frame")
    }

    pub fn mask(&mut self, view: &View, sun: DirectionalLight) -> GrayAlphaImage {
        self.render(view, sun, Outputs { mask: true, ..Default::default() }).mask.expect("a mask")
    }
}

/// One pixel of a picture and the ray through its centre.
pub struct Pixel {
    pub x: u32,
    pub y: u32,
    pub eye: DVec3,
    pub ray: DVec3,
}

impl Pixel {
    /// Where the ray meets the plane y = `height`.
    pub fn on_ground(&self, height: f64) -> Option<DVec3> {
        let t = (height - self.eye.y) / self.ray.y;
        (t > 0.0).then(|| self.eye + self.ray * t)
    }
}

pub fn pixels(view: &View, [width, height]: [u32; 2]) -> impl Iterator<Item = Pixel> {
    let view = *view;
    (0..width * height).map(move |i| {
        let (x, y) = (i % width, i / width);
        let (eye, ray) =
            view.ray_through((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
        Pixel { x, y, eye, ray }
    })
}

/// Whether a ray meets a box, ahead of its start.
pub fn meets_box(start: DVec3, ray: DVec3, min: DVec3, max: DVec3) -> bool {
    let (a, b) = ((min - start) / ray, (max - start) / ray);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    enter <= leave && leave > 0.0
}

/// Whether a ray meets a sphere, ahead of its start.
pub fn meets_sphere(start: DVec3, ray: DVec3, center: DVec3, radius: f64) -> bool {
    let along = (center - start).dot(ray.normalize());
    along > 0.0 && (start + ray.normalize() * along).distance(center) <= radius
}
