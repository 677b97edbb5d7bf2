//! An app without a window and without a GPU, and a town to look at.
#![allow(dead_code, reason = "each test file uses its own part")]

pub use bevy_app::prelude::*;
use bevy_asset::{AssetApp as _, AssetPlugin};
use bevy_camera::CameraPlugin;
pub use bevy_camera::prelude::*;
pub use bevy_camera::primitives::Aabb;
pub use bevy_ecs::prelude::*;
use bevy_image::Image;
pub use bevy_light::prelude::*;
pub use bevy_light::{Cascades, LightPlugin};
pub use bevy_math::prelude::*;
pub use bevy_mesh::Mesh3d;
use bevy_mesh::MeshPlugin;
use bevy_transform::TransformPlugin;
pub use bevy_transform::prelude::*;
use umbrage_bevy::UmbrageShadowsPlugin;

/// What the renderer's main world is made of, as far as cascades are concerned.
pub fn bare() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, AssetPlugin::default(), MeshPlugin));
    app.add_plugins((CameraPlugin, LightPlugin)).init_asset::<Image>();
    app
}

pub fn planned() -> App {
    let mut app = bare();
    app.add_plugins(UmbrageShadowsPlugin::default());
    app
}

/// Numbers from 0 to 1, the same in every run (SplitMix64).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }
}

/// A box of a mesh: the mesh itself is not needed, its bounds are.
pub fn spawn_box(app: &mut App, half: Vec3, at: Transform) -> Entity {
    let bounds = Aabb { center: Vec3::ZERO.into(), half_extents: half.into() };
    app.world_mut().spawn((Mesh3d::default(), bounds, at)).id()
}

/// A ground of 400 m and 300 boxes on it.
pub fn spawn_town(app: &mut App) -> Vec<Entity> {
    let mut numbers = Numbers(7);
    let ground = Transform::from_xyz(0.0, -0.5, 0.0);
    let mut town = vec![spawn_box(app, Vec3::new(200.0, 0.5, 200.0), ground)];
    for _ in 0..300 {
        let half = Vec3::new(numbers.between(0.5, 4.0), numbers.between(0.5, 9.0), numbers.between(0.5, 4.0));
        let at = Vec3::new(numbers.between(-190.0, 190.0), half.y, numbers.between(-190.0, 190.0));
        let turned = Quat::from_rotation_y(numbers.between(0.0, 3.0));
        town.push(spawn_box(app, half, Transform::from_translation(at).with_rotation(turned)));
    }
    town
}

pub fn spawn_sun(app: &mut App, towards: Vec3) -> Entity {
    let light = DirectionalLight { shadow_maps_enabled: true, ..Default::default() };
    app.world_mut().spawn((light, Transform::default().looking_to(towards, Vec3::Y))).id()
}

pub fn spawn_camera(app: &mut App, projection: impl Into<Projection>, at: Transform) -> Entity {
    app.world_mut().spawn((Camera3d::default(), projection.into(), at)).id()
}

pub fn lens() -> PerspectiveProjection {
    PerspectiveProjection { aspect_ratio: 16.0 / 9.0, ..Default::default() }
}

pub fn street() -> Transform {
    Transform::from_xyz(0.0, 6.0, 120.0).looking_at(Vec3::new(10.0, 0.0, 0.0), Vec3::Y)
}

pub fn morning() -> Vec3 {
    Vec3::new(-0.6, -0.7, -0.35)
}

pub fn cascades(app: &App, light: Entity) -> &Cascades {
    app.world().get::<Cascades>(light).expect("it is a light")
}

/// World points on the boxes of the app that a camera sees, hidden or not: `count` of them tried on
/// each box.
pub fn seen_points(app: &mut App, camera: Entity, count: usize) -> Vec<Vec3> {
    let world = app.world_mut();
    let (lens, at) = {
        let (camera, lens, at) = (
            world.get::<Camera>(camera).expect("it is a camera"),
            world.get::<Projection>(camera).expect("it is a camera"),
            world.get::<GlobalTransform>(camera).expect("it is a camera"),
        );
        let matrix = match &camera.sub_camera_view {
            Some(part) => lens.get_clip_from_view_for_sub(part),
            None => lens.get_clip_from_view(),
        };
        ((matrix, lens.far()), *at)
    };
    let clip_from_world = lens.0 * at.to_matrix().inverse();
    let mut numbers = Numbers(99);
    let mut points = Vec::new();
    let mut boxes = world.query::<(&Aabb, &GlobalTransform)>();
    for (bounds, place) in boxes.iter(world) {
        for _ in 0..count {
            let inside = Vec3::new(numbers.between(-1.0, 1.0), 1.0, numbers.between(-1.0, 1.0));
            let point = place.transform_point(Vec3::from(bounds.center) + inside * Vec3::from(bounds.half_extents));
            let clip = clip_from_world * point.extend(1.0);
            let depth = (point - at.translation()).dot(at.forward().as_vec3());
            let ndc = clip.truncate() / clip.w;
            let is_seen = clip.w > 0.0 && ndc.truncate().abs().max_element() < 1.0 && (0.0..1.0).contains(&ndc.z);
            if is_seen && depth < lens.1 {
                points.push(point);
            }
        }
    }
    points
}

/// View depth as Bevy's shaders have it.
pub fn depth_of(app: &App, camera: Entity, point: Vec3) -> f32 {
    let at = app.world().get::<GlobalTransform>(camera).expect("it is a camera");
    -at.to_matrix().inverse().transform_point3(point).z
}
