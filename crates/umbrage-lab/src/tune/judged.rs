//! The views with their ground truth, traced once, and a candidate's answers in them.

use indicatif::ProgressBar;
use umbrage_render::{Frame, Gpu, Lamp, Outputs, ProbePoint, Renderer, Samples};

use super::{
    Settings,
    candidates::Candidate,
    record::{Outcome, ViewOutcome},
};
use crate::{
    compare::{
        judge::{Scores, ViewTruth, score},
        points_shared_with,
        report::mean,
        shots::SceneShots,
        stillness::{Answered, Stillness},
    },
    failure::{Failure, Result},
    lights::NamedLight,
    reach::truth_for,
    technique::{ShadowOptions, ShadowRequest},
};

/// A scene with the ground truth of its views.
pub struct JudgedScene<'a> {
    set: &'a SceneShots,
    series: Vec<JudgedSeries>,
}

/// A camera under a sun, or the frames of a walk.
struct JudgedSeries {
    light: Lamp,
    frames: Vec<JudgedFrame>,
}

struct JudgedFrame {
    judged: ViewTruth,
    /// Points that this frame shares with the next.
    shared: Vec<ProbePoint>,
    counts: bool,
}

/// Sums over the views and walks of one candidate.
#[derive(Default)]
struct Sums {
    counting: Vec<Scores>,
    views: Vec<ViewOutcome>,
    flicker: Vec<f64>,
    bytes: u64,
}

impl<'a> JudgedScene<'a> {
    /// Traces the views of a scene.
    ///
    /// # Errors
    /// [`Failure`] if the scene cannot be traced.
    pub fn trace(set: &'a SceneShots, settings: &Settings, bar: &ProgressBar) -> Result<Self> {
        let truth = truth_for(&set.scene, &set.pose, &set.views())?;
        let mut all = Vec::new();
        for series in &set.series {
            let mut frames = Vec::new();
            for (k, view) in series.views.iter().enumerate() {
                let light = &series.light.light;
                let judged = ViewTruth::new(&truth, &set.pose, view, light, settings.size, settings.shadow_range)?;
                let counts = judged.domain.edges().len() >= settings.least_edges && !judged.domain.pixels().is_empty();
                let shared = series.views.get(k + 1).map_or(Vec::new(), |next| points_shared_with(&judged, next));
                frames.push(JudgedFrame { judged, shared, counts });
                bar.inc(1);
            }
            all.push(JudgedSeries { light: series.light, frames });
        }
        Ok(Self { set, series: all })
    }

    /// Returns whether any view has enough edges to count.
    pub fn counts(&self) -> bool {
        self.series.iter().flat_map(|series| &series.frames).any(|frame| frame.counts)
    }

    /// Draws and scores every view with a candidate.
    fn judge(
        &self,
        gpu: &Gpu,
        candidate: &Candidate,
        settings: &Settings,
        bar: &ProgressBar,
        sums: &mut Sums,
    ) -> Result<()> {
        let Some(first) = self.series.first() else { return Ok(()) };
        let in_candidate = |error| named(candidate, error);
        let asked =
            ShadowRequest { config: candidate.config.clone(), options: ShadowOptions::default(), notes: Vec::new() };
        let light = NamedLight { name: String::new(), lamp: first.light };
        let request = asked.under_sun(settings.sun_angle).for_lights(&[light])?;
        let made = request.render_settings(settings.size, Samples::default(), vec![first.light.light.into()]);
        let mut renderer = Renderer::new(gpu, &self.set.scene, &made).map_err(in_candidate)?;
        for series in &self.series {
            renderer.restart();
            let mut stillness = Stillness::new(candidate.config.transition);
            let mut before: Option<&JudgedFrame> = None;
            for frame in &series.frames {
                let drawn = Frame {
                    pose: &self.set.pose,
                    moved: Some(&[]),
                    view: &frame.judged.view,
                    light: series.light,
                    more_lights: &[],
                    shadows_on: true,
                    tint: false,
                };
                let wanted = Outputs { picture: false, mask: true, maps: false, edges: false };
                let rendered = renderer.render(&drawn, wanted).map_err(in_candidate)?;
                let mask = rendered.mask.ok_or_else(|| Failure::other("the renderer gave no mask"))?;
                let scores = score(&frame.judged, &mask, &rendered.stats, false)?;
                sums.bytes = sums.bytes.max(scores.cost.bytes);
                sums.views.push(ViewOutcome {
                    e: scores.e,
                    edges: frame.judged.domain.edges().len(),
                    counts: frame.counts,
                });
                if frame.counts {
                    sums.counting.push(scores);
                }
                let old = before.map_or(&[][..], |before| &before.shared);
                let both: Vec<ProbePoint> = old.iter().chain(&frame.shared).copied().collect();
                if !both.is_empty() {
                    let answers = renderer.probe(&drawn, &both).map_err(in_candidate)?;
                    let answers: Vec<f32> = answers.iter().map(|answer| answer.visibility).collect();
                    let (shared, next) = answers.split_at(old.len());
                    let domain = before.map(|before| (&before.judged.domain, old));
                    stillness.add(Answered { plan: rendered.stats.plan, shared, next }, domain)?;
                }
                before = Some(frame);
                bar.inc(1);
            }
            if series.frames.len() > 1 && series.frames.iter().all(|frame| frame.counts) {
                sums.flicker.extend(stillness.report().per_edge);
            }
        }
        Ok(())
    }
}

/// Adds the candidate to an error.
fn named(candidate: &Candidate, error: umbrage_render::Error) -> Failure {
    match Failure::from(error) {
        Failure::Input(message) => Failure::Input(format!("candidate {}: {message}", candidate.label)),
        Failure::Other(message) => Failure::Other(format!("candidate {}: {message}", candidate.label)),
    }
}

/// Judges a candidate over all scenes.
///
/// # Errors
/// [`Failure`] with the candidate that cannot be drawn.
pub fn judge(
    gpu: &Gpu,
    scenes: &[JudgedScene<'_>],
    (number, candidate): (usize, &Candidate),
    settings: &Settings,
    bar: &ProgressBar,
) -> Result<Outcome> {
    let mut sums = Sums::default();
    for scene in scenes {
        scene.judge(gpu, candidate, settings, bar, &mut sums)?;
    }
    let over = |of: fn(&Scores) -> Option<f64>| mean(sums.counting.iter().filter_map(of));
    Ok(Outcome {
        candidate: number,
        bytes: sums.bytes,
        e: over(|scores| scores.e),
        e_log: over(|scores| scores.e_log),
        acne: over(|scores| scores.acne),
        leak: over(|scores| scores.leak),
        edge_distance_px: over(|scores| scores.edge_distance_px),
        flicker: mean(sums.flicker.iter().copied()),
        draws: over(|scores| Some(scores.cost.draws as f64)),
        views: sums.views,
    })
}
