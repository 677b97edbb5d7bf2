//! Every technique, filter, fit, stabilisation and depth format, each in some world: a covering
//! set, not the whole product.

use std::path::Path;

use umbrage::Warp;
use umbrage::config::Filter;
use umbrage_render::Outputs;
use umbrage_scene::procedural::World;
use umbrage_tests::compare::{Golden, compare};
use umbrage_tests::golden::{Goldens, Mode};
use umbrage_tests::stage::{Stage, Technique, gpu};

/// Pixels of a mask.
const MASK_SIZE: [u32; 2] = [160, 120];
/// Pixels of a picture: colours do not pack as well as masks do.
const PICTURE_SIZE: [u32; 2] = [96, 72];
/// Edge of the maps in masks. At [`MASK_SIZE`] larger ones are so exact that techniques look the
/// same.
const MAP: u32 = 256;

/// What is drawn of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Mask,
    Picture,
    /// The picture, coloured by split.
    Tint,
}

/// An image with a reference.
struct Shot {
    name: String,
    world: World,
    camera: &'static str,
    what: What,
    technique: Technique,
}

fn shot(world: World, camera: &'static str, what: What, technique: Technique) -> Shot {
    let kind = match what {
        What::Mask => "mask",
        What::Picture => "picture",
        What::Tint => "tint",
    };
    let name = format!("{}.{camera}.{}.{kind}", world.name(), technique.name);
    Shot { name, world, camera, what, technique }
}

fn shots() -> Vec<Shot> {
    use What::{Mask, Picture, Tint};
    use World::{Chessboard, Knights, MiningTerrain, RobotWar};
    let pssm = |splits| Technique::pssm(splits, MAP);
    let ssm = || Technique::ssm(2 * MAP);
    let default = Technique::default;
    vec![
        // How many splits.
        shot(RobotWar, "near", Mask, ssm()),
        shot(RobotWar, "near", Mask, pssm(2)),
        shot(RobotWar, "near", Mask, pssm(3)),
        shot(RobotWar, "near", Mask, pssm(4)),
        shot(RobotWar, "far", Mask, pssm(4).exact()),
        shot(RobotWar, "dueling", Mask, ssm().exact().filter(Filter::Pcf2)),
        shot(RobotWar, "middle", Picture, default()),
        // Which filter.
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Hard)),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Pcf2)),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Pcf3 { width_m: None })),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Pcf5 { width_m: None })),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Pcf7 { width_m: None })),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Disc { width_m: None, rotated: false })),
        shot(Chessboard, "near", Mask, pssm(2).filter(Filter::Pcss { sun_degrees: 0.53, rotated: false })),
        shot(Chessboard, "far", Mask, pssm(3).exact().filter(Filter::Pcf5 { width_m: None }).blended(0.3, 0.4)),
        shot(Chessboard, "far", Tint, default()),
        // Which fit; leaves with holes.
        shot(Knights, "near", Mask, pssm(4).exact().filter(Filter::Pcf3 { width_m: None })),
        shot(Knights, "middle", Mask, pssm(3)),
        shot(Knights, "middle", Mask, pssm(3).independent()),
        shot(Knights, "dueling", Mask, pssm(4).d16()),
        shot(Knights, "far", Picture, default()),
        // Which warp.
        shot(Knights, "near", Mask, ssm().warped(Warp::Psm)),
        shot(Knights, "near", Mask, ssm().warped(Warp::Lispsm)),
        shot(Knights, "near", Mask, ssm().warped(Warp::Tsm { focus: 0.3 })),
        shot(Knights, "dueling", Mask, pssm(3).warped(Warp::Lispsm)),
        // Ground that casts shadows.
        shot(MiningTerrain, "near", Mask, pssm(4)),
        shot(MiningTerrain, "middle", Mask, ssm().independent()),
        shot(MiningTerrain, "far", Mask, pssm(4).exact().d16().filter(Filter::Pcf3 { width_m: None })),
        shot(MiningTerrain, "dueling", Mask, pssm(4).independent().exact()),
        shot(MiningTerrain, "dueling", Picture, default()),
        shot(RobotWar, "near", Tint, default()),
    ]
}

fn goldens() -> Goldens {
    Goldens {
        references: Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens"),
        failures: Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden-failures"),
        mode: Mode::from_env(),
    }
}

fn draw(shot: &Shot) -> Option<Golden> {
    let stage = Stage::of(shot.world);
    let size = if shot.what == What::Mask { MASK_SIZE } else { PICTURE_SIZE };
    let view = stage.view(shot.camera, size);
    let mut drawer = stage.drawer(gpu()?, &shot.technique, size);
    let outputs = Outputs { mask: shot.what == What::Mask, picture: shot.what != What::Mask, ..Outputs::default() };
    let rendered = drawer.draw(&view, outputs, shot.what == What::Tint);
    Some(match shot.what {
        What::Mask => Golden::Mask(rendered.mask.expect("a mask was asked for")),
        What::Picture | What::Tint => {
            let picture = rendered.picture.expect("a picture was asked for");
            Golden::Picture(image::DynamicImage::ImageRgba8(picture).into_rgb8())
        }
    })
}

/// Compares all images of a world, then says all that is wrong.
fn check(world: World) {
    let goldens = goldens();
    let mut failures = Vec::new();
    for shot in shots().iter().filter(|shot| shot.world == world) {
        let Some(image) = draw(shot) else { return };
        if let Err(failure) = goldens.check(&shot.name, &image) {
            failures.push(failure.to_string());
        }
    }
    assert!(failures.is_empty(), "{} images are not their references:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn robot_war_looks_as_it_did() {
    check(World::RobotWar);
}

#[test]
fn chessboard_looks_as_it_did() {
    check(World::Chessboard);
}

#[test]
fn knights_look_as_they_did() {
    check(World::Knights);
}

#[test]
fn mining_terrain_looks_as_it_did() {
    check(World::MiningTerrain);
}

#[test]
fn references_are_few_small_and_all_used() {
    let (shots, goldens) = (shots(), goldens());
    let names: Vec<&str> = shots.iter().map(|shot| shot.name.as_str()).collect();
    for (i, name) in names.iter().enumerate() {
        assert!(!names[..i].contains(name), "{name} stands twice in the list");
    }
    if goldens.mode == Mode::Bless {
        eprintln!("SKIPPED: the references are being replaced; run the tests again");
        return;
    }
    let complaints = goldens.audit(&names).expect("the folder of references can be read");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// A tolerance that lets one technique pass for another would let any change pass. References of
/// one view, drawn by techniques that should differ there, must differ by more than is tolerated.
#[test]
fn references_tell_techniques_apart() {
    let (shots, goldens) = (shots(), goldens());
    if goldens.mode == Mode::Bless {
        eprintln!("SKIPPED: the references are being replaced; run the tests again");
        return;
    }
    let mut pairs = 0;
    for (i, first) in shots.iter().enumerate() {
        for second in &shots[..i] {
            if (first.world, first.camera, first.what) != (second.world, second.camera, second.what) {
                continue;
            }
            let [a, b] = [first, second].map(|shot| goldens.read(&shot.name).expect("a reference"));
            let verdict = compare(&a, &b).expect("two images of one kind and size");
            assert!(!verdict.is_same(), "{} passes for {}: {verdict}", first.name, second.name);
            pairs += 1;
        }
    }
    assert!(pairs >= 13, "6 pairs of split counts, 6 of filters, 1 of fits, but only {pairs} were compared");
}

/// Pictures tell techniques apart: one hard map in place of four soft ones has to be seen in every
/// one of them.
#[test]
fn pictures_tell_techniques_apart() {
    let goldens = goldens();
    if goldens.mode == Mode::Bless {
        eprintln!("SKIPPED: the references are being replaced; run the tests again");
        return;
    }
    for shot in shots().into_iter().filter(|shot| shot.what == What::Picture) {
        let reference = goldens.read(&shot.name).expect("a reference");
        let other = Shot { technique: Technique::ssm(1024), ..shot };
        let Some(image) = draw(&other) else { return };
        let verdict = compare(&reference, &image).expect("two pictures of one size");
        eprintln!("{} with {}: {verdict}", other.name, other.technique.name);
        assert!(!verdict.is_same(), "{} passes with {}: {verdict}", other.name, other.technique.name);
    }
}
