//! Things stand on the ground, apart from each other and inside the world, at all times; cameras
//! and suns are as told.

use glam::{DVec2, DVec3, Vec3, Vec3Swizzles as _};
use umbrage_scene::procedural::World;
use umbrage_scene::{Keys, Lens, LightKind, Pose, Scene, camera_view, light_direction};

use crate::ground::Ground;
use crate::{is_ground, worlds};

/// The mesh nodes that stand on the ground, and those that they carry.
fn standing(scene: &Scene) -> Vec<(usize, Vec<usize>)> {
    let is_root = |node: &usize| {
        let node = &scene.nodes[*node];
        node.mesh.is_some() && node.parent.is_none() && !is_ground(&node.name)
    };
    let root_of = |mut node: usize| {
        while let Some(parent) = scene.nodes[node].parent {
            node = parent;
        }
        node
    };
    (0..scene.nodes.len())
        .filter(is_root)
        .map(|root| (root, (0..scene.nodes.len()).filter(|&node| root_of(node) == root).collect()))
        .collect()
}

/// Vertices of a node in the world.
fn vertices<'a>(scene: &'a Scene, pose: &'a Pose, node: usize) -> impl Iterator<Item = DVec3> + 'a {
    let world_from_node = pose.world_from_node[node];
    let primitives = scene.nodes[node].mesh.into_iter().flat_map(|mesh| &scene.meshes[mesh].primitives);
    primitives
        .flat_map(|primitive| &primitive.positions)
        .map(move |&local| world_from_node.transform_point3(Vec3::from_array(local).as_dvec3()))
}

fn moments(world: World) -> &'static [f64] {
    match world {
        World::RobotWar | World::Chessboard => &[0.0],
        _ => &[0.0, 3.7, 17.9, 41.3],
    }
}

#[test]
fn feet_are_on_the_ground() {
    for (world, scene) in worlds() {
        let ground = Ground::of(scene);
        for &time in moments(*world) {
            let pose = scene.pose(time).expect("a world has a pose");
            for (root, _) in standing(scene) {
                let name = &scene.nodes[root].name;
                // How far the lowest vertex is above the ground under it, and how deep anything
                // reaches.
                let above = |point: DVec3| point.y - ground.height(point.xz()).expect("inside the world");
                let lowest = vertices(scene, &pose, root).map(above).fold(f64::MAX, f64::min);
                let deepest = match name.split(' ').next() {
                    Some("rock") => 20.0,
                    Some("windmill") => 3.0,
                    Some("palm" | "pine" | "cactus") => 3.5,
                    Some("knight" | "dwarf") => 1.2,
                    Some("clawbot") => 0.2,
                    _ => 1e-4,
                };
                let height = if matches!(world, World::Knights) { 0.1 } else { 1e-4 };
                assert!(
                    (-deepest..=height).contains(&lowest),
                    "{name} of {} at {time} s: its lowest point is {lowest} m above the ground",
                    world.title()
                );
            }
        }
    }
}

#[test]
fn things_are_inside_and_apart() {
    for (world, scene) in worlds() {
        let edge = match world {
            World::RobotWar => 1200.0,
            World::Chessboard => 700.0,
            World::Knights => 1265.0,
            World::MiningTerrain => 1600.0,
            World::Thicket | World::Forest | World::CityBlocks => unreachable!("it is none of the paper's"),
        };
        for &time in moments(*world) {
            let pose = scene.pose(time).expect("a world has a pose");
            let circles: Vec<(&str, DVec2, f64)> = standing(scene)
                .into_iter()
                .map(|(root, nodes)| {
                    let middle = pose.world_from_node[root].translation.xz();
                    let reach = nodes
                        .iter()
                        .flat_map(|&node| vertices(scene, &pose, node))
                        .map(|point| point.xz().distance(middle))
                        .fold(0.0, f64::max);
                    (scene.nodes[root].name.as_str(), middle, reach)
                })
                .collect();
            for (i, &(name, middle, reach)) in circles.iter().enumerate() {
                let farthest = middle.abs().max_element() + reach;
                assert!(farthest <= 0.5 * edge, "{name} of {} reaches {farthest} m", world.title());
                for &(other_name, other, other_reach) in &circles[i + 1..] {
                    let gap = middle.distance(other) - reach - other_reach;
                    assert!(gap > 0.0, "{name} and {other_name} of {} at {time} s: {gap} m", world.title());
                }
            }
        }
    }
}

#[test]
fn chessmen_fit_their_squares() {
    let (_, scene) = &worlds()[1];
    let pose = scene.pose(0.0).expect("a world has a pose");
    let mut squares = std::collections::BTreeSet::new();
    for (root, _) in standing(scene) {
        let at = pose.world_from_node[root].translation.xz() / 87.5 + DVec2::splat(3.5);
        assert!((at - at.round()).length() < 1e-9, "{} stands in the middle of a square", scene.nodes[root].name);
        let square = at.round();
        let name = format!("{}{}", char::from(b'a' + square.x as u8), 8 - square.y as u8);
        assert!(scene.nodes[root].name.ends_with(&name), "{} stands on {name}", scene.nodes[root].name);
        assert!(squares.insert(name.clone()), "two men on {name}");
        for point in vertices(scene, &pose, root) {
            let off = (point.xz() / 87.5 + DVec2::splat(3.5) - square).abs().max_element();
            assert!(off < 0.5, "{} leaves its square", scene.nodes[root].name);
        }
    }
}

#[test]
fn cameras_stand_above_the_ground_and_see_casters() {
    for (world, scene) in worlds() {
        let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
        assert_eq!(names, ["near", "middle", "far", "dueling", "aerial"]);
        let (near, far) = world.near_far();
        assert_eq!((near, far), (1.0, if *world == World::MiningTerrain { 1000.0 } else { 800.0 }));
        let ground = Ground::of(scene);
        let pose = scene.pose(0.0).expect("a world has a pose");
        for (index, camera) in scene.cameras.iter().enumerate() {
            let lens = Lens::Perspective { yfov: 60_f64.to_radians(), aspect: None, znear: near, zfar: Some(far) };
            assert_eq!(camera.lens, lens);
            let eye = pose.world_from_node[camera.node].translation;
            if let Some(height) = ground.height(eye.xz()) {
                assert!(eye.y > height + 3.0, "{} of {} is {} m up", camera.name, world.title(), eye.y - height);
            }
            let inside = pose.objects.iter().find(|object| {
                let bounds = object.bounds;
                !is_ground(&scene.nodes[object.node].name) && eye.cmpge(bounds.min).all() && eye.cmple(bounds.max).all()
            });
            assert!(inside.is_none(), "{} of {} is inside something", camera.name, world.title());
            let view = camera_view(scene, &pose, index, 800.0 / 600.0, None, None).expect("a view");
            let seen = pose
                .objects
                .iter()
                .filter(|object| object.casts && (near..far).contains(&view.view_depth(object.bounds.center())));
            assert!(seen.count() >= 5, "{} of {} has casters in front of it", camera.name, world.title());
        }
    }
}

#[test]
fn the_sun_stands_well_and_never_sets() {
    for (world, scene) in worlds() {
        assert_eq!(scene.lights.len(), 1);
        let light = &scene.lights[0];
        assert_eq!((light.name.as_str(), light.kind), ("sun", LightKind::Directional));
        let elevation = |time: f64| {
            let pose = scene.pose(time).expect("a world has a pose");
            let direction = light_direction(scene, &pose, 0).expect("a sun");
            (-direction.y).asin().to_degrees()
        };
        assert!((30.0..=45.0).contains(&elevation(0.0)), "{}: {}°", world.title(), elevation(0.0));
        assert!((elevation(0.0) - elevation(120.0)).abs() < 1e-3, "the sun comes back");
        for quarter in 1..8 {
            assert!(elevation(15.0 * f64::from(quarter)) > 29.9, "{}", world.title());
        }
        assert!(elevation(60.0) > elevation(0.0) + 10.0, "{}: the sun moves", world.title());
        // The dueling camera looks into the light: the sun is in its picture or just above it.
        let pose = scene.pose(0.0).expect("a world has a pose");
        let sun = -light_direction(scene, &pose, 0).expect("a sun");
        let dueling = scene.cameras.iter().find(|camera| camera.name == "dueling").expect("a dueling camera");
        let look = -pose.world_from_node[dueling.node].matrix3.z_axis;
        let angle = look.dot(sun).acos().to_degrees();
        assert!(angle < 40.0, "{}: the sun is {angle}° off", world.title());
    }
}

#[test]
fn clips_are_loops_without_a_jump() {
    for (world, scene) in worlds() {
        let moving = scene.animations.len();
        assert_eq!(moving, [1, 1, 31, 26][World::PAPER.iter().position(|other| other == world).expect("a world")]);
        for clip in &scene.animations {
            for channel in &clip.channels {
                assert!(channel.times.windows(2).all(|pair| pair[0] < pair[1]), "{}: times rise", clip.name);
                assert_eq!(channel.times[0], 0.0, "{}", clip.name);
                assert_eq!(f64::from(channel.times[channel.times.len() - 1]), clip.duration, "{}", clip.name);
                match &channel.values {
                    Keys::Rotation(keys) => {
                        let turn = |a: &[f32; 4], b: &[f32; 4]| {
                            let dot: f32 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                            2.0 * f64::from(dot.abs().min(1.0)).acos().to_degrees()
                        };
                        assert!(keys.iter().all(|key| turn(key, key) < 0.2), "{}: unit quaternions", clip.name);
                        // Slerp has one shortest way between neighbours, and the last key is the
                        // first.
                        assert!(keys.windows(2).all(|pair| turn(&pair[0], &pair[1]) < 60.0), "{}", clip.name);
                        assert!(turn(&keys[0], &keys[keys.len() - 1]) < 0.2, "{}", clip.name);
                    }
                    Keys::Translation(keys) => {
                        let way = |a: &[f32; 3], b: &[f32; 3]| Vec3::from_array(*a).distance(Vec3::from_array(*b));
                        assert!(keys.windows(2).all(|pair| way(&pair[0], &pair[1]) < 5.0), "{}", clip.name);
                        assert!(way(&keys[0], &keys[keys.len() - 1]) < 1e-3, "{}", clip.name);
                    }
                    Keys::Scale(_) | Keys::Weights { .. } => panic!("{}: nothing grows", clip.name),
                }
            }
        }
    }
}

#[test]
fn what_should_move_moves_and_the_rest_stands_still() {
    for (world, scene) in worlds() {
        let (start, later) = (scene.pose(0.0).expect("a pose"), scene.pose(4.1).expect("a pose"));
        for (node, description) in scene.nodes.iter().enumerate().filter(|(_, node)| node.mesh.is_some()) {
            let name = &description.name;
            let moved = !start.world_from_node[node].abs_diff_eq(later.world_from_node[node], 1e-6);
            let walks = *world == World::Knights && (name.starts_with("knight ") || name.starts_with("dwarf "));
            let turns = name.ends_with("sails") || name.ends_with("trunk") || name.ends_with("jaw");
            assert_eq!(moved, walks || turns, "{name} of {}", world.title());
        }
    }
}

#[test]
fn walkers_go_where_they_look() {
    let (_, scene) = &worlds()[2];
    let mut walkers = 0;
    for &time in &[0.0, 6.3, 22.1] {
        let (now, soon) = (scene.pose(time).expect("a pose"), scene.pose(time + 0.4).expect("a pose"));
        for (node, description) in scene.nodes.iter().enumerate() {
            if !(description.name.starts_with("knight ") || description.name.starts_with("dwarf ")) {
                continue;
            }
            let way = (soon.world_from_node[node].translation - now.world_from_node[node].translation).xz();
            let look = now.world_from_node[node].matrix3.z_axis.xz();
            let angle = way.angle_to(look).to_degrees().abs();
            assert!(angle < 8.0, "{} looks {angle}° off its way at {time} s", description.name);
            let speed = way.length() / 0.4;
            assert!((3.5..5.0).contains(&speed), "{} walks at {speed} m/s", description.name);
            walkers += 1;
        }
    }
    assert_eq!(walkers, 90);
}
