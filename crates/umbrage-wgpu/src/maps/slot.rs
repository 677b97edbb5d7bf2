//! Assignment of maps and frames to lights.

use umbrage::config::{LightKind, ShadowConfig};
use umbrage_shaders::layout;

use crate::{Error, LightMaps, Result};

/// Range of one light's maps and frames among those of all lights.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Slot {
    pub kind: LightKind,
    /// Edge of each split's map in texels.
    pub sizes: Vec<u32>,
    /// Index of the map of the light's first split.
    pub first_map: usize,
    /// Index of the frame of the light's first face.
    pub first_frame: usize,
}

impl Slot {
    /// The slots of all lights, after every rule that they share has been checked.
    pub fn all(config: &ShadowConfig, lights: &[LightMaps], limits: &wgpu::Limits) -> Result<Vec<Self>> {
        let kinds: Vec<LightKind> = lights.iter().map(|light| light.kind).collect();
        let (mut slots, mut first_map, mut first_frame) = (Vec::new(), 0, 0);
        for light in lights {
            let sizes = light.map_sizes.as_ref().unwrap_or(&config.map_sizes);
            config.with_map_sizes(sizes).0.validate_shared(&kinds)?;
            slots.push(Self { kind: light.kind, sizes: sizes.clone(), first_map, first_frame });
            first_map += light.kind.faces() * sizes.len();
            first_frame += light.kind.faces();
        }
        let bytes = (first_frame * size_of::<layout::Frame>()) as u64;
        let limit = limits.max_uniform_buffer_binding_size;
        if first_frame == 0 || bytes > limit {
            return Err(Error::TooManyLights { frames: first_frame, bytes, limit });
        }
        Ok(slots)
    }

    /// Edges of the light's maps, face after face.
    pub fn map_sizes(&self) -> impl Iterator<Item = u32> {
        (0..self.kind.faces()).flat_map(|_| self.sizes.iter().copied())
    }

    /// Number of the light's maps.
    pub fn map_count(&self) -> usize {
        self.kind.faces() * self.sizes.len()
    }
}
