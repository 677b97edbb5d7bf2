//! What is done with whatever loads. The fuzzers of `umbrage-fuzz` include this file too.

use umbrage_scene::{GltfOptions, export_glb, load_gltf_slice};

/// Loads, and if it loads, does all that can be done with a scene.
pub fn exercise(bytes: &[u8]) {
    let Ok(scene) = load_gltf_slice("damaged.glb", bytes, &GltfOptions::default()) else { return };
    for time in [0.0, 0.37, -5.0, 1e9] {
        if let Ok(pose) = scene.pose(time) {
            assert!(pose.objects.iter().all(|object| object.bounds.is_valid()));
            let posed = pose.skinned.iter().flat_map(|s| s.positions.iter().chain(&s.normals)).flatten().flatten();
            assert!(posed.copied().all(f32::is_finite), "no NaN comes out");
        }
    }
    if let Ok(bytes) = export_glb(&scene) {
        load_gltf_slice("again.glb", &bytes, &GltfOptions::default())
            .unwrap_or_else(|error| panic!("what we wrote does not load: {error}"));
    }
}
