//! Lists of the objects that a pass draws, their transforms relative to the origin, and the draw
//! calls.

use std::ops::Range;

use glam::{DAffine3, DVec3};
use umbrage_scene::{Object, Pose};

use crate::geometry::{Geometry, GpuPrimitive};
use crate::materials::{GpuMaterial, Materials};
use crate::{Gpu, Result};

/// Rows of the transform from a mesh to the frame's origin, `Instance` in `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Instance {
    rows: [[f32; 4]; 3],
    /// Code of the copy of a caster, for passes that draw several splits.
    code: u32,
    /// First id of a caster whose triangles the maps name; 0 for other casters.
    first_id: u32,
}

/// An object and the range of codes of its copies, one instance each.
pub(crate) type Copies = (usize, Range<u32>);

/// Returns the copies of an object that is drawn once, for passes without copies.
pub(crate) fn once(object: usize) -> Copies {
    (object, 0..1)
}

impl Instance {
    /// Makes the instance of a transform. The origin is subtracted in `f64`; the difference is
    /// small near the eye and fits `f32`.
    fn new(world_from_local: &DAffine3, origin: DVec3, code: u32, first_id: u32) -> Self {
        let m = world_from_local.matrix3;
        let t = world_from_local.translation - origin;
        let row = |i: usize| [m.x_axis[i] as f32, m.y_axis[i] as f32, m.z_axis[i] as f32, t[i] as f32];
        Self { rows: [row(0), row(1), row(2)], code, first_id }
    }
}

/// Source of a run's vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Source {
    /// A mesh of the scene.
    Mesh(usize),
    /// An entry of [`Pose::skinned`].
    Skinned(usize),
}

/// Ranges of shadow indices that are drawn, for each primitive of a mesh.
pub(crate) type Parts = Vec<Vec<Range<u32>>>;

/// Choice of the indices of a primitive that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Show {
    /// Indices of the surface, in order.
    Surfaces,
    /// Indices of the surface in a pass after a depth pass: the last primitive of a run first, so
    /// that the first one stays.
    Visible,
    /// Shadow indices, or the ranges of them in [`Run::parts`].
    Shadows,
}

/// Objects that share a source and an orientation, and are drawn together, once per primitive.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub source: Source,
    /// True if the transform mirrors: front faces are then clockwise.
    pub mirrored: bool,
    pub instances: Range<u32>,
    /// Ranges of shadow indices of the object that are drawn; `None` draws all of it.
    pub parts: Option<Parts>,
}

/// A part of a run that is drawn by itself: one range of shadow indices of one primitive.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub source: Source,
    pub mirrored: bool,
    pub instances: Range<u32>,
    pub primitive: usize,
    pub indices: Range<u32>,
}

/// Instances of all passes of a frame, and the buffer that they are uploaded to.
pub(crate) struct Instances {
    data: Vec<Instance>,
    /// Object of each instance.
    objects: Vec<usize>,
    /// First id of each object, with exact edges.
    first_ids: Vec<u32>,
    buffer: wgpu::Buffer,
}

impl Instances {
    pub const STRIDE: u64 = size_of::<Instance>() as u64;

    pub fn new(gpu: &Gpu) -> Self {
        Self { data: Vec::new(), objects: Vec::new(), first_ids: Vec::new(), buffer: instance_buffer(gpu, 64) }
    }

    /// Clears the lists of the last frame. `first_ids` are the first ids of this frame's objects;
    /// empty without exact edges.
    pub fn clear(&mut self, first_ids: Vec<u32>) {
        self.data.clear();
        self.objects.clear();
        self.first_ids = first_ids;
    }

    /// Returns the object of an instance.
    pub fn object(&self, instance: u32) -> usize {
        self.objects[instance as usize]
    }

    /// Lists objects that share a source as one run, the objects given first as early as that
    /// allows. Where every draw has to begin with an instance that draws nothing, each object's
    /// codes begin with one; `leads` keeps the first of a run and drops the others.
    pub fn grouped(
        &mut self,
        pose: &Pose,
        origin: DVec3,
        leads: bool,
        objects: impl Iterator<Item = Copies>,
    ) -> Vec<Run> {
        self.grouped_as(pose, origin, leads, objects, |object| object.mesh)
    }

    /// Lists objects as [`Instances::grouped`] does, with the mesh that `shape` returns for each.
    pub fn grouped_as(
        &mut self,
        pose: &Pose,
        origin: DVec3,
        leads: bool,
        objects: impl Iterator<Item = Copies>,
        shape: impl Fn(&Object) -> usize,
    ) -> Vec<Run> {
        let key = |object: &Object| run_key_as(object, shape(object));
        let mut keyed: Vec<_> =
            objects.enumerate().map(|(rank, (i, codes))| (key(&pose.objects[i]), rank, i, codes)).collect();
        keyed.sort_unstable_by_key(|&(key, rank, ..)| (key, rank));
        // The rank of each run's first object: the runs below begin where the key changes.
        let mut ranks: Vec<usize> = Vec::new();
        for (i, (key, rank, ..)) in keyed.iter().enumerate() {
            if i == 0 || keyed[i - 1].0 != *key {
                ranks.push(*rank);
            }
        }
        let runs =
            self.list(pose, origin, leads, keyed.into_iter().map(|(key, _, index, codes)| (key, (index, codes))));
        let mut ranked: Vec<_> = ranks.into_iter().zip(runs).collect();
        ranked.sort_unstable_by_key(|(rank, _)| *rank);
        ranked.into_iter().map(|(_, run)| run).collect()
    }

    /// Lists objects one after the other, in the order given.
    pub fn ordered(&mut self, pose: &Pose, origin: DVec3, objects: impl Iterator<Item = usize>) -> Vec<Run> {
        self.list(pose, origin, false, objects.map(|index| (run_key(&pose.objects[index]), once(index))))
    }

    fn list(
        &mut self,
        pose: &Pose,
        origin: DVec3,
        leads: bool,
        objects: impl Iterator<Item = ((Source, bool), Copies)>,
    ) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        for ((source, mirrored), (index, mut codes)) in objects {
            let at = self.data.len() as u32;
            let same = |run: &Run| run.source == source && run.mirrored == mirrored;
            let joins = runs.last().is_some_and(same);
            if leads && joins {
                codes.start += 1;
            }
            let count = codes.len() as u32;
            let world_from_local = &pose.objects[index].world_from_local;
            self.objects.extend(codes.clone().map(|_| index));
            let first_id = self.first_ids.get(index).copied().unwrap_or(0);
            self.data.extend(codes.map(|code| Instance::new(world_from_local, origin, code, first_id)));
            match runs.last_mut() {
                Some(run) if joins => run.instances.end += count,
                _ => runs.push(Run { source, mirrored, instances: at..at + count, parts: None }),
            }
        }
        runs
    }

    /// Uploads all instances of this frame.
    pub fn upload(&mut self, gpu: &Gpu) -> Result<()> {
        let needed = self.data.len() as u64 * Self::STRIDE;
        if needed > self.buffer.size() {
            gpu.check_buffer("the objects", needed)?;
            self.buffer = instance_buffer(gpu, self.data.len().next_power_of_two() as u64);
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&self.data));
        Ok(())
    }
}

fn instance_buffer(gpu: &Gpu, count: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("Instances::buffer"),
        size: (count * Instances::STRIDE).min(gpu.device.limits().max_buffer_size),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn run_key(object: &Object) -> (Source, bool) {
    run_key_as(object, object.mesh)
}

fn run_key_as(object: &Object, mesh: usize) -> (Source, bool) {
    let source = object.skinned.map_or(Source::Mesh(mesh), Source::Skinned);
    (source, object.world_from_local.matrix3.determinant() < 0.0)
}

/// Layouts of the vertex buffers: slot 0 positions, 1 instances, 2 surfaces, 3 normals, 4 runs. A
/// pipeline uses the first few; a pipeline of casters with names uses 0, 1 and 4.
pub(crate) fn vertex_layouts() -> [Option<wgpu::VertexBufferLayout<'static>>; 5] {
    const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
    const INSTANCE: [wgpu::VertexAttribute; 5] =
        wgpu::vertex_attr_array![4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Uint32, 8 => Uint32];
    const RUN: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![9 => Uint32];
    const SURFACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![1 => Float32x2, 2 => Unorm16x4];
    const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![3 => Float32x3];
    let layout =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    let vertex = wgpu::VertexStepMode::Vertex;
    [
        layout(12, vertex, &POSITION),
        layout(Instances::STRIDE, wgpu::VertexStepMode::Instance, &INSTANCE),
        layout(16, vertex, &SURFACE),
        layout(12, vertex, &NORMAL),
        layout(4, vertex, &RUN),
    ]
}

/// Buffers and materials that draw calls refer to.
pub(crate) struct Drawable<'a> {
    pub scene: &'a Geometry,
    pub skinned: &'a Geometry,
    pub materials: &'a Materials,
    pub instances: &'a Instances,
}

/// Numbers of draw calls and triangles of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Drawn {
    /// Number of draw calls.
    pub draws: u32,
    /// Number of triangles, counting every instance, before any clipping.
    pub triangles: u64,
}

impl std::ops::AddAssign for Drawn {
    fn add_assign(&mut self, other: Self) {
        self.draws += other.draws;
        self.triangles += other.triangles;
    }
}

impl Drawable<'_> {
    /// Returns the geometry and the primitives of a source.
    pub fn primitives(&self, source: Source) -> (&Geometry, &[GpuPrimitive]) {
        match source {
            Source::Mesh(mesh) => (self.scene, &self.scene.meshes[mesh]),
            Source::Skinned(slot) => (self.skinned, &self.skinned.meshes[slot]),
        }
    }

    /// Returns whether any primitive of an object has a material for which `choose` is true.
    pub fn has(&self, object: &Object, choose: impl Fn(&GpuMaterial) -> bool) -> bool {
        let (_, primitives) = self.primitives(run_key(object).0);
        primitives.iter().any(|primitive| choose(&self.materials.list[primitive.material]))
    }

    /// Returns the number of triangles of an object's primitives whose material `choose` accepts.
    pub fn triangles(&self, object: &Object, choose: impl Fn(&GpuMaterial) -> bool) -> u64 {
        let (_, primitives) = self.primitives(run_key(object).0);
        let chosen = primitives.iter().filter(|primitive| choose(&self.materials.list[primitive.material]));
        chosen.map(GpuPrimitive::triangles).sum()
    }

    /// Draws the indices `what` of the primitives for which `pipeline_for` has a pipeline. Bind
    /// group 1 is the material.
    pub fn draw<'p, 'r>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        runs: impl IntoIterator<Item = &'r Run>,
        what: Show,
        pipeline_for: impl Fn(&GpuMaterial, bool) -> Option<&'p wgpu::RenderPipeline>,
    ) -> Drawn {
        let mut bound = Bound::default();
        for run in runs {
            let (_, primitives) = self.primitives(run.source);
            for rank in 0..primitives.len() {
                let i = if what == Show::Visible { primitives.len() - 1 - rank } else { rank };
                let primitive = &primitives[i];
                let material = &self.materials.list[primitive.material];
                let Some(pipeline) = pipeline_for(material, run.mirrored) else { continue };
                let whole = match what {
                    Show::Surfaces | Show::Visible => &primitive.indices,
                    Show::Shadows => &primitive.caster_indices,
                };
                match &run.parts {
                    None => self.draw_ranges(pass, &mut bound, run, primitive, pipeline, [whole.clone()]),
                    Some(parts) => {
                        let ranges = parts[i].iter().map(|part| moved(whole, primitive, part));
                        self.draw_ranges(pass, &mut bound, run, primitive, pipeline, ranges);
                    }
                }
            }
        }
        bound.drawn
    }

    /// Draws the indices `what` of pieces, in the order given.
    pub fn draw_pieces<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pieces: &[Piece],
        what: Show,
        pipeline_for: impl Fn(&GpuMaterial, bool) -> Option<&'p wgpu::RenderPipeline>,
    ) -> Drawn {
        let mut bound = Bound::default();
        for piece in pieces {
            let primitive = &self.primitives(piece.source).1[piece.primitive];
            if let Some(pipeline) = pipeline_for(&self.materials.list[primitive.material], piece.mirrored) {
                let run = Run {
                    source: piece.source,
                    mirrored: piece.mirrored,
                    instances: piece.instances.clone(),
                    parts: None,
                };
                let indices = match what {
                    Show::Surfaces | Show::Visible => moved(&primitive.indices, primitive, &piece.indices),
                    Show::Shadows => piece.indices.clone(),
                };
                self.draw_ranges(pass, &mut bound, &run, primitive, pipeline, [indices]);
            }
        }
        bound.drawn
    }

    /// Draws ranges of indices of one primitive, and binds buffers and groups that are not bound
    /// yet.
    fn draw_ranges<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bound: &mut Bound<'p>,
        run: &Run,
        primitive: &GpuPrimitive,
        pipeline: &'p wgpu::RenderPipeline,
        ranges: impl IntoIterator<Item = Range<u32>>,
    ) {
        let count = run.instances.end - run.instances.start;
        for indices in ranges.into_iter().filter(|indices| !indices.is_empty()) {
            let skinned = matches!(run.source, Source::Skinned(_));
            if bound.skinned != Some(skinned) {
                let (geometry, _) = self.primitives(run.source);
                pass.set_vertex_buffer(0, geometry.positions.slice(..));
                pass.set_vertex_buffer(2, geometry.surfaces.slice(..));
                pass.set_vertex_buffer(3, geometry.normals.slice(..));
                if let Some(named) = &geometry.named {
                    pass.set_vertex_buffer(4, named.of_vertices.slice(..));
                }
                pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
                bound.skinned = Some(skinned);
            }
            if bound.instances != Some(run.instances.start) {
                // An offset rather than a first instance: not every backend knows the latter.
                let offset = u64::from(run.instances.start) * Instances::STRIDE;
                pass.set_vertex_buffer(1, self.instances.buffer.slice(offset..));
                bound.instances = Some(run.instances.start);
            }
            if bound.pipeline != Some(pipeline) {
                pass.set_pipeline(pipeline);
                bound.pipeline = Some(pipeline);
            }
            if bound.material != Some(primitive.material) {
                pass.set_bind_group(1, &self.materials.list[primitive.material].bind_group, &[]);
                bound.material = Some(primitive.material);
            }
            pass.draw_indexed(indices.clone(), 0, 0..count);
            bound.drawn.draws += 1;
            bound.drawn.triangles += u64::from((indices.end - indices.start) / 3 * count);
        }
    }
}

/// Returns the range of a list of a primitive's indices that has the triangles of a part of its
/// shadow indices: triangles stand in all lists in one order.
fn moved(whole: &Range<u32>, primitive: &GpuPrimitive, part: &Range<u32>) -> Range<u32> {
    let first = whole.start + (part.start - primitive.shadow_indices.start);
    first..first + (part.end - part.start)
}

/// Buffers and groups that a pass has bound, and numbers of what it has drawn.
#[derive(Default)]
struct Bound<'p> {
    pipeline: Option<&'p wgpu::RenderPipeline>,
    material: Option<usize>,
    skinned: Option<bool>,
    /// First instance of the bound instance buffer.
    instances: Option<u32>,
    drawn: Drawn,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_keeps_millimetres_a_hundred_kilometres_away() {
        let origin = DVec3::splat(102_400.0);
        let offset = DVec3::new(1.001, -2.002, 3.003);
        let instance = Instance::new(&DAffine3::from_translation(origin + offset), origin, 0, 0);
        for axis in 0..3 {
            assert!((f64::from(instance.rows[axis][3]) - offset[axis]).abs() < 1e-6);
            assert_eq!(instance.rows[axis][axis], 1.0);
        }
    }
}
