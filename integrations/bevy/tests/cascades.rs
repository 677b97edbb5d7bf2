//! What is written over Bevy's cascades.

mod common;

use bevy_camera::SubCameraView;
use bevy_camera::visibility::RenderLayers;
use bevy_light::{CascadeShadowConfig, CascadeShadowConfigBuilder, VolumetricLight};
use common::*;
use umbrage_bevy::umbrage::ShadowConfig;
use umbrage_bevy::umbrage::glam::{DVec2, DVec3};
use umbrage_bevy::{BevyCascades, Error, LightShadows, PlannedLights};

/// How far a receiver is moved along its normal and towards the light at most, texels and metres.
const MOVED: (f32, f32) = (1.8 * std::f32::consts::SQRT_2, 0.02);

/// The points that the map which Bevy's shader asks does not hold, by the shader's own rules: the
/// cascade of the view depth, and in the band at its end the next one.
fn lost(app: &App, light: Entity, camera: Entity, points: &[Vec3]) -> usize {
    let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light");
    let maps = &cascades(app, light).cascades[&camera];
    assert_eq!(maps.len(), config.bounds.len());
    let is_lost = |&&point: &&Vec3| {
        let depth = depth_of(app, camera, point);
        let Some(index) = config.bounds.iter().position(|&far| depth < far) else { return true };
        let begins = (1.0 - config.overlap_proportion) * config.bounds[index];
        let is_blended = index + 1 < maps.len() && depth >= begins;
        maps[index..=index + usize::from(is_blended)].iter().any(|map| {
            let moved = MOVED.0 * map.texel_size + MOVED.1;
            [Vec3::ZERO, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::NEG_Z].iter().any(|normal| {
                let at = map.clip_from_world.project_point3(point + moved * *normal);
                at.truncate().abs().max_element() > 1.0 || !(0.0..=1.0).contains(&at.z)
            })
        })
    };
    points.iter().filter(is_lost).count()
}

#[test]
fn all_that_is_seen_lies_in_the_map_that_bevy_asks() {
    let orthographic = |near| OrthographicProjection {
        near,
        far: 400.0,
        area: Rect::new(-60.0, -30.0, 60.0, 30.0),
        ..OrthographicProjection::default_3d()
    };
    let endless = PerspectiveProjection { far: f32::INFINITY, ..lens() };
    let cameras: [Projection; 5] = [
        lens().into(),
        endless.into(),
        orthographic(0.0).into(),
        orthographic(-150.0).into(),
        PerspectiveProjection { far: 90.0, ..lens() }.into(),
    ];
    for projection in cameras {
        let mut app = planned();
        spawn_town(&mut app);
        let light = spawn_sun(&mut app, morning());
        let camera = spawn_camera(&mut app, projection.clone(), street());
        app.update();
        assert!(app.world().resource::<PlannedLights>().plan(light, camera).is_some(), "{projection:?}");
        let points = seen_points(&mut app, camera, 100);
        assert!(points.len() > 1000, "{}", points.len());
        assert_eq!(lost(&app, light, camera, &points), 0, "{projection:?}");
        // The comparison sees a map that is half as wide.
        let mut maps = app.world_mut().get_mut::<bevy_light::Cascades>(light).expect("it is a light");
        for map in maps.cascades.get_mut(&camera).expect("it is planned for") {
            map.clip_from_world = Mat4::from_scale(Vec3::new(2.0, 1.0, 1.0)) * map.clip_from_world;
        }
        assert!(lost(&app, light, camera, &points) > 200);
    }
}

#[test]
fn cascades_are_the_splits_of_the_plan() {
    let mut app = planned();
    spawn_town(&mut app);
    let light = spawn_sun(&mut app, morning());
    let camera = spawn_camera(&mut app, lens(), street());
    app.update();
    let plan = app.world().resource::<PlannedLights>().plan(light, camera).expect("it is planned").clone();
    let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light");
    let bounds: Vec<f32> = plan.planes[1..].iter().map(|&plane| plane as f32).collect();
    assert_eq!(config.bounds, bounds);
    assert_eq!(plan.splits.len(), 4);
    for (split, map) in plan.splits.iter().zip(&cascades(&app, light).cascades[&camera]) {
        assert_eq!(split.size, 2048);
        let corner = split.min_texel + 700.0;
        let along = split.u_axis * (corner.x * split.texel_m.x) + split.v_axis * (corner.y * split.texel_m.y);
        let point = along + split.depth_axis * (0.5 * (split.depth_near + split.depth_far));
        let at = map.clip_from_world.project_point3(Vec3::from_array(point.to_array().map(|m| m as f32)));
        // A map whose texels are too long is wider along the other axis, and on a grid of its own.
        let drawn = split.texel_m.max(DVec2::splat(0.25 * split.texel_m.max_element()));
        let place = (700.0 - 1024.0) / 1024.0 * split.texel_m / drawn;
        let expected = Vec2::new(place.x as f32, -place.y as f32);
        assert!(at.truncate().distance(expected) < 2e-3, "{at} {expected}");
        assert!((at.z - 0.5).abs() < 0.1, "{at}");
        assert_eq!(map.texel_size, split.texel_m.max_element() as f32);
    }
}

#[test]
fn every_camera_that_the_renderer_draws_has_an_entry() {
    let mut app = planned();
    spawn_town(&mut app);
    let suns = [spawn_sun(&mut app, morning()), spawn_sun(&mut app, Vec3::new(0.5, -0.3, 0.2))];
    let layered = spawn_sun(&mut app, morning());
    app.world_mut().entity_mut(layered).insert(RenderLayers::layer(5));
    let hidden = spawn_sun(&mut app, morning());
    app.world_mut().entity_mut(hidden).insert(Visibility::Hidden);
    let above = Transform::from_xyz(0.0, 80.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y);
    let cameras = [spawn_camera(&mut app, lens(), street()), spawn_camera(&mut app, lens(), above)];
    let part = SubCameraView { full_size: UVec2::new(160, 90), offset: Vec2::new(80.0, 0.0), size: UVec2::splat(80) };
    app.world_mut().get_mut::<Camera>(cameras[1]).expect("it is a camera").sub_camera_view = Some(part);
    let flat = app.world_mut().spawn(Camera2d).id();
    let asleep = spawn_camera(&mut app, lens(), above);
    app.world_mut().get_mut::<Camera>(asleep).expect("it is a camera").is_active = false;
    for _ in 0..3 {
        app.update();
        for light in [suns[0], suns[1], layered, hidden] {
            let maps = &cascades(&app, light).cascades;
            let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light");
            for camera in [cameras[0], cameras[1], flat] {
                assert!(maps[&camera].len() >= config.bounds.len(), "{light} {camera}");
            }
            assert!(!maps.contains_key(&asleep));
        }
        let own = app.world().get::<CascadeShadowConfig>(layered).expect("it is a light");
        assert_eq!(own.bounds, CascadeShadowConfig::default().bounds);
        for light in suns {
            for camera in cameras {
                let points = seen_points(&mut app, camera, 100);
                assert!(points.len() > 300, "{}", points.len());
                assert_eq!(lost(&app, light, camera, &points), 0);
            }
        }
    }
    // A camera wakes up, another goes.
    app.world_mut().get_mut::<Camera>(asleep).expect("it is a camera").is_active = true;
    app.world_mut().despawn(cameras[0]);
    app.update();
    let maps = &cascades(&app, suns[0]).cascades;
    assert!(maps.contains_key(&asleep) && maps.contains_key(&cameras[1]) && !maps.contains_key(&cameras[0]));
    assert!(app.world().resource::<PlannedLights>().plan(suns[0], cameras[0]).is_none());
}

#[test]
fn maps_follow_a_walking_camera_and_a_moving_sun() {
    let mut app = planned();
    spawn_town(&mut app);
    let light = spawn_sun(&mut app, morning());
    let camera = spawn_camera(&mut app, lens(), street());
    for frame in 0..16 {
        let turned = Quat::from_rotation_y(0.04 * frame as f32);
        let walked = street().translation + Vec3::new(0.3, 0.0, -2.0) * frame as f32;
        let eye = Transform::from_translation(walked).with_rotation(turned * street().rotation);
        *app.world_mut().get_mut::<Transform>(camera).expect("it is a camera") = eye;
        if frame > 8 {
            let towards = Quat::from_rotation_z(0.05 * (frame - 8) as f32) * morning();
            let sun = Transform::default().looking_to(towards, Vec3::Y);
            *app.world_mut().get_mut::<Transform>(light).expect("it is a light") = sun;
        }
        app.update();
        let points = seen_points(&mut app, camera, 30);
        assert_eq!(lost(&app, light, camera, &points), 0, "frame {frame}");
    }
}

#[test]
fn a_refused_light_has_what_bevy_gives_it_until_it_is_accepted() {
    let mut app = planned();
    let mut plain = bare();
    let own = CascadeShadowConfigBuilder { num_cascades: 3, maximum_distance: 77.0, ..Default::default() }.build();
    let mut lights = Vec::new();
    for app in [&mut app, &mut plain] {
        spawn_town(app);
        let light = spawn_sun(app, morning());
        app.world_mut().entity_mut(light).insert(own.clone());
        lights.push((light, spawn_camera(app, lens(), street())));
        app.update();
    }
    let (light, camera) = lights[0];
    let is_bevys = |app: &App| {
        let bevys = &cascades(&plain, lights[1].0).cascades[&lights[1].1];
        let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light");
        let ours = &cascades(app, light).cascades[&camera];
        let is_equal = |(a, b): (&bevy_light::cascade::Cascade, &bevy_light::cascade::Cascade)| {
            a.clip_from_world == b.clip_from_world
        };
        config.bounds == own.bounds && ours.len() == bevys.len() && ours.iter().zip(bevys).all(is_equal)
    };
    assert!(!is_bevys(&app), "the comparison tells planned cascades from Bevy's");
    let refused = LightShadows(ShadowConfig { map_sizes: vec![1024; 7], ..ShadowConfig::default() });
    app.world_mut().entity_mut(light).insert(refused);
    app.update();
    assert!(is_bevys(&app));
    let planned = app.world().resource::<PlannedLights>();
    assert_eq!(planned.refusal(light), Some(&Error::TooManySplits { given: 7, most: 4 }));
    app.world_mut().entity_mut(light).remove::<LightShadows>();
    app.update();
    assert!(!is_bevys(&app) && app.world().resource::<PlannedLights>().refusal(light).is_none());
    app.world_mut().entity_mut(light).insert(VolumetricLight);
    app.update();
    assert!(is_bevys(&app));
    app.world_mut().entity_mut(light).remove::<VolumetricLight>().insert(BevyCascades);
    app.update();
    assert!(is_bevys(&app) && app.world().resource::<PlannedLights>().refusal(light).is_none());
    app.world_mut().entity_mut(light).remove::<BevyCascades>();
    let scaled = street().with_scale(Vec3::splat(3.0));
    *app.world_mut().get_mut::<Transform>(camera).expect("it is a camera") = scaled;
    app.update();
    let planned = app.world().resource::<PlannedLights>();
    assert!(matches!(planned.refusal(light), Some(Error::ScaledCamera { .. })));
    assert_eq!(app.world().get::<CascadeShadowConfig>(light).expect("it is a light").bounds, own.bounds);
}

#[test]
fn what_the_application_writes_is_its_own_again_when_it_is_needed() {
    let mut app = planned();
    spawn_town(&mut app);
    let light = spawn_sun(&mut app, morning());
    spawn_camera(&mut app, lens(), street());
    app.update();
    app.update();
    let own = CascadeShadowConfigBuilder { maximum_distance: 42.0, ..Default::default() }.build();
    app.world_mut().entity_mut(light).insert(own.clone());
    app.update();
    assert_ne!(app.world().get::<CascadeShadowConfig>(light).expect("it is a light").bounds, own.bounds);
    app.world_mut().entity_mut(light).insert(BevyCascades);
    app.update();
    assert_eq!(app.world().get::<CascadeShadowConfig>(light).expect("it is a light").bounds, own.bounds);
}

#[test]
fn a_config_that_stays_is_not_reported_as_changed() {
    #[derive(Resource, Default)]
    struct Changes(usize);
    let mut app = planned();
    spawn_box(&mut app, Vec3::new(50.0, 0.5, 50.0), Transform::from_xyz(0.0, -0.5, 80.0));
    spawn_box(&mut app, Vec3::ONE, Transform::from_xyz(0.0, 1.0, 90.0));
    spawn_sun(&mut app, morning());
    spawn_camera(&mut app, lens(), street());
    app.init_resource::<Changes>().add_systems(
        Last,
        |mut changes: ResMut<Changes>, lights: Query<(), Changed<CascadeShadowConfig>>| {
            changes.0 += lights.iter().count();
        },
    );
    // A standing camera's maps settle.
    (0..120).for_each(|_| app.update());
    let settled = app.world().resource::<Changes>().0;
    (0..10).for_each(|_| app.update());
    assert_eq!(app.world().resource::<Changes>().0, settled);
    assert!(settled >= 1);
}

#[test]
fn an_empty_world_and_one_without_cameras_are_planned_without_complaint() {
    let mut app = planned();
    let light = spawn_sun(&mut app, morning());
    app.update();
    let camera = spawn_camera(&mut app, lens(), street());
    app.update();
    assert_eq!(app.world().resource::<PlannedLights>().refusal(light), None);
    assert!(cascades(&app, light).cascades.contains_key(&camera));
    let far = DVec3::splat(1e5);
    spawn_box(&mut app, Vec3::ONE, Transform::from_translation(Vec3::from_array(far.to_array().map(|m| m as f32))));
    let broken = Transform::from_translation(Vec3::NAN);
    let broken = spawn_box(&mut app, Vec3::ONE, broken);
    app.update();
    assert_eq!(app.world().resource::<PlannedLights>().refusal(light), None);
    app.world_mut().despawn(broken);
    app.update();
}
