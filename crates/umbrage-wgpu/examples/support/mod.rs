//! The parts of a wgpu program that have nothing to do with shadows: a device, a window or a
//! picture, a pipeline.
#![allow(dead_code, unused_imports, reason = "each example uses its own part of this module")]

mod net;
mod screen;
mod town;

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec3, Vec3};
use umbrage_wgpu::umbrage::Aabb;
use umbrage_wgpu::{device_descriptor, wgpu};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

pub use net::{net_texture, skin_layout};
pub use screen::{screen_pass, screen_pipeline, texture_group, textures};
pub use town::{TO_SUN, Town, walk};

pub type Result<T> = std::result::Result<T, Box<dyn Error>>;
type New<S> = fn(&wgpu::Device, &wgpu::Queue, wgpu::TextureFormat) -> Result<S>;
type Draw<S> = fn(&mut S, &wgpu::Device, &wgpu::Queue, &Target, f64) -> Result<()>;

/// Vertex attributes: a position and a normal.
pub const ATTRIBUTES: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];

pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const ATTACHED: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);
const SKY: wgpu::Color = wgpu::Color { r: 0.3, g: 0.45, b: 0.7, a: 1.0 };

/// An image that is drawn into, with its depth: reversed, 0 infinitely far away.
pub struct Target {
    pub size: [u32; 2],
    pub color: wgpu::TextureView,
    pub depth: wgpu::TextureView,
}

/// Runs an example: in a window, or with `--picture FILE.png` as one picture.
pub fn run<S>(name: &'static str, arguments: &[String], new: New<S>, draw: Draw<S>) -> Result<()> {
    match arguments {
        [] => in_window(name, new, draw),
        [option, path] if option == "--picture" => in_picture(path, new, draw),
        _ => Err(format!("usage: {name} [--picture FILE.png]").into()),
    }
}

/// Arguments of the command line.
pub fn arguments() -> Vec<String> {
    std::env::args().skip(1).collect()
}

impl Target {
    fn new(device: &wgpu::Device, picture: &wgpu::Texture) -> Self {
        let depth = texture(device, [picture.width(), picture.height()], DEPTH, ATTACHED);
        Self {
            size: [picture.width(), picture.height()],
            color: picture.create_view(&Default::default()),
            depth: depth.create_view(&Default::default()),
        }
    }

    /// Begins a pass over the sky.
    pub fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.begin_far(encoder, 0.0)
    }

    /// Begins a pass over the sky, which has this depth.
    pub fn begin_far<'e>(&self, encoder: &'e mut wgpu::CommandEncoder, depth: f32) -> wgpu::RenderPass<'e> {
        self.begin_into(encoder, &self.color, wgpu::LoadOp::Clear(SKY), depth)
    }

    /// Begins a pass over the image as it is, with new depth.
    pub fn begin_again<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.begin_into(encoder, &self.color, wgpu::LoadOp::Load, 0.0)
    }

    /// Begins a pass into another colour texture, with the depth of this image.
    pub fn begin_other<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        color: &wgpu::TextureView,
    ) -> wgpu::RenderPass<'e> {
        self.begin_into(encoder, color, wgpu::LoadOp::Clear(wgpu::Color::BLACK), 0.0)
    }

    fn begin_into<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        load: wgpu::LoadOp<wgpu::Color>,
        far: f32,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(far), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}

pub fn texture(
    device: &wgpu::Device,
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&texture_descriptor(size, format, usage))
}

fn texture_descriptor(
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// A uniform buffer for the camera's matrix, its layout, and the group that binds it.
pub fn camera(device: &wgpu::Device) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    uniform(device, wgpu::ShaderStages::VERTEX, 64)
}

/// A uniform buffer of `size` bytes, its layout, and the group that binds it.
pub fn uniform(
    device: &wgpu::Device,
    visibility: wgpu::ShaderStages,
    size: u64,
) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    (buffer, layout, group)
}

/// A pipeline that draws into a [`Target`].
pub fn pipeline(
    device: &wgpu::Device,
    text: &str,
    groups: &[Option<&wgpu::BindGroupLayout>],
    vertices: &[Option<wgpu::VertexBufferLayout<'_>>],
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    pipeline_with(device, text, groups, vertices, format, wgpu::CompareFunction::Greater)
}

/// [`pipeline`] for a depth comparison other than that of reversed depth.
pub fn pipeline_with(
    device: &wgpu::Device,
    text: &str,
    groups: &[Option<&wgpu::BindGroupLayout>],
    vertices: &[Option<wgpu::VertexBufferLayout<'_>>],
    format: wgpu::TextureFormat,
    compare: wgpu::CompareFunction,
) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = wgpu::PipelineLayoutDescriptor { bind_group_layouts: groups, ..Default::default() };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&device.create_pipeline_layout(&layout)),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: vertices,
        },
        primitive: wgpu::PrimitiveState { cull_mode: None, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

pub fn vertex_buffer(device: &wgpu::Device, vertices: &[[Vec3; 2]]) -> wgpu::Buffer {
    let contents = bytemuck::cast_slice(vertices.as_flattened());
    device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage: wgpu::BufferUsages::VERTEX })
}

/// Appends a box of 36 vertices and returns its bounds.
pub fn cuboid(vertices: &mut Vec<[Vec3; 2]>, min: DVec3, size: DVec3) -> Aabb {
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        for (b, c) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let (mut corner, mut normal) = ([0.0; 3], [0.0; 3]);
            (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, b, c);
            normal[axis] = 2.0 * side as f32 - 1.0;
            vertices.push([(min + DVec3::from(corner) * size).as_vec3(), Vec3::from(normal)]);
        }
    }
    Aabb::new(min, min + size)
}

/// A device with the optional features for shadows that the adapter has.
fn device(adapter: &wgpu::Adapter) -> Result<(wgpu::Device, wgpu::Queue)> {
    Ok(pollster::block_on(adapter.request_device(&device_descriptor(adapter, wgpu::DeviceDescriptor::default())))?)
}

/// Draws one frame and writes it as a PNG.
fn in_picture<S>(path: &str, new: New<S>, draw: Draw<S>) -> Result<()> {
    const SIZE: [u32; 2] = [768, 512];
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = device(&adapter)?;
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    let picture = texture(&device, SIZE, wgpu::TextureFormat::Rgba8UnormSrgb, usage);
    let mut scene = new(&device, &queue, picture.format())?;
    draw(&mut scene, &device, &queue, &Target::new(&device, &picture), 0.0)?;

    // Rows of 768 pixels need no padding.
    let [width, height] = SIZE;
    let back = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * width * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
    let mut encoder = device.create_command_encoder(&Default::default());
    let to = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
    encoder.copy_texture_to_buffer(picture.as_image_copy(), to, picture.size());
    queue.submit([encoder.finish()]);
    back.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    image::save_buffer(path, &back.get_mapped_range(..)?, width, height, image::ColorType::Rgba8)?;
    Ok(())
}

/// Draws frame after frame in a window, until it is closed.
fn in_window<S>(name: &'static str, new: New<S>, draw: Draw<S>) -> Result<()> {
    let mut app = App { name, new, draw, shown: None, failure: None };
    EventLoop::new()?.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

struct App<S> {
    name: &'static str,
    new: New<S>,
    draw: Draw<S>,
    shown: Option<Shown<S>>,
    failure: Option<Box<dyn Error>>,
}

/// A window and its contents.
struct Shown<S> {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    scene: S,
    begun: Instant,
}

impl<S> Shown<S> {
    fn open(name: &str, event_loop: &ActiveEventLoop, new: New<S>) -> Result<Self> {
        let attributes = Window::default_attributes().with_title(name);
        Self::open_in(Arc::new(event_loop.create_window(attributes)?), event_loop, new)
    }

    /// Creates everything except the window: at first, and after the device was lost.
    fn open_in(window: Arc<Window>, event_loop: &ActiveEventLoop, new: New<S>) -> Result<Self> {
        let display = Box::new(event_loop.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface = instance.create_surface(window.clone())?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let (device, queue) = device(&adapter)?;
        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the adapter cannot draw in this window")?;
        config.format = config.format.add_srgb_suffix();
        surface.configure(&device, &config);
        let scene = new(&device, &queue, config.format)?;
        Ok(Self { window, surface, config, device, queue, scene, begun: Instant::now() })
    }

    fn draw(&mut self, draw: Draw<S>) -> Result<()> {
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => frame,
            _ => {
                self.surface.configure(&self.device, &self.config);
                return Ok(());
            }
        };
        let target = Target::new(&self.device, &frame.texture);
        draw(&mut self.scene, &self.device, &self.queue, &target, self.begun.elapsed().as_secs_f64())?;
        self.queue.present(frame);
        Ok(())
    }

    fn resize(&mut self, [width, height]: [u32; 2]) {
        (self.config.width, self.config.height) = (width.max(1), height.max(1));
        self.surface.configure(&self.device, &self.config);
    }
}

impl<S> App<S> {
    /// Shows an opened window, or ends with the failure.
    fn show(&mut self, opened: Result<Shown<S>>, event_loop: &ActiveEventLoop) {
        match opened {
            Ok(shown) => self.shown = Some(shown),
            Err(failure) => {
                self.failure = Some(failure);
                event_loop.exit();
            }
        }
    }

    /// Draws a frame; on a new device if the old one was lost.
    fn redraw(&mut self, event_loop: &ActiveEventLoop) {
        let Some(mut shown) = self.shown.take() else { return };
        let drawn = shown.draw(self.draw);
        let window = shown.window.clone();
        let opened = match drawn {
            Err(failure) if matches!(failure.downcast_ref(), Some(umbrage_wgpu::Error::DeviceLost)) => {
                // A window has one surface at a time.
                drop(shown);
                Shown::open_in(window.clone(), event_loop, self.new)
            }
            drawn => drawn.map(|()| shown),
        };
        self.show(opened, event_loop);
        window.request_redraw();
    }
}

impl<S> ApplicationHandler for App<S> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let opened = Shown::open(self.name, event_loop, self.new);
        self.show(opened, event_loop);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => shown.resize([size.width, size.height]),
            WindowEvent::RedrawRequested => self.redraw(event_loop),
            _ => {}
        }
    }
}
