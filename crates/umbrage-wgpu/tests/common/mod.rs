//! What the GPU tests share: a device, plans made by hand, a pass that draws triangles and a pass
//! that asks points.
#![allow(dead_code, unused_imports, reason = "each test file uses its own part of this module")]

pub mod painter;
mod world;

use bytemuck::Pod;
use glam::{DVec2, DVec3, DVec4, Vec3};
use umbrage::config::{Filter, LightKind, MomentKind, Moments, Preset, ShadowConfig};
use umbrage::{DirectionalLight, ShadowPlan, Split};
use umbrage_wgpu::{ShadowMaps, optional_features};
pub use world::*;

pub const PCF3: Filter = Filter::Pcf3 { width_m: None };
pub const PCF5: Filter = Filter::Pcf5 { width_m: None };
pub const PCF7: Filter = Filter::Pcf7 { width_m: None };
pub const DISC: Filter = Filter::Disc { width_m: None, rotated: false };
pub const PCSS: Filter = Filter::Pcss { sun_degrees: 0.53, rotated: false };
pub const ESM: Filter = Filter::Moments(Moments::new(MomentKind::Esm));
pub const VSM: Filter = Filter::Moments(Moments::new(MomentKind::Vsm));
pub const EVSM2: Filter = Filter::Moments(Moments::new(MomentKind::Evsm2));
pub const EVSM4: Filter = Filter::Moments(Moments::new(MomentKind::Evsm4));
pub const MSM: Filter = Filter::Moments(Moments::new(MomentKind::Msm));

/// Maps of one sun.
pub const SUN: [LightKind; 1] = [LightKind::Directional];

/// The papers' config with other maps, another filter, and settings over it, `key=value` with
/// spaces between.
pub fn config(map_sizes: &[u32], filter: Filter, settings: &str) -> ShadowConfig {
    with(ShadowConfig { map_sizes: map_sizes.to_vec(), filter, ..Preset::Papers.config() }, settings)
}

/// Every filter that compares depth.
pub fn depth_filters() -> impl Iterator<Item = Filter> {
    Filter::ALL.into_iter().filter(|filter| !filter.is_prefiltered())
}

/// A config with settings over it.
pub fn with(mut config: ShadowConfig, settings: &str) -> ShadowConfig {
    let given: Vec<(String, String)> = settings
        .split_whitespace()
        .map(|setting| setting.split_once('=').expect("key=value"))
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .collect();
    config.apply(&given).expect("settings that go together");
    config
}

/// A device of its own for each test, and the queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

impl Gpu {
    /// With every optional feature that the adapter has. `None`, and a line on stderr, without an
    /// adapter.
    pub fn new() -> Option<Self> {
        Self::without(wgpu::Features::empty())
    }

    pub fn without(withheld: wgpu::Features) -> Option<Self> {
        Self::limited(withheld, None)
    }

    /// Without some features, and with these limits instead of the adapter's.
    pub fn limited(withheld: wgpu::Features, limits: Option<wgpu::Limits>) -> Option<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let adapter = match pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())) {
            Ok(adapter) => adapter,
            Err(error) => {
                let required = std::env::var("UMBRAGE_REQUIRE_GPU").is_ok_and(|v| v == "1");
                assert!(!required, "UMBRAGE_REQUIRE_GPU=1, but {error}");
                eprintln!("SKIPPED: no adapter ({error})");
                return None;
            }
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("Test::device"),
            required_features: (adapter.features() & optional_features()).difference(withheld),
            required_limits: limits.unwrap_or_else(|| adapter.limits()),
            ..Default::default()
        }))
        .expect("an adapter gives a device with features and limits that it has");
        Some(Self { device, queue })
    }

    /// Runs `body` and fails if wgpu found anything wrong with it.
    pub fn checked<T>(&self, body: impl FnOnce() -> T) -> T {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = body();
        if let Some(error) = pollster::block_on(scope.pop()) {
            panic!("{error}");
        }
        result
    }

    /// The bytes of a buffer that can be copied from.
    pub fn copied(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        let back = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Test::copied"),
            size: buffer.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &back, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        self.read(&back)
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a mappable buffer maps"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        buffer.get_mapped_range(..).expect("mapped above").to_vec()
    }

    pub fn buffer_with(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("Test::buffer"),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// Runs one compute shader, entry point `main`, workgroup of 64, over `input` at binding 0 of
    /// group 0 into as many `O` at binding 1, with `maps` in group 1 if its text says so.
    pub fn compute<I: Pod, O: Pod>(&self, source: &str, input: &[I], maps: Option<&ShadowMaps>) -> Vec<O> {
        let bytes = size_of::<O>() as u64 * input.len() as u64;
        self.checked(|| {
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("Test::compute"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            };
            let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("Test::compute"),
                entries: &[storage(0, true), storage(1, false)],
            });
            let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("Test::compute"),
                layout: Some(&self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("Test::compute"),
                    bind_group_layouts: &[Some(&layout), maps.map(ShadowMaps::receiver_layout)],
                    immediate_size: 0,
                })),
                module: &module,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                cache: None,
            });
            let input_buffer = self.buffer_with(bytemuck::cast_slice(input), wgpu::BufferUsages::STORAGE);
            let output = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("Test::output"),
                size: bytes,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            let back = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("Test::back"),
                size: bytes,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Test::compute"),
                layout: &layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: input_buffer.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
                ],
            });
            let mut encoder = self.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                if let Some(maps) = maps {
                    pass.set_bind_group(1, maps.receiver_bind_group(), &[]);
                }
                pass.dispatch_workgroups((input.len() as u32).div_ceil(64), 1, 1);
            }
            encoder.copy_buffer_to_buffer(&output, 0, &back, 0, bytes);
            self.queue.submit([encoder.finish()]);
            bytemuck::cast_slice(&self.read(&back)).to_vec()
        })
    }
}

impl Gpu {
    /// Draws three vertices with entry points `vs` and `fs` over a square of `size` floating-point
    /// pixels, `maps` in group 2 after two uniforms, as an app may have them.
    pub fn fragments(&self, source: &str, size: u32, maps: &ShadowMaps) -> Vec<[f32; 4]> {
        assert_eq!(16 * size % wgpu::COPY_BYTES_PER_ROW_ALIGNMENT, 0, "rows without gaps");
        self.checked(|| {
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("Test::fragments"),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let format = wgpu::TextureFormat::Rgba32Float;
            let uniform_layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("Test::uniform"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                }],
            });
            let buffer = self.buffer_with(&[0; 16], wgpu::BufferUsages::UNIFORM);
            let uniform = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Test::uniform"),
                layout: &uniform_layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
            });
            let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("Test::fragments"),
                layout: Some(&self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some("Test::fragments"),
                    bind_group_layouts: &[Some(&uniform_layout), Some(&uniform_layout), Some(maps.receiver_layout())],
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
                multiview_mask: None,
                cache: None,
            });
            let extent = wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 };
            let target = self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("Test::target"),
                size: extent,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let back = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("Test::back"),
                size: u64::from(16 * size * size),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut encoder = self.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("Test::fragments"),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: &target.create_view(&Default::default()),
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations {
                            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                            store: wgpu::StoreOp::Store,
                        },
                    })],
                    ..Default::default()
                });
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &uniform, &[]);
                pass.set_bind_group(1, &uniform, &[]);
                pass.set_bind_group(2, maps.receiver_bind_group(), &[]);
                pass.draw(0..3, 0..1);
            }
            encoder.copy_texture_to_buffer(
                target.as_image_copy(),
                wgpu::TexelCopyBufferInfo {
                    buffer: &back,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(16 * size),
                        rows_per_image: Some(size),
                    },
                },
                extent,
            );
            self.queue.submit([encoder.finish()]);
            bytemuck::cast_slice(&self.read(&back)).to_vec()
        })
    }
}

/// A plan with one entry of `sizes` per split.
///
/// Slices go from view depth `planes[i]` to `planes[i + 1]`; every map is a square of `widths[i]`
/// metres around the world's point `center`, with depth from 100 m before it to 100 m behind it.
/// The eye looks along +X from x = 0. Splits have a caster (index 0) each.
pub fn plan(light: DVec3, center: DVec3, sizes: &[u32], planes: &[f64], widths: &[f64]) -> ShadowPlan {
    let light = DirectionalLight::new(light).expect("a direction");
    let (u, v) = light.map_axes();
    let depth = light.direction();
    let splits = (0..sizes.len())
        .map(|i| {
            let texel = widths[i] / f64::from(sizes[i]);
            let at = DVec2::new(u.dot(center), v.dot(center)) / texel;
            let (begin, end) = (depth.dot(center) - 100.0, depth.dot(center) + 100.0);
            let mut split = Split::default();
            (split.near, split.far, split.blend_begin) = (planes[i], planes[i + 1], planes[i + 1]);
            split.coverage = (planes[i], planes[i + 1]);
            (split.size, split.texel_m) = (sizes[i], DVec2::splat(texel));
            (split.u_axis, split.v_axis, split.depth_axis) = (u, v, depth);
            split.min_texel = (at - 0.5 * f64::from(sizes[i])).round();
            (split.depth_near, split.depth_far, split.receiver_depths) = (begin, end, (begin, end));
            split.filter_radius_texels = 16.0;
            split.casters = i..i + 1;
            split
        })
        .collect();
    let mut plan = ShadowPlan::default();
    (plan.splits, plan.planes) = (splits, planes.to_vec());
    plan.view_depth_plane = DVec4::new(1.0, 0.0, 0.0, 0.0);
    plan.light_direction = depth;
    plan.fade_begin = planes[sizes.len()];
    plan.caster_indices = vec![0; sizes.len()];
    plan.split_range = vec![Some((0, sizes.len() as u8 - 1))];
    plan
}

/// Two triangles: the corners of a quad in order around it.
pub fn quad(corners: [Vec3; 4]) -> Vec<Vec3> {
    [0, 1, 2, 0, 2, 3].map(|i| corners[i]).to_vec()
}

/// The ground around the origin, `half` metres to each side, at y = 0.
pub fn ground(half: f32) -> Vec<Vec3> {
    quad([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| half * Vec3::new(x, 0.0, z)))
}

/// A closed box.
pub fn cuboid(min: Vec3, max: Vec3) -> Vec<Vec3> {
    let corner = |i: usize| {
        Vec3::new(
            if i & 1 == 0 { min.x } else { max.x },
            if i & 2 == 0 { min.y } else { max.y },
            if i & 4 == 0 { min.z } else { max.z },
        )
    };
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
        .iter()
        .flat_map(|face| quad(face.map(corner)))
        .collect()
}
