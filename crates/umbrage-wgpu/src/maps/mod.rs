//! Shadow maps: their textures, the passes that draw them, and the bind groups.

mod bindings;
pub(crate) mod choose;
mod groups;
mod kept;
mod lights;
mod limits;
mod passes;
pub(crate) mod place;
mod slices;
pub(crate) mod slot;
pub(crate) mod storage;
mod targets;
mod texts;

use std::num::NonZeroU32;

use umbrage::ShadowPlan;
use umbrage::config::{Cache, DepthFormat, Edges, Filter, Generation, Layout, Rebuilds, ShadowConfig};
use umbrage_shaders::Casters;

use choose::{Abilities, Chosen};
use groups::{Received, Uniforms};
use kept::KeptMaps;
use limits::{check_limits, check_sizes, largest_viewport, places};
pub use passes::MapPass;
use place::{Place, Viewport};
pub use slices::Slice;
use slot::Slot;
use storage::Arrangement;
use targets::Targets;

use crate::moments::{MomentStorage, Moments};
use crate::options::texture_format;
use crate::{Error, FrameOptions, LightMaps, Result, device};

/// Features that improve shadows if an adapter has them; [`device_descriptor`] requests them.
///
/// `DEPTH_CLIP_CONTROL` lets near planes of 16-bit maps lie at the receivers
/// ([`ShadowMaps::depth_clamp`]), `MULTIVIEW` draws the layers of [`Generation::Layered`] and
/// [`Generation::Mixed`] at once, `CLIP_DISTANCES` keeps the tiles of [`Generation::Instanced`] and
/// [`Generation::Mixed`] apart, `FLOAT32_FILTERABLE` lets the hardware filter moments in full
/// precision ([`MomentStorage`]).
#[must_use]
pub fn optional_features() -> wgpu::Features {
    wgpu::Features::DEPTH_CLIP_CONTROL
        | wgpu::Features::MULTIVIEW
        | wgpu::Features::CLIP_DISTANCES
        | wgpu::Features::FLOAT32_FILTERABLE
}

/// Descriptor with which to request a device: the application's own needs, plus every feature and
/// limit that improves shadows and that the adapter has. Without them the maps use fallbacks, which
/// their notes name.
///
/// ```no_run
/// # use umbrage_wgpu::{device_descriptor, wgpu};
/// # async fn example(adapter: wgpu::Adapter) -> Result<(), wgpu::RequestDeviceError> {
/// let (device, queue) = adapter.request_device(&device_descriptor(&adapter, wgpu::DeviceDescriptor::default())).await?;
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn device_descriptor<'a>(adapter: &wgpu::Adapter, own: wgpu::DeviceDescriptor<'a>) -> wgpu::DeviceDescriptor<'a> {
    let mut descriptor = own;
    descriptor.required_features |= adapter.features() & optional_features();
    if descriptor.required_features.contains(wgpu::Features::MULTIVIEW) {
        // Without it a device with multiview has one view.
        let views = adapter.limits().max_multiview_view_count;
        let limits = &mut descriptor.required_limits;
        limits.max_multiview_view_count = limits.max_multiview_view_count.max(views);
    }
    descriptor
}

/// The shadow maps of one light for one view, or of several lights
/// ([`ShadowMaps::prepare_lights`]), on the GPU: the low level below [`crate::Shadows`].
///
/// [`Layout`] chooses the storage of maps and the passes that draw them. Each frame:
/// [`ShadowMaps::prepare`], every pass of [`ShadowMaps::passes`] from [`ShadowMaps::begin_pass`],
/// [`ShadowMaps::prefilter`], then any pass of the application with
/// [`ShadowMaps::receiver_bind_group`]. With [`Layout::Reused`] the application's pass is divided
/// into slices, each after its map: see [`ShadowMaps::slice_bind_group`].
#[derive(Debug)]
pub struct ShadowMaps {
    device: wgpu::Device,
    /// The config as requested.
    config: ShadowConfig,
    /// The layout in use.
    layout: Layout,
    /// The edges in use.
    edges: Edges,
    slots: Vec<Slot>,
    notes: Vec<String>,
    places: Vec<Place>,
    /// Viewport of passes that draw several layers at once.
    viewport: Viewport,
    passes: Vec<MapPass>,
    multiview_mask: Option<NonZeroU32>,
    depth_loads: bool,
    depth_clip_control: bool,
    colour_target: Option<wgpu::ColorTargetState>,
    targets: Targets,
    moments: Option<Moments>,
    kept: Option<KeptMaps>,
    casters: Uniforms,
    receivers: Uniforms,
}

impl ShadowMaps {
    /// Creates the textures, buffers and bind groups for these lights, at least one: kinds
    /// ([`umbrage::config::LightKind`]) or [`LightMaps`]. Before the first [`ShadowMaps::prepare`]
    /// visibility is 0 everywhere.
    ///
    /// # Errors
    /// [`Error::Config`] for a config that is wrong or does not suit the lights;
    /// [`Error::MapTooLarge`], [`Error::TooManyLayers`], [`Error::AtlasTooLarge`],
    /// [`Error::TooManyTextures`], [`Error::TooManyLights`], [`Error::MissingFeature`],
    /// [`Error::NoFilterableFloats`], [`Error::NoDepthLoads`] and [`Error::NoExactEdges`] for
    /// limits of the device; [`Error::Device`] and [`Error::OutOfMemory`] for errors that the
    /// device reports; [`Error::DeviceLost`].
    pub fn new<L: Clone + Into<LightMaps>>(device: &wgpu::Device, config: &ShadowConfig, lights: &[L]) -> Result<Self> {
        let lights: Vec<LightMaps> = lights.iter().cloned().map(Into::into).collect();
        device::made(device, "making shadow maps", || Self::new_unguarded(device, config, &lights))
    }

    fn new_unguarded(device: &wgpu::Device, config: &ShadowConfig, lights: &[LightMaps]) -> Result<Self> {
        let limits = device.limits();
        let slots = Slot::all(config, lights, &limits)?;
        let sizes: &Vec<u32> = &slots.iter().flat_map(Slot::map_sizes).collect();
        check_sizes(&slots, &limits)?;
        let abilities = Abilities::of(device);
        let Chosen { layout, edges, mut notes } = choose::choose(config, abilities)?;
        let (storage, generation) = (layout.storage(), layout.generation());
        let passes = MapPass::all(generation, sizes.len(), abilities);
        let arrangement = Arrangement::new(storage, generation, &passes, sizes, limits.max_texture_dimension_2d)?;
        check_limits(device, (storage, edges), &arrangement)?;

        let targets = Targets::new(device, config, (storage, edges), sizes, &arrangement, &passes);
        let depth_loads = abilities.depth_loads;
        let depth_clip_control = device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL);
        let viewport = Viewport::around(sizes.iter().copied().max().unwrap_or(0), largest_viewport(device));
        let mut places = places(device, sizes, &arrangement.tiles);
        if generation == Generation::Layered {
            places.iter_mut().for_each(|place| place.viewport = viewport);
        }
        let moments = match &config.filter {
            Filter::Moments(filter) => {
                let layers = targets::layers_needed(device, storage, &arrangement);
                let depths = targets.splits(&arrangement);
                let edge_and_layers = [arrangement.layer_texels[0], layers];
                let moments = Moments::new(device, filter, config.fallbacks, edge_and_layers, &depths)?;
                notes.extend(moments.storage().note(filter.kind));
                Some(moments)
            }
            _ => None,
        };
        let is_colour = config.depth_format.is_colour();
        if config.depth_format == DepthFormat::D16Unorm && !depth_clip_control {
            notes.push(
                "no depth clip control: near planes of 16-bit maps lie in front of their first caster".to_owned(),
            );
        }
        if matches!(config.filter, Filter::Pcss { .. }) && !depth_loads && !is_colour {
            notes.push("no loads from depth textures on GL: pcss is a disc of fixed width".to_owned());
        }
        let keeps = config.cache == Cache::Kept;
        if keeps && !depth_loads {
            notes.push("no loads from depth textures on GL: nothing is kept of maps".to_owned());
        }
        let casters = Uniforms::of_casters(device, &passes);
        let kept = (keeps && depth_loads)
            .then(|| {
                let maps = (&sizes[..], &arrangement.tiles[..]);
                KeptMaps::new(device, &casters.layout, maps, largest_viewport(device))
            })
            .transpose()?;
        let received = Received {
            filter: config.filter,
            storage,
            is_colour,
            loads: depth_loads,
            frames: slots.iter().map(|slot| slot.kind.faces()).sum(),
            maps: sizes.len(),
        };
        Ok(Self {
            device: device.clone(),
            config: config.clone(),
            layout,
            edges,
            notes,
            places,
            viewport,
            multiview_mask: targets::multiview_mask(generation, &passes),
            depth_loads,
            depth_clip_control,
            colour_target: colour_format(config, edges).map(Into::into),
            casters,
            receivers: Uniforms::of_receivers(device, &received, &targets, moments.as_ref()),
            targets,
            moments,
            kept,
            passes,
            slots,
        })
    }

    /// Uses another config from the next [`ShadowMaps::prepare`] on. The config must need no other
    /// maps or pipelines: see [`umbrage::config::Setting::rebuilds`].
    ///
    /// # Errors
    /// [`Error::Config`] if the config is wrong, [`Error::NeedsNewMaps`] naming a setting that
    /// needs other maps or pipelines. The maps are unchanged then.
    pub fn set_config(&mut self, config: &ShadowConfig) -> Result<()> {
        let lights: Vec<LightMaps> =
            self.slots.iter().map(|slot| LightMaps::with_sizes(slot.kind, &slot.sizes)).collect();
        Slot::all(config, &lights, &self.device.limits())?;
        match self.config.rebuilds(config) {
            Some((rebuilds, setting)) if rebuilds > Rebuilds::Nothing => Err(Error::NeedsNewMaps { setting }),
            _ => {
                self.config = config.clone();
                Ok(())
            }
        }
    }

    /// Writes a frame's plan to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::PlanMismatch`] if the plan was made for other maps, [`Error::InvalidPlan`] or
    /// [`Error::InvalidSplit`] if it contains a number that cannot be used,
    /// [`Error::InvalidFrameOption`], [`Error::FilterTooWide`]. Nothing has been written then.
    /// [`Error::Device`] for errors that the device reports, [`Error::DeviceLost`].
    pub fn prepare(&mut self, queue: &wgpu::Queue, plan: &ShadowPlan, options: &FrameOptions) -> Result<()> {
        self.prepare_lights(queue, &[plan], options)
    }

    /// The passes that draw the maps, in order: with [`Generation::PerSplit`] and
    /// [`Generation::Multipass`] one for each map.
    #[must_use]
    pub fn passes(&self) -> &[MapPass] {
        &self.passes
    }

    /// Begins pass `pass` of [`ShadowMaps::passes`]: its maps are cleared, and viewport and scissor
    /// are set and have to stay. Bind [`ShadowMaps::caster_bind_group`] of the same pass and draw
    /// the casters of [`MapPass::casters`], in any order. Begin every pass, and the first one
    /// first, because it clears textures that the others share.
    ///
    /// # Panics
    /// If there is no such pass.
    pub fn begin_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: usize,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        self.begin(encoder, (pass, true), timestamp_writes)
    }

    fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        (pass, is_cleared): (usize, bool),
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let mut render = self.targets.begin(encoder, (pass, is_cleared), self.multiview_mask, timestamp_writes);
        let split = self.passes[pass].splits().start;
        let Place { tile, viewport } = self.places[split];
        match self.layout.generation() {
            // The whole layer is the viewport: clip distances cut the tiles out of it.
            Generation::Instanced | Generation::Mixed => {}
            Generation::Layered => {
                let (corner, edge) = (-(self.viewport.guard as f32), self.viewport.edge as f32);
                render.set_viewport(corner, corner, edge, edge, 0.0, 1.0);
                render.set_scissor_rect(0, 0, tile.layer_texels[0], tile.layer_texels[1]);
            }
            Generation::PerSplit | Generation::Multipass => {
                let (size, edge) = (self.map_size(split), viewport.edge as f32);
                let [left, top] = tile.corner.map(|texels| texels as f32 - viewport.guard as f32);
                render.set_viewport(left, top, edge, edge, 0.0, 1.0);
                render.set_scissor_rect(tile.corner[0], tile.corner[1], size, size);
            }
        }
        render
    }

    /// Converts the drawn depths to the form that receivers read: for moment filters by conversion,
    /// blur and mip levels ([`Filter::is_prefiltered`]); for all others it does nothing. Call it
    /// after the casters and before any receiver.
    pub fn prefilter(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(moments) = &self.moments {
            moments.record(encoder);
        }
    }

    /// Number format of moments on this device; `None` for filters that compare depth.
    #[must_use]
    pub fn moment_storage(&self) -> Option<MomentStorage> {
        self.moments.as_ref().map(Moments::storage)
    }

    /// Number of splits of the first light; for a point light, of each face.
    #[must_use]
    pub fn splits(&self) -> usize {
        self.slots[0].sizes.len()
    }

    /// WGSL that a vertex shader needs to draw casters; `group` is the index at which the
    /// application binds [`ShadowMaps::caster_bind_group`]. It has to come first in its module. The
    /// vertex shader is the same for every layout:
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

    /// WGSL for casters whose vertex shaders return more values: `members` is added to the struct
    /// `UmbrageCast`, for example `"@location(0) uv: vec2f,"`.
    #[must_use]
    pub fn caster_wgsl_with(&self, group: u32, members: &str) -> String {
        let (views, tiles) = match self.layout.generation() {
            Generation::PerSplit | Generation::Multipass => (false, false),
            Generation::Layered => (true, false),
            Generation::Instanced => (false, true),
            Generation::Mixed => (true, true),
        };
        umbrage_shaders::caster(group, Casters { views, tiles, ids: self.edges.is_exact() }, members)
    }

    /// The config of the maps.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        &self.config
    }

    /// Storage of maps and the passes that draw them: the config's layout, or the fallback that the
    /// device supports.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Method that decides where a shadow's edge lies: the config's edges, or the fallback that the
    /// device supports. With [`Edges::Exact`] a shader that computes visibility declares
    /// `umbrage_run` and `umbrage_corner`, or takes both from [`crate::stored_runs_wgsl`].
    #[must_use]
    pub fn edges(&self) -> Edges {
        self.edges
    }

    /// Texture of the ids that the texels of the map of split `split` store, with [`Edges::Exact`]:
    /// `R32Uint`, with the layers and the places of [`ShadowMaps::map_texture`]. Can be copied
    /// from.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn id_texture(&self, split: usize) -> Option<&wgpu::Texture> {
        self.targets.id(self.places[split].tile.layer)
    }

    /// Returns whether pipelines for casters and receivers that were made for `other` also fit
    /// these maps.
    pub(crate) fn shares_pipelines_with(&self, other: &Self) -> bool {
        // Bind group layouts follow from the texts: they hold what the texts declare.
        self.receiver_wgsl(0) == other.receiver_wgsl(0)
            && self.caster_wgsl(0) == other.caster_wgsl(0)
            && self.caster_depth_stencil() == other.caster_depth_stencil()
            && self.caster_targets() == other.caster_targets()
            && self.caster_multisample() == other.caster_multisample()
            && self.multiview_mask == other.multiview_mask
    }

    /// The device of the maps.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Number of lights.
    #[must_use]
    pub fn light_count(&self) -> usize {
        self.slots.len()
    }

    /// Requests that the device could not meet, each with the fallback.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Memory in bytes of all maps, of depth buffers beside colour maps, of ids beside depth, of
    /// kept textures, and for moment filters of the moments with their mip levels and of the
    /// texture between two blurs.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let moments = self.moments.as_ref().map_or(0, Moments::bytes);
        self.targets.bytes() + moments + self.kept.as_ref().map_or(0, KeptMaps::bytes)
    }

    /// Returns whether casters in front of a map's near plane are clamped to it, so that the plane
    /// may lie at the receivers: the value for [`umbrage::PlannerOptions::depth_clamp`]. True for
    /// 16-bit maps on a device with `DEPTH_CLIP_CONTROL` (see [`optional_features`]), which need
    /// the shorter depth range. 32-bit maps keep a fixed range, which does not move with the
    /// camera.
    #[must_use]
    pub fn depth_clamp(&self) -> bool {
        self.depth_clip_control && self.config.depth_format == DepthFormat::D16Unorm
    }

    /// Layer of [`ShadowMaps::map_texture`] that contains the map of split `split`, and the map's
    /// upper left corner there in texels. The map is a square of `map_sizes[split]` texels.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn map_place(&self, split: usize) -> (u32, [u32; 2]) {
        let tile = self.places[split].tile;
        (self.targets.layer(tile.layer), tile.corner)
    }

    /// Texture that contains the map of split `split`, at [`ShadowMaps::map_place`]. Can be copied
    /// from, but not with several samples per texel.
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::map_count`].
    #[must_use]
    pub fn map_texture(&self, split: usize) -> &wgpu::Texture {
        self.targets.map(self.places[split].tile.layer)
    }
}

/// Format of the colour target of casters' fragments, if they write more than depth.
fn colour_format(config: &ShadowConfig, edges: Edges) -> Option<wgpu::TextureFormat> {
    if edges.is_exact() {
        return Some(targets::ID_FORMAT);
    }
    config.depth_format.is_colour().then(|| texture_format(config.depth_format))
}
