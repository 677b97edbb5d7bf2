//! The world "Thicket": a dense wood whose foliage is cards with holes, merged by material as
//! exporters merge it.
//!
//! It is not from the paper. It is hard for a renderer: a million small triangles, more than half
//! of them alpha-tested, and 152 materials, each spread all over the wood, so that no object is
//! near or far.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec2, DVec3, dvec3};

use super::World;
use super::leaves::{Leaf, leaf_texture};
use super::maths::{Random, mix, sin_cos, turn};
use super::noise;
use super::sculpt::Sculpture;
use super::shapes::{Solid, ribbed};
use super::stage::{SkyPoint, Stage};
use super::terrain::{Surface, Terrain};
use super::worlds::{stage, standing};
use crate::{AlphaMode, Material, Mesh, Primitive, Scene, Trs};

const EDGE_M: f64 = 120.0;

/// Habit of a plant's growth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Habit {
    Broadleaf,
    Conifer,
    Shrub,
    Fern,
}

/// Number of tints of a species' foliage; each is a material.
const TINTS: usize = 4;
/// Number of models of a species. Plants are copies of them, turned and scaled.
const MODELS: u64 = 2;

/// Species: habit, leaf, and number of plants in the wood.
const SPECIES: [(Habit, Leaf, usize); 22] = [
    (Habit::Broadleaf, Leaf::Oval, 11),
    (Habit::Broadleaf, Leaf::Lobed, 11),
    (Habit::Broadleaf, Leaf::Round, 11),
    (Habit::Broadleaf, Leaf::Lance, 11),
    (Habit::Broadleaf, Leaf::Oval, 11),
    (Habit::Broadleaf, Leaf::Lobed, 11),
    (Habit::Broadleaf, Leaf::Round, 11),
    (Habit::Broadleaf, Leaf::Lance, 11),
    (Habit::Conifer, Leaf::Needles, 16),
    (Habit::Conifer, Leaf::Scales, 16),
    (Habit::Conifer, Leaf::Needles, 16),
    (Habit::Conifer, Leaf::Scales, 16),
    (Habit::Conifer, Leaf::Needles, 16),
    (Habit::Shrub, Leaf::Oval, 40),
    (Habit::Shrub, Leaf::Round, 40),
    (Habit::Shrub, Leaf::Lance, 40),
    (Habit::Shrub, Leaf::Lobed, 40),
    (Habit::Shrub, Leaf::Oval, 40),
    (Habit::Fern, Leaf::Pinnate, 150),
    (Habit::Fern, Leaf::Pinnate, 150),
    (Habit::Fern, Leaf::Lance, 150),
    (Habit::Fern, Leaf::Pinnate, 150),
];

/// Materials of one species.
#[derive(Clone, Copy, Debug)]
struct Colours {
    bark: usize,
    twig: usize,
    foliage: [usize; TINTS],
}

/// Builds the world.
pub(super) fn thicket() -> Scene {
    let mut stage = stage(World::Thicket);
    let mut random = Random::new(152);
    let terrain = Terrain::new(EDGE_M, 4, 20, ground_height);
    let litter = stage.paint("leaf litter", 0xFF_FF_FF);
    terrain.place(&mut stage, &Surface { material: litter, tint: Some(&litter_colour), cast_shadow: true });
    let textures = leaf_textures(&mut stage);

    let mut wood = Wood::default();
    for (index, &(habit, leaf, count)) in SPECIES.iter().enumerate() {
        let colours = colours(&mut stage, index, textures[leaf as usize], &mut random);
        let models: Vec<Mesh> = (0..MODELS).map(|model| plant(habit, 1000 * index as u64 + model, colours)).collect();
        for _ in 0..count {
            let reach = 0.5 * EDGE_M - 1.0;
            let place = DVec2::new(random.between(-reach, reach), random.between(-reach, reach));
            let at = dvec3(place.x, terrain.lowest_around(place, 0.3), place.y);
            let trs = standing(at, random.between(0.0, 360.0), random.between(0.75, 1.25));
            wood.add(&models[random.index(models.len())], trs);
        }
    }
    for index in 0..19_u64 {
        let grey = 0x60_60_58 + 0x04_03_03 * index as u32;
        let material = stage.paint(&format!("boulder {index}"), grey);
        let model = boulder(700 + index, material);
        for _ in 0..3 {
            let reach = 0.5 * EDGE_M - 3.0;
            let place = DVec2::new(random.between(-reach, reach), random.between(-reach, reach));
            let size = random.between(0.5, 1.6);
            let at = dvec3(place.x, terrain.lowest_around(place, 0.5 * size) + 0.35 * size, place.y);
            wood.add(&model, standing(at, random.between(0.0, 360.0), size));
        }
    }
    wood.place(&mut stage);

    stage.sun(SkyPoint { bearing: 40.0, elevation: 48.0 }, SkyPoint { bearing: 130.0, elevation: 66.0 });
    let above = |x: f64, z: f64, height: f64| terrain.on_ground(DVec2::new(x, z)) + DVec3::Y * height;
    stage.camera("near", above(-8.0, 12.0, 1.7), above(9.0, -14.0, 2.0));
    stage.camera("middle", above(-46.0, 44.0, 6.0), above(0.0, 0.0, 4.0));
    stage.camera("far", above(-58.0, 58.0, 24.0), above(10.0, -10.0, 4.0));
    stage.camera("dueling", above(-35.0, 30.0, 1.7), above(0.0, 0.0, 9.0));
    stage.camera("aerial", dvec3(-40.0, 75.0, 85.0), dvec3(0.0, 4.0, 0.0));
    stage.scene
}

fn ground_height(place: DVec2) -> f64 {
    3.0 * noise::plane_octaves(61, place / 45.0, 3, 0.45) + 0.15 * noise::plane_octaves(62, place / 4.0, 2, 0.5)
}

/// Colour of the litter: brown leaves, with moss in patches.
fn litter_colour(at: DVec3, _normal: DVec3) -> [f32; 3] {
    let moss = (0.5 + noise::plane_octaves(63, DVec2::new(at.x, at.z) / 9.0, 3, 0.5)).clamp(0.0, 1.0);
    let mixed = |channel: usize| mix([0.24, 0.16, 0.09][channel], [0.13, 0.18, 0.05][channel], moss) as f32;
    std::array::from_fn(mixed)
}

/// Makes one texture for each kind of leaf.
fn leaf_textures(stage: &mut Stage) -> Vec<usize> {
    let textures = &mut stage.scene.textures;
    textures.extend(Leaf::ALL.map(leaf_texture));
    (0..textures.len()).collect()
}

fn colours(stage: &mut Stage, species: usize, texture: usize, random: &mut Random) -> Colours {
    let shade = |random: &mut Random, from: [f64; 3], to: [f64; 3]| {
        let share = random.between(0.0, 1.0);
        [0, 1, 2].map(|channel| mix(from[channel], to[channel], share) as f32)
    };
    let mut wood = |stage: &mut Stage, part: &str| {
        let [red, green, blue] = shade(random, [0.10, 0.065, 0.04], [0.24, 0.20, 0.15]);
        stage.material(Material {
            name: format!("{part} {species}"),
            base_color: [red, green, blue, 1.0],
            ..Material::default()
        })
    };
    let (bark, twig) = (wood(stage, "bark"), wood(stage, "twig"));
    let foliage = std::array::from_fn(|tint| {
        let [red, green, blue] = shade(random, [0.45, 0.75, 0.35], [1.0, 1.0, 0.55]);
        stage.material(Material {
            name: format!("foliage {species} {tint}"),
            base_color: [red, green, blue, 1.0],
            base_color_texture: Some(texture),
            alpha: AlphaMode::Mask { cutoff: 0.5 },
            double_sided: true,
            ..Material::default()
        })
    });
    Colours { bark, twig, foliage }
}

/// Makes a plant that stands on y = 0.
fn plant(habit: Habit, seed: u64, colours: Colours) -> Mesh {
    let mut random = Random::new(seed);
    let mut sculpture = Sculpture::default();
    match habit {
        Habit::Broadleaf => broadleaf(&mut sculpture, &mut random, colours),
        Habit::Conifer => conifer(&mut sculpture, &mut random, colours),
        Habit::Shrub => shrub(&mut sculpture, &mut random, colours),
        Habit::Fern => fern(&mut sculpture, &mut random, colours),
    }
    sculpture.finish("plant")
}

/// Adds a tapering trunk with a foot that reaches below the ground.
fn trunk(sculpture: &mut Sculpture, colours: Colours, radius: f64, at: impl Fn(f64) -> DVec3) {
    const RINGS: u32 = 14;
    let path: Vec<_> = (0..=RINGS)
        .map(|i| {
            let t = f64::from(i) / f64::from(RINGS);
            let foot = 0.8 * radius * (1.0 - t).powi(12);
            (at(t) - DVec3::Y * 0.4 * (1.0 - t), if i == RINGS { 0.0 } else { radius * (1.0 - 0.85 * t) + foot })
        })
        .collect();
    sculpture.add(colours.bark, 50.0, &Solid::sweep(&path, &ribbed(7, 3, 0.14)));
}

/// Adds a card of leaves that begins at `root`, grows along `way`, and bends down a little.
fn card(sculpture: &mut Sculpture, material: usize, root: DVec3, way: DVec3, roll: f64, outward: DVec3) {
    let length = way.length();
    let side = way.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
    let across = turn(way / length, roll) * side * (0.45 * length);
    let rows: Vec<Vec<DVec3>> = (0..=2)
        .map(|k| f64::from(k) / 2.0)
        .map(|s| root + way * s - DVec3::Y * (0.18 * length * s * s))
        .map(|middle| vec![middle - across, middle + across])
        .collect();
    sculpture.card(material, &rows, (outward + DVec3::Y * 0.6).normalize());
}

fn broadleaf(sculpture: &mut Sculpture, random: &mut Random, colours: Colours) {
    let height = random.between(9.0, 13.0);
    let sway = dvec3(random.between(-0.8, 0.8), 0.0, random.between(-0.8, 0.8));
    let trunk_at = |t: f64| DVec3::Y * (height * t) + sway * sin_cos(160.0 * t).0;
    trunk(sculpture, colours, 0.32, trunk_at);
    const BRANCHES: u32 = 34;
    for i in 0..BRANCHES {
        let t = mix(0.28, 0.97, f64::from(i) / f64::from(BRANCHES - 1));
        let bearing = 137.507_764 * f64::from(i) + random.between(-15.0, 15.0);
        let heading = turn(DVec3::Y, bearing) * DVec3::X;
        let length = mix(4.2, 1.2, t) * random.between(0.8, 1.2);
        let rise = random.between(0.25, 0.7);
        let root = trunk_at(t);
        let along = |s: f64| root + heading * (length * s) + DVec3::Y * (length * rise * s * (1.0 - 0.3 * s));
        let wood: Vec<_> =
            (0..=4).map(|k| f64::from(k) / 4.0).map(|s| (along(s), 0.09 * (1.0 - s) * (1.2 - t))).collect();
        sculpture.add(colours.twig, 50.0, &Solid::tube(&wood, 5));
        let tint = colours.foliage[random.index(TINTS)];
        for _ in 0..20 {
            let from = along(random.between(0.3, 1.0));
            let out = turn(DVec3::Y, random.between(-80.0, 80.0)) * heading;
            let way = (out + DVec3::Y * random.between(-0.4, 0.7)).normalize() * random.between(0.6, 1.1);
            card(sculpture, tint, from, way, random.between(-70.0, 70.0), heading);
        }
    }
}

fn conifer(sculpture: &mut Sculpture, random: &mut Random, colours: Colours) {
    let height = random.between(13.0, 18.0);
    let sway = dvec3(random.between(-0.3, 0.3), 0.0, random.between(-0.3, 0.3));
    let trunk_at = |t: f64| DVec3::Y * (height * t) + sway * sin_cos(180.0 * t).0;
    trunk(sculpture, colours, 0.28, trunk_at);
    const BRANCHES: u32 = 48;
    for i in 0..BRANCHES {
        let t = mix(0.12, 0.98, f64::from(i) / f64::from(BRANCHES - 1));
        let heading = turn(DVec3::Y, 137.507_764 * f64::from(i) + random.between(-12.0, 12.0)) * DVec3::X;
        let length = mix(3.4, 0.5, t) * random.between(0.85, 1.1);
        let root = trunk_at(t);
        let along = |s: f64| root + heading * (length * s) + DVec3::Y * (length * (0.1 * s - 0.3 * s * s));
        let wood: Vec<_> =
            (0..=2).map(|k| f64::from(k) / 2.0).map(|s| (along(s), 0.04 * (1.0 - s) * (1.2 - t))).collect();
        sculpture.add(colours.twig, 50.0, &Solid::tube(&wood, 4));
        let tint = colours.foliage[random.index(TINTS)];
        let side = heading.cross(DVec3::Y);
        for k in 0..8 {
            let s = mix(0.1, 0.95, f64::from(k) / 7.0);
            for hand in [-1.0, 1.0] {
                let way = (heading * 0.7 + side * hand + DVec3::Y * random.between(-0.2, 0.2)).normalize();
                let reach = mix(0.9, 0.4, s) * random.between(0.5, 1.0) * (1.2 - 0.7 * t);
                card(sculpture, tint, along(s), way * reach, random.between(-30.0, 30.0), heading);
            }
        }
    }
}

fn shrub(sculpture: &mut Sculpture, random: &mut Random, colours: Colours) {
    for i in 0..10 {
        let heading = turn(DVec3::Y, 36.0 * f64::from(i) + random.between(-12.0, 12.0)) * DVec3::X;
        let length = random.between(0.8, 1.6);
        let lean = random.between(0.3, 0.9);
        let along = |s: f64| heading * (length * lean * s) + DVec3::Y * (length * s - 0.1);
        let wood: Vec<_> = (0..=4).map(|k| f64::from(k) / 4.0).map(|s| (along(s), 0.025 * (1.0 - s))).collect();
        sculpture.add(if i % 2 == 0 { colours.twig } else { colours.bark }, 50.0, &Solid::tube(&wood, 4));
        let tint = colours.foliage[random.index(TINTS)];
        for _ in 0..12 {
            let way = turn(DVec3::Y, random.between(-90.0, 90.0)) * heading + DVec3::Y * random.between(-0.2, 0.8);
            let way = way.normalize() * random.between(0.3, 0.6);
            card(sculpture, tint, along(random.between(0.25, 1.0)), way, random.between(-60.0, 60.0), heading);
        }
    }
}

fn fern(sculpture: &mut Sculpture, random: &mut Random, colours: Colours) {
    const FRONDS: u32 = 12;
    sculpture.add(colours.bark, 50.0, &Solid::sphere(0.09, 6, 4));
    for i in 0..FRONDS {
        let heading = turn(DVec3::Y, 30.0 * f64::from(i) + random.between(-10.0, 10.0)) * DVec3::X;
        let (length, rise) = (random.between(0.6, 1.0), random.between(0.5, 1.1));
        let side = heading.cross(DVec3::Y) * (0.2 * length);
        let at = |s: f64| heading * (length * s) + DVec3::Y * (length * (rise * s - 0.9 * s * s) + 0.05);
        let stalk: Vec<_> = (0..=2).map(|k| f64::from(k) / 2.0).map(|s| (at(s), 0.012 * (1.0 - s))).collect();
        sculpture.add(colours.twig, 50.0, &Solid::tube(&stalk, 3));
        let rows: Vec<Vec<DVec3>> =
            (0..=4).map(|k| f64::from(k) / 4.0).map(|s| vec![at(s) - side, at(s) + side]).collect();
        sculpture.card(colours.foliage[random.index(TINTS)], &rows, (DVec3::Y + 0.3 * heading).normalize());
    }
}

/// Makes a round stone about 2 m across, around the origin.
fn boulder(seed: u64, material: usize) -> Mesh {
    let mut sculpture = Sculpture::default();
    let rough = |p: DVec3| p * (1.0 + 0.35 * noise::space_octaves(seed, p * 1.3, 3, 0.5));
    sculpture.add(material, 40.0, &Solid::cube_sphere(4).bent(rough));
    sculpture.finish("boulder")
}

/// The wood under construction, one primitive for each material.
#[derive(Default)]
struct Wood {
    primitives: BTreeMap<usize, Primitive>,
}

impl Wood {
    /// Adds a copy of a model. The copy shares no vertices.
    fn add(&mut self, model: &Mesh, place: Trs) {
        let world_from_model: DAffine3 = place.to_affine();
        for source in &model.primitives {
            let target = self
                .primitives
                .entry(source.material)
                .or_insert_with(|| Primitive { material: source.material, ..Primitive::default() });
            let first = target.positions.len() as u32;
            let point = |p: &[f32; 3]| world_from_model.transform_point3(DVec3::from_array(p.map(f64::from)));
            let normal = |n: &[f32; 3]| place.rotation * DVec3::from_array(n.map(f64::from));
            target.positions.extend(source.positions.iter().map(|p| point(p).as_vec3().to_array()));
            target.normals.extend(source.normals.iter().map(|n| normal(n).as_vec3().to_array()));
            target.uvs.extend(&source.uvs);
            target.indices.extend(source.indices.iter().map(|index| first + index));
        }
    }

    /// Adds one node for each material to the stage.
    fn place(self, stage: &mut Stage) {
        for (material, primitive) in self.primitives {
            let name = stage.scene.materials[material].name.clone();
            let mesh = stage.mesh(Mesh { name: name.clone(), primitives: vec![primitive], ..Mesh::default() });
            stage.place(name, mesh, Trs::IDENTITY);
        }
    }
}
