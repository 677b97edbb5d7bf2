//! The surface of the window, and its renderer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui::ViewportId;
use egui_wgpu::ScreenDescriptor;
use image::RgbaImage;
use umbrage_render::Gpu;
use winit::dpi::PhysicalSize;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use crate::Result;
use crate::platform::{self, Wake};

/// Result of painting a frame.
pub(super) enum Painted {
    /// The frame is on the screen.
    Shown,
    /// The window has no pixels now.
    Hidden,
    /// The device is gone.
    Lost,
}

/// A window with the objects that draw into it.
pub(super) struct Shown {
    pub window: Arc<Window>,
    pub input: egui_winit::State,
    /// Device that draws the window, and in a browser the scene too.
    pub gpu: Gpu,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    painter: egui_wgpu::Renderer,
    lost: Arc<AtomicBool>,
}

impl Shown {
    /// Opens a device for a window.
    pub async fn open(
        window: Arc<Window>,
        display: OwnedDisplayHandle,
        ctx: egui::Context,
        wake: Wake,
    ) -> Result<Self> {
        let instance = platform::instance(display.clone()).await;
        let surface =
            instance.create_surface(Arc::clone(&window)).map_err(|error| platform::no_graphics(error.to_string()))?;
        let wanted = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter =
            instance.request_adapter(&wanted).await.map_err(|error| platform::no_graphics(error.to_string()))?;
        let described = match platform::SHARES_DEVICE {
            true => umbrage_render::device_descriptor(&adapter),
            false => wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() },
        };
        let (device, queue) =
            adapter.request_device(&described).await.map_err(|error| platform::no_graphics(error.to_string()))?;
        let lost = Arc::new(AtomicBool::new(false));
        let is_lost = Arc::clone(&lost);
        device.set_device_lost_callback(move |_, _| {
            is_lost.store(true, Ordering::Relaxed);
            wake();
        });
        let gpu = Gpu::from_parts(adapter.get_info(), device, queue);
        let config = configured(&surface, &adapter, &window)?;
        surface.configure(&gpu.device, &config);
        let side = gpu.device.limits().max_texture_dimension_2d as usize;
        let scale = window.scale_factor() as f32;
        let theme = window.theme();
        let input = egui_winit::State::new(ctx, ViewportId::ROOT, &display, Some(scale), theme, Some(side));
        let painter = egui_wgpu::Renderer::new(&gpu.device, config.format, painter_options());
        window.request_redraw();
        Ok(Self { window, input, gpu, surface, config, painter, lost })
    }

    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        // A minimised window has none.
        if size.width > 0 && size.height > 0 {
            let most = self.gpu.device.limits().max_texture_dimension_2d;
            (self.config.width, self.config.height) = (size.width.min(most), size.height.min(most));
            self.surface.configure(&self.gpu.device, &self.config);
        }
    }

    /// Draws the controls into the window.
    pub fn paint(
        &mut self,
        triangles: &[egui::ClippedPrimitive],
        textures: egui::TexturesDelta,
        scale: f32,
    ) -> Painted {
        for (id, deltas) in textures.set.iter() {
            for delta in deltas {
                self.painter.update_texture(&self.gpu.device, &self.gpu.queue, *id, delta);
            }
        }
        let painted = self.present(triangles, scale);
        for id in &textures.free {
            self.painter.free_texture(id);
        }
        let mut textures = textures;
        textures.clear();
        painted
    }

    fn present(&mut self, triangles: &[egui::ClippedPrimitive], scale: f32) -> Painted {
        if self.lost.load(Ordering::Relaxed) {
            return Painted::Lost;
        }
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Painted::Hidden;
        }
        let frame = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(frame) | wgpu::CurrentSurfaceTexture::Suboptimal(frame) => frame,
            wgpu::CurrentSurfaceTexture::Occluded => return Painted::Hidden,
            _ => {
                // Outdated or lost: created again, and tried again with the next frame.
                self.surface.configure(&self.gpu.device, &self.config);
                self.window.request_redraw();
                return Painted::Hidden;
            }
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(&view, [self.config.width, self.config.height], triangles, scale);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);
        Painted::Shown
    }

    fn draw(&mut self, target: &wgpu::TextureView, size: [u32; 2], triangles: &[egui::ClippedPrimitive], scale: f32) {
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: scale };
        let mut encoder =
            self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        let before = self.painter.update_buffers(&self.gpu.device, &self.gpu.queue, &mut encoder, triangles, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("controls"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        let mut pass = pass.forget_lifetime();
        self.painter.render(&mut pass, triangles, &screen);
        drop(pass);
        self.gpu.queue.submit(before.into_iter().chain([encoder.finish()]));
    }

    /// Draws the window's content once more into a readable texture, whose pixels are read later.
    pub fn picture(
        &mut self,
        triangles: &[egui::ClippedPrimitive],
        scale: f32,
    ) -> impl Future<Output = Result<RgbaImage, String>> + 'static {
        let (width, height) = (self.config.width, self.config.height);
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("screenshot"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.config.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(&view, [width, height], triangles, scale);
        let swapped =
            matches!(self.config.format, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb);
        let gpu = self.gpu.clone();
        async move {
            let bytes = gpu.pixels(&texture).await.map_err(|error| error.to_string())?;
            let picture = RgbaImage::from_raw(width, height, bytes).ok_or("the picture is not whole")?;
            Ok(opaque(picture, swapped))
        }
    }
}

/// Returns the configuration of the surface.
fn configured(
    surface: &wgpu::Surface<'_>,
    adapter: &wgpu::Adapter,
    window: &Window,
) -> Result<wgpu::SurfaceConfiguration> {
    let size = window.inner_size();
    let mut config = surface
        .get_default_config(adapter, size.width.max(1), size.height.max(1))
        .ok_or_else(|| platform::no_graphics("the adapter has no format for this window".to_owned()))?;
    // Controls are mixed as they are displayed.
    config.format = config.format.remove_srgb_suffix();
    let formats = surface.get_capabilities(adapter).formats;
    if !formats.contains(&config.format) {
        config.format = formats.first().copied().unwrap_or(config.format);
    }
    Ok(config)
}

/// Makes a window's picture opaque.
fn opaque(mut picture: RgbaImage, swapped: bool) -> RgbaImage {
    for pixel in picture.pixels_mut() {
        let [a, g, c, _] = pixel.0;
        pixel.0 = if swapped { [c, g, a, 255] } else { [a, g, c, 255] };
    }
    picture
}

/// Options of the renderer of controls. No dithering: a pixel of the picture is exactly that pixel
/// of the window.
fn painter_options() -> egui_wgpu::RendererOptions {
    egui_wgpu::RendererOptions { dithering: false, ..Default::default() }
}
