//! Geometry that an image showed, read back some frames later and without waiting.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use umbrage::{Aabb, View};

use crate::{Error, MaskFrame, Result, device};

/// Number of tiles across and down the image. With more tiles boxes are tighter, but more of them
/// are read back and used in planning. Scenes with 12 to 100 tiles across differed by less than a
/// tenth in E (`docs/notes/fit-to-depth.md`).
const TILES: [u32; 2] = [32, 24];

/// Most images that may be on their way back at once. A fourth one is skipped.
const SLOTS: usize = 3;

/// Bytes of a tile: two corners.
const TILE_BYTES: u64 = 32;

/// Most radians by which a camera may turn, and most share of the distance to the seen geometry by
/// which it may move, for the boxes to stay valid. Turning by 90° in a second and waiting for three
/// frames makes 4.5°.
const MOST_TURN: f64 = 0.2;
const MOST_STEP: f64 = 0.1;

/// Reads from the depth of images the geometry that they showed, as boxes for
/// [`crate::Inputs::seen`] (`fit-to depth`).
///
/// A compute pass makes a box for each of 32 × 24 tiles. The boxes come back one to three frames
/// later; nothing waits for them, and images are skipped while three others are on their way.
/// Source: \[SDSM10\] fits to the frame's samples. Here boxes of tiles are kept, so that any later
/// view, light and split can be fitted to them.
///
/// ```no_run
/// # use umbrage_wgpu::{Inputs, MaskFrame, SeenDepth, Shadows, wgpu};
/// # fn frame(seen: &mut SeenDepth, shadows: &mut Shadows, queue: &wgpu::Queue, inputs: &Inputs<'_>,
/// #     encoder: &mut wgpu::CommandEncoder, depth: &wgpu::TextureView, camera: &MaskFrame)
/// #     -> umbrage_wgpu::Result<()> {
/// let boxes = seen.boxes(inputs.view)?; // of an earlier frame
/// shadows.prepare(queue, &Inputs { seen: boxes, ..*inputs })?;
/// // … draw maps and picture …
/// seen.reduce(queue, encoder, depth, camera)?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct SeenDepth {
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    samples: u32,
    slots: [Slot; SLOTS],
    /// Number of images so far.
    turn: u64,
    boxes: Vec<Aabb>,
    /// The image from which the boxes are.
    shown: Option<Shown>,
    /// Images up to this number are forgotten.
    forgotten: u64,
}

/// An image that has come back.
#[derive(Clone, Copy, Debug)]
struct Shown {
    turn: u64,
    eye: DVec3,
    forward: DVec3,
    /// Median distance in metres from the camera to the image's boxes.
    distance: f64,
}

impl Shown {
    /// Returns whether a view sees much the same geometry.
    fn is_like(&self, view: &View) -> bool {
        let turned = self.forward.angle_between(view.forward());
        turned <= MOST_TURN && self.eye.distance(view.eye()) <= MOST_STEP * self.distance
    }
}

/// An image on its way back.
#[derive(Debug)]
struct Slot {
    uniform: wgpu::Buffer,
    corners: wgpu::Buffer,
    back: wgpu::Buffer,
    state: State,
    eye: DVec3,
    forward: DVec3,
    turn: u64,
}

#[derive(Debug)]
enum State {
    Free,
    /// The pass is recorded; it is submitted before the next call of [`SeenDepth::boxes`].
    Recorded,
    /// The map request is pending; the value is [`ARRIVED`] or [`LOST`] once it ends.
    Awaited(Arc<AtomicU8>),
}

const UNDER_WAY: u8 = 0;
const ARRIVED: u8 = 1;
const LOST: u8 = 2;

/// `UmbrageSeen` in `shaders/pass/seen.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Uniform {
    eye_from_clip: [[f32; 4]; 4],
    empty_depth: f32,
    padding: [f32; 3],
}

impl SeenDepth {
    /// A reader for depth with `samples` samples per pixel, of which it uses the first.
    ///
    /// # Errors
    /// [`Error::SeenDepth`] without compute shaders, or if depth cannot be loaded (GL, WebGL2).
    pub fn new(device: &wgpu::Device, samples: u32) -> Result<Self> {
        if device.adapter_info().backend == wgpu::Backend::Gl {
            return Err(bad("depth textures cannot be loaded on GL and WebGL2; use fit-to boxes"));
        }
        if device.limits().max_compute_workgroups_per_dimension < TILES[0] {
            return Err(bad("the device has no compute shaders; use fit-to boxes"));
        }
        let layout = layout(device, samples > 1);
        let pipeline =
            device::made(device, "making the pass that reads depth", || Ok(pipeline(device, &layout, samples)))?;
        let slots = std::array::from_fn(|_| Slot::new(device));
        Ok(Self {
            device: device.clone(),
            layout,
            pipeline,
            samples,
            slots,
            turn: 0,
            boxes: Vec::new(),
            shown: None,
            forgotten: 0,
        })
    }

    /// Reads an image's depth, after the image is drawn. `camera` is the camera that drew it.
    /// Submit the encoder before the next call of [`SeenDepth::boxes`].
    ///
    /// # Errors
    /// [`Error::SeenDepth`] for a view that is not of a depth texture with the number of samples
    /// for which this was made, or that cannot be bound; [`Error::InvalidFrameOption`] for a camera
    /// without an inverse. Nothing has been recorded then.
    pub fn reduce(
        &mut self,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        camera: &MaskFrame,
    ) -> Result<()> {
        self.check(depth.texture())?;
        let inverse = camera.clip_from_eye.inverse();
        if !(camera.clip_from_eye.is_finite() && inverse.is_finite() && camera.eye.is_finite()) {
            let expected = "a finite matrix that has an inverse, and a finite eye";
            return Err(Error::InvalidFrameOption { field: "clip_from_eye", value: f64::NAN, expected });
        }
        let turn = self.turn + 1;
        let Some(slot) = self.slots.iter_mut().find(|slot| matches!(slot.state, State::Free)) else { return Ok(()) };
        let eye_from_clip = inverse.as_mat4().to_cols_array_2d();
        let uniform = Uniform { eye_from_clip, empty_depth: camera.empty_depth, padding: [0.0; 3] };
        queue.write_buffer(&slot.uniform, 0, bytemuck::bytes_of(&uniform));
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("SeenDepth::group"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: slot.uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(depth) },
                wgpu::BindGroupEntry { binding: 2, resource: slot.corners.as_entire_binding() },
            ],
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("SeenDepth::reduce"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(TILES[0], TILES[1], 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&slot.corners, 0, &slot.back, 0, slot.back.size());
        (slot.state, slot.turn, self.turn) = (State::Recorded, turn, turn);
        (slot.eye, slot.forward) = (camera.eye, camera.forward);
        Ok(())
    }

    /// World boxes of the geometry that the newest returned image showed. `None` before the first
    /// one, and for a view of other geometry, as after a cut. Never waits.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub fn boxes(&mut self, view: &View) -> Result<Option<&[Aabb]>> {
        for slot in self.slots.iter_mut().filter(|slot| matches!(slot.state, State::Recorded)) {
            slot.await_back();
        }
        self.device.poll(wgpu::PollType::Poll).map_err(|_| Error::DeviceLost)?;
        let Self { slots, boxes, shown, forgotten, .. } = self;
        for slot in slots {
            let State::Awaited(state) = &slot.state else { continue };
            match state.load(Ordering::Acquire) {
                UNDER_WAY => continue,
                ARRIVED if slot.turn > shown.map_or(*forgotten, |shown| shown.turn) => *shown = slot.read(boxes),
                ARRIVED => slot.back.unmap(),
                _ => {}
            }
            slot.state = State::Free;
        }
        Ok(shown.filter(|shown| shown.is_like(view)).map(|_| &boxes[..]))
    }

    /// Forgets the seen geometry, as after a cut to another place.
    pub fn forget(&mut self) {
        self.shown = None;
        self.forgotten = self.turn;
    }

    fn check(&self, texture: &wgpu::Texture) -> Result<()> {
        if !texture.format().has_depth_aspect() {
            return Err(bad(&format!("the view is of {:?}, which has no depth", texture.format())));
        }
        if texture.sample_count() != self.samples {
            let (given, made) = (texture.sample_count(), self.samples);
            return Err(bad(&format!("depth has {given} samples; it was made for {made}: see SeenDepth::new")));
        }
        if !texture.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING) {
            return Err(bad("the depth texture lacks the usage TEXTURE_BINDING"));
        }
        Ok(())
    }
}

fn bad(reason: &str) -> Error {
    Error::SeenDepth { reason: reason.to_owned() }
}

impl Slot {
    fn new(device: &wgpu::Device) -> Self {
        let buffer = |label, size, usage| {
            let mapped_at_creation = false;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation })
        };
        let size = TILE_BYTES * u64::from(TILES[0] * TILES[1]);
        let [uniform, corners, back] = [
            wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        ];
        Self {
            uniform: buffer("SeenDepth::frame", size_of::<Uniform>() as u64, uniform),
            corners: buffer("SeenDepth::corners", size, corners),
            back: buffer("SeenDepth::back", size, back),
            state: State::Free,
            eye: DVec3::ZERO,
            forward: DVec3::NEG_Z,
            turn: 0,
        }
    }

    fn await_back(&mut self) {
        let state = Arc::new(AtomicU8::new(UNDER_WAY));
        let own = Arc::clone(&state);
        self.back.map_async(wgpu::MapMode::Read, .., move |result| {
            own.store(if result.is_ok() { ARRIVED } else { LOST }, Ordering::Release);
        });
        self.state = State::Awaited(state);
    }

    /// Writes the boxes of the returned image; `None` if there are none.
    fn read(&self, boxes: &mut Vec<Aabb>) -> Option<Shown> {
        boxes.clear();
        if let Ok(range) = self.back.get_mapped_range(..) {
            let corners: &[[f32; 4]] = bytemuck::cast_slice(&range);
            boxes.extend(corners.chunks_exact(2).filter_map(|pair| self.tile(pair)));
        }
        self.back.unmap();
        let mut distances: Vec<f64> = boxes.iter().map(|bounds| bounds.center().distance(self.eye)).collect();
        if distances.is_empty() {
            return None;
        }
        let middle = distances.len() / 2;
        let distance = *distances.select_nth_unstable_by(middle, f64::total_cmp).1;
        Some(Shown { turn: self.turn, eye: self.eye, forward: self.forward, distance })
    }

    /// The box of a tile, slightly wider than `f32` gives; `None` if the tile shows nothing.
    fn tile(&self, corners: &[[f32; 4]]) -> Option<Aabb> {
        let [low, high] = [corners[0], corners[1]].map(|[x, y, z, _]| DVec3::new(x.into(), y.into(), z.into()));
        if !(low.is_finite() && high.is_finite() && low.cmple(high).all()) {
            return None;
        }
        let room = 1e-5 * low.abs().max(high.abs()).max_element();
        Some(Aabb::new(self.eye + low - room, self.eye + high + room))
    }
}

fn layout(device: &wgpu::Device, multisampled: bool) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let depth = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("SeenDepth::layout"),
        entries: &[
            entry(0, buffer(wgpu::BufferBindingType::Uniform)),
            entry(1, depth),
            entry(2, buffer(wgpu::BufferBindingType::Storage { read_only: false })),
        ],
    })
}

fn pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, samples: u32) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("SeenDepth"),
        source: wgpu::ShaderSource::Wgsl(umbrage_shaders::seen(samples > 1).into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("SeenDepth"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("SeenDepth"),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("umbrage_seen"),
        compilation_options: Default::default(),
        cache: None,
    })
}
