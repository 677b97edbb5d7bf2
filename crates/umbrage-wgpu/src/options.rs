//! Options of a frame, and the config's choices as values for wgpu and for the shaders.

use glam::DVec3;
use umbrage::config::{DepthFormat, Filter, LightKind, MomentKind, ReceiverBias, Selection, SplitMetric, Transition};
use umbrage_shaders::layout::{BiasKind, FilterKind, MetricKind, SelectionKind, TransitionKind};

use crate::{Error, Result};

/// Texture format of a map's texels in wgpu.
#[must_use]
pub fn texture_format(format: DepthFormat) -> wgpu::TextureFormat {
    match format {
        DepthFormat::D32Float => wgpu::TextureFormat::Depth32Float,
        DepthFormat::D16Unorm => wgpu::TextureFormat::Depth16Unorm,
        DepthFormat::R32Float => wgpu::TextureFormat::R32Float,
    }
}

/// Step between stored depths as a share of the depth range; 0 if it is no coarser than `f32`.
pub(crate) fn depth_step(format: DepthFormat) -> f64 {
    match format {
        DepthFormat::D32Float | DepthFormat::R32Float => 0.0,
        DepthFormat::D16Unorm => 1.0 / 65535.0,
    }
}

/// Reach in texels of the narrowest disc: that of one tap, plus the tap's own.
const LEAST_REACH: f64 = 2.0;

/// Texels around a sample that the shader may read if a map was planned to keep `planned` free.
pub(crate) fn reach_within(filter: &Filter, planned: f64) -> f64 {
    match filter {
        Filter::Disc { .. } | Filter::Pcss { .. } => planned.clamp(LEAST_REACH, 16.0),
        _ => filter.radius_texels(),
    }
}

/// The filter as the shaders' enum.
pub(crate) fn filter_kind(filter: &Filter) -> FilterKind {
    match filter {
        Filter::Hard => FilterKind::Hard,
        Filter::Pcf2 => FilterKind::Pcf2,
        Filter::Pcf3 { .. } => FilterKind::Pcf3,
        Filter::Pcf5 { .. } => FilterKind::Pcf5,
        Filter::Pcf7 { .. } => FilterKind::Pcf7,
        Filter::Castano5 => FilterKind::Castano5,
        Filter::Disc { .. } => FilterKind::Disc,
        Filter::Pcss { .. } => FilterKind::Pcss,
        Filter::Moments(moments) => match moments.kind {
            MomentKind::Esm => FilterKind::Esm,
            MomentKind::Vsm => FilterKind::Vsm,
            MomentKind::Evsm2 => FilterKind::Evsm2,
            MomentKind::Evsm4 => FilterKind::Evsm4,
            MomentKind::Msm => FilterKind::Msm,
        },
    }
}

/// Filter mode of the sampler that compares depth.
pub(crate) fn sampler_mode(filter: &Filter) -> wgpu::FilterMode {
    match filter {
        Filter::Hard => wgpu::FilterMode::Nearest,
        _ => wgpu::FilterMode::Linear,
    }
}

/// The transition as the shaders' enum.
pub(crate) fn transition_kind(transition: Transition) -> TransitionKind {
    match transition {
        Transition::Blend { .. } => TransitionKind::Blend,
        Transition::Dither { .. } => TransitionKind::Dither,
        Transition::Hard => TransitionKind::Hard,
    }
}

/// The selection as the shaders' enum.
pub(crate) fn selection_kind(selection: Selection) -> SelectionKind {
    match selection {
        Selection::Interval(_) => SelectionKind::Depth,
        Selection::Map => SelectionKind::Map,
    }
}

/// The measure of splits as the shaders' enum.
pub(crate) fn metric_kind(metric: SplitMetric) -> MetricKind {
    match metric {
        SplitMetric::ViewDepth => MetricKind::ViewDepth,
        SplitMetric::Distance => MetricKind::Distance,
    }
}

/// The bias as the shaders' enum.
pub(crate) fn bias_kind(bias: ReceiverBias) -> BiasKind {
    match bias {
        ReceiverBias::Plane => BiasKind::Plane,
        ReceiverBias::Slope => BiasKind::Slope,
    }
}

/// The maps of one light.
///
/// Maps for a spot light also serve a directional light; those for a point light serve any light.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LightMaps {
    /// Kind of light for which the maps are made. A point light has six times the maps of the
    /// others.
    pub kind: LightKind,
    /// Edge of each split's map in texels, nearest split first; `None` for the config's
    /// [`umbrage::ShadowConfig::map_sizes`].
    pub map_sizes: Option<Vec<u32>>,
}

impl LightMaps {
    /// Maps with other sizes, and another number of splits, than the config's.
    #[must_use]
    pub fn with_sizes(kind: LightKind, map_sizes: &[u32]) -> Self {
        Self { kind, map_sizes: Some(map_sizes.to_vec()) }
    }

    /// Checks that these maps serve a light of this kind. `light` is its index in the frame.
    pub(crate) fn check(&self, light: usize, given: LightKind) -> Result<()> {
        if given.faces() > self.kind.faces() || (given.is_local() && !self.kind.is_local()) {
            return Err(Error::LightKind { light, given, made_for: self.kind });
        }
        Ok(())
    }
}

impl From<LightKind> for LightMaps {
    fn from(kind: LightKind) -> Self {
        Self { kind, map_sizes: None }
    }
}

impl From<umbrage::Light> for LightMaps {
    fn from(light: umbrage::Light) -> Self {
        LightKind::from(light).into()
    }
}

/// Options of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// World point in metres to which positions in the application's shaders are relative. Keep it
    /// within a kilometre or two of the camera and move it in whole steps: static shadows stand
    /// still between two steps.
    pub origin: DVec3,
    /// True if there are shadows. Otherwise every surface that faces the light is lit.
    pub enabled: bool,
    /// True if `umbrage_shadow` returns a debug colour for each split.
    pub tint: bool,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, enabled: true, tint: false }
    }
}

impl FrameOptions {
    /// Checks every field.
    ///
    /// # Errors
    /// [`Error::InvalidFrameOption`] naming the first field that is wrong.
    pub fn validate(&self) -> Result<()> {
        match self.origin.to_array().into_iter().find(|v| !v.is_finite()) {
            Some(value) => Err(Error::InvalidFrameOption { field: "origin", value, expected: "three finite numbers" }),
            None => Ok(()),
        }
    }
}
