//! Textures of the maps, and the attachments of each pass.

use umbrage::config::{DepthFormat, Edges, Generation, ShadowConfig, Storage};

use super::passes::MapPass;
use super::storage::Arrangement;
use crate::options::texture_format;

/// Format of the ids of runs of triangles, see [`umbrage_shaders::layout::RUN_BITS`].
pub(super) const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// The textures of all maps.
#[derive(Debug)]
pub(super) struct Targets {
    /// One texture; for separate maps, or several samples per texel, one for each split.
    pub maps: Vec<wgpu::Texture>,
    separate: bool,
    /// Depth buffers beside colour maps.
    depths: Vec<wgpu::Texture>,
    /// Ids of the runs that the maps' texels show, with exact edges: a texture for each of `maps`.
    pub ids: Vec<wgpu::Texture>,
    attachments: Vec<Attachments>,
}

/// Attachments of one pass.
#[derive(Debug)]
struct Attachments {
    /// Colour map, or the ids beside depth.
    colour: Option<wgpu::TextureView>,
    /// Clear value, of texels without a caster.
    clear: wgpu::Color,
    depth: wgpu::TextureView,
    /// True if an earlier pass has drawn other tiles.
    keeps: bool,
}

impl Targets {
    /// Creates the textures. `sizes` are the edges of all maps; the layout's `storage`, the
    /// `edges`, `it` and `passes` have been chosen.
    pub fn new(
        device: &wgpu::Device,
        config: &ShadowConfig,
        (storage, edges): (Storage, Edges),
        sizes: &[u32],
        it: &Arrangement,
        passes: &[MapPass],
    ) -> Self {
        let (format, samples) = (config.depth_format, config.filter.samples());
        let backend = device.adapter_info().backend;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = usage | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        // What has several samples cannot be copied.
        let read = if samples > 1 { read.difference(wgpu::TextureUsages::COPY_SRC) } else { read };
        let map = |texels, layers| {
            texture(device, "ShadowMaps::maps", texture_format(format), texels, [layers, samples], read)
        };
        // Several samples and several layers do not go together in one texture.
        let separate = storage == Storage::Separate || samples > 1;
        let maps: Vec<wgpu::Texture> = match storage {
            _ if separate => sizes.iter().map(|&size| map([size; 2], 1)).collect(),
            Storage::Cube => vec![map(it.layer_texels, it.layers)],
            _ => vec![map(it.layer_texels, array_layers(it.layers, it.layer_texels, backend))],
        };
        let id = |map: &wgpu::Texture| {
            let texels = [map.width(), map.height()];
            texture(device, "ShadowMaps::ids", ID_FORMAT, texels, [map.depth_or_array_layers(), 1], read)
        };
        let ids: Vec<wgpu::Texture> = if edges.is_exact() { maps.iter().map(id).collect() } else { Vec::new() };
        // Passes follow each other, so that those of one size share a depth buffer.
        let mut depths: Vec<wgpu::Texture> = Vec::new();
        let attachments = passes
            .iter()
            .map(|pass| {
                let tile = it.tiles[pass.splits().start];
                let (number, first) = if separate { (tile.layer as usize, 0) } else { (0, tile.layer) };
                let map = &maps[number];
                let views = pass.views() as u32;
                let keeps = storage == Storage::Atlas && pass.is_alone() && pass.splits().start > 0;
                if !format.is_colour() {
                    let colour = ids.get(number).map(|ids| view(ids, first, views));
                    return Attachments { colour, clear: NO_ID, depth: view(map, first, views), keeps };
                }
                let same_size = |depth: &wgpu::Texture| depth.width() == map.width() && depth.height() == map.height();
                let index = depths.iter().position(same_size).unwrap_or_else(|| {
                    let format = texture_format(DepthFormat::D32Float);
                    let texels = [map.width(), map.height()];
                    depths.push(texture(device, "ShadowMaps::depth", format, texels, [views, 1], usage));
                    depths.len() - 1
                });
                let (colour, depth) = (Some(view(map, first, views)), view(&depths[index], 0, views));
                Attachments { colour, clear: wgpu::Color::WHITE, depth, keeps }
            })
            .collect();
        Self { maps, separate, depths, ids, attachments }
    }

    /// The texture that contains a tile's layer.
    pub fn map(&self, layer: u32) -> &wgpu::Texture {
        &self.maps[if self.separate { layer as usize } else { 0 }]
    }

    /// The texture of ids beside the map of a tile's layer.
    pub fn id(&self, layer: u32) -> Option<&wgpu::Texture> {
        self.ids.get(if self.separate { layer as usize } else { 0 })
    }

    /// Index of a tile's layer in its texture.
    pub fn layer(&self, layer: u32) -> u32 {
        if self.separate { 0 } else { layer }
    }

    /// Views of each split's layer alone.
    pub fn splits(&self, it: &Arrangement) -> Vec<wgpu::TextureView> {
        it.tiles.iter().map(|tile| view(self.map(tile.layer), self.layer(tile.layer), 1)).collect()
    }

    /// Memory of all textures in bytes.
    pub fn bytes(&self) -> u64 {
        let bytes = |texture: &wgpu::Texture| {
            let size = texture.size();
            let texel = texture.format().block_copy_size(Some(aspect(texture))).unwrap_or(4);
            u64::from(size.width)
                * u64::from(size.height)
                * u64::from(size.depth_or_array_layers)
                * u64::from(texel * texture.sample_count())
        };
        self.maps.iter().chain(&self.depths).chain(&self.ids).map(bytes).sum()
    }

    /// Begins pass `index`. It is cleared to the farthest depth, or not cleared if the whole map is
    /// about to be written.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        (index, is_cleared): (usize, bool),
        multiview_mask: Option<std::num::NonZeroU32>,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let Attachments { colour, clear, depth, keeps } = &self.attachments[index];
        let store = wgpu::StoreOp::Store;
        let keeps = *keeps || !is_cleared;
        let colour_load = if keeps { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(*clear) };
        let colour = colour.as_ref().map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: colour_load, store },
        });
        let load = if keeps { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(1.0) };
        let colours = colour.map(Some);
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ShadowMaps::pass"),
            color_attachments: colours.as_slice(),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load, store }),
                stencil_ops: None,
            }),
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask,
        })
    }
}

/// Id of texels without a caster, or with one whose triangles cannot be tested.
const NO_ID: wgpu::Color = wgpu::Color::TRANSPARENT;

/// Aspect of a texture that is copied.
fn aspect(texture: &wgpu::Texture) -> wgpu::TextureAspect {
    if texture.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All }
}

pub(super) fn texture(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    [width, height]: [u32; 2],
    [layers, samples]: [u32; 2],
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Layers `first` to `first + count` as one attachment.
fn view(texture: &wgpu::Texture, first: u32, count: u32) -> wgpu::TextureView {
    let dimension = if count > 1 { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 };
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some("ShadowMaps::layers"),
        dimension: Some(dimension),
        base_array_layer: first,
        array_layer_count: Some(count),
        ..Default::default()
    })
}

/// Number of array layers to request. wgpu guesses a GL texture's kind from its number of layers:
/// one layer is no array, and a multiple of six squares is a cube. A spare layer makes it an array.
fn array_layers(layers: u32, [width, height]: [u32; 2], backend: wgpu::Backend) -> u32 {
    let mistaken = layers == 1 || (layers.is_multiple_of(6) && width == height);
    if backend == wgpu::Backend::Gl && mistaken { layers + 1 } else { layers }
}

/// Number of layers that a texture needs with these options.
pub(super) fn layers_needed(device: &wgpu::Device, storage: Storage, it: &Arrangement) -> u32 {
    match storage {
        Storage::Separate => 1,
        Storage::Cube => it.layers,
        _ => array_layers(it.layers, it.layer_texels, device.adapter_info().backend),
    }
}

/// Mask of the views that a pipeline for casters, and every pass, draws into.
pub(super) fn multiview_mask(generation: Generation, passes: &[MapPass]) -> Option<std::num::NonZeroU32> {
    let several = matches!(generation, Generation::Layered | Generation::Mixed);
    let views = passes.first().map_or(1, MapPass::views);
    several.then(|| std::num::NonZeroU32::new((1 << views) - 1)).flatten()
}
