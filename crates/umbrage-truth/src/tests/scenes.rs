//! Scenes put together by hand.

use glam::{DAffine3, DVec3};
use umbrage::{Aabb, Frustum, View};
use umbrage_scene::{AlphaMode, Material, Mesh, Object, Pose, Primitive, Scene};

use crate::{Truth, TruthMask};

/// A scene and its pose, one mesh per object.
#[derive(Debug, Default)]
pub struct Stage {
    pub scene: Scene,
    pub pose: Pose,
}

/// A triangle list.
#[derive(Clone, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

impl Stage {
    pub fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    /// Adds a primitive as an object of its own and answers the object's index.
    pub fn add_primitive(&mut self, primitive: Primitive, world_from_local: DAffine3, casts: bool) -> usize {
        let bounds = Aabb::from_points(
            primitive.positions.iter().map(|&p| world_from_local.transform_point3(DVec3::from(p.map(f64::from)))),
        );
        self.scene.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
        self.pose.objects.push(Object {
            node: 0,
            instance: None,
            mesh: self.scene.meshes.len() - 1,
            world_from_local,
            skinned: None,
            bounds,
            casts,
        });
        self.pose.objects.len() - 1
    }

    /// Adds an opaque two-sided shape that casts.
    pub fn add(&mut self, shape: Shape, world_from_local: DAffine3) -> usize {
        let material = self.material(Material { double_sided: true, ..Material::default() });
        self.add_primitive(shape.with_material(material), world_from_local, true)
    }

    /// Adds a shape with a material of its own.
    pub fn add_with(&mut self, shape: Shape, material: Material) -> usize {
        let material = self.material(material);
        self.add_primitive(shape.with_material(material), DAffine3::IDENTITY, true)
    }

    pub fn truth(&self, near_point: DVec3) -> Truth {
        Truth::build(&self.scene, &self.pose, near_point).unwrap()
    }

    pub fn mask(&self, view: &View, sun: DVec3, size: [u32; 2]) -> TruthMask {
        self.truth(view.eye()).mask(view, sun, size, &|_| {}).unwrap()
    }
}

impl Shape {
    pub fn with_material(self, material: usize) -> Primitive {
        Primitive { positions: self.positions, indices: self.indices, material, ..Primitive::default() }
    }

    /// A quad; counter-clockwise as listed.
    pub fn quad(corners: [[f32; 3]; 4]) -> Self {
        Self { positions: corners.to_vec(), indices: vec![0, 1, 2, 0, 2, 3] }
    }

    /// A horizontal square around the origin at height `y`, facing up.
    pub fn floor(half: f32, y: f32) -> Self {
        Self::quad([[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]])
    }

    /// An axis-aligned box, facing outwards.
    pub fn cuboid(min: [f32; 3], max: [f32; 3]) -> Self {
        let at = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 0 { min[k] } else { max[k] });
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut shape = Self::default();
        for face in faces {
            shape.append(Self::quad(face.map(at)));
        }
        shape
    }

    /// A sphere of `2 n` × `n` patches around the origin, facing outwards.
    pub fn sphere(radius: f32, n: u32) -> Self {
        let mut shape = Self::default();
        for i in 0..=n {
            for j in 0..2 * n {
                let polar = std::f64::consts::PI * f64::from(i) / f64::from(n);
                let around = std::f64::consts::PI * f64::from(j) / f64::from(n);
                let p = DVec3::new(polar.sin() * around.cos(), polar.cos(), polar.sin() * around.sin());
                shape.positions.push((f64::from(radius) * p).as_vec3().to_array());
            }
        }
        for i in 0..n {
            for j in 0..2 * n {
                let at = |i: u32, j: u32| i * 2 * n + j % (2 * n);
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                shape.indices.extend([a, b, c, a, c, d]);
            }
        }
        shape
    }

    pub fn append(&mut self, other: Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.indices.extend(other.indices.iter().map(|i| i + first));
    }
}

/// A view with a 60° lens from 0.1 m to 1 km.
pub fn view(eye: DVec3, target: DVec3) -> View {
    let frustum = Frustum::perspective(60_f64.to_radians(), 4.0 / 3.0, 0.1, 1000.0).unwrap();
    View::look_at_upright(eye, target, frustum).unwrap()
}

/// A material with the given alpha mode and base alpha.
pub fn with_alpha(alpha: AlphaMode, base: f32) -> Material {
    Material { alpha, base_color: [1.0, 1.0, 1.0, base], double_sided: true, ..Material::default() }
}
