//! The planner: from a view, a light and bounds to a [`ShadowPlan`].
//!
//! [`plan`] is the core: values in, values out, with the state that is held between frames as a
//! value of its own. A sun's plan is made in the stages of [`directional`], a local light's in
//! those of [`local`].

mod block;
mod casters;
mod covered;
mod depth;
mod directional;
mod fit;
mod frame;
mod goals;
mod in_view;
mod inputs;
mod kept;
mod layout;
mod local;
mod options;
mod picked;
mod range;
mod scope;
mod shaft;
mod slice_ends;
mod snap;
mod warped;

use crate::casters::{Counter, Crowd, OrderedList, Role, Visited};
use crate::geometry::light_frustum::LightFrustum;
use crate::held::Held;
use crate::{Light, Result, ShadowConfig, ShadowPlan, View};
use directional::SunBuffers;
pub(crate) use directional::is_small;
use frame::Frame;
pub use inputs::{Boxes, PlanInputs};
use kept::Kept;
use local::LocalBuffers;
pub use options::PlannerOptions;

/// Plans shadow maps frame after frame.
///
/// Contains the config, the state held between frames ([`Held`]) and buffers, so that only the
/// first frame allocates. Use one planner for each light of each view.
#[derive(Clone, Debug)]
pub struct Planner {
    config: ShadowConfig,
    options: PlannerOptions,
    held: Held,
    buffers: Buffers,
    plan: ShadowPlan,
    /// True if the buffers have the state held before the last frame.
    can_take_back: bool,
}

/// Buffers that are reused from call to call. No plan depends on them.
#[derive(Clone, Debug, Default)]
struct Buffers {
    /// Casters that are given as a list.
    casters: OrderedList,
    receivers: OrderedList,
    /// Boxes that an earlier image showed.
    seen: OrderedList,
    /// Counts of the boxes that the last plan visited.
    visited: Visited,
    kept: Kept,
    sun: SunBuffers,
    local: LocalBuffers,
    /// State held before the last frame that was not refused.
    held: Held,
}

impl Planner {
    /// A planner for a config, with the default options.
    ///
    /// # Errors
    /// Those of [`Planner::with_options`].
    pub fn new(config: &ShadowConfig) -> Result<Self> {
        Self::with_options(config, PlannerOptions::default())
    }

    /// A planner for a config and options.
    ///
    /// # Errors
    /// Those of [`ShadowConfig::validate`]; [`crate::Error::InvalidSetting`] naming a field of the
    /// options that is wrong, or `map-size` for maps that are too small for the options' filter.
    pub fn with_options(config: &ShadowConfig, options: PlannerOptions) -> Result<Self> {
        options.check(config)?;
        let (config, held, buffers) = (config.clone(), Held::default(), Buffers::default());
        Ok(Self { config, options, held, buffers, plan: ShadowPlan::default(), can_take_back: false })
    }

    /// Uses another config and other options from the next frame on. The held state is kept if
    /// plans do not depend on the changes, and dropped otherwise.
    ///
    /// # Errors
    /// Those of [`Planner::with_options`]. Nothing has changed then.
    pub fn set_config(&mut self, config: &ShadowConfig, options: PlannerOptions) -> Result<()> {
        options.check(config)?;
        let reaches = [options.reach(config), self.options.reach(&self.config)];
        let is_alike = options.depth_clamp == self.options.depth_clamp
            && reaches[0] == reaches[1]
            && config.plans_like(&self.config);
        if !is_alike {
            self.held = Held::default();
        }
        self.can_take_back = false;
        self.buffers.kept.clear();
        (self.config, self.options) = (config.clone(), options);
        Ok(())
    }

    /// The config by which maps are planned.
    #[must_use]
    pub fn config(&self) -> &ShadowConfig {
        &self.config
    }

    /// The options given beside the config.
    #[must_use]
    pub fn options(&self) -> PlannerOptions {
        self.options
    }

    /// State that is held between frames.
    #[must_use]
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// Number of casters and receivers that the last plan visited: a measure of its cost that does
    /// not depend on the machine. All zero if view, light, sets and held state equal those of the
    /// last plan, which is then returned again.
    #[must_use]
    pub fn visited(&self) -> Visited {
        self.buffers.visited
    }

    /// Replaces the state that is held between frames: to continue from another frame than the last
    /// one, or from nothing.
    pub fn set_held(&mut self, held: Held) {
        self.held = held;
        self.can_take_back = false;
    }

    /// Takes the last frame back, which is not shown: what is held is what it was before. Does
    /// nothing if that frame was refused, or taken back already.
    pub fn take_back(&mut self) {
        if std::mem::take(&mut self.can_take_back) {
            std::mem::swap(&mut self.held, &mut self.buffers.held);
        }
    }

    /// Plans the maps of one frame for one light and an image of [`PlannerOptions::image_size`];
    /// see [`Planner::plan_frame`].
    ///
    /// # Errors
    /// As [`Planner::plan_into`].
    pub fn plan<'a>(
        &mut self,
        view: &'a View,
        light: &(impl Copy + Into<Light>),
        casters: impl Into<Boxes<'a>>,
        receivers: impl Into<Boxes<'a>>,
    ) -> Result<&ShadowPlan> {
        let inputs =
            PlanInputs { image_size: self.options.image_size, ..PlanInputs::new(view, *light, casters, receivers) };
        self.plan_frame(&inputs)
    }

    /// Plans the maps of one frame for one light and keeps the plan until the next one.
    ///
    /// # Errors
    /// As [`Planner::plan_into`].
    pub fn plan_frame(&mut self, inputs: &PlanInputs<'_>) -> Result<&ShadowPlan> {
        let mut kept = std::mem::take(&mut self.plan);
        let result = self.plan_into(inputs, &mut kept);
        self.plan = kept;
        result.map(|()| &self.plan)
    }

    /// Plans the maps of one frame for one light into a plan of the caller's, whose buffers are
    /// reused.
    ///
    /// A point light's plan has six times as many splits as the config: those of its first face,
    /// then those of the next ([`Light::FACE_AXES`]). Splits that the light does not reach have no
    /// casters.
    ///
    /// A local light's default range is narrowed to the part of the view that the light reaches.
    /// Its stabilised maps lie on whole texels, of a size that changes in steps: between two steps
    /// a shadow's texels stay in place.
    ///
    /// # Errors
    /// [`crate::Error::InvalidBounds`] naming a box that is inverted or not finite;
    /// [`crate::Error::InvalidSetting`] if the range or the planes do not fit this camera;
    /// [`crate::Error::Conflict`] for a choice that a local light's plan cannot make, such as a
    /// warp; [`crate::Error::CameraConflict`] for splits by distance with an orthographic camera.
    /// The held state is then unchanged, and the plan is of no use.
    pub fn plan_into(&mut self, inputs: &PlanInputs<'_>, plan: &mut ShadowPlan) -> Result<()> {
        self.can_take_back = false;
        plan_with((&self.config, &self.options), inputs, &mut self.held, &mut self.buffers, plan)?;
        self.can_take_back = true;
        Ok(())
    }
}

/// Plans one frame as a function of the config, the options, the inputs and the state held from the
/// frames before. The image size is that of the inputs.
///
/// # Errors
/// As [`Planner::plan_into`], and as [`Planner::with_options`] for config and options.
pub fn plan(
    config: &ShadowConfig,
    options: PlannerOptions,
    inputs: &PlanInputs<'_>,
    held: &mut Held,
) -> Result<ShadowPlan> {
    options.check(config)?;
    let mut plan = ShadowPlan::default();
    plan_with((config, &options), inputs, held, &mut Buffers::default(), &mut plan)?;
    Ok(plan)
}

/// Plans one frame by a checked config, with reused buffers.
fn plan_with(
    technique: (&ShadowConfig, &PlannerOptions),
    inputs: &PlanInputs<'_>,
    held: &mut Held,
    buffers: &mut Buffers,
    plan: &mut ShadowPlan,
) -> Result<()> {
    inputs.check()?;
    let known = kept::Inputs::of(inputs);
    if buffers.kept.serve(known.as_ref(), (held, &mut buffers.held), plan) {
        buffers.visited = Visited::default();
        return Ok(());
    }
    inputs.casters.place("casters", &mut buffers.casters)?;
    let is_one = inputs.casters.is_same_list(&inputs.receivers);
    if !is_one {
        inputs.receivers.place("receivers", &mut buffers.receivers)?;
    }
    buffers.seen.fill_as_given(inputs.seen.unwrap_or_default());
    plan.begin(inputs.view, inputs.light);
    plan.split_range.resize(inputs.casters.listed(), None);
    // A frame that is refused leaves what is held as it was.
    let Buffers { casters, receivers, seen, visited, kept, sun, local, held: next } = buffers;
    let (eye, counter) = (inputs.view.eye(), Counter::default());
    let trees = (&*casters, &*receivers);
    let casters = inputs.casters.crowd(trees.0, (inputs.layers, Role::Caster), eye, &counter);
    let receivers = if is_one { trees.0 } else { trees.1 };
    let receivers = inputs.receivers.crowd(receivers, (inputs.layers, Role::Receiver), eye, &counter);
    let shows = |crowd: &Crowd<'_>| frame::shows_any(inputs.view, crowd);
    let are_replaced = receivers.is_empty() || (!shows(&receivers) && shows(&casters));
    let receivers = if are_replaced { casters } else { receivers };
    let seen = inputs.seen.map(|_| Crowd::of_list(&*seen, eye, &counter));
    next.clone_from(held);
    let frame = Frame::new(technique, inputs, (casters, receivers, seen));
    match &inputs.light {
        Light::Directional(light) => directional::plan(&frame, light, next, sun, plan)?,
        Light::Spot(spot) => {
            let at = (&inputs.light, spot.position());
            local::plan(&frame, at, &[LightFrustum::of_spot(spot)], next, local, plan)?;
        }
        Light::Point(point) => {
            let frusta = Light::FACE_AXES.map(|axis| LightFrustum::of_face(point, axis));
            local::plan(&frame, (&inputs.light, point.position()), &frusta, next, local, plan)?;
        }
    }
    if let Some(clusters) = inputs.receiver_clusters {
        plan.coverage.mask(clusters);
    }
    *visited = counter.get();
    kept.keep(known, held, next, plan);
    std::mem::swap(held, next);
    Ok(())
}
