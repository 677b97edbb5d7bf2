//! Driver defects that umbrage works around (docs/drivers.md), each drawn without the workaround.
//! **A test that fails here says that the defect is gone:** then the workaround goes, and its row
//! on that page. They run on the driver that has the defects alone.

use std::num::NonZeroU32;

/// The driver that has them.
const DRIVER: &str = "llvmpipe";
/// Pixels along the edge of what is drawn: a row of `f32` fills the alignment of copies.
const EDGE: u32 = 64;
/// Layers of what is drawn.
const LAYERS: u32 = 2;

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Gpu {
    /// `None`, and a line on stderr, on every other driver.
    fn new(features: wgpu::Features) -> Option<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .ok()
            .filter(|adapter| adapter.get_info().driver == DRIVER && adapter.features().contains(features));
        let Some(adapter) = adapter else {
            eprintln!("SKIPPED: the adapter is not {DRIVER} with {features:?}");
            return None;
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("Drivers::device"),
            required_features: features,
            required_limits: adapter.limits(),
            ..Default::default()
        }))
        .expect("an adapter gives a device with features that it has");
        Some(Self { device, queue })
    }

    /// Draws `instances` of three vertices by the entry points `vs` and `fs`, whose answer is one
    /// `f32`, with `texture` at binding 0 of group 0 and a sampler at 1, and returns each layer.
    /// Nothing drawn is -1.
    fn draw(&self, wgsl: &str, multiview: bool, instances: u32, texture: &wgpu::TextureView) -> Vec<Vec<f32>> {
        let format = wgpu::TextureFormat::R32Float;
        let device = &self.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Drivers::draw"),
            source: wgpu::ShaderSource::Wgsl(wgsl.into()),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Drivers::group"),
            entries: &[
                wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                    count: None,
                },
                wgpu::BindGroupLayoutEntry {
                    binding: 1,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                    count: None,
                },
            ],
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            anisotropy_clamp: 16,
            ..Default::default()
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Drivers::group"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(texture) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        let mask = if multiview { NonZeroU32::new((1 << LAYERS) - 1) } else { None };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("Drivers::draw"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("Drivers::draw"),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: mask,
            cache: None,
        });
        let layers = if multiview { LAYERS } else { 1 };
        let extent = wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: layers };
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("Drivers::target"),
            size: extent,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let dimension = if multiview { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 };
        let view =
            target.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() });
        let back = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Drivers::back"),
            size: u64::from(4 * EDGE * EDGE * layers),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let nothing = wgpu::Color { r: -1.0, g: 0.0, b: 0.0, a: 0.0 };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("Drivers::draw"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(nothing), store: wgpu::StoreOp::Store },
                })],
                multiview_mask: mask,
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..instances);
        }
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * EDGE), rows_per_image: Some(EDGE) };
        encoder.copy_texture_to_buffer(
            target.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &back, layout: rows },
            extent,
        );
        self.queue.submit([encoder.finish()]);
        back.map_async(wgpu::MapMode::Read, .., |result| result.expect("a mappable buffer maps"));
        device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let bytes = back.get_mapped_range(..).expect("mapped above").to_vec();
        bytemuck::cast_slice(&bytes).chunks_exact((EDGE * EDGE) as usize).map(<[f32]>::to_vec).collect()
    }

    /// A texture whose level `i` holds the number `i` everywhere.
    fn numbered_levels(&self) -> wgpu::TextureView {
        let levels = EDGE.ilog2() + 1;
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("Drivers::levels"),
            size: wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: 1 },
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for level in 0..levels {
            let edge = EDGE >> level;
            self.queue.write_texture(
                wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() },
                &vec![level as u8; (edge * edge) as usize],
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(edge), rows_per_image: Some(edge) },
                wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: 1 },
            );
        }
        texture.create_view(&Default::default())
    }
}

/// Bindings, and a triangle over the whole picture.
const WHOLE: &str = "
@group(0) @binding(0) var levels: texture_2d<f32>;
@group(0) @binding(1) var smooth_sampler: sampler;
@vertex fn vs(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(4.0 * f32(i & 1u) - 1.0, 4.0 * f32(i >> 1u) - 1.0, 0.5, 1.0);
}
";

#[test]
fn multiview_forgets_the_layer_of_clipped_triangles() {
    let Some(gpu) = Gpu::new(wgpu::Features::MULTIVIEW) else { return };
    let nothing = gpu.numbered_levels();
    // Corners before the near plane, so that the triangle is clipped; the first instance draws
    // nothing where there is a second.
    let text = |lead: &str| {
        format!(
            "@vertex fn vs(@builtin(vertex_index) i: u32, @builtin(instance_index) k: u32) -> @builtin(position) vec4f {{
                 {lead}
                 return vec4f(4.0 * f32(i & 1u) - 1.0, 4.0 * f32(i >> 1u) - 1.0, 0.5 - f32(i >> 1u), 1.0);
             }}
             @fragment fn fs(@builtin(view_index) view: u32) -> @location(0) f32 {{ return f32(view); }}"
        )
    };
    let drawn =
        |layers: &[Vec<f32>], layer: usize| layers[layer].iter().filter(|&&value| value == layer as f32).count();

    let plain = gpu.draw(&text(""), true, 1, &nothing);
    assert!(drawn(&plain, 0) > 0, "the first layer is drawn");
    assert_eq!(drawn(&plain, 1), 0, "the driver draws clipped triangles into their layer: MapPass::leads can go");

    let lead = "if k == 0u { return vec4f(0.0, 0.0, 0.5, 1.0); }";
    let led = gpu.draw(&text(lead), true, 2, &nothing);
    assert_eq!(drawn(&led, 1), drawn(&plain, 0), "an instance that needs no clipping sets the layer");
}

#[test]
fn anisotropic_samples_ignore_their_gradients() {
    let Some(gpu) = Gpu::new(wgpu::Features::empty()) else { return };
    // The place is the same everywhere, so differences between neighbours are 0; the gradients ask
    // for level 3.
    let text = WHOLE.to_owned()
        + "@fragment fn fs() -> @location(0) f32 {
               let d = 8.0 / 64.0;
               return 255.0 * textureSampleGrad(levels, smooth_sampler, vec2f(0.5), vec2f(d, 0.0), vec2f(0.0, d)).x;
           }";
    let level = gpu.draw(&text, false, 1, &gpu.numbered_levels())[0][0];
    assert!(
        (level - 3.0).abs() > 0.5,
        "the driver samples level {level}, as its gradients say: own_taps in shaders/maps/moments.wesl can go"
    );
}

#[test]
fn sizes_of_levels_are_one_pixels() {
    let Some(gpu) = Gpu::new(wgpu::Features::empty()) else { return };
    let text = WHOLE.to_owned()
        + "@fragment fn fs(@builtin(position) at: vec4f) -> @location(0) f32 {
               return f32(textureDimensions(levels, u32(at.x) % 4u).x);
           }";
    let answers = &gpu.draw(&text, false, 1, &gpu.numbered_levels())[0];
    let right = |x: usize| (EDGE >> (x % 4)) as f32;
    let wrong = answers.iter().enumerate().filter(|&(pixel, &answer)| answer != right(pixel % EDGE as usize)).count();
    assert!(
        wrong > 0,
        "the driver knows each pixel's level: umbrage_bilinear in shaders/maps/moments.wesl may ask for sizes"
    );
}
