//! Running a comparison: draws, probes, scores, writes the outputs.

use indicatif::ProgressBar;
use serde_json::{Value, json};
use umbrage::Light;
use umbrage_render::{Frame, Gpu, GpuOptions, Lamp, Outputs, ProbePoint, Renderer, Samples};
use umbrage_truth::{Truth, scores::shared_points};

use super::{
    job::{Job, Settings},
    journal::{self, Finished},
    judge::{ViewTruth, edge_scores, score},
    page,
    report::{self, Comparison, TechniqueReport, ViewReport, WalkReport},
    sheet::{self, Label, SheetShot},
    sheet_shots::{self, Answer, Place, Plain, sheet_shots},
    shots::{SceneShots, Series},
    stillness::{Answered, Stillness},
};
use crate::{
    failure::{Failure, Result},
    journal::Journal,
    lights::NamedLight,
    output::Staged,
    picture::png,
    progress,
    reach::truth_for,
    report::to_json,
    scene_setup,
    technique::Technique,
};

const REPRODUCE: &str = "umbrage render OPTIONS-OF-THE-VIEW OPTIONS-OF-THE-TECHNIQUE --visibility MASK.png; truth: umbrage truth OPTIONS-OF-THE-VIEW -o TRUTH.png";

/// Draws and scores everything and writes the outputs.
///
/// # Errors
/// [`Failure`] with the technique that cannot be drawn, or the file that cannot be written.
pub fn run(job: Job) -> Result<()> {
    let Job { techniques, scenes, settings, outputs, notes, resume, command } = job;
    let gpu = Gpu::new(&GpuOptions::default())?;
    let of = description(&techniques, &scenes, &settings, &gpu.description());
    let journal = resume.as_deref().map(|path| journal::open(path, &of)).transpose()?;
    let shown = sheet_shots::chosen(&scenes, settings.columns);
    let views: usize = scenes.iter().flat_map(|scene| &scene.series).map(|series| series.views.len()).sum();
    let mut run = Run {
        settings: &settings,
        command,
        gpu: &gpu,
        techniques: &techniques,
        cell: sheet::cell_size(shown.len(), settings.size),
        shown,
        bar: progress::steps((views * (techniques.len() + 1)) as u64, "views × techniques"),
        views: Vec::new(),
        walks: Vec::new(),
        sheets: [Vec::new(), Vec::new()],
        journal,
    };
    let mut all_notes = notes;
    if settings.image_metrics && !cfg!(feature = "flip") {
        all_notes.push("FLIP is left out: it needs a build with the feature flip and a C++ compiler".into());
    }
    if let Some(journal) = run.journal.as_ref().filter(|journal| !journal.finished.is_empty() || journal.dropped > 0) {
        all_notes.push(journal.note());
    }
    for (number, scene) in scenes.iter().enumerate() {
        all_notes.extend(scene.notes.iter().map(|note| format!("{}: {note}", scene.name)));
        run.scene(number, scene)?;
    }
    run.bar.finish_and_clear();
    let journal = run.journal.take();
    let (comparison, sheets) = run.finish(all_notes)?;

    let labels = labels(&comparison, &techniques);
    let cell = sheet::cell_size(sheets[0].len(), settings.size);
    let title = |what: &str| format!("{what}, {} × {} pixels", settings.size[0], settings.size[1]);
    let [pictures, errors] = &sheets;
    let contents = [
        png(&sheet::assemble(&title("Shadows; insets: where techniques differ most"), &labels, pictures, cell))?,
        png(&sheet::assemble(
            &title("Errors on the truth in grey: leaks red, acne blue, flips yellow"),
            &labels,
            errors,
            cell,
        ))?,
        to_json(&comparison)?,
        page::page(&comparison, &labels, &sheets)?.into_bytes(),
    ];
    let mut staged = Staged::default();
    outputs.stage(contents, &mut staged)?;
    staged.commit()?;
    journal.map_or(Ok(()), Journal::remove)
}

/// Results that grow while scenes are processed.
struct Run<'a> {
    settings: &'a Settings,
    command: Vec<String>,
    gpu: &'a Gpu,
    techniques: &'a [Technique],
    cell: [u32; 2],
    shown: Vec<Place>,
    bar: ProgressBar,
    views: Vec<ViewReport>,
    walks: Vec<WalkReport>,
    sheets: [Vec<SheetShot>; 2],
    journal: Option<Journal<Finished>>,
}

/// A frame whose points are probed again in the next one.
struct Before {
    judged: ViewTruth,
    /// Points that both frames share, P_k.
    points: Vec<ProbePoint>,
}

impl Run<'_> {
    fn scene(&mut self, number: usize, set: &SceneShots) -> Result<()> {
        let Some(first) = set.series.first() else { return Ok(()) };
        let mut take = |of| self.journal.as_mut().and_then(|journal| journal.take([number, of]));
        let before: Vec<Option<Finished>> = (0..set.series.len()).map(&mut take).collect();
        if before.iter().all(Option::is_some) {
            before.into_iter().flatten().for_each(|finished| self.restore(finished));
            return Ok(());
        }
        let truth = truth_for(&set.scene, &set.pose, &set.views())?;
        let mut renderers = Vec::new();
        for technique in self.techniques {
            let shadows = technique.shadows.clone().under_sun(self.settings.sun_angle);
            let light = NamedLight { name: first.sun_name.clone(), lamp: first.light };
            let shadows = shadows.for_lights(&[light])?;
            let settings =
                shadows.render_settings(self.settings.size, Samples::default(), vec![first.light.light.into()]);
            let renderer = Renderer::new(self.gpu, &set.scene, &settings);
            renderers.push(renderer.map_err(|error| in_technique(technique, error))?);
        }
        for (of, (series, finished)) in set.series.iter().zip(before).enumerate() {
            match finished {
                Some(finished) => self.restore(finished),
                None => {
                    let begin = [self.views.len(), self.walks.len(), self.sheets[0].len()];
                    self.series(set, series, [number, of], &truth, &mut renderers)?;
                    self.keep([number, of], begin)?;
                }
            }
        }
        Ok(())
    }

    /// Takes over a series that an earlier run finished.
    fn restore(&mut self, finished: Finished) {
        self.bar.inc((finished.views.len() * (self.techniques.len() + 1)) as u64);
        self.views.extend(finished.views);
        self.walks.extend(finished.walk);
        for (sheet, shots) in self.sheets.iter_mut().zip(finished.sheets) {
            sheet.extend(shots);
        }
    }

    /// Writes the series that begins at these numbers of views, walks and shots of the sheets.
    fn keep(&mut self, series: [usize; 2], [views, walks, shots]: [usize; 3]) -> Result<()> {
        let Some(journal) = &mut self.journal else { return Ok(()) };
        journal.keep(&Finished {
            series,
            views: self.views[views..].to_vec(),
            walk: self.walks.get(walks).cloned(),
            sheets: [self.sheets[0][shots..].to_vec(), self.sheets[1][shots..].to_vec()],
        })
    }

    fn series(
        &mut self,
        set: &SceneShots,
        series: &Series,
        [scene, of]: [usize; 2],
        truth: &Truth,
        renderers: &mut [Renderer],
    ) -> Result<()> {
        for renderer in renderers.iter_mut() {
            renderer.restart();
        }
        let first_view = self.views.len();
        let mut walks: Vec<Stillness> =
            self.techniques.iter().map(|technique| Stillness::new(technique.shadows.config.transition)).collect();
        let mut before: Option<Before> = None;
        for (k, view) in series.views.iter().enumerate() {
            let range = self.settings.shadow_range;
            let mut judged = ViewTruth::new(truth, &set.pose, view, &series.light.light, self.settings.size, range)?;
            judged.soften(truth, self.settings.sun_angle)?;
            self.bar.inc(1);
            let is_shown = self.shown.contains(&[scene, of, k]);
            let frame = Frame {
                pose: &set.pose,
                moved: Some(&[]),
                view,
                light: series.light,
                more_lights: &[],
                shadows_on: true,
                tint: self.settings.tint,
            };
            let points = match series.views.get(k + 1) {
                Some(next) => points_shared_with(&judged, next),
                None => Vec::new(),
            };
            let old_points = before.as_ref().map_or(&[][..], |before| &before.points);
            let both: Vec<ProbePoint> = old_points.iter().chain(&points).copied().collect();
            let (mut scores, mut shown) = (Vec::new(), Vec::new());
            for (number, (technique, renderer)) in self.techniques.iter().zip(renderers.iter_mut()).enumerate() {
                let wanted = Outputs { picture: is_shown, mask: true, maps: false, edges: true };
                let coloured = Frame { tint: frame.tint || technique.shadows.options.tint, ..frame };
                let rendered = renderer.render(&coloured, wanted).map_err(|error| in_technique(technique, error))?;
                let mask = rendered.mask.ok_or_else(|| Failure::other("the renderer gave no mask"))?;
                let image_metrics = is_shown && self.settings.image_metrics;
                let mut of_view = score(&judged, &mask, &rendered.stats, image_metrics)?;
                of_view.edges = rendered.edges.map(|edges| edge_scores(&judged, &mask, &edges));
                scores.push(of_view.clone());
                let mut flipped = Vec::new();
                if !both.is_empty() {
                    let answers = renderer.probe(&frame, &both).map_err(|error| in_technique(technique, error))?;
                    let answers: Vec<f32> = answers.iter().map(|answer| answer.visibility).collect();
                    let (shared, next) = answers.split_at(old_points.len());
                    let old = before.as_ref().map(|before| (&before.judged.domain, &before.points[..]));
                    let indices = walks[number].add(Answered { plan: rendered.stats.plan, shared, next }, old)?;
                    flipped.extend(
                        indices.iter().filter_map(|&i| pixel_of(view, self.settings.size, old_points[i].position)),
                    );
                }
                if let Some(picture) = rendered.picture {
                    shown.push(Answer { mask, picture, scores: of_view, flipped });
                }
                self.bar.inc(1);
            }
            self.views.push(ViewReport {
                scene: set.name.clone(),
                camera: scene_setup::camera_report(&series.camera, view),
                frame: (series.views.len() > 1).then_some(k as u32),
                sun_name: series.sun_name.clone(),
                sun: match series.light.light {
                    Light::Directional(sun) => Some(sun.direction().to_array()),
                    Light::Spot(_) | Light::Point(_) => None,
                },
                options: series.options[k].clone(),
                range_m: [judged.domain.range().0, judged.domain.range().1],
                scored_pixels: judged.domain.pixels().len(),
                true_edges: judged.domain.edges().len(),
                counts: judged.domain.edges().len() >= self.settings.least_edges && !judged.domain.pixels().is_empty(),
                scores,
            });
            if is_shown {
                self.show(&judged, &shown, &frame, &mut renderers[0], series)?;
            }
            before = Some(Before { judged, points });
        }
        if series.views.len() > 1 {
            self.walks.push(WalkReport {
                scene: set.name.clone(),
                camera: series.camera.clone(),
                sun_name: series.sun_name.clone(),
                frames: series.views.len(),
                counts: self.views[first_view..].iter().all(|view| view.counts),
                flicker: walks.iter().map(Stillness::report).collect(),
            });
        }
        Ok(())
    }

    /// Adds a shot to both sheets.
    fn show(
        &mut self,
        judged: &ViewTruth,
        answers: &[Answer],
        frame: &Frame<'_>,
        renderer: &mut Renderer,
        series: &Series,
    ) -> Result<()> {
        let against = match frame.light.light {
            Light::Directional(sun) => umbrage::DirectionalLight::new(-sun.direction())?.into(),
            // Turned off: a lamp has no other side.
            Light::Spot(_) | Light::Point(_) => Lamp { color: glam::Vec3::ZERO, ..frame.light },
        };
        let mut plain = |light| -> Result<_> {
            let frame = Frame { light, shadows_on: false, ..*frame };
            let wanted = Outputs { picture: true, ..Outputs::default() };
            renderer.render(&frame, wanted)?.picture.ok_or_else(|| Failure::other("the renderer gave no picture"))
        };
        let plain = Plain { lit: plain(frame.light)?, dark: plain(against)? };
        let view = self.views.last();
        let title = view.map_or(String::new(), |view| format!("{} · {}", short(&view.scene), series.camera));
        let mut lines = vec![series.sun_name.clone()];
        if let Some(number) = view.and_then(|view| view.frame) {
            lines.push(format!("frame {number} of {}", series.views.len()));
        }
        let warning = sheet_shots::warning(&judged.domain, self.settings.least_edges);
        for (sheet, shot) in self.sheets.iter_mut().zip(sheet_shots(judged, answers, &plain, self.cell)?) {
            sheet.push(SheetShot { title: title.clone(), lines: lines.clone(), warning: warning.clone(), ..shot });
        }
        Ok(())
    }

    fn finish(self, mut notes: Vec<String>) -> Result<(Comparison, [Vec<SheetShot>; 2])> {
        let reports = self.techniques.iter().enumerate().map(|(number, technique)| TechniqueReport {
            label: technique.label.clone(),
            spec: technique.spec.clone(),
            family: technique.family.clone(),
            options: technique.options.clone(),
            texels: technique.texels(),
            bytes: self.views.first().map_or(0, |view| view.scores[number].cost.bytes),
            mean: report::means(number, &self.views, &self.walks),
        });
        let techniques: Vec<TechniqueReport> = reports.collect();
        let counting = self.views.iter().filter(|view| view.counts).count();
        if counting == 0 {
            notes.push(format!(
                "no view counts: none has {} edge pixels; there are no means. Give a larger --size, other shots, or a smaller --least-edges",
                self.settings.least_edges
            ));
        } else if counting < self.views.len() {
            notes.push(format!(
                "{} of {} views do not count: fewer than {} edge pixels",
                self.views.len() - counting,
                self.views.len(),
                self.settings.least_edges
            ));
        }
        let labels: Vec<String> = techniques.iter().map(|technique| technique.label.clone()).collect();
        let comparison = Comparison {
            command: self.command,
            reproduce: REPRODUCE,
            adapter: self.gpu.description(),
            size: self.settings.size,
            least_edges: self.settings.least_edges,
            pairs: report::pairs(&labels, &self.views)?,
            memory_at_half_percent: report::families(&techniques)?,
            techniques,
            views: self.views,
            walks: self.walks,
            notes,
        };
        Ok((comparison, self.sheets))
    }
}

/// Describes all inputs that the results of a series depend on, for the journal.
fn description(techniques: &[Technique], scenes: &[SceneShots], settings: &Settings, adapter: &str) -> Value {
    let series = |scene: &SceneShots| {
        let of = |series: &Series| json!([series.camera, series.sun_name, series.options]);
        json!({ "scene": scene.name, "series": scene.series.iter().map(of).collect::<Vec<_>>() })
    };
    let technique = |technique: &Technique| json!([technique.label, technique.options]);
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "adapter": adapter,
        "techniques": techniques.iter().map(technique).collect::<Vec<_>>(),
        "scenes": scenes.iter().map(series).collect::<Vec<_>>(),
        "size": settings.size,
        "shadow-range": settings.shadow_range,
        "sun-angle": settings.sun_angle,
        "least-edges": settings.least_edges,
        "columns": settings.columns,
        "tint": settings.tint,
        "image-metrics": settings.image_metrics,
    })
}

/// Returns the pixel of a world point.
fn pixel_of(view: &umbrage::View, size: [u32; 2], point: glam::DVec3) -> Option<[u32; 2]> {
    let (at, lens) = (view.view_from_world_point(point), view.frustum());
    let scale = lens.scale_at(-at.z);
    let across = (at.x / scale - lens.left) / (lens.right - lens.left);
    let down = (lens.top - at.y / scale) / (lens.top - lens.bottom);
    let pixel = [across * f64::from(size[0]), down * f64::from(size[1])];
    let inside = pixel.iter().zip(size).all(|(&at, size)| at >= 0.0 && at < f64::from(size));
    inside.then_some(pixel.map(|at| at as u32))
}

/// Returns P_k, as points for the renderer's probe.
pub(crate) fn points_shared_with(judged: &ViewTruth, next: &umbrage::View) -> Vec<ProbePoint> {
    let shared = shared_points(&judged.truth, &judged.domain, next, judged.domain.range());
    let point =
        |pixel: usize| judged.truth.hits()[pixel].map(|hit| ProbePoint { position: hit.position, normal: hit.normal });
    shared.into_iter().filter_map(point).collect()
}

/// Adds the technique to an error.
fn in_technique(technique: &Technique, error: umbrage_render::Error) -> Failure {
    match Failure::from(error) {
        Failure::Input(message) => Failure::Input(format!("technique {}: {message}", technique.spec)),
        Failure::Other(message) => Failure::Other(format!("technique {}: {message}", technique.spec)),
    }
}

/// Returns a scene's name without its folders.
fn short(scene: &str) -> String {
    std::path::Path::new(scene).file_name().map_or(scene.into(), |name| name.to_string_lossy().into_owned())
}

/// Returns the labels of the rows: techniques, then the truth.
fn labels(comparison: &Comparison, techniques: &[Technique]) -> Vec<Label> {
    let of = |(report, technique): (&TechniqueReport, &Technique)| {
        let [texels, bytes] = [report.texels, report.bytes].map(|count| count as f64 / f64::from(1 << 20));
        let mut lines =
            vec![format!("{texels:.2} Mtexel, {bytes:.1} MiB"), format!("filter {}", technique.shadows.word("filter"))];
        if let Some(e) = report.mean.e {
            lines.push(format!("mean E {:.2} %, {} views", 100.0 * e, report.mean.views));
        }
        if let Some(flicker) = report.mean.flicker_per_edge {
            lines.push(format!("F_edge {:.1} %", 100.0 * flicker));
        }
        Label { title: report.label.clone(), lines }
    };
    let truth = Label { title: "ray-traced truth".into(), lines: Vec::new() };
    comparison.techniques.iter().zip(techniques).map(of).chain([truth]).collect()
}
