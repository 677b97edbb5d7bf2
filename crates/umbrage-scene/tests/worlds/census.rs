//! Counts and sizes against the paper (section 5 and table 1), and the same bits every time.

use std::collections::BTreeMap;

use umbrage_scene::procedural::World;
use umbrage_scene::{AlphaMode, Keys, Scene, Trs};

use crate::{is_ground, worlds};

/// Node names without their numbers and squares, with how many mesh nodes have them.
fn sorts(scene: &Scene) -> BTreeMap<String, usize> {
    let mut sorts = BTreeMap::new();
    for node in scene.nodes.iter().filter(|node| node.mesh.is_some() && !is_ground(&node.name)) {
        let is_number = |word: &str| word.chars().any(|c| c.is_ascii_digit());
        let words: Vec<&str> = node.name.split(' ').filter(|word| !is_number(word)).collect();
        *sorts.entry(words.join(" ")).or_insert(0) += 1;
    }
    sorts
}

#[test]
fn every_world_holds_what_the_paper_says() {
    let expected: [&[(&str, usize)]; 4] = [
        &[("robot", 160)],
        &[
            ("black bishop", 2),
            ("black king", 1),
            ("black knight", 2),
            ("black pawn", 8),
            ("black queen", 1),
            ("black rook", 2),
            ("white bishop", 2),
            ("white king", 1),
            ("white knight", 2),
            ("white pawn", 8),
            ("white queen", 1),
            ("white rook", 2),
        ],
        &[("cactus", 15), ("dwarf", 15), ("knight", 15), ("palm", 15)],
        &[
            ("clawbot", 10),
            ("clawbot left jaw", 10),
            ("clawbot right jaw", 10),
            ("clawbot trunk", 10),
            ("pine", 10),
            ("rock", 20),
            ("windmill", 15),
            ("windmill sails", 15),
        ],
    ];
    for ((world, scene), expected) in worlds().iter().zip(expected) {
        let expected: BTreeMap<String, usize> =
            expected.iter().map(|&(name, count)| (name.to_owned(), count)).collect();
        assert_eq!(sorts(scene), expected, "{}", world.title());
        scene.validate().unwrap_or_else(|error| panic!("{}: {error}", world.title()));
    }
}

#[test]
fn triangles_are_within_two_percent_of_the_paper() {
    for ((world, scene), paper) in worlds().iter().zip([240_000.0, 51_000.0, 1_000_000.0, 1_300_000.0]) {
        let placed: usize = scene
            .nodes
            .iter()
            .filter_map(|node| node.mesh)
            .flat_map(|mesh| &scene.meshes[mesh].primitives)
            .map(|primitive| primitive.indices.len() / 3)
            .sum();
        let off = placed as f64 / paper - 1.0;
        assert!(off.abs() < 0.02, "{} has {placed} triangles, {:.1} % off", world.title(), 100.0 * off);
    }
}

#[test]
fn grounds_are_as_large_as_the_paper_says() {
    for ((world, scene), paper_km2) in worlds().iter().zip([1.44, 0.49, 1.6, 2.56]) {
        let pose = scene.pose(0.0).expect("a world has a pose");
        let ground = pose
            .objects
            .iter()
            .filter(|object| is_ground(&scene.nodes[object.node].name))
            .map(|object| object.bounds)
            .reduce(|a, b| a.union(b))
            .expect("a world has ground");
        let size = ground.max - ground.min;
        let area_km2 = size.x * size.z * 1e-6;
        assert!((area_km2 - paper_km2).abs() < 1e-3, "{} covers {area_km2} km²", world.title());
        assert!((size.x - size.z).abs() < 1e-6 && (ground.min.x + ground.max.x).abs() < 1e-6, "a centred square");
    }
}

#[test]
fn flat_ground_only_receives_and_everything_else_casts() {
    for (world, scene) in worlds() {
        for node in scene.nodes.iter().filter(|node| node.mesh.is_some()) {
            let casts = !is_ground(&node.name) || *world == World::MiningTerrain;
            assert_eq!(node.cast_shadow, casts, "{} in {}", node.name, world.title());
        }
    }
}

#[test]
fn the_alpha_mask_is_exercised() {
    let (_, mine) = &worlds()[3];
    let masked = mine.materials.iter().position(|m| matches!(m.alpha, AlphaMode::Mask { .. })).expect("pine needles");
    let texture = &mine.textures[mine.materials[masked].base_color_texture.expect("a picture of needles")];
    let solid = texture.rgba.chunks_exact(4).filter(|pixel| pixel[3] > 102).count();
    let share = solid as f64 / f64::from(texture.width * texture.height);
    assert!((0.15..0.7).contains(&share), "needles cover {share} of their card");
}

#[test]
fn names_lead_back_to_their_worlds() {
    for world in World::ALL {
        assert_eq!(World::from_name(world.name()), Some(world));
        assert_ne!(world.name(), world.title());
    }
    assert_eq!(World::from_name("Robot War"), None);
    assert_eq!(World::from_name(""), None);
}

/// FNV-1a over everything that has an influence on a picture.
pub(crate) struct Fingerprint(u64);

impl Fingerprint {
    fn eat(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        }
    }

    fn eat_f32(&mut self, values: impl IntoIterator<Item = f32>) {
        values.into_iter().for_each(|value| self.eat(&value.to_bits().to_le_bytes()));
    }

    pub(crate) fn of(scene: &Scene) -> u64 {
        let mut print = Self(0xCBF2_9CE4_8422_2325);
        for primitive in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
            print.eat_f32(primitive.positions.iter().flatten().copied());
            print.eat_f32(primitive.normals.iter().flatten().copied());
            print.eat_f32(primitive.uvs.iter().flatten().copied());
            print.eat_f32(primitive.colors.iter().flatten().copied());
            primitive.indices.iter().for_each(|index| print.eat(&index.to_le_bytes()));
        }
        for material in &scene.materials {
            print.eat_f32(material.base_color);
        }
        scene.textures.iter().for_each(|texture| print.eat(&texture.rgba));
        for node in &scene.nodes {
            print.eat(node.name.as_bytes());
            let Trs { translation, rotation, scale } = node.local;
            let values = translation.to_array().into_iter().chain(rotation.to_array()).chain(scale.to_array());
            values.for_each(|value| print.eat(&value.to_bits().to_le_bytes()));
        }
        for channel in scene.animations.iter().flat_map(|animation| &animation.channels) {
            print.eat_f32(channel.times.iter().copied());
            match &channel.values {
                Keys::Translation(keys) | Keys::Scale(keys) => print.eat_f32(keys.iter().flatten().copied()),
                Keys::Weights { values, .. } => print.eat_f32(values.iter().copied()),
                Keys::Rotation(keys) => print.eat_f32(keys.iter().flatten().copied()),
            }
        }
        print.0
    }
}

#[test]
fn worlds_are_the_same_every_time() {
    for (world, scene) in worlds() {
        assert_eq!(Fingerprint::of(scene), Fingerprint::of(&world.build()), "{}", world.title());
    }
}

/// Measurements are only comparable where these agree. Whoever changes a world on purpose writes
/// the new number here.
#[test]
fn worlds_are_the_same_on_every_machine() {
    let known = [0xA0F5_7759_9F75_F67C, 0x355C_B2D1_3CAA_E70C, 0xF668_0F60_E68A_DBC0, 0x4A1B_FF89_10A1_B2CF];
    let built: Vec<u64> = worlds().iter().map(|(_, scene)| Fingerprint::of(scene)).collect();
    assert_eq!(built, known, "{built:#018X?}");
}

#[test]
fn a_fingerprint_notices_a_moved_vertex() {
    let (_, scene) = &worlds()[1];
    let mut moved = scene.clone();
    moved.meshes[3].primitives[0].positions[7][1] += 1e-4;
    assert_ne!(Fingerprint::of(scene), Fingerprint::of(&moved));
}
