//! The worlds Robot War and Chessboard: places of objects, cameras and the path of the sun.

use glam::{DVec2, DVec3, dvec3};

use super::World;
use super::chessmen::Piece;
use super::maths::{Random, turn};
use super::robot::{self, Livery, Make};
use super::stage::{SkyPoint, Stage, scatter};
use super::terrain::{Surface, Terrain};
use crate::{Mesh, Node, Scene, Trs};

pub(super) fn stage(world: World) -> Stage {
    Stage::new(world.name(), world.near_far())
}

/// Returns a transform that stands an object on the ground, turned about Y and scaled.
pub(super) fn standing(at: DVec3, yaw_degrees: f64, scale: f64) -> Trs {
    Trs { translation: at, rotation: turn(DVec3::Y, yaw_degrees), scale: DVec3::splat(scale) }
}

/// Builds 160 robots on a plain of 1200 m × 1200 m.
pub(super) fn robot_war() -> Scene {
    const EDGE_M: f64 = 1200.0;
    let mut stage = stage(World::RobotWar);
    let sand = stage.paint("packed earth", 0xA2_96_84);
    Terrain::new(EDGE_M, 8, 3, |_| 0.0).place(&mut stage, &Surface { material: sand, tint: None, cast_shadow: false });

    let meshes = robot_meshes(&mut stage);
    let mut random = Random::new(160);
    let mut scales: Vec<f64> = (0..160).map(|_| random.between(1.3, 2.7)).collect();
    scales.sort_by(|a, b| b.total_cmp(a));
    let radii: Vec<f64> = scales.iter().map(|scale| 0.5 + robot::REACH * scale).collect();
    let places = scatter(&mut random, EDGE_M, &radii, |_| true);
    for (i, (place, scale)) in places.into_iter().zip(scales).enumerate() {
        let mesh = meshes[random.index(meshes.len())];
        let yaw = random.between(0.0, 360.0);
        stage.place(format!("robot {i}"), mesh, standing(dvec3(place.x, 0.0, place.y), yaw, scale));
    }

    robot_sun(&mut stage);
    stage.camera("near", dvec3(129.3, 9.6, -149.4), dvec3(140.5, -14.6, -53.1));
    stage.camera("middle", dvec3(317.3, 36.0, 411.3), dvec3(229.6, 16.4, 367.4));
    stage.camera("far", dvec3(86.1, 75.0, -263.1), dvec3(146.7, 46.5, -188.7));
    stage.camera("dueling", dvec3(-549.4, 19.3, -139.2), dvec3(-463.7, 17.5, -190.7));
    stage.camera("aerial", dvec3(-250.0, 330.0, 520.0), dvec3(0.0, 0.0, -20.0));
    stage.scene
}

/// Makes every make of robot in every colour.
pub(super) fn robot_meshes(stage: &mut Stage) -> Vec<usize> {
    let metal = stage.paint("gun metal", 0x4A_4D_52);
    let glass = stage.paint("visor", 0xD8_A2_3A);
    let armours = [
        stage.paint("rust red armour", 0x8C_58_4A),
        stage.paint("olive armour", 0x74_78_58),
        stage.paint("steel blue armour", 0x62_72_80),
    ];
    armours
        .iter()
        .flat_map(|&armour| Make::ALL.map(|make| robot::robot(make, Livery { armour, metal, glass })))
        .map(|mesh| stage.mesh(mesh))
        .collect()
}

/// Adds the sun of Robot War.
pub(super) fn robot_sun(stage: &mut Stage) {
    stage.sun(SkyPoint { bearing: 35.0, elevation: 31.0 }, SkyPoint { bearing: 130.0, elevation: 58.0 });
}

/// Builds a game on a board of 700 m × 700 m, with all men still on it.
pub(super) fn chessboard() -> Scene {
    const SQUARE_M: f64 = 87.5;
    let mut stage = stage(World::Chessboard);
    let light = stage.paint("maple", 0xCB_B6_8C);
    let dark = stage.paint("walnut", 0x7A_5A_45);
    let white = stage.paint("boxwood", 0xD9_C3_8F);
    let black = stage.paint("ebony", 0x5E_50_46);

    // Two by two squares are the pattern; 16 of them are the board.
    let pattern = stage.mesh(four_squares(SQUARE_M, [light, dark]));
    for i in 0..16 {
        let (column, row) = (f64::from(i % 4), f64::from(i / 4));
        let translation = 2.0 * SQUARE_M * dvec3(column - 1.5, 0.0, row - 1.5);
        stage.node(Node {
            name: format!("board {i}"),
            mesh: Some(pattern),
            local: Trs { translation, ..Trs::IDENTITY },
            cast_shadow: false,
            ..Node::default()
        });
    }

    let mut random = Random::new(32);
    for (side, material) in [("white", white), ("black", black)] {
        let sorts = [Piece::Pawn, Piece::Rook, Piece::Knight, Piece::Bishop, Piece::Queen, Piece::King];
        let meshes: Vec<usize> = sorts
            .iter()
            .map(|piece| {
                let name = format!("{side} {piece:?}").to_lowercase();
                let mesh = piece.mesh(&name, material);
                stage.mesh(mesh)
            })
            .collect();
        for (square, piece) in position(side) {
            // Files a to h run along +X, ranks 1 to 8 towards −Z; men look at the enemy.
            let [file, rank] = square;
            let at = SQUARE_M * dvec3(file as f64 - 3.5, 0.0, 3.5 - rank as f64);
            let yaw = if side == "white" { 180.0 } else { 0.0 } + random.between(-12.0, 12.0);
            let name = format!("{side} {piece:?} {}{}", char::from(b'a' + file), rank + 1).to_lowercase();
            let mesh = meshes[sorts.iter().position(|&sort| sort == piece).unwrap_or(0)];
            stage.place(name, mesh, standing(at, yaw, 1.0));
        }
    }

    stage.sun(SkyPoint { bearing: 150.0, elevation: 32.0 }, SkyPoint { bearing: 60.0, elevation: 60.0 });
    stage.camera("near", dvec3(75.4, 33.8, -87.2), dvec3(86.7, 9.6, 9.2));
    stage.camera("middle", dvec3(-29.1, 104.2, -100.6), dvec3(-41.4, 66.0, -9.0));
    stage.camera("far", dvec3(47.1, 130.5, 303.2), dvec3(27.4, 90.1, 213.9));
    stage.camera("dueling", dvec3(234.6, 55.9, 234.0), dvec3(150.6, 47.0, 180.5));
    stage.camera("aerial", dvec3(-330.0, 330.0, 430.0), dvec3(0.0, 0.0, 20.0));
    stage.scene
}

/// Returns the men of one side after the ten half moves 1 e4 e5 2 Nf3 Nc6 3 Bc4 Bc5 4 c3 Nf6 5 d3
/// d6, none taken. Files and ranks count from 0.
fn position(side: &str) -> Vec<([u8; 2], Piece)> {
    let white = side == "white";
    let rank = |from_own_side: u8| if white { from_own_side } else { 7 - from_own_side };
    let mut men = Vec::new();
    for file in 0..8 {
        let piece = Piece::BACK_RANK[usize::from(file)];
        let square = match (piece, file) {
            (Piece::Knight, 6) => [5, rank(2)],
            (Piece::Knight, 1) if !white => [2, rank(2)],
            (Piece::Bishop, 5) => [2, rank(3)],
            _ => [file, rank(0)],
        };
        men.push((square, piece));
        let steps = match file {
            4 => 2,
            3 => 1,
            2 if white => 1,
            _ => 0,
        };
        men.push(([file, rank(1 + steps)], Piece::Pawn));
    }
    men
}

/// Makes two by two squares around the origin, the light ones at north-west and south-east, each of
/// 2 × 2 cells.
fn four_squares(square: f64, [light, dark]: [usize; 2]) -> Mesh {
    let mut sculpture = super::sculpt::Sculpture::default();
    for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let corner = square * DVec2::new(f64::from(column) - 1.0, f64::from(row) - 1.0);
        let rows: Vec<Vec<_>> = (0..3)
            .map(|z| {
                (0..3)
                    .map(|x| {
                        let at = corner + square * DVec2::new(f64::from(x), f64::from(2 - z)) / 2.0;
                        dvec3(at.x, 0.0, at.y)
                    })
                    .collect()
            })
            .collect();
        sculpture.sheet(if (column + row) % 2 == 0 { light } else { dark }, &rows, DVec3::Y);
    }
    sculpture.finish("four squares")
}
