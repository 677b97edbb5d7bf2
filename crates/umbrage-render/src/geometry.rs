//! Vertices and indices on the GPU. Rigid geometry is uploaded once, skinned geometry every frame.
//!
//! Vertices lie in three streams, so that a shadow pass reads positions only: positions, normals,
//! and the *surface* (texture coordinates and colour). Opaque primitives have separate indices for
//! shadow passes where that spares vertices, and a further set where maps name triangles. Indices
//! count from the start of the whole buffer, which spares base vertices.

use std::ops::Range;

use umbrage::config::Edges;
use umbrage_scene::{AlphaMode, Object, Pose, Primitive, Scene, SkinnedMesh};
use umbrage_wgpu::{StoredRun, stored_runs};

use crate::cut;
use crate::named::{Named, NamedRuns};
use crate::shadow_mesh::{Cluster, Merged, clusters};
use crate::{Error, Gpu, Result};

/// Texture coordinates and colour of a vertex.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Surface {
    pub uv: [f32; 2],
    /// Linear RGBA as 16-bit fractions.
    pub color: [u16; 4],
}

/// The part of the index buffer that is one primitive.
#[derive(Clone, Debug)]
pub(crate) struct GpuPrimitive {
    pub indices: Range<u32>,
    pub material: usize,
    /// Indices of the mesh's triangles for passes that read positions alone.
    pub shadow_indices: Range<u32>,
    /// Indices of these triangles for shadow passes. With exact edges the first corner of a
    /// triangle tells its run.
    pub caster_indices: Range<u32>,
    /// Tree of parts of the shadow indices: one node if the triangles are few, empty if their
    /// vertices move.
    pub clusters: Vec<Cluster>,
}

impl GpuPrimitive {
    pub fn triangles(&self) -> u64 {
        u64::from(self.indices.end - self.indices.start) / 3
    }
}

/// Properties of a primitive that matter to shadow passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Matter {
    /// Opaque and rigid: only positions matter.
    Solid,
    /// Not opaque everywhere: the alpha of the surface matters too.
    Textured,
    /// Skinned: its vertices change every frame.
    Moving,
}

/// Vertex streams, indices and, for each mesh, the ranges of its primitives.
pub(crate) struct Geometry {
    pub positions: wgpu::Buffer,
    pub normals: wgpu::Buffer,
    pub surfaces: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub meshes: Vec<Vec<GpuPrimitive>>,
    /// Runs that texels of maps name, with exact edges.
    pub named: Option<NamedRuns>,
    pub bytes: u64,
}

impl Geometry {
    /// Uploads all meshes of a scene.
    pub fn of_scene(gpu: &Gpu, scene: &Scene, edges: Edges) -> Result<Self> {
        for (index, mesh) in scene.meshes.iter().enumerate() {
            for primitive in &mesh.primitives {
                check(primitive, scene.materials.len()).map_err(|reason| Error::Scene {
                    what: "mesh",
                    index,
                    reason,
                })?;
            }
        }
        let cut = cut::meshes(scene);
        let meshes: Vec<&[Primitive]> = cut.iter().map(|primitives| &**primitives).collect();
        Self::of_primitives(gpu, &meshes, edges, |primitive| match scene.materials[primitive.material].alpha {
            AlphaMode::Opaque => Matter::Solid,
            AlphaMode::Mask { .. } | AlphaMode::Blend => Matter::Textured,
        })
    }

    fn of_primitives(
        gpu: &Gpu,
        meshes: &[&[Primitive]],
        edges: Edges,
        matter: impl Fn(&Primitive) -> Matter,
    ) -> Result<Self> {
        let all = || meshes.iter().copied().flatten();
        let vertices: u64 = all().map(|primitive| primitive.positions.len() as u64).sum();
        let index_count: u64 = all().map(|primitive| primitive.indices.len() as u64).sum();
        gpu.check_buffer("the vertices", vertices * size_of::<Surface>() as u64)?;
        gpu.check_buffer("the indices", index_count * size_of::<u32>() as u64)?;
        // Indices and draws count in u32, and shadow passes may have as many again: a device with
        // enormous buffers is still bound by that.
        let most = u64::from(u32::MAX) / 2;
        if vertices.max(index_count) > most {
            let [needed, limit] = [vertices.max(index_count), most].map(|count| count * size_of::<u32>() as u64);
            return Err(Error::BufferSize { what: "the indices", needed, limit });
        }

        let mut positions: Vec<[f32; 3]> = Vec::with_capacity(vertices as usize);
        let mut normals: Vec<[f32; 3]> = Vec::with_capacity(vertices as usize);
        let mut surfaces: Vec<Surface> = Vec::with_capacity(vertices as usize);
        let mut indices: Vec<u32> = Vec::with_capacity(index_count as usize);
        let mut ranges = Vec::with_capacity(meshes.len());
        for mesh in meshes {
            let mut primitives = Vec::with_capacity(mesh.len());
            for primitive in *mesh {
                let (first_vertex, first_index) = (positions.len() as u32, indices.len() as u32);
                positions.extend(&primitive.positions);
                normals.extend(&primitive.normals);
                surfaces.extend((0..primitive.positions.len()).map(|vertex| surface(primitive, vertex)));
                indices.extend(primitive.indices.iter().map(|index| first_vertex + index));
                let own = first_index..indices.len() as u32;
                let material = primitive.material;
                primitives.push(GpuPrimitive {
                    shadow_indices: own.clone(),
                    caster_indices: own.clone(),
                    indices: own,
                    material,
                    clusters: Vec::new(),
                });
            }
            ranges.push(primitives);
        }
        // Positions that only shadow passes read follow those that have normals and surfaces.
        let still = ranges.iter_mut().flatten().zip(all()).filter(|(_, primitive)| matter(primitive) != Matter::Moving);
        for (uploaded, primitive) in still {
            if matter(primitive) == Matter::Solid
                && let Some(merged) = Merged::of(&primitive.positions, &primitive.indices)
            {
                let (first_vertex, first_index) = (positions.len() as u32, indices.len() as u32);
                positions.extend(&merged.positions);
                indices.extend(merged.indices.iter().map(|index| first_vertex + index));
                uploaded.shadow_indices = first_index..indices.len() as u32;
                uploaded.caster_indices = uploaded.shadow_indices.clone();
            }
            uploaded.clusters = clusters(&primitive.positions, &primitive.indices, uploaded.shadow_indices.start);
        }
        let named = match edges.is_exact() {
            false => None,
            true => {
                let mut runs = vec![0; positions.len()];
                let named = |primitive: &Primitive| matter(primitive) == Matter::Solid;
                let of_meshes = name(meshes, &mut ranges, (&mut positions, &mut runs, &mut indices), named);
                gpu.check_storage("the vertices", size_of_val(positions.as_slice()) as u64)?;
                gpu.check_storage("the indices", size_of_val(indices.as_slice()) as u64)?;
                Some(NamedRuns::new(gpu, &runs, &of_meshes)?)
            }
        };
        gpu.check_buffer("the vertices", size_of_val(positions.as_slice()) as u64)?;
        gpu.check_buffer("the indices", size_of_val(indices.as_slice()) as u64)?;
        let read = if named.is_some() { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        let buffer = |label, bytes: &[u8], usage| gpu.filled_buffer(label, bytes, usage);
        let vertex = wgpu::BufferUsages::VERTEX;
        let positions = buffer("Geometry::positions", bytemuck::cast_slice(&positions), vertex | read);
        let normals = buffer("Geometry::normals", bytemuck::cast_slice(&normals), vertex);
        let surfaces = buffer("Geometry::surfaces", bytemuck::cast_slice(&surfaces), vertex);
        let indices = buffer("Geometry::indices", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX | read);
        let bytes: u64 = [&positions, &normals, &surfaces, &indices].map(wgpu::Buffer::size).iter().sum();
        let bytes = bytes + named.as_ref().map_or(0, NamedRuns::bytes);
        Ok(Self { positions, normals, surfaces, indices, meshes: ranges, named, bytes })
    }
}

/// Appends positions and indices of the primitives for which `is_named` is true, with the runs that
/// first corners belong to. Returns each mesh's runs; runs are numbered through all primitives of a
/// mesh.
fn name(
    meshes: &[&[Primitive]],
    uploaded: &mut [Vec<GpuPrimitive>],
    (positions, runs, indices): (&mut Vec<[f32; 3]>, &mut Vec<u32>, &mut Vec<u32>),
    is_named: impl Fn(&Primitive) -> bool,
) -> Vec<Vec<StoredRun>> {
    let mut of_meshes = Vec::with_capacity(meshes.len());
    for (mesh, uploaded) in meshes.iter().zip(uploaded) {
        let mut of_mesh: Vec<StoredRun> = Vec::new();
        for (primitive, uploaded) in mesh.iter().zip(uploaded).filter(|(primitive, _)| is_named(primitive)) {
            let named = Named::of(&primitive.positions, &primitive.indices, of_mesh.len() as u32);
            let (first_vertex, first_index) = (positions.len() as u32, indices.len() as u32);
            of_mesh.extend(stored_runs(&named.positions, &named.indices, first_index));
            positions.extend(&named.positions);
            runs.extend(&named.runs);
            indices.extend(named.indices.iter().map(|index| first_vertex + index));
            uploaded.caster_indices = first_index..indices.len() as u32;
        }
        of_meshes.push(of_mesh);
    }
    of_meshes
}

/// Geometry that changes every frame: one "mesh" per entry of [`Pose::skinned`].
pub(crate) struct SkinnedGeometry {
    pub geometry: Geometry,
    /// Mesh of each entry of [`Pose::skinned`]; rebuilt when it changes.
    posed_meshes: Vec<usize>,
    edges: Edges,
}

impl SkinnedGeometry {
    /// Makes empty skinned geometry. With exact edges it has no ids, because its vertices move.
    pub fn of(gpu: &Gpu, edges: Edges) -> Result<Self> {
        let geometry = Geometry::of_primitives(gpu, &[], edges, |_| Matter::Moving)?;
        Ok(Self { geometry, posed_meshes: Vec::new(), edges })
    }

    /// Uploads the vertices of this pose.
    pub fn update(&mut self, gpu: &Gpu, scene: &SceneMeshes, pose: &Pose) -> Result<()> {
        let posed_meshes = posed_meshes(scene, pose)?;
        if posed_meshes != self.posed_meshes {
            let meshes: Vec<&[Primitive]> = posed_meshes.iter().map(|&mesh| scene.0[mesh].as_slice()).collect();
            self.geometry = Geometry::of_primitives(gpu, &meshes, self.edges, |_| Matter::Moving)?;
            self.posed_meshes = posed_meshes;
        }
        let mut offset = 0;
        for skinned in &pose.skinned {
            for (positions, normals) in skinned.positions.iter().zip(&skinned.normals) {
                gpu.queue.write_buffer(&self.geometry.positions, offset, bytemuck::cast_slice(positions));
                gpu.queue.write_buffer(&self.geometry.normals, offset, bytemuck::cast_slice(normals));
                offset += size_of_val(positions.as_slice()) as u64;
            }
        }
        Ok(())
    }
}

/// Primitives of the meshes whose vertices a pose moves, kept to lay out their vertices. Other
/// meshes are empty.
pub(crate) struct SceneMeshes(Vec<Vec<Primitive>>);

impl SceneMeshes {
    /// Keeps the primitives that [`SkinnedGeometry::update`] needs.
    pub fn of_scene(scene: &Scene) -> Self {
        let mut kept = vec![Vec::new(); scene.meshes.len()];
        for node in &scene.nodes {
            if let Some(mesh) = node.mesh
                && let Some(source) = scene.meshes.get(mesh)
                && (node.skin.is_some() || source.is_morphed())
                && kept[mesh].is_empty()
            {
                // Their morph targets have done their part in the pose.
                let laid_out = |primitive: &Primitive| Primitive { targets: Vec::new(), ..primitive.clone() };
                kept[mesh] = source.primitives.iter().map(laid_out).collect();
            }
        }
        Self(kept)
    }
}

/// Returns the mesh that each entry of [`Pose::skinned`] poses, after checking that their vertices
/// fit.
fn posed_meshes(scene: &SceneMeshes, pose: &Pose) -> Result<Vec<usize>> {
    let mut meshes = vec![None; pose.skinned.len()];
    for (index, object) in pose.objects.iter().enumerate() {
        let Some(slot) = object.skinned else { continue };
        let wrong = |reason: &str| Error::Scene { what: "pose object", index, reason: reason.to_owned() };
        let entry = meshes.get_mut(slot).ok_or_else(|| wrong("its skinned vertices are missing from the pose"))?;
        let primitives = scene.0.get(object.mesh).ok_or_else(|| wrong("there is no such mesh"))?;
        if !fits(primitives, &pose.skinned[slot]) {
            return Err(wrong("its skinned vertices are not those of its mesh; pose the scene that was uploaded"));
        }
        *entry = Some(object.mesh);
    }
    meshes
        .into_iter()
        .enumerate()
        .map(|(index, mesh)| {
            mesh.ok_or_else(|| Error::Scene {
                what: "skinned mesh",
                index,
                reason: "no object of the pose shows it".to_owned(),
            })
        })
        .collect()
}

fn fits(primitives: &[Primitive], skinned: &SkinnedMesh) -> bool {
    let lengths = |list: &[Vec<[f32; 3]>]| list.iter().map(Vec::len).collect::<Vec<_>>();
    let expected: Vec<usize> = primitives.iter().map(|primitive| primitive.positions.len()).collect();
    lengths(&skinned.positions) == expected && lengths(&skinned.normals) == expected
}

fn check(primitive: &Primitive, materials: usize) -> Result<(), String> {
    let vertices = primitive.positions.len();
    let wrong = |what: &str, count: usize| Err(format!("{count} {what} for {vertices} positions"));
    if primitive.normals.len() != vertices {
        return wrong("normals", primitive.normals.len());
    }
    if !primitive.uvs.is_empty() && primitive.uvs.len() != vertices {
        return wrong("texture coordinates", primitive.uvs.len());
    }
    if !primitive.colors.is_empty() && primitive.colors.len() != vertices {
        return wrong("colours", primitive.colors.len());
    }
    if !primitive.indices.len().is_multiple_of(3) {
        return Err(format!("{} indices are no whole number of triangles", primitive.indices.len()));
    }
    if let Some(index) = primitive.indices.iter().find(|&&index| index as usize >= vertices) {
        return Err(format!("index {index} points beyond its {vertices} vertices"));
    }
    if primitive.material >= materials {
        return Err(format!("there is no material {}, only {materials}", primitive.material));
    }
    Ok(())
}

fn surface(primitive: &Primitive, vertex: usize) -> Surface {
    let uv = primitive.uvs.get(vertex).copied().unwrap_or_default();
    let color = primitive.colors.get(vertex).copied().unwrap_or([1.0; 4]);
    Surface { uv, color: color.map(|channel| (channel.clamp(0.0, 1.0) * 65535.0).round() as u16) }
}

/// Checks that an object of a pose belongs to the uploaded scene.
pub(crate) fn check_object(index: usize, object: &Object, meshes: usize) -> Result<()> {
    if object.mesh < meshes && object.world_from_local.is_finite() {
        return Ok(());
    }
    Err(Error::Scene {
        what: "pose object",
        index,
        reason: "its mesh is missing or its transform is not finite; pose the scene that was uploaded".to_owned(),
    })
}
