//! Scores may not slip: E, the share of wrong decisions, of a few techniques at fixed settings in
//! every world.

use std::sync::OnceLock;

use image::GrayAlphaImage;
use umbrage_scene::procedural::World;
use umbrage_tests::judge::{Ceiling, Judged, pooled};
use umbrage_tests::stage::{Stage, Technique, gpu};
use umbrage_truth::scores::{LEAST_EDGES, MisShadowed};

/// Pixels of a judged view.
const SIZE: [u32; 2] = [200, 150];
/// The views of each world; their decisions are scored as one.
const CAMERAS: [&str; 4] = ["near", "middle", "far", "dueling"];
/// The view rule (at least [`LEAST_EDGES`] edge pixels) is meant for 800 × 600; edges are lines, so
/// a picture of a quarter of the width has a quarter of them.
const LEAST_EDGES_HERE: usize = LEAST_EDGES / 4;
/// How many of [`CAMERAS`] must satisfy the view rule in each world, lest the scores speak of
/// nothing.
const LEAST_VIEWS: usize = 3;

/// Share of pixels that the judge sees and the renderer leaves empty: those whose centre lies on a
/// silhouette before the sky. Measured: 2 pixels in the four views of Robot War.
const MISSING: f64 = 0.001;

/// E in one world of each of [`techniques`], in their order.
struct Ceilings {
    world: World,
    pssm4: Ceiling,
    pssm4_exact: Ceiling,
    pssm3: Ceiling,
    ssm: Ceiling,
}

/// What was measured, with the room of [`Ceiling::ROOM`] above it. Where a score becomes better,
/// lower it; where one must become worse, the commit says why. The tests print the numbers of
/// today; nothing changes these but a person.
const CEILINGS: [Ceilings; 4] = [
    Ceilings {
        world: World::RobotWar,
        pssm4: Ceiling::above(0.00547),
        pssm4_exact: Ceiling::above(0.01211),
        pssm3: Ceiling::above(0.00631),
        ssm: Ceiling::above(0.01564),
    },
    Ceilings {
        world: World::Chessboard,
        pssm4: Ceiling::above(0.00214),
        pssm4_exact: Ceiling::above(0.00532),
        pssm3: Ceiling::above(0.00221),
        ssm: Ceiling::above(0.00258),
    },
    Ceilings {
        world: World::Knights,
        pssm4: Ceiling::above(0.01037),
        pssm4_exact: Ceiling::above(0.01602),
        pssm3: Ceiling::above(0.01104),
        ssm: Ceiling::above(0.01471),
    },
    Ceilings {
        world: World::MiningTerrain,
        pssm4: Ceiling::above(0.00946),
        pssm4_exact: Ceiling::above(0.01558),
        pssm3: Ceiling::above(0.01127),
        ssm: Ceiling::above(0.01647),
    },
];

/// The judged techniques: all with one nearest texel, no blend, no fade.
fn techniques() -> [Technique; 4] {
    [Technique::pssm(4, 512), Technique::pssm(4, 512).exact(), Technique::pssm(3, 512), Technique::ssm(1024)]
}

/// What a world scored: one entry per technique.
struct Scores {
    scores: [MisShadowed; 4],
    /// PSSM(4) again, its masks moved by a pixel: what every ceiling has to refuse.
    shifted: MisShadowed,
    views_that_count: usize,
}

/// Draws and judges a world when it is first asked for.
fn scores(world: World) -> Option<&'static Scores> {
    static SCORES: [OnceLock<Option<Scores>>; 4] = [const { OnceLock::new() }; 4];
    let index = World::PAPER.iter().position(|&other| other == world).expect("all worlds are in the list");
    SCORES[index].get_or_init(|| measure(world)).as_ref()
}

fn measure(world: World) -> Option<Scores> {
    let gpu = gpu()?;
    let stage = Stage::of(world);
    let views = Judged::views(stage, &CAMERAS, SIZE);
    let masks = techniques().map(|technique| {
        let mut drawer = stage.drawer(gpu, &technique, SIZE);
        views.iter().map(|judged| drawer.mask(&judged.view)).collect::<Vec<_>>()
    });
    let score = |masks: &[GrayAlphaImage]| pooled(views.iter().zip(masks).map(|(judged, mask)| judged.score(mask)));
    let shifted: Vec<GrayAlphaImage> = masks[0].iter().map(shifted_by_a_pixel).collect();
    let scores = masks.each_ref().map(|masks| score(masks));
    let edges: Vec<usize> = views.iter().map(|judged| judged.domain.edges().len()).collect();
    eprintln!(
        "{}: |B*| {edges:?}, E {:.5?}, moved by a pixel {:.5}",
        world.name(),
        scores.map(|score| score.rate()),
        score(&shifted).rate()
    );
    Some(Scores {
        shifted: score(&shifted),
        scores,
        views_that_count: views.iter().filter(|judged| judged.domain.edges().len() >= LEAST_EDGES_HERE).count(),
    })
}

fn shifted_by_a_pixel(mask: &GrayAlphaImage) -> GrayAlphaImage {
    GrayAlphaImage::from_fn(mask.width(), mask.height(), |x, y| *mask.get_pixel(x.saturating_sub(1), y))
}

fn check(world: World) {
    let Some(scores) = scores(world) else { return };
    assert!(
        scores.views_that_count >= LEAST_VIEWS,
        "only {} views of {} have edges enough to be judged by",
        scores.views_that_count,
        world.name()
    );
    let Ceilings { pssm4, pssm4_exact, pssm3, ssm, .. } = *of(world);
    let all = [pssm4, pssm4_exact, pssm3, ssm];
    let mut failures = Vec::new();
    for ((technique, ceiling), score) in techniques().iter().zip(all).zip(&scores.scores) {
        if let Err(exceeded) = ceiling.check(score) {
            failures.push(format!("{}: {exceeded}", technique.name));
        }
        let missing = score.missing as f64 / score.pixels as f64;
        assert!(missing <= MISSING, "{}: {} pixels have no answer", technique.name, score.missing);
    }
    assert!(failures.is_empty(), "{}:\n{}", world.name(), failures.join("\n"));
    let answer = pssm4.check(&scores.shifted);
    assert!(answer.is_err(), "{}: shadows that are a pixel aside pass, E {:.5}", world.name(), scores.shifted.rate());
}

fn of(world: World) -> &'static Ceilings {
    CEILINGS.iter().find(|ceilings| ceilings.world == world).expect("every world has ceilings")
}

#[test]
fn robot_war_is_as_right_as_it_was() {
    check(World::RobotWar);
}

#[test]
fn chessboard_is_as_right_as_it_was() {
    check(World::Chessboard);
}

#[test]
fn knights_are_as_right_as_they_were() {
    check(World::Knights);
}

#[test]
fn mining_terrain_is_as_right_as_it_was() {
    check(World::MiningTerrain);
}

/// PSSM(3;512²), three quarters of the memory of SSM(1024²), has at most this share of its error in
/// Robot War: what first light promised. Measured: 0.40.
const PSSM3_OF_SSM_ROBOT_WAR: f64 = 0.5;
/// Error of three splits over that of one map, over all worlds, measured: 0.625, with the room of
/// [`Ceiling::ROOM`]. It is not 0.5: Huge Chessboard has 0.86, Knights 0.75, Mining Terrain 0.68.
const PSSM3_OF_SSM: f64 = 0.72;

/// How techniques stand to each other, which is what the papers claim.
#[test]
fn techniques_keep_their_order() {
    let Some(all) = World::PAPER.into_iter().map(scores).collect::<Option<Vec<_>>>() else { return };
    let rates = |worlds: &[&Scores]| {
        [0, 1, 2, 3].map(|technique| pooled(worlds.iter().map(|scores| scores.scores[technique])).rate())
    };
    let robot_war =
        World::PAPER.iter().position(|&world| world == World::RobotWar).expect("all worlds are in the list");
    for (name, worlds, most) in
        [("robot-war", &all[robot_war..=robot_war], PSSM3_OF_SSM_ROBOT_WAR), ("all worlds", &all[..], PSSM3_OF_SSM)]
    {
        let [pssm4, pssm4_exact, pssm3, ssm] = rates(worlds);
        let numbers = format!("{name}: PSSM(4) {pssm4:.5}, exact {pssm4_exact:.5}, PSSM(3) {pssm3:.5}, SSM {ssm:.5}");
        eprintln!("{numbers}; PSSM(3) / SSM = {:.3}", pssm3 / ssm);
        assert!(pssm3 <= most * ssm, "PSSM(3) should have at most {most} of SSM's error; {numbers}");
        assert!(pssm4 < pssm3, "a split more is better; {numbers}");
        assert!(pssm4 < pssm4_exact, "stillness has its price; {numbers}");
    }
}
