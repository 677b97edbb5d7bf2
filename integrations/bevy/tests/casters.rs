//! What stays in Bevy's lists of casters.

mod common;

use std::collections::{BTreeMap, BTreeSet};

use bevy_camera::visibility::{CascadesVisibleEntities, NoFrustumCulling, RenderLayers};
use bevy_light::{CascadeShadowConfig, CascadeShadowConfigBuilder, NotShadowCaster, NotShadowReceiver};
use common::*;
use umbrage_bevy::{MeshBoxes, PlannedLights, UmbrageSystems};

fn lists(app: &App, light: Entity, camera: Entity) -> Vec<BTreeSet<Entity>> {
    let visible = app.world().get::<CascadesVisibleEntities>(light).expect("it is a light");
    visible.entities[&camera].iter().map(|list| list.entities.iter().copied().collect()).collect()
}

/// Where a ray enters a box, if it does, as a distance.
fn hits(place: &GlobalTransform, bounds: &Aabb, origin: Vec3, direction: Vec3) -> bool {
    let local = place.affine().inverse();
    let (o, d) = (local.transform_point3(origin), local.transform_vector3(direction));
    let (low, high) = (Vec3::from(bounds.min()), Vec3::from(bounds.max()));
    let (a, b) = ((low - o) / d, (high - o) / d);
    let (first, last) = (a.min(b).max_element(), a.max(b).min_element());
    first <= last && last > 1e-3
}

/// Casters that stand between the light and a seen point and are missing in a list of the cascade
/// that Bevy asks for that point.
fn missing(app: &mut App, light: Entity, camera: Entity, lists: &[BTreeSet<Entity>]) -> usize {
    let points = seen_points(app, camera, 6);
    assert!(points.len() > 100, "{}", points.len());
    let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light").clone();
    let to_light = -app.world().get::<GlobalTransform>(light).expect("it is a light").forward().as_vec3();
    let depths: Vec<f32> = points.iter().map(|&point| depth_of(app, camera, point)).collect();
    let world = app.world_mut();
    let mut boxes = world.query_filtered::<(Entity, &Aabb, &GlobalTransform), Without<NotShadowCaster>>();
    let mut count = 0;
    for (entity, bounds, place) in boxes.iter(world) {
        for (point, depth) in points.iter().zip(&depths) {
            let Some(index) = config.bounds.iter().position(|far| depth < far) else { continue };
            if !lists[index].contains(&entity) && hits(place, bounds, *point, to_light) {
                count += 1;
            }
        }
    }
    count
}

struct Scene {
    app: App,
    light: Entity,
    camera: Entity,
    town: Vec<Entity>,
}

fn scene() -> Scene {
    let mut app = planned();
    let town = spawn_town(&mut app);
    let light = spawn_sun(&mut app, morning());
    let camera = spawn_camera(&mut app, lens(), street());
    app.update();
    app.update();
    Scene { app, light, camera, town }
}

#[test]
fn no_caster_is_missing_whose_shadow_is_seen() {
    let Scene { mut app, light, camera, .. } = scene();
    for frame in 0..3 {
        let mut kept = lists(&app, light, camera);
        assert_eq!(missing(&mut app, light, camera, &kept), 0, "frame {frame}");
        // Without those of one cascade, the search finds some missing.
        let most = (0..4).max_by_key(|&index| kept[index].len()).expect("there are four");
        kept[most].clear();
        assert!(missing(&mut app, light, camera, &kept) > 10);
        let mut eye = app.world_mut().get_mut::<Transform>(camera).expect("it is a camera");
        eye.translation += Vec3::new(5.0, -1.0, -30.0);
        eye.rotate_y(0.3);
        app.update();
    }
}

#[test]
fn lists_are_bevys_without_what_the_plan_leaves_out() {
    let Scene { mut app, light, camera, .. } = scene();
    let kept = lists(&app, light, camera);
    app.configure_sets(PostUpdate, UmbrageSystems::Cull.run_if(|| false));
    app.update();
    let bevys = lists(&app, light, camera);
    let plan = app.world().resource::<PlannedLights>().plan(light, camera).expect("it is planned");
    for (index, (kept, bevys)) in kept.iter().zip(&bevys).enumerate() {
        let planned: BTreeSet<u32> = plan.casters(index).iter().copied().collect();
        let both = bevys.iter().filter(|entity| planned.contains(&entity.index_u32()));
        assert_eq!(*kept, both.copied().collect(), "cascade {index}");
    }
    let count = |lists: &[BTreeSet<Entity>]| lists.iter().map(BTreeSet::len).sum::<usize>();
    assert!(count(&kept) < count(&bevys), "{} of {}", count(&kept), count(&bevys));
}

/// Casters of each cascade, and the geometric mean over seen points of a texel's edge in metres,
/// that of the cascade which Bevy asks.
fn drawn(app: &mut App, light: Entity, camera: Entity, points: &[Vec3]) -> (Vec<usize>, f32) {
    let counts = lists(app, light, camera).iter().map(BTreeSet::len).collect();
    let config = app.world().get::<CascadeShadowConfig>(light).expect("it is a light");
    let maps = &cascades(app, light).cascades[&camera];
    let texels = points.iter().map(|&point| {
        let index = config.bounds.iter().position(|&far| depth_of(app, camera, point) < far);
        maps[index.expect("it is in reach")].texel_size.ln()
    });
    (counts, (texels.sum::<f32>() / points.len() as f32).exp())
}

#[test]
fn planned_cascades_draw_fewer_casters_than_bevys_own_and_have_finer_texels() {
    let Scene { mut app, light, camera, .. } = scene();
    let points = seen_points(&mut app, camera, 20);
    let ours = drawn(&mut app, light, camera, &points);
    let far = app.world().get::<CascadeShadowConfig>(light).expect("it is a light").bounds[3];
    let mut app = bare();
    spawn_town(&mut app);
    let light = spawn_sun(&mut app, morning());
    let config = CascadeShadowConfigBuilder { maximum_distance: far, ..Default::default() }.build();
    app.world_mut().entity_mut(light).insert(config);
    let camera = spawn_camera(&mut app, lens(), street());
    app.update();
    app.update();
    let bevys = drawn(&mut app, light, camera, &points);
    let message = format!("to {far} m, planned {ours:?}, Bevy's {bevys:?}");
    eprintln!("{message}");
    let count = |(counts, _): &(Vec<usize>, f32)| counts.iter().sum::<usize>();
    assert!(2 * count(&ours) < count(&bevys), "{message}");
    assert!(ours.1 < bevys.1, "{message}");
}

#[test]
fn what_bevy_does_not_cull_stays() {
    let Scene { mut app, light, camera, .. } = scene();
    let behind = Transform::from_xyz(0.0, 1.0, 900.0);
    let boxed = spawn_box(&mut app, Vec3::ONE, behind);
    let unknown = app.world_mut().spawn((Mesh3d::default(), NoFrustumCulling, behind)).id();
    app.update();
    assert!(lists(&app, light, camera).iter().all(|list| !list.contains(&boxed) && list.contains(&unknown)));
    app.world_mut().entity_mut(boxed).insert(NoFrustumCulling);
    app.update();
    assert!(lists(&app, light, camera).iter().all(|list| list.contains(&boxed)));
    app.world_mut().entity_mut(boxed).remove::<NoFrustumCulling>();
    app.update();
    assert!(lists(&app, light, camera).iter().all(|list| !list.contains(&boxed)));
}

/// What the set has to hold, from the components alone: index, whether it casts and receives,
/// layers, and the box.
fn expected(app: &mut App) -> BTreeMap<u32, (bool, bool, u32, [f64; 6])> {
    let world = app.world_mut();
    let mut meshes = world.query::<(
        Entity,
        &Aabb,
        &GlobalTransform,
        &InheritedVisibility,
        Option<&RenderLayers>,
        Has<NotShadowCaster>,
        Has<NotShadowReceiver>,
    )>();
    let mut all = BTreeMap::new();
    for (entity, bounds, place, visibility, layers, is_no_caster, is_no_receiver) in meshes.iter(world) {
        if !visibility.get() || (is_no_caster && is_no_receiver) {
            continue;
        }
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for corner in 0..8 {
            let side = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let local = Vec3::from(bounds.half_extents) * Vec3::new(side(0), side(1), side(2));
            let at = place.transform_point(Vec3::from(bounds.center) + local);
            (low, high) = (low.min(at), high.max(at));
        }
        let layers = layers.map_or(1, |layers| layers.bits().first().copied().unwrap_or_default() as u32);
        let ends = [low.x, low.y, low.z, high.x, high.y, high.z].map(f64::from);
        all.insert(entity.index_u32(), (!is_no_caster, !is_no_receiver, layers, ends));
    }
    all
}

/// Whether the app's boxes are those, but for rounding outwards.
fn holds(app: &App, expected: &BTreeMap<u32, (bool, bool, u32, [f64; 6])>) -> bool {
    let set = app.world().resource::<MeshBoxes>().set();
    set.len() == expected.len()
        && set.iter().all(|(_, caster)| {
            expected.get(&caster.key).is_some_and(|&(casts, receives, layers, ends)| {
                let (min, max) = (caster.bounds.min.to_array(), caster.bounds.max.to_array());
                let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 2e-3;
                (caster.casts, caster.receives, caster.layers.bits()) == (casts, receives, layers)
                    && min.iter().zip(&ends[..3]).all(is_near)
                    && max.iter().zip(&ends[3..]).all(is_near)
            })
        })
}

#[test]
fn the_set_follows_every_change_of_the_world() {
    let Scene { mut app, mut town, .. } = scene();
    let mut numbers = Numbers(3);
    for frame in 0..40 {
        for _ in 0..12 {
            let at = (numbers.next() * town.len() as f32) as usize;
            let entity = town[at];
            let mut commands = app.world_mut().entity_mut(entity);
            match (numbers.next() * 11.0) as u32 {
                0 => {
                    commands.despawn();
                    town.swap_remove(at);
                }
                1 => {
                    commands.insert(NotShadowCaster);
                }
                2 => {
                    commands.insert(NotShadowReceiver);
                }
                3 => {
                    commands.remove::<(NotShadowCaster, NotShadowReceiver)>();
                }
                4 => {
                    commands.insert(RenderLayers::from_layers(&[2, 4]));
                }
                5 => {
                    commands.remove::<RenderLayers>();
                }
                6 => {
                    commands.insert(Visibility::Hidden);
                }
                7 => {
                    commands.insert(Visibility::Visible);
                }
                8 => {
                    let half_extents = Vec3::splat(numbers.next() + 0.1).into();
                    commands.insert(Aabb { center: Vec3::Y.into(), half_extents });
                }
                9 => {
                    let moved = Vec3::new(numbers.between(-9.0, 9.0), 0.0, numbers.next());
                    commands.get_mut::<Transform>().expect("it has one").translation += moved;
                }
                _ => town.push(spawn_box(&mut app, Vec3::ONE, Transform::from_xyz(numbers.next(), 1.0, 2.0))),
            }
        }
        app.update();
        let mut world = expected(&mut app);
        assert!(holds(&app, &world), "frame {frame}");
        let one = *world.keys().next().expect("there are some");
        world.get_mut(&one).expect("it is there").3[4] += 0.01;
        assert!(!holds(&app, &world), "the comparison sees 1 cm");
    }
}

#[test]
fn lights_and_casters_of_other_layers_do_not_meet() {
    let Scene { mut app, light, camera, town } = scene();
    let counted = lists(&app, light, camera).iter().map(BTreeSet::len).sum::<usize>();
    for &entity in &town[1..] {
        app.world_mut().entity_mut(entity).insert(RenderLayers::layer(3));
    }
    app.update();
    let now = lists(&app, light, camera).iter().map(BTreeSet::len).sum::<usize>();
    assert!(counted > 40 && now <= 4, "{counted} {now}");
    app.world_mut().entity_mut(light).insert(RenderLayers::from_layers(&[0, 3]));
    app.world_mut().entity_mut(camera).insert(RenderLayers::from_layers(&[0, 3]));
    app.update();
    assert_eq!(lists(&app, light, camera).iter().map(BTreeSet::len).sum::<usize>(), counted);
}
