//! What static casters have drawn into a sun's maps, and what of it still holds: the books of
//! [`crate::config::Cache::Kept`].
//!
//! A kept map is a window of a grid that the light and the size of a texel decide. Cells of the
//! grid are drawn once, into a texture that is a torus ([`books`]); the window is copied out of it
//! into the map, and what moves is drawn over it. Which cells have to be drawn follows from what
//! has changed ([`rest`], [`grid`]) and from where the window has come to ([`regions`]).

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

/// What is kept of a sun's maps, frame after frame.
///
/// Each frame: plan, [`Keeper::prepare`], draw every region of [`Keeper::regions`] with its casters
/// into the texture of its split, copy the windows of [`Keeper::maps`] into the maps and draw
/// [`Keeper::movers`] over them, [`Keeper::accept`]. `umbrage-wgpu` does so behind
/// `umbrage_wgpu::Shadows`.
///
/// The texels of a map are then the same, bit for bit, as if all its regions were drawn in every
/// frame, which [`KeptFrame::redraws`] asks for: as long as a texel of a texture depends on its
/// place there, its casters and the uniforms of its [`KeptRegion::turn`] alone.
///
/// # What is drawn anew
///
/// All cells, once the light, the size of a texel, the depth range, the frame's origin, the layers
/// or the set is another. The cells that a caster's shadow may lie over, once it is added, removed,
/// moved or reshaped. Cells that a window reaches for the first time, or again after others have
/// taken their place.
///
/// # What moves
///
/// Casters of [`crate::Motion::Moving`] are drawn in every frame. A static one that moves joins
/// them at once and is kept again when it has stood still for 60 frames. Casters that share a key
/// have to agree in their motion.
#[derive(Clone, Debug)]
pub struct Keeper {
    books: Vec<Kept>,
    rest: Rest,
    /// The set that cells were drawn from, and the number of its next change.
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
    /// What the split's map shows; `None` if that is not known.
    shown: Option<Shown>,
    /// How often cells were drawn or forgotten.
    version: u64,
}

/// A map that needs no drawing while this does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    window: Area,
    version: u64,
}

/// What a frame is prepared from, beside its plan.
#[derive(Clone, Copy, Debug)]
pub struct KeptFrame<'a> {
    /// The casters that were planned for.
    pub set: &'a CasterSet,
    /// Whose casters were planned for.
    pub layers: Layers,
    /// The world point that vertices are relative to, metres.
    pub origin: DVec3,
    /// Texels of kept textures that may be drawn in this frame; `None`: as many as are missing. The
    /// last split is filled whatever that takes. A split that waits hands its slice on to the next
    /// one, which is coarser: shadows are blurred and never missing.
    pub budget: Option<u64>,
    /// Whether casters are dropped whose shadow is small:
    /// [`crate::ShadowConfig::drop_small_casters`].
    pub drops_small: bool,
    /// Whether all that the maps show is drawn anew, though it is there: to compare with.
    pub redraws: bool,
}

/// A part of a split's kept texture that is to be drawn: cleared, then its casters, cut at its
/// edge.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct KeptRegion {
    /// The split.
    pub split: usize,
    /// How often the texture's edge lies between the grid's origin and the region, along u and v:
    /// texel `t` of the grid is texel `t - turn · edge` of the texture.
    pub turn: [i64; 2],
    /// Its texels in the grid.
    pub texels: Area,
    /// Its texels in the texture.
    pub place: Area,
    casters: Range<usize>,
    grid: Grid,
}

impl KeptRegion {
    /// Whether a part of a caster, by its world box, can leave anything in the region, as
    /// [`crate::ShadowPlan::casts_into`] says of a whole map.
    #[must_use]
    pub fn casts_into(&self, part: &Aabb) -> bool {
        self.grid.footprint(&Placed::from(*part)).meets(&self.texels)
    }
}

/// How a split's map comes from its kept texture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct KeptMap {
    /// Where the map's upper left texel lies in the texture; texels past its edge are at its other
    /// end.
    pub begin: [u32; 2],
    /// Edge of the texture in texels.
    pub edge: u32,
    /// Whether the map has to be drawn: it shows something else than it did, or something moves.
    pub is_due: bool,
    movers: Range<usize>,
    /// What it shows once it is drawn, and whether all of that is kept.
    shows: Option<Shown>,
}

impl Keeper {
    /// For maps of these edges in texels, nothing of which is drawn yet.
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

    /// Edge of the texture that a map of `map_size` texels is kept in, texels: an eighth more.
    #[must_use]
    pub fn texture_edge(map_size: u32) -> u32 {
        Books::new(map_size).edge()
    }

    /// Forgets all that is kept, as if nothing had been drawn yet.
    pub fn clear(&mut self) {
        self.books.iter_mut().for_each(Kept::clear);
        self.forget_maps();
        self.rest.clear();
        self.set = None;
        self.regions.clear();
        self.maps.clear();
    }

    /// Takes maps as drawn over: their textures still hold what they held.
    pub fn forget_maps(&mut self) {
        self.books.iter_mut().for_each(|kept| kept.shown = None);
    }

    /// Works out what has to be drawn for a plan of a sun, whose maps stand exactly still. Splits
    /// that cannot be filled in this frame are handed on in the plan
    /// ([`ShadowPlan::is_handed_on`]).
    ///
    /// Until [`Keeper::accept`] nothing counts as drawn.
    ///
    /// # Panics
    /// If the plan has not as many splits as there are maps.
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

    /// Takes the regions and maps of the last [`Keeper::prepare`] as drawn.
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

    /// What is to be drawn into kept textures.
    #[must_use]
    pub fn regions(&self) -> &[KeptRegion] {
        &self.regions
    }

    /// The casters of a region, by their keys, rising.
    #[must_use]
    pub fn casters(&self, region: &KeptRegion) -> &[u32] {
        &self.casters[region.casters.clone()]
    }

    /// How each split's map comes from its kept texture.
    #[must_use]
    pub fn maps(&self) -> &[KeptMap] {
        &self.maps
    }

    /// The casters of a map that are drawn over what is kept, by their keys, rising.
    #[must_use]
    pub fn movers(&self, map: &KeptMap) -> &[u32] {
        &self.casters[map.movers.clone()]
    }

    /// Forgets what changes of the set have made wrong.
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

    /// Lists regions of the first `most` cells that are missing; if all is drawn anew, of the
    /// others, too.
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

    /// Lists how maps come from what is kept, and what moves in them.
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

    /// Forgets what was drawn on another grid.
    fn stand_on(&mut self, grid: Grid) {
        if self.grid != Some(grid) {
            self.clear();
            self.grid = Some(grid);
        }
    }

    /// Forgets the cells that the shadow of a box may lie over.
    fn drop(&mut self, placed: &Placed) {
        if let Some(grid) = &self.grid
            && self.books.drop(&grid.footprint(placed))
        {
            self.version += 1;
        }
    }
}
