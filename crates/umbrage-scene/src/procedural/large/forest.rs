//! The world "Forest": up to millions of trees on mountains.

use glam::{DVec2, DVec3, dvec3};

use super::super::World;
use super::super::maths::{Random, mix, scramble, smoothstep};
use super::super::noise;
use super::super::stage::{SkyPoint, Stage};
use super::super::terrain::{Surface, Terrain};
use super::super::worlds::{stage, standing};
use super::trees::{Paints, Tree};
use super::{Crowd, Watch};
use crate::{Scene, Trs};

/// Number of trees of the whole forest.
pub(in super::super) const TREES: u32 = 1_000_000;

/// Edge of the ground under [`TREES`] trees in metres: 100 km².
const EDGE_M: f64 = 10_000.0;

/// Least edge of the ground in metres.
const LEAST_EDGE_M: f64 = 800.0;

/// Metres between the posts of the ground.
const POST_M: f64 = 20.0;

/// Edge in metres of the squares that are planted one after the other. The plants of a square
/// depend on its place and its number of trees alone.
const SQUARE_M: f64 = 100.0;

/// Number of places that are tried for a tree before an unsuitable one is taken.
const TRIES: usize = 40;

/// Density below which a place is the forest's edge, where trees that like light stand.
const EDGE_OF_FOREST: f64 = 0.45;

/// Builds a forest of `trees` trees, as dense as the whole one, on as much ground as they need.
pub(in super::super) fn forest(trees: u32, watch: Watch<'_>) -> Scene {
    let edge = (EDGE_M * (f64::from(trees) / f64::from(TREES)).sqrt()).max(LEAST_EDGE_M);
    let mut stage = stage(World::Forest);
    let cells = 25;
    let tiles = ((edge / POST_M / cells as f64).round() as usize).max(1);
    let terrain = Terrain::new(edge.ceil(), tiles, cells, |place| height(place, edge));
    let soil = stage.paint("forest floor", 0xFF_FF_FF);
    terrain.place(&mut stage, &Surface { material: soil, tint: Some(&soil_colour), cast_shadow: true });

    let paints = Paints::new(&mut stage);
    let meshes = Tree::FOREST.map(|(tree, seed)| tree.levels(seed, paints).store(&mut stage));
    let mut crowd = Crowd::new("trees", meshes.to_vec());
    plant(&mut crowd, &terrain, (edge, trees), watch);
    crowd.place(&mut stage);
    cameras(&mut stage, &terrain);
    stage.scene
}

/// Plants square after square, each with its share of the trees.
fn plant(crowd: &mut Crowd, terrain: &Terrain, (edge, trees): (f64, u32), watch: Watch<'_>) {
    let across = (edge / SQUARE_M).ceil() as usize;
    let square_m = edge / across as f64;
    let corner = |index: usize| {
        let at = DVec2::new((index % across) as f64, (index / across) as f64);
        at * square_m - DVec2::splat(0.5 * edge)
    };
    let samples = [0.1, 0.37, 0.63, 0.9];
    let weight = |index: usize| -> f64 {
        let at = |u: f64, v: f64| density(terrain, corner(index) + square_m * DVec2::new(u, v));
        samples.iter().flat_map(|&u| samples.map(|v| at(u, v))).sum::<f64>() + 1e-6
    };
    let weights: Vec<f64> = (0..across * across).map(weight).collect();
    let all: f64 = weights.iter().sum();
    let (mut below, mut planted) = (0.0, 0_u32);
    for (index, weight) in weights.iter().enumerate() {
        below += weight;
        // Rounded sums, not sums of rounded shares: the last square ends with the last tree.
        let due = if index + 1 == weights.len() { trees } else { (f64::from(trees) * (below / all)).round() as u32 };
        plant_square(crowd, terrain, (corner(index), square_m), (scramble(index as u64), due - planted));
        planted = due;
        if index % 32 == 0 {
            watch(index as f32 / weights.len() as f32);
        }
    }
}

/// Plants `count` trees in a square. Their places follow the sequence of the plastic number, so
/// that they keep apart.
fn plant_square(crowd: &mut Crowd, terrain: &Terrain, (corner, square_m): (DVec2, f64), (seed, count): (u64, u32)) {
    let mut random = Random::new(seed);
    let begin = DVec2::new(random.between(0.0, 1.0), random.between(0.0, 1.0));
    let mut step = 0.0;
    for _ in 0..count {
        let mut found = (corner, 1.0);
        for _ in 0..TRIES {
            step += 1.0;
            let at = begin + step * DVec2::new(0.754_877_666_246_693, 0.569_840_290_998_053);
            let place = corner + square_m * (at - at.floor());
            found = (place, density(terrain, place));
            if random.between(0.0, 1.0) < found.1 {
                break;
            }
        }
        let (kind, tree) = tree_at(terrain, found, &mut random);
        crowd.add(kind, tree);
    }
}

/// Chooses the kind and the transform of the tree at a place.
fn tree_at(terrain: &Terrain, (place, density): (DVec2, f64), random: &mut Random) -> (usize, Trs) {
    let at = terrain.on_ground(place);
    let high = smoothstep(60.0, 240.0, at.y + 60.0 * noise::plane_octaves(74, place / 300.0, 2, 0.5));
    let draw = random.between(0.0, 1.0);
    // In the order of `Tree::FOREST`.
    let kind = if density < EDGE_OF_FOREST && draw < 0.4 {
        5
    } else if random.between(0.0, 1.0) < high {
        if draw < 0.8 { usize::from(draw < 0.4) } else { 2 }
    } else if draw < 0.62 {
        3 + usize::from(draw < 0.3)
    } else if draw < 0.75 {
        5
    } else {
        usize::from(draw < 0.9)
    };
    let size = random.between(0.62, 1.18) * mix(1.0, 0.6, smoothstep(280.0, 420.0, at.y));
    let mut tree = standing(dvec3(at.x, at.y, at.z), random.between(0.0, 360.0), size);
    tree.scale.y *= random.between(0.9, 1.2);
    (kind, tree)
}

/// Returns the density of trees at a place, 0 to 1. Clearings, scree and heights stay free.
fn density(terrain: &Terrain, place: DVec2) -> f64 {
    let at = terrain.on_ground(place);
    let treeline = smoothstep(470.0, 330.0, at.y + 90.0 * noise::plane_octaves(76, place / 240.0, 2, 0.5));
    wooded(place) * treeline * smoothstep(1.15, 0.75, steepness(terrain, place))
}

/// Returns 0 in clearings, one of which is the middle of the ground, and 1 in the wood.
fn wooded(place: DVec2) -> f64 {
    let open = smoothstep(35.0, 60.0, place.length());
    open * smoothstep(-0.26, -0.02, noise::plane_octaves(75, place / 330.0, 3, 0.5))
}

/// Returns the slope of the ground in metres up per metre along.
fn steepness(terrain: &Terrain, place: DVec2) -> f64 {
    const STEP_M: f64 = 8.0;
    let inside = |p: DVec2| terrain.height_at(terrain.nearest(p));
    let rise = |step: DVec2| (inside(place + step) - inside(place - step)) / (2.0 * STEP_M);
    rise(DVec2::X * STEP_M).hypot(rise(DVec2::Y * STEP_M))
}

/// Returns the height of a valley between mountains, which rise to the rim of the whole forest's
/// ground.
fn height(place: DVec2, edge: f64) -> f64 {
    let rolling = 46.0 * noise::plane_octaves(71, place / 780.0, 4, 0.42);
    let ridges = 1.0 - 2.0 * noise::plane_octaves(72, place / 2300.0, 5, 0.48).abs();
    let away = smoothstep(500.0, 0.5 * EDGE_M.max(edge), place.length());
    let bumps = 0.9 * noise::plane_octaves(73, place / 46.0, 2, 0.5);
    rolling + bumps + mix(0.0, 620.0, away) * (ridges - 0.25).max(-0.2)
}

/// Colour of the soil: grass, needles under trees, rock where it is steep, and bare heights.
fn soil_colour(at: DVec3, normal: DVec3) -> [f32; 3] {
    let place = DVec2::new(at.x, at.z);
    let patch = 0.5 + 0.7 * noise::plane_octaves(77, place / 60.0, 3, 0.55);
    let forest = wooded(place);
    let rock = smoothstep(0.80, 0.66, normal.y).max(smoothstep(360.0, 500.0, at.y));
    let channel = |i: usize| {
        let grass = mix([0.170, 0.240, 0.060][i], [0.330, 0.310, 0.110][i], patch);
        let litter = mix([0.070, 0.060, 0.030][i], [0.060, 0.075, 0.025][i], patch);
        let stone = mix([0.190, 0.180, 0.170][i], [0.300, 0.285, 0.265][i], patch);
        mix(mix(grass, litter, 0.75 * forest), stone, rock) as f32
    };
    std::array::from_fn(channel)
}

/// Adds the cameras. The middle of the ground is a clearing.
fn cameras(stage: &mut Stage, terrain: &Terrain) {
    stage.sun(SkyPoint { bearing: 158.0, elevation: 27.0 }, SkyPoint { bearing: 100.0, elevation: 55.0 });
    let above = |x: f64, z: f64, height: f64| terrain.on_ground(DVec2::new(x, z)) + DVec3::Y * height;
    stage.camera("near", above(-14.0, 20.0, 2.2), above(44.0, -46.0, 9.0));
    stage.camera("middle", above(-40.0, 60.0, 26.0), above(60.0, -140.0, 4.0));
    stage.camera("far", above(-150.0, 230.0, 75.0), above(120.0, -330.0, 6.0));
    stage.camera("dueling", above(46.0, 16.0, 3.0), above(-60.0, -27.0, 12.0));
    stage.camera("aerial", above(-280.0, 330.0, 260.0), above(60.0, -60.0, 0.0));
}
