//! The wood is as hard as it is meant to be, and the same every time.

use umbrage_scene::procedural::World;
use umbrage_scene::{AlphaMode, Scene, camera_view};

use crate::census::Fingerprint;

/// Triangles in the wood, and those of them that are alpha-tested.
fn triangles(scene: &Scene) -> [usize; 2] {
    let mut counts = [0; 2];
    for primitive in scene.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let count = primitive.indices.len() / 3;
        let is_masked = matches!(scene.materials[primitive.material].alpha, AlphaMode::Mask { .. });
        counts[0] += count;
        counts[1] += if is_masked { count } else { 0 };
    }
    counts
}

#[test]
fn a_million_triangles_more_than_half_of_them_alpha_tested() {
    let scene = World::Thicket.build();
    scene.validate().unwrap_or_else(|error| panic!("{error}"));
    let [all, masked] = triangles(&scene);
    assert!((1_020_000..1_130_000).contains(&all), "{all} triangles");
    let share = masked as f64 / all as f64;
    assert!((0.55..0.62).contains(&share), "{share} of {all} triangles are alpha-tested");
    assert_eq!(scene.materials.len(), 152);
    let is_used = |material| scene.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|p| p.material == material);
    assert!((0..152).all(is_used), "a material is on nothing");
}

#[test]
fn every_material_of_a_plant_is_all_over_the_wood() {
    let scene = World::Thicket.build();
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    for object in &pose.objects {
        let name = &scene.nodes[object.node].name;
        let size = object.bounds.max - object.bounds.min;
        let is_wide = size.x > 60.0 && size.z > 60.0;
        assert!(is_wide || name.starts_with("ground ") || name.starts_with("boulder "), "{name} spans {size}");
    }
}

#[test]
fn leaves_have_holes() {
    let scene = World::Thicket.build();
    assert_eq!(scene.textures.len(), 7);
    for (index, texture) in scene.textures.iter().enumerate() {
        let solid = texture.rgba.chunks_exact(4).filter(|pixel| pixel[3] >= 128).count();
        let share = solid as f64 / f64::from(texture.width * texture.height);
        assert!((0.1..0.75).contains(&share), "leaves of texture {index} cover {share} of their card");
    }
}

#[test]
fn cameras_are_those_of_every_world_and_stand_above_the_ground() {
    let scene = World::Thicket.build();
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    assert_eq!(names, ["near", "middle", "far", "dueling", "aerial"]);
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    for (index, name) in names.iter().enumerate() {
        let view = camera_view(&scene, &pose, index, 1.5, None, None).unwrap_or_else(|error| panic!("{error}"));
        assert!(view.eye().y > -5.0, "{name} is below the wood");
    }
}

#[test]
fn the_wood_is_the_same_every_time() {
    assert_eq!(Fingerprint::of(&World::Thicket.build()), Fingerprint::of(&World::Thicket.build()));
}
