//! Morph targets: their shapes, in bounds, under skins, instances and animation, and through
//! export.

mod common;

use common::*;
use glam::{DVec3, dvec3};
use serde_json::{Value, json};
use umbrage_scene::{GltfOptions, Pose, Scene, export_glb, load_gltf_slice};

/// A triangle with normals that a target lifts by 1 m along Y, another moves by 2 m along X.
fn morphed(bend: impl FnOnce(&mut Glb)) -> Scene {
    let mut glb = Glb::triangle();
    let normals = glb.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let up = glb.floats("VEC3", &[0.0, 1.0, 0.0].repeat(3));
    let aside = glb.floats("VEC3", &[2.0, 0.0, 0.0].repeat(3));
    let turned = glb.floats("VEC3", &[0.0, 1.0, -1.0].repeat(3));
    glb.primitive()["attributes"]["NORMAL"] = json!(normals);
    glb.primitive()["targets"] = json!([{ "POSITION": up, "NORMAL": turned }, { "POSITION": aside }]);
    bend(&mut glb);
    glb.scene()
}

fn pose(scene: &Scene, time: f64) -> Pose {
    scene.pose(time).unwrap_or_else(|error| panic!("{error}"))
}

/// The first corner of the first object, in the world.
fn corner(pose: &Pose) -> DVec3 {
    let object = &pose.objects[0];
    let shape = &pose.skinned[object.skinned.expect("it is posed")];
    object.world_from_local.transform_point3(DVec3::from(shape.positions[0][0].map(f64::from)))
}

#[track_caller]
fn assert_near(a: DVec3, b: DVec3) {
    assert!(a.distance(b) < 1e-6, "{a} is not {b}");
}

#[test]
fn weights_of_the_mesh_and_of_the_node_move_vertices_normals_and_bounds() {
    let scene = morphed(|g| g.json["meshes"][0]["weights"] = json!([1.0, 0.5]));
    let posed = pose(&scene, 0.0);
    assert_near(corner(&posed), dvec3(1.0, 1.0, 0.0));
    assert_near(posed.objects[0].bounds.min, dvec3(1.0, 1.0, 0.0));
    assert_near(posed.objects[0].bounds.max, dvec3(2.0, 2.0, 0.0));
    assert_eq!(posed.skinned[0].normals[0][0], [0.0, 1.0, 0.0]);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);

    let scene = morphed(|g| {
        g.json["meshes"][0]["weights"] = json!([1.0, 0.5]);
        g.json["nodes"][0]["weights"] = json!([0.0, 2.0]);
        g.json["nodes"][0]["translation"] = json!([0, 0, 7]);
    });
    assert_near(corner(&pose(&scene, 0.0)), dvec3(4.0, 0.0, 7.0));
    assert_eq!(pose(&scene, 0.0).skinned[0].normals[0][0], [0.0, 0.0, 1.0]);
    // Without weights: the base shape.
    assert_near(corner(&pose(&morphed(|_| {}), 0.0)), DVec3::ZERO);
}

#[test]
fn animations_change_weights() {
    let animated = |interpolation: &str, values: &[f32]| {
        morphed(|g| {
            let (input, output) = (g.floats("SCALAR", &[0.0, 2.0]), g.floats("SCALAR", values));
            g.json["animations"] = json!([{
                "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
                "samplers": [{ "input": input, "output": output, "interpolation": interpolation }],
            }]);
        })
    };
    let linear = animated("LINEAR", &[0.0, 0.0, 1.0, 2.0]);
    assert_near(corner(&pose(&linear, 0.5)), dvec3(1.0, 0.25, 0.0));
    assert_near(corner(&pose(&animated("STEP", &[0.5, 0.0, 1.0, 2.0]), 1.9)), dvec3(0.0, 0.5, 0.0));
    let spline = animated("CUBICSPLINE", &[0., 0., 1., 0., 0., 0., 0., 0., 3., 0., 0., 0.]);
    assert_near(corner(&pose(&spline, 1.0)), dvec3(0.0, 2.0, 0.0));
    let uneven = animated("LINEAR", &[0.0, 0.0, 1.0]);
    assert!(uneven.animations.is_empty() && uneven.notes[0].contains("animations[0]"), "{:?}", uneven.notes);
}

#[test]
fn morphs_come_before_skins_and_serve_all_instances() {
    let skinned = morphed(|g| {
        let joints = g.accessor(&[0; 12], U8, "VEC4", 3);
        let weights = g.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
        g.primitive()["attributes"]["JOINTS_0"] = json!(joints);
        g.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        g.json["meshes"][0]["weights"] = json!([1.0]);
        g.json["nodes"] = json!([{ "mesh": 0, "skin": 0, "translation": [9, 9, 9] }, { "scale": [1, 3, 1] }]);
        g.json["scenes"][0]["nodes"] = json!([0, 1]);
        g.json["skins"] = json!([{ "joints": [1] }]);
    });
    assert_near(corner(&pose(&skinned, 0.0)), dvec3(0.0, 3.0, 0.0));

    let instanced = morphed(|g| {
        let places = g.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 5.0]);
        g.json["meshes"][0]["weights"] = json!([1.0]);
        g.json["nodes"][0]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    });
    let posed = pose(&instanced, 0.0);
    assert_eq!((posed.objects.len(), posed.skinned.len()), (2, 1));
    assert_near(posed.objects[1].bounds.min, dvec3(0.0, 1.0, 5.0));
}

#[test]
fn shapes_without_normals_stay_flat() {
    let mut glb = Glb::triangle();
    // The corner on the X axis moves up along Z: the plane tilts.
    let tilt = glb.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    glb.primitive()["targets"] = json!([{ "POSITION": tilt }]);
    glb.json["meshes"][0]["weights"] = json!([1.0]);
    let posed = pose(&glb.scene(), 0.0);
    let normal = DVec3::from(posed.skinned[0].normals[0][0].map(f64::from));
    assert_near(normal, dvec3(-1.0, 0.0, 1.0).normalize());
}

#[test]
fn targets_come_back_from_export() {
    let scene = morphed(|g| {
        g.json["meshes"][0]["weights"] = json!([0.25, 0.5]);
        g.json["nodes"][0]["weights"] = json!([1.0, 2.0]);
        let (input, output) = (g.floats("SCALAR", &[0.0, 2.0]), g.floats("SCALAR", &[0.0, 0.0, 1.0, 2.0]));
        g.json["animations"] = json!([{
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
            "samplers": [{ "input": input, "output": output }],
        }]);
    });
    let bytes = export_glb(&scene).unwrap_or_else(|error| panic!("{error}"));
    let again = load_gltf_slice("again.glb", &bytes, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    for time in [0.0, 0.7, 1.9] {
        assert_near(corner(&pose(&again, time)), corner(&pose(&scene, time)));
    }
    assert_eq!(
        (&again.meshes[0].weights, &again.nodes[0].weights),
        (&scene.meshes[0].weights, &scene.nodes[0].weights)
    );
}

#[test]
fn targets_that_do_not_fit() {
    let refused = |targets: Value| {
        let mut glb = Glb::triangle();
        glb.floats("VEC3", &[0.0; 6]);
        glb.primitive()["targets"] = targets;
        glb.load().expect_err("it does not fit").to_string()
    };
    assert!(refused(json!([{ "POSITION": 2 }])).contains("targets[0].POSITION"));
    assert!(refused(json!([{}, { "NORMAL": 99 }])).contains("accessors[99]"));
}
