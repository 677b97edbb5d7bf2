//! Planners of each view and light: the part of a frame that needs no GPU.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use umbrage::{PlanInputs, Planner, PlannerOptions, ShadowConfig, ShadowPlan};

use super::Inputs;
use crate::Result;

/// Planners, and the plans of the last frame. After the first frames nothing is allocated.
#[derive(Debug, Default)]
pub(super) struct Planning {
    /// Planners of each view's maps, one for each light.
    views: BTreeMap<u32, Vec<Planner>>,
    /// The last frame's plans, one for each light. Their buffers serve the next frame once nobody
    /// else holds them.
    plans: Vec<Arc<ShadowPlan>>,
}

impl Planning {
    /// The last frame's plans, one for each light.
    pub fn plans(&self) -> &[Arc<ShadowPlan>] {
        &self.plans
    }

    /// The last frame's plan of a sole light, where nobody else holds it.
    pub fn sole_plan(&mut self) -> Option<&mut ShadowPlan> {
        match &mut self.plans[..] {
            [plan] => Arc::get_mut(plan),
            _ => None,
        }
    }

    /// Plans a frame: each light by its config. A refused frame leaves what is held as it was.
    pub fn plan(&mut self, configs: &[ShadowConfig], options: PlannerOptions, inputs: &Inputs<'_>) -> Result<()> {
        let [casters, receivers] = inputs.boxes()?;
        let planners = match self.views.entry(inputs.view_slot) {
            Entry::Occupied(there) => there.into_mut(),
            Entry::Vacant(place) => {
                let fresh = configs.iter().map(|config| Planner::with_options(config, options));
                place.insert(fresh.collect::<Result<_, _>>()?)
            }
        };
        self.plans.resize_with(planners.len(), Arc::default);
        for (light, &given) in inputs.lights.iter().enumerate().take(planners.len()) {
            let of_light = PlanInputs {
                receiver_clusters: inputs.receiver_clusters,
                seen: inputs.seen,
                layers: inputs.layers,
                image_size: inputs.image_size,
                ..PlanInputs::new(inputs.view, given, casters, receivers)
            };
            let plan = &mut self.plans[light];
            if Arc::get_mut(plan).is_none() {
                *plan = Arc::default();
            }
            let Some(plan) = Arc::get_mut(plan) else { continue };
            if let Err(error) = planners[light].plan_into(&of_light, plan) {
                planners[..light].iter_mut().for_each(Planner::take_back);
                return Err(error.into());
            }
        }
        Ok(())
    }

    /// Takes back a planned frame that is not shown: its view holds again what it held before.
    pub fn take_back(&mut self, view_slot: u32) {
        self.views.get_mut(&view_slot).into_iter().flatten().for_each(Planner::take_back);
    }

    /// Plans by other configs from the next frame on, one for each light.
    pub fn set_configs(&mut self, configs: &[ShadowConfig], options: PlannerOptions) -> Result<()> {
        for planners in self.views.values_mut() {
            planners.truncate(configs.len());
            for (light, config) in configs.iter().enumerate() {
                match planners.get_mut(light) {
                    Some(planner) => planner.set_config(config, options)?,
                    None => planners.push(Planner::with_options(config, options)?),
                }
            }
        }
        self.plans.clear();
        Ok(())
    }

    /// Forgets the held state of all views.
    pub fn restart(&mut self) {
        self.views.clear();
        self.plans.clear();
    }

    /// Forgets the held state of a view.
    pub fn restart_view(&mut self, view_slot: u32) {
        self.views.remove(&view_slot);
    }

    /// Gives the held state of view `from` to view `to`, and forgets `from`.
    pub fn move_view(&mut self, from: u32, to: u32) {
        if let Some(planners) = self.views.remove(&from) {
            self.views.insert(to, planners);
        }
    }

    /// Returns whether any state is held for a view.
    pub fn holds_view(&self, view_slot: u32) -> bool {
        self.views.contains_key(&view_slot)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::config::{LightKind, Preset};
    use umbrage::{Aabb, CasterSet, DirectionalLight, Frustum, Light, PointLight, View};

    use super::*;
    use crate::Error;

    fn boxes() -> Vec<Aabb> {
        let house = |i: i32| {
            let at = DVec3::new(f64::from(i * 37 % 200) - 100.0, 0.0, f64::from(i * 61 % 200) - 100.0);
            Aabb::new(at, at + DVec3::new(6.0, 4.0 + f64::from(i % 7), 5.0))
        };
        let ground = Aabb::new(DVec3::new(-100.0, 0.0, -100.0), DVec3::new(100.0, 0.0, 100.0));
        (0..100).map(house).chain([ground]).collect()
    }

    /// A camera that walks and turns.
    fn view(frame: u32) -> View {
        let (frame, lens) = (f64::from(frame), Frustum::perspective(1.0, 1.5, 0.1, 500.0).expect("a lens"));
        let eye = DVec3::new(0.4 * frame - 12.0, 2.0, 30.0 - 0.5 * frame);
        let (sin, cos) = (0.03 * frame).sin_cos();
        View::look_at_upright(eye, eye + DVec3::new(sin, -0.1, -cos), lens).expect("a view")
    }

    fn lights() -> [Light; 2] {
        let sun = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("a sun");
        [sun.into(), PointLight::new(DVec3::new(3.0, 12.0, 5.0), 60.0).expect("a lamp").into()]
    }

    /// Configs of a sun and a lamp.
    fn configs(preset: Preset) -> [ShadowConfig; 2] {
        [LightKind::Directional, LightKind::Point].map(|kind| preset.config().for_light(kind).0)
    }

    #[test]
    fn steady_frames_of_a_moving_view_allocate_nothing() {
        let (boxes, lights) = (boxes(), lights());
        let mut set = CasterSet::default();
        for (key, &bounds) in (0..).zip(&boxes) {
            set.insert(umbrage::Caster::new(bounds, key)).expect("a caster");
        }
        set.pack();
        for preset in Preset::ALL {
            for set in [None, Some(&set)] {
                let mut planning = Planning::default();
                let configs = configs(*preset);
                let mut walk = |enabled: bool| {
                    for frame in 0..60 {
                        let view = view(frame);
                        let inputs = match set {
                            None => Inputs { casters: &boxes, receivers: &boxes, ..Inputs::new(&view, &lights) },
                            Some(_) => Inputs { set, ..Inputs::new(&view, &lights) },
                        };
                        planning.plan(&configs, PlannerOptions::default(), &inputs).expect("a frame");
                        if !enabled {
                            planning.take_back(0);
                        }
                    }
                };
                let first = allocation_counter::measure(|| walk(true));
                assert!(first.count_total > 0, "the counter counts");
                // The same ways once more: no buffer has to grow for what comes into view, nor for
                // planes that are searched for in other frames where frames are taken back.
                walk(true);
                walk(false);
                let again = allocation_counter::measure(|| {
                    walk(true);
                    walk(false);
                });
                assert_eq!(again.count_total, 0, "{preset}, of a set: {}: {again:?}", set.is_some());
            }
        }
    }

    #[test]
    fn frames_that_are_refused_or_taken_back_leave_no_trace() {
        let (boxes, [sun, lamp]) = (boxes(), lights());
        let configs = configs(Preset::Papers);
        let (mut planning, mut alike) = (Planning::default(), Planning::default());
        let mut bad = boxes.clone();
        bad[3].min.x = f64::NAN;
        let plan = |planning: &mut Planning, frame: u32, casters: &[Aabb], lights: &[Light]| {
            let view = view(frame);
            let inputs = Inputs { casters, receivers: &boxes, ..Inputs::new(&view, lights) };
            planning.plan(&configs, PlannerOptions::default(), &inputs)
        };
        for frame in 0..20 {
            plan(&mut planning, frame, &boxes, &[sun, lamp]).expect("a frame");
            plan(&mut alike, frame, &boxes, &[sun, lamp]).expect("a frame");
            assert_eq!(planning.plans(), alike.plans(), "frame {frame}");
            // The first light of a frame is planned, and the second refused.
            let far = PointLight::new(DVec3::ZERO, 1.0).expect("a lamp");
            assert!(matches!(plan(&mut planning, frame + 30, &bad, &[sun, far.into()]), Err(Error::Config(_))));
            plan(&mut planning, frame + 40, &boxes, &[sun, lamp]).expect("a frame");
            planning.take_back(0);
            // A second time there is nothing to take back.
            planning.take_back(0);
        }
    }
}
