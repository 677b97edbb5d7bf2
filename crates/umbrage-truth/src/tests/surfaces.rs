//! Tests of the surfaces that the eye sees and of those that stop light.

use glam::{DAffine3, DQuat, DVec3};
use umbrage::{Frustum, View};
use umbrage_scene::{AlphaMode, Material, Primitive, SkinnedMesh, Texture, TextureFilter, Wrap};

use super::scenes::{Shape, Stage, view, with_alpha};
use crate::{Error, Truth};

/// Object and light at the middle of a picture from above.
fn middle(stage: &Stage, sun: DVec3) -> Option<(usize, bool)> {
    let mask = stage.mask(&view(DVec3::new(0.0, 10.0, 0.1), DVec3::ZERO), sun, [3, 3]);
    mask.hits()[4].map(|hit| (hit.object as usize, hit.lit))
}

const SLANTED: DVec3 = DVec3::new(0.5, -1.0, 0.0);

#[test]
fn the_eye_passes_through_back_faces_but_light_does_not() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    assert_eq!(middle(&stage, SLANTED), Some((0, true)));
    // A single-sided ceiling that faces down: unseen from above, and yet its shadow lies on the
    // floor.
    let mut ceiling = Shape::floor(5.0, 2.0);
    ceiling.indices = vec![0, 2, 1, 0, 3, 2];
    let single = stage.material(Material::default());
    let ceiling = stage.add_primitive(ceiling.with_material(single), DAffine3::IDENTITY, true);
    assert_eq!(middle(&stage, SLANTED), Some((0, false)));
    // Mirrored sideways it still faces down, although its corners now run the other way round.
    let sideways = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    stage.pose.objects[ceiling].world_from_local = sideways;
    assert_eq!(middle(&stage, SLANTED), Some((0, false)));
    // Mirrored upwards or turned over it faces up.
    let raised = DAffine3::from_translation(DVec3::new(0.0, 4.0, 0.0));
    let upwards = raised * DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let over = raised * DAffine3::from_quat(DQuat::from_rotation_z(std::f64::consts::PI));
    for up in [upwards, over, over * sideways] {
        stage.pose.objects[ceiling].world_from_local = up;
        assert_eq!(middle(&stage, SLANTED), Some((1, true)));
    }
    stage.pose.objects[ceiling].world_from_local = DAffine3::IDENTITY;
    stage.scene.materials[single].double_sided = true;
    assert_eq!(middle(&stage, SLANTED), Some((1, true)));
}

#[test]
fn what_does_not_cast_is_seen_but_throws_nothing() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    let lid = stage.add(Shape::floor(1.0, 2.0), DAffine3::from_translation(DVec3::new(-1.2, 0.0, 0.0)));
    let cover = stage.add(Shape::floor(0.1, 6.0), DAffine3::IDENTITY);
    stage.pose.objects[cover].casts = false;
    assert_eq!(middle(&stage, SLANTED), Some((cover, true)));
    stage.pose.objects.pop();
    assert_eq!(middle(&stage, SLANTED), Some((0, false)));
    stage.pose.objects[lid].casts = false;
    assert_eq!(middle(&stage, SLANTED), Some((0, true)));
}

#[test]
fn blended_surfaces_are_not_there() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    stage.add_with(Shape::floor(10.0, 2.0), with_alpha(AlphaMode::Blend, 1.0));
    assert_eq!(middle(&stage, SLANTED), Some((0, true)));
    assert_eq!(stage.truth(DVec3::ZERO).triangle_count(), 2);
}

#[test]
fn alpha_at_the_cutoff_counts() {
    for (base, there) in [(0.5, true), (0.499, false), (1.0, true), (0.0, false)] {
        let mut stage = Stage::default();
        stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
        stage.add_with(Shape::floor(10.0, 2.0), with_alpha(AlphaMode::Mask { cutoff: 0.5 }, base));
        let expected = if there { (1, true) } else { (0, true) };
        assert_eq!(middle(&stage, SLANTED), Some(expected), "base alpha {base}");
    }
}

/// A leaf of 10 x 10 m at height 2 whose texture is opaque for u < 1/2.
fn half_leaf(vertex_alpha: Option<f32>) -> Stage {
    let mut stage = Stage::default();
    stage.add(Shape::floor(40.0, 0.0), DAffine3::IDENTITY);
    let mut rgba = Vec::new();
    for _ in 0..4 {
        rgba.extend((0..4).flat_map(|x| [255, 255, 255, if x < 2 { 255 } else { 0 }]));
    }
    stage.scene.textures.push(Texture {
        width: 4,
        height: 4,
        rgba,
        wrap: [Wrap::Clamp; 2],
        filter: TextureFilter::Linear,
    });
    let material = Material { base_color_texture: Some(0), ..with_alpha(AlphaMode::Mask { cutoff: 0.5 }, 1.0) };
    let material = stage.material(material);
    let leaf = Primitive {
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        colors: vertex_alpha.map_or(Vec::new(), |alpha| vec![[1.0, 1.0, 1.0, alpha]; 4]),
        ..Shape::floor(5.0, 2.0).with_material(material)
    };
    stage.add_primitive(leaf, DAffine3::IDENTITY, true);
    stage
}

#[test]
fn a_leaf_is_there_where_its_texture_says_so() {
    let stage = half_leaf(None);
    let sun = DVec3::new(1.0, -1.0, 0.0);
    let mask = stage.mask(&view(DVec3::new(1.0, 9.0, 12.0), DVec3::ZERO), sun, [120, 90]);
    let mut counted = [0; 3];
    for hit in mask.hits().iter().flatten() {
        let p = hit.position;
        if hit.object == 1 {
            assert!(p.x < 1e-9 && p.x > -5.0 - 1e-9, "the leaf is seen at {p}");
            assert!(hit.lit);
            counted[0] += 1;
        } else {
            // Light that reaches the floor at x crossed the leaf's height at x − 2.
            let dark = p.x - 2.0 > -5.0 && p.x - 2.0 < 0.0 && p.z.abs() < 5.0;
            assert_eq!(hit.lit, !dark, "{p}");
            counted[1 + usize::from(dark)] += 1;
        }
    }
    assert!(counted.iter().all(|&n| n > 200), "{counted:?}");
    // Vertex alpha multiplies: 0.6 of 1 passes the cutoff in the middle of the opaque half, 0.4
    // nowhere.
    for (alpha, expected) in [(0.6, 1), (0.4, 0)] {
        let mask =
            half_leaf(Some(alpha)).mask(&view(DVec3::new(-3.0, 9.0, 0.1), DVec3::new(-3.0, 0.0, 0.0)), sun, [3, 3]);
        assert_eq!(mask.hits()[4].map(|hit| hit.object), Some(expected), "{alpha}");
    }
}

#[test]
fn near_and_far_cut() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(20.0, 2.0), DAffine3::IDENTITY);
    let seen = |near: f64, far: f64| {
        let frustum = Frustum::perspective(1.0, 1.0, near, far).unwrap();
        let view = View::look_at_upright(DVec3::new(0.0, 10.0, 0.0), DVec3::ZERO, frustum).unwrap();
        stage.mask(&view, SLANTED, [3, 3]).hits()[0].map(|hit| (hit.object, (hit.depth * 1e6).round() / 1e6))
    };
    assert_eq!(seen(1.0, f64::INFINITY), Some((1, 8.0)));
    assert_eq!(seen(1.0, 8.0), Some((1, 8.0)));
    assert_eq!(seen(8.5, 100.0), Some((0, 10.0)));
    assert_eq!(seen(8.5, 9.5), None);
    assert_eq!(seen(1.0, 7.9), None);
}

#[test]
fn orthographic_rays_run_in_parallel() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    let frustum = Frustum::orthographic(8.0, 4.0, -5.0, 50.0).unwrap();
    let view = View::look_at_upright(DVec3::new(1.0, 10.0, 2.0), DVec3::new(1.0, 0.0, 2.0), frustum).unwrap();
    let mask = stage.mask(&view, SLANTED, [8, 4]);
    for (i, hit) in mask.hits().iter().enumerate() {
        let at = hit.expect("the floor fills the picture").position;
        let expected = DVec3::new(1.0 - 3.5 + (i % 8) as f64, 0.0, 2.0 - 1.5 + (i / 8) as f64);
        assert!(at.distance(expected) < 1e-9, "{at} {expected}");
    }
}

#[test]
fn skinned_vertices_stand_where_the_pose_puts_them() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    let lid = stage.add(Shape::floor(1.0, 2.0), DAffine3::IDENTITY);
    let origin = DVec3::new(1.0, 2.0, 0.0);
    stage.pose.skinned.push(SkinnedMesh {
        origin,
        positions: vec![Shape::floor(0.5, 1.0).positions],
        normals: vec![vec![[0.0, 1.0, 0.0]; 4]],
    });
    stage.pose.objects[lid].skinned = Some(0);
    stage.pose.objects[lid].world_from_local = DAffine3::from_translation(origin);
    let truth = stage.truth(DVec3::ZERO);
    let points = [0.4, 0.6, 1.4, 1.6].map(|x| (DVec3::new(x, 0.0, 0.1), DVec3::Y));
    assert_eq!(truth.visibility_at(&points, DVec3::NEG_Y).unwrap(), [1.0, 0.0, 0.0, 1.0]);
    stage.pose.skinned[0].positions[0].pop();
    let error = Truth::build(&stage.scene, &stage.pose, DVec3::ZERO).unwrap_err();
    assert!(matches!(error, Error::InvalidGeometry { object: 1, .. }), "{error}");
}

#[test]
fn an_empty_scene_is_all_sky() {
    let mask = Stage::default().mask(&view(DVec3::ONE, DVec3::ZERO), DVec3::NEG_Y, [9, 7]);
    assert!(mask.hits().iter().all(Option::is_none));
}

#[test]
fn broken_scenes_are_refused_by_name() {
    type Damage = fn(&mut Primitive);
    let broken: [(&str, Damage); 5] = [
        ("whole triangles", |p| p.indices.truncate(4)),
        ("points past", |p| p.indices[2] = 99),
        ("not a number", |p| p.positions[1][0] = f32::NAN),
        ("texture coordinates", |p| p.uvs = vec![[0.0; 2]; 3]),
        ("material", |p| p.material = 7),
    ];
    for (says, damage) in broken {
        let mut stage = Stage::default();
        stage.add(Shape::floor(1.0, 0.0), DAffine3::IDENTITY);
        damage(&mut stage.scene.meshes[0].primitives[0]);
        let error = Truth::build(&stage.scene, &stage.pose, DVec3::ZERO).unwrap_err().to_string();
        assert!(error.contains(says) && error.contains("object 0"), "{error}");
    }
    assert!(Truth::build(&Stage::default().scene, &Stage::default().pose, DVec3::NAN).is_err());
}
