//! `cargo xtask demo`: every world and the city, at near, middle and far, as one page.

use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::{
    adapter, page,
    run::{build_umbrage, root},
};

/// A scene and its shots.
pub struct Section {
    /// For file names and anchors.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// A sentence about the scene.
    pub about: &'static str,
    /// SCENE and the options that all its shots share.
    scene: &'static [&'static str],
    /// What to look at.
    shots: Vec<ShotPlan>,
}

struct ShotPlan {
    name: &'static str,
    caption: &'static str,
    camera: &'static [&'static str],
}

/// A rendered shot: files and the report.
pub struct Shot {
    /// For file names.
    pub name: &'static str,
    /// What to look for.
    pub caption: &'static str,
    /// The command that draws it.
    pub command: String,
    /// The picture.
    pub picture: PathBuf,
    /// The same, coloured by split.
    pub tint: PathBuf,
    /// The visibility mask.
    pub mask: PathBuf,
    /// Each split's map, nearest first.
    pub maps: Vec<PathBuf>,
    /// `render`'s report.
    pub report: Value,
}

/// Renders everything and writes `out/demo/index.html`.
pub fn run() -> Result<()> {
    let umbrage = build_umbrage(true)?;
    let adapter = adapter::ensure(&umbrage)?;
    eprintln!("xtask: drawing with {adapter}");
    let folder = root().join("out/demo");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let sections = sections();
    let total: usize = sections.iter().map(|section| section.shots.len()).sum();
    let mut done = 0;
    let mut drawn = Vec::new();
    for section in sections {
        let mut shots = Vec::new();
        for plan in &section.shots {
            done += 1;
            eprintln!("xtask: {done:>2}/{total} {}, {}", section.title, plan.name);
            shots.push(draw(&umbrage, &folder, &section, plan)?);
        }
        drawn.push((section, shots));
    }
    let index = folder.join("index.html");
    let page = page::html(&adapter, &drawn)?;
    fs::write(&index, page).with_context(|| format!("cannot write {}", index.display()))?;
    eprintln!("xtask: look at it with a browser:");
    print_result(&index);
    Ok(())
}

/// The one line that goes to standard output, so that scripts can use it.
#[expect(clippy::print_stdout, reason = "the result of the command")]
fn print_result(path: &Path) {
    println!("{}", path.display());
}

/// Draws one shot twice: as it is, and coloured by split.
fn draw(umbrage: &Path, folder: &Path, section: &Section, plan: &ShotPlan) -> Result<Shot> {
    let home = folder.join("shots").join(format!("{}-{}", section.id, plan.name));
    if home.exists() {
        fs::remove_dir_all(&home).with_context(|| format!("cannot replace {}", home.display()))?;
    }
    fs::create_dir_all(&home).with_context(|| format!("cannot make {}", home.display()))?;
    let at = |name: &str| home.join(name);
    let view: Vec<&str> = section.scene.iter().chain(plan.camera).copied().collect();
    let render = |outputs: &[OsString]| {
        let mut command = Command::new(umbrage);
        command.current_dir(root()).arg("render").args(&view).args(outputs);
        let output = command.output().context("umbrage did not start")?;
        if !output.status.success() {
            bail!("umbrage render {} failed: {}", view.join(" "), String::from_utf8_lossy(&output.stderr).trim());
        }
        Ok(())
    };
    render(&[
        "-o".into(),
        at("picture.png").into(),
        "--visibility".into(),
        at("mask.png").into(),
        "--maps".into(),
        at("maps").into(),
        "--report".into(),
        at("report.json").into(),
    ])?;
    render(&["--tint".into(), "-o".into(), at("tint.png").into()])?;

    let report = fs::read(at("report.json")).context("cannot read the report")?;
    let mut maps: Vec<PathBuf> =
        fs::read_dir(at("maps"))?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    maps.sort();
    Ok(Shot {
        name: plan.name,
        caption: plan.caption,
        command: format!("umbrage render {} -o picture.png", view.join(" ")),
        picture: at("picture.png"),
        tint: at("tint.png"),
        mask: at("mask.png"),
        maps,
        report: serde_json::from_slice(&report).context("the report is not JSON")?,
    })
}

fn sections() -> Vec<Section> {
    let world = |id, title, about, scene| Section { id, title, about, scene, shots: world_shots() };
    vec![
        world("robot-war", "Robot War", "160 robots, 240,000 triangles, on a plain of 1.44 km².", &["robot-war"]),
        world("chessboard", "Huge Chessboard", "32 chessmen, 51,000 triangles, on 0.49 km².", &["chessboard"]),
        world(
            "knights",
            "Knights",
            "15 dwarfs and 15 knights on the move, 15 trees and 15 cactuses, a million triangles, in 1.6 km² of desert.",
            &["knights"],
        ),
        world(
            "mining-terrain",
            "Mining Terrain",
            "10 clawbots and 15 windmills at work, 20 rocks, 10 trees, 1.3 million triangles, on 2.56 km² of terrain.",
            &["mining-terrain"],
        ),
        Section {
            id: "city",
            title: "City by the sea",
            about: "The track candela_city of SuperTuxKart, © 2014-2017 Jean-Manuel Clémençon, CC-BY-SA-4.0 (these pictures \
                    of it too): 416 nodes, 294,631 triangles, under the sun its author chose.",
            scene: &["assets/city_candela.glb", "--sun", "0.97478,-0.2229,0.01083"],
            shots: vec![
                ShotPlan {
                    name: "near",
                    caption: "A lamp, a tree and the truss, from the pavement.",
                    camera: &["--eye", "-60,-5,-20", "--target", "-110,-9,5"],
                },
                ShotPlan {
                    name: "middle",
                    caption: "The truss's shadow across the square and up the houses.",
                    camera: &["--eye", "-245,-7.9,11", "--target", "-225,-9.5,-4"],
                },
                ShotPlan {
                    name: "far",
                    caption: "Over the roofs to the hills.",
                    camera: &["--eye", "-255,70,-200", "--target", "-120,-10,0"],
                },
                ShotPlan {
                    name: "dueling",
                    caption: "Along the author's driveline, nearly into the light: the case that warped shadow maps cannot do.",
                    camera: &["--eye", "-114.77,-7.95,8.25", "--target", "-134.77,-7.95,8.25"],
                },
            ],
        },
    ]
}

/// Every world has these four cameras.
fn world_shots() -> Vec<ShotPlan> {
    vec![
        ShotPlan { name: "near", caption: "Shadows at arm's length: the first splits.", camera: &["--camera", "near"] },
        ShotPlan {
            name: "middle",
            caption: "Shadows at a hundred metres: the splits' borders lie here.",
            camera: &["--camera", "middle"],
        },
        ShotPlan { name: "far", caption: "Shadows out to the end of the range.", camera: &["--camera", "far"] },
        ShotPlan {
            name: "dueling",
            caption: "Nearly into the light: the case that warped shadow maps cannot do.",
            camera: &["--camera", "dueling"],
        },
    ]
}
