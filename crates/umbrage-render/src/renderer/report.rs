//! Statistics of a frame, from what was recorded and measured.

use umbrage::config::{Filter, Translucent};
use umbrage::{ShadowPlan, Split};
use umbrage_scene::AlphaMode;

use super::prepare::Prepared;
use super::record::Recorded;
use super::{Frame, Renderer};
use crate::materials::GpuMaterial;
use crate::stats::{FrameStats, LightStats, SplitStats};
use crate::timing::{Measured, PassCounts};

impl Renderer {
    /// Computes the statistics of a frame. `wall` are the milliseconds of maps and frame by the
    /// CPU's clock, if the GPU has none.
    pub(super) fn stats(
        &self,
        frame: &Frame<'_>,
        prepared: &Prepared,
        recorded: &Recorded,
        measured: &Measured,
        wall: Option<(f64, f64)>,
    ) -> FrameStats {
        let is_of_maps = |pass: usize| recorded.map_passes.iter().any(|&(_, _, slot)| slot == pass);
        let counts = |maps: bool| {
            measured.counts.as_ref().map(|counts| {
                let mut sum = PassCounts::default();
                counts.iter().enumerate().filter(|&(i, _)| is_of_maps(i) == maps).for_each(|(_, &count)| sum += count);
                sum
            })
        };
        let (shadow_ms, frame_ms) = match (&measured.spans_ms, wall) {
            (Some(spans), _) if !spans.is_empty() => self.milliseconds(prepared, recorded, spans),
            (_, Some(wall)) => wall,
            _ => (0.0, 0.0),
        };
        let spans = measured.spans_ms.as_deref();
        let shown = self.shadows.frame();
        let maps = self.shadows.maps();
        FrameStats {
            plan_ms: prepared.plan_ms,
            shadow_ms,
            frame_ms,
            splits: self.split_stats(0, frame, recorded, spans),
            shadow_draws: recorded.map_passes.iter().map(|(_, drawn, _)| drawn.draws).sum(),
            shadow_triangles: recorded.map_passes.iter().map(|(_, drawn, _)| drawn.triangles).sum(),
            more_lights: (1..self.shadows.lights().len())
                .map(|light| LightStats {
                    splits: self.split_stats(light, frame, recorded, spans),
                    plan: shown.shared_plan(light),
                })
                .collect(),
            objects_in_view: prepared.objects_in_view,
            view_draws: recorded.view.draws,
            view_triangles: recorded.view.triangles,
            shadow_counts: counts(true),
            view_counts: counts(false),
            bytes: maps.bytes(),
            generation: maps.layout().generation().word(),
            storage: maps.layout().storage().word(),
            notes: self.notes.iter().cloned().chain(narrowed(&maps.config().filter, &shown.shared_plan(0))).collect(),
            plan: shown.shared_plan(0),
        }
    }

    /// Returns the milliseconds of the maps and of the frame, from the passes' times on the GPU.
    fn milliseconds(&self, prepared: &Prepared, recorded: &Recorded, spans: &[[f64; 2]]) -> (f64, f64) {
        let is_of_maps = |pass: usize| recorded.map_passes.iter().any(|&(_, _, slot)| slot == pass);
        let maps = || spans.iter().enumerate().filter(|&(i, _)| is_of_maps(i)).map(|(_, span)| span);
        let mut slots = recorded.map_passes.iter().map(|&(_, _, slot)| slot);
        let last = slots.rfind(|&slot| slot < spans.len()).unwrap_or(0);
        let is_prefiltered = self.shadows.maps().config().filter.is_prefiltered();
        let shadow_ms = match prepared.slices.is_empty() {
            // What turns depths into moments is no pass of ours; it is over when the next one
            // begins.
            true if is_prefiltered && maps().next().is_some() && last + 1 < spans.len() => spans[last + 1][0],
            true => maps().map(|span| span[1]).fold(0.0, f64::max),
            // Between the maps there is the view.
            false => maps().map(|span| span[1] - span[0]).sum(),
        };
        (shadow_ms, spans.iter().map(|span| span[1]).fold(0.0, f64::max))
    }

    fn split_stats(
        &self,
        light: usize,
        frame: &Frame<'_>,
        recorded: &Recorded,
        spans_ms: Option<&[[f64; 2]]>,
    ) -> Vec<SplitStats> {
        let plan: &ShadowPlan = self.shadows.frame().plan(light);
        let pose = frame.pose;
        let drawable = self.drawable();
        let dithered = self.shadows.maps().config().look.translucent == Translucent::Dithered;
        let triangles = |caster: &u32| {
            let drawn = |material: &GpuMaterial| dithered || material.alpha != AlphaMode::Blend;
            drawable.triangles(&pose.objects[self.gathered.object(*caster)], drawn)
        };
        let stats = |(i, split): (usize, &umbrage::Split)| {
            let shown = self.shadows.frame();
            let draws_it = |pass: usize| {
                let map = shown.map(pass);
                map.light() == light && map.splits().contains(&i)
            };
            let draws = recorded.map_passes.iter().filter(|&&(pass, ..)| draws_it(pass));
            let took = |spans: &[[f64; 2]]| {
                draws.clone().filter_map(|&(_, _, slot)| spans.get(slot)).map(|span| span[1] - span[0]).sum()
            };
            // Of a map that has a pass of its own, what was drawn: maybe parts of casters.
            let is_alone = |pass: usize| shown.map(pass).splits().len() == 1;
            let alone = self.keeps_maps() || draws.clone().any(|&(pass, ..)| is_alone(pass));
            SplitStats {
                near: split.near,
                far: split.far,
                texel_m: split.texel_m.max_element(),
                warped: split.warp.is_some() && split.light_position.is_none(),
                casters: split.casters.len(),
                gpu_ms: spans_ms.map(took),
                draws: draws.clone().map(|(_, drawn, _)| drawn.draws).sum(),
                triangles: match alone {
                    true => draws.map(|(_, drawn, _)| drawn.triangles).sum(),
                    false if frame.shadows_on => plan.casters(i).iter().map(triangles).sum(),
                    false => 0,
                },
                bytes: u64::from(split.size) * u64::from(split.size) * self.shadows.maps().config().texel_bytes(),
            }
        };
        plan.splits.iter().enumerate().map(stats).collect()
    }
}

/// The note of splits in which a filter is narrower than its width, by more than a tenth.
fn narrowed(filter: &Filter, plan: &ShadowPlan) -> Option<String> {
    let width = filter.width_m()?;
    let narrow = |(index, split): (usize, &Split)| {
        let there = filter.width_in(split).filter(|there| *there < 0.9 * width)?;
        (!split.casters.is_empty()).then(|| format!("{there:.3} m in split {index}"))
    };
    let splits: Vec<_> = plan.splits.iter().enumerate().filter_map(narrow).collect();
    let word = filter.word();
    (!splits.is_empty()).then(|| {
        format!("a filter {word} of {width} m takes more texels than it reads: it is as wide as {}", splits.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::config::Filter;
    use umbrage::{Aabb, DirectionalLight, Frustum, Planner, ShadowConfig, View};

    use super::narrowed;

    #[test]
    fn a_filter_that_is_too_wide_for_a_map_says_so() {
        let lens = Frustum::perspective(1.0, 1.0, 0.1, 100.0).expect("a lens");
        let view = View::look_at_upright(DVec3::new(0.0, 2.0, 8.0), DVec3::ZERO, lens).expect("a view");
        let boxes =
            [Aabb::new(DVec3::new(-8.0, -0.1, -8.0), DVec3::new(8.0, 0.0, 8.0)), Aabb::new(DVec3::ZERO, DVec3::ONE)];
        let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2)).expect("a direction");
        let config = ShadowConfig { map_sizes: vec![512], ..ShadowConfig::default() };
        let plan = Planner::new(&config).expect("settings").plan(&view, &sun, &boxes, &boxes).expect("a plan").clone();
        let disc = |width_m| Filter::Disc { width_m, rotated: false };
        assert_eq!(narrowed(&disc(None), &plan), None);
        let texel = plan.splits[0].texel_m.min_element();
        assert_eq!(narrowed(&disc(Some(29.0 * texel)), &plan), None);
        let note = narrowed(&disc(Some(60.0 * texel)), &plan).expect("a note");
        assert!(note.contains(&format!("{:.3} m in split 0", 30.0 * texel)), "{note}");
    }
}
