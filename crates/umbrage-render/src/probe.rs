//! Visibility at given world points, from the maps and functions that shade the scene.

use std::borrow::Cow;

use glam::DVec3;
use umbrage_wgpu::ShadowMaps;
use wgpu::util::{DeviceExt, TextureDataOrder};

use crate::capture::Capture;
use crate::formats::{ANSWERS_FORMAT, POINTS_FORMAT};
use crate::layouts::{self, UNFILTERED};
use crate::names::Names;
use crate::{Error, Gpu, Result, shaders};

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePoint {
    /// World position in metres.
    pub position: DVec3,
    /// The surface's geometric normal on the side that is probed. It need not be normalised.
    pub normal: DVec3,
}

/// Result of probing one world point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProbeAnswer {
    /// Visibility from 1 (lit) to 0 (in shadow); 0 where the surface is turned away from the light.
    pub visibility: f32,
    /// Index of the split whose map was read; −1 if no map covers the point.
    pub split: i32,
}

/// Choice of the split that answers for a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Responder {
    /// The split that the view chooses.
    View,
    /// A given split, for a point that the view does not show.
    Split(usize),
    /// No split: no map covers the point. It is lit unless turned away from the light.
    Nobody,
}

/// Most points in one texture row, which every device can draw.
const ROW: u32 = 2048;
/// Most rows of points in one pass.
const MOST_ROWS: u32 = 512;
/// The most points that [`Probe::record`] takes at once.
pub(crate) const BATCH: usize = (ROW * MOST_ROWS) as usize;

/// Pass that probes points.
pub(crate) struct Probe {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

/// Answers that are being read back.
pub(crate) struct PendingAnswers {
    capture: Capture,
    count: usize,
}

impl Probe {
    /// Binding of the first buffer of caster ids, with exact edges.
    pub const NAMES: u32 = 2;

    pub fn new(gpu: &Gpu, maps: &ShadowMaps) -> Self {
        let device = &gpu.device;
        let is_exact = maps.edges().is_exact();
        let runs = if is_exact { umbrage_wgpu::stored_runs_wgsl(0, Self::NAMES) } else { String::new() };
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("Probe::shader"),
            source: wgpu::ShaderSource::Wgsl(Cow::Owned(shaders::probe(&(maps.receiver_wgsl(1) + &runs)))),
        });
        let mut entries = vec![layouts::texture(0, UNFILTERED), layouts::texture(1, UNFILTERED)];
        if is_exact {
            entries.extend(Names::layout(Self::NAMES));
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("Probe::layout"),
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("Probe::pipeline_layout"),
            bind_group_layouts: &[Some(&layout), Some(maps.receiver_layout())],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("Probe::pipeline"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_all"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs_probe"),
                compilation_options: Default::default(),
                targets: &[Some(ANSWERS_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { layout, pipeline }
    }

    /// Records the pass for at most [`BATCH`] points. Points without a responder are looked up in
    /// split 0 and corrected by the caller. `named` are the buffers of [`Names::entries`].
    pub fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (maps, named): (&wgpu::BindGroup, &[wgpu::BindGroupEntry<'_>]),
        origin: DVec3,
        points: &[(ProbePoint, Responder)],
    ) -> Result<PendingAnswers> {
        let height = (points.len() as u32).div_ceil(ROW).max(1);
        let pixels = (ROW * height) as usize;
        let mut positions = vec![[0.0_f32; 4]; pixels];
        let mut normals = vec![[0.0_f32; 4]; pixels];
        for (index, (point, responder)) in points.iter().enumerate() {
            let position = (point.position - origin).as_vec3();
            let who = match responder {
                Responder::View => 0.0,
                Responder::Split(split) => *split as f32 + 1.0,
                Responder::Nobody => 1.0,
            };
            positions[index] = position.extend(who).to_array();
            normals[index] = point.normal.normalize().as_vec3().extend(0.0).to_array();
        }
        let size = wgpu::Extent3d { width: ROW, height, depth_or_array_layers: 1 };
        let descriptor = |label, format, usage| wgpu::TextureDescriptor {
            label: Some(label),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        };
        let input = |label, data: &[[f32; 4]]| {
            let descriptor = descriptor(label, POINTS_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING);
            let data = bytemuck::cast_slice(data);
            let texture =
                gpu.device.create_texture_with_data(&gpu.queue, &descriptor, TextureDataOrder::LayerMajor, data);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (positions, normals) = (input("Probe::points", &positions), input("Probe::normals", &normals));
        let answers = gpu.device.create_texture(&descriptor(
            "Probe::answers",
            ANSWERS_FORMAT,
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        ));
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&positions) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&normals) },
        ];
        entries.extend_from_slice(named);
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("Probe::bind_group"),
            layout: &self.layout,
            entries: &entries,
        });
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("Probe::pass"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &answers.create_view(&wgpu::TextureViewDescriptor::default()),
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &bind_group, &[]);
            pass.set_bind_group(1, maps, &[]);
            pass.draw(0..3, 0..1);
        }
        let capture = Capture::record(gpu, encoder, &answers, 0, [ROW, height])?;
        Ok(PendingAnswers { capture, count: points.len() })
    }
}

impl PendingAnswers {
    /// Waits for the answers, in the order of the points.
    pub async fn read(self, gpu: &Gpu) -> Result<Vec<ProbeAnswer>> {
        let numbers: Vec<[f32; 2]> = bytemuck::pod_collect_to_vec(&self.capture.read(gpu).await?);
        let answer = |&[visibility, split]: &[f32; 2]| ProbeAnswer { visibility, split: split as i32 };
        Ok(numbers[..self.count].iter().map(answer).collect())
    }
}

/// Checks points before anything is drawn for them.
pub(crate) fn check(points: &[ProbePoint]) -> Result<()> {
    for (index, point) in points.iter().enumerate() {
        let wrong = |reason| Err(Error::Probe { index, reason });
        if !point.position.is_finite() {
            return wrong("its position is not finite; give three numbers in metres");
        }
        if !point.normal.is_finite() || point.normal.try_normalize().is_none() {
            return wrong("its normal has no direction; give three finite numbers, not all zero");
        }
    }
    Ok(())
}
