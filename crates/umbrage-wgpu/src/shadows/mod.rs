//! The main API: from a view, lights and boxes to maps that are drawn and sampled.

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
/// [`Shadows::prefilter`], then the application's own pass with [`Shadows::bind_group`]. What the
/// filter reaches, whether the device clamps depth, how many layers it draws at once and what a
/// pixel covers is worked out here.
///
/// # Changes while it runs
///
/// | change | by | what it costs |
/// |---|---|---|
/// | view, directions and positions of lights, casters, receivers, picture size | [`Inputs`] | nothing |
/// | a setting of [`Rebuilds::Nothing`] | [`Shadows::set_config`] | nothing |
/// | a setting of [`Rebuilds::Maps`] | [`Shadows::set_config`] | textures and bind groups; pipelines stay valid |
/// | a setting of [`Rebuilds::Pipelines`] | [`Shadows::set_config`] | possibly pipelines: see the returned value |
/// | number or kinds of lights | [`Shadows::set_lights`] | possibly pipelines: see the returned value |
///
/// [`umbrage::config::SETTINGS`] lists the settings with what they rebuild at most. Shadows stand
/// still through every change that has nothing to do with where maps lie.
///
/// # What is kept
///
/// With [`umbrage::config::Cache::Kept`] and [`Inputs::set`], what static casters have drawn is
/// kept from frame to frame, and [`ShadowFrame::maps`] has what is to be drawn beside it: maybe
/// nothing. Maps are those that are drawn anew, bit for bit. All maps of a frame that was prepared
/// have to be drawn, or [`Shadows::forget_kept`] has to be told. Views that take turns draw over
/// what is kept of each other: give each a `Shadows` of its own.
///
/// # Several views
///
/// Views share the maps, one after the other: prepare, draw and submit one view before the next is
/// prepared. Give each its own [`Inputs::view_slot`], under which its stabilised maps are held.
/// Views that are drawn in one submission take a `Shadows` each.
///
/// # A lost device
///
/// If a driver is reset or updated, or an adapter is unplugged, the device and all its resources
/// are lost. [`Shadows::prepare`] returns [`Error::DeviceLost`] from then on; so does
/// [`Shadows::new`] with that device. The application requests a new adapter and a new device,
/// creates its own resources and `Shadows` again and redraws the frame, as the example
/// `hello_shadows` does. What stabilised maps hold is lost with `Shadows`: their texels may move
/// once.
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
    /// What each light is planned with.
    planned: Vec<ShadowConfig>,
    notes: Vec<String>,
    planning: Planning,
    enabled: bool,
    draws: Draws,
    /// Books of what is kept of the maps, where anything is.
    keeper: Option<Keeper>,
    /// Whether this frame's maps come from what is kept.
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

    /// Shadows of these lights, one at least: kinds ([`LightKind`]), lights ([`umbrage::Light`]) or
    /// [`LightMaps`].
    ///
    /// A choice that a plan makes by itself and that excludes a kind of light, such as a warp for a
    /// lamp, is replaced for that light alone; [`Shadows::notes`] lists it.
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

    /// Plans a frame and hands it to the GPU. Takes effect with the next submission to `queue`.
    ///
    /// # Errors
    /// [`Error::LightCount`] or [`Error::LightKind`] if the lights are not those that the maps were
    /// made for, [`Error::Config`] naming a box that is no box or a camera that the range does not
    /// go with, [`Error::InvalidFrameOption`] for an origin that is not finite,
    /// [`Error::SetAndLists`], [`Error::FilterTooWide`], [`Error::Device`] for what the device
    /// complains about, [`Error::DeviceLost`]. A refused frame does not change the next.
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

    /// Hands a frame over that was planned and lists what is drawn.
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

    /// Works out what has to be drawn into what is kept. False if nothing is: casters of a list say
    /// neither what is static nor which is which.
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

    /// Whatever can be wrong before anything is planned.
    fn check(&self, inputs: &Inputs<'_>) -> Result<()> {
        if inputs.lights.len() != self.lights.len() {
            return Err(Error::LightCount { plans: inputs.lights.len(), lights: self.lights.len() });
        }
        for (light, (given, maps)) in inputs.lights.iter().zip(&self.lights).enumerate() {
            maps.check(light, LightKind::from(*given))?;
        }
        Ok(())
    }

    /// The last frame that was prepared.
    #[must_use]
    pub fn frame(&self) -> ShadowFrame<'_> {
        ShadowFrame::new(self)
    }

    /// Turns drawn depths into what receivers read, for moment filters; for others it does
    /// nothing. Call it after the casters and before any receiver.
    pub fn prefilter(&self, encoder: &mut wgpu::CommandEncoder) {
        if self.enabled {
            self.maps.prefilter(encoder);
        }
    }

    /// The group that [`Shadows::receiver_wgsl`] declares.
    #[must_use]
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        self.maps.receiver_bind_group()
    }

    /// Layout of [`Shadows::bind_group`], for pipelines that ask for visibility.
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
    /// [`ShadowMap::bind_group`] is bound. [`Shadows::caster_pipeline`] does the rest for the
    /// common case.
    #[must_use]
    pub fn caster_wgsl(&self, group: u32) -> String {
        self.maps.caster_wgsl(group)
    }

    /// [`Shadows::caster_wgsl`] for vertex shaders that hand more to their fragments: `members`
    /// joins the struct that they return, for example `"@location(0) uv: vec2f,"`.
    #[must_use]
    pub fn caster_wgsl_with(&self, group: u32, members: &str) -> String {
        self.maps.caster_wgsl_with(group, members)
    }

    /// Ids for casters, for exact edges ([`umbrage::config::Edges::Exact`]). They stay through
    /// every change of config.
    pub fn occluders(&mut self) -> &mut Occluders {
        &mut self.occluders
    }

    /// The maps: the low-level API, with textures, passes and pipeline states.
    #[must_use]
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// The config that is carried out.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        &self.config
    }

    /// The lights that maps are made for.
    #[must_use]
    pub fn lights(&self) -> &[LightMaps] {
        &self.lights
    }

    /// What was asked for and could not be had, with what is done instead.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Changes the config. Returns what was rebuilt: after [`Rebuilds::Pipelines`] shader texts or
    /// pipeline states have changed, and pipelines with them; after [`Rebuilds::Maps`] bind groups.
    /// The answer is at most what [`ShadowConfig::rebuilds`] promises.
    ///
    /// # Errors
    /// Those of [`ShadowMaps::new`]. Nothing has changed then.
    pub fn set_config(&mut self, config: &ShadowConfig) -> Result<Rebuilds> {
        self.change(config.clone(), self.lights.clone())
    }

    /// Changes the lights that maps are made for. Returns what was rebuilt, as
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

    /// Forgets what stabilised maps hold on to, as if nothing had been drawn yet: for views that do
    /// not follow each other.
    pub fn restart(&mut self) {
        self.planning.restart();
        self.forget_kept();
    }

    /// [`Shadows::restart`] for one view, [`Inputs::view_slot`]: after a cut. Other views, and what
    /// is kept of maps, stay as they are.
    pub fn restart_view(&mut self, view_slot: u32) {
        self.planning.restart_view(view_slot);
    }

    /// Forgets what is kept of maps, for an application that has prepared a frame and not drawn all
    /// of its maps. What stabilised maps hold on to stays.
    pub fn forget_kept(&mut self) {
        if let Some(keeper) = &mut self.keeper {
            keeper.clear();
        }
        self.draws.clear();
        self.is_kept = false;
    }

    /// Lets view `to` go on from what view `from` holds, and forgets `from`.
    pub fn move_view(&mut self, from: u32, to: u32) {
        self.planning.move_view(from, to);
    }

    /// Whether anything is held for a view.
    #[must_use]
    pub fn holds_view(&self, view_slot: u32) -> bool {
        self.planning.holds_view(view_slot)
    }
}

/// What each light is planned with, and notes on what was replaced.
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

/// The options of planners beside a config. The picture's size is given per frame.
fn planner_options(maps: &ShadowMaps) -> PlannerOptions {
    PlannerOptions { depth_clamp: maps.depth_clamp(), ..PlannerOptions::default() }
}
