//! Conversion of depth maps to moments: conversion, blur and mip levels, and the textures that
//! receivers read.

use umbrage::config::{Derivatives, Fallbacks, MomentKind, Moments as MomentFilter};
use umbrage::{MAX_SPLITS, ShadowPlan};
use umbrage_shaders::layout::{self, FilterKind};
use umbrage_shaders::{MOMENT_PASSES, MOMENT_PASSES_OF_SAMPLES, MomentMaps, twin::moments::of_depth};

use crate::options::filter_kind;
use crate::{Error, Filter, Result, device};

/// Number format of moments: the best that the device supports, chosen when the maps are created.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MomentStorage {
    /// 32-bit floats, filtered by the hardware's sampler: needs `FLOAT32_FILTERABLE` (see
    /// [`crate::optional_features`]).
    F32,
    /// 16-bit floats, for the exponential filters, with exponents that fit. They leak more light.
    F16,
    /// 32-bit floats that the receiver's shader filters itself, for filters for which 16 bits are
    /// not enough.
    F32Manual,
}

/// Most texels of a kernel to each side; maps keep as much room around the points that they serve.
const MOST_RADIUS: f64 = 15.0;

/// Width in texels of the finest map of a kernel without a given width. All other maps have the
/// same width in metres, unless that is less than the width of linear sampling.
const DEFAULT_TEXELS: f64 = 8.0;

/// Edge of the smallest mip level in texels: no pixel covers more of a map than that.
const LEAST_LEVEL: u32 = 4;

/// Most texels along the longer axis of a pixel's footprint that a sampler reads.
const ANISOTROPY: u16 = 16;

impl MomentStorage {
    /// The format for a filter on a device with these features; an error if fallbacks are
    /// forbidden.
    fn choose(kind: MomentKind, features: wgpu::Features, fallbacks: Fallbacks) -> Result<Self> {
        if features.contains(wgpu::Features::FLOAT32_FILTERABLE) {
            return Ok(Self::F32);
        }
        if fallbacks == Fallbacks::Forbid {
            return Err(Error::NoFilterableFloats { filter: kind.word() });
        }
        Ok(if matches!(kind, MomentKind::Vsm | MomentKind::Msm) { Self::F32Manual } else { Self::F16 })
    }

    /// Exponents of the rising and the falling exponential: the largest ones whose squares fit,
    /// e^(2·40) in 3e38 and e^(2·5.5) in 65504. The falling one is A. Lauritzen's 5 if there is
    /// room, as larger ones only add noise. A single moment is not squared.
    fn exponents(self, kind: MomentKind) -> [f32; 2] {
        match (self, kind) {
            (Self::F16, MomentKind::Esm) => [9.0, 0.0],
            (Self::F16, _) => [5.5, 5.5],
            _ => [40.0, 5.0],
        }
    }

    fn format(self, kind: MomentKind) -> wgpu::TextureFormat {
        use wgpu::TextureFormat::*;
        match (kind, self) {
            (MomentKind::Esm, Self::F16) => R16Float,
            (MomentKind::Esm, _) => R32Float,
            (MomentKind::Vsm | MomentKind::Evsm2, Self::F16) => Rg16Float,
            (MomentKind::Vsm | MomentKind::Evsm2, _) => Rg32Float,
            (MomentKind::Evsm4 | MomentKind::Msm, Self::F16) => Rgba16Float,
            (MomentKind::Evsm4 | MomentKind::Msm, _) => Rgba32Float,
        }
    }

    /// Note for a device that does not store moments as 32-bit floats with the hardware's filter.
    pub(crate) fn note(self, kind: MomentKind) -> Option<String> {
        match self {
            Self::F32 => None,
            Self::F16 => Some(format!(
                "no filterable 32-bit floats: {kind} is kept in 16-bit floats, with smaller exponents, and leaks more"
            )),
            Self::F32Manual => {
                Some(format!("no filterable 32-bit floats: the shader filters the moments of {kind} itself"))
            }
        }
    }
}

/// Textures, pipelines and bind groups of one set of maps.
#[derive(Debug)]
pub(crate) struct Moments {
    kind: MomentKind,
    storage: MomentStorage,
    own_taps: bool,
    texture: wgpu::Texture,
    between: wgpu::Texture,
    between_view: wgpu::TextureView,
    frame_buffer: wgpu::Buffer,
    pass_buffer: wgpu::Buffer,
    pass_stride: u64,
    convert: wgpu::RenderPipeline,
    blur_u: wgpu::RenderPipeline,
    blur_v: wgpu::RenderPipeline,
    halve: wgpu::RenderPipeline,
    far: wgpu::Color,
    splits: Vec<SplitTargets>,
    /// Uniform of each split for the last plan; `None` for a split without casters.
    wanted: Vec<Option<layout::MomentPass>>,
}

/// One split's views and bind groups.
#[derive(Debug)]
struct SplitTargets {
    /// Views of the mip levels.
    levels: Vec<wgpu::TextureView>,
    from_depth: wgpu::BindGroup,
    from_level_0: wgpu::BindGroup,
    from_between: wgpu::BindGroup,
    /// Bind groups that read level i to make level i + 1.
    halves: Vec<wgpu::BindGroup>,
}

impl Moments {
    /// Creates textures and pipelines. `depths` has one view for each split; `edge` is the edge of
    /// a layer, and `layers` the number of layers.
    pub fn new(
        device: &wgpu::Device,
        &MomentFilter { kind, samples, .. }: &MomentFilter,
        fallbacks: Fallbacks,
        [edge, layers]: [u32; 2],
        depths: &[wgpu::TextureView],
    ) -> Result<Self> {
        if device.adapter_info().backend == wgpu::Backend::Gl {
            return Err(Error::NoDepthLoads { filter: kind.word() });
        }
        let storage = MomentStorage::choose(kind, device.features(), fallbacks)?;
        // Mesa's software driver (seen with 22.3) gives an anisotropic sample the differences
        // between neighbouring pixels' places, whatever derivatives or level it was told: wrong on
        // every border of splits, and outside fragment shaders.
        let own_taps = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let format = storage.format(kind);
        let level_count = edge.max(LEAST_LEVEL).ilog2() - LEAST_LEVEL.ilog2() + 1;
        let texture_of = |label, layers, levels| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: layers },
                mip_level_count: levels,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let texture = texture_of("Moments::maps", layers, level_count);
        let between = texture_of("Moments::between", 1, 1);
        let between_view = between.create_view(&wgpu::TextureViewDescriptor::default());

        let uniform = |label, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let pass_bytes = size_of::<layout::MomentPass>() as u64;
        let pass_stride = pass_bytes.next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment));
        let frame_buffer = uniform("Moments::frame", size_of::<layout::Moments>() as u64);
        let pass_buffer = uniform("Moments::passes", pass_stride * depths.len() as u64);

        let from_depth_layout = pass_layout(device, true, wgpu::TextureSampleType::Depth, samples > 1);
        let unfiltered = wgpu::TextureSampleType::Float { filterable: false };
        let blur_layout = pass_layout(device, true, unfiltered, false);
        let halve_layout = pass_layout(device, false, unfiltered, false);
        let group = |layout: &wgpu::BindGroupLayout, split: Option<usize>, binding: u32, view: &wgpu::TextureView| {
            let buffer = split.map(|split| wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &pass_buffer,
                    offset: split as u64 * pass_stride,
                    size: wgpu::BufferSize::new(pass_bytes),
                }),
            });
            let texture = wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
            let entries: Vec<_> = buffer.into_iter().chain([texture]).collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("Moments::pass"),
                layout,
                entries: &entries,
            })
        };
        let splits = (depths.iter().enumerate())
            .map(|(split, depth)| {
                let levels: Vec<_> = (0..level_count).map(|level| level_view(&texture, split as u32, level)).collect();
                SplitTargets {
                    from_depth: group(&from_depth_layout, Some(split), 1, depth),
                    from_level_0: group(&blur_layout, Some(split), 2, &levels[0]),
                    from_between: group(&blur_layout, Some(split), 2, &between_view),
                    halves: levels[1..]
                        .iter()
                        .zip(&levels)
                        .map(|(_, from)| group(&halve_layout, None, 2, from))
                        .collect(),
                    levels,
                }
            })
            .collect();

        let exponents = storage.exponents(kind);
        let shader_kind = filter_kind(&Filter::Moments(MomentFilter::new(kind)));
        let text = if samples > 1 { MOMENT_PASSES_OF_SAMPLES } else { MOMENT_PASSES };
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Moments::passes"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = |layout, entry| pass_pipeline(device, &module, layout, entry, format, shader_kind, exponents);
        let far = of_depth(shader_kind, exponents, 1.0).map(f64::from);
        Ok(Self {
            kind,
            storage,
            own_taps,
            convert: pipeline(&from_depth_layout, "fs_convert"),
            blur_u: pipeline(&blur_layout, "fs_blur_u"),
            blur_v: pipeline(&blur_layout, "fs_blur_v"),
            halve: pipeline(&halve_layout, "fs_halve"),
            texture,
            between,
            between_view,
            frame_buffer,
            pass_buffer,
            pass_stride,
            far: wgpu::Color { r: far[0], g: far[1], b: far[2], a: far[3] },
            wanted: vec![None; depths.len()],
            splits,
        })
    }

    /// The chosen number format.
    pub fn storage(&self) -> MomentStorage {
        self.storage
    }

    /// The part of the receiver text that reads these moments.
    pub fn maps(&self) -> MomentMaps {
        match (self.storage, self.own_taps) {
            (MomentStorage::F32Manual, _) => MomentMaps::Manual,
            (_, true) => MomentMaps::Taps,
            (_, false) => MomentMaps::Sampled,
        }
    }

    /// Memory in bytes of all levels and of the texture between the blurs.
    pub fn bytes(&self) -> u64 {
        [&self.texture, &self.between].into_iter().map(texture_bytes).sum()
    }

    /// Bind group layout entries after the frame's uniform.
    pub fn receiver_entries(&self, visibility: wgpu::ShaderStages) -> Vec<wgpu::BindGroupLayoutEntry> {
        let by_hand = self.storage == MomentStorage::F32Manual;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let texture = entry(
            1,
            wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: !by_hand },
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
        );
        let sampler = entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering));
        let uniform = entry(
            3,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(size_of::<layout::Moments>() as u64),
            },
        );
        if by_hand { vec![texture, uniform] } else { vec![texture, sampler, uniform] }
    }

    /// The bind group for [`Moments::receiver_entries`].
    pub fn receiver_bind_group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        frame: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let view = self.texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("Moments::all"),
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let sampler = (self.storage != MomentStorage::F32Manual).then(|| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("Moments::smooth"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                anisotropy_clamp: if self.own_taps { 1 } else { ANISOTROPY },
                ..Default::default()
            })
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let texture = entry(1, wgpu::BindingResource::TextureView(&view));
        let sampler = sampler.as_ref().map(|sampler| entry(2, wgpu::BindingResource::Sampler(sampler)));
        let uniforms = [entry(0, frame.as_entire_binding()), entry(3, self.frame_buffer.as_entire_binding())];
        let entries: Vec<_> = uniforms.into_iter().chain([texture]).chain(sampler).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("ShadowMaps::receiver"),
            layout,
            entries: &entries,
        })
    }

    /// Writes a plan's uniforms; nothing is written if the plan cannot be used.
    pub fn prepare(&mut self, queue: &wgpu::Queue, plan: &ShadowPlan, filter: &MomentFilter) -> Result<()> {
        let wanted = self.wanted(plan, filter)?;
        self.write(queue, wanted, filter)
    }

    /// Checked uniforms of a plan's splits.
    fn wanted(&self, plan: &ShadowPlan, filter: &MomentFilter) -> Result<Vec<Option<layout::MomentPass>>> {
        let finest = plan.splits.iter().map(|split| split.texel_m.max_element()).fold(f64::INFINITY, f64::min);
        let width = filter.width_m.unwrap_or(DEFAULT_TEXELS * finest);
        (plan.splits.iter().enumerate())
            .map(|(index, split)| {
                let (first, last) = split.receiver_depths;
                let span = last - first;
                if !(span > 0.0 && span.is_finite() && first.is_finite()) {
                    let expected = "two finite depths that rise";
                    return Err(Error::InvalidSplit { split: index, field: "receiver_depths", value: span, expected });
                }
                let range = split.depth_far - split.depth_near;
                let radius = (0.5 * width / split.texel_m).clamp(glam::DVec2::ONE, glam::DVec2::splat(MOST_RADIUS));
                let pass = layout::MomentPass {
                    split: layout::MomentSplit {
                        depth: [2.0 * range / span, 2.0 * (split.depth_near - first) / span - 1.0].map(|x| x as f32),
                        radius: radius.as_vec2().to_array(),
                        ..layout::MomentSplit::default()
                    },
                    size: split.size as f32,
                    ..layout::MomentPass::default()
                };
                Ok((!split.casters.is_empty()).then_some(pass))
            })
            .collect()
    }

    fn write(
        &mut self,
        queue: &wgpu::Queue,
        wanted: Vec<Option<layout::MomentPass>>,
        filter: &MomentFilter,
    ) -> Result<()> {
        let quads = (filter.derivatives == Derivatives::Quad).into();
        let mut frame = layout::Moments {
            exponents: self.storage.exponents(self.kind),
            bleeding: filter.bleeding as f32,
            splits: [layout::MomentSplit { quads, ..layout::MomentSplit::default() }; MAX_SPLITS],
            ..layout::Moments::default()
        };
        for (index, pass) in wanted.iter().enumerate() {
            let Some(pass) = pass else { continue };
            frame.splits[index] = layout::MomentSplit { quads, ..pass.split };
            device::write(queue, &self.pass_buffer, index as u64 * self.pass_stride, bytemuck::bytes_of(pass))?;
        }
        device::write(queue, &self.frame_buffer, 0, bytemuck::bytes_of(&frame))?;
        self.wanted = wanted;
        Ok(())
    }

    /// Records the passes.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        for (targets, pass) in self.splits.iter().zip(&self.wanted) {
            let Some(pass) = pass else { continue };
            let mut draw = |label, target: &wgpu::TextureView, load, size: Option<u32>, pipeline, group| {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some(label),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: target,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                    })],
                    depth_stencil_attachment: None,
                    timestamp_writes: None,
                    occlusion_query_set: None,
                    multiview_mask: None,
                });
                if let Some(size) = size {
                    pass.set_scissor_rect(0, 0, size, size);
                }
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
            };
            let size = Some(pass.size as u32);
            let [level_0, smaller @ ..] = &targets.levels[..] else { continue };
            // What lies outside the map is the last place, in this level and so in all.
            let cleared = wgpu::LoadOp::Clear(self.far);
            draw("Moments::convert", level_0, cleared, size, &self.convert, &targets.from_depth);
            draw("Moments::blur_u", &self.between_view, cleared, size, &self.blur_u, &targets.from_level_0);
            draw("Moments::blur_v", level_0, wgpu::LoadOp::Load, size, &self.blur_v, &targets.from_between);
            for (level, group) in smaller.iter().zip(&targets.halves) {
                draw("Moments::halve", level, cleared, None, &self.halve, group);
            }
        }
    }
}

/// View of one level of one layer.
fn level_view(texture: &wgpu::Texture, layer: u32, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some("Moments::level"),
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_mip_level: level,
        mip_level_count: Some(1),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// Memory in bytes of all levels of a colour texture.
fn texture_bytes(texture: &wgpu::Texture) -> u64 {
    let texel = u64::from(texture.format().block_copy_size(None).unwrap_or(0));
    let level =
        |level: u32| u64::from((texture.width() >> level).max(1)) * u64::from((texture.height() >> level).max(1));
    (0..texture.mip_level_count()).map(level).sum::<u64>() * u64::from(texture.depth_or_array_layers()) * texel
}

/// Bind group layout of a pass: a uniform at 0 if there is one, and a texture: depths at 1, moments
/// at 2.
fn pass_layout(
    device: &wgpu::Device,
    uniform: bool,
    sample_type: wgpu::TextureSampleType,
    multisampled: bool,
) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let uniform = uniform.then(|| {
        let min_binding_size = wgpu::BufferSize::new(size_of::<layout::MomentPass>() as u64);
        let ty = wgpu::BufferBindingType::Uniform;
        entry(0, wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size })
    });
    let binding = if sample_type == wgpu::TextureSampleType::Depth { 1 } else { 2 };
    let view_dimension = wgpu::TextureViewDimension::D2;
    let texture = entry(binding, wgpu::BindingType::Texture { sample_type, view_dimension, multisampled });
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("Moments::pass"),
        entries: &uniform.into_iter().chain([texture]).collect::<Vec<_>>(),
    })
}

fn pass_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    entry_point: &str,
    format: wgpu::TextureFormat,
    kind: FilterKind,
    exponents: [f32; 2],
) -> wgpu::RenderPipeline {
    let constants = [
        ("KIND", f64::from(kind as u32)),
        ("POSITIVE_EXPONENT", f64::from(exponents[0])),
        ("NEGATIVE_EXPONENT", f64::from(exponents[1])),
    ];
    let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry_point),
        layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Moments::pass"),
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        })),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_all"),
            compilation_options: options.clone(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry_point),
            compilation_options: options,
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
