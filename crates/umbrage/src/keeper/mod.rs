//! Bookkeeping for [`crate::config::Cache::Kept`]: the parts of a sun's maps that static casters
//! have been drawn into and that are still valid.
//!
//! A kept map is a window of a grid that the light and the size of a texel determine. Cells of the
//! grid are drawn once, into a texture that is a torus ([`books`]). The window is copied from there
//! into the map, and moving casters are drawn over it. The cells to be drawn follow from the
//! changes of casters ([`rest`], [`grid`]) and from the movement of the window ([`regions`]).

mod area;
mod books;
mod grid;
mod hand_on;
mod regions;
mod rest;
#[cfg(test)]
mod tests;

use std::ops::Range;

use glam::DVec3;

pub use area::Area;
use books::Books;
use grid::{Grid, window};
use rest::Rest;

use crate::bounds::Placed;
use crate::casters::{Counter, Crowd, Role};
use crate::{Aabb, CasterSet, Layers, ShadowPlan};

/// Bookkeeping for the kept maps of a sun.
///
/// Each frame: plan, [`Keeper::prepare`], draw every region of [`Keeper::regions`] with its casters
/// into the texture of its split, copy the windows of [`Keeper::maps`] into the maps and draw
/// [`Keeper::movers`] over them, [`Keeper::accept`]. `umbrage-wgpu` does so behind
/// `umbrage_wgpu::Shadows`.
///
/// The texels of a map then equal, bit for bit, those of a map whose regions are all drawn in every
/// frame, as [`KeptFrame::redraws`] does. This requires that a texel of a texture depends only on
/// its place there, its casters and the uniforms of its [`KeptRegion::turn`].
///
/// # Cells that are drawn again
///
/// * All cells, if the light, the size of a texel, the depth range, the frame's origin, the layers
///   or the set changes.
/// * The cells over which a caster's shadow may lie, if it is added, removed, moved or reshaped.
/// * Cells that a window reaches for the first time, or again after others have taken their place.
///
/// # Moving casters
///
/// Casters of [`crate::Motion::Moving`] are drawn in every frame. A static caster that moves joins
/// them at once, and is kept again when it has stood still for 60 frames. Casters that share a key
/// have to agree in their motion.
#[derive(Clone, Debug)]
pub struct Keeper {
    books: Vec<Kept>,
    rest: Rest,
    /// Identity of the set from which cells were drawn, and the number of its next change.
    set: Option<(u64, u64)>,
    regions: Vec<KeptRegion>,
    maps: Vec<KeptMap>,
    /// Casters of regions and of maps.
    casters: Vec<u32>,
}

/// One split's texture.
#[derive(Clone, Debug)]
struct Kept {
    books: Books,
    grid: Option<Grid>,
    /// Contents of the split's map; `None` if they are not known.
    shown: Option<Shown>,
    /// Number of times that cells were drawn or forgotten.
    version: u64,
}

/// Contents of a map, which needs no drawing while they do not change.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    window: Area,
    version: u64,
}

/// Inputs of a frame beside its plan.
#[derive(Clone, Copy, Debug)]
pub struct KeptFrame<'a> {
    /// The casters that were planned for.
    pub set: &'a CasterSet,
    /// Layers whose casters were planned for.
    pub layers: Layers,
    /// World point in metres to which vertices are relative.
    pub origin: DVec3,
    /// Most texels of kept textures that may be drawn in this frame; `None` for all that are
    /// missing. The last split is filled in any case. A split that has to wait hands its slice on
    /// to the next split, which is coarser: shadows are blurred and never missing.
    pub budget: Option<u64>,
    /// True if casters with a small shadow are dropped:
    /// [`crate::ShadowConfig::drop_small_casters`].
    pub drops_small: bool,
    /// True if all cells that the maps show are drawn again even if they are kept, for comparison.
    pub redraws: bool,
}

/// A part of a split's kept texture that has to be drawn: it is cleared, then its casters are
/// drawn, clipped to its edge.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct KeptRegion {
    /// Index of the split.
    pub split: usize,
    /// Number of texture edges between the grid's origin and the region, along u and v: texel `t`
    /// of the grid is texel `t - turn · edge` of the texture.
    pub turn: [i64; 2],
    /// Texels of the region in the grid.
    pub texels: Area,
    /// Texels of the region in the texture.
    pub place: Area,
    casters: Range<usize>,
    grid: Grid,
}

impl KeptRegion {
    /// Returns whether a part of a caster, given by its world box, can cover any texel of the
    /// region.
    #[must_use]
    pub fn casts_into(&self, part: &Aabb) -> bool {
        self.grid.footprint(&Placed::from(*part)).meets(&self.texels)
    }
}

/// Window of a kept texture that becomes a split's map.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct KeptMap {
    /// Texel of the texture at which the map's upper left texel lies. Texels past the texture's
    /// edge continue at the opposite edge.
    pub begin: [u32; 2],
    /// Edge of the texture in texels.
    pub edge: u32,
    /// True if the map has to be drawn, because its contents have changed or casters move in it.
    pub is_due: bool,
    movers: Range<usize>,
    /// Contents of the map once it is drawn; `None` if moving casters are among them.
    shows: Option<Shown>,
}

impl Keeper {
    /// A keeper for maps of these edges in texels, nothing of which is drawn yet.
    #[must_use]
    pub fn new(map_sizes: &[u32]) -> Self {
        let kept = |&size: &u32| Kept { books: Books::new(size), grid: None, shown: None, version: 0 };
        Self {
            books: map_sizes.iter().map(kept).collect(),
            rest: Rest::default(),
            set: None,
            regions: Vec::new(),
            maps: Vec::new(),
            casters: Vec::new(),
        }
    }

    /// Edge in texels of the texture in which a map of `map_size` texels is kept: about an eighth
    /// more.
    #[must_use]
    pub fn texture_edge(map_size: u32) -> u32 {
        Books::new(map_size).edge()
    }

    /// Forgets everything, as if nothing had been drawn yet.
    pub fn clear(&mut self) {
        self.books.iter_mut().for_each(Kept::clear);
        self.forget_maps();
        self.rest.clear();
        self.set = None;
        self.regions.clear();
        self.maps.clear();
    }

    /// Marks the contents of maps as lost; the kept textures remain valid.
    pub fn forget_maps(&mut self) {
        self.books.iter_mut().for_each(|kept| kept.shown = None);
    }

    /// Determines the regions and maps to be drawn for a plan of a sun, whose maps have to be
    /// exactly stabilised. Splits that cannot be filled in this frame are handed on in the plan
    /// ([`ShadowPlan::is_handed_on`]).
    ///
    /// Nothing counts as drawn until [`Keeper::accept`].
    ///
    /// # Panics
    /// If the plan does not have as many splits as there are maps.
    pub fn prepare(&mut self, frame: &KeptFrame<'_>, plan: &mut ShadowPlan) {
        assert_eq!(plan.splits.len(), self.books.len(), "a map for each split");
        self.regions.clear();
        self.maps.clear();
        self.casters.clear();
        for (kept, split) in self.books.iter_mut().zip(&plan.splits) {
            kept.stand_on(Grid::of(split, frame.origin, frame.layers, frame.drops_small));
        }
        self.follow(frame.set);
        self.choose(frame, plan);
        self.list_casters(frame);
        self.list_maps(plan);
    }

    /// Records the regions and maps of the last [`Keeper::prepare`] as drawn.
    pub fn accept(&mut self) {
        for region in &self.regions {
            let kept = &mut self.books[region.split];
            for cell in kept.books.cells(&region.texels).each() {
                kept.books.take(cell);
            }
        }
        for (kept, map) in self.books.iter_mut().zip(&self.maps) {
            if map.is_due {
                kept.shown = map.shows;
            }
        }
        self.rest.advance();
    }

    /// Regions to be drawn into kept textures.
    #[must_use]
    pub fn regions(&self) -> &[KeptRegion] {
        &self.regions
    }

    /// Casters of a region by their keys, rising.
    #[must_use]
    pub fn casters(&self, region: &KeptRegion) -> &[u32] {
        &self.casters[region.casters.clone()]
    }

    /// For each split, the window of its kept texture that becomes its map.
    #[must_use]
    pub fn maps(&self) -> &[KeptMap] {
        &self.maps
    }

    /// Casters of a map that are drawn over the kept depth, by their keys, rising.
    #[must_use]
    pub fn movers(&self, map: &KeptMap) -> &[u32] {
        &self.casters[map.movers.clone()]
    }

    /// Forgets all that changes of the set have made invalid.
    fn follow(&mut self, set: &CasterSet) {
        let Self { books, rest, set: known, .. } = self;
        let identity = set.stamp().0;
        let from = known.filter(|(of, _)| *of == identity).map_or(u64::MAX, |(_, next)| next);
        let (changes, next) = set.changes_since(from);
        *known = Some((identity, next));
        let mut drop = |bounds: Aabb| books.iter_mut().for_each(|kept| kept.drop(&bounds.into()));
        match changes {
            Some(changes) => changes.for_each(|change| rest.follow(change, &mut drop)),
            None => {
                rest.clear();
                books.iter_mut().for_each(Kept::clear);
                return rest.list(set);
            }
        }
        rest.settle(set, &mut drop);
        rest.list(set);
    }

    /// Chooses the cells to draw, and hands on the splits that have to wait for theirs.
    fn choose(&mut self, frame: &KeptFrame<'_>, plan: &mut ShadowPlan) {
        let last = plan.splits.len() - 1;
        let is_lit = plan.splits.iter().all(|split| split.casters.is_empty());
        let mut left = frame.budget.unwrap_or(u64::MAX);
        // Even where nothing is left, one cell is drawn in every frame.
        let mut spare = 1;
        let mut filled = [false; crate::MAX_SPLITS];
        for index in (0..=last).rev() {
            let split = &plan.splits[index];
            if is_lit || (index != last && split.casters.is_empty()) {
                continue;
            }
            let kept = &self.books[index];
            let cells = kept.books.cells(&window(split));
            let missing = cells.each().filter(|&cell| !kept.books.holds(cell)).count() as u64;
            let cost = missing * kept.books.cell_texels();
            filled[index] = index == last || cost <= left;
            let most = if filled[index] { missing } else { (left / kept.books.cell_texels()).max(spare) };
            left = left.saturating_sub(most * kept.books.cell_texels());
            spare = if filled[index] { spare } else { 0 };
            let redraws = frame.redraws && filled[index];
            self.list_regions(index, cells, most, redraws);
        }
        for (index, is_filled) in filled.into_iter().enumerate().take(last) {
            if !is_filled && !plan.splits[index].casters.is_empty() {
                plan.hand_on(index);
            }
        }
    }

    /// Lists regions of the first `most` cells that are missing, and with `redraws` of all other
    /// cells.
    fn list_regions(&mut self, split: usize, cells: Area, most: u64, redraws: bool) {
        let Self { books, regions, .. } = self;
        let Kept { books, grid: Some(grid), .. } = &books[split] else { return };
        let mut left = most;
        let end = cells.each().find(|&cell| {
            left -= u64::from(left > 0 && !books.holds(cell));
            left == 0
        });
        // Cells in their order, row after row, up to and with the last one that is drawn.
        let is_due = |cell: [i64; 2]| match end {
            _ if most == 0 => false,
            Some([x, y]) => !books.holds(cell) && (cell[1], cell[0]) <= (y, x),
            None => !books.holds(cell),
        };
        regions::rectangles(
            books,
            cells,
            |cell| redraws || is_due(cell),
            |area, turn| {
                let texels = books.texels(&area);
                let edge = i64::from(books.edge());
                let placed = |at: [i64; 2]| [0, 1].map(|axis| at[axis] - turn[axis] * edge);
                let place = Area { min: placed(texels.min), max: placed(texels.max) };
                regions.push(KeptRegion { split, turn, texels, place, casters: 0..0, grid: *grid });
            },
        );
    }

    /// Lists the casters of regions.
    fn list_casters(&mut self, frame: &KeptFrame<'_>) {
        let (Self { books, regions, casters, rest, .. }, counter) = (self, Counter::default());
        // Tests are taken across the light, where the origin is as good as the eye.
        let crowd = Crowd::of_set(frame.set, (frame.layers, Role::Caster), frame.origin, &counter);
        for region in regions {
            let begin = casters.len();
            let reaches = |placed: &Placed| region.grid.footprint(placed).meets(&region.texels);
            crowd.each_static(reaches, |key, placed| {
                if !rest.is_live(key) && !region.grid.drops(placed) {
                    casters.push(key);
                }
            });
            casters[begin..].sort_unstable();
            let mut kept = begin;
            for at in begin..casters.len() {
                if kept == begin || casters[kept - 1] != casters[at] {
                    casters[kept] = casters[at];
                    kept += 1;
                }
            }
            casters.truncate(kept);
            region.casters = begin..kept;
            books[region.split].version += 1;
        }
    }

    /// Lists the maps and their moving casters.
    fn list_maps(&mut self, plan: &ShadowPlan) {
        let Self { books, maps, casters, rest, .. } = self;
        for (index, (kept, split)) in books.iter().zip(&plan.splits).enumerate() {
            let begin = casters.len();
            casters.extend(plan.casters(index).iter().filter(|&&key| rest.is_live(key)));
            let movers = begin..casters.len();
            let window = window(split);
            let edge = kept.books.edge();
            let shows = Some(Shown { window, version: kept.version }).filter(|_| movers.is_empty());
            let is_due = !split.casters.is_empty() && (shows.is_none() || shows != kept.shown);
            let begin = window.min.map(|at| at.rem_euclid(i64::from(edge)) as u32);
            maps.push(KeptMap { begin, edge, is_due, movers, shows });
        }
    }
}

impl Kept {
    fn clear(&mut self) {
        self.books.clear();
        self.version += 1;
    }

    /// Forgets all that was drawn on another grid.
    fn stand_on(&mut self, grid: Grid) {
        if self.grid != Some(grid) {
            self.clear();
            self.grid = Some(grid);
        }
    }

    /// Forgets the cells over which the shadow of a box may lie.
    fn drop(&mut self, placed: &Placed) {
        if let Some(grid) = &self.grid
            && self.books.drop(&grid.footprint(placed))
        {
            self.version += 1;
        }
    }
}
