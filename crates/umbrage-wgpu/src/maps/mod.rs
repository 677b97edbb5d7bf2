//! The maps: their texture, the passes that draw them, two kinds of bind group.

mod lights;
pub(crate) mod storage;

use umbrage::{MAX_SPLITS, ShadowPlan, ShadowSettings};
use umbrage_shaders::{Maps, layout};

use storage::{Arrangement, Tile};

use crate::moments::{MomentStorage, Moments};
use crate::uniforms::{Place, Viewport};
use crate::{Error, FrameOptions, Generation, Result, ShadowMapsOptions, Storage};

/// Features that make shadows better where an adapter has them: request `adapter.features() & optional_features()`.
///
/// `DEPTH_CLIP_CONTROL` lets the near plane lie at the receivers ([`ShadowMaps::depth_clamp`]), `FLOAT32_FILTERABLE` lets the hardware
/// filter moments in full precision ([`MomentStorage`]).
#[must_use]
pub fn optional_features() -> wgpu::Features {
    wgpu::Features::DEPTH_CLIP_CONTROL | wgpu::Features::FLOAT32_FILTERABLE
}

/// The shadow maps of one light for one view, or of several lights ([`ShadowMaps::prepare_lights`]), on the GPU.
///
/// [`Storage`] says where maps are kept, [`Generation`] how they are drawn. Each frame: [`ShadowMaps::prepare`], one pass per split from
/// [`ShadowMaps::begin_split`], then any pass of the app with [`ShadowMaps::receiver_bind_group`]. Several views of one scene are as
/// many `ShadowMaps`, each planned for its view.
#[derive(Debug)]
pub struct ShadowMaps {
    options: ShadowMapsOptions,
    places: Vec<Place>,
    depth_loads: bool,
    depth_clamp: bool,
    /// One; with several samples a texel one for each split.
    textures: Vec<wgpu::Texture>,
    /// One for each layer; one for each texture if there are several.
    layers: Vec<wgpu::TextureView>,
    moments: Option<Moments>,
    frame_buffer: wgpu::Buffer,
    caster_buffer: wgpu::Buffer,
    caster_stride: u64,
    caster_layout: wgpu::BindGroupLayout,
    caster_bind_groups: Vec<wgpu::BindGroup>,
    receiver_layout: wgpu::BindGroupLayout,
    receiver_bind_group: wgpu::BindGroup,
}

impl ShadowMaps {
    /// Makes the texture, buffers and bind groups. Before the first [`ShadowMaps::prepare`] every
    /// answer is 0.
    ///
    /// # Errors
    /// [`Error::SplitCount`], [`Error::MapTooSmall`], [`Error::MapTooLarge`], [`Error::TooManyLayers`], [`Error::TooManyLights`],
    /// [`Error::LightsNeedArray`]; for filters of moments also [`Error::Samples`], [`Error::NoFilterableFloats`],
    /// [`Error::NoDepthLoads`], [`Error::MomentsNeedArray`] and [`Error::MomentsNeedOneSun`].
    pub fn new(device: &wgpu::Device, options: &ShadowMapsOptions) -> Result<Self> {
        check_sizes(options, &device.limits())?;
        check_samples(options)?;
        let map_sizes = lights::map_sizes(options, &device.limits())?;
        let backend = device.adapter_info().backend;
        let storage = if options.storage == Storage::Auto { Storage::Array } else { options.storage };
        let Arrangement { tiles, layers, layer_texels } =
            Arrangement::new(storage, &map_sizes, device.limits().max_texture_dimension_2d)?;
        let layer_count = layer_count(layers, layer_texels, backend);
        let limit = device.limits().max_texture_array_layers;
        if layer_count > limit {
            return Err(Error::TooManyLayers { count: layer_count, limit });
        }

        if options.filter.is_prefiltered() && storage != Storage::Array {
            return Err(Error::MomentsNeedArray { storage, filter: options.filter });
        }
        if options.filter.is_prefiltered() && map_sizes.len() > options.map_sizes.len() {
            return Err(Error::MomentsNeedOneSun { lights: options.lights.clone(), filter: options.filter });
        }
        // Several samples and several layers do not go together in one texture.
        let textures: Vec<wgpu::Texture> = if options.samples > 1 {
            options.map_sizes.iter().map(|&size| depth_texture(device, options, [size; 2], 1)).collect()
        } else {
            vec![depth_texture(device, options, layer_texels, layer_count)]
        };
        let layers: Vec<wgpu::TextureView> = if options.samples > 1 {
            textures.iter().map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default())).collect()
        } else {
            (0..layers).map(|layer| layer_view(&textures[0], layer)).collect()
        };
        let moments = options
            .filter
            .is_prefiltered()
            .then(|| Moments::new(device, options, [layer_texels[0], layer_count], &layers))
            .transpose()?;

        let uniform = |label, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let split_bytes = size_of::<layout::Split>() as u64;
        let caster_stride =
            split_bytes.next_multiple_of(u64::from(device.limits().min_uniform_buffer_offset_alignment));
        let frame_buffer = uniform("ShadowMaps::frame", lights::frame_bytes(options));
        let caster_buffer = uniform("ShadowMaps::casters", caster_stride * map_sizes.len() as u64);

        let caster_layout = caster_layout(device);
        let caster_bind_groups = (0..map_sizes.len() as u64)
            .map(|split| {
                device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("ShadowMaps::caster"),
                    layout: &caster_layout,
                    entries: &[wgpu::BindGroupEntry {
                        binding: 0,
                        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                            buffer: &caster_buffer,
                            offset: split * caster_stride,
                            size: wgpu::BufferSize::new(split_bytes),
                        }),
                    }],
                })
            })
            .collect();

        let receiver_layout = receiver_layout(device, lights::frame_bytes(options), moments.as_ref());
        let receiver_bind_group = match &moments {
            Some(moments) => moments.receiver_bind_group(device, &receiver_layout, &frame_buffer),
            None => {
                receiver_bind_group(device, &receiver_layout, &frame_buffer, &textures[0], &sampler(device, options))
            }
        };

        Ok(Self {
            options: ShadowMapsOptions { storage, generation: Generation::PerSplit, ..options.clone() },
            places: places(device, &map_sizes, &tiles),
            depth_loads: backend != wgpu::Backend::Gl,
            depth_clamp: device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL),
            textures,
            layers,
            moments,
            frame_buffer,
            caster_buffer,
            caster_stride,
            caster_layout,
            caster_bind_groups,
            receiver_layout,
            receiver_bind_group,
        })
    }

    /// Hands a frame's plan to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::PlanMismatch`] if the plan was made for other maps, [`Error::InvalidPlan`] or [`Error::InvalidSplit`] if it
    /// holds a number that cannot be used, [`Error::InvalidFrameOption`]. Nothing has been written then.
    pub fn prepare(&mut self, queue: &wgpu::Queue, plan: &ShadowPlan, options: &FrameOptions) -> Result<()> {
        self.prepare_lights(queue, &[plan], options)
    }

    /// Begins the pass that draws split `split`: its map is cleared, viewport and scissor are set and have to stay. Bind
    /// [`ShadowMaps::caster_bind_group`] of the same split and draw its casters in any order. Begin every split's pass, the first one
    /// first: it clears what the others share.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    pub fn begin_split<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        split: usize,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let Place { tile, viewport } = self.places[split];
        let shared = self.options.storage == Storage::Atlas && split > 0;
        let load = if shared { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(1.0) };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ShadowMaps::split"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.layers[tile.layer as usize],
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let (size, edge) = (self.options.map_sizes[split % self.splits()], viewport.edge as f32);
        let [left, top] = tile.corner.map(|texels| texels as f32 - viewport.guard as f32);
        pass.set_viewport(left, top, edge, edge, 0.0, 1.0);
        pass.set_scissor_rect(tile.corner[0], tile.corner[1], size, size);
        pass
    }

    /// Turns the depths that were drawn into what receivers read: for filters of moments conversion, blur and mip levels
    /// ([`crate::Filter::is_prefiltered`]), for all others nothing. Call it after the casters and before any receiver.
    pub fn filter(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(moments) = &self.moments {
            moments.record(encoder);
        }
    }

    /// What moments are kept in on this device; `None` for filters that compare depth.
    #[must_use]
    pub fn moment_storage(&self) -> Option<MomentStorage> {
        self.moments.as_ref().map(Moments::storage)
    }

    /// The number of splits; of a point light, of each face.
    #[must_use]
    pub fn splits(&self) -> usize {
        self.options.map_sizes.len()
    }

    /// What a vertex shader needs to draw casters; `group` is the index at which the app binds
    /// [`ShadowMaps::caster_bind_group`].
    #[must_use]
    pub fn caster_wgsl(&self, group: u32) -> String {
        umbrage_shaders::caster(group)
    }

    /// What any shader needs to ask for visibility; `group` is the index at which the app binds
    /// [`ShadowMaps::receiver_bind_group`]. On GL and WebGL2, where depth textures cannot be loaded from, [`crate::Filter::Pcss`] is
    /// then [`crate::Filter::Disc`].
    #[must_use]
    pub fn receiver_wgsl(&self, group: u32) -> String {
        let maps = Maps {
            without_loads: !self.depth_loads,
            frames: lights::frame_count(&self.options) as u32,
            moments: self.moments.as_ref().map(Moments::maps),
        };
        umbrage_shaders::receiver(group, maps)
    }

    /// What the maps were made with; where the options left a choice, what was chosen.
    #[must_use]
    pub fn options(&self) -> &ShadowMapsOptions {
        &self.options
    }

    /// Planner settings that fit these maps: their sizes, their filter's radius and whether depth is clamped. Everything else,
    /// `image_size` in the first place, is the default and the app's to change.
    #[must_use]
    pub fn matching_settings(&self) -> ShadowSettings {
        ShadowSettings {
            map_sizes: self.options.map_sizes.clone(),
            filter_radius: self.options.filter.radius_texels(),
            depth_clamp: self.depth_clamp,
            ..ShadowSettings::default()
        }
    }

    /// Bytes of all depths and, for filters of moments, of these with their levels and of the texture between two blurs.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let texels = |texture: &wgpu::Texture| {
            let size = texture.size();
            u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers)
        };
        let samples = self.textures.iter().map(texels).sum::<u64>() * u64::from(self.options.samples);
        samples * self.options.depth_format.texel_bytes() + self.moments.as_ref().map_or(0, Moments::bytes)
    }

    /// Whether depth is not clipped: what `umbrage::ShadowSettings::depth_clamp` wants. True if the device was requested with
    /// `DEPTH_CLIP_CONTROL` (see [`optional_features`]).
    #[must_use]
    pub fn depth_clamp(&self) -> bool {
        self.depth_clamp
    }

    /// The layer of [`ShadowMaps::depth_texture`] that holds the map of split `split`, and the map's upper left corner there in
    /// texels. The map is a square of `map_sizes[split]` texels.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn map_place(&self, split: usize) -> (u32, [u32; 2]) {
        let tile = self.places[split].tile;
        (tile.layer, tile.corner)
    }

    /// The depth maps themselves, each where [`ShadowMaps::map_place`] says. Can be copied from. With several samples a texel this is the
    /// texture of split 0, and cannot.
    #[must_use]
    pub fn depth_texture(&self) -> &wgpu::Texture {
        &self.textures[0]
    }

    /// Layout of the group that [`ShadowMaps::caster_wgsl`] declares.
    #[must_use]
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster_layout
    }

    /// The group to bind while drawing the casters of split `split`.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn caster_bind_group(&self, split: usize) -> &wgpu::BindGroup {
        &self.caster_bind_groups[split]
    }

    /// Depth state for a pipeline that draws casters. It has no slope bias: receivers know their own slope.
    #[must_use]
    pub fn caster_depth_stencil(&self) -> wgpu::DepthStencilState {
        wgpu::DepthStencilState {
            format: self.options.depth_format.texture_format(),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// Multisample state for a pipeline that draws casters: as many samples as [`crate::ShadowMapsOptions::samples`].
    #[must_use]
    pub fn caster_multisample(&self) -> wgpu::MultisampleState {
        wgpu::MultisampleState { count: self.options.samples, ..Default::default() }
    }

    /// Primitive state for a pipeline that draws casters: triangle lists, both faces (single-sided walls cast, too).
    #[must_use]
    pub fn caster_primitive(&self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState { cull_mode: None, unclipped_depth: self.depth_clamp, ..Default::default() }
    }

    /// Layout of the group that [`ShadowMaps::receiver_wgsl`] declares, visible to vertex, fragment and compute shaders.
    #[must_use]
    pub fn receiver_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receiver_layout
    }

    /// The group to bind where visibility is asked for.
    #[must_use]
    pub fn receiver_bind_group(&self) -> &wgpu::BindGroup {
        &self.receiver_bind_group
    }
}

/// Every size has to fit the filter and the device.
fn check_sizes(options: &ShadowMapsOptions, limits: &wgpu::Limits) -> Result<()> {
    let sizes = &options.map_sizes;
    let least = options.filter.least_size();
    let limit = limits.max_texture_dimension_2d;
    for (split, &size) in sizes.iter().enumerate() {
        if size < least {
            return Err(Error::MapTooSmall { split, size, filter: options.filter, least });
        }
        if size > limit {
            return Err(Error::MapTooLarge { split, size, limit });
        }
    }
    match sizes.len() {
        1..=MAX_SPLITS => Ok(()),
        count => Err(Error::SplitCount { count, most: MAX_SPLITS }),
    }
}

/// 1, or 4 where the mean of samples means something. WebGPU has these two everywhere.
fn check_samples(&ShadowMapsOptions { samples, filter, .. }: &ShadowMapsOptions) -> Result<()> {
    match samples {
        1 => Ok(()),
        4 if filter.is_prefiltered() => Ok(()),
        _ => Err(Error::Samples { samples, filter }),
    }
}

fn depth_texture(
    device: &wgpu::Device,
    options: &ShadowMapsOptions,
    [width, height]: [u32; 2],
    layers: u32,
) -> wgpu::Texture {
    // What has several samples cannot be copied.
    let copies = if options.samples > 1 { wgpu::TextureUsages::empty() } else { wgpu::TextureUsages::COPY_SRC };
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("ShadowMaps::depth"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: options.samples,
        dimension: wgpu::TextureDimension::D2,
        format: options.depth_format.texture_format(),
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | copies,
        view_formats: &[],
    })
}

fn layer_view(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some("ShadowMaps::layer"),
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// wgpu guesses a GL texture's kind from its number of layers: one is no array, and a multiple of six squares is a cube. A spare
/// layer makes it an array.
fn layer_count(layers: u32, [width, height]: [u32; 2], backend: wgpu::Backend) -> u32 {
    let mistaken = layers == 1 || (layers.is_multiple_of(6) && width == height);
    if backend == wgpu::Backend::Gl && mistaken { layers + 1 } else { layers }
}

/// A guard band around every map, except in browsers: those that are older than the rule reject a viewport that leaves its target.
fn places(device: &wgpu::Device, sizes: &[u32], tiles: &[Tile]) -> Vec<Place> {
    let in_browser = device.adapter_info().backend == wgpu::Backend::BrowserWebGpu;
    let largest = if in_browser { 0 } else { device.limits().max_texture_dimension_2d };
    let place = |(&size, &tile)| Place { tile, viewport: Viewport::around(size, largest) };
    sizes.iter().zip(tiles).map(place).collect()
}

fn sampler(device: &wgpu::Device, options: &ShadowMapsOptions) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("ShadowMaps::compare"),
        address_mode_u: wgpu::AddressMode::ClampToEdge,
        address_mode_v: wgpu::AddressMode::ClampToEdge,
        mag_filter: options.filter.sampler_mode(),
        min_filter: options.filter.sampler_mode(),
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    })
}

fn caster_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("ShadowMaps::caster"),
        entries: &[uniform_entry(wgpu::ShaderStages::VERTEX, size_of::<layout::Split>() as u64)],
    })
}

/// The frame's uniform, then depths and the sampler that compares with them, or what moments need.
fn receiver_layout(device: &wgpu::Device, frame_bytes: u64, moments: Option<&Moments>) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let of_depth = || {
        vec![
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
            ),
            entry(2, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison)),
        ]
    };
    let of_maps = moments.map_or_else(of_depth, |moments| moments.receiver_entries(visibility));
    let entries: Vec<_> = [uniform_entry(visibility, frame_bytes)].into_iter().chain(of_maps).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("ShadowMaps::receiver"),
        entries: &entries,
    })
}

fn receiver_bind_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    frame: &wgpu::Buffer,
    depths: &wgpu::Texture,
    compare: &wgpu::Sampler,
) -> wgpu::BindGroup {
    let view = depths.create_view(&wgpu::TextureViewDescriptor {
        label: Some("ShadowMaps::maps"),
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("ShadowMaps::receiver"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(compare) },
        ],
    })
}

/// A uniform of so many bytes at binding 0.
fn uniform_entry(visibility: wgpu::ShaderStages, bytes: u64) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(bytes),
        },
        count: None,
    }
}
