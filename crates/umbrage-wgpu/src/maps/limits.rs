//! Limits of the device.

use umbrage::config::{Edges, Storage};

use super::place::{Place, Viewport};
use super::slot::Slot;
use super::storage::{Arrangement, Tile};
use super::targets;
use crate::{Error, Result};

/// Checks the limits of texture layers and of sampled textures.
pub(super) fn check_limits(
    device: &wgpu::Device,
    (storage, edges): (Storage, Edges),
    arrangement: &Arrangement,
) -> Result<()> {
    let limits = device.limits();
    let (layers, limit) = (targets::layers_needed(device, storage, arrangement), limits.max_texture_array_layers);
    if layers > limit {
        return Err(Error::TooManyLayers { count: layers, limit });
    }
    let (maps, limit) = (arrangement.tiles.len(), limits.max_sampled_textures_per_shader_stage);
    // Ids lie beside each map.
    let count = if edges.is_exact() { 2 * maps } else { maps };
    if storage == Storage::Separate && count > limit as usize {
        return Err(Error::TooManyTextures { maps, count, limit });
    }
    Ok(())
}

/// Checks that every size fits the device.
pub(super) fn check_sizes(slots: &[Slot], limits: &wgpu::Limits) -> Result<()> {
    let limit = limits.max_texture_dimension_2d;
    for slot in slots {
        if let Some((split, &size)) = slot.sizes.iter().enumerate().find(|&(_, &size)| size > limit) {
            return Err(Error::MapTooLarge { split, size, limit });
        }
    }
    Ok(())
}

/// Largest viewport for a guard band around every map; 0, for no guard band, in browsers: those
/// that are older than the rule reject a viewport that leaves its target.
pub(super) fn largest_viewport(device: &wgpu::Device) -> u32 {
    let in_browser = device.adapter_info().backend == wgpu::Backend::BrowserWebGpu;
    if in_browser { 0 } else { device.limits().max_texture_dimension_2d }
}

/// Places of the maps, each with as wide a guard band as the device allows.
pub(super) fn places(device: &wgpu::Device, sizes: &[u32], tiles: &[Tile]) -> Vec<Place> {
    let largest = largest_viewport(device);
    let place = |(&size, &tile)| Place { tile, viewport: Viewport::around(size, largest) };
    sizes.iter().zip(tiles).map(place).collect()
}
