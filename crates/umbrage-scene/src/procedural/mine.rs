//! The world "Mining Terrain": an open-cast mine with benches, clawbots at work in it, windmills on
//! the hills around.

use glam::{DVec2, DVec3, dvec3};

use super::World;
use super::maths::{Random, mix, sin_cos, smoothstep, turn};
use super::mining::{self, ClawbotsColours, HINGE, HUB, TURRET, WindmillsColours};
use super::noise;
use super::plants::{self, PinesColours};
use super::stage::{SkyPoint, Stage, scatter};
use super::terrain::{Surface, Terrain};
use super::worlds::{stage, standing};
use crate::{AlphaMode, Channel, Interpolation, Keys, Material, Node, Scene, Trs};

const EDGE_M: f64 = 1600.0;
/// Height of a bench of the pit in metres.
const BENCH_M: f64 = 11.0;

/// Returns the metres from the middle of the pit, which is not quite a circle.
fn from_pit(place: DVec2) -> f64 {
    let offset = place - DVec2::new(-60.0, 30.0);
    let ragged = 1.0 + 0.3 * noise::plane_octaves(31, place / 300.0, 2, 0.5);
    libm::hypot(offset.x * 0.8, offset.y * 1.05) * ragged
}

/// Returns the height of hills with a pit cut into them in steps.
fn natural_height(place: DVec2) -> f64 {
    let away = from_pit(place);
    let hills = 78.0 * noise::plane_octaves(32, place / 520.0, 4, 0.42);
    let bowl = 62.0 * smoothstep(470.0, 70.0, away);
    let height = hills * smoothstep(40.0, 420.0, away) - bowl;
    let level = height / BENCH_M;
    let step = level.floor() + smoothstep(0.76, 0.97, level - level.floor());
    let stepped = mix(height, step * BENCH_M, smoothstep(500.0, 400.0, away));
    stepped + 0.5 * noise::plane_octaves(33, place / 22.0, 2, 0.5)
}

/// A level place for a machine. Its ground is level up to `radius` and joins the hills 16 m further
/// out.
struct Pad {
    place: DVec2,
    radius: f64,
    height: f64,
}

/// Builds the world.
pub(super) fn mining_terrain() -> Scene {
    let mut stage = stage(World::MiningTerrain);
    let mut random = Random::new(256);

    // Windmills stand around the pit, clawbots in it, pines and rocks where there is room.
    let mut radii = vec![34.0; 15];
    radii.extend([24.0; 10]);
    radii.extend([15.0; 10]);
    let rock_sizes: Vec<f64> = (0..20).map(|i| mix(19.0, 6.0, f64::from(i) / 19.0)).collect();
    radii.extend(rock_sizes.iter().map(|size| 1.5 * size));
    let even = |place: DVec2, radius: f64, most: f64| {
        let heights = (0..8).map(|i| {
            let (sin, cos) = sin_cos(45.0 * f64::from(i));
            natural_height(place + radius * DVec2::new(cos, sin))
        });
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)));
        high - low < most
    };
    let windmills = scatter(&mut random, EDGE_M, &radii[..15], |p| from_pit(p) > 420.0 && even(p, 16.0, 9.0));
    let clawbots = more(&mut random, &radii[..25], &windmills, |p| from_pit(p) < 430.0 && even(p, 12.0, 9.0));
    let pines = more(&mut random, &radii[..35], &clawbots, |p| from_pit(p) > 400.0 && even(p, 10.0, 4.0));
    let places = more(&mut random, &radii, &pines, |_| true);

    let pads: Vec<Pad> = places[..25]
        .iter()
        .enumerate()
        .map(|(i, &place)| Pad { place, radius: if i < 15 { 15.0 } else { 13.0 }, height: natural_height(place) })
        .collect();
    let terrain = Terrain::new(EDGE_M, 25, 20, |place| {
        pads.iter().fold(natural_height(place), |height, pad| {
            mix(pad.height, height, smoothstep(pad.radius, pad.radius + 16.0, place.distance(pad.place)))
        })
    });
    let soil = stage.paint("soil", 0xFF_FF_FF);
    terrain.place(&mut stage, &Surface { material: soil, tint: Some(&soil_colour), cast_shadow: true });

    let [rocks, pines] = still_meshes(&mut stage);
    place_windmills(&mut stage, &terrain, &mut random, &places[..15]);
    place_clawbots(&mut stage, &terrain, &mut random, &places[15..25]);
    for (i, &place) in places[25..35].iter().enumerate() {
        let at = dvec3(place.x, terrain.lowest_around(place, 1.0), place.y);
        let trs = standing(at, random.between(0.0, 360.0), random.between(1.5, 2.0));
        stage.place(format!("pine {i}"), pines[i % pines.len()], trs);
    }
    for (i, (&place, size)) in places[35..].iter().zip(rock_sizes).enumerate() {
        // A rock lies in the ground, not on it.
        let at = dvec3(place.x, terrain.lowest_around(place, 0.5 * size) + 0.35 * size, place.y);
        stage.place(format!("rock {i}"), rocks[i % rocks.len()], standing(at, random.between(0.0, 360.0), size));
    }

    stage.sun(SkyPoint { bearing: 300.0, elevation: 31.0 }, SkyPoint { bearing: 210.0, elevation: 60.0 });
    stage.camera("near", dvec3(-190.5, -55.0, -17.1), dvec3(-239.0, -59.4, 70.3));
    stage.camera("middle", dvec3(-463.7, 50.7, 346.3), dvec3(-448.2, 18.2, 439.6));
    stage.camera("far", dvec3(-161.6, 76.6, 317.6), dvec3(-67.5, 44.3, 307.2));
    stage.camera("dueling", dvec3(-669.0, 54.4, -270.2), dvec3(-624.4, 43.5, -181.3));
    stage.camera("aerial", dvec3(-350.0, 420.0, 620.0), dvec3(0.0, 0.0, -20.0));
    stage.scene
}

/// Scatters the rest of `radii` around places that are taken already.
fn more(random: &mut Random, radii: &[f64], taken: &[DVec2], fits: impl Fn(DVec2) -> bool) -> Vec<DVec2> {
    let rest = &radii[taken.len()..];
    let widest = rest.iter().copied().fold(0.0, f64::max);
    let free = |place: DVec2| {
        fits(place) && taken.iter().zip(radii).all(|(other, radius)| place.distance(*other) > radius + widest)
    };
    let fresh = scatter(random, 0.97 * EDGE_M, rest, free);
    [taken, &fresh].concat()
}

/// Colour of the soil: grass on level ground outside the pit, ochre soil inside, grey rock where it
/// is steep.
fn soil_colour(at: DVec3, normal: DVec3) -> [f32; 3] {
    let place = DVec2::new(at.x, at.z);
    let patchy = 0.5 * noise::plane_octaves(34, place / 60.0, 3, 0.5);
    let grass = smoothstep(400.0, 520.0, from_pit(place) + 160.0 * patchy);
    let steep = smoothstep(0.93, 0.8, normal.y + 0.06 * patchy);
    let layer = 0.5 + 0.5 * sin_cos(at.y * 75.0 + 90.0 * patchy).0;
    std::array::from_fn(|channel| {
        let soil = mix([0.42, 0.29, 0.18][channel], [0.47, 0.35, 0.235][channel], 0.5 + patchy);
        let meadow = mix([0.20, 0.235, 0.095][channel], [0.30, 0.285, 0.135][channel], 0.5 + patchy);
        let stone = mix([0.33, 0.285, 0.25][channel], [0.42, 0.36, 0.31][channel], layer);
        mix(mix(soil, meadow, grass), stone, steep) as f32
    })
}

/// Makes the meshes of rocks and pines, some of each.
fn still_meshes(stage: &mut Stage) -> [Vec<usize>; 2] {
    let granite = stage.paint("granite", 0x86_80_78);
    let sandstone = stage.paint("sandstone", 0x94_7B_62);
    let rocks = (0..5)
        .map(|i| {
            let material = if i % 2 == 0 { granite } else { sandstone };
            stage.mesh(mining::rock(&format!("rock {i}"), 300 + i, material))
        })
        .collect();
    let bark = stage.paint("pine bark", 0x6A_52_40);
    stage.scene.textures.push(plants::bough_texture());
    let needles = stage.material(Material {
        name: "pine needles".to_owned(),
        base_color_texture: Some(stage.scene.textures.len() - 1),
        alpha: AlphaMode::Mask { cutoff: 0.4 },
        double_sided: true,
        ..Material::default()
    });
    let pines = (0..3)
        .map(|i| stage.mesh(plants::pine(&format!("pine {i}"), 400 + i, PinesColours { bark, needles })))
        .collect();
    [rocks, pines]
}

fn place_windmills(stage: &mut Stage, terrain: &Terrain, random: &mut Random, places: &[DVec2]) {
    let colours = WindmillsColours {
        stone: stage.paint("windmill stone", 0xB8_AB_98),
        wood: stage.paint("weathered wood", 0x6B_55_42),
        thatch: stage.paint("shingles", 0x5E_50_48),
        cloth: stage.paint("sailcloth", 0xC9_BE_A6),
    };
    let [tower, sails] = mining::windmill(colours).map(|mesh| stage.mesh(mesh));
    // The wind comes from one side; no miller is quite exact.
    for (i, &place) in places.iter().enumerate() {
        let scale = random.between(1.45, 1.75);
        let trs = standing(terrain.on_ground(place), 65.0 + random.between(-14.0, 14.0), scale);
        let parent = Some(stage.place(format!("windmill {i}"), tower, trs));
        let start = random.between(0.0, 90.0);
        let local = Trs { translation: HUB, rotation: turn(DVec3::Z, start), ..Trs::IDENTITY };
        let name = format!("windmill {i} sails");
        let node = stage.node(Node { name: name.clone(), parent, local, mesh: Some(sails), ..Node::default() });
        let turning = rotations(node, DVec3::Z, random.between(9.0, 13.0), 8, |share| start - 360.0 * share);
        stage.clip(&name, vec![turning]);
    }
}

fn place_clawbots(stage: &mut Stage, terrain: &Terrain, random: &mut Random, places: &[DVec2]) {
    let steel = stage.paint("clawbot steel", 0x55_58_5C);
    let rubber = stage.paint("track", 0x38_36_34);
    let glass = stage.paint("clawbot eye", 0xD9_8E_2B);
    let makes = [("yellow paint", 0xC0_9C_4C), ("orange paint", 0xAE_6C_44)].map(|(name, colour)| {
        let paint = stage.paint(name, colour);
        let robot = mining::clawbot(ClawbotsColours { paint, steel, rubber, glass });
        let [left, right] = robot.jaws;
        [robot.tracks, robot.trunk, left, right].map(|mesh| stage.mesh(mesh))
    });
    for (i, &place) in places.iter().enumerate() {
        let [tracks, trunk, left, right] = makes[i % makes.len()];
        let trs = standing(terrain.on_ground(place), random.between(0.0, 360.0), random.between(1.9, 2.3));
        let base = stage.place(format!("clawbot {i}"), tracks, trs);
        let mut limb = |part: &str, parent: usize, mesh: usize, translation: DVec3, rotation| {
            stage.node(Node {
                name: format!("clawbot {i} {part}"),
                parent: Some(parent),
                local: Trs { translation, rotation, ..Trs::IDENTITY },
                mesh: Some(mesh),
                ..Node::default()
            })
        };
        let (facing, swing) = (random.between(-40.0, 40.0), random.between(30.0, 70.0));
        let turret = limb("trunk", base, trunk, TURRET, turn(DVec3::Y, facing));
        let jaws = [(left, 1.0, "left jaw"), (right, -1.0, "right jaw")].map(|(mesh, side, part)| {
            let node = limb(part, turret, mesh, HINGE * dvec3(side, 1.0, 1.0), turn(DVec3::Y, side * 40.0));
            (node, side)
        });
        let period = random.between(11.0, 17.0);
        let mut channels =
            vec![rotations(turret, DVec3::Y, period, 32, |share| facing + swing * sin_cos(360.0 * share).0)];
        for (node, side) in jaws {
            // Three bites in one swing.
            let open = move |share: f64| side * (22.0 + 18.0 * sin_cos(3.0 * 360.0 * share).1);
            channels.push(rotations(node, DVec3::Y, period, 48, open));
        }
        stage.clip(&format!("clawbot {i} works"), channels);
    }
}

/// Rotates a node about an axis by an angle in degrees that depends on the share of the period.
fn rotations(node: usize, axis: DVec3, period_s: f64, keys: usize, angle: impl Fn(f64) -> f64) -> Channel {
    let share = |key: usize| key as f64 / keys as f64;
    Channel {
        node,
        times: (0..=keys).map(|key| (period_s * share(key)) as f32).collect(),
        values: Keys::Rotation((0..=keys).map(|key| turn(axis, angle(share(key))).as_quat().to_array()).collect()),
        interpolation: Interpolation::Linear,
    }
}
