//! What is kept of each light, and how its plans are made.

use bevy_ecs::change_detection::{DetectChangesMut as _, Mut};
use bevy_ecs::entity::{Entity, EntityHashMap};
use bevy_light::cascade::Cascade;
use bevy_light::{CascadeShadowConfig, Cascades, ShadowFilteringMethod};
use umbrage::config::{Range, SplitScheme};
use umbrage::{DirectionalLight, FilterReach, Layers, PlanInputs, Planner, PlannerOptions, ShadowConfig, ShadowPlan};

use crate::boxes::MeshBoxes;
use crate::camera::PlannerView;
use crate::cascade::{MOST_STRETCH, ReceiverOffset, cascade};
use crate::config::{Ignored, for_bevy};
use crate::{Error, shared};

/// Texels that a map which is widened may be moved by, to stand on whole ones.
const SNAP: f64 = 1.0;

/// Share of itself by which Bevy's blend band is narrower than the plan's, for rounding to `f32`.
const BAND_ROOM: f64 = 1e-3;

/// The widest band that Bevy takes as a share of a cascade's far bound.
const MOST_OVERLAP: f64 = 0.99;

/// A camera that a light is planned for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub camera: Entity,
    pub seen: PlannerView,
    pub layers: Layers,
    pub method: ShadowFilteringMethod,
}

/// What all plans of a light in one frame share.
#[derive(Clone, Copy)]
pub(crate) struct LightFrame<'a> {
    pub sun: DirectionalLight,
    pub offset: ReceiverOffset,
    pub layers: Layers,
    pub boxes: &'a MeshBoxes,
}

/// What is kept of a light.
#[derive(Debug, Default)]
pub(crate) struct LightState {
    /// As the application gave it.
    pub own: CascadeShadowConfig,
    /// As it was last written over that.
    pub written: CascadeShadowConfig,
    /// Whether this frame's cascades are planned, and the config is the one that was written.
    pub is_planned: bool,
    pub told: Option<Error>,
    asked: Option<(ShadowConfig, u32)>,
    taken: Option<Result<ShadowConfig, Error>>,
    /// Settings that were given and have no effect, until they are logged.
    pub ignored: Vec<Ignored>,
    pub views: EntityHashMap<ViewState>,
    planes: Vec<f64>,
    made: Vec<Cascade>,
    next: CascadeShadowConfig,
}

/// What is kept of a camera for a light.
#[derive(Debug)]
pub(crate) struct ViewState {
    /// Plans for this camera alone.
    planner: Planner,
    /// Plans with planes that several cameras share, by a config that is changed in place.
    shared: Option<(Planner, ShadowConfig)>,
    pub plan: ShadowPlan,
    standoff: f64,
    is_live: bool,
}

impl LightState {
    /// Translates a config for Bevy, once.
    fn translate(&mut self, asked: &ShadowConfig, map_size: u32) {
        let is_known = self.asked.as_ref().is_some_and(|(known, size)| known == asked && *size == map_size);
        if is_known {
            return;
        }
        self.asked = Some((asked.clone(), map_size));
        self.views.values_mut().for_each(|view| view.shared = None);
        self.taken = Some(for_bevy(asked, map_size).map(|(config, ignored)| {
            self.ignored = ignored;
            config
        }));
    }

    /// Plans the light for these cameras.
    ///
    /// # Errors
    /// The first that a planner returns. Nothing has been written to Bevy's components then.
    pub fn plan(
        &mut self,
        (asked, map_size): (&ShadowConfig, u32),
        frame: &LightFrame<'_>,
        eyes: &[Eye],
    ) -> Result<(), Error> {
        self.translate(asked, map_size);
        let Self { taken, views, planes, .. } = self;
        let config = match taken {
            Some(Ok(config)) => &*config,
            Some(Err(refusal)) => return Err(refusal.clone()),
            None => asked,
        };
        views.values_mut().for_each(|view| view.is_live = false);
        for eye in eyes {
            let options = options(eye.method, frame.offset);
            if !views.contains_key(&eye.camera) {
                views.insert(eye.camera, ViewState::new(config, options)?);
            }
            let Some(view) = views.get_mut(&eye.camera) else { continue };
            view.is_live = true;
            view.standoff = eye.seen.standoff;
            configure(&mut view.planner, config, options)?;
            plan_into(&mut view.planner, frame, eye, &mut view.plan)?;
        }
        views.retain(|_, view| view.is_live);
        if views.len() < 2 {
            views.values_mut().for_each(|view| view.shared = None);
            return Ok(());
        }
        // Bevy keeps one list of bounds for all cameras.
        let own = views.values().map(|view| (&view.plan.planes[..], view.standoff));
        shared::planes(own, planes);
        for eye in eyes {
            if let Some(view) = views.get_mut(&eye.camera) {
                view.plan_shared((config, planes), frame, eye)?;
            }
        }
        Ok(())
    }

    /// Writes the plans over Bevy's cascades.
    pub fn write(&mut self, offset: ReceiverOffset, config: &mut Mut<CascadeShadowConfig>, cascades: &mut Cascades) {
        for (&camera, view) in &self.views {
            self.made.clear();
            self.made.extend(view.plan.splits.iter().map(|split| cascade(split, offset)));
            cascades.cascades.entry(camera).or_default().clone_from(&self.made);
        }
        bounds(&self.views, &mut self.next);
        // The application hears of changes only.
        let is_news = !equal(&self.next, &self.written);
        copy(&self.next, config.bypass_change_detection());
        if is_news {
            config.set_changed();
            copy(&self.next, &mut self.written);
        }
        self.is_planned = true;
    }
}

impl ViewState {
    fn new(config: &ShadowConfig, options: PlannerOptions) -> Result<Self, Error> {
        Ok(Self {
            planner: Planner::with_options(config, options)?,
            shared: None,
            plan: ShadowPlan::default(),
            standoff: 0.0,
            is_live: true,
        })
    }

    /// Plans again with shared planes, which are view depths of Bevy's.
    fn plan_shared(
        &mut self,
        (config, shared): (&ShadowConfig, &[f64]),
        frame: &LightFrame<'_>,
        eye: &Eye,
    ) -> Result<(), Error> {
        let (options, standoff, m) = (options(eye.method, frame.offset), self.standoff, config.splits());
        let (planner, config) = match &mut self.shared {
            Some(known) => known,
            none => none.insert((Planner::with_options(config, options)?, config.clone())),
        };
        if !matches!(config.scheme, SplitScheme::Manual { .. }) {
            config.scheme = SplitScheme::Manual { planes: Vec::new() };
        }
        let far = shared[m] + standoff;
        let mut near = self.plan.planes[0].min(0.5 * far);
        if let SplitScheme::Manual { planes } = &mut config.scheme {
            planes.clear();
            planes.extend(shared[1..m].iter().map(|plane| plane + standoff));
            // The first slice begins before the first plane, whatever this camera sees.
            near = planes.first().map_or(near, |&first| near.min(0.5 * first));
        }
        config.range = Range::Metres { near, far };
        configure(planner, config, options)?;
        plan_into(planner, frame, eye, &mut self.plan)
    }
}

/// Copies a config into another one's memory.
pub(crate) fn copy(from: &CascadeShadowConfig, to: &mut CascadeShadowConfig) {
    to.bounds.clone_from(&from.bounds);
    to.overlap_proportion = from.overlap_proportion;
    to.minimum_distance = from.minimum_distance;
}

/// Whether two configs are one and the same.
pub(crate) fn equal(one: &CascadeShadowConfig, other: &CascadeShadowConfig) -> bool {
    one.bounds == other.bounds
        && one.overlap_proportion == other.overlap_proportion
        && one.minimum_distance == other.minimum_distance
}

/// What Bevy's config has to say for the plans of all cameras: far bounds, which they share, and
/// the widest band that lies within the band of every plan.
fn bounds(views: &EntityHashMap<ViewState>, config: &mut CascadeShadowConfig) {
    config.bounds.clear();
    let mut overlap = MOST_OVERLAP;
    for ViewState { plan, standoff, .. } in views.values() {
        if config.bounds.is_empty() {
            config.bounds.extend(plan.planes[1..].iter().map(|plane| (plane - standoff) as f32));
            config.minimum_distance = (plan.planes[0] - standoff) as f32;
        }
        for split in plan.splits.iter().take(plan.splits.len().saturating_sub(1)) {
            let far = (split.far - standoff).max(f64::MIN_POSITIVE);
            overlap = overlap.min((split.far - split.blend_begin) / far * (1.0 - BAND_ROOM));
        }
    }
    config.overlap_proportion = if config.bounds.len() > 1 { overlap.max(0.0) as f32 } else { 0.0 };
}

fn options(method: ShadowFilteringMethod, offset: ReceiverOffset) -> PlannerOptions {
    // Texels that the filter reads from the sample: `sample_shadow_map` in Bevy's
    // shadow_sampling.wgsl. The radius of the temporal one is 0.011 m + 1.05 texels.
    let filter = match method {
        ShadowFilteringMethod::Hardware2x2 => 1.0,
        ShadowFilteringMethod::Gaussian => 3.0,
        ShadowFilteringMethod::Temporal => 8.0,
    };
    let radius_texels = (filter + offset.normal_texels * MOST_STRETCH + SNAP).min(64.0);
    let filter_reach = Some(FilterReach { radius_texels, radius_m: None });
    // Bevy's shadow pass does not clip depth, by hardware or by its shader.
    PlannerOptions { depth_clamp: true, filter_reach, ..PlannerOptions::default() }
}

fn configure(planner: &mut Planner, config: &ShadowConfig, options: PlannerOptions) -> Result<(), Error> {
    if planner.config() != config || planner.options() != options {
        planner.set_config(config, options)?;
    }
    Ok(())
}

fn plan_into(planner: &mut Planner, frame: &LightFrame<'_>, eye: &Eye, plan: &mut ShadowPlan) -> Result<(), Error> {
    let set = frame.boxes.set();
    let inputs = PlanInputs {
        // What the light's maps show and what the camera does are two questions to Bevy, and one to
        // the planner: more is planned for than need be, and Bevy's own lists leave it out.
        layers: frame.layers | eye.layers,
        image_size: eye.seen.image_size,
        ..PlanInputs::new(&eye.seen.view, frame.sun, set, set)
    };
    let refused = |reason| Error::Camera { camera: eye.camera, reason };
    planner.plan_into(&inputs, plan).map_err(refused)
}
