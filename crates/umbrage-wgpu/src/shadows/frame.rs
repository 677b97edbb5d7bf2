//! A prepared frame, and its maps.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use umbrage::{Aabb, KeptRegion, ShadowPlan, View};

use super::{Shadows, draws};
use crate::Slice;

/// A prepared frame.
#[derive(Clone, Copy, Debug)]
pub struct ShadowFrame<'a> {
    shadows: &'a Shadows,
}

impl<'a> ShadowFrame<'a> {
    pub(super) fn new(shadows: &'a Shadows) -> Self {
        Self { shadows }
    }

    /// The maps to draw, in this order; none if shadows are disabled. With several lights, maps
    /// that no caster reaches are omitted, because nothing reads them. With
    /// [`umbrage::config::Cache::Kept`] the regions of kept maps come first, and unchanged maps are
    /// omitted, so there may be nothing to draw for many frames.
    pub fn maps(&self) -> impl Iterator<Item = ShadowMap<'a>> + use<'a> {
        let shadows = self.shadows;
        shadows.draws.passes.iter().map(move |&pass| ShadowMap { shadows, pass })
    }

    /// The map pass of index `pass`, with or without casters. The passes of
    /// [`crate::ShadowMaps::passes`] come first, then those of this frame's kept regions.
    ///
    /// # Panics
    /// If there is no such pass.
    #[must_use]
    pub fn map(&self, pass: usize) -> ShadowMap<'a> {
        assert!(pass < self.pass_count(), "there are {} passes", self.pass_count());
        ShadowMap { shadows: self.shadows, pass }
    }

    /// Number of passes; [`ShadowFrame::map`] takes an index below it.
    #[must_use]
    pub fn pass_count(&self) -> usize {
        self.shadows.maps.passes().len() + self.shadows.regions().len()
    }

    /// Returns whether the maps of this frame are copied from kept textures
    /// ([`umbrage::config::Cache::Kept`]).
    #[must_use]
    pub fn is_kept(&self) -> bool {
        self.shadows.is_kept
    }

    /// Returns whether all maps are filled. With a budget ([`crate::Inputs::kept_texels`]) coarser
    /// kept maps may answer for others for some frames, as after a step of the sun: see
    /// [`umbrage::SteppedSun::follow_filled`].
    #[must_use]
    pub fn is_filled(&self) -> bool {
        self.shadows.planning.plans().iter().all(|plan| plan.is_filled())
    }

    /// The plan of a light.
    ///
    /// # Panics
    /// If there is no such light, or no frame was prepared.
    #[must_use]
    pub fn plan(&self, light: usize) -> &'a ShadowPlan {
        &self.shadows.planning.plans()[light]
    }

    /// [`ShadowFrame::plan`] as a shared pointer, to keep beyond the frame.
    ///
    /// # Panics
    /// If there is no such light, or no frame was prepared.
    #[must_use]
    pub fn shared_plan(&self, light: usize) -> Arc<ShadowPlan> {
        Arc::clone(&self.shadows.planning.plans()[light])
    }

    /// The slices in which the image is drawn if one map is used for one split after the other
    /// ([`umbrage::config::Layout::Reused`]); none with any other layout, and none if shadows are
    /// disabled. Draw [`ShadowFrame::map`] of a slice's split, then the part of the image in the
    /// slice, front to back.
    #[must_use]
    pub fn slices(&self, view: &View) -> Vec<Slice> {
        let is_sliced = self.shadows.enabled && self.shadows.maps.layout() == umbrage::config::Layout::Reused;
        if is_sliced { Slice::all(self.plan(0), view) } else { Vec::new() }
    }
}

/// Casters of a map that are drawn with one shape.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShapeDraw<S> {
    /// The chosen shape.
    pub shape: S,
    /// The casters with their instances, as in [`ShadowMap::casters`].
    pub casters: Vec<(u32, Range<u32>)>,
}

impl<S> ShapeDraw<S> {
    /// The casters as ranges of neighbours, for the layouts of [`ShadowMap::rows`].
    pub fn rows(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        draws::rows(&self.casters)
    }
}

/// One pass that draws casters: into one map, or with a layered, instanced or mixed layout into the
/// maps of several splits at once.
#[derive(Clone, Copy, Debug)]
pub struct ShadowMap<'a> {
    shadows: &'a Shadows,
    pass: usize,
}

impl<'a> ShadowMap<'a> {
    /// Index of the pass among all map passes; see [`ShadowFrame::map`].
    #[must_use]
    pub fn index(&self) -> usize {
        self.pass
    }

    /// Index of the light.
    #[must_use]
    pub fn light(&self) -> usize {
        self.place().0
    }

    /// Splits of the light's plan that the pass draws: one with layouts that draw one map per pass.
    #[must_use]
    pub fn splits(&self) -> Range<usize> {
        if let Some(region) = self.region() {
            return region.split..region.split + 1;
        }
        let (_, first) = self.place();
        first..first + self.shadows.maps.passes()[self.pass].splits().len()
    }

    /// Longer edge of a texel in metres; with several splits, that of the finest. Details of a
    /// caster that are smaller cast no shadow of their own: draw a coarser shape
    /// ([`ShadowMap::shapes`]).
    #[must_use]
    pub fn texel_m(&self) -> f64 {
        let splits = &self.shadows.planning.plans()[self.light()].splits;
        let texels = splits.iter().take(self.splits().end).skip(self.splits().start);
        texels.map(|split| split.texel_m.max_element()).fold(f64::INFINITY, f64::min)
    }

    /// Returns whether this is a region of a kept texture, and not a map itself.
    #[must_use]
    pub fn is_region(&self) -> bool {
        self.region().is_some()
    }

    /// Returns whether a part of one of the casters, given by its world box, has to be drawn: in a
    /// region by [`umbrage::KeptRegion::casts_into`], in a map by [`ShadowPlan::casts_into`].
    /// Skipping what it rejects never changes a visible pixel or a kept texel.
    #[must_use]
    pub fn casts_into(&self, part: &Aabb) -> bool {
        match self.region() {
            Some(region) => region.casts_into(part),
            None => self.splits().any(|split| self.shadows.planning.plans()[self.light()].casts_into(split, part)),
        }
    }

    fn region(&self) -> Option<&'a KeptRegion> {
        let first = self.shadows.maps.passes().len();
        self.shadows.regions().get(self.pass.checked_sub(first)?)
    }

    fn place(&self) -> (usize, usize) {
        if self.is_region() {
            return (0, self.splits().start);
        }
        self.shadows.maps.light_of_map(self.shadows.maps.passes()[self.pass].splits().start)
    }

    /// The casters, by index into [`crate::Inputs::casters`] or by the keys of its set, each with
    /// the instances to draw.
    pub fn casters(&self) -> impl ExactSizeIterator<Item = (u32, Range<u32>)> + use<'a> {
        self.shadows.draws.of_pass(self.pass).iter().cloned()
    }

    /// The casters grouped by shape, for applications with coarser shapes of their casters.
    /// `choose` gets a caster and the edge of a texel ([`ShadowMap::texel_m`]) and returns the
    /// shape to draw into the map. Draws come shape by shape, each with its casters in the order of
    /// [`ShadowMap::casters`].
    ///
    /// A shape whose outline differs from the finest by less than a quarter of a texel leaves the
    /// same shadow, except for texels along its edge. With [`umbrage::config::Cache::Kept`] the
    /// choice must not depend on anything else, because kept texels would otherwise show another
    /// shape than newly drawn ones.
    ///
    /// ```no_run
    /// # use umbrage_wgpu::{ShadowMap, wgpu};
    /// # struct Mesh { indices: u32, detail_m: f64 }
    /// # fn draw(map: &ShadowMap<'_>, pass: &mut wgpu::RenderPass<'_>, meshes: &[Mesh]) {
    /// // Coarser meshes follow finer ones.
    /// let coarsest = |_caster, texel_m| meshes.iter().rposition(|mesh| mesh.detail_m <= 0.25 * texel_m).unwrap_or(0);
    /// for draw in map.shapes(coarsest) {
    ///     for rows in draw.rows() {
    ///         pass.draw_indexed(0..meshes[draw.shape].indices, 0, rows);
    ///     }
    /// }
    /// # }
    /// ```
    pub fn shapes<S: Ord>(&self, mut choose: impl FnMut(u32, f64) -> S) -> Vec<ShapeDraw<S>> {
        let texel_m = self.texel_m();
        let mut by_shape: BTreeMap<S, Vec<(u32, Range<u32>)>> = BTreeMap::new();
        for (caster, instances) in self.casters() {
            by_shape.entry(choose(caster, texel_m)).or_default().push((caster, instances));
        }
        by_shape.into_iter().map(|(shape, casters)| ShapeDraw { shape, casters }).collect()
    }

    /// The casters as ranges of [`crate::Inputs::casters`], for an application whose instance
    /// buffer has one row for each caster, in their order: one draw of a mesh draws a range of
    /// rows.
    ///
    /// `None` with layered, instanced and mixed layouts. There the instances of a draw encode the
    /// splits of a caster, and [`ShadowMap::casters`] lists them: draw one caster at a time.
    /// Matrices that are attributes would advance with these instances, so the instance buffer has
    /// `array_stride` 0 in the casters' pipeline, and each draw binds the caster's own row.
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
        let is_alone = self.is_region() || self.shadows.maps.passes()[self.pass].is_alone();
        is_alone.then(|| draws::rows(self.shadows.draws.of_pass(self.pass)))
    }

    /// The bind group that [`Shadows::caster_wgsl`] declares, for this map.
    #[must_use]
    pub fn bind_group(&self) -> &'a wgpu::BindGroup {
        let of_region = self.region().and_then(|region| self.shadows.maps.region_bind_group(region));
        of_region.unwrap_or_else(|| self.shadows.maps.caster_bind_group(self.pass))
    }

    /// Begins the pass: the map is cleared, or contains its kept depth; viewport and scissor are
    /// set and have to stay. Set the pipeline and bind group 0.
    pub fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        self.begin_timed(encoder, None)
    }

    /// [`ShadowMap::begin`] with timestamps.
    pub fn begin_timed<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'e> {
        let maps = &self.shadows.maps;
        match self.region() {
            Some(region) => maps.begin_region(encoder, region, timestamp_writes).expect("a region is of what is kept"),
            None if self.shadows.is_kept => maps.begin_kept(encoder, self.pass, timestamp_writes),
            None => maps.begin_pass(encoder, self.pass, timestamp_writes),
        }
    }
}
