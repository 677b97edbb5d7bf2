//! Which objects a pass draws, where they stand relative to the origin, and the calls that draw them.

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
    /// Which copy of a caster, for passes that draw several splits.
    code: u32,
}

/// An object and the codes of its copies, one instance each.
pub(crate) type Copies = (usize, Range<u32>);

/// An object that is drawn once, in any pass that knows no copies.
pub(crate) fn once(object: usize) -> Copies {
    (object, 0..1)
}

impl Instance {
    /// The subtraction happens in `f64`; what is left is small near the eye and fits `f32`.
    fn new(world_from_local: &DAffine3, origin: DVec3, code: u32) -> Self {
        let m = world_from_local.matrix3;
        let t = world_from_local.translation - origin;
        let row = |i: usize| [m.x_axis[i] as f32, m.y_axis[i] as f32, m.z_axis[i] as f32, t[i] as f32];
        Self { rows: [row(0), row(1), row(2)], code }
    }
}

/// Where a run's vertices come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Source {
    /// A mesh of the scene.
    Mesh(usize),
    /// An entry of [`Pose::skinned`].
    Skinned(usize),
}

/// For each primitive of a mesh the ranges of its shadow indices that are drawn.
pub(crate) type Parts = Vec<Vec<Range<u32>>>;

/// Which of a primitive's indices are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Show {
    /// Those of its surface.
    Surfaces,
    /// Those for shadow passes, or what a run has of them.
    Shadows,
}

/// Objects that share a source and an orientation: drawn together, once per primitive.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub source: Source,
    /// The transform mirrors: front faces are clockwise.
    pub mirrored: bool,
    pub instances: Range<u32>,
    /// In shadow passes: what is drawn of its object; `None`: all of it.
    pub parts: Option<Parts>,
}

/// The instances of all passes of a frame, and the buffer they are uploaded into.
pub(crate) struct Instances {
    data: Vec<Instance>,
    buffer: wgpu::Buffer,
}

impl Instances {
    pub const STRIDE: u64 = size_of::<Instance>() as u64;

    pub fn new(gpu: &Gpu) -> Self {
        Self { data: Vec::new(), buffer: instance_buffer(gpu, 64) }
    }

    /// Forgets the last frame.
    pub fn clear(&mut self) {
        self.data.clear();
    }

    /// Objects that share a source drawn together, those given first as early as that allows. Where every draw has to begin with an
    /// instance that draws nothing, each object's codes begin with one; `leads` keeps the first of a run and drops the others.
    pub fn grouped(
        &mut self,
        pose: &Pose,
        origin: DVec3,
        leads: bool,
        objects: impl Iterator<Item = Copies>,
    ) -> Vec<Run> {
        let mut keyed: Vec<_> =
            objects.enumerate().map(|(rank, (i, codes))| (run_key(&pose.objects[i]), rank, i, codes)).collect();
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

    /// Objects drawn one after the other in the order given.
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
            self.data.extend(codes.map(|code| Instance::new(world_from_local, origin, code)));
            match runs.last_mut() {
                Some(run) if joins => run.instances.end += count,
                _ => runs.push(Run { source, mirrored, instances: at..at + count, parts: None }),
            }
        }
        runs
    }

    /// Sends all lists of this frame to the GPU.
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
    let source = object.skinned.map_or(Source::Mesh(object.mesh), Source::Skinned);
    (source, object.world_from_local.matrix3.determinant() < 0.0)
}

/// How vertex buffers are laid out: slot 0 positions, 1 instances, 2 surfaces, 3 normals. A pipeline uses the first few.
pub(crate) fn vertex_layouts() -> [Option<wgpu::VertexBufferLayout<'static>>; 4] {
    const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
    const INSTANCE: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Uint32];
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
    ]
}

/// Everything that draws may refer to.
pub(crate) struct Drawable<'a> {
    pub scene: &'a Geometry,
    pub skinned: &'a Geometry,
    pub materials: &'a Materials,
    pub instances: &'a Instances,
}

/// What a pass has drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Drawn {
    /// Draw calls.
    pub draws: u32,
    /// Triangles, counting every instance, before any clipping.
    pub triangles: u64,
}

impl std::ops::AddAssign for Drawn {
    fn add_assign(&mut self, other: Self) {
        self.draws += other.draws;
        self.triangles += other.triangles;
    }
}

impl Drawable<'_> {
    /// The primitives of a run.
    fn primitives(&self, source: Source) -> (&Geometry, &[GpuPrimitive]) {
        match source {
            Source::Mesh(mesh) => (self.scene, &self.scene.meshes[mesh]),
            Source::Skinned(slot) => (self.skinned, &self.skinned.meshes[slot]),
        }
    }

    /// Whether any primitive of an object has a material that `choose` likes.
    pub fn has(&self, object: &Object, choose: impl Fn(&GpuMaterial) -> bool) -> bool {
        let (_, primitives) = self.primitives(run_key(object).0);
        primitives.iter().any(|primitive| choose(&self.materials.list[primitive.material]))
    }

    /// Triangles of an object's primitives whose material `choose` likes.
    pub fn triangles(&self, object: &Object, choose: impl Fn(&GpuMaterial) -> bool) -> u64 {
        let (_, primitives) = self.primitives(run_key(object).0);
        let chosen = primitives.iter().filter(|primitive| choose(&self.materials.list[primitive.material]));
        chosen.map(GpuPrimitive::triangles).sum()
    }

    /// Draws `what` of the primitives for which `pipeline_for` has a pipeline. Bind group 1 is the material.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        runs: &[Run],
        what: Show,
        pipeline_for: impl Fn(&GpuMaterial, bool) -> Option<&'p wgpu::RenderPipeline>,
    ) -> Drawn {
        let mut drawn = Drawn::default();
        let (mut bound_pipeline, mut bound_material, mut bound_skinned) = (None, None, None);
        for run in runs {
            let (geometry, primitives) = self.primitives(run.source);
            let count = run.instances.end - run.instances.start;
            let skinned = matches!(run.source, Source::Skinned(_));
            let mut instances_bound = false;
            for (i, primitive) in primitives.iter().enumerate() {
                let material = &self.materials.list[primitive.material];
                let Some(pipeline) = pipeline_for(material, run.mirrored) else { continue };
                let ranges = match (what, &run.parts) {
                    (Show::Surfaces, _) => std::slice::from_ref(&primitive.indices),
                    (Show::Shadows, None) => std::slice::from_ref(&primitive.shadow_indices),
                    (Show::Shadows, Some(parts)) => &parts[i],
                };
                if ranges.iter().all(Range::is_empty) {
                    continue;
                }
                if bound_skinned != Some(skinned) {
                    pass.set_vertex_buffer(0, geometry.positions.slice(..));
                    pass.set_vertex_buffer(2, geometry.surfaces.slice(..));
                    pass.set_vertex_buffer(3, geometry.normals.slice(..));
                    pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
                    bound_skinned = Some(skinned);
                }
                if !instances_bound {
                    // An offset rather than a first instance: not every backend knows the latter.
                    let offset = u64::from(run.instances.start) * Instances::STRIDE;
                    pass.set_vertex_buffer(1, self.instances.buffer.slice(offset..));
                    instances_bound = true;
                }
                if bound_pipeline != Some(pipeline) {
                    pass.set_pipeline(pipeline);
                    bound_pipeline = Some(pipeline);
                }
                if bound_material != Some(primitive.material) {
                    pass.set_bind_group(1, &material.bind_group, &[]);
                    bound_material = Some(primitive.material);
                }
                for indices in ranges {
                    pass.draw_indexed(indices.clone(), 0, 0..count);
                    drawn.draws += 1;
                    drawn.triangles += u64::from((indices.end - indices.start) / 3 * count);
                }
            }
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_keeps_millimetres_a_hundred_kilometres_away() {
        let origin = DVec3::splat(102_400.0);
        let offset = DVec3::new(1.001, -2.002, 3.003);
        let instance = Instance::new(&DAffine3::from_translation(origin + offset), origin, 0);
        for axis in 0..3 {
            assert!((f64::from(instance.rows[axis][3]) - offset[axis]).abs() < 1e-6);
            assert_eq!(instance.rows[axis][axis], 1.0);
        }
    }
}
