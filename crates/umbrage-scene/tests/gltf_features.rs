//! What glTF can say and how it arrives in a scene.

mod common;

use common::*;
use glam::{DVec3, dvec3};
use serde_json::json;
use umbrage_scene::{AlphaMode, GltfOptions, Lens, LightKind, Scene, Wrap, load_gltf, load_gltf_slice};

fn bent(bend: impl FnOnce(&mut Glb)) -> Scene {
    let mut glb = Glb::triangle();
    bend(&mut glb);
    glb.scene()
}

/// World positions of the corners of all triangles of all objects.
fn corners(scene: &Scene) -> Vec<DVec3> {
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    let mut corners = Vec::new();
    for object in &pose.objects {
        for primitive in &scene.meshes[object.mesh].primitives {
            for &index in &primitive.indices {
                let local = primitive.positions[index as usize];
                corners.push(object.world_from_local.transform_point3(DVec3::from(local.map(f64::from))));
            }
        }
    }
    corners
}

#[track_caller]
fn assert_near(a: DVec3, b: DVec3) {
    assert!(a.distance(b) < 1e-6, "{a} is not {b}");
}

#[test]
fn the_triangle_has_a_flat_normal_and_a_material() {
    let scene = bent(|_| {});
    let primitive = &scene.meshes[0].primitives[0];
    assert_eq!(primitive.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(primitive.material, 0);
    assert!(primitive.uvs.is_empty() && primitive.colors.is_empty() && primitive.joints.is_empty());
}

#[test]
fn json_files_with_data_uris() {
    let glb = Glb::triangle();
    let mut json = glb.json.clone();
    let uri = format!("data:application/octet-stream;base64,{}", base64(&glb.binary));
    json["buffers"] = json!([{ "uri": uri, "byteLength": glb.binary.len() }]);
    let text = format!("\u{feff}{json}");
    let scene = load_gltf_slice("a.gltf", text.as_bytes(), &GltfOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.placed_triangles(), 1);
    // Percent-encoded data, and base64 without its padding.
    let percent: String = glb.binary.iter().map(|byte| format!("%{byte:02X}")).collect();
    let unpadded = uri.trim_end_matches('=').to_owned();
    for uri in [format!("data:application/gltf-buffer,{percent}"), unpadded] {
        json["buffers"][0]["uri"] = json!(uri);
        assert!(load_gltf_slice("a.gltf", json.to_string().as_bytes(), &GltfOptions::default()).is_ok(), "{uri}");
    }
}

#[test]
fn external_buffers_and_pictures() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut glb = Glb::triangle();
    let uvs = glb.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    glb.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    glb.primitive()["material"] = json!(0);
    glb.json["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    glb.json["textures"] = json!([{ "source": 0 }]);
    glb.json["images"] = json!([{ "uri": "pictures/a%20leaf.png" }]);
    glb.json["buffers"] = json!([{ "uri": "all.bin", "byteLength": glb.binary.len() }]);
    std::fs::create_dir(folder.path().join("pictures")).expect("a folder");
    std::fs::write(folder.path().join("pictures/a leaf.png"), png(3, 2, [10, 20, 30, 40])).expect("a file");
    std::fs::write(folder.path().join("all.bin"), &glb.binary).expect("a file");
    std::fs::write(folder.path().join("a.gltf"), glb.json.to_string()).expect("a file");
    let scene =
        load_gltf(&folder.path().join("a.gltf"), &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scene.textures[0].width, scene.textures[0].height), (3, 2));
    assert_eq!(scene.textures[0].rgba[..4], [10, 20, 30, 40]);
}

#[test]
fn children_follow_their_parents_wherever_they_stand_in_the_file() {
    let scene = bent(|g| {
        g.json["nodes"] = json!([
            { "name": "leaf", "mesh": 0, "translation": [1, 0, 0] },
            { "name": "root", "children": [2], "scale": [2, 2, 2], "translation": [0, 10, 0] },
            { "name": "branch", "children": [0], "rotation": [0, 1, 0, 1] },
        ]);
        g.json["scenes"][0]["nodes"] = json!([1]);
    });
    let names: Vec<&str> = scene.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["root", "branch", "leaf"]);
    // +90° about Y takes +X to −Z; then twice as large, then up.
    assert_near(corners(&scene)[0], dvec3(0.0, 10.0, -2.0));
    assert_near(corners(&scene)[1], dvec3(0.0, 10.0, -4.0));
    assert_near(corners(&scene)[2], dvec3(0.0, 12.0, -2.0));
}

#[test]
fn matrices_with_reflection_and_shear() {
    let with = |matrix: [f64; 16]| corners(&bent(|g| g.json["nodes"][0]["matrix"] = json!(matrix)));
    let mirrored = with([-2., 0., 0., 0., 0., 3., 0., 0., 0., 0., 1., 0., 5., 6., 7., 1.]);
    assert_near(mirrored[1], dvec3(3.0, 6.0, 7.0));
    assert_near(mirrored[2], dvec3(5.0, 9.0, 7.0));
    let sheared = with([1., 0., 0., 0., 0.5, 1., 0.25, 0., 0., 0., 1., 0., 5., 6., 7., 1.]);
    assert_near(sheared[1], dvec3(6.0, 6.0, 7.0));
    assert_near(sheared[2], dvec3(5.5, 7.0, 7.25));
}

#[test]
fn only_the_default_scene_is_shown() {
    let scene = bent(|g| {
        g.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }, { "mesh": 0 }]);
        g.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1, 2] }]);
        g.json["scene"] = json!(1);
    });
    assert_eq!(scene.placed_triangles(), 2);
    assert!(scene.notes.iter().any(|note| note.contains("1 nodes do not belong")), "{:?}", scene.notes);
}

#[test]
fn quantized_and_normalized_attributes() {
    let scene = bent(|g| {
        // KHR_mesh_quantization: positions in 16 bits, 8 bytes apart, as plain integers.
        let bytes: Vec<u8> = [[0_i16, 0, 0, 99], [100, 0, 0, 99], [0, -100, 0, 99]]
            .as_flattened()
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let positions = g.accessor(&bytes, I16, "VEC3", 3);
        let view = g.json["accessors"][positions]["bufferView"].as_u64().expect("a number") as usize;
        g.json["bufferViews"][view]["byteStride"] = json!(8);
        g.primitive()["attributes"]["POSITION"] = json!(positions);
        let colors = g.accessor(&[255, 0, 51, 0, 255, 0, 51, 0, 255, 0, 51, 0], U8, "VEC3", 3);
        let view = g.json["accessors"][colors]["bufferView"].as_u64().expect("a number") as usize;
        g.json["bufferViews"][view]["byteStride"] = json!(4);
        g.json["accessors"][colors]["normalized"] = json!(true);
        g.primitive()["attributes"]["COLOR_0"] = json!(colors);
        g.json["nodes"][0]["scale"] = json!([0.01, 0.01, 0.01]);
    });
    assert_near(corners(&scene)[2], dvec3(0.0, -1.0, 0.0));
    assert_eq!(scene.meshes[0].primitives[0].colors[1], [1.0, 0.0, 0.2, 1.0]);
    assert_eq!(scene.meshes[0].primitives[0].normals[0], [0.0, 0.0, -1.0]);
}

#[test]
fn sparse_accessors() {
    let scene = bent(|g| {
        let indices = g.view(&[1, 2]);
        let values = g.view(&[5.0_f32, 6.0, 7.0, 8.0, 9.0, 10.0].map(f32::to_le_bytes).concat());
        g.json["accessors"][0]["sparse"] = json!({
            "count": 2, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values },
        });
    });
    assert_eq!(corners(&scene), [DVec3::ZERO, dvec3(5.0, 6.0, 7.0), dvec3(8.0, 9.0, 10.0)]);
}

#[test]
fn strips_fans_and_lists_without_indices() {
    let quad = |mode: u32| {
        bent(|g| {
            let positions = g.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
            g.json["meshes"] = json!([{ "primitives": [{ "attributes": { "POSITION": positions }, "mode": mode }] }]);
        })
    };
    let strip = quad(5);
    assert_eq!(strip.placed_triangles(), 2);
    assert_eq!(strip.meshes[0].primitives[0].normals, [[0.0, 0.0, 1.0]; 4]);
    assert_eq!(quad(6).placed_triangles(), 2);
    for mode in 0..=3 {
        let scene = quad(mode);
        assert_eq!(scene.placed_triangles(), 0);
        assert!(scene.pose(0.0).unwrap_or_else(|e| panic!("{e}")).objects.is_empty());
        assert!(scene.notes.iter().any(|note| note.contains("points or lines")), "{:?}", scene.notes);
    }
    let unindexed = bent(|g| {
        g.primitive().as_object_mut().expect("an object").remove("indices");
    });
    assert_eq!(unindexed.placed_triangles(), 1);
}

#[test]
fn materials_textures_and_their_coordinates() {
    let scene = bent(|g| {
        let first = g.floats("VEC2", &[9.0; 6]);
        let second = g.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        g.primitive()["attributes"]["TEXCOORD_0"] = json!(first);
        g.primitive()["attributes"]["TEXCOORD_3"] = json!(second);
        g.primitive()["material"] = json!(1);
        let view = g.view(&png(1, 1, [1, 2, 3, 4]));
        g.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
        g.json["samplers"] = json!([{ "wrapS": 33071 }, { "wrapT": 33648 }]);
        g.json["textures"] =
            json!([{ "source": 0, "sampler": 0 }, { "source": 0, "sampler": 1 }, { "source": 0, "sampler": 0 }]);
        let texture = |index: u32| {
            json!({ "index": index, "texCoord": 0, "extensions": {
            "KHR_texture_transform": { "offset": [0.25, 0.0], "scale": [2.0, 3.0], "texCoord": 3 } } })
        };
        g.json["materials"] = json!([
            { "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorTexture": texture(0) } },
            { "name": "leaf", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true, "emissiveFactor": [0.0, 0.5, 0.0],
              "extensions": { "KHR_materials_unlit": {}, "KHR_materials_emissive_strength": { "emissiveStrength": 4.0 } },
              "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "baseColorTexture": texture(1) } },
            { "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorTexture": texture(2) } },
            { "extensions": { "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [0.5, 0.5, 0.5, 1.0], "diffuseTexture": { "index": 0 } } } },
        ]);
    });
    let leaf = &scene.materials[1];
    assert_eq!(leaf.alpha, AlphaMode::Mask { cutoff: 0.25 });
    assert!(leaf.double_sided && leaf.name == "leaf");
    assert_eq!((leaf.base_color, leaf.emissive), ([0.1, 0.2, 0.3, 0.4], [0.0, 2.0, 0.0]));
    assert_eq!(scene.materials[0].alpha, AlphaMode::Blend);
    assert_eq!(scene.materials[2].alpha, AlphaMode::Mask { cutoff: 0.5 });
    assert_eq!((scene.materials[3].base_color, scene.materials[3].base_color_texture), ([0.5, 0.5, 0.5, 1.0], Some(0)));
    // The first and third differ in nothing and are stored once.
    assert_eq!(scene.textures.len(), 2);
    assert_eq!(scene.materials[0].base_color_texture, scene.materials[2].base_color_texture);
    let texture = &scene.textures[leaf.base_color_texture.expect("the leaf has a texture")];
    assert_eq!((texture.wrap, texture.rgba.as_slice()), ([Wrap::Repeat, Wrap::Mirror], [1, 2, 3, 4].as_slice()));
    assert_eq!(scene.meshes[0].primitives[0].uvs, [[0.25, 0.0], [2.25, 0.0], [0.25, 3.0]]);
}

#[test]
fn instances_are_placed_relative_to_their_node() {
    let scene = bent(|g| {
        let places = g.floats("VEC3", &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        let turns = g.accessor(&[0, 0, 0, 127, 0, 0, 127, 0], I8, "VEC4", 2);
        g.json["accessors"][turns]["normalized"] = json!(true);
        g.json["nodes"][0]["translation"] = json!([10, 0, 0]);
        g.json["nodes"][0]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places, "ROTATION": turns } } });
    });
    assert_eq!(scene.placed_triangles(), 2);
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(pose.objects.iter().map(|o| (o.node, o.instance)).collect::<Vec<_>>(), [(0, Some(0)), (0, Some(1))]);
    let corners = corners(&scene);
    assert_near(corners[0], dvec3(11.0, 0.0, 0.0));
    // Half a turn about Z.
    assert_near(corners[4], dvec3(9.0, 2.0, 0.0));
    assert_near(corners[5], dvec3(10.0, 1.0, 0.0));
}

#[test]
fn cameras_lights_and_marks() {
    let scene = bent(|g| {
        g.json["cameras"] = json!([
            { "name": "eye", "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.5, "aspectRatio": 1.5 } },
            { "type": "orthographic", "orthographic": { "xmag": 4.0, "ymag": 3.0, "znear": 0.0, "zfar": 9.0 } },
        ]);
        g.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
            { "name": "lamp", "type": "spot", "intensity": 7.0, "range": 20.0, "color": [1.0, 0.5, 0.25], "spot": { "outerConeAngle": 0.5 } },
            { "type": "directional" },
        ] } });
        g.json["nodes"] = json!([
            { "name": "plan", "camera": 1, "mesh": 0, "extras": { "castShadow": false } },
            { "name": "sun", "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 1 } }, "extras": { "castShadow": 0, "other": [] } },
            { "mesh": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } }, "extras": { "castShadow": true } },
        ]);
        g.json["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    });
    let cameras: Vec<_> = scene.cameras.iter().map(|c| (c.name.as_str(), c.node)).collect();
    assert_eq!(cameras, [("eye", 1), ("plan", 0)], "in the file's order, with their nodes' names where they have none");
    assert_eq!(scene.cameras[0].lens, Lens::Perspective { yfov: 1.0, aspect: Some(1.5), znear: 0.5, zfar: None });
    assert_eq!(scene.cameras[1].lens, Lens::Orthographic { xmag: 4.0, ymag: 3.0, znear: 0.0, zfar: 9.0 });
    let lights: Vec<_> = scene.lights.iter().map(|l| (l.name.as_str(), l.node, l.kind)).collect();
    let spot = LightKind::Spot { inner: 0.0, outer: 0.5 };
    assert_eq!(lights, [("lamp", 2, spot), ("sun", 1, LightKind::Directional)]);
    assert_eq!((scene.lights[0].range, scene.lights[0].intensity), (Some(20.0), 7.0));
    assert_eq!(scene.nodes.iter().map(|n| n.cast_shadow).collect::<Vec<_>>(), [false, true, true]);
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(pose.objects.iter().map(|o| o.casts).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn blended_surfaces_throw_no_shadow() {
    let scene = bent(|g| {
        g.json["materials"] = json!([{ "alphaMode": "BLEND" }]);
        g.primitive()["material"] = json!(0);
    });
    assert!(!scene.pose(0.0).unwrap_or_else(|error| panic!("{error}")).objects[0].casts);
}

#[test]
fn more_than_four_joints_keep_the_strongest() {
    let scene = bent(|g| {
        let first = g.accessor(&[0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3], U8, "VEC4", 3);
        let second = g.accessor(&[4, 5, 0, 0, 4, 5, 0, 0, 4, 5, 0, 0], U8, "VEC4", 3);
        let weak = g.floats("VEC4", &[0.1, 0.1, 0.05, 0.15].repeat(3));
        let strong = g.floats("VEC4", &[0.4, 0.2, 0.0, 0.0].repeat(3));
        let attributes = &mut g.primitive()["attributes"];
        attributes["JOINTS_0"] = json!(first);
        attributes["WEIGHTS_0"] = json!(weak);
        attributes["JOINTS_1"] = json!(second);
        attributes["WEIGHTS_1"] = json!(strong);
        g.json["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}, {}, {}, {}, {}, {}]);
        g.json["skins"] = json!([{ "joints": [1, 2, 3, 4, 5, 6] }]);
    });
    let primitive = &scene.meshes[0].primitives[0];
    assert_eq!(primitive.joints[0], [4, 5, 3, 0]);
    assert!((primitive.weights[0].iter().sum::<f32>() - 1.0).abs() < 1e-6);
    assert!((primitive.weights[0][0] - 0.4 / 0.85).abs() < 1e-6);
}

#[test]
fn vertices_without_weights_and_normals_without_length_are_put_right() {
    let scene = bent(|g| {
        let normals = g.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0]);
        g.primitive()["attributes"]["NORMAL"] = json!(normals);
        let joints = g.accessor(&[1, 0, 0, 0].repeat(3), U8, "VEC4", 3);
        let weights = g.floats("VEC4", &[0.0; 12]);
        g.primitive()["attributes"]["JOINTS_0"] = json!(joints);
        g.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
    });
    let primitive = &scene.meshes[0].primitives[0];
    assert_eq!(primitive.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    assert_eq!((primitive.weights[0], primitive.joints[0]), ([1.0, 0.0, 0.0, 0.0], [1, 0, 0, 0]));
    assert_eq!(scene.notes.len(), 2, "{:?}", scene.notes);
}

#[test]
fn nodes_keep_the_digits_of_their_numbers() {
    // In f32 a metre is lost at 100,000 km, and with it where a camera stands beside what it sees.
    let mut glb = Glb::triangle();
    glb.json["nodes"] = json!([
        { "mesh": 0, "translation": [100_000_000.125, 0.1, -999_999_999.75] },
        { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 100_000_000.125, 0.1, -999_999_999.75, 1] },
    ]);
    glb.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    let scene = glb.scene();
    for node in &scene.nodes {
        assert_eq!(node.local.translation.to_array(), [100_000_000.125, 0.1, -999_999_999.75]);
    }
}

/// A triangle of 1 m for every 2 m of 2 × 2 km: loaded, posed and planned.
#[test]
fn a_million_instances_are_loaded_and_planned() {
    const SIDE: usize = 1000;
    let mut glb = Glb::triangle();
    let places: Vec<f32> =
        (0..SIDE * SIDE).flat_map(|i| [2.0 * (i % SIDE) as f32, 0.0, -2.0 * (i / SIDE) as f32]).collect();
    let translations = glb.floats("VEC3", &places);
    glb.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    glb.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    let scene = glb.scene();
    assert_eq!((scene.placed_triangles(), scene.notes.len()), (SIDE * SIDE, 0));
    let pose = scene.pose(0.0).expect("a pose");
    let boxes: Vec<umbrage::Aabb> = pose.objects.iter().map(|object| object.bounds).collect();
    assert_eq!(boxes.len(), SIDE * SIDE);
    assert_eq!(boxes[SIDE * SIDE - 1].min, DVec3::new(1998.0, 0.0, -1998.0));

    let lens = umbrage::Frustum::perspective(1.0, 1.5, 0.1, f64::INFINITY).expect("a lens");
    let view = umbrage::View::look_at_upright(DVec3::new(1000.0, 2.0, 5.0), DVec3::new(1000.0, 0.0, -20.0), lens);
    let sun = umbrage::DirectionalLight::new(DVec3::new(-0.5, -0.7, -0.3)).expect("a direction");
    let mut planner = umbrage::Planner::new(&umbrage::ShadowConfig::default()).expect("the default is valid");
    let inputs = umbrage::PlanInputs::new(view.as_ref().expect("a view"), sun, &boxes, &boxes);
    let plan = planner.plan_frame(&inputs).expect("a plan");
    let listed = |split: usize| plan.casters(split).len();
    // The one at the view's middle casts into the first map; most of the field does into none.
    assert!(plan.casters(0).contains(&(2 * SIDE as u32 + 500)), "{} casters", listed(0));
    assert!(listed(0) < 1000 && (0..plan.splits.len()).map(listed).max() > Some(10_000));
}
