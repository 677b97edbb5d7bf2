//! States and bind groups for the pipelines of casters and receivers.

use std::num::NonZeroU32;

use umbrage::config::DepthFormat;
#[cfg(doc)]
use umbrage::config::{Edges, Filter, Layout};

use super::ShadowMaps;
#[cfg(doc)]
use crate::Slice;
use crate::options::texture_format;

impl ShadowMaps {
    /// Layout of the bind group that [`ShadowMaps::caster_wgsl`] declares.
    #[must_use]
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.casters.layout
    }

    /// The bind group for drawing the casters of pass `pass`.
    ///
    /// # Panics
    /// If there is no such pass.
    #[must_use]
    pub fn caster_bind_group(&self, pass: usize) -> &wgpu::BindGroup {
        &self.casters.groups[pass]
    }

    /// Depth state for a pipeline that draws casters. It has no slope bias, because receivers
    /// account for their own slope.
    #[must_use]
    pub fn caster_depth_stencil(&self) -> wgpu::DepthStencilState {
        let format = self.config.depth_format;
        let format = if format.is_colour() { DepthFormat::D32Float } else { format };
        wgpu::DepthStencilState {
            format: texture_format(format),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// Multisample state for a pipeline that draws casters: [`Filter::samples`] samples per texel.
    #[must_use]
    pub fn caster_multisample(&self) -> wgpu::MultisampleState {
        wgpu::MultisampleState { count: self.config.filter.samples(), ..Default::default() }
    }

    /// Primitive state for a pipeline that draws casters: triangle lists, both faces (single-sided
    /// walls cast shadows, too).
    #[must_use]
    pub fn caster_primitive(&self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState { cull_mode: None, unclipped_depth: self.depth_clip_control, ..Default::default() }
    }

    /// Colour targets of a pipeline that draws casters: one with [`DepthFormat::R32Float`] or
    /// [`Edges::Exact`], otherwise none. With a target, casters need a fragment shader that returns
    /// `umbrage_caster_texel(at, id)` at location 0, a `UmbrageTexel`, of its `@builtin(position)`
    /// and the id of its vertices. A fragment shader that exists anyway, in order to discard, may
    /// return it in any config. A caster whose triangles cannot be tested has the id 0.
    #[must_use]
    pub fn caster_targets(&self) -> &[Option<wgpu::ColorTargetState>] {
        match &self.colour_target {
            Some(_) => std::slice::from_ref(&self.colour_target),
            None => &[],
        }
    }

    /// Multiview mask of a pipeline that draws casters.
    #[must_use]
    pub fn caster_multiview_mask(&self) -> Option<NonZeroU32> {
        self.multiview_mask
    }

    /// Layout of the bind group that [`ShadowMaps::receiver_wgsl`] declares, visible to vertex,
    /// fragment and compute shaders.
    #[must_use]
    pub fn receiver_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receivers.layout
    }

    /// The bind group for shaders that compute visibility. With [`Layout::Reused`] it gives the
    /// visibility of the map that was drawn last: bind [`ShadowMaps::slice_bind_group`] instead.
    #[must_use]
    pub fn receiver_bind_group(&self) -> &wgpu::BindGroup {
        &self.receivers.groups[0]
    }

    /// With [`Layout::Reused`], the bind group to use after pass `split` and before the next.
    /// Visibility is that of the slice whose map is there, and `umbrage_in_slice(position)` is
    /// false for fragments to discard because they belong to another slice. Draw slices front to
    /// back, each with the matrix and the depth range of its [`Slice`] ([`Slice::all`]). With any
    /// other storage it is [`ShadowMaps::receiver_bind_group`].
    ///
    /// # Panics
    /// If `split` is not less than [`ShadowMaps::splits`].
    #[must_use]
    pub fn slice_bind_group(&self, split: usize) -> &wgpu::BindGroup {
        assert!(split < self.splits(), "split {split} of {}", self.splits());
        self.receivers.groups.get(1 + split).unwrap_or(&self.receivers.groups[0])
    }
}
