//! What is written comes back the same.

use std::path::PathBuf;

use glam::{DQuat, Mat4, dvec3};
use umbrage_scene::procedural::World;
use umbrage_scene::{
    AlphaMode, Animation, Channel, Error, GltfOptions, Interpolation, Keys, Lens, LightKind, Material, Mesh, Node,
    Primitive, Scene, SceneCamera, SceneLight, Skin, Texture, TextureFilter, Trs, Wrap, export_glb, load_gltf,
    load_gltf_slice,
};

#[track_caller]
fn round(scene: &Scene) -> Scene {
    let bytes = export_glb(scene).unwrap_or_else(|error| panic!("{error}"));
    load_gltf_slice("round.glb", &bytes, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// That two scenes are the same, up to the `f32` of transforms.
#[track_caller]
fn assert_same(a: &Scene, b: &Scene) {
    assert_eq!(a.meshes.len(), b.meshes.len());
    for (a, b) in a.meshes.iter().zip(&b.meshes) {
        assert_eq!((&a.name, a.primitives.len()), (&b.name, b.primitives.len()));
        for (a, b) in a.primitives.iter().zip(&b.primitives) {
            // Plain asserts: printing a whole mesh helps nobody.
            assert!(a.indices == b.indices && a.material == b.material);
            assert!(a.positions == b.positions && a.normals == b.normals);
            assert!(a.uvs == b.uvs && a.colors == b.colors);
            assert!(a.joints == b.joints && a.weights == b.weights);
        }
    }
    assert_eq!(format!("{:?}", a.materials), format!("{:?}", b.materials));
    assert_eq!(a.textures.len(), b.textures.len());
    for (a, b) in a.textures.iter().zip(&b.textures) {
        assert_eq!((a.width, a.height, a.wrap), (b.width, b.height, b.wrap));
        assert!(a.rgba == b.rgba);
    }
    assert_eq!(a.nodes.len(), b.nodes.len());
    for (a, b) in a.nodes.iter().zip(&b.nodes) {
        assert_eq!((&a.name, a.parent, a.mesh, a.skin), (&b.name, b.parent, b.mesh, b.skin));
        assert_eq!((a.cast_shadow, a.instances.len()), (b.cast_shadow, b.instances.len()));
        let pairs = std::iter::once((&a.local, &b.local)).chain(a.instances.iter().zip(&b.instances));
        for (a, b) in pairs {
            let near = 1e-7 * (1.0 + a.translation.length());
            assert!(a.translation.distance(b.translation) < near, "{a:?} {b:?}");
            assert!(
                a.rotation.dot(b.rotation).abs() > 1.0 - 1e-6 && a.scale.distance(b.scale) < 1e-6 * a.scale.length()
            );
        }
    }
    assert_eq!(format!("{:?}", a.cameras.len()), format!("{:?}", b.cameras.len()));
    for (a, b) in a.cameras.iter().zip(&b.cameras) {
        assert_eq!((&a.name, a.node), (&b.name, b.node));
        assert_eq!(lens(a.lens), lens(b.lens));
    }
    assert_eq!(a.lights.len(), b.lights.len());
    for (a, b) in a.lights.iter().zip(&b.lights) {
        assert_eq!((&a.name, a.node, a.color, a.intensity), (&b.name, b.node, b.color, b.intensity));
        assert_eq!(std::mem::discriminant(&a.kind), std::mem::discriminant(&b.kind));
        assert_eq!(a.range.map(|r| r as f32), b.range.map(|r| r as f32));
    }
    assert_eq!(format!("{:?}", a.skins), format!("{:?}", b.skins));
    assert_eq!(format!("{:?}", a.animations), format!("{:?}", b.animations));
}

/// A lens in single precision.
fn lens(lens: Lens) -> [Option<f32>; 4] {
    match lens {
        Lens::Perspective { yfov, aspect, znear, zfar } => {
            [Some(yfov as f32), aspect.map(|a| a as f32), Some(znear as f32), zfar.map(|z| z as f32)]
        }
        Lens::Orthographic { xmag, ymag, znear, zfar } => [xmag, ymag, znear, zfar].map(|x| Some(x as f32)),
    }
}

/// Everything that a scene can have.
fn rich() -> Scene {
    let primitive = |material| Primitive {
        positions: vec![[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -2.25, 0.1]],
        normals: vec![[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        uvs: vec![[0.0, 0.0], [3.0, -1.0], [0.25, 0.5]],
        colors: vec![[1.0, 0.5, 0.25, 0.125]; 3],
        indices: vec![0, 1, 2, 2, 1, 0],
        material,
        ..Primitive::default()
    };
    let skinned = Primitive {
        joints: vec![[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0]],
        weights: vec![[0.25, 0.75, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]],
        ..primitive(1)
    };
    let texture = |shade: u8, wrap| Texture {
        width: 2,
        height: 1,
        rgba: vec![shade, 2, 3, 4, 5, 6, 7, 8],
        wrap,
        filter: TextureFilter::Linear,
    };
    let turned = Trs {
        translation: dvec3(10.0, -3.0, 0.5),
        rotation: DQuat::from_rotation_y(1.0),
        scale: dvec3(1.0, 2.0, -3.0),
    };
    Scene {
        name: "rich".into(),
        levels: Default::default(),
        meshes: vec![
            Mesh { name: "plain".into(), primitives: vec![primitive(0), primitive(2)], ..Mesh::default() },
            Mesh { primitives: vec![skinned], ..Mesh::default() },
        ],
        materials: vec![
            Material {
                name: "leaf".into(),
                alpha: AlphaMode::Mask { cutoff: 0.3 },
                base_color_texture: Some(0),
                double_sided: true,
                ..Material::default()
            },
            Material {
                alpha: AlphaMode::Blend,
                base_color_texture: Some(1),
                emissive: [0.0, 0.25, 4.0],
                ..Material::default()
            },
            Material {
                base_color: [0.1, 0.2, 0.3, 1.0],
                base_color_texture: Some(2),
                emissive: [0.5; 3],
                ..Material::default()
            },
        ],
        textures: vec![
            texture(1, [Wrap::Repeat, Wrap::Clamp]),
            texture(1, [Wrap::Mirror; 2]),
            texture(9, [Wrap::Repeat, Wrap::Clamp]),
        ],
        nodes: vec![
            Node { name: "root".into(), local: turned, ..Node::default() },
            Node {
                name: "many".into(),
                parent: Some(0),
                mesh: Some(0),
                instances: vec![Trs::IDENTITY, turned],
                ..Node::default()
            },
            Node { parent: Some(0), mesh: Some(0), cast_shadow: false, ..Node::default() },
            Node { name: "hip".into(), parent: Some(2), ..Node::default() },
            Node { name: "body".into(), mesh: Some(1), skin: Some(0), ..Node::default() },
        ],
        cameras: vec![
            SceneCamera {
                name: "eye".into(),
                node: 0,
                lens: Lens::Perspective { yfov: 1.0, aspect: None, znear: 0.1, zfar: Some(800.0) },
            },
            SceneCamera {
                name: "plan".into(),
                node: 3,
                lens: Lens::Orthographic { xmag: 4.0, ymag: 3.0, znear: 0.0, zfar: 9.0 },
            },
        ],
        lights: vec![
            SceneLight {
                name: "sun".into(),
                node: 0,
                kind: LightKind::Directional,
                color: [1.0, 0.9, 0.8],
                intensity: 3.0,
                range: None,
            },
            SceneLight {
                name: "lamp".into(),
                node: 3,
                kind: LightKind::Spot { inner: 0.25, outer: 0.5 },
                color: [1.0; 3],
                intensity: 9.0,
                range: Some(20.0),
            },
        ],
        skins: vec![Skin { joints: vec![3, 0], inverse_bind: vec![Mat4::IDENTITY, Mat4::from_rotation_x(0.5)] }],
        animations: vec![Animation {
            name: "walk".into(),
            channels: vec![
                Channel {
                    node: 3,
                    times: vec![0.0, 0.5],
                    values: Keys::Rotation(vec![[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]]),
                    interpolation: Interpolation::Linear,
                },
                Channel {
                    node: 0,
                    times: vec![0.0, 0.5],
                    values: Keys::Translation(vec![[1.0; 3]; 6]),
                    interpolation: Interpolation::CubicSpline,
                },
                Channel {
                    node: 0,
                    times: vec![0.25],
                    values: Keys::Scale(vec![[2.0; 3]]),
                    interpolation: Interpolation::Step,
                },
            ],
            duration: 0.5,
        }],
        notes: Vec::new(),
    }
}

#[test]
fn everything_comes_back() {
    assert_same(&rich(), &round(&rich()));
}

#[test]
fn the_comparison_can_say_no() {
    let bends: [fn(&mut Scene); 5] = [
        |s| s.meshes[0].primitives[1].positions[2][0] += 1e-6,
        |s| s.nodes[2].cast_shadow = true,
        |s| s.nodes[1].instances[1].translation.x += 0.01,
        |s| s.textures[2].rgba[0] = 8,
        |s| s.animations[0].channels[0].times[1] = 0.4,
    ];
    for bend in bends {
        let mut other = rich();
        bend(&mut other);
        assert!(std::panic::catch_unwind(|| assert_same(&rich(), &other)).is_err());
    }
}

#[test]
fn writing_twice_gives_the_same_bytes() {
    let once = export_glb(&rich()).unwrap_or_else(|error| panic!("{error}"));
    assert!(once == export_glb(&rich()).unwrap_or_else(|error| panic!("{error}")));
    let again = export_glb(&round(&rich())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(once.len(), again.len());
}

#[test]
fn empty_scenes_and_meshes() {
    assert_same(&Scene::default(), &round(&Scene::default()));
    let mut scene = rich();
    scene.meshes.insert(0, Mesh::default());
    scene.nodes.iter_mut().for_each(|node| node.mesh = node.mesh.map(|mesh| mesh + 1));
    scene.nodes[3].mesh = Some(0);
    assert_same(&rich(), &round(&scene));
}

#[test]
fn two_lights_and_cameras_on_one_node() {
    let mut scene = rich();
    scene.lights.push(SceneLight { name: "second".into(), ..scene.lights[0].clone() });
    scene.cameras.push(SceneCamera { name: "second".into(), ..scene.cameras[0].clone() });
    let back = round(&scene);
    let (before, after) = (scene.pose(0.1), back.pose(0.1));
    let (before, after) = (before.unwrap_or_else(|e| panic!("{e}")), after.unwrap_or_else(|e| panic!("{e}")));
    for (a, b) in scene.lights.iter().map(|l| l.node).zip(back.lights.iter().map(|l| l.node)) {
        assert!(before.world_from_node[a].abs_diff_eq(after.world_from_node[b], 1e-5));
    }
    assert_eq!(back.cameras[2].name, "second");
}

#[test]
fn wide_indices_and_many_joints() {
    let mut scene = rich();
    let count = 70_000_u32;
    scene.meshes[0].primitives.truncate(1);
    scene.meshes[0].primitives[0] = Primitive {
        positions: (0..count).map(|i| [i as f32, 0.0, (i % 7) as f32]).collect(),
        normals: vec![[0.0, 1.0, 0.0]; count as usize],
        uvs: vec![[0.5, 0.25]; count as usize],
        indices: (0..count - 2).flat_map(|i| [i, i + 1, i + 2]).collect(),
        ..Primitive::default()
    };
    scene.skins[0] = Skin { joints: vec![3; 300], inverse_bind: vec![Mat4::IDENTITY; 300] };
    scene.meshes[1].primitives[0].joints[1] = [299, 0, 0, 0];
    // Indices up to 65534 are narrow, 65535 is not.
    assert_same(&scene, &round(&scene));
}

#[test]
fn numbers_that_gltf_cannot_hold_are_refused() {
    let mut scene = rich();
    scene.nodes[3].local.translation.x = 1e39;
    let error = export_glb(&scene).expect_err("it is too far away");
    assert!(matches!(error, Error::Export { .. }) && error.to_string().contains("nodes[3] (hip)"), "{error}");
    let mut scene = rich();
    scene.cameras[0].lens = Lens::Perspective { yfov: f64::NAN, aspect: None, znear: 0.1, zfar: None };
    assert!(export_glb(&scene).expect_err("no angle").to_string().contains("cameras[0] (eye)"));
    let mut scene = rich();
    scene.nodes[0].mesh = Some(9);
    assert!(matches!(export_glb(&scene), Err(Error::InvalidScene { .. })));
}

#[test]
fn a_real_city_comes_back() {
    let city = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/city_candela.glb");
    let scene = load_gltf(&city, &GltfOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_same(&scene, &round(&scene));
}

#[test]
fn worlds_come_back() {
    let all = World::ALL.into_iter().filter(|world| !World::LARGE.contains(world));
    for world in all {
        let (scene, back) = (world.build(), round(&world.build()));
        assert_eq!(scene.placed_triangles(), back.placed_triangles(), "{}", world.name());
        assert_eq!((scene.cameras.len(), scene.lights.len()), (back.cameras.len(), back.lights.len()));
        let bounds =
            |scene: &Scene| scene.pose(1.5).unwrap_or_else(|e| panic!("{e}")).bounds.expect("there are triangles");
        let (a, b) = (bounds(&scene), bounds(&back));
        assert!(a.min.distance(b.min) < 1e-3 && a.max.distance(b.max) < 1e-3, "{}: {a:?} {b:?}", world.name());
    }
}
