//! What people's files have that the specification does not want, or hardly anybody uses: read,
//! with a note where something is left out.

mod common;

use common::*;
use glam::{DVec3, dvec3};
use serde_json::{Value, json};
use umbrage_scene::{GltfOptions, OpenOptions, Scene, TextureFilter, load_gltf, load_gltf_slice, open};

fn bent(bend: impl FnOnce(&mut Glb)) -> Scene {
    let mut glb = Glb::triangle();
    bend(&mut glb);
    glb.scene()
}

/// The one note of a scene has all of `parts`.
#[track_caller]
fn noted(scene: &Scene, parts: &[&str]) {
    assert_eq!(scene.notes.len(), 1, "{:?}", scene.notes);
    assert!(parts.iter().all(|part| scene.notes[0].contains(part)), "{parts:?} in {:?}", scene.notes);
}

/// Where the objects of a scene start.
fn places(scene: &Scene) -> Vec<DVec3> {
    let pose = scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"));
    pose.objects.iter().map(|object| object.world_from_local.translation).collect()
}

#[test]
fn a_child_that_the_scene_lists_too_is_shown_once_under_its_parent() {
    let nodes = json!([{ "children": [1], "translation": [5, 0, 0] }, { "mesh": 0, "translation": [0, 1, 0] }]);
    let with = |roots: Value| {
        bent(|g| {
            g.json["nodes"] = nodes.clone();
            g.json["scenes"][0]["nodes"] = roots;
        })
    };
    for (roots, words) in [
        (json!([0, 1]), ["nodes[1]", "besides its parent"]),
        (json!([1, 0]), ["nodes[1]", "besides its parent"]),
        (json!([0, 0]), ["nodes[0]", "twice"]),
    ] {
        let scene = with(roots);
        assert_eq!(places(&scene), [dvec3(5.0, 1.0, 0.0)]);
        noted(&scene, &words);
    }
    // Without its parent it is a root.
    let scene = with(json!([1]));
    assert_eq!(places(&scene), [dvec3(0.0, 1.0, 0.0)]);
    assert!(scene.notes.iter().any(|note| note.contains("nodes[1]: listed in scenes[0] without its parent")));
}

#[test]
fn accessors_without_a_buffer_view_are_zeros() {
    let zeros =
        |g: &mut Glb, kind: &str| g.push("accessors", json!({ "componentType": F32, "type": kind, "count": 3 }));
    let scene = bent(|g| {
        let (colors, normals) = (zeros(g, "VEC4"), zeros(g, "VEC3"));
        g.primitive()["attributes"]["COLOR_0"] = json!(colors);
        g.primitive()["attributes"]["NORMAL"] = json!(normals);
    });
    let primitive = &scene.meshes[0].primitives[0];
    assert_eq!((&primitive.colors[..], &primitive.normals[..]), (&[[0.0; 4]; 3][..], &[[0.0, 0.0, 1.0]; 3][..]));
    noted(&scene, &["meshes[0].primitives[0]", "normals of no length"]);
}

#[test]
fn numbers_written_with_a_point_are_whole() {
    let scene = bent(|g| {
        g.json["accessors"][0]["count"] = json!(3.0);
        g.json["nodes"][0]["mesh"] = json!(0.0);
        g.json["asset"]["version"] = json!(2.0);
    });
    assert_eq!(scene.placed_triangles(), 1);
    assert!(scene.notes.is_empty());
}

#[test]
fn buffers_that_nobody_uses_may_be_missing() {
    let mut glb = Glb::triangle();
    let length = glb.binary.len();
    glb.json["buffers"] =
        json!([{ "byteLength": length }, { "byteLength": 9 }, { "byteLength": 9, "uri": "nowhere.bin" }]);
    assert!(glb.scene().notes.is_empty());
}

#[test]
fn corners_beyond_the_last_triangle_are_left_out() {
    let scene = bent(|g| {
        let indices = g.accessor(&[0, 1, 2, 0], U8, "SCALAR", 4);
        g.primitive()["indices"] = json!(indices);
    });
    assert_eq!(scene.placed_triangles(), 1);
    noted(&scene, &["meshes[0].primitives[0]", "left out"]);
}

#[test]
fn rotations_of_no_length_do_not_rotate() {
    let scene = bent(|g| g.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]));
    assert!(scene.pose(0.0).unwrap_or_else(|error| panic!("{error}")).objects[0].bounds.max.x == 1.0);
    noted(&scene, &["nodes[0] (thing)", "rotation"]);
}

#[test]
fn nearly_affine_matrices_are_affine() {
    let with = |last_row: [f64; 4]| {
        let [x, y, z, w] = last_row;
        let mut glb = Glb::triangle();
        glb.json["nodes"][0]["matrix"] = json!([1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 6, 0, 0, w]);
        glb.load()
    };
    for (last_row, place) in
        [([0.0, 1e-9, 0.0, 1.0], 6.0), ([0.0, 0.0, 0.0, 0.999_999], 6.0), ([0.0, 0.0, 0.0, 2.0], 3.0)]
    {
        let scene = with(last_row).unwrap_or_else(|error| panic!("{error}"));
        assert!((places(&scene)[0].x - place).abs() < 1e-4, "{last_row:?}");
    }
    for last_row in [[0.5, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0]] {
        assert!(with(last_row).is_err(), "{last_row:?}");
    }
}

#[test]
fn cameras_lights_and_animations_of_the_wrong_type_are_left_out() {
    let scene = bent(|g| {
        g.json["cameras"] = json!([{ "type": "perspective", "perspective": { "znear": 0.1 } }]);
        g.json["nodes"][0]["camera"] = json!(0);
        g.json["animations"] = json!([{ "channels": "none" }]);
        g.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "color": 7 }] } });
        g.json["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
    });
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.animations.len()), (0, 0, 0));
    let notes = scene.notes.join("\n");
    for part in ["camera of nodes[0] (thing)", "yfov", "light of nodes[0] (thing)", "animations[0]"] {
        assert!(notes.contains(part), "{part} in {notes}");
    }
}

#[test]
fn invisible_nodes_show_and_light_nothing() {
    for required in [false, true] {
        let scene = bent(|g| {
            let hidden = json!({ "KHR_node_visibility": { "visible": false } });
            let lamp = json!({ "KHR_lights_punctual": { "light": 0 } });
            g.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
            g.json["nodes"] = json!([
                { "mesh": 0, "children": [1], "extensions": hidden },
                { "mesh": 0, "extensions": lamp },
                { "mesh": 0, "extensions": { "KHR_node_visibility": { "visible": true } } },
            ]);
            g.json["scenes"][0]["nodes"] = json!([0, 2]);
            if required {
                g.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
            }
        });
        assert_eq!((scene.placed_triangles(), scene.lights.len()), (1, 0));
        noted(&scene, &["nodes[0]", "2 nodes are invisible"]);
    }
}

#[test]
fn extensions_that_change_no_shape_may_be_required() {
    let scene = bent(|g| g.json["extensionsRequired"] = json!(["KHR_materials_clearcoat", "VRM", "EXT_texture_avif"]));
    assert_eq!((scene.placed_triangles(), scene.notes.len()), (1, 3));
    assert!(scene.notes.iter().all(|note| note.contains("extensionsRequired")), "{:?}", scene.notes);
}

/// Boxes with textures, one for each picture.
fn textured(pictures: &[Vec<u8>]) -> Glb {
    let mut glb = Glb::triangle();
    let uvs = glb.floats("VEC2", &[0.0; 6]);
    glb.primitive()["attributes"]["TEXCOORD_0"] = json!(uvs);
    glb.primitive()["material"] = json!(0);
    for picture in pictures {
        let view = glb.view(picture);
        let image = glb.push("images", json!({ "bufferView": view }));
        let texture = glb.push("textures", json!({ "source": image }));
        glb.push("materials", json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }));
    }
    glb
}

/// As files come from systems that take `Bark.png` and `bark.png` for one.
#[test]
fn a_texture_whose_name_differs_in_case_is_left_out_unless_an_alpha_mask_needs_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("Bark.png"), png(2, 2, [9, 8, 7, 255])).expect("a file");
    if folder.path().join("bark.png").exists() {
        // This file system takes them for one, too.
        return;
    }
    let load = |name: &str, mode: &str| {
        let mut glb = textured(&[png(1, 1, [0; 4])]);
        glb.json["images"] = json!([{ "uri": name }]);
        glb.json["materials"][0]["alphaMode"] = json!(mode);
        let path = folder.path().join("tree.glb");
        std::fs::write(&path, glb.bytes()).expect("a file");
        load_gltf(&path, &GltfOptions::default())
    };
    let found = load("Bark.png", "MASK").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((found.textures.len(), found.textures[0].width, found.notes.len()), (1, 2, 0));
    let scene = load("bark.png", "OPAQUE").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scene.textures.len(), scene.placed_triangles()), (0, 1));
    noted(&scene, &["images[0]", "bark.png", "left out"]);
    let error = load("bark.png", "MASK").expect_err("its alpha is not known").to_string();
    assert!(["materials[0]", "images[0]", "bark.png"].iter().all(|part| error.contains(part)), "{error}");
}

#[test]
fn textures_beyond_the_budget_are_scaled_down() {
    let pictures: Vec<Vec<u8>> = [256, 256, 64].map(|edge| png(edge, edge, [9, 8, 7, 255])).into();
    let load = |texture_bytes: u64| {
        let options = GltfOptions { texture_bytes, ..GltfOptions::default() };
        load_gltf_slice("a.glb", &textured(&pictures).bytes(), &options).unwrap_or_else(|error| panic!("{error}"))
    };
    let sizes = |scene: &Scene| scene.textures.iter().map(|texture| texture.width).collect::<Vec<_>>();
    let whole = load(u64::MAX);
    assert_eq!((sizes(&whole), whole.notes.len()), (vec![256, 256, 64], 0));
    let half = load(4 * (2 * 128 * 128 + 64 * 64));
    assert_eq!(sizes(&half), [128, 128, 64], "the small one stays");
    noted(&half, &["images[0] and 1 more", "256×256 to 128×128"]);
    assert!(half.textures.iter().all(|texture| texture.rgba.starts_with(&[9, 8, 7, 255])));
    assert_eq!(sizes(&load(1)), [1, 1, 1], "something is left of each");
}

#[test]
fn nine_large_textures_load() {
    let scene = textured(&vec![png(4096, 4096, [9, 8, 7, 255]); 9]).scene();
    assert_eq!(scene.textures.len(), 9);
    assert!(scene.textures.iter().map(|texture| texture.rgba.len()).sum::<usize>() <= 512 << 20);
    noted(&scene, &["images[0] and 8 more", "4096×4096"]);
}

#[test]
fn the_nearest_filter_arrives() {
    let filter = |sampler: Value| {
        let mut glb = textured(&[png(1, 1, [0; 4])]);
        glb.json["samplers"] = json!([sampler]);
        glb.json["textures"][0]["sampler"] = json!(0);
        glb.scene().textures[0].filter
    };
    assert_eq!(filter(json!({ "magFilter": 9728 })), TextureFilter::Nearest);
    assert_eq!(filter(json!({ "magFilter": 9729, "minFilter": 9728 })), TextureFilter::Linear);
    assert_eq!(filter(json!({})), TextureFilter::Linear);
}

#[test]
fn webp_pictures_are_read() {
    let mut webp = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(3, 2, image::Rgba([10, 20, 30, 40]))
        .write_to(&mut webp, image::ImageFormat::WebP)
        .expect("a small picture can be encoded");
    let mut glb = textured(&[webp.into_inner()]);
    glb.json["textures"][0] = json!({ "extensions": { "EXT_texture_webp": { "source": 0 } } });
    glb.json["extensionsRequired"] = json!(["EXT_texture_webp"]);
    let scene = glb.scene();
    assert_eq!((scene.textures[0].width, &scene.textures[0].rgba[..4]), (3, &[10, 20, 30, 40][..]));
    assert!(scene.notes.is_empty());
}

#[test]
fn basis_pictures_are_read() {
    let files: [&[u8]; 2] = [include_bytes!("files/disc-etc1s.ktx2"), include_bytes!("files/disc-uastc.ktx2")];
    for ktx in files {
        let mut glb = textured(&[ktx.to_vec()]);
        glb.json["textures"][0] = json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } });
        glb.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
        let scene = glb.scene();
        let texture = &scene.textures[0];
        assert_eq!((texture.width, texture.height, scene.notes.len()), (64, 48, 0));
        for (x, y) in [(8, 8), (32, 24), (32, 12), (50, 40), (20, 24)] {
            let texel = &texture.rgba[4 * (64 * y + x)..][..4];
            let inside = (x as i32 - 32).pow(2) + (y as i32 - 24).pow(2) < 300;
            assert_eq!(texel[3] > 127, inside, "{x} {y}");
            let wanted = [4 * x, 5 * y, 128];
            assert!((0..3).all(|i| i32::from(texel[i]).abs_diff(wanted[i] as i32) < 40), "{x} {y}: {texel:?}");
        }
        // A level of half the size, or one made of the whole.
        let options = GltfOptions { texture_bytes: 4 * 32 * 24, ..GltfOptions::default() };
        let half = load_gltf_slice("a.glb", &glb.bytes(), &options).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((half.textures[0].width, half.textures[0].height), (32, 24));
        for length in [0, 30, 80, ktx.len() / 2] {
            let mut glb = textured(&[ktx[..length].to_vec()]);
            glb.json["textures"][0] = json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } });
            noted(&glb.scene(), &["materials[0]", "images[0]"]);
        }
    }
}

#[test]
fn what_begins_as_a_glb_is_one() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for name in ["avatar.vrm", "noextension"] {
        let path = folder.path().join(name);
        std::fs::write(&path, Glb::triangle().bytes()).expect("a file");
        let scene =
            open(&path.display().to_string(), &OpenOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.placed_triangles(), 1, "{name}");
    }
}

#[test]
fn files_beside_the_folder_are_reached_if_they_may_be() {
    let root = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(root.path().join("models")).expect("a folder");
    let mut glb = Glb::triangle();
    std::fs::write(root.path().join("all.bin"), &glb.binary).expect("a file");
    glb.json["buffers"] = json!([{ "uri": "../all.bin", "byteLength": glb.binary.len() }]);
    let path = root.path().join("models/a.gltf");
    std::fs::write(&path, glb.json.to_string()).expect("a file");
    let error = load_gltf(&path, &GltfOptions::default()).expect_err("it leads out of the folder").to_string();
    assert!(error.contains("--parent-folders"), "{error}");
    let options = GltfOptions { parent_folders: true, ..GltfOptions::default() };
    assert_eq!(load_gltf(&path, &options).unwrap_or_else(|error| panic!("{error}")).placed_triangles(), 1);
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_no_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pipe = folder.path().join("pipe.glb");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo makes a pipe");
    for (path, kind) in [(pipe.as_path(), "a pipe"), (folder.path(), "a folder")] {
        let error = load_gltf(path, &GltfOptions::default()).expect_err("it is no file").to_string();
        assert!(error.contains(kind), "{error}");
    }
}
