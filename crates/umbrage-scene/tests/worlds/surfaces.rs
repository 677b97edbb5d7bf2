//! Surfaces: sound numbers, no degenerate triangles, closed solids with their outside outside.

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use umbrage_scene::{Mesh, Primitive};

use crate::worlds;

fn corner(primitive: &Primitive, index: u32) -> DVec3 {
    Vec3::from_array(primitive.positions[index as usize]).as_dvec3()
}

/// What is wrong with a primitive's numbers, if anything.
fn unsound(primitive: &Primitive) -> Option<String> {
    let count = primitive.positions.len();
    if primitive.normals.len() != count {
        return Some(format!("{count} positions, {} normals", primitive.normals.len()));
    }
    for (name, length) in [("uvs", primitive.uvs.len()), ("colors", primitive.colors.len())] {
        if length != 0 && length != count {
            return Some(format!("{count} positions, {length} {name}"));
        }
    }
    if primitive.indices.is_empty() || !primitive.indices.len().is_multiple_of(3) {
        return Some(format!("{} indices", primitive.indices.len()));
    }
    if let Some(index) = primitive.indices.iter().find(|&&index| index as usize >= count) {
        return Some(format!("index {index} of {count}"));
    }
    for (position, normal) in primitive.positions.iter().zip(&primitive.normals) {
        let (position, normal) = (Vec3::from_array(*position), Vec3::from_array(*normal));
        if !position.is_finite() || !normal.is_normalized() {
            return Some(format!("position {position}, normal {normal}"));
        }
    }
    primitive.indices.chunks_exact(3).find_map(|triangle| {
        let [a, b, c] = [0, 1, 2].map(|k| corner(primitive, triangle[k]));
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let height = (b - a).cross(c - a).length() / longest;
        // A thousandth of the longest side is thin; a millimetre is small; less is a mistake of
        // construction.
        let fine = height > 2e-4 * longest && longest > 1e-3;
        (!fine).then(|| format!("degenerate triangle {a} {b} {c}"))
    })
}

/// What keeps a mesh from being made of closed solids that face outwards, if anything.
fn leaky(triangles: &[[DVec3; 3]]) -> Option<String> {
    let mut known = HashMap::new();
    let mut points: Vec<DVec3> = Vec::new();
    let faces: Vec<[usize; 3]> = triangles
        .iter()
        .map(|triangle| {
            triangle.map(|point| {
                let bits = point.to_array().map(f64::to_bits);
                *known.entry(bits).or_insert_with(|| {
                    points.push(point);
                    points.len() - 1
                })
            })
        })
        .collect();
    let mut balance: HashMap<(usize, usize), i32> = HashMap::new();
    for face in &faces {
        for k in 0..3 {
            let (from, to) = (face[k], face[(k + 1) % 3]);
            *balance.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
        }
    }
    if let Some(((a, b), _)) = balance.iter().find(|(_, sum)| **sum != 0) {
        return Some(format!("open edge {} {}", points[*a], points[*b]));
    }
    // Parts that hang together.
    let mut part: Vec<usize> = (0..points.len()).collect();
    fn root(part: &mut [usize], mut i: usize) -> usize {
        while part[i] != i {
            part[i] = part[part[i]];
            i = part[i];
        }
        i
    }
    for face in &faces {
        for k in 1..3 {
            let (a, b) = (root(&mut part, face[0]), root(&mut part, face[k]));
            part[a] = b;
        }
    }
    let mut volumes: HashMap<usize, (f64, DVec3)> = HashMap::new();
    for face in &faces {
        let [a, b, c] = face.map(|i| points[i]);
        let entry = volumes.entry(root(&mut part, face[0])).or_insert((0.0, a));
        // Relative to a point of the part, so that small parts far from the origin keep their
        // digits.
        let origin = entry.1;
        entry.0 += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
    }
    volumes.values().find(|(volume, _)| *volume <= 0.0).map(|(volume, at)| format!("volume {volume} m³ at {at}"))
}

#[test]
fn numbers_are_sound() {
    for (world, scene) in worlds() {
        for mesh in &scene.meshes {
            for primitive in &mesh.primitives {
                if let Some(reason) = unsound(primitive) {
                    panic!("{} of {}: {reason}", mesh.name, world.title());
                }
                let textured = scene.materials[primitive.material].base_color_texture.is_some();
                assert_eq!(!primitive.uvs.is_empty(), textured, "{}: pictures need coordinates", mesh.name);
            }
        }
    }
}

#[test]
fn solids_are_closed_and_face_outwards() {
    let mut checked = 0;
    for (world, scene) in worlds() {
        let solid = |mesh: &&Mesh| !mesh.name.starts_with("ground ") && mesh.name != "four squares";
        for mesh in scene.meshes.iter().filter(solid) {
            for primitive in &mesh.primitives {
                if scene.materials[primitive.material].double_sided {
                    continue;
                }
                let triangles: Vec<_> = primitive
                    .indices
                    .chunks_exact(3)
                    .map(|triangle| [0, 1, 2].map(|k| corner(primitive, triangle[k])))
                    .collect();
                if let Some(reason) = leaky(&triangles) {
                    let material = &scene.materials[primitive.material].name;
                    panic!("{} ({material}) of {}: {reason}", mesh.name, world.title());
                }
                checked += triangles.len();
            }
        }
    }
    assert!(checked > 150_000, "only {checked} triangles were looked at");
}

#[test]
fn normals_agree_with_their_triangles() {
    for (world, scene) in worlds() {
        for mesh in &scene.meshes {
            for primitive in &mesh.primitives {
                if scene.materials[primitive.material].double_sided {
                    continue;
                }
                for triangle in primitive.indices.chunks_exact(3) {
                    let [a, b, c] = [0, 1, 2].map(|k| corner(primitive, triangle[k]));
                    let face = (b - a).cross(c - a).normalize();
                    for &index in triangle {
                        let normal = Vec3::from_array(primitive.normals[index as usize]).as_dvec3();
                        assert!(
                            normal.dot(face) > 0.25,
                            "{} of {}: normal {normal} on a triangle that faces {face} at {a}",
                            mesh.name,
                            world.title()
                        );
                    }
                }
            }
        }
    }
}

/// A cube without its first `missing` triangles, or inside out.
fn cube(missing: usize, inverted: bool) -> Vec<[DVec3; 3]> {
    let point = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .skip(missing)
        .map(|[a, b, c]| if inverted { [a, c, b] } else { [a, b, c] }.map(point))
        .collect()
}

#[test]
fn the_check_for_solids_can_say_no() {
    assert_eq!(leaky(&cube(0, false)), None);
    assert!(leaky(&cube(1, false)).expect("a hole").contains("open edge"));
    assert!(leaky(&cube(0, true)).expect("inside out").contains("volume -"));
}

#[test]
fn the_check_for_sound_numbers_can_say_no() {
    let good = Primitive {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        indices: vec![0, 1, 2],
        ..Primitive::default()
    };
    assert_eq!(unsound(&good), None);
    let bad = [
        Primitive { indices: vec![0, 1, 3], ..good.clone() },
        Primitive { indices: vec![0, 1, 1], ..good.clone() },
        Primitive { normals: vec![[0.0, 0.0, 1.1]; 3], ..good.clone() },
        Primitive { positions: vec![[f32::NAN; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], ..good.clone() },
        Primitive { uvs: vec![[0.0; 2]], ..good },
    ];
    for primitive in bad {
        assert!(unsound(&primitive).is_some(), "{primitive:?}");
    }
}
