//! A real scene, made by others, loads as its list says.

use std::path::PathBuf;

use umbrage_scene::{AlphaMode, GltfOptions, Scene, load_gltf};

/// The city of `assets`.
fn city() -> Scene {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/city_candela.glb");
    load_gltf(&path, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn it_has_the_triangles_and_extents_of_its_list() {
    let city = city();
    assert_eq!((city.placed_triangles(), city.stored_triangles()), (294_631, 116_305));
    let bounds = city.pose(0.0).unwrap_or_else(|error| panic!("{error}")).bounds.expect("there are triangles");
    let apart = (bounds.max - bounds.min - glam::dvec3(3975.0, 973.0, 3094.0)).abs().max_element();
    assert!(apart < 1.0, "{bounds:?}");
}

#[test]
fn its_authors_marks_are_kept() {
    let city = city();
    assert!(city.nodes.iter().any(|node| !node.cast_shadow));
    let masked: usize = city
        .nodes
        .iter()
        .filter_map(|node| node.mesh)
        .flat_map(|mesh| &city.meshes[mesh].primitives)
        .filter(|p| matches!(city.materials[p.material].alpha, AlphaMode::Mask { .. }))
        .map(|p| p.indices.len() / 3)
        .sum();
    assert_eq!(masked, 3816, "alpha-tested triangles");
}
