//! Posing a scene at one moment: animation, hierarchy, morph targets, skinning, bounds.

use glam::{DAffine3, DMat3, DMat4, DVec3};
use umbrage::Aabb;

use crate::morph::morphed;
use crate::outline::Outline;
use crate::{AlphaMode, Error, Mesh, Object, Pose, Result, Scene, SkinnedMesh, Trs};

/// Poses one scene many times. Values that never change are computed once.
#[derive(Debug)]
pub struct Poser<'s> {
    scene: &'s Scene,
    /// Bounding box of each mesh in its own space; empty for meshes without triangles.
    local_bounds: Vec<Aabb>,
    /// True for each mesh of which some primitive casts shadows.
    mesh_casts: Vec<bool>,
    /// True for each mesh with morph targets.
    mesh_morphs: Vec<bool>,
    /// True for each clip that plays: no earlier one that plays moves a node of the clip.
    plays: Vec<bool>,
    /// Transform and bounds in the last pose of each object that has the mesh's own vertices and is
    /// no instance, in the order of objects.
    known_bounds: Vec<(DAffine3, Aabb)>,
    /// Outlines of the meshes that instances show.
    outlines: Vec<Option<Outline>>,
    detail: Option<Detail>,
}

/// Eyes and resolution of the views of a scene. Instances that are far away show coarser levels of
/// detail ([`Scene::levels`]), in the picture and to rays alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Detail {
    /// World positions of the eyes. The nearest one counts.
    pub eyes: Vec<DVec3>,
    /// Angle in radians of the smallest visible detail, such as that of a pixel.
    pub angle: f64,
}

impl Detail {
    /// Returns the size in metres of the smallest visible detail at a point.
    fn at(&self, point: DVec3) -> f64 {
        let away = self.eyes.iter().map(|eye| eye.distance(point)).fold(f64::INFINITY, f64::min);
        self.angle * away
    }
}

impl Scene {
    /// Poses the scene `time_s` seconds after its clips began. To pose a scene many times use a
    /// [`Poser`].
    ///
    /// # Errors
    /// [`Error::InvalidScene`] as [`Scene::validate`], [`Error::Pose`] as [`Poser::pose`].
    pub fn pose(&self, time_s: f64) -> Result<Pose> {
        Poser::new(self)?.pose(time_s)
    }

    /// Poses the scene as [`Scene::pose`] does, with the coarsest levels of detail that look like
    /// the finest at the resolution of `detail`.
    ///
    /// # Errors
    /// As [`Scene::pose`].
    pub fn pose_for(&self, time_s: f64, detail: Detail) -> Result<Pose> {
        Poser { detail: Some(detail), ..Poser::new(self)? }.pose(time_s)
    }

    /// Returns the number of triangles that are stored.
    #[must_use]
    pub fn stored_triangles(&self) -> usize {
        self.meshes.iter().map(Mesh::triangles).sum()
    }

    /// Returns the number of triangles that are drawn: each placed mesh counts.
    #[must_use]
    pub fn placed_triangles(&self) -> usize {
        let placed = |node: &crate::Node| {
            let copies = if node.skin.is_some() { 1 } else { node.instances.len().max(1) };
            node.mesh.and_then(|mesh| self.meshes.get(mesh)).map_or(0, |mesh| mesh.triangles() * copies)
        };
        self.nodes.iter().map(placed).sum()
    }
}

impl Pose {
    /// Returns this pose without any object.
    #[must_use]
    pub fn clone_without_objects(&self) -> Self {
        let (world_from_node, skinned) = (self.world_from_node.clone(), self.skinned.clone());
        Self { objects: Vec::new(), world_from_node, skinned, bounds: self.bounds }
    }
}

impl Mesh {
    /// Returns the number of triangles of all primitives.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.primitives.iter().map(|primitive| primitive.indices.len() / 3).sum()
    }
}

impl<'s> Poser<'s> {
    /// Checks the scene and prepares for posing it.
    ///
    /// # Errors
    /// [`Error::InvalidScene`] as [`Scene::validate`].
    pub fn new(scene: &'s Scene) -> Result<Self> {
        scene.validate()?;
        let local_bounds = scene.meshes.iter().map(|mesh| vertex_bounds(mesh, &DAffine3::IDENTITY)).collect();
        let casts = |mesh: &Mesh| {
            mesh.primitives
                .iter()
                .any(|p| scene.materials[p.material].alpha != AlphaMode::Blend && !p.indices.is_empty())
        };
        let mesh_casts = scene.meshes.iter().map(casts).collect();
        let mesh_morphs = scene.meshes.iter().map(Mesh::is_morphed).collect();
        let mut is_moved = vec![false; scene.nodes.len()];
        let mut plays = Vec::with_capacity(scene.animations.len());
        for clip in &scene.animations {
            let is_free = clip.channels.iter().all(|channel| !is_moved[channel.node]);
            if is_free {
                clip.channels.iter().for_each(|channel| is_moved[channel.node] = true);
            }
            plays.push(is_free);
        }
        let outlines = outlines(scene);
        let (known_bounds, detail) = (Vec::new(), None);
        Ok(Self { scene, local_bounds, mesh_casts, mesh_morphs, plays, known_bounds, outlines, detail })
    }

    /// Poses the scene `time_s` seconds after its clips began. Each clip that plays is looped on
    /// its own.
    ///
    /// # Errors
    /// [`Error::Pose`] if the time is not finite, or with the node whose transform or mesh is not.
    pub fn pose(&mut self, time_s: f64) -> Result<Pose> {
        if !time_s.is_finite() {
            return Err(self.error("time", format!("{time_s} s is not a finite number of seconds")));
        }
        let (world_from_node, weights) = self.nodes_at(time_s)?;
        let scene = self.scene;
        let mut pose = Pose { world_from_node, ..Pose::default() };
        let mut known = std::mem::take(&mut self.known_bounds).into_iter();
        for (index, node) in scene.nodes.iter().enumerate() {
            let Some(mesh) = node.mesh.filter(|&mesh| !self.local_bounds[mesh].is_empty()) else { continue };
            let casts = node.cast_shadow && self.mesh_casts[mesh];
            let shape = self.mesh_morphs[mesh].then(|| morphed(&scene.meshes[mesh], &weights[index]));
            if let Some(skin) = node.skin {
                let (skinned, bounds) = self.skin(&pose, shape.as_ref(), mesh, skin, index)?;
                pose.objects.push(Object {
                    node: index,
                    instance: None,
                    mesh,
                    world_from_local: DAffine3::from_translation(skinned.origin),
                    skinned: Some(pose.skinned.len()),
                    bounds,
                    casts,
                });
                pose.skinned.push(skinned);
                continue;
            }
            let world_from_node = pose.world_from_node[index];
            let single = [Trs::IDENTITY];
            let copies: &[Trs] = if node.instances.is_empty() { &single } else { &node.instances };
            pose.objects.reserve(copies.len());
            for (copy, node_from_local) in copies.iter().enumerate() {
                let instance = (!node.instances.is_empty()).then_some(copy as u32);
                let world_from_local = match instance {
                    Some(_) => world_from_node * node_from_local.to_affine(),
                    None => world_from_node,
                };
                let shown = match (&shape, instance) {
                    (None, Some(_)) => self.shown(mesh, &world_from_local),
                    _ => mesh,
                };
                let bounds = match &shape {
                    Some(shape) => shape_bounds(&scene.meshes[mesh], shape, &world_from_local),
                    None if instance.is_some() => self.instance_bounds(shown, &world_from_local),
                    None => match known.next() {
                        Some((transform, bounds)) if transform == world_from_local => bounds,
                        _ => world_bounds(&scene.meshes[mesh], self.local_bounds[mesh], &world_from_local),
                    },
                };
                if !bounds.is_valid() {
                    let reason = format!("its mesh has no finite bounds in the world (instance {instance:?})");
                    return Err(self.error(scene.node_element(index), reason));
                }
                if shape.is_none() && instance.is_none() {
                    self.known_bounds.push((world_from_local, bounds));
                }
                pose.objects.push(Object {
                    node: index,
                    instance,
                    mesh: shown,
                    world_from_local,
                    skinned: shape.as_ref().map(|_| pose.skinned.len()),
                    bounds,
                    casts,
                });
            }
            pose.skinned.extend(shape);
        }
        pose.bounds = pose.objects.iter().map(|object| object.bounds).reduce(Aabb::union);
        Ok(pose)
    }

    /// Returns the level of detail of a mesh that an instance shows.
    fn shown(&self, mesh: usize, world_from_local: &DAffine3) -> usize {
        let Some(detail) = &self.detail else { return mesh };
        let m = world_from_local.matrix3;
        let scale = m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length()).max(f64::MIN_POSITIVE);
        self.scene.shape_of(mesh, detail.at(world_from_local.translation) / scale)
    }

    fn instance_bounds(&self, mesh: usize, world_from_local: &DAffine3) -> Aabb {
        let upright = self.outlines[mesh].as_ref().and_then(|outline| outline.bounds(world_from_local));
        upright.unwrap_or_else(|| world_bounds(&self.scene.meshes[mesh], self.local_bounds[mesh], world_from_local))
    }

    fn error(&self, element: impl Into<String>, reason: impl Into<String>) -> Error {
        Error::Pose { scene: self.scene.name.clone(), element: element.into(), reason: reason.into() }
    }

    /// Returns the world transform of every node, and the weights of morph targets of the nodes
    /// that have some.
    fn nodes_at(&self, time_s: f64) -> Result<(Vec<DAffine3>, Vec<Vec<f64>>)> {
        let scene = self.scene;
        let mut local: Vec<Trs> = scene.nodes.iter().map(|node| node.local).collect();
        let still = |node: &crate::Node| match node.mesh.filter(|&mesh| self.mesh_morphs[mesh]) {
            Some(mesh) if node.weights.is_empty() => {
                scene.meshes[mesh].weights.iter().copied().map(f64::from).collect()
            }
            Some(_) => node.weights.iter().copied().map(f64::from).collect(),
            None => Vec::new(),
        };
        let mut weights: Vec<Vec<f64>> = scene.nodes.iter().map(still).collect();
        for (clip, _) in scene.animations.iter().zip(&self.plays).filter(|(_, plays)| **plays) {
            let time = if clip.duration > 0.0 { time_s.rem_euclid(clip.duration) } else { 0.0 };
            for channel in &clip.channels {
                channel.apply(time, &mut local[channel.node], &mut weights[channel.node]);
            }
        }
        let mut world_from_node: Vec<DAffine3> = Vec::with_capacity(local.len());
        for (index, (node, local)) in scene.nodes.iter().zip(&local).enumerate() {
            let parent_from_node = local.to_affine();
            let world = match node.parent {
                Some(parent) => world_from_node[parent] * parent_from_node,
                None => parent_from_node,
            };
            if !world.is_finite() {
                let reason = format!("its transform is not finite at {time_s} s: {local:?}");
                return Err(self.error(scene.node_element(index), reason));
            }
            world_from_node.push(world);
        }
        Ok((world_from_node, weights))
    }

    /// Applies linear blend skinning in `f64`. Source: glTF 2.0 specification, section 3.7.3.3: the
    /// node's own transform is ignored; each joint takes the vertex from mesh space through its
    /// bind pose into the world. Morph targets come before: `shape` is the mesh with them, if it
    /// has some.
    fn skin(
        &self,
        pose: &Pose,
        shape: Option<&SkinnedMesh>,
        mesh: usize,
        skin: usize,
        node: usize,
    ) -> Result<(SkinnedMesh, Aabb)> {
        let (mesh, skin) = (&self.scene.meshes[mesh], &self.scene.skins[skin]);
        let world_from_mesh: Vec<DMat4> = skin
            .joints
            .iter()
            .zip(&skin.inverse_bind)
            .map(|(&joint, joint_from_mesh)| DMat4::from(pose.world_from_node[joint]) * joint_from_mesh.as_dmat4())
            .collect();
        let mut bounds = Aabb::EMPTY;
        let mut posed: Vec<Vec<DVec3>> = Vec::with_capacity(mesh.primitives.len());
        let mut normals = Vec::with_capacity(mesh.primitives.len());
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            let (positions, still_normals) = match shape {
                Some(shape) => (&shape.positions[k], &shape.normals[k]),
                None => (&primitive.positions, &primitive.normals),
            };
            let mut posed_here = Vec::with_capacity(positions.len());
            let mut normals_here = Vec::with_capacity(positions.len());
            for (vertex, position) in positions.iter().enumerate() {
                let (joints, weights) = (primitive.joints[vertex], primitive.weights[vertex]);
                let blended = joints
                    .into_iter()
                    .zip(weights)
                    .filter(|(_, weight)| *weight != 0.0)
                    .map(|(joint, weight)| world_from_mesh[usize::from(joint)] * f64::from(weight))
                    .fold(DMat4::ZERO, |sum, matrix| sum + matrix);
                let blended = DAffine3::from_mat4(blended);
                let point = blended.transform_point3(DVec3::from(position.map(f64::from)));
                bounds = bounds.including(point);
                posed_here.push(point);
                normals_here.push(posed_normal(&blended.matrix3, still_normals[vertex]));
            }
            posed.push(posed_here);
            normals.push(normals_here);
        }
        let is_finite = posed.iter().flatten().all(|p| p.is_finite());
        if !(is_finite && bounds.is_valid()) {
            return Err(self.error(self.scene.node_element(node), "its skinned vertices are not finite"));
        }
        let origin = bounds.center();
        let relative = |points: Vec<DVec3>| points.iter().map(|p| (*p - origin).as_vec3().to_array()).collect();
        Ok((SkinnedMesh { origin, positions: posed.into_iter().map(relative).collect(), normals }, bounds))
    }
}

/// Returns the outlines of the meshes that instances may show, at all levels of detail.
fn outlines(scene: &Scene) -> Vec<Option<Outline>> {
    let mut outlines = vec![None; scene.meshes.len()];
    for mesh in scene.nodes.iter().filter(|node| !node.instances.is_empty()).filter_map(|node| node.mesh) {
        let coarser = scene.levels.get(&mesh).into_iter().flatten().map(|level| level.mesh);
        for shape in std::iter::once(mesh).chain(coarser) {
            if outlines[shape].is_none() {
                outlines[shape] = Outline::of(&scene.meshes[shape]);
            }
        }
    }
    outlines
}

/// Transforms a normal by a linear map's cofactor matrix, which is the inverse transpose up to
/// scale and exists for flat maps too. If the result has no length, the normal stays as it was.
fn posed_normal(linear: &DMat3, normal: [f32; 3]) -> [f32; 3] {
    let m = linear;
    let cofactor = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let outside = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    let turned = cofactor * (outside * DVec3::from(normal.map(f64::from)));
    turned.try_normalize().map_or(normal, |n| n.as_vec3().to_array())
}

/// Returns the exact box of all vertices under a transform.
fn vertex_bounds(mesh: &Mesh, world_from_local: &DAffine3) -> Aabb {
    let drawn = mesh.primitives.iter().filter(|primitive| !primitive.indices.is_empty());
    let positions = drawn.flat_map(|primitive| &primitive.positions);
    Aabb::from_points(positions.map(|p| world_from_local.transform_point3(DVec3::from(p.map(f64::from)))))
}

/// Returns the box of all vertices of a morphed mesh under a transform; invalid if one is not
/// finite.
fn shape_bounds(mesh: &Mesh, shape: &SkinnedMesh, world_from_local: &DAffine3) -> Aabb {
    let drawn = mesh.primitives.iter().zip(&shape.positions).filter(|(primitive, _)| !primitive.indices.is_empty());
    let points = || drawn.clone().flat_map(|(_, positions)| positions).map(|p| DVec3::from(p.map(f64::from)));
    if !points().all(|point| point.is_finite()) {
        return Aabb::EMPTY;
    }
    Aabb::from_points(points().map(|point| world_from_local.transform_point3(point)))
}

/// Returns the world bounds of a mesh. The mesh's local box is used if it gives the exact answer,
/// which it does when no axis turns into another.
fn world_bounds(mesh: &Mesh, local: Aabb, world_from_local: &DAffine3) -> Aabb {
    let m = world_from_local.matrix3;
    if DMat3::from_diagonal(DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z)) == m {
        return local.transformed(world_from_local);
    }
    vertex_bounds(mesh, world_from_local)
}
