//! `umbrage render`: writes the picture, the mask, the maps and the report.

use std::path::{Path, PathBuf};

use umbrage::config::SplitMetric;
use umbrage_lab::{
    failure::{Failure, Result},
    notes,
    output::{self, Staged, numbered_file, numbered_folder},
    picture::{png, side_by_side},
    progress,
    report::{Report, to_json},
    scene_request::SceneRequest,
    scene_setup::{SceneSetup, Shot},
    session::{Session, beside_report},
    split_views,
    technique::ShadowRequest,
};
use umbrage_render::{Frame, Outputs, Rendered};

use crate::{
    scene_options::{Asked, SceneOptions},
    shadow_args::ShadowArgs,
};

/// `umbrage render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// Scene, camera, light and time.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Shadows.
    #[command(flatten)]
    pub shadows: ShadowArgs,
    /// Write the picture here (PNG)
    #[arg(short = 'o', long = "output", value_name = "PICTURE", help_heading = "Output")]
    pub picture: Option<PathBuf>,
    /// Write the visibility mask here (PNG, grey and alpha: 255 lit, 0 shadowed, alpha 0 where
    /// nothing was hit)
    #[arg(long, value_name = "MASK", help_heading = "Output")]
    pub visibility: Option<PathBuf>,
    /// With --edges exact, write what triangles decide here (PNG, to be laid over the picture:
    /// yellow lit, blue dark, red left to the filter, transparent where depth decides)
    #[arg(long, value_name = "PICTURE", help_heading = "Output")]
    pub edge_counts: Option<PathBuf>,
    /// Write each split's map into this folder, as pictures
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub maps: Option<PathBuf>,
    /// Write two pictures of each split into this folder: the scene between the split's planes
    /// (planned as a view of its own), and as the light sees it through the split's map
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub split_views: Option<PathBuf>,
    /// Write what was done and what it cost here (JSON)
    #[arg(long, value_name = "JSON", help_heading = "Output")]
    pub report: Option<PathBuf>,
}

/// Runs the subcommand.
pub fn run(args: &RenderArgs) -> Result<()> {
    let Asked { scene: request, shadows } = Asked::new(&args.scene, &args.shadows)?;
    let files: Vec<&Path> = [&args.picture, &args.visibility, &args.edge_counts, &args.report]
        .into_iter()
        .flatten()
        .map(AsRef::as_ref)
        .collect();
    let folders: Vec<&Path> = args.maps.iter().chain(&args.split_views).map(AsRef::as_ref).collect();
    if files.is_empty() && folders.is_empty() {
        return Err(Failure::input(
            "nothing to write: give -o PICTURE, --visibility MASK, --edge-counts PICTURE, --maps DIR, --split-views DIR or \
             --report JSON",
        ));
    }
    let inputs: Vec<&Path> = request.inputs().into_iter().chain(args.shadows.file()).collect();
    output::check(&files, &folders, &inputs)?;

    let setup = SceneSetup::open_views(&request)?;
    check_views(args, &setup, &shadows)?;
    let mut session = Session::open(&request, &shadows, &setup)?;
    // Views of splits are planned one by one and must not disturb what the frames' own maps hold on
    // to.
    let mut beside = args.split_views.as_ref().map(|_| Session::open(&request, &shadows, &setup)).transpose()?;
    let mut staged = Staged::default();
    let bar = progress::steps(setup.shots.len() as u64, "frames");
    for shot in &setup.shots {
        let frames: Vec<Frame<'_>> = shot.views().map(|(_, view)| session.frame(&setup, shot, view)).collect();
        let is_wanted = setup.is_wanted(shot);
        let outputs = if is_wanted { outputs(args) } else { Outputs::default() };
        let mut views = session.renderer.render_views(&frames, shot.shown.as_ref(), outputs)?;
        notes::say(shadows.notes.iter().chain(&views[0].stats.notes));
        let number = setup.file_number(shot);
        if let (Some(path), Some(beside)) = (&args.split_views, &mut beside) {
            let files = split_views::pictures(&mut beside.renderer, &frames[0], &views[0].stats.plan.splits)?;
            if is_wanted {
                staged.folder(&numbered_folder(path, number), files)?;
            }
        }
        if is_wanted {
            stage(args, number, &mut views, &mut staged)?;
            if let Some(path) = &args.report {
                let report = report(&session, &request, &setup, shot, &views);
                staged.file(&numbered_file(path, number), to_json(&report)?)?;
            }
            staged.finish_frame();
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    staged.commit()
}

/// Refuses outputs that are impossible for several views, or for splits by distance.
fn check_views(args: &RenderArgs, setup: &SceneSetup, shadows: &ShadowRequest) -> Result<()> {
    if args.edge_counts.is_some() && !shadows.config.edges.is_exact() {
        return Err(Failure::input("--edge-counts shows what exact edges do; give --edges exact"));
    }
    let has_several = setup.shots.iter().any(|shot| !shot.beside.is_empty());
    if args.maps.is_some() && has_several {
        return Err(Failure::input("--maps and several cameras: maps are of one view; name one --camera"));
    }
    if args.split_views.is_some() && shadows.config.selection.metric() == SplitMetric::Distance {
        return Err(Failure::input(
            "--split-views and --bands radial exclude each other: each picture lies between two planes; give only one of the two",
        ));
    }
    if args.split_views.is_some() && has_several {
        return Err(Failure::input("--split-views and several cameras: splits are of one view; name one --camera"));
    }
    Ok(())
}

fn outputs(args: &RenderArgs) -> Outputs {
    Outputs {
        picture: args.picture.is_some(),
        mask: args.visibility.is_some(),
        maps: args.maps.is_some(),
        edges: args.edge_counts.is_some() || args.report.is_some(),
    }
}

/// Stages pictures, masks and maps of a shot's views.
fn stage(args: &RenderArgs, number: Option<u32>, views: &mut [Rendered], staged: &mut Staged) -> Result<()> {
    let pictures: Vec<_> = views.iter_mut().filter_map(|view| view.picture.take()).collect();
    if let (Some(path), false) = (&args.picture, pictures.is_empty()) {
        staged.file(&numbered_file(path, number), png(&side_by_side(pictures))?)?;
    }
    let masks: Vec<_> = views.iter_mut().filter_map(|view| view.mask.take()).collect();
    if let (Some(path), false) = (&args.visibility, masks.is_empty()) {
        staged.file(&numbered_file(path, number), png(&side_by_side(masks))?)?;
    }
    let edges: Vec<_> = views.iter().filter_map(|view| Some(view.edges.as_ref()?.picture())).collect();
    if let (Some(path), false) = (&args.edge_counts, edges.is_empty()) {
        staged.file(&numbered_file(path, number), png(&side_by_side(edges))?)?;
    }
    if let Some(path) = &args.maps {
        let maps = views[0].maps.iter().enumerate();
        let files = maps.map(|(split, map)| Ok((format!("split{split}.png"), png(map)?))).collect::<Result<_>>()?;
        staged.folder(&numbered_folder(path, number), files)?;
    }
    Ok(())
}

/// Makes the report of a shot: of its first view, with the others beside it.
fn report(session: &Session, request: &SceneRequest, setup: &SceneSetup, shot: &Shot, views: &[Rendered]) -> Report {
    let beside = shot.beside.iter().zip(&views[1..]);
    let beside = beside.map(|((camera, view), of)| beside_report(setup, camera, view, &of.stats)).collect();
    let edges = views[0].edges.as_ref().map(|edges| edges.sums().into());
    Report { beside, edges, ..session.report(request, setup, shot, &views[0].stats) }
}
