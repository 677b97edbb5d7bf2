//! Culling on the GPU: which instances are drawn into which splits, for applications whose
//! instances live there.

mod buffers;

use std::ops::Range;

use glam::DVec3;
use umbrage::CasterTest;
use umbrage_shaders::CULL_PASS;
use umbrage_shaders::layout::{CullBox, CullDraw, CullFrame};

use self::buffers::Buffers;
use crate::shadows::{ShadowFrame, ShadowMap};
use crate::{Error, Result, device};

/// Threads of a workgroup, as the shader has them.
const WORKGROUP: u32 = 64;

/// A mesh that instances show, as its application draws it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CullMesh {
    /// Its indices in the index buffer.
    pub indices: Range<u32>,
    /// Added to each index.
    pub base_vertex: i32,
    /// How many instances show it, at most: so many places are kept for it in each split.
    pub instances: u32,
}

/// The instances of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CullInputs {
    /// How many there are, at the beginning of the buffer of boxes.
    pub instances: u32,
    /// The world point that boxes are relative to: one near them, so that `f32` holds them. It need
    /// not be the frame's origin and may stay as it is for good.
    pub origin: DVec3,
}

/// Culls instances on the GPU: each box against all splits of a sun's plan, and draws of what
/// passes, without a list on the CPU and without reading back.
///
/// Boxes ([`CullBox`]) lie in a storage buffer of the application's, which says for each instance
/// which mesh it shows. A compute pass writes the numbers of instances that pass behind each other,
/// mesh by mesh, and counts them in the arguments of indirect draws. Numbers are a vertex buffer
/// that advances by instance, bound at the place where a mesh's begin: no device needs to know
/// first instances, counts of draws or draw indices.
///
/// The plan is made without a list: [`crate::Inputs::casters`] and [`crate::Inputs::receivers`]
/// are a few boxes that hold all instances, such as a level's tiles. The test is that of the
/// planner's lists with room for rounding ([`umbrage::CasterTest`]): whatever such a list would
/// have held is drawn.
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
    /// How many boxes the bound buffer holds.
    bound: u64,
    tests: Vec<CasterTest>,
    inputs: CullInputs,
    /// Where lists were made on the CPU, how many instances each draw has.
    counts: Option<Vec<u32>>,
}

impl InstanceCulling {
    /// For a sun's maps and these meshes; [`crate::ShadowMaps::splits`] says how many splits there
    /// are.
    ///
    /// # Errors
    /// [`Error::Culling`] naming what is wrong with the meshes, [`Error::CullingTooLarge`] if the
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

    /// Whether the device runs compute shaders with as many buffers as this takes. Without,
    /// [`InstanceCulling::cull_on_cpu`] makes the same lists.
    #[must_use]
    pub fn can_compute(&self) -> bool {
        self.pipeline.is_some()
    }

    /// Chooses the buffer of boxes: [`CullBox`] after [`CullBox`], with
    /// [`wgpu::BufferUsages::STORAGE`].
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

    /// Hands a prepared frame's tests to the GPU and empties the draws; both take effect with the
    /// next submission.
    ///
    /// # Errors
    /// [`Error::CullingPlan`] for plans that have no such test: of several lights or of a lamp, of
    /// warped or kept maps, or of layouts that draw several splits in one pass.
    /// [`Error::Culling`] for more instances than a dispatch or the bound buffer holds and for an
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

    /// Records the compute pass. Draws of this frame come after it.
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

    /// The draws of a map, mesh by mesh. Nothing for a map that is not of the prepared frame's sun.
    pub fn draws<'a>(&'a self, map: &ShadowMap<'_>) -> impl Iterator<Item = CulledDraw<'a>> + use<'a> {
        let split = map.splits().start;
        let meshes = if split < self.tests.len() { self.meshes.len() } else { 0 };
        (0..meshes).map(move |mesh| CulledDraw { culling: self, split, mesh })
    }

    /// The numbers of instances that passed, as the shader wrote them: [`CulledDraw::places`] says
    /// where those of a draw lie. To copy from, or to bind as a storage buffer.
    #[must_use]
    pub fn ids(&self) -> &wgpu::Buffer {
        &self.buffers.ids
    }

    /// The arguments of all draws ([`CullDraw`]), split by split and mesh by mesh.
    #[must_use]
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.buffers.draws
    }

    /// Bytes of all buffers.
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
    /// Number of the mesh.
    #[must_use]
    pub fn mesh(&self) -> usize {
        self.mesh
    }

    /// Where the numbers of its instances lie in [`InstanceCulling::ids`], in numbers; how many of
    /// them are written is in its arguments.
    #[must_use]
    pub fn places(&self) -> Range<u64> {
        let first = self.culling.buffers.offset(self.split, self.mesh) / 4;
        first..first + u64::from(self.culling.meshes[self.mesh].instances)
    }

    /// Byte offset of its arguments in [`InstanceCulling::arguments`].
    #[must_use]
    pub fn arguments_offset(&self) -> u64 {
        let draw = self.split * self.culling.meshes.len() + self.mesh;
        (draw * size_of::<CullDraw>()) as u64
    }

    /// Draws: binds the numbers of its instances as vertex buffer `slot` (one `u32` an instance)
    /// and draws with its arguments. Pipeline, bind groups, other vertex buffers and the index
    /// buffer are set already.
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

/// Whether compute shaders run, with the seven storage buffers of ours.
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
