//! A device with a scene loaded onto it, for `render` and `probe`, and the reports of its frames.

use umbrage::config::Filter;
use umbrage::{ShadowConfig, ShadowPlan, View};
use umbrage_render::{Frame, FrameStats, Gpu, GpuOptions, Renderer, Samples, SplitStats};

use crate::{
    failure::Result,
    lights::{self, NamedLight},
    report::{BesideReport, LightReport, Report, SplitReport, TimesMs},
    scene_request::SceneRequest,
    scene_setup::{SceneSetup, Shot, camera_report},
    technique::ShadowRequest,
};

/// A renderer set up by the options, for `render` and `probe`.
pub struct Session {
    /// Renderer of the scene.
    pub renderer: Renderer,
    shadows: ShadowRequest,
    adapter: String,
}

impl Session {
    /// Opens the device and loads the scene onto it.
    pub fn open(request: &SceneRequest, shadows: &ShadowRequest, setup: &SceneSetup) -> Result<Self> {
        let shadows = shadows.for_lights(&setup.lights)?;
        let gpu = Gpu::new(&GpuOptions::default())?;
        let settings = shadows.render_settings(request.size, Samples::default(), lights::kinds(&setup.lights));
        let renderer = Renderer::new(&gpu, &setup.scene, &settings)?;
        Ok(Self { renderer, shadows, adapter: gpu.description() })
    }

    /// Makes a renderer's frame of one view of a shot.
    pub fn frame<'s>(&self, setup: &'s SceneSetup, shot: &Shot, view: &'s View) -> Frame<'s> {
        setup.frame(shot, view, !self.shadows.options.shadows_off, self.shadows.options.tint)
    }

    /// Makes the report of a frame.
    pub fn report(&self, request: &SceneRequest, setup: &SceneSetup, shot: &Shot, stats: &FrameStats) -> Report {
        let mut shot = setup.report(request, shot);
        shot.lights = light_reports(setup, stats);
        let config = &self.shadows.config;
        Report {
            shot,
            adapter: self.adapter.clone(),
            technique: self.shadows.word("technique"),
            generation: stats.generation.to_string(),
            storage: stats.storage.to_string(),
            filter: self.shadows.word("filter"),
            filter_width: config.filter.width_m(),
            sun_angle: match config.filter {
                Filter::Pcss { sun_degrees, .. } => Some(sun_degrees),
                _ => None,
            },
            transition: self.shadows.word("transition"),
            bias: self.shadows.word("bias"),
            translucent: self.shadows.word("translucent"),
            contact_shadows: config.look.contact,
            shadow_strength: config.look.strength,
            shadow_colour: config.look.colour,
            fit: self.shadows.word("fit"),
            bands: config.selection.metric().word().to_owned(),
            scheme: self.shadows.word("scheme"),
            stabilize: self.shadows.word("stabilize"),
            warp: warps(config),
            config: config.clone(),
            planes_m: stats.plan.planes.clone(),
            times_ms: TimesMs { plan: stats.plan_ms, shadow: stats.shadow_ms, frame: stats.frame_ms },
            bytes: stats.bytes,
            draws: u64::from(stats.shadow_draws),
            triangles: stats.shadow_triangles,
            dropped_casters: stats.plan.dropped_casters.clone(),
            splits: stats.splits.iter().map(split_report).collect(),
            edges: None,
            beside: Vec::new(),
            probe: None,
            notes: setup.notes.iter().chain(&self.shadows.notes).chain(&stats.notes).cloned().collect(),
        }
    }
}

/// Returns the warp of all maps, or of each.
#[must_use]
pub fn warps(config: &ShadowConfig) -> Vec<String> {
    let warps: Vec<String> = (0..config.splits()).map(|split| config.warp(split).word().to_owned()).collect();
    match &warps[..] {
        [first, rest @ ..] if rest.iter().all(|warp| warp == first) => vec![first.clone()],
        _ => warps,
    }
}

/// Makes the reports of all lights with their splits.
fn light_reports(setup: &SceneSetup, stats: &FrameStats) -> Vec<LightReport> {
    let others = stats.more_lights.iter().map(|light| (&*light.plan, &light.splits));
    let all = [(&*stats.plan, &stats.splits)].into_iter().chain(others);
    let report = |(light, (plan, splits)): (&NamedLight, (&ShadowPlan, &Vec<SplitStats>))| LightReport {
        planes_m: plan.planes.clone(),
        splits: splits.iter().map(split_report).collect(),
        ..light.report()
    };
    setup.lights.iter().zip(all).map(report).collect()
}

/// Makes the report of one of the views beside the first.
#[must_use]
pub fn beside_report(setup: &SceneSetup, camera: &str, view: &View, stats: &FrameStats) -> BesideReport {
    BesideReport {
        camera: camera_report(camera, view),
        planes_m: stats.plan.planes.clone(),
        times_ms: TimesMs { plan: stats.plan_ms, shadow: stats.shadow_ms, frame: stats.frame_ms },
        lights: light_reports(setup, stats),
    }
}

fn split_report(split: &SplitStats) -> SplitReport {
    SplitReport {
        near: split.near,
        far: split.far,
        texel_m: split.texel_m,
        warped: split.warped,
        casters: split.casters as u64,
        draws: u64::from(split.draws),
        triangles: split.triangles,
        bytes: split.bytes,
    }
}
