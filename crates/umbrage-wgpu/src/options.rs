//! What is settled when the maps are made, and what may change with every frame.

use glam::DVec3;
use umbrage_shaders::layout::FilterKind;

use crate::{Error, Result};

/// How a map stores depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthFormat {
    /// Four bytes a texel.
    #[default]
    D32Float,
    /// Two bytes a texel and a step of 1/65535 of the depth range, which every comparison allows for.
    D16Unorm,
}

impl DepthFormat {
    /// wgpu's name for it.
    #[must_use]
    pub fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::D32Float => wgpu::TextureFormat::Depth32Float,
            Self::D16Unorm => wgpu::TextureFormat::Depth16Unorm,
        }
    }

    /// Bytes of one texel.
    #[must_use]
    pub fn texel_bytes(self) -> u64 {
        match self {
            Self::D32Float => 4,
            Self::D16Unorm => 2,
        }
    }

    /// The step between stored depths as a share of the depth range; 0 where it is no coarser than `f32`.
    pub(crate) fn step(self) -> f64 {
        match self {
            Self::D32Float => 0.0,
            Self::D16Unorm => 1.0 / 65535.0,
        }
    }
}

/// How soft a shadow's edge is, and what a sample costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// One nearest texel, one comparison: answers are 0 or 1.
    Hard,
    /// One linear comparison: 2×2 texels in one hardware tap.
    Pcf2,
    /// A tent of three texels in four hardware taps.
    #[default]
    Pcf3,
    /// A tent of five texels in nine hardware taps.
    Pcf5,
}

impl Filter {
    /// How far the filter reaches from the sample, in texels: what `umbrage::ShadowSettings::filter_radius` wants.
    #[must_use]
    pub const fn radius_texels(self) -> f64 {
        match self {
            Self::Hard => 0.5,
            Self::Pcf2 => 1.0,
            Self::Pcf3 => 1.5,
            Self::Pcf5 => 2.5,
        }
    }

    /// The smallest map that holds the filter once, in texels.
    pub(crate) fn least_size(self) -> u32 {
        match self {
            Self::Hard => 1,
            Self::Pcf2 => 3,
            Self::Pcf3 => 4,
            Self::Pcf5 => 6,
        }
    }

    pub(crate) fn kind(self) -> FilterKind {
        match self {
            Self::Hard => FilterKind::Hard,
            Self::Pcf2 => FilterKind::Pcf2,
            Self::Pcf3 => FilterKind::Pcf3,
            Self::Pcf5 => FilterKind::Pcf5,
        }
    }

    pub(crate) fn sampler_mode(self) -> wgpu::FilterMode {
        match self {
            Self::Hard => wgpu::FilterMode::Nearest,
            Self::Pcf2 | Self::Pcf3 | Self::Pcf5 => wgpu::FilterMode::Linear,
        }
    }
}

/// What is fixed when [`crate::ShadowMaps`] are made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShadowMapsOptions {
    /// Edge of each split's map in texels, nearest split first: the same list as `umbrage::ShadowSettings::map_sizes`.
    /// Memory is that of the largest times the number of maps, because they are layers of one texture.
    pub map_sizes: Vec<u32>,
    /// How maps store depth.
    pub depth_format: DepthFormat,
    /// How maps are read.
    pub filter: Filter,
}

impl Default for ShadowMapsOptions {
    fn default() -> Self {
        Self { map_sizes: vec![1024; 4], depth_format: DepthFormat::default(), filter: Filter::default() }
    }
}

/// What may change with every frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// The world point, in metres, that the positions in the app's shaders are relative to. Keep it within a kilometre or
    /// two of the eye, and move it in whole steps: between two steps static shadows stand still.
    pub origin: DVec3,
    /// Whether there are shadows; without them every surface that faces the light is lit.
    pub enabled: bool,
    /// Whether `umbrage_shadow` answers with a debug colour for each split.
    pub tint: bool,
    /// How dark a shadow is, 0 (not at all) to 1 (no light).
    pub strength: f32,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, enabled: true, tint: false, strength: 1.0 }
    }
}

impl FrameOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<()> {
        if let Some(value) = self.origin.to_array().into_iter().find(|v| !v.is_finite()) {
            return Err(Error::InvalidFrameOption { field: "origin", value, expected: "three finite numbers" });
        }
        if !(0.0..=1.0).contains(&self.strength) {
            return Err(Error::InvalidFrameOption {
                field: "strength",
                value: f64::from(self.strength),
                expected: "in 0..=1",
            });
        }
        Ok(())
    }
}
