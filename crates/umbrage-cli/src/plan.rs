//! `umbrage plan`: prints the planner's result as JSON, without a GPU.

use std::path::{Path, PathBuf};

use serde::Serialize;
use umbrage::config::{ExtentSteps, Stability};
use umbrage::{Aabb, DepthConvention, Planner, PlannerOptions, ShadowPlan, Split};
use umbrage_lab::{
    failure::Result,
    output::{self, Staged, numbered_file},
    report::{ShotReport, to_json},
    scene_request::SceneRequest,
    scene_setup::{SceneSetup, Shot},
    session::warps,
    technique::ShadowRequest,
};

use crate::{
    print::print,
    scene_options::{Asked, SceneOptions},
    shadow_args::ShadowArgs,
    words,
};

/// `umbrage plan`.
#[derive(Debug, clap::Args)]
pub struct PlanArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// What the graphics interface that reads the matrices takes for granted
    #[arg(long, value_name = "WORD", value_parser = words::parser::<DepthConvention>(DepthConvention::WORDS), default_value_t, help_heading = "Output")]
    pub depth_convention: DepthConvention,
    /// Write the plan here (JSON) instead of printing it; with --frames, NAME.json becomes
    /// NAME.0000.json and so on
    #[arg(short = 'o', long = "output", value_name = "JSON", help_heading = "Output")]
    pub output: Option<PathBuf>,
}

/// Report of the plan of one frame.
#[derive(Debug, Serialize)]
struct PlanReport {
    /// Scene, camera and sun.
    #[serde(flatten)]
    shot: ShotReport,
    technique: String,
    fit: String,
    stabilize: String,
    /// Steps of the extents of approximately stabilised maps; absent for others.
    #[serde(skip_serializing_if = "Option::is_none")]
    extent_steps: Option<ExtentSteps>,
    /// Metric of depths: `planar` if all depths of this report are view depths; `radial` if all but
    /// `coverage_m` are distances to the eye.
    bands: String,
    /// Split scheme: `uniform`, `log`, `practical`, `manual` or `optimal`.
    scheme: String,
    /// Warp of all splits, or of each.
    warp: Vec<String>,
    /// Depth convention of the matrices.
    depth_convention: String,
    /// Split planes `C_0 ..= C_m`: view depths in metres.
    planes_m: Vec<f64>,
    /// Plane that gives the view depth of a world point in metres: `xyz · point + w`.
    view_depth_plane: [f64; 4],
    /// View depth at which the fade to lit begins, metres.
    fade_begin_m: f64,
    splits: Vec<SplitPlan>,
    /// Casters that `splits[].casters` refers to: the node of each, and its index among the node's
    /// instances.
    casters: Vec<Caster>,
    /// Invented defaults, and parts of the scene that were left out.
    notes: Vec<String>,
}

/// Report of one split.
#[derive(Debug, Serialize)]
struct SplitPlan {
    near_m: f64,
    far_m: f64,
    blend_begin_m: f64,
    /// View depths that may sample the map, in metres.
    coverage_m: [f64; 2],
    /// Edge of the map in texels.
    size: u32,
    /// Metres per texel along u and v; for a warped map, in the middle of its receivers.
    texel_m: [f64; 2],
    warped: bool,
    /// Matrix to normalised device coordinates, x right, y up, column after column. Divide by w.
    shadow_from_world: [[f64; 4]; 4],
    /// Matrix to texture coordinates (u right, v as the depth convention has it, in 0..1) and
    /// stored depth in 0..1, column after column. Divide by w.
    texture_from_world: [[f64; 4]; 4],
    /// Casters that are drawn into the map. If empty, nothing casts a shadow here.
    casters: Vec<u32>,
}

/// A shadow caster.
#[derive(Debug, Serialize)]
struct Caster {
    node: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    instance: Option<u32>,
    /// First and last split that the caster is drawn into.
    #[serde(skip_serializing_if = "Option::is_none")]
    split_range: Option<[u8; 2]>,
}

/// Runs the subcommand.
pub fn run(args: &PlanArgs) -> Result<()> {
    let Asked { scene: request, shadows } = Asked::new(&args.scene, &args.shadows)?;
    if let Some(path) = &args.output {
        let inputs: Vec<&Path> = request.inputs().into_iter().chain(args.shadows.file()).collect();
        output::check(&[path], &[], &inputs)?;
    }
    let setup = SceneSetup::open(&request)?;
    let shadows = shadows.for_lights(&setup.lights[..1])?;
    let options = PlannerOptions { image_size: request.size, ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&shadows.config, options)?;
    let receivers: Vec<Aabb> = setup.pose.objects.iter().map(|object| object.bounds).collect();
    let casters: Vec<Aabb> =
        setup.pose.objects.iter().filter(|object| object.casts).map(|object| object.bounds).collect();
    let mut frames = Vec::new();
    for shot in &setup.shots {
        let plan = planner.plan(&shot.view, &shot.shown_light(), &casters, &receivers)?;
        if setup.is_wanted(shot) {
            let report = report(&request, &shadows, &setup, shot, plan, args.depth_convention);
            frames.push((setup.file_number(shot), report));
        }
    }
    match &args.output {
        Some(path) => write(path, &frames),
        None => frames.iter().try_for_each(|(_, frame)| print(&String::from_utf8_lossy(&to_json(frame)?))),
    }
}

fn write(path: &Path, frames: &[(Option<u32>, PlanReport)]) -> Result<()> {
    let mut staged = Staged::default();
    for (number, frame) in frames {
        staged.file(&numbered_file(path, *number), to_json(frame)?)?;
    }
    staged.commit()
}

fn report(
    request: &SceneRequest,
    shadows: &ShadowRequest,
    setup: &SceneSetup,
    shot: &Shot,
    plan: &ShadowPlan,
    convention: DepthConvention,
) -> PlanReport {
    let casters = setup.pose.objects.iter().filter(|object| object.casts).zip(&plan.split_range);
    PlanReport {
        shot: setup.report(request, shot),
        technique: shadows.word("technique"),
        fit: shadows.word("fit"),
        stabilize: shadows.word("stabilize"),
        extent_steps: match shadows.config.stability {
            Stability::Approximate { steps } => Some(steps),
            _ => None,
        },
        bands: shadows.config.selection.metric().to_string(),
        scheme: shadows.word("scheme"),
        warp: warps(&shadows.config),
        depth_convention: convention.to_string(),
        planes_m: plan.planes.clone(),
        view_depth_plane: plan.view_depth_plane.to_array(),
        fade_begin_m: plan.fade_begin,
        splits: (0..plan.splits.len()).map(|i| split(plan, i, convention)).collect(),
        casters: casters
            .map(|(object, range)| Caster {
                node: setup.scene.nodes[object.node].name.clone(),
                instance: object.instance,
                split_range: range.map(|(first, last)| [first, last]),
            })
            .collect(),
        notes: setup.notes.iter().chain(&shadows.notes).cloned().collect(),
    }
}

fn split(plan: &ShadowPlan, index: usize, convention: DepthConvention) -> SplitPlan {
    let split: &Split = &plan.splits[index];
    SplitPlan {
        near_m: split.near,
        far_m: split.far,
        blend_begin_m: split.blend_begin,
        coverage_m: [split.coverage.0, split.coverage.1],
        size: split.size,
        texel_m: split.texel_m.to_array(),
        warped: split.warp.is_some(),
        shadow_from_world: split.shadow_from_world_in(convention).to_cols_array_2d(),
        texture_from_world: split.texture_from_world(convention).to_cols_array_2d(),
        casters: plan.casters(index).to_vec(),
    }
}
