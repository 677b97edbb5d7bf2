//! Poses: animation, hierarchy, skinning and bounds against closed forms and brute force.

use glam::{DAffine3, DMat4, DQuat, DVec3, Mat4, dvec3};
use proptest::prelude::*;
use umbrage::Aabb;
use umbrage_scene::{
    AlphaMode, Animation, Channel, Error, Interpolation, Keys, Lens, Material, Mesh, Node, Pose, Poser, Primitive,
    Scene, SceneCamera, Skin, Trs, camera_view,
};

fn triangle(material: usize) -> Primitive {
    Primitive {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        indices: vec![0, 1, 2],
        material,
        ..Primitive::default()
    }
}

fn scene_of(nodes: Vec<Node>) -> Scene {
    Scene {
        name: "test".into(),
        meshes: vec![Mesh { name: "triangle".into(), primitives: vec![triangle(0)], ..Mesh::default() }],
        materials: vec![Material::default()],
        nodes,
        ..Scene::default()
    }
}

fn moved(channel: Channel) -> Scene {
    let duration = f64::from(channel.times[channel.times.len() - 1]);
    let mut scene = scene_of(vec![Node { mesh: Some(0), ..Node::default() }]);
    scene.animations.push(Animation { name: "clip".into(), channels: vec![channel], duration });
    scene
}

#[track_caller]
fn pose(scene: &Scene, time: f64) -> Pose {
    scene.pose(time).unwrap_or_else(|error| panic!("{error}"))
}

fn translation_at(scene: &Scene, time: f64) -> DVec3 {
    pose(scene, time).world_from_node[0].translation
}

const NEAR: f64 = 1e-9;

#[test]
fn linear_and_step_translations() {
    let keys = || Keys::Translation(vec![[0.0, 0.0, 0.0], [4.0, 0.0, -8.0], [4.0, 6.0, 0.0]]);
    let channel = |interpolation| Channel { node: 0, times: vec![1.0, 3.0, 4.0], values: keys(), interpolation };
    let linear = moved(channel(Interpolation::Linear));
    for (time, expected) in [
        (0.0, [0.0, 0.0, 0.0]),
        (1.0, [0.0, 0.0, 0.0]),
        (1.5, [1.0, 0.0, -2.0]),
        (3.0, [4.0, 0.0, -8.0]),
        (3.75, [4.0, 4.5, -2.0]),
        (4.0, [0.0, 0.0, 0.0]),
        (4.0 + 1.5, [1.0, 0.0, -2.0]),
        (-0.25, [4.0, 4.5, -2.0]),
    ] {
        assert!(translation_at(&linear, time).distance(expected.into()) < NEAR, "{time}");
    }
    let step = moved(channel(Interpolation::Step));
    for (time, expected) in
        [(0.5, [0.0, 0.0, 0.0]), (2.9, [0.0, 0.0, 0.0]), (3.0, [4.0, 0.0, -8.0]), (3.9, [4.0, 0.0, -8.0])]
    {
        assert_eq!(translation_at(&step, time), DVec3::from(expected), "{time}");
    }
}

#[test]
fn cubic_splines_are_the_cubics_they_came_from() {
    // x = t³ − 2 t² + 3 over [0, 2] and on to [2, 3]: keys with their true derivatives give the
    // polynomial back.
    let (f, df) = (|t: f64| t.powi(3) - 2.0 * t * t + 3.0, |t: f64| 3.0 * t * t - 4.0 * t);
    let times = [0.0, 2.0, 3.0];
    let keys = times.iter().flat_map(|&t| [df(t), f(t), df(t)]).map(|x| [x as f32, 0.0, 0.0]).collect();
    let scene = moved(Channel {
        node: 0,
        times: times.map(|t| t as f32).to_vec(),
        values: Keys::Translation(keys),
        interpolation: Interpolation::CubicSpline,
    });
    for i in 0..60 {
        let time = f64::from(i) * 0.05;
        assert!((translation_at(&scene, time).x - f(time)).abs() < 1e-9, "{time}");
    }
}

#[test]
fn rotations_take_the_short_way_at_even_speed() {
    // A quarter turn about Y whose second key is written with the other sign.
    let half = std::f32::consts::FRAC_PI_4;
    let keys = vec![[0.0, 0.0, 0.0, 1.0], [0.0, -half.sin(), 0.0, -half.cos()]];
    let scene = moved(Channel {
        node: 0,
        times: vec![0.0, 1.0],
        values: Keys::Rotation(keys),
        interpolation: Interpolation::Linear,
    });
    for share in [0.1, 0.25, 0.5, 0.9] {
        let turned = pose(&scene, share).world_from_node[0].transform_vector3(DVec3::X);
        let angle = share * std::f64::consts::FRAC_PI_2;
        assert!(turned.distance(dvec3(angle.cos(), 0.0, -angle.sin())) < 1e-6, "{share}: {turned}");
    }
}

#[test]
fn scales_and_clips() {
    let clip = |node: usize, to: f32, seconds: f32| Animation {
        name: String::new(),
        channels: vec![Channel {
            node,
            times: vec![0.0, seconds],
            values: Keys::Scale(vec![[1.0; 3], [to; 3]]),
            interpolation: Interpolation::Linear,
        }],
        duration: seconds.into(),
    };
    let mut scene =
        scene_of(vec![Node { mesh: Some(0), ..Node::default() }, Node { mesh: Some(0), ..Node::default() }]);
    // The second clip moves what the first moves and does not play; the third plays at its own
    // length.
    scene.animations = vec![clip(0, 3.0, 2.0), clip(0, 9.0, 1.0), clip(1, 5.0, 4.0)];
    let pose = pose(&scene, 3.0);
    assert!((pose.world_from_node[0].matrix3.x_axis.x - 2.0).abs() < NEAR);
    assert!((pose.world_from_node[1].matrix3.x_axis.x - 4.0).abs() < NEAR);
}

#[test]
fn times_and_transforms_that_are_not_finite() {
    let scene = scene_of(vec![Node::default()]);
    for time in [f64::NAN, f64::INFINITY] {
        assert!(matches!(scene.pose(time), Err(Error::Pose { .. })));
    }
    let mut scene = scene_of(vec![Node { name: "wheel".into(), mesh: Some(0), ..Node::default() }]);
    scene.nodes[0].local.translation.x = f64::NAN;
    let error = scene.pose(0.0).expect_err("a node is nowhere");
    assert!(matches!(error, Error::Pose { .. }) && error.to_string().contains("nodes[0] (wheel)"), "{error}");
    scene.nodes[0].local = Trs { scale: DVec3::splat(1e308), ..Trs::IDENTITY };
    scene.nodes.push(Node {
        name: "hub".into(),
        parent: Some(0),
        mesh: Some(0),
        local: scene.nodes[0].local,
        ..Node::default()
    });
    assert!(scene.pose(0.0).expect_err("it is too large").to_string().contains("hub"));
    // Keys of no length have no rotation.
    let scene = moved(Channel {
        node: 0,
        times: vec![0.0, 1.0],
        values: Keys::Rotation(vec![[0.0; 4]; 2]),
        interpolation: Interpolation::Linear,
    });
    assert!(matches!(scene.pose(0.5), Err(Error::Pose { .. })));
}

#[test]
fn inconsistent_scenes_are_refused() {
    let good = || {
        let mut scene = moved(Channel {
            node: 0,
            times: vec![0.0],
            values: Keys::Scale(vec![[1.0; 3]]),
            interpolation: Interpolation::Step,
        });
        scene.skins.push(Skin { joints: vec![0], inverse_bind: vec![Mat4::IDENTITY] });
        scene
    };
    assert!(good().validate().is_ok());
    type Bend = (&'static str, fn(&mut Scene));
    let bends: [Bend; 18] = [
        ("index", |s| s.meshes[0].primitives[0].indices[0] = 3),
        ("indices", |s| s.meshes[0].primitives[0].indices.truncate(2)),
        ("normals", |s| s.meshes[0].primitives[0].normals.truncate(2)),
        ("coordinates", |s| s.meshes[0].primitives[0].uvs = vec![[0.0; 2]; 2]),
        ("material", |s| s.meshes[0].primitives[0].material = 1),
        ("finite", |s| s.meshes[0].primitives[0].positions[0][1] = f32::NAN),
        ("joints and weights", |s| s.meshes[0].primitives[0].joints = vec![[0; 4]; 3]),
        ("texture", |s| s.materials[0].base_color_texture = Some(0)),
        ("pixels", |s| {
            let texture = umbrage_scene::Texture {
                width: 2,
                height: 2,
                rgba: vec![0; 15],
                wrap: Default::default(),
                filter: Default::default(),
            };
            s.textures.push(texture);
        }),
        ("mesh", |s| s.nodes[0].mesh = Some(1)),
        ("skin", |s| s.nodes[0].skin = Some(1)),
        ("not every vertex", |s| s.nodes[0].skin = Some(0)),
        ("parent", |s| s.nodes[0].parent = Some(0)),
        ("beyond", |s| s.skins[0].joints = vec![1]),
        ("inverse bind", |s| s.skins[0].inverse_bind.clear()),
        ("moves node", |s| s.animations[0].channels[0].node = 1),
        ("keys", |s| s.animations[0].channels[0].times.clear()),
        ("lasts", |s| s.animations[0].duration = f64::NAN),
    ];
    for (word, bend) in bends {
        let mut scene = good();
        bend(&mut scene);
        let error = scene.pose(0.0).expect_err(word);
        assert!(matches!(error, Error::InvalidScene { .. }) && error.to_string().contains(word), "{word}: {error}");
    }
}

#[test]
fn objects_stand_in_node_order_and_know_whether_they_cast() {
    let mut scene = scene_of(vec![
        Node { mesh: Some(0), instances: vec![Trs::IDENTITY; 2], ..Node::default() },
        Node::default(),
        Node { mesh: Some(1), ..Node::default() },
        Node { mesh: Some(2), ..Node::default() },
        Node { mesh: Some(0), cast_shadow: false, ..Node::default() },
        Node { mesh: Some(3), ..Node::default() },
    ]);
    scene.materials.push(Material { alpha: AlphaMode::Blend, ..Material::default() });
    scene.meshes.push(Mesh::default());
    scene.meshes.push(Mesh { primitives: vec![triangle(1)], ..Mesh::default() });
    scene.meshes.push(Mesh { primitives: vec![triangle(1), triangle(0)], ..Mesh::default() });
    let pose = pose(&scene, 0.0);
    let objects: Vec<_> = pose.objects.iter().map(|o| (o.node, o.instance, o.casts)).collect();
    let expected = [(0, Some(0), true), (0, Some(1), true), (3, None, false), (4, None, false), (5, None, true)];
    assert_eq!(objects, expected);
}

#[test]
fn one_joint_moves_the_mesh_and_the_node_does_not() {
    let mut scene = scene_of(vec![
        Node { local: Trs { translation: dvec3(100_000.0, 5.0, 0.0), ..Trs::IDENTITY }, ..Node::default() },
        Node {
            mesh: Some(0),
            skin: Some(0),
            local: Trs { scale: DVec3::splat(77.0), ..Trs::IDENTITY },
            ..Node::default()
        },
    ]);
    scene.meshes[0].primitives[0].joints = vec![[0; 4]; 3];
    scene.meshes[0].primitives[0].weights = vec![[1.0, 0.0, 0.0, 0.0]; 3];
    scene.skins.push(Skin { joints: vec![0], inverse_bind: vec![Mat4::from_translation(glam::vec3(0.0, 1.0, 0.0))] });
    let pose = pose(&scene, 0.0);
    let (object, skinned) = (&pose.objects[0], &pose.skinned[0]);
    assert_eq!(object.bounds, Aabb::new(dvec3(100_000.0, 6.0, 0.0), dvec3(100_001.0, 8.0, 0.0)));
    assert_eq!(object.world_from_local, DAffine3::from_translation(skinned.origin));
    let first = object.world_from_local.transform_point3(DVec3::from(skinned.positions[0][0].map(f64::from)));
    assert!(first.distance(dvec3(100_000.0, 6.0, 0.0)) < 1e-6);
    assert_eq!(skinned.normals[0][0], [0.0, 0.0, 1.0]);
}

#[test]
fn mirrored_and_flattened_normals_stay_unit_and_outside() {
    let with_scale = |scale: DVec3| {
        let local = Trs { scale, ..Trs::IDENTITY };
        let mut scene =
            scene_of(vec![Node { local, ..Node::default() }, Node { mesh: Some(0), skin: Some(0), ..Node::default() }]);
        let primitive = &mut scene.meshes[0].primitives[0];
        primitive.joints = vec![[0; 4]; 3];
        primitive.weights = vec![[1.0, 0.0, 0.0, 0.0]; 3];
        scene.skins.push(Skin { joints: vec![0], inverse_bind: vec![Mat4::IDENTITY] });
        pose(&scene, 0.0).skinned[0].normals[0][0]
    };
    assert_eq!(with_scale(dvec3(1.0, 1.0, -1.0)), [0.0, 0.0, -1.0], "as the inverse transpose has it");
    assert_eq!(with_scale(dvec3(-2.0, 1.0, 1.0)), [0.0, 0.0, 1.0]);
    assert_eq!(with_scale(dvec3(1.0, 1.0, 0.0)), [0.0, 0.0, 1.0]);
    assert_eq!(with_scale(DVec3::ZERO), [0.0, 0.0, 1.0]);
}

fn any_trs() -> impl Strategy<Value = Trs> {
    let coordinate = || prop_oneof![4 => -50.0..50.0, 1 => Just(0.0), 1 => Just(100_000.0)];
    let scale = || prop_oneof![4 => 0.1..3.0, 1 => Just(1.0), 1 => Just(-1.0), 1 => Just(0.0)];
    let turn = prop_oneof![
        2 => Just(DQuat::IDENTITY),
        3 => (-3.2..3.2, -1.6..1.6, -3.2..3.2).prop_map(|(x, y, z)| DQuat::from_euler(glam::EulerRot::XYZ, x, y, z)),
    ];
    ([coordinate(), coordinate(), coordinate()], turn, [scale(), scale(), scale()]).prop_map(|(t, rotation, s)| Trs {
        translation: t.into(),
        rotation,
        scale: s.into(),
    })
}

prop_compose! {
    /// Random forests, some nodes with a mesh, some with instances.
    fn any_forest()(
        nodes in prop::collection::vec(
            (any_trs(), any::<u32>(), any::<bool>(),
             prop::collection::vec(any_trs(), 0..3)),
            1..12,
        ),
    ) -> Scene {
        let nodes = nodes
            .into_iter()
            .enumerate()
            .map(|(i, (local, pick, has_mesh, instances))| Node {
                name: format!("n{i}"),
                // A third of the nodes are roots.
                parent: (i > 0 && pick % 3 != 0).then(|| pick as usize / 3 % i),
                local,
                mesh: has_mesh.then_some(0),
                instances,
                ..Node::default()
            })
            .collect();
        scene_of(nodes)
    }
}

/// The matrix of a node by walking up to its root.
fn by_walking(scene: &Scene, node: usize) -> DMat4 {
    let local = &scene.nodes[node].local;
    let matrix = DMat4::from_scale_rotation_translation(local.scale, local.rotation, local.translation);
    scene.nodes[node].parent.map_or(matrix, |parent| by_walking(scene, parent) * matrix)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn hierarchies_and_bounds_are_as_by_brute_force(scene in any_forest()) {
        let pose = pose(&scene, 0.0);
        let mut objects = pose.objects.iter();
        for (index, node) in scene.nodes.iter().enumerate() {
            let expected = by_walking(&scene, index);
            let (got, size) = (DMat4::from(pose.world_from_node[index]), 1.0 + expected.to_cols_array().iter().fold(0.0_f64, |a, x| a.max(x.abs())));
            prop_assert!(got.abs_diff_eq(expected, 1e-12 * size), "{got} {expected}");
            if node.mesh.is_none() {
                continue;
            }
            let copies: Vec<DMat4> = if node.instances.is_empty() {
                vec![expected]
            } else {
                node.instances.iter().map(|t| expected * DMat4::from_scale_rotation_translation(t.scale, t.rotation, t.translation)).collect()
            };
            for (i, copy) in copies.iter().enumerate() {
                let object = objects.next().expect("an object per mesh node or instance");
                prop_assert_eq!((object.node, object.instance), (index, (!node.instances.is_empty()).then_some(i as u32)));
                let corners = scene.meshes[0].primitives[0].positions.iter().map(|p| copy.transform_point3(DVec3::from(p.map(f64::from))));
                let exact = Aabb::from_points(corners);
                let size = 1.0 + exact.min.abs().max_element().max(exact.max.abs().max_element());
                prop_assert!(object.bounds.min.distance(exact.min) < 1e-9 * size && object.bounds.max.distance(exact.max) < 1e-9 * size);
                let all = pose.bounds.expect("there is an object");
                prop_assert!(all.union(object.bounds) == all);
            }
        }
        prop_assert!(objects.next().is_none());
    }

    /// A poser that has seen other moments says the same as one that has not.
    #[test]
    fn posers_remember_nothing_wrong(
        scene in any_forest(),
        keys in prop::collection::vec([-5.0_f32..5.0, -5.0..5.0, -5.0..5.0], 2..5),
        times in prop::collection::vec(-10.0..10.0, 1..6),
    ) {
        let mut scene = scene;
        let node = scene.nodes.len() / 2;
        let duration = (keys.len() - 1) as f64;
        let channel = Channel {
            node,
            times: (0..keys.len()).map(|i| i as f32).collect(),
            values: Keys::Translation(keys),
            interpolation: Interpolation::Linear,
        };
        scene.animations.push(Animation { name: String::new(), channels: vec![channel], duration });
        let mut poser = Poser::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        for time in times {
            let (again, fresh) = (poser.pose(time).unwrap_or_else(|error| panic!("{error}")), pose(&scene, time));
            prop_assert_eq!(&again.world_from_node, &fresh.world_from_node);
            prop_assert_eq!(again.bounds, fresh.bounds);
            for (a, b) in again.objects.iter().zip(&fresh.objects) {
                prop_assert_eq!((a.world_from_local, a.bounds), (b.world_from_local, b.bounds));
            }
            // One round later it is where it was.
            let looped = pose(&scene, time + duration);
            for (a, b) in looped.world_from_node.iter().zip(&fresh.world_from_node) {
                prop_assert!(a.translation.distance(b.translation) < 1e-9 * (1.0 + b.translation.length()));
            }
        }
    }

    /// Skinning against the formula, joint by joint.
    #[test]
    fn skinning_is_the_weighted_sum_of_joints(a in any_trs(), b in any_trs(), weight in 0.0_f32..1.0) {
        let mut scene = scene_of(vec![
            Node { local: a, ..Node::default() },
            Node { local: b, parent: Some(0), ..Node::default() },
            Node { mesh: Some(0), skin: Some(0), ..Node::default() },
        ]);
        let primitive = &mut scene.meshes[0].primitives[0];
        primitive.joints = vec![[0, 1, 0, 0]; 3];
        primitive.weights = vec![[weight, 1.0 - weight, 0.0, 0.0]; 3];
        let bind = Mat4::from_rotation_x(0.3) * Mat4::from_translation(glam::vec3(1.0, 2.0, 3.0));
        scene.skins.push(Skin { joints: vec![0, 1], inverse_bind: vec![Mat4::IDENTITY, bind] });
        let pose = pose(&scene, 0.0);
        let mut bounds = Aabb::EMPTY;
        for (vertex, position) in scene.meshes[0].primitives[0].positions.iter().enumerate() {
            let point = DVec3::from(position.map(f64::from));
            let by = |node: usize, bind: DMat4| (by_walking(&scene, node) * bind).transform_point3(point);
            let expected = by(0, DMat4::IDENTITY) * f64::from(weight) + by(1, bind.as_dmat4()) * f64::from(1.0 - weight);
            let got = pose.skinned[0].origin + DVec3::from(pose.skinned[0].positions[0][vertex].map(f64::from));
            let reach = 1.0 + pose.skinned[0].positions[0][vertex].iter().fold(0.0_f32, |a, x| a.max(x.abs()));
            prop_assert!(got.distance(expected) < 1e-6 * f64::from(reach) + 1e-12 * expected.length(), "{got} {expected}");
            bounds = bounds.including(expected);
        }
        prop_assert!(pose.objects[0].bounds.min.distance(bounds.min) < 1e-9 * (1.0 + bounds.min.length()));
    }
}

#[test]
fn a_moved_scene_is_the_same_elsewhere() {
    let channel = Channel {
        node: 0,
        times: vec![0.0, 2.0],
        values: Keys::Translation(vec![[0.0; 3], [4.0, 0.0, 0.5]]),
        interpolation: Interpolation::Linear,
    };
    let mut scene = moved(channel);
    scene.nodes.push(Node { parent: Some(0), mesh: Some(0), ..Node::default() });
    scene.meshes.push(Mesh {
        name: "skinned".into(),
        primitives: vec![Primitive { joints: vec![[0; 4]; 3], weights: vec![[1.0, 0.0, 0.0, 0.0]; 3], ..triangle(0) }],
        ..Mesh::default()
    });
    scene.nodes.push(Node { mesh: Some(1), skin: Some(0), ..Node::default() });
    scene.skins.push(Skin { joints: vec![1], inverse_bind: vec![Mat4::IDENTITY] });
    let lens = Lens::Perspective { yfov: 1.0, aspect: None, znear: 0.5, zfar: None };
    scene.cameras.push(SceneCamera { name: "eye".into(), node: 1, lens });
    let by = dvec3(-1e5, 12.5, 1e5);
    let elsewhere = scene.clone().moved(by);
    elsewhere.validate().unwrap_or_else(|error| panic!("{error}"));
    let (here, there) = (pose(&scene, 1.0), pose(&elsewhere, 1.0));
    assert_eq!((here.objects.len(), there.objects.len()), (3, 3));
    for (here, there) in here.objects.iter().zip(&there.objects) {
        let apart = [there.bounds.min - here.bounds.min - by, there.bounds.max - here.bounds.max - by];
        assert!(apart.iter().all(|apart| apart.length() < 1e-9), "{here:?} {there:?}");
    }
    let eye = |scene: &Scene, pose: &Pose| {
        let view = camera_view(scene, pose, 0, 1.5, None, None).unwrap_or_else(|error| panic!("{error}"));
        (view.eye(), view.forward())
    };
    let ((eye_here, ahead), (eye_there, same)) = (eye(&scene, &here), eye(&elsewhere, &there));
    assert!((eye_there - eye_here).abs_diff_eq(by, 1e-9) && ahead == same, "{eye_here} {eye_there}");
}
