//! Worlds of `umbrage-scene` in Bevy: one entity and one mesh for each object.

use bevy::asset::RenderAssetUsages;
use bevy::light::NotShadowCaster;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use umbrage_bevy::umbrage::View;
use umbrage_bevy::umbrage::glam::DVec3;
use umbrage_scene::procedural::{World as Procedural, WorldOptions};
use umbrage_scene::{Pose, Scene, camera_view, light_direction};

use crate::Failure;
use crate::mask::MaskMaterial;
use crate::studio::{Size, Studio};

/// A world at one moment.
pub struct Stage {
    pub scene: Scene,
    pub pose: Pose,
    pub sun: DVec3,
}

impl Stage {
    /// A world by its name, with this many robots or buildings.
    pub fn new(name: &str, count: Option<u32>) -> Result<Self, Failure> {
        let world = Procedural::from_name(name).ok_or_else(|| format!("no world is called `{name}`"))?;
        let options = match world {
            Procedural::RobotWar => WorldOptions { robots: count, ..WorldOptions::default() },
            _ => WorldOptions { buildings: count, ..WorldOptions::default() },
        };
        let scene = world.build_with(&options, &|_| ())?;
        let pose = scene.pose(0.0)?;
        let sun = light_direction(&scene, &pose, 0)?;
        Ok(Self { scene, pose, sun })
    }

    /// What a camera of the world sees.
    pub fn view(&self, camera: &str, size: Size) -> Result<View, Failure> {
        let index = self.scene.cameras.iter().position(|known| known.name == camera);
        let index = index.ok_or_else(|| format!("the world has no camera `{camera}`"))?;
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        Ok(camera_view(&self.scene, &self.pose, index, aspect, None, None)?)
    }

    /// The sun's direction of travel for Bevy.
    pub fn travel(&self) -> Vec3 {
        Vec3::from(self.sun.to_array().map(|entry| entry as f32))
    }

    /// Puts the objects into the app, coloured or as a mask of visibility.
    pub fn place(&self, studio: &mut Studio, as_mask: bool) {
        let world = studio.app.world_mut();
        let meshes: Vec<Handle<Mesh>> = {
            let mut assets = world.resource_mut::<Assets<Mesh>>();
            self.scene.meshes.iter().map(|mesh| assets.add(mesh_of(&self.scene, mesh))).collect()
        };
        let paint = StandardMaterial { perceptual_roughness: 1.0, reflectance: 0.0, ..default() };
        let paint = world.resource_mut::<Assets<StandardMaterial>>().add(paint);
        let mask = world.resource_mut::<Assets<MaskMaterial>>().add(MaskMaterial {});
        for object in &self.pose.objects {
            let matrix = object.world_from_local;
            let matrix =
                Mat4::from_cols_array(&umbrage_bevy::umbrage::glam::DMat4::from(matrix).as_mat4().to_cols_array());
            let mut entity = world.spawn((Mesh3d(meshes[object.mesh].clone()), Transform::from_matrix(matrix)));
            if as_mask {
                entity.insert(MeshMaterial3d(mask.clone()));
            } else {
                entity.insert(MeshMaterial3d(paint.clone()));
            }
            if !object.casts {
                entity.insert(NotShadowCaster);
            }
        }
    }
}

/// All primitives of a mesh as one, with their materials' colours at the vertices: an object is one
/// caster, as it is in the judge's scene.
fn mesh_of(scene: &Scene, mesh: &umbrage_scene::Mesh) -> Mesh {
    let (mut positions, mut normals, mut colours, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for primitive in &mesh.primitives {
        let first = positions.len() as u32;
        let base = Vec4::from(scene.materials[primitive.material].base_color);
        positions.extend_from_slice(&primitive.positions);
        normals.extend_from_slice(&primitive.normals);
        let tint = |vertex: usize| primitive.colors.get(vertex).map_or(Vec4::ONE, |&tint| Vec4::from(tint));
        colours.extend((0..primitive.positions.len()).map(|vertex| (base * tint(vertex)).to_array()));
        indices.extend(primitive.indices.iter().map(|index| first + index));
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
        .with_inserted_indices(Indices::U32(indices))
}
