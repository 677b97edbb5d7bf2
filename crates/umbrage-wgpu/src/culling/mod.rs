//! Culling of instances on the GPU, split by split, for applications whose instances live there.

mod buffers;

use std::ops::Range;

use glam::DVec3;
use umbrage::CasterTest;
use umbrage_shaders::CULL_PASS;
use umbrage_shaders::layout::{CullBox, CullDraw, CullFrame};

use self::buffers::Buffers;
use crate::shadows::{ShadowFrame, ShadowMap};
use crate::{Error, Result, device};

/// Threads of a workgroup, as declared in the shader.
const WORKGROUP: u32 = 64;

/// A mesh that instances show, with the index range that the application draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CullMesh {
    /// Range of the mesh in the index buffer.
    pub indices: Range<u32>,
    /// Value added to each index.
    pub base_vertex: i32,
    /// Most instances of the mesh: so many places are reserved for it in each split.
    pub instances: u32,
}

/// The instances of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CullInputs {
    /// Number of instances, at the beginning of the buffer of boxes.
    pub instances: u32,
    /// World point to which boxes are relative, near them, so that `f32` is precise enough. It need
    /// not be the frame's origin, and may stay the same forever.
    pub origin: DVec3,
}

/// Culls instances on the GPU: each box is tested against all splits of a sun's plan, and those
/// that pass are drawn, without a list on the CPU and without reading back.
///
/// Boxes ([`CullBox`]) lie in a storage buffer of the application, which also gives the mesh of
/// each instance. A compute pass writes the numbers of the instances that pass one after the other,
/// mesh by mesh, and counts them in the arguments of indirect draws. The numbers are a vertex
/// buffer that advances by instance, bound at the offset where those of a mesh begin. The device
/// therefore needs no feature for first instances, counts of draws or draw indices.
///
/// The plan is made without a list: [`crate::Inputs::casters`] and [`crate::Inputs::receivers`] are
/// a few boxes that contain all instances, such as a level's tiles. The test is that of the
/// planner's lists with room for rounding ([`umbrage::CasterTest`]): every instance that such a
/// list would have contained is drawn.
///
/// ```no_run
/// # use umbrage_wgpu::{CullInputs, CullMesh, Error, Inputs, InstanceCulling, Shadows, wgpu};
/// # fn frame(device: &wgpu::Device, queue: &wgpu::Queue, shadows: &mut Shadows, inputs: &Inputs<'_>,
/// #     boxes: &wgpu::Buffer, meshes: &[CullMesh], pipeline: &wgpu::RenderPipeline) -> Result<(), Error> {
/// let mut culling = InstanceCulling::new(device, shadows.maps().splits(), meshes)?; // once
/// culling.bind(boxes)?; // once, and for another buffer
///
/// let frame = shadows.prepare(queue, inputs)?; // each frame
/// culling.prepare(queue, &frame, &CullInputs { instances: 1_000_000, origin: inputs.origin })?;
/// let mut encoder = device.create_command_encoder(&Default::default());
/// culling.cull(&mut encoder)?;
/// for map in frame.maps() {
///     let mut pass = map.begin(&mut encoder);
///     pass.set_pipeline(pipeline);
///     pass.set_bind_group(0, map.bind_group(), &[]);
///     for draw in culling.draws(&map) {
///         // Vertex and index buffers of meshes[draw.mesh()] are the application's.
///         draw.draw(&mut pass, 1); // the vertex shader gets the instance's number from slot 1
///     }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct InstanceCulling {
    device: wgpu::Device,
    meshes: Vec<CullMesh>,
    splits: usize,
    buffers: Buffers,
    pipeline: Option<wgpu::ComputePipeline>,
    group: Option<wgpu::BindGroup>,
    /// Number of boxes in the bound buffer.
    bound: u64,
    tests: Vec<CasterTest>,
    inputs: CullInputs,
    /// Number of instances of each draw, if lists were made on the CPU.
    counts: Option<Vec<u32>>,
}

impl InstanceCulling {
    /// Culling for a sun's maps and these meshes; `splits` is [`crate::ShadowMaps::splits`].
    ///
    /// # Errors
    /// [`Error::Culling`] naming the problem with the meshes, [`Error::CullingTooLarge`] if the
    /// device has no buffer for so many places, [`Error::Device`], [`Error::OutOfMemory`],
    /// [`Error::DeviceLost`].
    pub fn new(device: &wgpu::Device, splits: usize, meshes: &[CullMesh]) -> Result<Self> {
        check_meshes(splits, meshes)?;
        device::made(device, "creating culling", || {
            let buffers = Buffers::new(device, splits, meshes)?;
            let pipeline = can_compute(device).then(|| pipeline(device, &buffers));
            Ok(Self {
                device: device.clone(),
                meshes: meshes.to_vec(),
                splits,
                buffers,
                pipeline,
                group: None,
                bound: 0,
                tests: Vec::new(),
                inputs: CullInputs::default(),
                counts: None,
            })
        })
    }

    /// Returns whether the device runs compute shaders with the number of buffers that culling
    /// needs. Otherwise [`InstanceCulling::cull_on_cpu`] makes the same lists.
    #[must_use]
    pub fn can_compute(&self) -> bool {
        self.pipeline.is_some()
    }

    /// Sets the buffer of boxes: an array of [`CullBox`], with [`wgpu::BufferUsages::STORAGE`].
    ///
    /// # Errors
    /// [`Error::Culling`] for a buffer of another usage, [`Error::CullingNeedsCompute`],
    /// [`Error::Device`].
    pub fn bind(&mut self, boxes: &wgpu::Buffer) -> Result<()> {
        let Some(pipeline) = &self.pipeline else { return Err(Error::CullingNeedsCompute) };
        if !boxes.usage().contains(wgpu::BufferUsages::STORAGE) {
            return Err(culling("boxes", "the buffer has no usage STORAGE; create it with it".to_owned()));
        }
        let bound = boxes.size() / size_of::<CullBox>() as u64;
        if bound == 0 {
            return Err(culling("boxes", format!("the buffer has {} bytes, less than a box", boxes.size())));
        }
        let (device, buffers) = (&self.device, &self.buffers);
        let layout = pipeline.get_bind_group_layout(0);
        self.group = Some(device::guarded(device, "binding boxes", || Ok(buffers.group(device, &layout, boxes)))?);
        self.bound = bound;
        Ok(())
    }

    /// Writes a prepared frame's tests to the GPU and clears the draws; both take effect with the
    /// next submission.
    ///
    /// # Errors
    /// [`Error::CullingPlan`] for plans without such a test: of several lights or of a local light,
    /// of warped or kept maps, or of layouts that draw several splits in one pass.
    /// [`Error::Culling`] for more instances than a dispatch or the bound buffer allows, and for an
    /// origin that is not finite. [`Error::DeviceLost`].
    pub fn prepare(&mut self, queue: &wgpu::Queue, frame: &ShadowFrame<'_>, inputs: &CullInputs) -> Result<()> {
        self.check(inputs)?;
        self.tests = tests(frame, self.splits, inputs.origin)?;
        self.inputs = *inputs;
        self.counts = None;
        let room = self.buffers.room;
        let header = CullFrame {
            instances: inputs.instances,
            splits: self.tests.len() as u32,
            meshes: self.meshes.len() as u32,
            room,
        };
        self.buffers.write(queue, &header, &self.tests, &self.draws_of(|_| 0))
    }

    /// Records the compute pass. Draws of this frame have to come after it.
    ///
    /// # Errors
    /// [`Error::CullingNeedsCompute`], [`Error::Culling`] if no boxes are bound.
    pub fn cull(&self, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        let Some(pipeline) = &self.pipeline else { return Err(Error::CullingNeedsCompute) };
        let Some(group) = &self.group else {
            return Err(culling("boxes", "no buffer is bound; call InstanceCulling::bind first".to_owned()));
        };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("InstanceCulling::cull"),
            timestamp_writes: None,
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(self.inputs.instances.div_ceil(WORKGROUP), 1, 1);
        Ok(())
    }

    /// Makes the lists of the prepared frame on the CPU, from a copy of the boxes: for devices
    /// without compute shaders, in place of [`InstanceCulling::cull`].
    ///
    /// # Errors
    /// [`Error::Culling`] if there are fewer boxes than instances, [`Error::DeviceLost`].
    pub fn cull_on_cpu(&mut self, queue: &wgpu::Queue, boxes: &[CullBox]) -> Result<()> {
        let Some(boxes) = boxes.get(..self.inputs.instances as usize) else {
            let (given, wanted) = (boxes.len(), self.inputs.instances);
            return Err(culling("boxes", format!("there are {given} for {wanted} instances; give one for each")));
        };
        let mut counts = vec![0_u32; self.splits * self.meshes.len()];
        for (split, test) in self.tests.iter().enumerate() {
            let mut ids: Vec<Vec<u32>> = vec![Vec::new(); self.meshes.len()];
            let shown = |own: &CullBox| own.skip == 0 && (own.mesh as usize) < self.meshes.len();
            for (instance, own) in boxes.iter().enumerate().filter(|(_, own)| shown(own)) {
                let list = &mut ids[own.mesh as usize];
                let has_room = list.len() < self.meshes[own.mesh as usize].instances as usize;
                if has_room && test.passes(own.center.into(), own.half.into()) {
                    list.push(instance as u32);
                }
            }
            for (mesh, ids) in ids.iter().enumerate() {
                counts[split * self.meshes.len() + mesh] = ids.len() as u32;
                device::write(queue, &self.buffers.ids, self.buffers.offset(split, mesh), bytemuck::cast_slice(ids))?;
            }
        }
        self.buffers.write_draws(queue, &self.draws_of(|draw| counts[draw]))?;
        self.counts = Some(counts);
        Ok(())
    }

    /// The draws of a map, mesh by mesh. Empty for a map that does not belong to the prepared
    /// frame's sun.
    pub fn draws<'a>(&'a self, map: &ShadowMap<'_>) -> impl Iterator<Item = CulledDraw<'a>> + use<'a> {
        let split = map.splits().start;
        let meshes = if split < self.tests.len() { self.meshes.len() } else { 0 };
        (0..meshes).map(move |mesh| CulledDraw { culling: self, split, mesh })
    }

    /// Buffer of the numbers of the instances that passed, as the shader wrote them;
    /// [`CulledDraw::places`] gives the range of a draw. To copy from, or to bind as a storage
    /// buffer.
    #[must_use]
    pub fn ids(&self) -> &wgpu::Buffer {
        &self.buffers.ids
    }

    /// Buffer of the arguments of all draws ([`CullDraw`]), split by split and mesh by mesh.
    #[must_use]
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.buffers.draws
    }

    /// Memory of all buffers in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.buffers.bytes()
    }

    fn draws_of(&self, count: impl Fn(usize) -> u32) -> Vec<CullDraw> {
        let draw = |index: usize| {
            let mesh = &self.meshes[index % self.meshes.len()];
            CullDraw {
                index_count: mesh.indices.end - mesh.indices.start,
                instance_count: count(index),
                first_index: mesh.indices.start,
                base_vertex: mesh.base_vertex,
                first_instance: 0,
            }
        };
        (0..self.splits * self.meshes.len()).map(draw).collect()
    }

    fn check(&self, inputs: &CullInputs) -> Result<()> {
        if !inputs.origin.is_finite() {
            return Err(culling("origin", format!("{} is not finite; give a world point", inputs.origin)));
        }
        let most = u64::from(self.device.limits().max_compute_workgroups_per_dimension) * u64::from(WORKGROUP);
        if self.can_compute() && u64::from(inputs.instances) > most {
            return Err(culling("instances", format!("{} are more than a dispatch takes, {most}", inputs.instances)));
        }
        if self.group.is_some() && u64::from(inputs.instances) > self.bound {
            let (given, bound) = (inputs.instances, self.bound);
            return Err(culling("instances", format!("{given} are more than the {bound} boxes that are bound")));
        }
        Ok(())
    }
}

/// The instances of one mesh in one split.
#[derive(Clone, Copy, Debug)]
pub struct CulledDraw<'a> {
    culling: &'a InstanceCulling,
    split: usize,
    mesh: usize,
}

impl CulledDraw<'_> {
    /// Index of the mesh.
    #[must_use]
    pub fn mesh(&self) -> usize {
        self.mesh
    }

    /// Range of the draw's instance numbers in [`InstanceCulling::ids`], counted in numbers. The
    /// draw's arguments give how many of them are written.
    #[must_use]
    pub fn places(&self) -> Range<u64> {
        let first = self.culling.buffers.offset(self.split, self.mesh) / 4;
        first..first + u64::from(self.culling.meshes[self.mesh].instances)
    }

    /// Byte offset of the draw's arguments in [`InstanceCulling::arguments`].
    #[must_use]
    pub fn arguments_offset(&self) -> u64 {
        let draw = self.split * self.culling.meshes.len() + self.mesh;
        (draw * size_of::<CullDraw>()) as u64
    }

    /// Draws: binds the instance numbers as vertex buffer `slot` (one `u32` per instance) and draws
    /// with the arguments. Pipeline, bind groups, other vertex buffers and the index buffer have to
    /// be set before.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, slot: u32) {
        let places = self.places();
        if places.is_empty() {
            return;
        }
        pass.set_vertex_buffer(slot, self.culling.buffers.ids.slice(4 * places.start..4 * places.end));
        let mesh = &self.culling.meshes[self.mesh];
        match &self.culling.counts {
            None => pass.draw_indexed_indirect(&self.culling.buffers.draws, self.arguments_offset()),
            Some(counts) => {
                let count = counts[self.split * self.culling.meshes.len() + self.mesh];
                pass.draw_indexed(mesh.indices.clone(), mesh.base_vertex, 0..count);
            }
        }
    }
}

fn culling(field: &'static str, reason: String) -> Error {
    Error::Culling { field, reason }
}

fn check_meshes(splits: usize, meshes: &[CullMesh]) -> Result<()> {
    if splits == 0 {
        return Err(culling("splits", "there is none; give ShadowMaps::splits".to_owned()));
    }
    if meshes.is_empty() {
        return Err(culling("meshes", "there is none; give one for each number in the boxes".to_owned()));
    }
    for (index, mesh) in meshes.iter().enumerate() {
        if mesh.indices.start > mesh.indices.end {
            let reason = format!("indices of mesh {index}, {:?}, end before they begin", mesh.indices);
            return Err(culling("meshes", reason));
        }
    }
    let places: u64 = meshes.iter().map(|mesh| u64::from(mesh.instances)).sum();
    if places == 0 || places * splits as u64 > u64::from(u32::MAX) {
        let reason = format!("their instances are {places} for each of {splits} splits; give 1 to 2^32 in all");
        return Err(culling("meshes", reason));
    }
    Ok(())
}

/// The tests of a frame's splits.
fn tests(frame: &ShadowFrame<'_>, splits: usize, origin: DVec3) -> Result<Vec<CasterTest>> {
    let refused = |what| Err(Error::CullingPlan { what });
    if frame.is_kept() {
        return refused("maps are kept (cache kept), which are drawn from a set of casters");
    }
    if frame.maps().any(|map| map.splits().len() > 1) {
        return refused("one pass draws several splits (generation)");
    }
    if frame.maps().any(|map| map.light() > 0) {
        return refused("there are several lights");
    }
    let plan = frame.plan(0);
    if plan.splits.len() != splits {
        return refused("it has another number of splits than culling was made for");
    }
    let tests: Option<Vec<CasterTest>> = (0..splits).map(|split| plan.caster_test(split, origin)).collect();
    tests.map_or_else(|| refused("it is of a lamp, or its maps are warped"), Ok)
}

/// Returns whether compute shaders run, with the seven storage buffers that culling needs.
fn can_compute(device: &wgpu::Device) -> bool {
    let limits = device.limits();
    limits.max_compute_workgroups_per_dimension > 0
        && limits.max_compute_invocations_per_workgroup >= WORKGROUP
        && limits.max_storage_buffers_per_shader_stage >= buffers::STORAGE_BUFFERS
}

fn pipeline(device: &wgpu::Device, buffers: &Buffers) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("InstanceCulling::shader"),
        source: wgpu::ShaderSource::Wgsl(CULL_PASS.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("InstanceCulling::layout"),
        bind_group_layouts: &[Some(&buffers.layout(device))],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("InstanceCulling::cull"),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("cull"),
        compilation_options: Default::default(),
        cache: None,
    })
}
