//! Flicker of one technique along a walk: over all points, over those that keep their split, and
//! over those of the latter whose map takes no step.

use std::sync::Arc;

use umbrage::ShadowPlan;
use umbrage::config::Transition;
use umbrage_render::ProbePoint;
use umbrage_truth::scores::{Domain, Flicker, FramePair};

use super::report::FlickerReport;
use crate::failure::Result;

/// Sums of one technique, frame after frame.
#[derive(Debug)]
pub struct Stillness {
    transition: Transition,
    all: Flicker,
    kept: Flicker,
    standing: Flicker,
    standing_points: usize,
    steps: usize,
    before: Option<Before>,
}

/// The frame before.
#[derive(Debug)]
struct Before {
    plan: Arc<ShadowPlan>,
    /// Answers at the points that this frame and the next share.
    answers: Vec<f32>,
}

/// Answers of a technique in one frame.
#[derive(Debug)]
pub struct Answered<'a> {
    /// Plan of the frame.
    pub plan: Arc<ShadowPlan>,
    /// Answers at the points that the frame before shares with this one.
    pub shared: &'a [f32],
    /// Answers at the points that this frame shares with the next.
    pub next: &'a [f32],
}

impl Stillness {
    /// Starts with empty sums.
    #[must_use]
    pub fn new(transition: Transition) -> Self {
        let (all, kept, standing) = Default::default();
        Self { transition, all, kept, standing, standing_points: 0, steps: 0, before: None }
    }

    /// Adds one more frame. `shared` are the domain of the frame before and the points that it
    /// shares with this one. Returns the points among them whose decision has changed.
    ///
    /// # Errors
    /// [`crate::failure::Failure`] if answers are missing or none at all.
    pub fn add(&mut self, answered: Answered<'_>, shared: Option<(&Domain, &[ProbePoint])>) -> Result<Vec<usize>> {
        let mut flipped = Vec::new();
        let now = Before { plan: answered.plan, answers: answered.next.to_vec() };
        if let (Some(before), Some((domain, points))) = (&self.before, shared) {
            let (old, new) = (&before.answers[..], answered.shared);
            let differ = |(_, (a, b)): &(usize, (&f32, &f32))| (**a >= 0.5) != (**b >= 0.5);
            flipped.extend(old.iter().zip(new).enumerate().filter(differ).map(|(index, _)| index));
            self.all.add(FramePair { domain, now: old, next: new })?;
            let splits = now.plan.splits.iter().zip(&before.plan.splits);
            // A split that nothing casts a shadow in stands still, whatever its map.
            let stands: Vec<bool> = splits
                .map(|(new, old)| {
                    (new.casters.is_empty() && old.casters.is_empty()) || new.texels_moved_since(old).is_some()
                })
                .collect();
            self.steps += stands.iter().filter(|stands| !**stands).count();
            let (mut kept, mut standing) = ((Vec::new(), Vec::new()), (Vec::new(), Vec::new()));
            for ((point, &old), &new) in points.iter().zip(old).zip(new) {
                let decider = decides(&now.plan, point, self.transition);
                if decider != Decides::Several && decider == decides(&before.plan, point, self.transition) {
                    kept.0.push(old);
                    kept.1.push(new);
                    if !matches!(decider, Decides::Split(split) if !stands[split]) {
                        standing.0.push(old);
                        standing.1.push(new);
                    }
                }
            }
            self.kept.add(FramePair { domain, now: &kept.0, next: &kept.1 })?;
            self.standing_points += standing.0.len();
            self.standing.add(FramePair { domain, now: &standing.0, next: &standing.1 })?;
        }
        self.before = Some(now);
        Ok(flipped)
    }

    /// Returns the flicker so far.
    #[must_use]
    pub fn report(&self) -> FlickerReport {
        FlickerReport {
            rate: self.all.rate(),
            per_edge: self.all.per_edge(),
            kept_per_edge: self.kept.per_edge(),
            standing_points: self.standing_points,
            standing_per_edge: self.standing.per_edge(),
            steps: self.steps,
        }
    }
}

/// Split that decides on a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Decides {
    /// A single split.
    Split(usize),
    /// Two splits that are blended, or one that fades out. Their shares change as the eye moves,
    /// and soft edges with them.
    Several,
    /// No split, because the point lies beyond the range.
    Nobody,
}

/// Returns the split that decides on a point, by its view depth or its distance. A dithered border
/// counts as lying in the middle of its band, because the points are not pixels.
fn decides(plan: &ShadowPlan, point: &ProbePoint, transition: Transition) -> Decides {
    let depth = plan.depth_at(point.position);
    let Some(index) = plan.splits.iter().position(|split| depth < split.far) else { return Decides::Nobody };
    if depth > plan.fade_begin {
        return Decides::Several;
    }
    let split = &plan.splits[index];
    let next = (index + 1).min(plan.splits.len() - 1);
    match transition {
        Transition::Hard => Decides::Split(index),
        Transition::Blend { .. } if depth > split.blend_begin => Decides::Several,
        Transition::Dither { .. } if depth > 0.5 * (split.blend_begin + split.far) => Decides::Split(next),
        Transition::Blend { .. } | Transition::Dither { .. } => Decides::Split(index),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::config::{Preset, Range, SplitScheme, Transition};
    use umbrage::{DirectionalLight, Frustum, Planner, ShadowConfig, View};

    use super::*;

    #[test]
    fn one_split_decides_or_several_do() {
        let settings = ShadowConfig {
            range: Range::Metres { near: 1.0, far: 100.0 },
            map_sizes: vec![64; 2],
            scheme: SplitScheme::Manual { planes: vec![21.0] },
            transition: Transition::Blend { share: 0.2 },
            far_fade: 0.1,
            ..Preset::Papers.config()
        };
        let lens = Frustum::perspective(1.0, 1.0, 0.5, 200.0).expect("a lens");
        let view = View::look_at_upright(DVec3::ZERO, DVec3::NEG_Z, lens).expect("a view");
        let sun = DirectionalLight::new(DVec3::new(0.2, -1.0, 0.1)).expect("a sun");
        let mut planner = Planner::new(&settings).expect("a planner");
        let plan = planner.plan(&view, &sun, &[], &[]).expect("a plan");
        let at = |depth: f64, transition| {
            decides(plan, &ProbePoint { position: DVec3::NEG_Z * depth, normal: DVec3::Y }, transition)
        };
        use Decides::{Nobody, Several, Split};
        // The blend reaches from 17 to 21 m, the fade from 90 to 100.
        for (depth, blend, dither, hard) in [
            (0.7, Split(0), Split(0), Split(0)),
            (16.9, Split(0), Split(0), Split(0)),
            (18.9, Several, Split(0), Split(0)),
            (19.1, Several, Split(1), Split(0)),
            (21.1, Split(1), Split(1), Split(1)),
            (89.0, Split(1), Split(1), Split(1)),
            (91.0, Several, Several, Several),
            (101.0, Nobody, Nobody, Nobody),
        ] {
            assert_eq!(at(depth, Transition::Blend { share: 0.1 }), blend, "{depth}");
            assert_eq!(at(depth, Transition::Dither { share: 0.1 }), dither, "{depth}");
            assert_eq!(at(depth, Transition::Hard), hard, "{depth}");
        }
    }
}
