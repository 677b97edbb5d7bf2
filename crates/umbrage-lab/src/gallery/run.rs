//! Drawing the gallery: pictures, reports, and the page.

use std::{
    fs,
    path::{Path, PathBuf},
};

use image::DynamicImage;
use umbrage_render::Outputs;

use super::{
    drawn::Drawn,
    page,
    scenes::{Scene, Shot},
};
use crate::{
    failure::{Failure, Result},
    output::Staged,
    picture::png,
    progress,
    report::to_json,
    scene_setup::{self, SceneSetup},
    session::Session,
    technique::text,
};

/// Technique of the gallery: all defaults.
const TECHNIQUE: &str = "pssm:4:1024";

/// Job of drawing a gallery.
#[derive(Debug)]
pub struct Job {
    /// The scenes.
    pub scenes: Vec<&'static Scene>,
    /// Width and height of each picture in pixels.
    pub size: [u32; 2],
    /// Folder of the outputs: `index.html` and the folder `shots`.
    pub folder: PathBuf,
}

/// Draws every shot, then writes the page and, below it, full-size pictures, masks, maps and
/// reports. Returns the path of the page.
///
/// # Errors
/// [`Failure`] with the scene that cannot be drawn or the file that cannot be written.
pub fn run(job: &Job) -> Result<PathBuf> {
    let shots_folder = job.folder.join("shots");
    fs::create_dir_all(&shots_folder).map_err(|error| Failure::file("make", &shots_folder, &error))?;
    let technique = text::parse_all(&[TECHNIQUE.to_owned()], "")?.remove(0);
    let total = job.scenes.iter().map(|scene| scene.shots.len() as u64).sum();
    let bar = progress::steps(total, "shots");
    let mut staged = Staged::default();
    let (mut sections, mut adapter) = (Vec::new(), String::new());
    for scene in &job.scenes {
        let mut drawn = Vec::new();
        let first = scene.request(&scene.shots[0], job.size)?;
        let setup = SceneSetup::open(&first)?;
        let mut session = Session::open(&first, &technique.shadows, &setup)?;
        for shot in scene.shots {
            drawn.push(draw(&mut session, &setup, scene, shot, job.size)?);
            bar.inc(1);
        }
        for of_shot in &drawn {
            let home = shots_folder.join(format!("{}-{}", scene.id, of_shot.shot.name));
            write(&mut staged, &home, of_shot)?;
        }
        adapter = drawn.last().map_or(adapter, |of_shot| of_shot.report.adapter.clone());
        sections.push(page::section(scene, &drawn)?);
    }
    bar.finish_and_clear();
    let index = job.folder.join("index.html");
    staged.file(&index, page::page(&adapter, sections).into_bytes())?;
    staged.commit()?;
    Ok(index)
}

fn draw(
    session: &mut Session,
    setup: &SceneSetup,
    scene: &'static Scene,
    shot: &'static Shot,
    size: [u32; 2],
) -> Result<Drawn> {
    let request = scene.request(shot, size)?;
    let views = scene_setup::frame_views(&request, &setup.scene, &setup.pose, None, &mut Vec::new())?;
    let view = &views[0];
    let of_view = scene_setup::Shot { camera: view.camera.clone(), view: view.view, ..setup.shots[0].clone() };
    // Shots do not follow each other: what earlier ones hold must not show.
    session.renderer.restart();
    let all = Outputs { picture: true, mask: true, maps: true, edges: false };
    let frame = setup.frame(&of_view, &of_view.view, true, false);
    let rendered = session.renderer.render_views(&[frame], of_view.shown.as_ref(), all)?.remove(0);
    session.renderer.restart();
    let tinted = setup.frame(&of_view, &of_view.view, true, true);
    let picture_only = Outputs { picture: true, ..Outputs::default() };
    let tint = session.renderer.render_views(&[tinted], of_view.shown.as_ref(), picture_only)?.remove(0);
    let missing = || Failure::other("the renderer gave no picture");
    Ok(Drawn {
        shot,
        command: scene.command(shot, size),
        report: session.report(&request, setup, &of_view, &rendered.stats),
        picture: rendered.picture.ok_or_else(missing)?,
        tint: tint.picture.ok_or_else(missing)?,
        mask: rendered.mask.ok_or_else(missing)?,
        maps: rendered.maps.into_iter().map(DynamicImage::from).collect(),
    })
}

/// Writes a folder for each shot, in place of that of an earlier run.
fn write(staged: &mut Staged, home: &Path, drawn: &Drawn) -> Result<()> {
    if home.exists() {
        fs::remove_dir_all(home).map_err(|error| Failure::file("replace", home, &error))?;
    }
    let mut files = vec![
        ("picture.png".to_owned(), png(&drawn.picture)?),
        ("tint.png".to_owned(), png(&drawn.tint)?),
        ("mask.png".to_owned(), png(&drawn.mask)?),
        ("report.json".to_owned(), to_json(&drawn.report)?),
    ];
    for (split, map) in drawn.maps.iter().enumerate() {
        files.push((format!("map{split}.png"), png(map)?));
    }
    staged.folder(home, files)
}
