//! Scenes of a given number of objects, for GPU Gems' Figure 10-9.

use glam::{DQuat, DVec3};
use umbrage_scene::{Mesh, Node, Scene, Trs, procedural::World};

use crate::failure::{Failure, Result};

/// Square metres of ground per object: the density of Robot War.
const GROUND_PER_OBJECT: f64 = 9000.0;

/// Makes `count` robots on a plane of Robot War's density, seen from its edge.
///
/// # Errors
/// [`Failure::Other`] if Robot War has no robots.
pub fn crowd(count: u32) -> Result<(Scene, DVec3, DVec3)> {
    let mut scene = World::RobotWar.build();
    let missing = || Failure::other("Robot War has no robots and ground to make a crowd of");
    let standing: Vec<usize> =
        scene.nodes.iter().filter(|node| node.cast_shadow).filter_map(|node| node.mesh).collect();
    let triangles = |mesh: &Mesh| mesh.primitives.iter().map(|p| p.indices.len() / 3).sum::<usize>();
    // The first robot's mesh: every object alike, as in the source.
    let robot = standing.into_iter().find(|&mesh| triangles(&scene.meshes[mesh]) > 1000).ok_or_else(missing)?;
    let edge = (GROUND_PER_OBJECT * f64::from(count)).sqrt();
    let ground = Mesh { name: "ground".into(), primitives: vec![plane(edge)], ..Mesh::default() };
    scene.meshes.push(ground);
    let ground = scene.meshes.len() - 1;
    scene.nodes = vec![Node { name: "ground".into(), mesh: Some(ground), ..Node::default() }];
    scene.nodes.extend((0..count).map(|i| {
        // The sequence of the plastic number: even at any count, and no two runs differ.
        let (x, z) = ((f64::from(i) * 0.754_877_666_246_693).fract(), (f64::from(i) * 0.569_840_290_998_053).fract());
        Node {
            name: format!("robot {i}"),
            mesh: Some(robot),
            local: Trs {
                translation: DVec3::new((x - 0.5) * edge, 0.0, (z - 0.5) * edge),
                rotation: DQuat::from_rotation_y(f64::from(i) * 2.4),
                scale: DVec3::ONE,
            },
            ..Node::default()
        }
    }));
    scene.cameras.clear();
    scene.lights.clear();
    scene.animations.clear();
    scene.skins.clear();
    Ok((scene, DVec3::new(0.0, 25.0, 0.5 * edge), DVec3::new(0.0, 0.0, 0.1 * edge)))
}

fn plane(edge: f64) -> umbrage_scene::Primitive {
    let half = (0.5 * edge) as f32;
    umbrage_scene::Primitive {
        positions: vec![[-half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half], [half, 0.0, -half]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..umbrage_scene::Primitive::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crowd_has_its_number() {
        for count in [1, 10, 250] {
            let (scene, eye, _) = crowd(count).expect("a crowd");
            let pose = scene.pose(0.0).expect("a pose");
            assert_eq!(pose.objects.len(), count as usize + 1);
            assert!(eye.is_finite());
            scene.validate().expect("a valid scene");
        }
    }
}
