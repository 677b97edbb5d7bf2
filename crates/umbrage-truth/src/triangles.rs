//! The scene's triangles in the world, in `f64`, relative to a world point near the camera.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec3A};
use obvhs::aabb::Aabb;
use rayon::prelude::*;
use umbrage_scene::{AlphaMode, Pose, Primitive, Scene};

use crate::alpha::{AlphaPicture, AlphaTest};
use crate::{Error, Result};

/// Largest distance of a ray from an edge that it meets, as a share of the coordinates of both: the
/// rounding of a corner that was placed, moved and sheared.
pub(crate) const EDGE_ERROR: f64 = 16.0 * f64::EPSILON;

/// Largest coordinate in metres. Beyond it `f32` boxes and inverse directions would overflow.
const FARTHEST: f64 = 1e12;

/// One primitive of one object, as rays see it. Its triangles are numbered from `first` on.
#[derive(Debug)]
pub(crate) struct Surface {
    /// Index into the pose's objects.
    pub object: u32,
    mesh: u32,
    primitive: u32,
    /// Number of the primitive's first triangle.
    pub first: u32,
    /// True if shadow rays meet the surface.
    pub casts: bool,
    /// True if primary rays pass through the surface's back faces.
    pub single_sided: bool,
    /// True if the transform mirrors, which swaps front and back.
    pub mirrored: bool,
    /// Index into [`Triangles::alpha_tests`].
    pub alpha: Option<u32>,
}

/// A triangle in the world, relative to [`Triangles::origin`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// Corners in the primitive's order, in metres.
    pub corners: [DVec3; 3],
    /// Number of the triangle, counted through all surfaces.
    pub number: u32,
    /// Index into [`Triangles::surfaces`].
    pub surface: u32,
}

/// All triangles that a ray can meet. Translucent primitives are left out: they are neither hit nor
/// do they occlude.
#[derive(Debug)]
pub(crate) struct Triangles {
    pub origin: DVec3,
    pub surfaces: Vec<Surface>,
    pub alpha_tests: Vec<AlphaTest>,
    pub pictures: Vec<AlphaPicture>,
    pub count: u32,
}

impl Triangles {
    /// Lists the surfaces and checks every index and number that rays rely on.
    pub(crate) fn gather(scene: &Scene, pose: &Pose, origin: DVec3) -> Result<Self> {
        let mut all = Self { origin, surfaces: Vec::new(), alpha_tests: Vec::new(), pictures: Vec::new(), count: 0 };
        let mut count = 0_u64;
        let mut test_of_primitive = HashMap::new();
        let mut picture_of_texture = HashMap::new();
        for (index, object) in pose.objects.iter().enumerate() {
            let bad = |primitive: usize, reason: String| invalid(scene, pose, index, primitive, reason);
            let mesh = scene
                .meshes
                .get(object.mesh)
                .ok_or_else(|| bad(0, format!("it shows mesh {}, which the scene has not", object.mesh)))?;
            for (k, primitive) in mesh.primitives.iter().enumerate() {
                let material = scene
                    .materials
                    .get(primitive.material)
                    .ok_or_else(|| bad(k, format!("material {} is not in the scene", primitive.material)))?;
                if material.alpha == AlphaMode::Blend || primitive.indices.is_empty() {
                    continue;
                }
                check_primitive(scene, pose, index, k, primitive).map_err(|reason| bad(k, reason))?;
                let alpha = if matches!(material.alpha, AlphaMode::Mask { .. }) {
                    let picture = material.base_color_texture.map(|texture| {
                        *picture_of_texture.entry(texture).or_insert_with(|| {
                            all.pictures.push(AlphaPicture::new(scene, texture));
                            all.pictures.len() - 1
                        })
                    });
                    Some(*test_of_primitive.entry((object.mesh, k)).or_insert_with(|| {
                        all.alpha_tests.extend(AlphaTest::new(primitive, material, picture));
                        all.alpha_tests.len() as u32 - 1
                    }))
                } else {
                    None
                };
                all.surfaces.push(Surface {
                    object: index as u32,
                    mesh: object.mesh as u32,
                    primitive: k as u32,
                    first: count as u32,
                    casts: object.casts,
                    single_sided: !material.double_sided,
                    mirrored: object.world_from_local.matrix3.determinant() < 0.0,
                    alpha,
                });
                count += primitive.indices.len() as u64 / 3;
                if count >= u64::from(u32::MAX) {
                    return Err(Error::TooManyTriangles { triangles: count, most: u64::from(u32::MAX) - 1 });
                }
            }
        }
        all.count = count as u32;
        Ok(all)
    }

    /// Computes boxes around all triangles in number order, rounded outwards.
    pub(crate) fn boxes(&self, scene: &Scene, pose: &Pose) -> Result<Vec<Aabb>> {
        let mut boxes = vec![Aabb::empty(); self.count as usize];
        let mut rest = boxes.as_mut_slice();
        let mut parts = Vec::with_capacity(self.surfaces.len());
        for surface in &self.surfaces {
            let placed = self.placed(scene, pose, surface);
            let (part, tail) = rest.split_at_mut(placed.primitive.indices.len() / 3);
            rest = tail;
            parts.push((surface, placed, part));
        }
        parts.into_par_iter().try_for_each(|(surface, placed, part)| {
            part.par_iter_mut().with_min_len(4096).enumerate().try_for_each(|(triangle, bounds)| {
                let corners = placed.corners(triangle);
                if !corners.iter().all(|corner| corner.abs().max_element() <= FARTHEST) {
                    let reason = format!(
                        "triangle {triangle} has a corner that is not a number or more than {FARTHEST:e} m from the camera; \
                         check its positions and its node's transform"
                    );
                    let (object, primitive) = (surface.object as usize, surface.primitive as usize);
                    return Err(invalid(scene, pose, object, primitive, reason));
                }
                let low = corners[0].min(corners[1]).min(corners[2]);
                let high = corners[0].max(corners[1]).max(corners[2]);
                // Room for rays that pass an edge within its rounding.
                let room = 2.0 * EDGE_ERROR * low.abs().max(high.abs()).max_element();
                *bounds = Aabb::new(rounded(low - room, round_down), rounded(high + room, round_up));
                Ok(())
            })
        })?;
        Ok(boxes)
    }

    /// Returns the triangles with the numbers in `order`, in that order.
    pub(crate) fn in_order(&self, scene: &Scene, pose: &Pose, order: &[u32]) -> Vec<Triangle> {
        let placed: Vec<Placed> = self.surfaces.iter().map(|surface| self.placed(scene, pose, surface)).collect();
        order
            .par_iter()
            .with_min_len(4096)
            .map(|&number| {
                let surface = self.surface_of(number);
                let corners = placed[surface].corners((number - self.surfaces[surface].first) as usize);
                Triangle { corners, number, surface: surface as u32 }
            })
            .collect()
    }

    /// Returns the index of the surface that a triangle number belongs to.
    pub(crate) fn surface_of(&self, number: u32) -> usize {
        self.surfaces.partition_point(|surface| surface.first <= number) - 1
    }

    fn placed<'a>(&self, scene: &'a Scene, pose: &'a Pose, surface: &Surface) -> Placed<'a> {
        let object = &pose.objects[surface.object as usize];
        let primitive = &scene.meshes[surface.mesh as usize].primitives[surface.primitive as usize];
        let positions = match object.skinned {
            Some(skinned) => &pose.skinned[skinned].positions[surface.primitive as usize],
            None => &primitive.positions,
        };
        // Subtracting here and not from the finished points keeps the digits that a far origin
        // would cost.
        let relative_from_local = DAffine3 {
            matrix3: object.world_from_local.matrix3,
            translation: object.world_from_local.translation - self.origin,
        };
        Placed { primitive, positions, relative_from_local }
    }
}

/// A primitive with its transform into the world. Equal positions become equal corners, bit for
/// bit.
struct Placed<'a> {
    primitive: &'a Primitive,
    positions: &'a [[f32; 3]],
    relative_from_local: DAffine3,
}

impl Placed<'_> {
    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        std::array::from_fn(|i| {
            let [x, y, z] = self.positions[self.primitive.indices[3 * triangle + i] as usize].map(f64::from);
            self.relative_from_local.transform_point3(DVec3::new(x, y, z))
        })
    }
}

/// Makes the error about a primitive of an object, with the node that shows it.
fn invalid(scene: &Scene, pose: &Pose, object: usize, primitive: usize, reason: String) -> Error {
    let node = pose.objects.get(object).map(|object| object.node);
    let named = |index: usize| match scene.nodes.get(index) {
        Some(node) if !node.name.is_empty() => format!("nodes[{index}] ({})", node.name),
        _ => format!("nodes[{index}]"),
    };
    let node = node.map_or_else(|| "no node".into(), named);
    Error::InvalidGeometry { scene: scene.name.clone(), node, object, primitive, reason }
}

/// Checks a primitive. The error says what is wrong with it.
fn check_primitive(scene: &Scene, pose: &Pose, object: usize, k: usize, primitive: &Primitive) -> Result<(), String> {
    let vertices = primitive.positions.len();
    if !primitive.indices.len().is_multiple_of(3) {
        return Err(format!("{} indices are not whole triangles; give three for each", primitive.indices.len()));
    }
    if let Some(index) = primitive.indices.iter().find(|&&index| index as usize >= vertices) {
        return Err(format!("index {index} points past its {vertices} positions"));
    }
    for (what, length) in [("texture coordinates", primitive.uvs.len()), ("vertex colours", primitive.colors.len())] {
        if length != 0 && length != vertices {
            return Err(format!("{length} {what} for {vertices} positions; give one each, or none"));
        }
    }
    if let Some(skinned) = pose.objects[object].skinned {
        let posed = pose.skinned.get(skinned).and_then(|mesh| mesh.positions.get(k)).map_or(0, Vec::len);
        if posed != vertices {
            return Err(format!(
                "the pose holds {posed} skinned positions for {vertices} vertices; pose the scene again"
            ));
        }
    }
    if let Some(texture) = scene.materials[primitive.material].base_color_texture {
        let complete = scene.textures.get(texture).is_some_and(|t| {
            t.width > 0 && t.height > 0 && t.rgba.len() as u64 == 4 * u64::from(t.width) * u64::from(t.height)
        });
        if !complete {
            return Err(format!("texture {texture} is missing, or its bytes do not match its size"));
        }
    }
    Ok(())
}

fn rounded(point: DVec3, round: impl Fn(f64) -> f32) -> Vec3A {
    Vec3A::new(round(point.x), round(point.y), round(point.z))
}

/// Returns the greatest `f32` that is not above `x`.
pub(crate) fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// Returns the least `f32` that is not below `x`.
pub(crate) fn round_up(x: f64) -> f32 {
    -round_down(-x)
}
