//! The maps: their textures, the passes that draw them, the bind groups.

pub(crate) mod choose;
mod groups;
mod lights;
mod passes;
mod slices;
pub(crate) mod storage;
mod targets;

use std::num::NonZeroU32;

use umbrage::{Bands, MAX_SPLITS, Selection, ShadowPlan, ShadowSettings};
use umbrage_shaders::layout::{MetricKind, SelectionKind};
use umbrage_shaders::{Bound, Casters, Lights, Maps, Projection, ReceiverText};

use choose::{Abilities, Chosen};
use groups::Uniforms;
pub use passes::MapPass;
pub use slices::Slice;
use storage::{Arrangement, Tile};
use targets::Targets;

use crate::moments::{MomentStorage, Moments};
use crate::uniforms::{Place, Viewport};
use crate::{Error, FrameOptions, Generation, LightSlot, Result, ShadowMapsOptions, Storage};

/// Features that make shadows better where an adapter has them: request `adapter.features() & optional_features()`.
///
/// `DEPTH_CLIP_CONTROL` lets the near plane lie at the receivers ([`ShadowMaps::depth_clamp`]), `MULTIVIEW` (with a
/// `max_multiview_view_count` of 2 or more in the limits) draws the layers of [`Generation::Layered`] and [`Generation::Mixed`] at
/// once, `CLIP_DISTANCES` keeps the tiles of [`Generation::Instanced`] and [`Generation::Mixed`] apart,
/// `FLOAT32_FILTERABLE` lets the hardware filter moments in full precision ([`MomentStorage`]).
#[must_use]
pub fn optional_features() -> wgpu::Features {
    wgpu::Features::DEPTH_CLIP_CONTROL
        | wgpu::Features::MULTIVIEW
        | wgpu::Features::CLIP_DISTANCES
        | wgpu::Features::FLOAT32_FILTERABLE
}

/// The shadow maps of one light for one view, or of several lights ([`ShadowMaps::prepare_lights`]), on the GPU.
///
/// [`Storage`] says where maps are kept, [`Generation`] how they are drawn. Each frame: [`ShadowMaps::prepare`], every pass of
/// [`ShadowMaps::passes`] from [`ShadowMaps::begin_pass`], then any pass of the app with [`ShadowMaps::receiver_bind_group`]. With
/// [`Storage::Reused`] the app's pass is taken apart into slices, each after its map: see [`ShadowMaps::slice_bind_group`]. Several views of
/// one scene are as many `ShadowMaps`, each planned for its view.
#[derive(Debug)]
pub struct ShadowMaps {
    options: ShadowMapsOptions,
    notes: Vec<String>,
    places: Vec<Place>,
    /// The viewport of passes that draw several layers at once.
    viewport: Viewport,
    passes: Vec<MapPass>,
    multiview_mask: Option<NonZeroU32>,
    depth_loads: bool,
    depth_clamp: bool,
    colour_target: Option<wgpu::ColorTargetState>,
    targets: Targets,
    moments: Option<Moments>,
    casters: Uniforms,
    receivers: Uniforms,
}

impl ShadowMaps {
    /// Makes the textures, buffers and bind groups. Before the first [`ShadowMaps::prepare`] every
    /// answer is 0.
    ///
    /// # Errors
    /// [`Error::SplitCount`], [`Error::MapTooSmall`], [`Error::MapTooLarge`], [`Error::TooManyLayers`], [`Error::AtlasTooLarge`],
    /// [`Error::TooManyTextures`], [`Error::TooManyLights`], [`Error::LightsNeedArray`], [`Error::ConflictingOptions`],
    /// [`Error::MissingFeature`]; for filters of moments also [`Error::Samples`], [`Error::NoFilterableFloats`],
    /// [`Error::NoDepthLoads`], [`Error::MomentsNeedArray`] and [`Error::MomentsNeedOneSun`].
    pub fn new(device: &wgpu::Device, options: &ShadowMapsOptions) -> Result<Self> {
        let limits = device.limits();
        check_sizes(options, &limits)?;
        check_samples(options)?;
        let abilities = Abilities::of(device);
        let Chosen { storage, generation, notes } = choose::choose(options, abilities)?;
        let options = ShadowMapsOptions { storage, generation, ..options.clone() };
        let sizes = &lights::map_sizes(&options, &limits)?;
        let passes = MapPass::all(generation, sizes.len(), abilities);
        let arrangement = Arrangement::new(storage, generation, &passes, sizes, limits.max_texture_dimension_2d)?;
        check_limits(device, storage, &arrangement)?;

        check_moments(&options, sizes.len())?;

        let targets = Targets::new(device, &options, &arrangement, &passes);
        let backend = device.adapter_info().backend;
        let depth_loads = backend != wgpu::Backend::Gl;
        let viewport = Viewport::around(sizes.iter().copied().max().unwrap_or(0), largest_viewport(device));
        let mut places = places(device, sizes, &arrangement.tiles);
        if generation == Generation::Layered {
            places.iter_mut().for_each(|place| place.viewport = viewport);
        }
        let moments = (options.filter.is_prefiltered())
            .then(|| {
                let layers = targets::layers_needed(device, storage, &arrangement);
                let depths = targets.splits(&arrangement);
                Moments::new(device, &options, [arrangement.layer_texels[0], layers], &depths)
            })
            .transpose()?;
        Ok(Self {
            notes,
            places,
            viewport,
            multiview_mask: targets::multiview_mask(generation, &passes),
            depth_loads,
            depth_clamp: device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL),
            colour_target: options.depth_format.is_colour().then(|| options.depth_format.texture_format().into()),
            casters: Uniforms::of_casters(device, &passes),
            receivers: Uniforms::of_receivers(device, &options, &targets, depth_loads, moments.as_ref()),
            targets,
            moments,
            passes,
            options,
        })
    }

    /// Hands a frame's plan to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::PlanMismatch`] if the plan was made for other maps, [`Error::ConflictingOptions`] if it blends splits and there is only
    /// one map at a time, [`Error::InvalidPlan`] or [`Error::InvalidSplit`] if it holds a number that cannot be used,
    /// [`Error::InvalidFrameOption`]. Nothing has been written then.
    pub fn prepare(&mut self, queue: &wgpu::Queue, plan: &ShadowPlan, options: &FrameOptions) -> Result<()> {
        self.prepare_lights(queue, &[plan], options)
    }

    /// The passes that draw the maps, in order: with [`Generation::PerSplit`] and [`Generation::Multipass`] one for each split.
    #[must_use]
    pub fn passes(&self) -> &[MapPass] {
        &self.passes
    }

    /// Begins pass `pass` of [`ShadowMaps::passes`]: its maps are cleared, viewport and scissor are set and have to stay. Bind
    /// [`ShadowMaps::caster_bind_group`] of the same pass and draw what [`MapPass::casters`] says in any order. Begin every pass, the first
    /// one first: it clears what the others share.
    ///
    /// # Panics
    /// If there is no such pass.
    pub fn begin_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: usize,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let mut render = self.targets.begin(encoder, pass, self.multiview_mask, timestamp_writes);
        let split = self.passes[pass].splits().start;
        let Place { tile, viewport } = self.places[split];
        match self.options.generation {
            // The whole layer is the viewport: clip distances cut the tiles out of it.
            Generation::Instanced | Generation::Mixed => {}
            Generation::Layered => {
                let (corner, edge) = (-(self.viewport.guard as f32), self.viewport.edge as f32);
                render.set_viewport(corner, corner, edge, edge, 0.0, 1.0);
                render.set_scissor_rect(0, 0, tile.layer_texels[0], tile.layer_texels[1]);
            }
            Generation::Auto | Generation::PerSplit | Generation::Multipass => {
                let (size, edge) = (self.options.map_sizes[split % self.splits()], viewport.edge as f32);
                let [left, top] = tile.corner.map(|texels| texels as f32 - viewport.guard as f32);
                render.set_viewport(left, top, edge, edge, 0.0, 1.0);
                render.set_scissor_rect(tile.corner[0], tile.corner[1], size, size);
            }
        }
        render
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
    /// [`ShadowMaps::caster_bind_group`]. It stands before everything else in its module. The vertex shader is the same for every path:
    ///
    /// ```wgsl
    /// @vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {
    ///     return umbrage_cast(position, instance);
    /// }
    /// ```
    #[must_use]
    pub fn caster_wgsl(&self, group: u32) -> String {
        self.caster_wgsl_with(group, "")
    }

    /// The same for vertex shaders that have more to return: `members` joins the struct `UmbrageCast`, for example
    /// `"@location(0) uv: vec2f,"`.
    #[must_use]
    pub fn caster_wgsl_with(&self, group: u32, members: &str) -> String {
        let casters = match self.options.generation {
            Generation::Auto | Generation::PerSplit | Generation::Multipass => Casters::default(),
            Generation::Layered => Casters { views: true, tiles: false },
            Generation::Instanced => Casters { views: false, tiles: true },
            Generation::Mixed => Casters { views: true, tiles: true },
        };
        umbrage_shaders::caster(group, casters, members)
    }

    /// What any shader needs to ask for visibility; `group` is the index at which the app binds
    /// [`ShadowMaps::receiver_bind_group`]. On GL and WebGL2, where depth textures cannot be loaded from, [`crate::Filter::Pcss`] is
    /// then [`crate::Filter::Disc`], unless the format is [`crate::DepthFormat::R32Float`].
    #[must_use]
    pub fn receiver_wgsl(&self, group: u32) -> String {
        umbrage_shaders::receiver(group, self.receiver_text())
    }

    /// [`ShadowMaps::receiver_wgsl`] for apps whose vertex shaders make the shadow coordinates of every split (`umbrage_shadow_coordinates` and
    /// `umbrage_shadow_from_coordinates`, see `umbrage_shaders::Maps::coordinates`). Plans have to be of a sun, without warps: others have
    /// coordinates that cannot be interpolated.
    ///
    /// # Errors
    /// [`Error::ConflictingOptions`] with more than [`crate::MAX_COORDINATES`] splits, with several lights and with
    /// [`crate::LightSlot::Cube`].
    pub fn receiver_wgsl_with_coordinates(&self, group: u32) -> Result<String> {
        let conflict =
            |second, reason| Err(Error::ConflictingOptions { first: "coordinates split".to_owned(), second, reason });
        let lights = &self.options.lights;
        if self.options.map_sizes.len() > umbrage_shaders::layout::MAX_COORDINATES {
            return conflict(
                format!("{} splits", self.options.map_sizes.len()),
                "vertices hand on the coordinates of at most 4 splits; use fewer splits or coordinates world",
            );
        }
        if lights.iter().map(|slot| slot.faces()).sum::<usize>() > 1 {
            return conflict(
                format!("{} lights with {} faces", lights.len(), lights.iter().map(|slot| slot.faces()).sum::<usize>()),
                "vertices hand on the coordinates of one sun; use one sun or coordinates world",
            );
        }
        let text = self.receiver_text();
        Ok(umbrage_shaders::receiver(group, ReceiverText { maps: Maps { coordinates: true, ..text.maps }, ..text }))
    }

    /// What receivers' text is made for.
    fn receiver_text(&self) -> ReceiverText {
        let ShadowMapsOptions { filter, storage, fixed, lights, .. } = &self.options;
        let lights = match () {
            () if lights.iter().all(|slot| *slot == LightSlot::Sun) => Lights::Suns,
            () if lights.iter().all(|slot| slot.faces() == 1) => Lights::Single,
            () => Lights::Any,
        };
        ReceiverText {
            filter: Some(filter.kind()),
            selection: fixed.selection.filter(|_| lights == Lights::Suns).map(|selection| match selection {
                Selection::Depth => SelectionKind::Depth,
                Selection::Map => SelectionKind::Map,
            }),
            metric: fixed.bands.filter(|_| lights == Lights::Suns).map(|bands| match bands {
                Bands::Planar => MetricKind::ViewDepth,
                Bands::Radial => MetricKind::Distance,
            }),
            transition: fixed.transition.map(|transition| transition.kind()),
            bias: fixed.bias.map(|bias| bias.kind()),
            projection: match fixed.warped {
                None => Projection::Any,
                Some(true) => Projection::Warped,
                Some(false) => Projection::Plain,
            },
            lights,
            sliced: *storage == Storage::Reused,
            ..self.receiver_maps().into()
        }
    }

    /// How receivers read these maps.
    fn receiver_maps(&self) -> Maps {
        let bound = match self.options.storage {
            Storage::Separate => Bound::Separate(self.splits()),
            Storage::Cube => Bound::Cube,
            Storage::Auto | Storage::Array | Storage::Atlas | Storage::Reused => Bound::Array,
        };
        Maps {
            bound,
            r32f: self.options.depth_format.is_colour(),
            without_loads: !self.depth_loads,
            frames: lights::frame_count(&self.options) as u32,
            moments: self.moments.as_ref().map(Moments::maps),
            coordinates: false,
        }
    }

    /// What the maps were made with; where the options left a choice, what was chosen.
    #[must_use]
    pub fn options(&self) -> &ShadowMapsOptions {
        &self.options
    }

    /// What was asked for and the device could not do, with what was done instead.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Planner settings that fit these maps: their sizes, their filter's radius, whether depth is clamped, and no blend where there is only
    /// one map at a time. Everything else, `image_size` in the first place, is the default and the app's to change.
    #[must_use]
    pub fn matching_settings(&self) -> ShadowSettings {
        let mut settings = ShadowSettings {
            map_sizes: self.options.map_sizes.clone(),
            filter_radius: self.options.filter.radius_texels(),
            depth_clamp: self.depth_clamp,
            ..ShadowSettings::default()
        };
        if self.options.storage == Storage::Reused {
            settings.blend = 0.0;
        }
        settings
    }

    /// Bytes of all maps, of depth buffers beside maps that are colours, and for filters of moments of these with their levels and of the
    /// texture between two blurs.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.targets.bytes() + self.moments.as_ref().map_or(0, Moments::bytes)
    }

    /// Whether depth is not clipped: what `umbrage::ShadowSettings::depth_clamp` wants. True if the device was requested with
    /// `DEPTH_CLIP_CONTROL` (see [`optional_features`]).
    #[must_use]
    pub fn depth_clamp(&self) -> bool {
        self.depth_clamp
    }

    /// The layer of [`ShadowMaps::map_texture`] that holds the map of split `split`, and the map's upper left corner there in
    /// texels. The map is a square of `map_sizes[split]` texels.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn map_place(&self, split: usize) -> (u32, [u32; 2]) {
        let tile = self.places[split].tile;
        (self.targets.layer(tile.layer), tile.corner)
    }

    /// The texture that holds the map of split `split`, where [`ShadowMaps::map_place`] says. Can be copied from, but not with several
    /// samples a texel.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::splits`].
    #[must_use]
    pub fn map_texture(&self, split: usize) -> &wgpu::Texture {
        self.targets.map(self.places[split].tile.layer)
    }

    /// Layout of the group that [`ShadowMaps::caster_wgsl`] declares.
    #[must_use]
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.casters.layout
    }

    /// The group to bind while drawing the casters of pass `pass`.
    ///
    /// # Panics
    /// If there is no such pass.
    #[must_use]
    pub fn caster_bind_group(&self, pass: usize) -> &wgpu::BindGroup {
        &self.casters.groups[pass]
    }

    /// Depth state for a pipeline that draws casters. It has no slope bias: receivers know their own slope.
    #[must_use]
    pub fn caster_depth_stencil(&self) -> wgpu::DepthStencilState {
        let format = self.options.depth_format;
        let format = if format.is_colour() { crate::DepthFormat::D32Float } else { format };
        wgpu::DepthStencilState {
            format: format.texture_format(),
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

    /// Colour targets of a pipeline that draws casters: none, but one with [`crate::DepthFormat::R32Float`]. Casters then need a fragment
    /// shader that returns `umbrage_caster_depth(at)` of its `@builtin(position)` at location 0; one that is there anyway, to discard,
    /// may return it in any format.
    #[must_use]
    pub fn caster_targets(&self) -> &[Option<wgpu::ColorTargetState>] {
        match &self.colour_target {
            Some(_) => std::slice::from_ref(&self.colour_target),
            None => &[],
        }
    }

    /// Multiview mask of a pipeline that draws casters.
    #[must_use]
    pub fn caster_multiview_mask(&self) -> Option<NonZeroU32> {
        self.multiview_mask
    }

    /// Layout of the group that [`ShadowMaps::receiver_wgsl`] declares, visible to vertex, fragment and compute shaders.
    #[must_use]
    pub fn receiver_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receivers.layout
    }

    /// The group to bind where visibility is asked for. With [`Storage::Reused`] it answers for whatever map was drawn last: bind
    /// [`ShadowMaps::slice_bind_group`] instead.
    #[must_use]
    pub fn receiver_bind_group(&self) -> &wgpu::BindGroup {
        &self.receivers.groups[0]
    }

    /// With [`Storage::Reused`], the group to bind after pass `split` and before the next: visibility is that of the slice whose map is
    /// there, and `umbrage_in_slice(position)` says what to discard because it belongs to another. Draw slices front to back, each with the
    /// matrix and the depth range of its [`Slice`] ([`Slice::all`]). With any other storage it is [`ShadowMaps::receiver_bind_group`].
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::splits`].
    #[must_use]
    pub fn slice_bind_group(&self, split: usize) -> &wgpu::BindGroup {
        assert!(split < self.splits(), "split {split} of {}", self.splits());
        self.receivers.groups.get(1 + split).unwrap_or(&self.receivers.groups[0])
    }
}

/// What the device holds of layers and of textures.
fn check_limits(device: &wgpu::Device, storage: Storage, arrangement: &Arrangement) -> Result<()> {
    let limits = device.limits();
    let (layers, limit) = (targets::layers_needed(device, storage, arrangement), limits.max_texture_array_layers);
    if layers > limit {
        return Err(Error::TooManyLayers { count: layers, limit });
    }
    let (count, limit) = (arrangement.tiles.len(), limits.max_sampled_textures_per_shader_stage);
    if storage == Storage::Separate && count > limit as usize {
        return Err(Error::TooManyTextures { count, limit });
    }
    Ok(())
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

/// Moments are made of depth, a layer for each split of one sun.
fn check_moments(options: &ShadowMapsOptions, maps: usize) -> Result<()> {
    let &ShadowMapsOptions { filter, storage, generation, samples, .. } = options;
    if !filter.is_prefiltered() {
        return Ok(());
    }
    let conflict =
        |second: String, reason| Err(Error::ConflictingOptions { first: format!("filter {filter:?}"), second, reason });
    if storage != Storage::Array {
        return Err(Error::MomentsNeedArray { storage, filter });
    }
    if maps > options.map_sizes.len() {
        return Err(Error::MomentsNeedOneSun { lights: options.lights.clone(), filter });
    }
    if options.depth_format.is_colour() {
        return conflict("depth format R32Float".to_owned(), "moments are made of depth; use D32Float or D16Unorm");
    }
    if generation != Generation::PerSplit && (generation != Generation::Layered || samples > 1) {
        let second = format!("generation {}", generation.name());
        return conflict(
            second,
            "moments need a layer for each split; use generation per-split, or layered with one sample a texel",
        );
    }
    Ok(())
}

/// A guard band around every map, except in browsers: those that are older than the rule reject a viewport that leaves its target.
fn largest_viewport(device: &wgpu::Device) -> u32 {
    let in_browser = device.adapter_info().backend == wgpu::Backend::BrowserWebGpu;
    if in_browser { 0 } else { device.limits().max_texture_dimension_2d }
}

fn places(device: &wgpu::Device, sizes: &[u32], tiles: &[Tile]) -> Vec<Place> {
    let largest = largest_viewport(device);
    let place = |(&size, &tile)| Place { tile, viewport: Viewport::around(size, largest) };
    sizes.iter().zip(tiles).map(place).collect()
}
