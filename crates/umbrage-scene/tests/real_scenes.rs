//! Every real scene loads, has as many triangles as its list says, and can be posed.

use std::path::PathBuf;

use umbrage_scene::{AlphaMode, GltfOptions, Scene, load_gltf};

/// A file of the shared scenes; `None`, loudly, where they are not there.
fn shared(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes").join(name);
    if !path.exists() {
        eprintln!("SKIPPED: {} is not there", path.display());
        return None;
    }
    Some(path)
}

fn load(name: &str) -> Option<Scene> {
    shared(name).map(|path| load_gltf(&path, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}")))
}

/// File, placed triangles, stored triangles, extents (as listed, in whole or tenth metres), tolerance of the extents.
const LISTED: [(&str, usize, usize, [f64; 3], f64); 8] = [
    ("city_candela.glb", 294_631, 116_305, [3975.0, 973.0, 3094.0], 1.0),
    ("veg_cocoa_temple.glb", 271_945, 90_163, [2725.0, 702.0, 2845.0], 1.0),
    ("arch_zdm2.glb", 58_772, 58_772, [77.0, 36.0, 60.0], 1.0),
    ("town_truck.glb", 36_167, 31_435, [2048.0, 28.0, 2048.0], 1.0),
    ("city_delft.glb", 36_267, 36_267, [524.0, 17.0, 328.0], 1.0),
    ("skin_fox.glb", 576, 576, [25.0, 79.0, 155.0], 1.0),
    ("skin_mannequiny.glb", 13_832, 13_832, [1.6, 0.3, 1.8], 0.1),
    ("tiny_watertower.glb", 146, 146, [0.5, 0.7, 0.5], 0.1),
];

#[test]
fn all_load_with_their_triangles_and_extents() {
    for (name, placed, stored, extents, tolerance) in LISTED {
        let Some(scene) = load(name) else { continue };
        assert_eq!(scene.placed_triangles(), placed, "{name}");
        assert_eq!(scene.stored_triangles(), stored, "{name}");
        let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
        let bounds = pose.bounds.expect("there are triangles");
        let size = bounds.max - bounds.min;
        eprintln!(
            "{name}: {} objects, {size:.2} m from {:.2}, notes {:?}",
            pose.objects.len(),
            bounds.min,
            scene.notes
        );
        // Those of skinned scenes are listed in bind pose.
        if scene.skins.is_empty() {
            let expected = glam::DVec3::from(extents);
            assert!((size - expected).abs().max_element() < tolerance, "{name}: {size} instead of {expected}");
        }
    }
}

#[test]
fn authors_marks_are_kept() {
    let Some(temple) = load("veg_cocoa_temple.glb") else { return };
    assert!(temple.nodes.iter().any(|node| !node.cast_shadow));
    let masked: usize = temple
        .nodes
        .iter()
        .filter_map(|node| node.mesh)
        .flat_map(|mesh| &temple.meshes[mesh].primitives)
        .filter(|p| matches!(temple.materials[p.material].alpha, AlphaMode::Mask { .. }))
        .map(|p| p.indices.len() / 3)
        .sum();
    assert_eq!(masked, 61_590, "alpha-tested triangles");
}

#[test]
fn skinned_scenes_move_and_loop() {
    for name in ["skin_fox.glb", "skin_mannequiny.glb"] {
        let Some(scene) = load(name) else { continue };
        let duration = scene.animations[0].duration;
        let at = |t: f64| scene.pose(t).unwrap_or_else(|error| panic!("{error}")).skinned[0].clone();
        let (start, later, looped) = (at(0.0), at(0.3 * duration), at(1.3 * duration));
        assert_ne!(start.positions, later.positions, "{name}");
        for (a, b) in later.positions.iter().flatten().zip(looped.positions.iter().flatten()) {
            let apart = (glam::Vec3::from(*a) - glam::Vec3::from(*b)).length();
            assert!(apart < 1e-3, "{name}: {apart} apart after one round");
        }
    }
}
