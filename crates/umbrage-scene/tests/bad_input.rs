//! Files that are missing, cut short, or lie: a typed error that names the file and the part at
//! fault, never a panic.

mod common;

use std::path::Path;

use common::*;
use serde_json::{Value, json};
use umbrage_scene::{Error, GltfOptions, OpenOptions, load_gltf, load_gltf_slice, open};

#[test]
fn the_unbent_triangle_loads() {
    assert_eq!(Glb::triangle().scene().placed_triangles(), 1);
}

#[test]
fn missing_files_and_unknown_kinds() {
    let error =
        load_gltf(Path::new("/nonexistent/house.glb"), &GltfOptions::default()).expect_err("there is no such file");
    assert!(matches!(error, Error::Read { .. }) && error.to_string().contains("/nonexistent/house.glb"), "{error}");
    for spec in ["house.obj", "robot-wars", "", "png"] {
        let error = open(spec, &OpenOptions::default()).expect_err("no scene is called that");
        assert!(matches!(error, Error::UnknownScene { .. }) && error.to_string().contains("robot-war"), "{error}");
    }
}

#[test]
fn every_truncation_is_an_error() {
    let whole = Glb::triangle().bytes();
    for length in 0..whole.len() {
        let error =
            load_gltf_slice("test.glb", &whole[..length], &GltfOptions::default()).expect_err("it is cut short");
        assert!(error.to_string().contains("test.glb"), "{error}");
    }
    let json = serde_json::to_vec(&Glb::empty().json).expect("it is JSON");
    for length in 0..json.len() {
        assert!(
            matches!(load_gltf_slice("a.gltf", &json[..length], &GltfOptions::default()), Err(Error::Malformed { .. })),
            "{length}"
        );
    }
}

#[test]
fn containers_that_are_not() {
    let mut whole = Glb::triangle().bytes();
    whole[4] = 1;
    assert!(matches!(load_gltf_slice("a", &whole, &GltfOptions::default()), Err(Error::Malformed { .. })), "version 1");
    for length in [0_u32, 4, 11, 12, 19, u32::MAX] {
        let mut whole = Glb::triangle().bytes();
        whole[8..12].copy_from_slice(&length.to_le_bytes());
        assert!(
            matches!(load_gltf_slice("a", &whole, &GltfOptions::default()), Err(Error::Malformed { .. })),
            "length {length}"
        );
    }
    let mut whole = Glb::triangle().bytes();
    whole[16..20].copy_from_slice(b"JUNK");
    assert!(
        matches!(load_gltf_slice("a", &whole, &GltfOptions::default()), Err(Error::Malformed { .. })),
        "first chunk"
    );
    for text in ["[]", "{}", "null", "{\"asset\":{\"version\":\"1.0\"}}", "not json", "\u{feff}"] {
        assert!(
            matches!(load_gltf_slice("a", text.as_bytes(), &GltfOptions::default()), Err(Error::Malformed { .. })),
            "{text}"
        );
    }
}

#[test]
fn empty_scenes_are_fine() {
    let nothing = |json: Value| {
        load_gltf_slice("a", json.to_string().as_bytes(), &GltfOptions::default()).unwrap_or_else(|e| panic!("{e}"))
    };
    for json in [
        json!({ "asset": { "version": "2.0" } }),
        json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{}] }),
        json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] }),
        json!({ "asset": { "version": "2.1" }, "nodes": [{ "name": "alone" }] }),
    ] {
        let scene = nothing(json);
        let pose = scene.pose(0.0).unwrap_or_else(|e| panic!("{e}"));
        assert!(pose.objects.is_empty() && pose.bounds.is_none());
    }
}

#[test]
fn accessors_beyond_their_bytes() {
    for (field, value) in
        [("count", 4_u64), ("count", u64::MAX), ("count", 1 << 61), ("byteOffset", 4), ("byteOffset", u64::MAX)]
    {
        refused(&bent(|g| g.json["accessors"][0][field] = json!(value)), &["accessors[0]"]);
    }
    for (field, value) in
        [("byteLength", 10_000_u64), ("byteLength", u64::MAX), ("byteOffset", 1 << 40), ("byteOffset", u64::MAX)]
    {
        refused(&bent(|g| g.json["bufferViews"][0][field] = json!(value)), &["bufferViews[0]"]);
    }
    refused(&bent(|g| g.json["bufferViews"][0]["byteStride"] = json!(8)), &["accessors[0]"]);
    refused(&bent(|g| g.json["bufferViews"][0]["byteStride"] = json!(250)), &["accessors[0]"]);
    refused(&bent(|g| g.json["buffers"] = json!([{ "byteLength": 1_000_000 }])), &["buffers[0]", "cut short"]);
    refused(&bent(|g| g.json["accessors"][0]["bufferView"] = json!(9)), &["accessors[0]", "bufferViews[9]"]);
    refused(&bent(|g| g.json["bufferViews"][0]["buffer"] = json!(1)), &["bufferViews[0]", "buffers[1]"]);
    refused(&bent(|g| g.json["accessors"][0]["type"] = json!("VEC2")), &["accessors[0]", "Vec2"]);
    refused(&bent(|g| g.json["accessors"][0]["type"] = json!("VEC9")), &["accessors[0]"]);
    refused(&bent(|g| g.json["accessors"][0]["componentType"] = json!(1)), &["accessors[0]"]);
    refused(&bent(|g| g.json["accessors"][1]["componentType"] = json!(F32)), &["accessors[1]"]);
    refused(&bent(|g| g.json["accessors"][1]["componentType"] = json!(I16)), &["accessors[1]", "unsigned"]);
}

#[test]
fn zeros_without_bytes_cannot_fill_the_memory() {
    let glb = bent(|g| {
        g.primitive().as_object_mut().expect("an object").remove("indices");
        let indices = g.view(&[0, 0]);
        let values = g.view(&[0; 12]);
        g.json["accessors"][0] = json!({
            "componentType": F32, "type": "VEC3", "count": 1_u64 << 22,
            "sparse": { "count": 1, "indices": { "bufferView": indices, "componentType": U16 }, "values": { "bufferView": values } },
        });
    });
    refused(&glb, &["accessors[0]", "without any bytes"]);

    // The same few bytes used again and again.
    let mut glb = Glb::triangle();
    let (indices, values) = (glb.view(&[0, 0]), glb.view(&[0; 12]));
    glb.push("accessors", json!({
        "componentType": F32, "type": "VEC3", "count": 1_u64 << 20,
        "sparse": { "count": 1, "indices": { "bufferView": indices, "componentType": U16 }, "values": { "bufferView": values } },
    }));
    let node =
        json!({ "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 2 } } } });
    glb.json["nodes"] = json!([node, node, node, node, node]);
    glb.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4]);
    refused(&glb, &["nodes[0]", "instances"]);
}

#[test]
fn sparse_values_that_lie() {
    let sparse = |count: u64, index: u16| {
        bent(|g| {
            let indices = g.view(&index.to_le_bytes());
            let values = g.view(&[0; 12]);
            g.json["accessors"][0]["sparse"] = json!({
                "count": count, "indices": { "bufferView": indices, "componentType": U16 }, "values": { "bufferView": values },
            });
        })
    };
    assert!(sparse(1, 2).load().is_ok());
    refused(&sparse(1, 3), &["accessors[0]", "sparse index 3"]);
    refused(&sparse(2, 0), &["accessors[0]", "sparse values"]);
    refused(&sparse(u64::MAX, 0), &["accessors[0]"]);
}

#[test]
fn indices_and_counts_that_do_not_fit() {
    refused(&bent(|g| g.primitive()["indices"] = json!(7)), &["accessors[7]"]);
    refused(
        &bent(|g| g.primitive()["attributes"]["POSITION"] = json!(7)),
        &["meshes[0].primitives[0]", "accessors[7]"],
    );
    refused(&bent(|g| g.primitive()["material"] = json!(0)), &["meshes[0].primitives[0]", "materials[0]"]);
    refused(
        &bent(|g| {
            let at = g.json["bufferViews"][1]["byteOffset"].as_u64().expect("a number") as usize;
            g.binary[at] = 3;
        }),
        &["meshes[0].primitives[0]", "index 3", "3 vertices"],
    );
    noted(&bent(|g| g.json["accessors"][1]["count"] = json!(2)), &["meshes[0].primitives[0]", "last whole triangle"]);
    for (name, kind, values) in [("NORMAL", "VEC3", [0.0_f32; 6].as_slice()), ("COLOR_0", "VEC4", &[1.0; 8])] {
        let glb = bent(|g| {
            let accessor = g.floats(kind, values);
            g.primitive()["attributes"][name] = json!(accessor);
        });
        refused(&glb, &["meshes[0].primitives[0]", name, "3 positions"]);
    }
    refused(&bent(|g| g.primitive()["mode"] = json!(77)), &["mode"]);
    refused(&bent(|g| g.json["nodes"][0]["mesh"] = json!(1)), &["nodes[0] (thing)", "meshes[1]"]);
    refused(&bent(|g| g.json["scenes"][0]["nodes"] = json!([4])), &["scenes[0]", "nodes[4]"]);
    refused(&bent(|g| g.json["scene"] = json!(4)), &["scenes[4]"]);
    noted(&bent(|g| g.json["nodes"][0]["camera"] = json!(0)), &["nodes[0] (thing)", "cameras[0]"]);
    refused(&bent(|g| g.json["nodes"][0]["skin"] = json!(0)), &["nodes[0] (thing)", "skins[0]"]);
    let light = json!({ "KHR_lights_punctual": { "light": 3 } });
    noted(&bent(|g| g.json["nodes"][0]["extensions"] = light), &["nodes[0] (thing)", "lights[3]"]);
}

#[test]
fn numbers_that_are_none() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        refused(&bent(|g| g.binary[4..8].copy_from_slice(&bad.to_le_bytes())), &["accessors[0]", "finite"]);
    }
    // JSON has no infinity, but numbers that are too large for f32.
    for field in ["translation", "scale"] {
        refused(&bent(|g| g.json["nodes"][0][field] = json!([1e39, 0, 0])), &["nodes[0] (thing)", field]);
    }
    let matrix = |last: f64| json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e39, 0, 0, last]);
    refused(&bent(|g| g.json["nodes"][0]["matrix"] = matrix(1.0)), &["nodes[0] (thing)", "matrix"]);
    let projective = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]);
    refused(&bent(|g| g.json["nodes"][0]["matrix"] = projective), &["nodes[0] (thing)", "last row"]);
}

#[test]
fn hierarchies_that_are_no_trees() {
    refused(&bent(|g| g.json["nodes"][0]["children"] = json!([0])), &["nodes[0] (thing)"]);
    refused(&bent(|g| g.json["nodes"][0]["children"] = json!([5])), &["nodes[0] (thing)", "nodes[5]"]);
    let two = |a: Value, b: Value, c: Value| bent(|g| g.json["nodes"] = json!([a, b, c]));
    let child = |i: usize| json!({ "children": [i] });
    refused(&two(json!({}), child(2), child(1)), &["nodes[1]", "ancestor"]);
    refused(&two(child(2), child(2), json!({})), &["nodes[2]", "one parent"]);
    refused(&two(child(1), child(2), child(0)), &["nodes[0]"]);
}

/// A triangle that hangs on two joints.
fn skinned() -> Glb {
    bent(|g| {
        let joints = g.accessor(&[0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], U8, "VEC4", 3);
        let weights = g.floats("VEC4", &[0.5, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        g.primitive()["attributes"]["JOINTS_0"] = json!(joints);
        g.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        g.json["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}, {}]);
        g.json["skins"] = json!([{ "joints": [1, 2] }]);
    })
}

#[test]
fn skins_that_do_not_fit() {
    assert!(skinned().load().is_ok());
    let with = |bend: &dyn Fn(&mut Glb)| {
        let mut glb = skinned();
        bend(&mut glb);
        glb
    };
    refused(&with(&|g| g.json["skins"][0]["joints"] = json!([1])), &["nodes[0]", "joint 1", "skins[0]"]);
    refused(&with(&|g| g.json["skins"][0]["joints"] = json!([1, 9])), &["skins[0]", "nodes[9]"]);
    refused(&with(&|g| g.json["skins"][0]["inverseBindMatrices"] = json!(0)), &["accessors[0]", "inverseBindMatrices"]);
    refused(
        &with(&|g| {
            g.primitive()["attributes"].as_object_mut().expect("an object").remove("WEIGHTS_0");
        }),
        &["meshes[0].primitives[0]", "WEIGHTS_0"],
    );
    refused(
        &with(&|g| {
            let attributes = g.primitive()["attributes"].as_object_mut().expect("an object");
            attributes.remove("WEIGHTS_0");
            attributes.remove("JOINTS_0");
        }),
        &["nodes[0]", "JOINTS_0"],
    );
    refused(
        &with(&|g| {
            let matrices = g.floats("MAT4", &[0.0; 16]);
            g.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
        }),
        &["skins[0]", "2 joints"],
    );
    refused(
        &with(&|g| {
            let weights = g.floats("VEC4", &[-0.5; 12]);
            g.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        }),
        &["negative weight"],
    );
}

#[test]
fn animations_that_do_not_fit() {
    let animated = |times: &[f32], values: &[f32], interpolation: &str, node: usize| {
        bent(|g| {
            let input = g.floats("SCALAR", times);
            let output = g.floats("VEC3", values);
            g.json["animations"] = json!([{
                "name": "turn",
                "channels": [{ "sampler": 0, "target": { "node": node, "path": "translation" } }],
                "samplers": [{ "input": input, "output": output, "interpolation": interpolation }],
            }]);
        })
    };
    let turn = "animations[0] (turn)";
    assert!(animated(&[0.0, 1.0], &[0.0; 6], "LINEAR", 0).load().is_ok());
    assert!(animated(&[0.0, 1.0], &[0.0; 18], "CUBICSPLINE", 0).load().is_ok());
    noted(&animated(&[0.0, 1.0], &[0.0; 6], "CUBICSPLINE", 0), &[turn, "needs 6 values", "has 2"]);
    noted(&animated(&[0.0, 1.0], &[0.0; 9], "LINEAR", 0), &[turn, "needs 2 values"]);
    noted(&animated(&[1.0, 0.5], &[0.0; 6], "LINEAR", 0), &[turn, "before"]);
    assert_eq!(animated(&[-1.0, 0.5], &[0.0; 6], "LINEAR", 0).scene().animations[0].channels[0].times, [-1.0, 0.5]);
    noted(&animated(&[], &[], "LINEAR", 0), &[turn, "no keys"]);
    noted(&animated(&[0.0, f32::NAN], &[0.0; 6], "LINEAR", 0), &["finite"]);
    noted(&animated(&[0.0, 1.0], &[0.0; 6], "LINEAR", 8), &[turn, "nodes[8]"]);
    noted(&animated(&[0.0, 1.0], &[0.0; 6], "WAVY", 0), &[turn]);
    let mut glb = animated(&[0.0, 1.0], &[0.0; 6], "LINEAR", 0);
    glb.json["animations"][0]["channels"][0]["sampler"] = json!(3);
    noted(&glb, &[turn, "samplers[3]"]);
    // A channel without a target node is to be ignored.
    let target = glb.json["animations"][0]["channels"][0]["target"].as_object_mut().expect("an object");
    target.remove("node");
    assert!(glb.scene().animations[0].channels.is_empty());
}

#[test]
fn cameras_and_lights_out_of_range() {
    let camera = |camera: Value| {
        bent(|g| {
            g.json["cameras"] = json!([camera]);
            g.json["nodes"][0]["camera"] = json!(0);
        })
    };
    let perspective = |yfov: f64, znear: f64, zfar: f64| {
        camera(json!({ "type": "perspective", "perspective": { "yfov": yfov, "znear": znear, "zfar": zfar } }))
    };
    assert!(perspective(1.0, 0.1, 10.0).load().is_ok());
    noted(&perspective(0.0, 0.1, 10.0), &["cameras[0]", "yfov"]);
    noted(&perspective(4.0, 0.1, 10.0), &["cameras[0]", "yfov"]);
    noted(&perspective(1.0, 0.0, 10.0), &["cameras[0]", "znear"]);
    noted(&perspective(1.0, 10.0, 1.0), &["cameras[0]", "zfar"]);
    noted(&camera(json!({ "type": "perspective" })), &["cameras[0]"]);
    let flat = json!({ "xmag": 0.0, "ymag": 1.0, "znear": 0.0, "zfar": 1.0 });
    noted(&camera(json!({ "type": "orthographic", "orthographic": flat })), &["cameras[0]", "xmag"]);

    let light = |light: Value| {
        bent(|g| {
            g.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
            g.json["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
        })
    };
    assert!(light(json!({ "type": "directional" })).load().is_ok());
    noted(&light(json!({ "type": "laser" })), &["lights[0]"]);
    noted(&light(json!({ "type": "point", "range": -1.0 })), &["lights[0]", "range"]);
    noted(&light(json!({ "type": "spot", "spot": { "outerConeAngle": 3.0 } })), &["lights[0]", "cone"]);
    noted(&light(json!({ "type": "directional", "intensity": 1e39 })), &["lights[0]", "intensity"]);
}

#[test]
fn required_extensions_that_are_not_there() {
    for extension in ["EXT_primitive_voxels", "KHR_implicit_shapes", "WEB3D_quantized_attributes"] {
        let error = refused(&bent(|g| g.json["extensionsRequired"] = json!([extension])), &[extension]);
        assert!(matches!(error, Error::UnsupportedExtension { .. }), "{error}");
    }
    let known = ["KHR_lights_punctual", "KHR_texture_transform", "EXT_mesh_gpu_instancing", "KHR_mesh_quantization"];
    assert!(
        bent(|g| g.json["extensionsRequired"] = json!(known)).scene().notes.iter().all(|n| !n.contains("not read"))
    );
}

#[test]
fn instances_that_do_not_fit() {
    let instanced = |attributes: Value| {
        bent(|g| {
            g.floats("VEC3", &[0.0; 6]);
            g.floats("VEC4", &[0.0; 8]);
            g.json["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
        })
    };
    assert_eq!(instanced(json!({ "TRANSLATION": 2 })).scene().placed_triangles(), 2);
    refused(&instanced(json!({ "TRANSLATION": 2, "SCALE": 0 })), &["EXT_mesh_gpu_instancing"]);
    refused(&instanced(json!({ "TRANSLATION": 77 })), &["accessors[77]"]);
    refused(&instanced(json!({ "TRANSLATION": -1 })), &["TRANSLATION"]);
    noted(&instanced(json!({ "ROTATION": 3 })), &["nodes[0]", "rotation"]);
    refused(&instanced(json!({})), &["EXT_mesh_gpu_instancing"]);
    refused(&instanced(json!([])), &["EXT_mesh_gpu_instancing"]);
}

#[test]
fn external_files_stay_in_their_folder() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path().join("scene");
    std::fs::create_dir_all(folder.join("sub dir")).expect("a folder");
    let triangle = Glb::triangle();
    let write = |uri: &str| {
        let mut json = triangle.json.clone();
        json["buffers"] = json!([{ "uri": uri, "byteLength": triangle.binary.len() }]);
        let path = folder.join("scene.gltf");
        std::fs::write(&path, json.to_string()).expect("a file");
        load_gltf(&path, &GltfOptions::default())
    };
    std::fs::write(root.path().join("secret.bin"), &triangle.binary).expect("a file");
    std::fs::write(folder.join("sub dir/a.bin"), &triangle.binary).expect("a file");

    assert_eq!(write("sub%20dir/a.bin").unwrap_or_else(|e| panic!("{e}")).placed_triangles(), 1);
    assert_eq!(write("sub dir/../sub dir/a.bin").unwrap_or_else(|e| panic!("{e}")).placed_triangles(), 1);
    for (uri, word) in [("sub/missing.bin", "sub/missing.bin"), ("sub dir", "a folder")] {
        let error = write(uri).expect_err("there is no such file");
        let message = error.to_string();
        assert!(matches!(error, Error::External { .. }), "{error}");
        assert!(["scene.gltf", "buffers[0]", word].iter().all(|part| message.contains(part)), "{message}");
    }
    let absolute = root.path().join("secret.bin").display().to_string();
    for uri in [
        "../secret.bin",
        "..%2Fsecret.bin",
        "sub dir/../../secret.bin",
        "%2e%2e/secret.bin",
        "..\\secret.bin",
        absolute.as_str(),
        &format!("file://{absolute}"),
        "https://example.invalid/a.bin",
        "",
    ] {
        let error = write(uri).expect_err("it leads out of the folder");
        assert!(matches!(error, Error::UnsafeUri { .. }), "{uri}: {error}");
        assert!(error.to_string().contains("buffers[0]") && error.to_string().contains("scene.gltf"), "{error}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(root.path().join("secret.bin"), folder.join("link.bin")).expect("a link");
        assert!(matches!(write("link.bin"), Err(Error::UnsafeUri { .. })));
    }
    // Cut short.
    std::fs::write(folder.join("short.bin"), &triangle.binary[..10]).expect("a file");
    let error = write("short.bin").expect_err("the buffer is too short");
    assert!(error.to_string().contains("buffers[0]"), "{error}");
}

#[test]
fn files_from_memory_have_no_folder() {
    let mut glb = Glb::triangle();
    glb.json["buffers"] = json!([{ "uri": "a.bin", "byteLength": 4 }]);
    assert!(matches!(glb.load(), Err(Error::UnsafeUri { .. })));
    glb.json["buffers"] = json!([{ "byteLength": 4 }, { "byteLength": 4 }]);
    glb.json["bufferViews"][0]["buffer"] = json!(1);
    refused(&glb, &["buffers[1]", "bufferViews[0]"]);
}
