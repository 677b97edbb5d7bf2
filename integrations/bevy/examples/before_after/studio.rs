//! An app that draws into a picture instead of a window, one frame at a time.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::camera::visibility::CascadesVisibleEntities;
use bevy::camera::{RenderTarget, Viewport};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::image::Image;
use bevy::light::{CascadeShadowConfig, DirectionalLightShadowMap, GlobalAmbientLight};
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_asset::RenderAssets;
use bevy::render::render_resource::{
    BufferDescriptor, BufferUsages, CommandEncoderDescriptor, MapMode, PollType, TexelCopyBufferInfo,
    TexelCopyBufferLayout, TextureFormat, TextureUsages,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::texture::GpuImage;
use bevy::render::{RenderApp, RenderPlugin};
use bevy::window::ExitCondition;
use umbrage_bevy::umbrage::View;
use umbrage_bevy::{PlannedLights, UmbrageShadowsPlugin};

use crate::Failure;
use crate::mask::MaskPlugin;

/// How the sun's shadows are made.
#[derive(Clone, Debug)]
pub enum Shadows {
    /// Not at all.
    Off,
    /// By Bevy, with these cascades.
    Bevys(CascadeShadowConfig),
    /// By Bevy, with cascades that the plugin plans.
    Planned,
}

/// Width and height of a picture, in pixels.
pub type Size = [u32; 2];

/// An app and the picture that it draws.
pub struct Studio {
    pub app: App,
    pub shadows: Shadows,
    size: Size,
    target: Handle<Image>,
}

impl Studio {
    /// An empty world, with maps of this many texels along an edge.
    pub fn new(size: Size, map_size: usize, shadows: Shadows) -> Self {
        let mut app = App::new();
        let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
        let plugins = DefaultPlugins.set(window).set(render).disable::<PipelinedRenderingPlugin>();
        // Only the first app of a process can set up the log.
        static HAS_LOG: AtomicBool = AtomicBool::new(false);
        let log = LogPlugin { level: Level::WARN, ..default() };
        let plugins =
            if HAS_LOG.swap(true, Ordering::Relaxed) { plugins.disable::<LogPlugin>() } else { plugins.set(log) };
        app.add_plugins(plugins).add_plugins(MaskPlugin);
        if matches!(shadows, Shadows::Planned) {
            app.add_plugins(UmbrageShadowsPlugin::default());
        }
        app.insert_resource(DirectionalLightShadowMap { size: map_size })
            .insert_resource(ClearColor(Color::srgb(0.62, 0.72, 0.84)))
            .insert_resource(GlobalAmbientLight { brightness: 900.0, ..default() });
        app.finish();
        app.cleanup();
        let mut image = Image::new_target_texture(size[0], size[1], TextureFormat::Rgba8UnormSrgb, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        Self { app, shadows, size, target }
    }

    /// Puts a camera where a view is, for the whole picture or a part of it.
    pub fn spawn_camera(&mut self, view: &View, part: Option<Viewport>) -> Entity {
        let order = isize::from(part.as_ref().is_some_and(|part| part.physical_position != UVec2::ZERO));
        let clear_color = if order == 0 { ClearColorConfig::Default } else { ClearColorConfig::None };
        let size = part.as_ref().map_or(UVec2::from(self.size), |part| part.physical_size);
        let camera = Camera { viewport: part, order, clear_color, ..default() };
        let target = RenderTarget::Image(self.target.clone().into());
        let bundle = (
            (Camera3d::default(), camera, target, Msaa::Off),
            (Tonemapping::None, DebandDither::Disabled),
            (lens_of(view, size), place_of(view)),
        );
        self.app.world_mut().spawn(bundle).id()
    }

    /// Adds a sun that shines in this direction.
    pub fn spawn_sun(&mut self, travel: Vec3, color: Color, illuminance: f32) -> Entity {
        let shadow_maps_enabled = !matches!(self.shadows, Shadows::Off);
        let light = DirectionalLight { shadow_maps_enabled, color, illuminance, ..default() };
        let place = Transform::default().looking_to(travel, up_for(travel));
        let sun = self.app.world_mut().spawn((light, place)).id();
        if let Shadows::Bevys(config) = &self.shadows {
            self.app.world_mut().entity_mut(sun).insert(config.clone());
        }
        sun
    }

    /// Draws a frame and waits for it.
    pub fn frame(&mut self) -> Result<(), Failure> {
        self.app.update();
        let device = self.app.world().resource::<RenderDevice>();
        device.poll(PollType::wait_indefinitely())?;
        Ok(())
    }

    /// Draws some frames and returns the last of them. The first ones load meshes and shaders.
    pub fn picture(&mut self) -> Result<Picture, Failure> {
        for _ in 0..4 {
            self.frame()?;
        }
        self.refusals()?;
        self.read()
    }

    /// An error if the planner refused a light, which has Bevy's cascades then.
    fn refusals(&mut self) -> Result<(), Failure> {
        let world = self.app.world_mut();
        let lights: Vec<Entity> = world.query_filtered::<Entity, With<DirectionalLight>>().iter(world).collect();
        let Some(planned) = world.get_resource::<PlannedLights>() else { return Ok(()) };
        match lights.into_iter().find_map(|light| planned.refusal(light)) {
            Some(refusal) => Err(refusal.clone().into()),
            None => Ok(()),
        }
    }

    /// The picture of the last frame.
    fn read(&self) -> Result<Picture, Failure> {
        let (world, rendered) = (self.app.world(), self.app.sub_app(RenderApp).world());
        let image =
            rendered.resource::<RenderAssets<GpuImage>>().get(&self.target).ok_or("the target has no texture")?;
        let (device, queue) = (world.resource::<RenderDevice>(), rendered.resource::<RenderQueue>());
        let [width, height] = self.size;
        let row = RenderDevice::align_copy_bytes_per_row(4 * width as usize);
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some("picture"),
            size: (row * height as usize) as u64,
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(
            image.texture.as_image_copy(),
            TexelCopyBufferInfo {
                buffer: &buffer,
                layout: TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None },
            },
            image.texture_descriptor.size,
        );
        queue.submit([encoder.finish()]);
        let (sender, receiver) = std::sync::mpsc::channel();
        // The receiver outlives the poll below, so nobody misses what is sent.
        buffer.slice(..).map_async(MapMode::Read, move |result| drop(sender.send(result)));
        device.poll(PollType::wait_indefinitely())?;
        receiver.recv()??;
        let bytes = buffer.slice(..).get_mapped_range();
        let rgba = bytes.chunks(row).flat_map(|line| &line[..4 * width as usize]).copied().collect();
        Picture::from_raw(width, height, rgba).ok_or_else(|| "the picture has another size".into())
    }

    /// How many casters each cascade of a light has for a camera.
    pub fn casters(&self, light: Entity, camera: Entity) -> Vec<usize> {
        let lists = self.app.world().get::<CascadesVisibleEntities>(light);
        let lists = lists.and_then(|lists| lists.entities.get(&camera));
        lists.map(|lists| lists.iter().map(|list| list.entities.len()).collect()).unwrap_or_default()
    }

    /// Far bounds of a light's cascades, metres of view depth.
    pub fn bounds(&self, light: Entity) -> Vec<f32> {
        self.app.world().get::<CascadeShadowConfig>(light).map(|config| config.bounds.clone()).unwrap_or_default()
    }

    /// Moves a camera to a view.
    pub fn place(&mut self, camera: Entity, view: &View) {
        if let Some(mut at) = self.app.world_mut().get_mut::<Transform>(camera) {
            *at = place_of(view);
        }
    }

    /// Turns a light.
    pub fn turn(&mut self, light: Entity, travel: Vec3) {
        if let Some(mut at) = self.app.world_mut().get_mut::<Transform>(light) {
            at.look_to(travel, up_for(travel));
        }
    }
}

/// A picture in sRGB, row 0 on top.
pub type Picture = image::RgbaImage;

/// Bevy's lens for a view, whose projection is symmetric.
fn lens_of(view: &View, size: UVec2) -> Projection {
    let frustum = view.frustum();
    Projection::Perspective(PerspectiveProjection {
        fov: 2.0 * frustum.top.atan() as f32,
        aspect_ratio: size.x as f32 / size.y as f32,
        near: frustum.near as f32,
        far: frustum.far as f32,
        ..default()
    })
}

fn place_of(view: &View) -> Transform {
    let rotation = view.world_from_view_rotation().to_cols_array().map(|entry| entry as f32);
    let eye = view.eye().to_array().map(|metres| metres as f32);
    Transform::from_translation(Vec3::from(eye)).with_rotation(Quat::from_mat3(&Mat3::from_cols_array(&rotation)))
}

fn up_for(travel: Vec3) -> Vec3 {
    if travel.normalize().y.abs() > 0.99 { Vec3::Z } else { Vec3::Y }
}
