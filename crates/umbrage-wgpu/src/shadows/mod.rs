//! The main API: prepares maps from a view, lights and boxes.

mod draws;
mod frame;
mod inputs;
mod planning;

use umbrage::config::{LightKind, Rebuilds, ShadowConfig};
use umbrage::{Keeper, KeptFrame, KeptRegion, PlannerOptions};

use draws::Draws;
pub use frame::{ShadowFrame, ShadowMap, ShapeDraw};
pub use inputs::Inputs;
use planning::Planning;

use crate::{Error, FrameOptions, LightMaps, Occluders, Result, ShadowMaps};

/// Shadows of one sun or several lights, for one view or several.
///
/// Each frame: [`Shadows::prepare`], every map of [`ShadowFrame::maps`] drawn with its casters,
/// [`Shadows::prefilter`], then the application's own pass with [`Shadows::bind_group`]. `Shadows`
/// itself determines the filter's reach, whether the device clamps depth, how many layers it draws
/// at once, and the footprint of a pixel.
///
/// # Changes at run time
///
/// | change | by | cost |
/// |---|---|---|
/// | view, directions and positions of lights, casters, receivers, image size | [`Inputs`] | nothing |
/// | a setting of [`Rebuilds::Nothing`] | [`Shadows::set_config`] | nothing |
/// | a setting of [`Rebuilds::Maps`] | [`Shadows::set_config`] | textures and bind groups; pipelines stay valid |
/// | a setting of [`Rebuilds::Pipelines`] | [`Shadows::set_config`] | possibly pipelines: see the returned value |
/// | number or kinds of lights | [`Shadows::set_lights`] | possibly pipelines: see the returned value |
///
/// [`umbrage::config::SETTINGS`] lists the settings with the most that each rebuilds. Shadows stand
/// still through every change that does not concern the position of maps.
///
/// # Kept maps
///
/// With [`umbrage::config::Cache::Kept`] and [`Inputs::set`], the depth drawn by static casters is
/// kept from frame to frame, and [`ShadowFrame::maps`] contains only the parts to draw, which may
/// be none. Maps equal those that are drawn completely, bit for bit. All maps of a prepared frame
/// have to be drawn; otherwise call [`Shadows::forget_kept`]. Views that take turns overwrite each
/// other's kept maps: give each a `Shadows` of its own.
///
/// A sun that moves in steps ([`umbrage::SteppedSun`]) has another grid after each step, on which
/// nothing is drawn yet. To fade from step to step without a visible jump, make two `Shadows`, one
/// for either sun of [`umbrage::SunFade`], which take turns: the old sun's maps stand and cost
/// nothing while the new ones are filled within [`Inputs::kept_texels`]. Give
/// [`ShadowFrame::is_filled`] of the new ones to [`umbrage::SteppedSun::follow_filled`], and the
/// fade begins once they are filled.
///
/// # Several views
///
/// Views share the maps, one after the other: prepare, draw and submit one view before the next is
/// prepared. Give each view its own [`Inputs::view_slot`], under which the state of its stabilised
/// maps is held. Views that are drawn in one submission need a `Shadows` each.
///
/// # A lost device
///
/// If a driver is reset or updated, or an adapter is unplugged, the device and all its resources
/// are lost. [`Shadows::prepare`] returns [`Error::DeviceLost`] from then on; so does
/// [`Shadows::new`] with that device. The application requests a new adapter and a new device,
/// creates its own resources and `Shadows` again and redraws the frame, as the example
/// `hello_shadows` does. The held state of stabilised maps is lost with `Shadows`: their texels may
/// move once.
///
/// If the device is lost between `prepare` and the end of the frame, the next `prepare` reports it.
/// Commands that the frame still records have no effect. wgpu reports some of them to
/// [`wgpu::Device::on_uncaptured_error`], which should not panic then. In a browser only
/// [`wgpu::Device::set_device_lost_callback`] is called, which belongs to the application.
#[derive(Debug)]
pub struct Shadows {
    config: ShadowConfig,
    lights: Vec<LightMaps>,
    maps: ShadowMaps,
    /// Config with which each light is planned.
    planned: Vec<ShadowConfig>,
    notes: Vec<String>,
    planning: Planning,
    enabled: bool,
    draws: Draws,
    /// Bookkeeping for the kept maps, if maps are kept.
    keeper: Option<Keeper>,
    /// True if this frame's maps are copied from kept textures.
    is_kept: bool,
    occluders: Occluders,
}

impl Shadows {
    /// Shadows of one sun.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::new`].
    pub fn new(device: &wgpu::Device, config: &ShadowConfig) -> Result<Self> {
        Self::with_lights(device, config, &[LightKind::Directional])
    }

    /// Shadows of these lights, at least one: kinds ([`LightKind`]), lights ([`umbrage::Light`]) or
    /// [`LightMaps`].
    ///
    /// A choice that each light's plan makes by itself and that excludes a kind of light, such as a
    /// warp for a local light, is replaced for that light alone; [`Shadows::notes`] lists it.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::new`].
    pub fn with_lights<L: Clone + Into<LightMaps>>(
        device: &wgpu::Device,
        config: &ShadowConfig,
        lights: &[L],
    ) -> Result<Self> {
        let lights: Vec<LightMaps> = lights.iter().cloned().map(Into::into).collect();
        let maps = ShadowMaps::new(device, config, &lights)?;
        let (planned, notes) = planned_with(&maps, config, &lights);
        // Whatever the planner refuses is refused now and not in a frame.
        planned.iter().try_for_each(ShadowConfig::validate)?;
        Ok(Self {
            config: config.clone(),
            lights,
            keeper: maps.keeper(),
            is_kept: false,
            maps,
            planned,
            notes,
            planning: Planning::default(),
            enabled: true,
            draws: Draws::default(),
            occluders: Occluders::default(),
        })
    }

    /// Plans a frame and writes it to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::LightCount`] or [`Error::LightKind`] if the lights are not those for which the maps
    /// were made, [`Error::Config`] naming an invalid box or a camera that does not suit the range,
    /// [`Error::InvalidFrameOption`] for an origin that is not finite, [`Error::SetAndLists`],
    /// [`Error::FilterTooWide`], [`Error::Device`] for errors that the device reports,
    /// [`Error::DeviceLost`]. A refused frame does not change the next.
    pub fn prepare(&mut self, queue: &wgpu::Queue, inputs: &Inputs<'_>) -> Result<ShadowFrame<'_>> {
        self.check(inputs)?;
        self.draws.clear();
        self.planning.plan(&self.planned, planner_options(&self.maps), inputs)?;
        let result = self.hand_over(queue, inputs);
        // What stabilised maps hold belongs to frames that were shown with shadows.
        if result.is_err() || !inputs.enabled {
            self.planning.take_back(inputs.view_slot);
        }
        result?;
        self.occluders.recycle();
        self.enabled = inputs.enabled;
        Ok(self.frame())
    }

    /// Writes a planned frame to the GPU and lists the maps to draw.
    fn hand_over(&mut self, queue: &wgpu::Queue, inputs: &Inputs<'_>) -> Result<()> {
        let options = FrameOptions { origin: inputs.origin, enabled: inputs.enabled, tint: inputs.tint };
        // An origin that is none would be another grid, and all that is kept of no use.
        options.validate()?;
        self.is_kept = inputs.enabled && self.keep(inputs);
        let plans = self.planning.plans();
        self.maps.prepare_lights(queue, plans, &options)?;
        match &mut self.keeper {
            Some(keeper) if self.is_kept => {
                self.maps.prepare_kept(queue, &plans[0], keeper, &options)?;
                self.draws.list_kept(keeper);
                keeper.accept();
            }
            _ => self.draws.list(&self.maps, plans, inputs.enabled),
        }
        Ok(())
    }

    /// Determines the parts of kept maps to draw. Returns false if nothing is kept: casters of a
    /// list are neither marked as static nor identified from frame to frame.
    fn keep(&mut self, inputs: &Inputs<'_>) -> bool {
        let Some(keeper) = &mut self.keeper else { return false };
        let (Some(set), Some(plan)) = (inputs.set, self.planning.sole_plan()) else {
            keeper.forget_maps();
            return false;
        };
        let frame = KeptFrame {
            set,
            layers: inputs.layers,
            origin: inputs.origin,
            budget: inputs.kept_texels,
            drops_small: self.config.drop_small_casters,
            redraws: inputs.redraws_kept,
        };
        keeper.prepare(&frame, plan);
        true
    }

    /// The regions of this frame.
    fn regions(&self) -> &[KeptRegion] {
        self.keeper.as_ref().filter(|_| self.is_kept).map_or(&[], Keeper::regions)
    }

    /// Checks the inputs before anything is planned.
    fn check(&self, inputs: &Inputs<'_>) -> Result<()> {
        if inputs.lights.len() != self.lights.len() {
            return Err(Error::LightCount { plans: inputs.lights.len(), lights: self.lights.len() });
        }
        for (light, (given, maps)) in inputs.lights.iter().zip(&self.lights).enumerate() {
            maps.check(light, LightKind::from(*given))?;
        }
        Ok(())
    }

    /// The last prepared frame.
    #[must_use]
    pub fn frame(&self) -> ShadowFrame<'_> {
        ShadowFrame::new(self)
    }

    /// Converts drawn depths to the form that receivers read, for moment filters; for others it
    /// does nothing. Call it after the casters and before any receiver.
    pub fn prefilter(&self, encoder: &mut wgpu::CommandEncoder) {
        if self.enabled {
            self.maps.prefilter(encoder);
        }
    }

    /// The bind group that [`Shadows::receiver_wgsl`] declares.
    #[must_use]
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        self.maps.receiver_bind_group()
    }

    /// Layout of [`Shadows::bind_group`], for pipelines that compute visibility.
    #[must_use]
    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        self.maps.receiver_layout()
    }

    /// WGSL to put before a shader that computes visibility; `group` is the index at which
    /// [`Shadows::bind_group`] is bound.
    #[must_use]
    pub fn receiver_wgsl(&self, group: u32) -> String {
        self.maps.receiver_wgsl(group)
    }

    /// WGSL to put before a vertex shader that draws casters; `group` is the index at which
    /// [`ShadowMap::bind_group`] is bound. For the common case [`Shadows::caster_pipeline`] makes
    /// the whole pipeline.
    #[must_use]
    pub fn caster_wgsl(&self, group: u32) -> String {
        self.maps.caster_wgsl(group)
    }

    /// [`Shadows::caster_wgsl`] for vertex shaders that pass more to their fragment shaders:
    /// `members` is added to the struct that they return, for example `"@location(0) uv: vec2f,"`.
    #[must_use]
    pub fn caster_wgsl_with(&self, group: u32, members: &str) -> String {
        self.maps.caster_wgsl_with(group, members)
    }

    /// Allocator of ids for casters, for exact edges ([`umbrage::config::Edges::Exact`]). Ids stay
    /// valid through every change of config.
    pub fn occluders(&mut self) -> &mut Occluders {
        &mut self.occluders
    }

    /// The maps: the low-level API, with textures, passes and pipeline states.
    #[must_use]
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// The current config.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        &self.config
    }

    /// The lights for which maps are made.
    #[must_use]
    pub fn lights(&self) -> &[LightMaps] {
        &self.lights
    }

    /// Requests that could not be met, each with the fallback.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Changes the config. Returns what was rebuilt: after [`Rebuilds::Pipelines`] shader texts or
    /// pipeline states have changed, and pipelines with them; after [`Rebuilds::Maps`] bind groups.
    /// The result is at most that of [`ShadowConfig::rebuilds`].
    ///
    /// # Errors
    /// Those of [`ShadowMaps::new`]. Nothing has changed then.
    pub fn set_config(&mut self, config: &ShadowConfig) -> Result<Rebuilds> {
        self.change(config.clone(), self.lights.clone())
    }

    /// Changes the lights for which maps are made. Returns what was rebuilt, as
    /// [`Shadows::set_config`] does.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::new`]. Nothing has changed then.
    pub fn set_lights<L: Clone + Into<LightMaps>>(&mut self, lights: &[L]) -> Result<Rebuilds> {
        self.change(self.config.clone(), lights.iter().cloned().map(Into::into).collect())
    }

    fn change(&mut self, config: ShadowConfig, lights: Vec<LightMaps>) -> Result<Rebuilds> {
        let promised = self.config.rebuilds(&config).map_or(Rebuilds::Nothing, |(rebuilds, _)| rebuilds);
        let needs_maps = promised > Rebuilds::Nothing || lights != self.lights;
        let new = needs_maps.then(|| ShadowMaps::new(self.maps.device(), &config, &lights)).transpose()?;
        let (planned, notes) = planned_with(new.as_ref().unwrap_or(&self.maps), &config, &lights);
        planned.iter().try_for_each(ShadowConfig::validate)?;
        let rebuilt = match new {
            None => {
                self.maps.set_config(&config)?;
                if let Some(keeper) = &mut self.keeper {
                    keeper.clear();
                }
                Rebuilds::Nothing
            }
            Some(new) => {
                let keeps_pipelines = new.shares_pipelines_with(&self.maps);
                self.keeper = new.keeper();
                self.maps = new;
                if keeps_pipelines { Rebuilds::Maps } else { Rebuilds::Pipelines }
            }
        };
        self.planning.set_configs(&planned, planner_options(&self.maps))?;
        self.is_kept = false;
        (self.config, self.lights, self.planned, self.notes) = (config, lights, planned, notes);
        self.draws.clear();
        Ok(rebuilt)
    }

    /// Forgets the held state of stabilised maps, as if nothing had been drawn yet: for views that
    /// do not follow each other.
    pub fn restart(&mut self) {
        self.planning.restart();
        self.forget_kept();
    }

    /// [`Shadows::restart`] for one view, [`Inputs::view_slot`], as after a cut. Other views and
    /// kept maps are unchanged.
    pub fn restart_view(&mut self, view_slot: u32) {
        self.planning.restart_view(view_slot);
    }

    /// Forgets kept maps, for an application that has prepared a frame and not drawn all of its
    /// maps. The held state of stabilised maps is unchanged.
    pub fn forget_kept(&mut self) {
        if let Some(keeper) = &mut self.keeper {
            keeper.clear();
        }
        self.draws.clear();
        self.is_kept = false;
    }

    /// Gives the held state of view `from` to view `to`, and forgets `from`.
    pub fn move_view(&mut self, from: u32, to: u32) {
        self.planning.move_view(from, to);
    }

    /// Returns whether any state is held for a view.
    #[must_use]
    pub fn holds_view(&self, view_slot: u32) -> bool {
        self.planning.holds_view(view_slot)
    }
}

/// Config with which each light is planned, and notes on the replaced choices.
fn planned_with(maps: &ShadowMaps, config: &ShadowConfig, lights: &[LightMaps]) -> (Vec<ShadowConfig>, Vec<String>) {
    let (mut planned, mut notes) = (Vec::new(), maps.notes().to_vec());
    for (light, slot) in lights.iter().enumerate() {
        let (own, of_sizes) = config.with_map_sizes(maps.map_sizes(light));
        let (own, of_kind) = own.for_light(slot.kind);
        notes.extend(of_sizes.into_iter().chain(of_kind));
        planned.push(own);
    }
    (planned, notes)
}

/// Options of planners beside a config. The image size is given per frame.
fn planner_options(maps: &ShadowMaps) -> PlannerOptions {
    PlannerOptions { depth_clamp: maps.depth_clamp(), ..PlannerOptions::default() }
}
