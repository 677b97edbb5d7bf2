//! Textures with the depth drawn by static casters, one for each split, and the passes that copy
//! them into the maps: [`umbrage::config::Cache::Kept`].

use glam::DVec2;
use umbrage::config::DepthFormat;
use umbrage::{Keeper, KeptMap, KeptRegion, ShadowPlan};
use umbrage_shaders::{KEPT_PASS, layout};

use super::groups::Uniforms;
use super::place::{Place, Viewport};
use super::storage::Tile;
use super::{ShadowMaps, targets};
use crate::options::{depth_step, texture_format};
use crate::{Error, FrameOptions, Result, device, uniforms};

/// Most turns of the torus that a window meets: two along each axis.
const TURNS: usize = 4;

/// Kept textures of all splits.
#[derive(Debug)]
pub(super) struct KeptMaps {
    textures: Vec<KeptTexture>,
    /// Uniforms of each split's regions for casters, one for each turn.
    casters: Uniforms,
    windows: wgpu::Buffer,
    window_stride: u64,
    clear: wgpu::RenderPipeline,
    copy: wgpu::RenderPipeline,
}

/// Kept texture of one split.
#[derive(Debug)]
struct KeptTexture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Place of regions: the whole texture is one map.
    place: Place,
    /// Bind group with the position of the map in the texture.
    window: wgpu::BindGroup,
    /// The map's upper left corner in its layer.
    corner: [u32; 2],
}

impl KeptMaps {
    /// Kept textures for the maps of one sun, `sizes` wide at these `tiles`; `layout` is that of
    /// casters' bind groups.
    pub fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        (sizes, tiles): (&[u32], &[Tile]),
        largest: u32,
    ) -> Result<Self> {
        let limit = device.limits().max_texture_dimension_2d;
        for (split, &size) in sizes.iter().enumerate() {
            let kept = Keeper::texture_edge(size);
            if kept > limit {
                return Err(Error::KeptMapTooLarge { split, size, kept, limit });
            }
        }
        let stride = u64::from(device.limits().min_uniform_buffer_offset_alignment);
        let bytes = size_of::<layout::KeptWindow>() as u64;
        let window_stride = bytes.next_multiple_of(stride);
        let windows = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("KeptMaps::windows"),
            size: window_stride * sizes.len() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group_layout = group_layout(device, bytes);
        let textures = sizes.iter().zip(tiles).enumerate().map(|(split, (&size, tile))| {
            let edge = Keeper::texture_edge(size);
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            let format = texture_format(DepthFormat::D32Float);
            let texture = targets::texture(device, "KeptMaps::texture", format, [edge; 2], [1, 1], usage);
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            let window = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &windows,
                offset: split as u64 * window_stride,
                size: wgpu::BufferSize::new(bytes),
            });
            let window = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("KeptMaps::window"),
                layout: &group_layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: window },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
                ],
            });
            let tile_of_all = Tile { layer: 0, corner: [0; 2], layer_texels: [edge; 2] };
            let place = Place { tile: tile_of_all, viewport: Viewport::of_power(edge, largest) };
            KeptTexture { texture, view, place, window, corner: tile.corner }
        });
        let textures = textures.collect();
        let casters = Uniforms::of_regions(device, layout.clone(), TURNS * sizes.len());
        let [clear, copy] = pipelines(device, &group_layout);
        Ok(Self { textures, casters, windows, window_stride, clear, copy })
    }

    /// Memory of the textures in bytes.
    pub fn bytes(&self) -> u64 {
        let texel = DepthFormat::D32Float.texel_bytes();
        self.textures.iter().map(|it| u64::from(it.texture.width()) * u64::from(it.texture.height()) * texel).sum()
    }

    /// Writes a frame to the GPU.
    pub fn write(&self, queue: &wgpu::Queue, plan: &ShadowPlan, keeper: &Keeper, options: &FrameOptions) -> Result<()> {
        let mut written = None;
        for region in keeper.regions() {
            let group = group_of(region);
            if written == Some(group) {
                continue;
            }
            written = Some(group);
            let kept = &self.textures[region.split];
            let edge = kept.texture.width();
            let corner = DVec2::from(region.turn.map(|turn| (turn * i64::from(edge)) as f64));
            let mut whole = plan.splits[region.split].clone();
            (whole.size, whole.min_texel) = (edge, corner);
            let step = depth_step(DepthFormat::D32Float);
            let uniform = uniforms::split(region.split, &whole, step, kept.place, options.origin)?;
            self.casters.write(queue, group, &[uniform])?;
        }
        for (split, (kept, KeptMap { begin, edge, .. })) in self.textures.iter().zip(keeper.maps()).enumerate() {
            let window = layout::KeptWindow {
                begin: begin.map(|at| at as i32),
                corner: kept.corner.map(|at| at as i32),
                edge: *edge as i32,
                ..layout::KeptWindow::default()
            };
            let offset = split as u64 * self.window_stride;
            device::write(queue, &self.windows, offset, bytemuck::bytes_of(&window))?;
        }
        Ok(())
    }

    /// The bind group for drawing the casters of a region.
    pub fn caster_bind_group(&self, region: &KeptRegion) -> &wgpu::BindGroup {
        &self.casters.groups[group_of(region)]
    }

    /// Begins a region: it is cleared; the rest of its texture stays unchanged.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        region: &KeptRegion,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let kept = &self.textures[region.split];
        let depth = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("KeptMaps::region"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &kept.view,
                depth_ops: Some(depth),
                stencil_ops: None,
            }),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        let Viewport { edge, guard } = kept.place.viewport;
        let (corner, edge) = (-(guard as f32), edge as f32);
        pass.set_viewport(corner, corner, edge, edge, 0.0, 1.0);
        let [width, height] = region.place.edges();
        let [left, top] = region.place.min.map(|at| at as u32);
        pass.set_scissor_rect(left, top, width, height);
        pass.set_pipeline(&self.clear);
        pass.draw(0..3, 0..1);
        pass
    }

    /// Copies the map's window of a split's texture, in a pass over the map whose viewport and
    /// scissor are set.
    pub fn copy(&self, pass: &mut wgpu::RenderPass<'_>, split: usize) {
        pass.set_pipeline(&self.copy);
        pass.set_bind_group(0, &self.textures[split].window, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl ShadowMaps {
    /// Begins a pass over one map with its kept depth.
    pub(crate) fn begin_kept<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: usize,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let mut render = self.begin(encoder, (pass, self.kept.is_none()), timestamp_writes);
        if let Some(kept) = &self.kept {
            kept.copy(&mut render, self.passes[pass].splits().start);
        }
        render
    }

    /// Begins a region of a kept texture; `None` if nothing is kept.
    pub(crate) fn begin_region<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        region: &KeptRegion,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> Option<wgpu::RenderPass<'e>> {
        Some(self.kept.as_ref()?.begin(encoder, region, timestamp_writes))
    }

    /// The bind group for drawing the casters of a region; `None` if nothing is kept.
    pub(crate) fn region_bind_group(&self, region: &KeptRegion) -> Option<&wgpu::BindGroup> {
        Some(self.kept.as_ref()?.caster_bind_group(region))
    }

    /// Empty bookkeeping for the kept maps; `None` if nothing is kept.
    pub(crate) fn keeper(&self) -> Option<Keeper> {
        self.kept.as_ref().map(|_| Keeper::new(self.map_sizes(0)))
    }

    /// Writes the uniforms of regions and maps to the GPU.
    pub(crate) fn prepare_kept(
        &self,
        queue: &wgpu::Queue,
        plan: &ShadowPlan,
        keeper: &Keeper,
        options: &FrameOptions,
    ) -> Result<()> {
        let Some(kept) = &self.kept else { return Ok(()) };
        device::guarded(&self.device, "preparing kept maps", || kept.write(queue, plan, keeper, options))
    }
}

/// Index of a region's uniform: neighbouring turns differ in whether they are even.
fn group_of(region: &KeptRegion) -> usize {
    let [u, v] = region.turn.map(|turn| turn.rem_euclid(2) as usize);
    TURNS * region.split + 2 * v + u
}

fn group_layout(device: &wgpu::Device, bytes: u64) -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let window = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(bytes),
    };
    let kept = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("KeptMaps::window"),
        entries: &[entry(0, window), entry(1, kept)],
    })
}

/// The pipelines that clear a region and copy a map.
fn pipelines(device: &wgpu::Device, group: &wgpu::BindGroupLayout) -> [wgpu::RenderPipeline; 2] {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("KeptMaps::shader"),
        source: wgpu::ShaderSource::Wgsl(KEPT_PASS.into()),
    });
    let pipeline = |label, groups: &[Option<&wgpu::BindGroupLayout>], copies: bool| {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: groups,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_all"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: texture_format(DepthFormat::D32Float),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: Default::default(),
            fragment: copies.then_some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs_copy"),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    [pipeline("KeptMaps::clear", &[], false), pipeline("KeptMaps::copy", &[Some(group)], true)]
}
