//! The world "City Blocks": up to a million buildings on a grid of streets, high in the middle.

use glam::{DVec2, DVec3, dvec3};

use super::super::World;
use super::super::maths::{Random, mix, scramble, smoothstep};
use super::super::noise;
use super::super::sculpt::Sculpture;
use super::super::shapes::Solid;
use super::super::stage::{SkyPoint, Stage};
use super::super::terrain::{Surface, Terrain};
use super::super::worlds::{stage, standing};
use super::buildings::{self, KINDS, Style};
use super::trees::{Paints, Tree};
use super::{Crowd, Watch};
use crate::{Node, Scene, Trs};

/// Number of buildings of the whole city.
pub(in super::super) const BUILDINGS: u32 = 100_000;

/// Metres of a block between its pavements' edges, along x and z, and of the streets between.
const BLOCK_M: [f64; 2] = [132.0, 72.6];
const STREETS_M: [f64; 2] = [20.0, 14.0];

/// Metres of pavement in front of houses.
const PAVEMENT_M: f64 = 3.0;

/// Height of a pavement over the street in metres.
const KERB_M: f64 = 0.16;

/// Number of blocks of which one is a park.
const PARKS: u64 = 23;

/// Meshes and crowds that make up a city.
struct City {
    buildings: Crowd,
    trees: Crowd,
    pavements: Vec<Trs>,
    lawns: Vec<Trs>,
}

/// Builds a city of `count` buildings, block after block from the middle outwards.
pub(in super::super) fn city_blocks(count: u32, watch: Watch<'_>) -> Scene {
    let mut stage = stage(World::CityBlocks);
    let meshes = (0..KINDS.len()).map(|kind| buildings::store(&mut stage, kind)).collect();
    let paints = Paints::new(&mut stage);
    let trees = [(Tree::Oak, 4), (Tree::Birch, 6)].map(|(tree, seed)| tree.levels(seed, paints).store(&mut stage));
    let mut city = City {
        buildings: Crowd::new("buildings", meshes),
        trees: Crowd::new("trees", trees.to_vec()),
        pavements: Vec::new(),
        lawns: Vec::new(),
    };
    let mut built = 0;
    let mut reach: f64 = 0.0;
    for (column, row) in outwards(count) {
        if built == count {
            break;
        }
        let seed = scramble((column as u64) << 32 ^ (row as u64 & 0xFFFF_FFFF));
        let middle = DVec2::new(f64::from(column) * pitch(0), f64::from(row) * pitch(1));
        let slab = Trs { translation: dvec3(middle.x, 0.0, middle.y), ..Trs::IDENTITY };
        reach = reach.max(middle.abs().max_element());
        // The block that all cameras look at is the park.
        if seed.is_multiple_of(PARKS) || (column, row) == (0, 0) {
            city.lawns.push(slab);
            park(&mut city.trees, middle, seed);
        } else {
            city.pavements.push(slab);
            built += block(&mut city.buildings, middle, seed, count - built);
        }
        watch(built as f32 / count as f32);
    }
    ground(&mut stage, reach + 600.0);
    for (name, places, colour) in [("pavement", city.pavements, 0x9C_98_92), ("lawn", city.lawns, 0x5A_64_3C)] {
        let paint = stage.paint(name, colour);
        let mut slab = Sculpture::default();
        slab.add(paint, 30.0, &Solid::cuboid([BLOCK_M[0], 2.0 * KERB_M, BLOCK_M[1]]));
        let mesh = Some(stage.mesh(slab.finish(name)));
        if !places.is_empty() {
            stage.node(Node { name: name.into(), mesh, instances: places, cast_shadow: false, ..Node::default() });
        }
    }
    city.buildings.place(&mut stage);
    city.trees.place(&mut stage);
    cameras(&mut stage);
    stage.scene
}

/// Returns the metres from one block's middle to the next, along x (0) or z (1).
fn pitch(axis: usize) -> f64 {
    BLOCK_M[axis] + STREETS_M[axis]
}

/// Lists blocks by their distance from the middle, more than `count` buildings need.
fn outwards(count: u32) -> Vec<(i32, i32)> {
    // At least eight buildings to a block, and half as many blocks again for parks.
    let area = (f64::from(count) / 8.0 * 1.5 + 40.0) * pitch(0) * pitch(1);
    let radius = (area / std::f64::consts::PI).sqrt();
    let [columns, rows] = [0, 1].map(|axis| (radius / pitch(axis)).ceil() as i32);
    let mut blocks: Vec<(i32, i32)> =
        (-rows..=rows).flat_map(|row| (-columns..=columns).map(move |column| (column, row))).collect();
    let squared = |&(column, row): &(i32, i32)| {
        libm::pow(f64::from(column) * pitch(0), 2.0) + libm::pow(f64::from(row) * pitch(1), 2.0)
    };
    blocks.sort_by(|a, b| squared(a).total_cmp(&squared(b)).then(a.cmp(b)));
    blocks
}

/// Chooses the style of a building by its distance from the middle.
fn style_at(place: DVec2, random: &mut Random) -> Style {
    let away = place.length() * (1.0 + 0.5 * noise::plane_octaves(81, place / 700.0, 3, 0.5));
    let draw = random.between(0.0, 1.0);
    let downtown = smoothstep(1100.0, 350.0, away);
    let town = smoothstep(2600.0, 1200.0, away);
    if draw < 0.5 * downtown {
        if random.between(0.0, 1.0) < 0.35 { Style::Glass } else { Style::Tower }
    } else if draw < 0.12 * town + 0.5 * downtown + 0.02 {
        Style::Office
    } else if draw < mix(0.25, 1.0, town) {
        Style::Apartments
    } else {
        Style::House
    }
}

/// Adds two rows of houses, back to back, and returns their number.
fn block(crowd: &mut Crowd, middle: DVec2, seed: u64, most: u32) -> u32 {
    let mut random = Random::new(seed);
    let mut built = 0;
    let styles: Vec<Style> = (0..2).map(|_| style_at(middle, &mut random)).collect();
    for (side, style) in [1.0, -1.0].into_iter().zip(styles) {
        let mut at = -0.5 * BLOCK_M[0] + PAVEMENT_M;
        loop {
            let own = if random.between(0.0, 1.0) < 0.7 { style } else { style_at(middle, &mut random) };
            let kinds: Vec<usize> = buildings::of_style(own).collect();
            let kind = kinds[random.index(kinds.len())];
            let [width, depth] = KINDS[kind].size;
            if at + width > 0.5 * BLOCK_M[0] - PAVEMENT_M || built == most {
                break;
            }
            let front = 0.5 * BLOCK_M[1] - PAVEMENT_M - random.between(0.0, 1.5) - 0.5 * depth;
            let yaw = if side > 0.0 { 0.0 } else { 180.0 };
            let place = dvec3(middle.x + at + 0.5 * width, KERB_M, middle.y + side * front);
            crowd.add(kind, standing(place, yaw, 1.0));
            built += 1;
            at += width + if random.between(0.0, 1.0) < 0.25 { random.between(2.0, 7.0) } else { 0.0 };
        }
    }
    built
}

/// Adds trees on a lawn.
fn park(trees: &mut Crowd, middle: DVec2, seed: u64) {
    let mut random = Random::new(seed);
    for step in 0..46 {
        let share = f64::from(step) * DVec2::new(0.754_877_666_246_693, 0.569_840_290_998_053);
        let at = (share - share.floor() - 0.5) * DVec2::new(BLOCK_M[0] - 10.0, BLOCK_M[1] - 10.0);
        // A meadow stays free.
        if at.length() < 15.0 {
            continue;
        }
        let place = dvec3(middle.x + at.x, KERB_M, middle.y + at.y);
        let kind = random.index(trees.kinds());
        trees.add(kind, standing(place, random.between(0.0, 360.0), random.between(0.7, 1.15)));
    }
}

/// Adds asphalt under the city, and grass beyond.
fn ground(stage: &mut Stage, reach: f64) {
    let asphalt = stage.paint("streets", 0xFF_FF_FF);
    let tint = |at: DVec3, _: DVec3| {
        let worn = 0.5 + 0.5 * noise::plane_octaves(82, DVec2::new(at.x, at.z) / 90.0, 2, 0.5);
        [0.070, 0.072, 0.076].map(|channel: f64| (channel * mix(0.85, 1.2, worn)) as f32)
    };
    let surface = Surface { material: asphalt, tint: Some(&tint), cast_shadow: false };
    Terrain::new((2.0 * reach).ceil(), 8, 8, |_| 0.0).place(stage, &surface);
}

/// Adds cameras that look down the streets and over the roofs.
fn cameras(stage: &mut Stage) {
    stage.sun(SkyPoint { bearing: 52.0, elevation: 38.0 }, SkyPoint { bearing: 120.0, elevation: 62.0 });
    let street = 0.5 * pitch(1);
    stage.camera("near", dvec3(-58.0, 2.0, street + 1.0), dvec3(40.0, 12.0, street - 18.0));
    stage.camera("middle", dvec3(-72.0, 18.0, 47.0), dvec3(20.0, 9.0, -12.0));
    stage.camera("far", dvec3(-420.0, 150.0, 520.0), dvec3(0.0, 50.0, 0.0));
    stage.camera("dueling", dvec3(-240.0, 12.0, street), dvec3(60.0, 30.0, street - 6.0));
    stage.camera("aerial", dvec3(-900.0, 560.0, 1150.0), dvec3(60.0, 0.0, -80.0));
}
