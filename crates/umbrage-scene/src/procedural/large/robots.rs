//! Robot War with any number of robots.

use glam::dvec3;

use super::super::World;
use super::super::maths::Random;
use super::super::robot;
use super::super::terrain::{Surface, Terrain};
use super::super::worlds::{robot_meshes, robot_sun, stage, standing};
use super::{Crowd, Watch};
use crate::Scene;

/// Edge in metres of the square that each robot has to itself: its arms and its step aside.
const SQUARE_M: f64 = 36.0;

/// Metres of plain around the army.
const RIM_M: f64 = 200.0;

/// Builds robots in ranks and files, each a little out of line, on a plain of matching size.
pub(in super::super) fn robot_war(count: u32, watch: Watch<'_>) -> Scene {
    let mut stage = stage(World::RobotWar);
    let files = f64::from(count).sqrt().ceil();
    let edge = files * SQUARE_M + 2.0 * RIM_M;
    let sand = stage.paint("packed earth", 0xA2_96_84);
    let surface = Surface { material: sand, tint: None, cast_shadow: false };
    Terrain::new(edge.ceil(), 8, 3, |_| 0.0).place(&mut stage, &surface);

    let meshes = robot_meshes(&mut stage);
    let mut crowd = Crowd::new("robots", meshes);
    let mut random = Random::new(160);
    for index in 0..count {
        let (rank, file) = ((f64::from(index) / files).floor(), f64::from(index) % files);
        let scale = random.between(1.3, 2.7);
        let free = 0.5 * SQUARE_M - robot::REACH * scale;
        let mut along = |at: f64| SQUARE_M * (at + 0.5 - 0.5 * files) + random.between(-free, free);
        let at = dvec3(along(file), 0.0, along(rank));
        crowd.add(random.index(crowd.kinds()), standing(at, random.between(0.0, 360.0), scale));
        if index % 1024 == 0 {
            watch(index as f32 / count as f32);
        }
    }
    crowd.place(&mut stage);

    robot_sun(&mut stage);
    let (half, front) = (0.5 * files * SQUARE_M, 0.5 * files * SQUARE_M + 30.0);
    stage.camera("near", dvec3(6.0, 9.0, 0.4 * half), dvec3(14.0, 3.0, 0.4 * half - 40.0));
    stage.camera("middle", dvec3(-30.0, 36.0, front), dvec3(20.0, 10.0, front - 120.0));
    stage.camera("far", dvec3(-60.0, 90.0, front + 60.0), dvec3(0.0, 20.0, front - 200.0));
    stage.camera("dueling", dvec3(-half.min(500.0), 19.0, 0.0), dvec3(80.0 - half.min(500.0), 15.0, -48.0));
    stage.camera("aerial", dvec3(-half.min(400.0), 330.0, half.min(500.0) + 120.0), dvec3(0.0, 0.0, -20.0));
    stage.scene
}
