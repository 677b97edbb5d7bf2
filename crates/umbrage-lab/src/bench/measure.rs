//! Rounds of one scene: every technique in turn, each followed by a renderer whose shaders contain
//! no shadow code.

use std::time::Instant;

use cpu_time::ProcessTime;
use indicatif::ProgressBar;
use umbrage_render::{FrameStats, Gpu, LightMaps, Outputs, RenderSettings, Renderer};

use super::{
    job::Job,
    report::{Counts, Row},
    summary::Summary,
};
use crate::{failure::Result, lights, scene_setup::SceneSetup, technique::Technique};

/// Measurements of one technique, round by round, in milliseconds.
#[derive(Default)]
struct Rounds {
    plan: Vec<f64>,
    shadow: Vec<f64>,
    frame: Vec<f64>,
    wall: Vec<f64>,
    cpu: Vec<f64>,
    frame_without: Vec<f64>,
    wall_without: Vec<f64>,
    cpu_without: Vec<f64>,
    /// Time from nothing to the first picture.
    first: Spent,
}

/// Milliseconds of wall-clock time, and of CPU time of all of this process's threads.
#[derive(Clone, Copy, Default)]
struct Spent {
    wall: f64,
    cpu: f64,
}

impl Spent {
    /// Runs `work` and measures its time.
    fn by<T>(work: impl FnOnce() -> T) -> (Self, T) {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        let result = work();
        let ms = |span: std::time::Duration| 1e3 * span.as_secs_f64();
        (Self { wall: ms(wall.elapsed()), cpu: ms(cpu.elapsed()) }, result)
    }
}

/// Measures `techniques` on the first shot of the setup. The first technique is the baseline of all
/// ratios.
pub fn measure(
    gpu: &Gpu,
    setup: &SceneSetup,
    techniques: &[Technique],
    job: &Job,
    bar: &ProgressBar,
) -> Result<Vec<Row>> {
    let mut renderers = Vec::new();
    let mut all: Vec<Rounds> = Vec::new();
    for technique in techniques {
        let shadows = technique.shadows.for_lights(&setup.lights)?;
        let settings = shadows.render_settings(job.size, job.samples, lights::kinds(&setup.lights));
        let (first, renderer) = Spent::by(|| Renderer::new(gpu, &setup.scene, &settings));
        renderers.push(renderer?);
        all.push(Rounds { first, ..Rounds::default() });
    }
    let lights = lights::kinds(&setup.lights).into_iter().map(LightMaps::from).collect();
    let bare = RenderSettings { size: job.size, samples: job.samples, lights, ..RenderSettings::default() };
    let mut without_shadows = Renderer::without_shadows(gpu, &setup.scene, &bare)?;
    let frame = |shadows_on| setup.frame(&setup.shots[0], &setup.shots[0].view, shadows_on, false);
    let outputs = Outputs { picture: true, ..Outputs::default() };
    let timed = |renderer: &mut Renderer, shadows_on| -> Result<(Spent, FrameStats)> {
        let (spent, rendered) = Spent::by(|| renderer.render(&frame(shadows_on), outputs));
        Ok((spent, rendered?.stats))
    };
    let mut last: Vec<Option<FrameStats>> = techniques.iter().map(|_| None).collect();
    for round in 0..=job.rounds {
        for ((renderer, measured), last) in renderers.iter_mut().zip(&mut all).zip(&mut last) {
            let (spent, stats) = timed(renderer, true)?;
            let (spent_without, without) = timed(&mut without_shadows, false)?;
            // The first round fills caches and compiles; it is not counted.
            if round == 0 {
                measured.first.wall += spent.wall;
                measured.first.cpu += spent.cpu;
            } else {
                measured.plan.push(stats.plan_ms);
                measured.shadow.push(stats.shadow_ms);
                measured.frame.push(stats.frame_ms);
                measured.wall.push(spent.wall);
                measured.cpu.push(spent.cpu);
                measured.frame_without.push(without.frame_ms);
                measured.wall_without.push(spent_without.wall);
                measured.cpu_without.push(spent_without.cpu);
            }
            *last = Some(stats);
            bar.inc(1);
        }
    }
    let [first, ..] = &all[..] else { return Ok(Vec::new()) };
    let rows = techniques.iter().zip(&all).zip(&last);
    let rows = rows.filter_map(|((technique, measured), stats)| Some(row(technique, measured, first, stats.as_ref()?)));
    let mut rows: Vec<Row> = rows.collect();
    for (row, renderer) in rows.iter_mut().zip(&mut renderers) {
        // Counted by a text of its own, and not in the rounds.
        let counted = renderer.render(&frame(true), Outputs { edges: true, ..Outputs::default() })?;
        row.edges = counted.edges.map(|edges| edges.sums().into());
    }
    Ok(rows)
}

fn row(technique: &Technique, measured: &Rounds, baseline: &Rounds, stats: &FrameStats) -> Row {
    let ratio = |of: &[f64], to: &[f64]| {
        let ratios: Vec<f64> = of.iter().zip(to).filter(|(_, to)| **to > 0.0).map(|(of, to)| of / to).collect();
        Summary::of(&ratios)
    };
    let cost: Vec<f64> = measured.frame.iter().zip(&measured.frame_without).map(|(on, off)| on - off).collect();
    let counts = |counts: umbrage_render::PassCounts| Counts {
        vertices: counts.vertices,
        primitives: counts.primitives,
        fragments: counts.fragments,
    };
    let sum = |f: fn(&umbrage_render::SplitStats) -> u64| stats.splits.iter().map(f).sum();
    Row {
        technique: technique.label.clone(),
        spec: technique.spec.clone(),
        splits: stats.splits.len(),
        generation: stats.generation.to_string(),
        storage: stats.storage.to_string(),
        plan_us: Summary::of(&measured.plan.iter().map(|ms| 1e3 * ms).collect::<Vec<_>>()),
        shadow_ms: Summary::of(&measured.shadow),
        frame_ms: Summary::of(&measured.frame),
        wall_ms: Summary::of(&measured.wall),
        frame_without_ms: Summary::of(&measured.frame_without),
        wall_without_ms: Summary::of(&measured.wall_without),
        cpu_ms: Summary::of(&measured.cpu),
        cpu_without_ms: Summary::of(&measured.cpu_without),
        first_picture_ms: measured.first.wall,
        first_picture_cpu_ms: measured.first.cpu,
        cost_ms: Summary::of(&cost),
        frame_ratio: ratio(&measured.frame, &baseline.frame),
        shadow_ratio: ratio(&measured.shadow, &baseline.shadow),
        paper_ratio: None,
        samples: technique.shadows.config.filter.texels_read(),
        pairs: sum(|split| split.casters as u64),
        draws: u64::from(stats.shadow_draws),
        triangles: stats.shadow_triangles,
        map_bytes: stats.bytes,
        edges: None,
        shadow_counts: stats.shadow_counts.map(counts),
        view_counts: stats.view_counts.map(counts),
    }
}
