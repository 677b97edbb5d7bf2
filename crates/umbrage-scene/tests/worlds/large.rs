//! Worlds of any number of objects.

use glam::{DVec2, DVec3};
use umbrage_scene::procedural::{World, WorldOptions};
use umbrage_scene::{Detail, Error, Pose, Scene};

use super::census::Fingerprint;
use super::ground::Ground;

fn none() -> WorldOptions {
    WorldOptions::default()
}

/// Each world with so many objects, and the name of the nodes that hold them.
fn of(count: u32) -> [(World, WorldOptions, &'static str); 3] {
    [
        (World::RobotWar, WorldOptions { robots: Some(count), ..none() }, "robots "),
        (World::Forest, WorldOptions { trees: Some(count), ..none() }, "trees "),
        (World::CityBlocks, WorldOptions { buildings: Some(count), ..none() }, "buildings "),
    ]
}

fn built(world: World, options: &WorldOptions) -> Scene {
    world.build_with(options, &|_| ()).unwrap_or_else(|error| panic!("{error}"))
}

fn posed(scene: &Scene) -> Pose {
    scene.pose(0.0).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn there_are_as_many_as_were_asked_for() {
    for count in [1, 37, 700] {
        for (world, options, name) in of(count) {
            let scene = built(world, &options);
            let named = scene.nodes.iter().filter(|node| node.name.starts_with(name));
            assert_eq!(named.map(|node| node.instances.len()).sum::<usize>(), count as usize, "{}", world.title());
            assert!(scene.cameras.len() == 5 && scene.lights.len() == 1, "{}", world.title());
            scene.validate().unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

#[test]
fn they_are_the_same_every_time_and_others_with_another_number() {
    for (world, options, _) in of(300) {
        let prints = |options: &WorldOptions| {
            let scene = built(world, options);
            let places = posed(&scene).objects.iter().map(|object| object.bounds.min).fold(DVec3::ZERO, |a, b| a + b);
            (Fingerprint::of(&scene), places.to_array().map(f64::to_bits))
        };
        assert_eq!(prints(&options), prints(&options), "{}", world.title());
        let (_, more, _) = of(301)[World::LARGE.iter().position(|&large| large == world).map_or(0, |at| at + 1)];
        assert_ne!(prints(&options), prints(&more), "{}", world.title());
    }
}

#[test]
fn trees_stand_on_the_ground_and_robots_apart() {
    let (_, options, _) = of(900)[1];
    let scene = built(World::Forest, &options);
    let (ground, pose) = (Ground::of(&scene), posed(&scene));
    let trees = pose.objects.iter().filter(|object| object.instance.is_some());
    for tree in trees {
        let at = tree.world_from_local.translation;
        let height = ground.height(DVec2::new(at.x, at.z)).expect("on the ground");
        assert!((at.y - height).abs() < 1e-3, "a tree at {at}, the ground at {height}");
    }
    let (_, options, _) = of(400)[0];
    let robots = posed(&built(World::RobotWar, &options));
    let boxes: Vec<_> = robots.objects.iter().filter(|object| object.instance.is_some()).collect();
    for (i, a) in boxes.iter().enumerate() {
        for b in &boxes[..i] {
            let apart = a.world_from_local.translation.distance(b.world_from_local.translation);
            assert!(apart > 7.0, "{} and {}", a.world_from_local.translation, b.world_from_local.translation);
        }
    }
}

#[test]
fn buildings_do_not_meet() {
    let (_, options, _) = of(600)[2];
    let scene = built(World::CityBlocks, &options);
    let pose = posed(&scene);
    let is_building = |node: usize| scene.nodes[node].name.starts_with("buildings ");
    let boxes: Vec<_> = pose.objects.iter().filter(|object| is_building(object.node)).map(|o| o.bounds).collect();
    assert_eq!(boxes.len(), 600);
    for (i, a) in boxes.iter().enumerate() {
        for b in &boxes[..i] {
            let over = (a.max.min(b.max) - a.min.max(b.min)).min_element();
            // Eaves may lie over a neighbour's.
            assert!(over < 1.3, "{a:?} and {b:?}");
        }
    }
}

#[test]
fn shapes_get_coarser_with_distance() {
    for (world, options, name) in &of(500)[1..] {
        let scene = built(*world, options);
        for (&mesh, levels) in &scene.levels {
            let triangles = |mesh: usize| scene.meshes[mesh].triangles();
            let shapes: Vec<usize> = std::iter::once(mesh).chain(levels.iter().map(|level| level.mesh)).collect();
            assert!(shapes.windows(2).all(|pair| triangles(pair[0]) >= triangles(pair[1])), "{name}{mesh}");
            assert!(triangles(shapes[shapes.len() - 1]) <= 40, "{name}{mesh}");
            assert_eq!(scene.shape_of(mesh, 0.0), mesh);
            assert_eq!(scene.shape_of(mesh, f64::INFINITY), shapes[shapes.len() - 1]);
        }
        let fine = posed(&scene);
        let eye = DVec3::new(0.0, 20.0, 0.0);
        let seen = scene.pose_for(0.0, Detail { eyes: vec![eye], angle: 0.01 }).expect("a pose");
        let triangles = |pose: &Pose| pose.objects.iter().map(|o| scene.meshes[o.mesh].triangles()).sum::<usize>();
        assert!(2 * triangles(&seen) < triangles(&fine), "{name}: {} of {}", triangles(&seen), triangles(&fine));
        for (seen, fine) in seen.objects.iter().zip(&fine.objects) {
            let wanted = 0.01 * fine.world_from_local.translation.distance(eye);
            let shown = scene.levels.get(&fine.mesh).into_iter().flatten().find(|level| level.mesh == seen.mesh);
            assert!(seen.mesh == fine.mesh || shown.is_some_and(|level| level.detail_m * 0.6 <= wanted), "{name}");
        }
        let at_once = scene.pose_for(0.0, Detail { eyes: vec![eye], angle: 0.0 }).expect("a pose");
        assert_eq!(triangles(&at_once), triangles(&fine));
    }
}

#[test]
fn numbers_of_another_world_are_refused() {
    let refused = |world: World, options: WorldOptions| match world.build_with(&options, &|_| ()) {
        Err(Error::WorldOption { option, .. }) => option,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(World::Forest, WorldOptions { robots: Some(3), ..none() }), "robots");
    assert_eq!(refused(World::RobotWar, WorldOptions { trees: Some(3), ..none() }), "trees");
    assert_eq!(refused(World::Forest, WorldOptions { trees: Some(0), ..none() }), "trees");
    assert_eq!(refused(World::CityBlocks, WorldOptions { buildings: Some(u32::MAX), ..none() }), "buildings");
    assert_eq!(refused(World::RobotWar, WorldOptions { robots: Some(100_001), ..none() }), "robots");
}

#[test]
fn building_says_how_far_it_is() {
    let said = std::cell::RefCell::new(Vec::new());
    let (world, options, _) = of(5000)[1];
    world.build_with(&options, &|done| said.borrow_mut().push(done)).expect("a forest");
    let said = said.into_inner();
    assert!(said.len() > 1 && said.windows(2).all(|pair| pair[0] <= pair[1]), "{said:?}");
    assert!(said.iter().all(|done| (0.0..=1.0).contains(done)), "{said:?}");
}
