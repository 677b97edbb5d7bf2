//! Scenes of boxes.

use glam::DVec3;
use umbrage_scene::{Material, Mesh, Node, Primitive, Scene};

/// Makes an empty scene with one material.
#[must_use]
pub fn scene() -> Scene {
    Scene { materials: vec![Material::default()], ..Scene::default() }
}

/// Adds an object to a scene.
pub fn add(scene: &mut Scene, primitive: Primitive) {
    scene.nodes.push(Node { mesh: Some(scene.meshes.len()), ..Node::default() });
    scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
}

/// Adds a rectangle from `corner` along `a` and `b`; its front faces `a × b`.
pub fn rectangle(into: &mut Primitive, corner: DVec3, a: DVec3, b: DVec3) {
    let first = into.positions.len() as u32;
    let normal = a.cross(b).normalize().as_vec3().to_array();
    for at in [corner, corner + a, corner + a + b, corner + b] {
        into.positions.push(at.as_vec3().to_array());
        into.normals.push(normal);
    }
    into.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
}

/// Adds a box of six rectangles that face outwards.
pub fn cuboid(into: &mut Primitive, min: DVec3, size: DVec3) {
    let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    for (corner, a, b) in [(min, z, y), (min + x, y, z), (min, x, z), (min + y, z, x), (min, y, x), (min + z, x, y)] {
        rectangle(into, corner, a, b);
    }
}

/// Makes a square ground of half edge `half` at height `y`, in metres.
#[must_use]
pub fn ground(y: f64, half: f64) -> Primitive {
    let mut primitive = Primitive::default();
    rectangle(&mut primitive, DVec3::new(-half, y, half), DVec3::X * 2.0 * half, DVec3::NEG_Z * 2.0 * half);
    primitive
}
