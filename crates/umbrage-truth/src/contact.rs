//! Contact of surfaces: whether two surfaces lie on each other, within the rounding of the scene's
//! numbers.
//!
//! Vertices are stored in `f32`, relative to their object. Two surfaces that were meant to
//! coincide, the faces of a leaf or a decal on a wall, therefore lie apart by the rounding of their
//! local coordinates and of the rotations and scales between them. That distance belongs to the
//! data: it grows with the scene and moves with it. It is neither a length nor a share of how far
//! the scene is from the world's origin, for nodes place objects in `f64`.

use glam::{DAffine3, DMat3, DVec3};
use umbrage_scene::{Pose, Scene};

use crate::triangles::Surface;

/// Relative error of a coordinate in `f32`: four roundings, one of the file and three of the tools
/// before it.
const F32_ERROR: f64 = 4.0 / (1_u64 << 24) as f64;

/// Relative error of a coordinate in `f64` after all the arithmetic here.
pub(crate) const F64_ERROR: f64 = 8.0 / (1_u64 << 53) as f64;

/// Largest part of the tolerance that the rounding of two objects' translations may make, as a
/// share of the smaller object's radius. A translation may be exact however large it is, because a
/// scene moved in `f64` moves by an exact one. Its rounding is therefore counted only while it is
/// too small to take a shadow away from an object.
const MOST_TRANSLATION_ERROR: f64 = 1.0 / 4096.0;

/// Entries of a matrix below this share of their row count as 0 that was rounded.
const NO_ENTRY: f64 = 1e-12;

/// Precision of a scene's objects.
#[derive(Debug)]
pub(crate) struct Contact {
    /// Precision of each object.
    placed: Vec<Placed>,
    /// Parent of each node, which has a lower index.
    parents: Vec<Option<usize>>,
    world_from_node: Vec<DAffine3>,
}

#[derive(Debug)]
struct Placed {
    node: usize,
    /// True if the vertices are blended from several joints.
    is_skinned: bool,
    world_from_local: DMat3,
    local_from_world: Option<DMat3>,
    /// World position of the local origin.
    pivot: DVec3,
    /// Largest distance of a vertex from the pivot, in metres.
    radius: f64,
}

impl Contact {
    pub(crate) fn new(scene: &Scene, pose: &Pose) -> Self {
        let placed = |object: &umbrage_scene::Object| {
            let pivot = object.world_from_local.translation;
            let world_from_local = object.world_from_local.matrix3;
            Placed {
                node: object.node,
                is_skinned: object.skinned.is_some(),
                world_from_local,
                local_from_world: inverse(world_from_local),
                pivot,
                radius: (object.bounds.min - pivot).abs().max((object.bounds.max - pivot).abs()).length(),
            }
        };
        Self {
            placed: pose.objects.iter().map(placed).collect(),
            parents: scene.nodes.iter().map(|node| node.parent).collect(),
            world_from_node: pose.world_from_node.clone(),
        }
    }

    /// Returns, cheaply, an upper bound in metres on what a surface adds to [`Contact::tolerance`].
    pub(crate) fn most(&self, surface: &Surface) -> f64 {
        let placed = &self.placed[surface.object as usize];
        // Vertices, at most √3 times a corner's distance, and transforms, at most √3 times it
        // again.
        (4.0 * F32_ERROR + MOST_TRANSLATION_ERROR) * placed.radius + F64_ERROR * (placed.radius + placed.pivot.length())
    }

    /// Returns the largest distance in metres, due to rounding, of a point of one surface from the
    /// plane of another's triangle where both were meant to coincide. `there` is the triangle's
    /// surface with its corners, `here` the point's surface, if known, and the point. Both are
    /// relative to the world point `origin`; `normal` is the triangle's unit normal.
    pub(crate) fn tolerance(
        &self,
        there: (&Surface, &[DVec3; 3]),
        here: (Option<&Surface>, DVec3),
        normal: DVec3,
        origin: DVec3,
    ) -> f64 {
        let theirs = &self.placed[there.0.object as usize];
        let ours = here.0.map(|surface| &self.placed[surface.object as usize]);
        let others = ours.filter(|&ours| !std::ptr::eq(ours, theirs));
        let common = others.and_then(|ours| self.common_node(theirs, ours));
        let world_from_common = common.map_or(DAffine3::IDENTITY, |node| self.world_from_node[node]);
        let off = |of: &Placed, point: DVec3| {
            let from_pivot = point - (of.pivot - origin);
            let mut error = F32_ERROR * vertex_error(of, from_pivot, normal) + F64_ERROR * from_pivot.length();
            if others.is_some() {
                error += F64_ERROR * of.pivot.length();
                error += F32_ERROR * transform_error(of, world_from_common.matrix3, from_pivot, normal);
            }
            error
        };
        let translations = others.map_or(0.0, |ours| {
            let far = [theirs, ours].map(|of| of.pivot.distance(world_from_common.translation));
            (F32_ERROR * (far[0] + far[1])).min(MOST_TRANSLATION_ERROR * theirs.radius.min(ours.radius))
        });
        let theirs_off = there.1.iter().map(|&corner| off(theirs, corner)).fold(0.0, f64::max);
        // Of a point whose surface is not known as much is taken as of the triangle.
        translations + theirs_off + ours.map_or(theirs_off, |ours| off(ours, here.1))
    }

    /// Returns the lowest node above both objects. The transforms above it are the same for both.
    fn common_node(&self, a: &Placed, b: &Placed) -> Option<usize> {
        let own = |of: &Placed| if of.is_skinned { None } else { Some(of.node) };
        let (mut a, mut b) = (own(a)?, own(b)?);
        while a != b {
            let higher = a.max(b);
            let parent = self.parents.get(higher).copied().flatten()?;
            *(if a > b { &mut a } else { &mut b }) = parent;
        }
        Some(a).filter(|&node| node < self.world_from_node.len())
    }
}

/// Returns a bound on the error of a point along `normal` that comes from rounding its coordinates,
/// relative to that rounding.
fn vertex_error(of: &Placed, from_pivot: DVec3, normal: DVec3) -> f64 {
    let longest = 3_f64.sqrt() * from_pivot.length();
    match of.local_from_world {
        // Blending rounds matrices along all axes.
        Some(local_from_world) if !of.is_skinned => {
            let local = (local_from_world * from_pivot).abs();
            (of.world_from_local.transpose() * normal).abs().dot(local).min(longest)
        }
        _ => longest,
    }
}

/// Returns a bound in metres on the error of a point that comes from rounding the rotation and the
/// scale between the object and the node with the linear part `common`.
fn transform_error(of: &Placed, common: DMat3, from_pivot: DVec3, normal: DVec3) -> f64 {
    let longest = 3_f64.sqrt() * from_pivot.length();
    let Some(common_from_world) = inverse(common) else { return longest };
    let placed = common_from_world * from_pivot;
    let rows = (common_from_world * of.world_from_local).transpose();
    let is_turned = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| {
        // One entry is a scale, which moves a point along that axis. Several are a rotation: it
        // moves a point by its distance.
        let size = row.abs();
        size.element_sum() - size.max_element() > NO_ENTRY * size.max_element()
    });
    let off = DVec3::from_array(std::array::from_fn(|i| if is_turned[i] { placed.length() } else { placed[i].abs() }));
    (common.transpose() * normal).abs().dot(off).min(longest)
}

/// Returns the inverse of an invertible matrix.
fn inverse(matrix: DMat3) -> Option<DMat3> {
    let inverse = matrix.inverse();
    (matrix.determinant() != 0.0 && inverse.is_finite()).then_some(inverse)
}
