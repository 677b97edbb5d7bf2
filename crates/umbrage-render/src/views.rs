//! Several views of one scene, side by side.

use std::sync::Arc;

use umbrage::{Held, PlanInputs, Planner, ShadowPlan, ShadowSettings, SunFade};

use crate::{Frame, Outputs, Rendered, Renderer, Result};

/// What plans one view's maps.
pub(crate) struct Planners {
    /// One for each light.
    pub now: Vec<LightPlanner>,
    /// While a step of the sun is faded: what plans for the sun that is faded to.
    pub next: Option<Vec<LightPlanner>>,
}

/// What plans one light's maps.
pub(crate) struct LightPlanner {
    pub planner: Planner,
    /// The last plan. Its buffers serve the next one once nobody else holds it.
    plan: Arc<ShadowPlan>,
}

impl LightPlanner {
    fn new(settings: &ShadowSettings) -> Result<Self> {
        Ok(Self { planner: Planner::new(settings.clone())?, plan: Arc::default() })
    }

    /// Plans a frame.
    pub fn plan(&mut self, inputs: &PlanInputs<'_>) -> Result<Arc<ShadowPlan>> {
        if Arc::get_mut(&mut self.plan).is_none() {
            self.plan = Arc::default();
        }
        if let Some(plan) = Arc::get_mut(&mut self.plan) {
            self.planner.plan_into(inputs, plan)?;
        }
        Ok(Arc::clone(&self.plan))
    }
}

impl Planners {
    /// One for each light.
    pub fn new(settings: &ShadowSettings, lights: usize) -> Result<Self> {
        let now = (0..lights).map(|_| LightPlanner::new(settings)).collect::<Result<_>>()?;
        Ok(Self { now, next: None })
    }

    /// Others of the same settings, which remember nothing.
    pub fn afresh(&self) -> Result<Self> {
        Self::new(self.now[0].planner.settings(), self.now.len())
    }
}

impl Renderer {
    /// Draws several views, for a split screen: each as if it were drawn alone, under the suns of `fade` if there is one. The maps are
    /// one view's after the other's; what stabilisation holds is kept for each, so a view keeps its place in the list from frame to
    /// frame.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_views(
        &mut self,
        frames: &[Frame<'_>],
        fade: Option<&SunFade>,
        outputs: Outputs,
    ) -> Result<Vec<Rendered>> {
        let mut views = Vec::with_capacity(frames.len());
        for (view, frame) in frames.iter().enumerate() {
            if view > self.more_views.len() {
                self.more_views.push(self.planners.afresh()?);
            }
            self.swap_planners(view);
            let rendered = match fade {
                Some(fade) => self.render_faded(frame, fade, outputs),
                None => self.render(frame, outputs),
            };
            self.swap_planners(view);
            views.push(rendered?);
        }
        Ok(views)
    }

    /// Brings a further view's planners to the fore, or back.
    fn swap_planners(&mut self, view: usize) {
        if let Some(other) = view.checked_sub(1) {
            std::mem::swap(&mut self.planners, &mut self.more_views[other]);
        }
    }

    /// What maps hold on to belongs to the frames that show them: one without shadows leaves it as it was.
    pub(crate) fn held_apart<T>(&mut self, frame: &Frame<'_>, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let kept: Vec<Held> = match frame.shadows_on {
            true => Vec::new(),
            false => self.planners.now.iter().map(|light| light.planner.held().clone()).collect(),
        };
        let result = work(self);
        for (light, held) in self.planners.now.iter_mut().zip(kept) {
            light.planner.set_held(held);
        }
        result
    }
}
