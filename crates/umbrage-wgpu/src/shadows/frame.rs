//! A frame that was prepared, and its maps.

use std::ops::Range;
use std::sync::Arc;

use umbrage::{ShadowPlan, View};

use super::{Shadows, draws};
use crate::Slice;

/// A frame that was prepared.
#[derive(Clone, Copy, Debug)]
pub struct ShadowFrame<'a> {
    shadows: &'a Shadows,
}

impl<'a> ShadowFrame<'a> {
    pub(super) fn new(shadows: &'a Shadows) -> Self {
        Self { shadows }
    }

    /// The maps to draw, in this order; none without shadows. Maps of several lights that no caster
    /// reaches are omitted: nothing reads them.
    pub fn maps(&self) -> impl Iterator<Item = ShadowMap<'a>> + use<'a> {
        let shadows = self.shadows;
        shadows.draws.passes.iter().map(move |&pass| ShadowMap { shadows, pass })
    }

    /// The map pass of index `pass`, whether it has casters or not.
    ///
    /// # Panics
    /// If there is no such pass.
    #[must_use]
    pub fn map(&self, pass: usize) -> ShadowMap<'a> {
        assert!(pass < self.shadows.maps.passes().len(), "there are {} passes", self.shadows.maps.passes().len());
        ShadowMap { shadows: self.shadows, pass }
    }

    /// The plan of a light.
    ///
    /// # Panics
    /// If there is no such light, or no frame was prepared.
    #[must_use]
    pub fn plan(&self, light: usize) -> &'a ShadowPlan {
        &self.shadows.plans[light]
    }

    /// [`ShadowFrame::plan`] to keep beyond the frame.
    ///
    /// # Panics
    /// If there is no such light, or no frame was prepared.
    #[must_use]
    pub fn shared_plan(&self, light: usize) -> Arc<ShadowPlan> {
        Arc::clone(&self.shadows.plans[light])
    }

    /// The slices in which the picture is drawn where one map is used for one split after the other
    /// ([`umbrage::config::Layout::Reused`]); none with any other layout and none without shadows.
    /// Draw [`ShadowFrame::map`] of a slice's split, then what of the picture lies in it, front to
    /// back.
    #[must_use]
    pub fn slices(&self, view: &View) -> Vec<Slice> {
        let is_sliced = self.shadows.enabled && self.shadows.maps.layout() == umbrage::config::Layout::Reused;
        if is_sliced { Slice::all(self.plan(0), view) } else { Vec::new() }
    }
}

/// One pass that draws casters: into one map, or with a layered, instanced or mixed layout into
/// those of several splits at once.
#[derive(Clone, Copy, Debug)]
pub struct ShadowMap<'a> {
    shadows: &'a Shadows,
    pass: usize,
}

impl<'a> ShadowMap<'a> {
    /// Its index among all map passes.
    #[must_use]
    pub fn index(&self) -> usize {
        self.pass
    }

    /// The light that it is of.
    #[must_use]
    pub fn light(&self) -> usize {
        self.place().0
    }

    /// The splits of the light's plan that it draws: one with layouts that draw one map a pass.
    #[must_use]
    pub fn splits(&self) -> Range<usize> {
        let (_, first) = self.place();
        first..first + self.shadows.maps.passes()[self.pass].splits().len()
    }

    fn place(&self) -> (usize, usize) {
        self.shadows.maps.light_of_map(self.shadows.maps.passes()[self.pass].splits().start)
    }

    /// The casters, by index into [`crate::Inputs::casters`] or by the keys of its set, each
    /// with the instances that it is drawn with.
    pub fn casters(&self) -> impl ExactSizeIterator<Item = (u32, Range<u32>)> + use<'a> {
        self.shadows.draws.of_pass(self.pass).iter().cloned()
    }

    /// The casters as ranges of [`crate::Inputs::casters`], for an application whose instance buffer
    /// has one row for each caster, in their order: one draw of a mesh draws a range of rows.
    ///
    /// `None` with layered, instanced and mixed layouts. Instances of draws then say which splits a
    /// caster belongs to, and [`ShadowMap::casters`] has them: draw one caster at a time. Matrices
    /// that are attributes follow those instances there, so the instance buffer has `array_stride`
    /// 0 in the casters' pipeline, and each draw binds the caster's own row.
    ///
    /// ```no_run
    /// # use umbrage_wgpu::{ShadowMap, wgpu};
    /// # fn draw(map: &ShadowMap<'_>, pass: &mut wgpu::RenderPass<'_>, rows: &wgpu::Buffer, row_bytes: u64) {
    /// match map.rows() {
    ///     Some(ranges) => ranges.for_each(|range| pass.draw_indexed(0..36, 0, range)),
    ///     None => {
    ///         for (caster, instances) in map.casters() {
    ///             pass.set_vertex_buffer(1, rows.slice(u64::from(caster) * row_bytes..));
    ///             pass.draw_indexed(0..36, 0, instances);
    ///         }
    ///     }
    /// }
    /// # }
    /// ```
    #[must_use]
    pub fn rows(&self) -> Option<impl Iterator<Item = Range<u32>> + use<'a>> {
        let is_alone = self.shadows.maps.passes()[self.pass].is_alone();
        is_alone.then(|| draws::rows(self.shadows.draws.of_pass(self.pass)))
    }

    /// The group that [`Shadows::caster_wgsl`] declares, for this map.
    #[must_use]
    pub fn bind_group(&self) -> &'a wgpu::BindGroup {
        self.shadows.maps.caster_bind_group(self.pass)
    }

    /// Begins the pass: the map is cleared, viewport and scissor are set and have to stay.
    pub fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.begin_timed(encoder, None)
    }

    /// [`ShadowMap::begin`] with timestamps.
    pub fn begin_timed<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        self.shadows.maps.begin_pass(encoder, self.pass, timestamp_writes)
    }
}
