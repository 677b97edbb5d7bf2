//! The world "Knights": dwarfs and knights walk in circles between palms and cactuses.

use glam::{DVec2, DVec3, dvec3};

use super::World;
use super::figures::{self, DwarfsColours, KnightsColours, STRIDE};
use super::maths::{Random, mix, sin_cos, smoothstep, turn};
use super::noise;
use super::plants::{self, CactusColours, PalmsColours};
use super::stage::{SkyPoint, Stage, scatter};
use super::terrain::{Surface, Terrain};
use super::worlds::{stage, standing};
use crate::{Channel, Interpolation, Keys, Material, Scene};

/// Edge of the desert in metres: 1265² m² are the paper's 1.6 km².
const EDGE_M: f64 = 1265.0;

/// Height of dunes so gentle that none ever stands in another's shadow: the ground only receives
/// shadows.
fn dunes(place: DVec2) -> f64 {
    let broad = noise::plane_octaves(11, place / 310.0, 2, 0.4);
    // Long crests across the wind.
    let bent = place.x + 60.0 * noise::plane(12, place / 190.0);
    let crest = 0.5 + 0.5 * noise::plane(13, DVec2::new(bent / 95.0, place.y / 340.0));
    let ripple = noise::plane_octaves(14, place / 28.0, 2, 0.5);
    13.0 * broad + 7.0 * crest * crest + 0.35 * ripple
}

/// Returns whether a place is inhabited. Inhabited places form groups, more of them towards the
/// middle, with empty desert between.
fn inhabited(place: DVec2) -> bool {
    noise::plane_octaves(16, place / 300.0, 2, 0.5) + 0.4 * (1.0 - place.length() / 420.0) > 0.2
}

/// Builds the world.
pub(super) fn knights() -> Scene {
    let mut stage = stage(World::Knights);
    let terrain = Terrain::new(EDGE_M, 8, 30, dunes);
    let sand = stage.paint("sand", 0xFF_FF_FF);
    let tint = |at: DVec3, normal: DVec3| {
        let pale = smoothstep(-6.0, 14.0, at.y) + 0.25 * noise::plane(15, DVec2::new(at.x, at.z) / 55.0);
        let lee = smoothstep(0.96, 1.0, normal.y);
        let shade = |low: f64, high: f64| (mix(low, high, pale.clamp(0.0, 1.0)) * mix(0.88, 1.0, lee)) as f32;
        [shade(0.50, 0.62), shade(0.335, 0.45), shade(0.185, 0.265)]
    };
    terrain.place(&mut stage, &Surface { material: sand, tint: Some(&tint), cast_shadow: false });

    let [knights, dwarfs, palms, cactuses] = cast(&mut stage);
    let mut random = Random::new(1515);
    // A figure's loop, a crown of leaves, arms.
    let loops: Vec<f64> = (0..30).map(|_| random.between(14.0, 26.0)).collect();
    let mut radii: Vec<f64> = loops.iter().map(|radius| radius + 11.0).collect();
    radii.extend([16.0; 15]);
    radii.extend([9.0; 15]);
    let places = scatter(&mut random, 0.94 * EDGE_M, &radii, inhabited);

    for (i, (&place, &radius)) in places.iter().zip(&loops).enumerate() {
        let (kind, meshes, size) = if i % 2 == 0 { ("knight", &knights, 2.2) } else { ("dwarf", &dwarfs, 2.2) };
        let walk = Walk {
            center: place,
            radius,
            scale: size * random.between(0.9, 1.15),
            clockwise: random.between(0.0, 1.0) < 0.5,
            start: random.between(0.0, 360.0),
        };
        walk.place(&mut stage, &terrain, format!("{kind} {}", i / 2), meshes[random.index(meshes.len())]);
    }
    for (i, &place) in places[30..45].iter().enumerate() {
        let at = terrain.on_ground(place);
        let trs = standing(at, random.between(0.0, 360.0), random.between(2.1, 2.9));
        stage.place(format!("palm {i}"), palms[i % palms.len()], trs);
    }
    for (i, &place) in places[45..].iter().enumerate() {
        let at = terrain.on_ground(place);
        let trs = standing(at, random.between(0.0, 360.0), random.between(1.7, 2.4));
        stage.place(format!("cactus {i}"), cactuses[i % cactuses.len()], trs);
    }

    stage.sun(SkyPoint { bearing: 205.0, elevation: 31.0 }, SkyPoint { bearing: 110.0, elevation: 62.0 });
    stage.camera("near", dvec3(146.0, 19.2, -276.2), dvec3(123.9, -4.1, -370.8));
    stage.camera("middle", dvec3(-458.9, 38.4, 101.5), dvec3(-418.2, 5.0, 186.6));
    stage.camera("far", dvec3(85.1, 78.2, 548.0), dvec3(65.1, 42.1, 456.9));
    stage.camera("dueling", dvec3(181.8, 23.0, -396.7), dvec3(97.1, 15.7, -344.1));
    stage.camera("aerial", dvec3(-220.0, 300.0, 470.0), dvec3(0.0, 0.0, 0.0));
    stage.scene
}

/// Makes the meshes of knights, dwarfs, palms and cactuses, some of each.
fn cast(stage: &mut Stage) -> [Vec<usize>; 4] {
    let steel = stage.paint("steel", 0x8C_92_99);
    let brass = stage.paint("brass", 0xB5_8E_46);
    let leather = stage.paint("leather", 0x5E_42_2E);
    let iron = stage.paint("iron", 0x5A_5D_62);
    let skin = stage.paint("skin", 0xC7_94_75);
    let knights = [("red knight", 0x8C_42_3C), ("blue knight", 0x46_5E_86), ("green knight", 0x50_70_56)]
        .into_iter()
        .map(|(name, colour)| {
            let cloth = stage.paint(name, colour);
            let mesh = figures::knight(name, KnightsColours { steel, brass, cloth, leather });
            stage.mesh(mesh)
        })
        .collect();
    let dwarfs = [("red-haired dwarf", 0x9A_62_40, 0x5C_66_4A), ("grey dwarf", 0xA8_A2_98, 0x6B_3D_33)]
        .into_iter()
        .map(|(name, hair, cloth)| {
            let beard = stage.paint(&format!("{name}'s beard"), hair);
            let tunic = stage.paint(&format!("{name}'s tunic"), cloth);
            let mesh = figures::dwarf(name, DwarfsColours { skin, beard, tunic, leather, iron });
            stage.mesh(mesh)
        })
        .collect();

    let bark = stage.paint("palm bark", 0x7A_62_48);
    let mut leaf = |name: &str, srgb: u32| {
        let material = stage.paint(name, srgb);
        let leaf = &mut stage.scene.materials[material];
        *leaf = Material { double_sided: true, ..leaf.clone() };
        material
    };
    let colours = PalmsColours {
        bark,
        leaf: leaf("palm leaf", 0x6A_80_4C),
        dry_leaf: leaf("dry palm leaf", 0x94_7E_50),
        fruit: stage.paint("dates", 0x8A_4A_22),
    };
    let palms = (0..3).map(|i| stage.mesh(plants::palm(&format!("palm {i}"), 100 + i, colours))).collect();
    let colours = CactusColours {
        flesh: stage.paint("cactus", 0x66_80_5C),
        spine: stage.paint("cactus spine", 0xCF_C3_9A),
        flower: stage.paint("cactus flower", 0xC9_6A_86),
    };
    let cactuses = (0..3).map(|i| stage.mesh(plants::cactus(&format!("cactus {i}"), 200 + i, colours))).collect();
    [knights, dwarfs, palms, cactuses]
}

/// A walk in a circle, rocking from foot to foot.
struct Walk {
    center: DVec2,
    radius: f64,
    scale: f64,
    clockwise: bool,
    start: f64,
}

impl Walk {
    const SPEED_M_S: f64 = 4.5;
    const ROCK_DEGREES: f64 = 3.2;
    const KEYS_PER_STRIDE: usize = 8;

    fn place(&self, stage: &mut Stage, terrain: &Terrain, name: String, mesh: usize) {
        let way = 2.0 * std::f64::consts::PI * self.radius;
        let strides = (way / (2.0 * STRIDE[1] * 1.9 * self.scale)).round();
        let keys = strides as usize * Self::KEYS_PER_STRIDE;
        let sense = if self.clockwise { -1.0 } else { 1.0 };
        let at = |share: f64| {
            let bearing = self.start + sense * 360.0 * share;
            let (sin, cos) = sin_cos(bearing);
            let place = self.center + self.radius * DVec2::new(cos, -sin);
            let rock = Self::ROCK_DEGREES * sin_cos(360.0 * share * strides).0;
            // Rocking lifts the figure so far that the foot it stands on stays on the ground.
            let lift = STRIDE[0] * self.scale * sin_cos(rock).0.abs();
            let height = terrain.lowest_around(place, STRIDE[1] * self.scale) + lift;
            // Walking along the circle: +Z to the tangent.
            let heading = turn(DVec3::Y, bearing + if self.clockwise { 0.0 } else { 180.0 });
            let mut trs = standing(dvec3(place.x, height, place.y), 0.0, self.scale);
            trs.rotation = heading * turn(DVec3::Z, rock);
            trs
        };
        let poses: Vec<_> = (0..=keys).map(|key| at(key as f64 / keys as f64)).collect();
        let node = stage.place(name.clone(), mesh, poses[0]);
        let duration = way / Self::SPEED_M_S;
        let times: Vec<f32> = (0..=keys).map(|key| (duration * key as f64 / keys as f64) as f32).collect();
        let translations = poses.iter().map(|trs| trs.translation.as_vec3().to_array()).collect();
        let rotations = poses.iter().map(|trs| trs.rotation.as_quat().to_array()).collect();
        let channel = |values| Channel { node, times: times.clone(), values, interpolation: Interpolation::Linear };
        let channels = vec![channel(Keys::Translation(translations)), channel(Keys::Rotation(rotations))];
        stage.clip(&format!("{name} walks"), channels);
    }
}
