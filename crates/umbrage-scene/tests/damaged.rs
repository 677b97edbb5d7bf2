//! Files damaged at random never bring the loader down, and what still loads can be posed and written.

mod common;

use common::*;
use proptest::prelude::*;
use serde_json::json;
use umbrage_scene::{GltfOptions, export_glb, load_gltf_slice};

/// Everything that the loader knows in one small file.
fn rich() -> Glb {
    let mut glb = Glb::triangle();
    let uvs = glb.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let normals = glb.accessor(&[0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0], I8, "VEC3", 3);
    glb.json["accessors"][normals]["normalized"] = json!(true);
    let view = glb.json["accessors"][normals]["bufferView"].as_u64().expect("a number") as usize;
    glb.json["bufferViews"][view]["byteStride"] = json!(4);
    let colors = glb.accessor(&[255; 12], U8, "VEC4", 3);
    glb.json["accessors"][colors]["normalized"] = json!(true);
    let joints = glb.accessor(&[0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], U8, "VEC4", 3);
    let weights = glb.floats("VEC4", &[0.5, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let (changed, values) = (glb.view(&[2, 0]), glb.view(&[0; 12]));
    glb.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": changed, "componentType": U16 }, "values": { "bufferView": values },
    });
    glb.json["meshes"] = json!([
        { "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": uvs, "NORMAL": normals, "COLOR_0": colors },
            "indices": 1, "material": 0 }] },
        { "primitives": [{ "attributes": { "POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights }, "mode": 5 }] },
    ]);
    let picture = glb.view(&png(2, 2, [1, 2, 3, 4]));
    glb.json["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    glb.json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648 }]);
    glb.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    glb.json["materials"] = json!([{
        "alphaMode": "MASK", "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": {
            "KHR_texture_transform": { "offset": [0.5, 0.5], "rotation": 1.0, "scale": [2, 2] } } } },
    }]);
    let (times, turns) = (glb.floats("SCALAR", &[0.0, 1.0]), glb.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]));
    let moves = glb.floats("VEC3", &[0.0; 18]);
    glb.json["animations"] = json!([{
        "channels": [
            { "sampler": 0, "target": { "node": 1, "path": "rotation" } },
            { "sampler": 1, "target": { "node": 2, "path": "translation" } },
        ],
        "samplers": [{ "input": times, "output": turns }, { "input": times, "output": moves, "interpolation": "CUBICSPLINE" }],
    }]);
    glb.json["skins"] = json!([{ "joints": [1, 2] }]);
    let places = glb.floats("VEC3", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": {} }] } });
    glb.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1 } }]);
    glb.json["nodes"] = json!([
        { "mesh": 0, "extras": { "castShadow": false }, "children": [1, 3],
          "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } } },
        { "translation": [1, 2, 3], "children": [2] },
        { "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 1, "skin": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1] },
    ]);
    glb
}

/// Loads, and if it loads, does all that can be done with a scene.
fn exercise(bytes: &[u8]) {
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

#[test]
fn the_rich_file_is_whole() {
    let scene = rich().scene();
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.skins.len(), scene.animations.len()), (1, 1, 1, 1));
    assert_eq!(scene.pose(0.25).unwrap_or_else(|e| panic!("{e}")).objects.len(), 3);
    exercise(&rich().bytes());
}

#[test]
fn no_truncation_panics() {
    let bytes = rich().bytes();
    (0..bytes.len()).step_by(7).for_each(|length| exercise(&bytes[..length]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn flipped_bytes_never_panic(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = rich().bytes();
        for (at, with) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= with;
        }
        exercise(&bytes);
    }

    /// Damage that keeps the JSON a JSON: any number in it becomes another one.
    #[test]
    fn changed_numbers_never_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![
            Just("0".to_owned()), Just("1".to_owned()), Just("3".to_owned()), Just("-1".to_owned()), Just("1e39".to_owned()),
            Just("18446744073709551615".to_owned()), Just("4294967296".to_owned()), Just("null".to_owned()),
            (0_u32..200).prop_map(|n| n.to_string()), Just("5126".to_owned()), Just("5123".to_owned()),
        ]), 1..4),
    ) {
        let glb = rich();
        let mut json = glb.json.clone();
        json["buffers"] = json!([{ "byteLength": glb.binary.len() }]);
        let mut text = json.to_string();
        for (at, with) in changes {
            let starts: Vec<usize> = text
                .char_indices()
                .filter(|&(i, c)| c.is_ascii_digit() && matches!(text.as_bytes()[i - 1], b':' | b',' | b'[' | b'-'))
                .map(|(i, _)| i)
                .collect();
            let start = starts[at.index(starts.len())];
            let length = text[start..].find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(1);
            text.replace_range(start..start + length, &with);
        }
        exercise(&container(text.as_bytes(), Some(&glb.binary)));
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..64)) {
        exercise(&bytes);
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend_from_slice(&bytes);
        exercise(&glb);
    }
}
