//! Record of the cells of a grid that a texture holds.
//!
//! The texture is a torus: a texel of the grid always has the same place, its number modulo the
//! texture's edge. A window that moves uncovers cells at one side, which take the places of the
//! cells that it leaves at the other side, and nothing is ever copied.

use super::area::Area;

/// Number of cells along the edge of a map. With more cells less is drawn when a window moves, but
/// casters that lie across several cells are drawn more often.
const CELLS: u32 = 8;

/// The cells that the texture of one map holds.
#[derive(Clone, Debug)]
pub(super) struct Books {
    /// Edge of a cell in texels.
    cell: u32,
    /// Number of cells along the texture's edge.
    count: u32,
    /// For each place, the cell whose texels it holds.
    held: Vec<Option<[i64; 2]>>,
}

impl Books {
    /// Record for a map of `map_size` texels. Its texture has room for all cells that the map
    /// meets, wherever the map lies.
    pub fn new(map_size: u32) -> Self {
        let cell = map_size.div_ceil(CELLS).max(1);
        let count = map_size.div_ceil(cell) + 1;
        Self { cell, count, held: vec![None; (count * count) as usize] }
    }

    /// Edge of the texture in texels.
    pub fn edge(&self) -> u32 {
        self.cell * self.count
    }

    /// Number of texels of a cell.
    pub fn cell_texels(&self) -> u64 {
        u64::from(self.cell) * u64::from(self.cell)
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.held.fill(None);
    }

    /// The cells in which texels lie.
    pub fn cells(&self, texels: &Area) -> Area {
        let cell = i64::from(self.cell);
        Area { min: texels.min.map(|at| at.div_euclid(cell)), max: texels.max.map(|at| (at - 1).div_euclid(cell) + 1) }
    }

    /// The texels of cells.
    pub fn texels(&self, cells: &Area) -> Area {
        let cell = i64::from(self.cell);
        Area { min: cells.min.map(|at| at * cell), max: cells.max.map(|at| at * cell) }
    }

    /// Number of texture edges before a cell, along both axes. Cells with equal numbers lie in the
    /// texture as they lie in the grid.
    pub fn turn(&self, cell: [i64; 2]) -> [i64; 2] {
        cell.map(|at| at.div_euclid(i64::from(self.count)))
    }

    fn place(&self, cell: [i64; 2]) -> usize {
        let [x, y] = cell.map(|at| at.rem_euclid(i64::from(self.count)) as usize);
        y * self.count as usize + x
    }

    /// Returns whether the texture holds a cell.
    pub fn holds(&self, cell: [i64; 2]) -> bool {
        self.held[self.place(cell)] == Some(cell)
    }

    /// Records a cell as drawn.
    pub fn take(&mut self, cell: [i64; 2]) {
        let place = self.place(cell);
        self.held[place] = Some(cell);
    }

    /// Forgets the cells in which some texels lie. Returns whether there was any.
    pub fn drop(&mut self, texels: &Area) -> bool {
        let cells = self.cells(texels);
        let meets = |[x, y]: [i64; 2]| cells.meets(&Area::square([x, y], 1));
        let mut any = false;
        for held in self.held.iter_mut().filter(|held| held.is_some_and(meets)) {
            (*held, any) = (None, true);
        }
        any
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[derive(Clone, Debug)]
    enum Step {
        Show([i64; 2]),
        Drop([i64; 2], [i64; 2]),
        Clear,
    }

    fn step() -> impl Strategy<Value = Step> {
        let at = || prop_oneof![8 => -300..300i64, 1 => -5_000_000_000..5_000_000_000i64];
        prop_oneof![
            6 => (at(), at()).prop_map(|(x, y)| Step::Show([x, y])),
            4 => (at(), at(), 1..200i64, 1..200i64).prop_map(|(x, y, w, h)| Step::Drop([x, y], [w, h])),
            1 => Just(Step::Clear),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// 10^5 operations beside a model that remembers which cell was drawn into which texel.
        #[test]
        fn a_place_has_one_owner_and_the_model_knows_it(size in 1u32..200, steps in prop::collection::vec(step(), 500)) {
            let mut books = Books::new(size);
            let mut model: BTreeSet<[i64; 2]> = BTreeSet::new();
            let room = i64::from(books.count);
            for step in steps {
                match step {
                    Step::Show(min) => {
                        let window = Area::square(min, i64::from(size));
                        let cells: Vec<[i64; 2]> = books.cells(&window).each().collect();
                        let places: BTreeSet<usize> = cells.iter().map(|&cell| books.place(cell)).collect();
                        prop_assert_eq!(places.len(), cells.len(), "cells of one window share a place");
                        for &cell in &cells {
                            prop_assert_eq!(books.holds(cell), model.contains(&cell));
                            books.take(cell);
                            model.retain(|other| (0..2).any(|axis| (other[axis] - cell[axis]).rem_euclid(room) != 0));
                            model.insert(cell);
                        }
                        let all = books.texels(&books.cells(&window));
                        prop_assert!((0..2).all(|axis| all.min[axis] <= min[axis] && all.max[axis] >= window.max[axis]));
                    }
                    Step::Drop(min, edges) => {
                        let area = Area { min, max: [min[0] + edges[0], min[1] + edges[1]] };
                        let cell = i64::from(books.cell);
                        let hit = |at: &[i64; 2]| area.meets(&Area::square(at.map(|at| at * cell), cell));
                        let any = model.iter().any(hit);
                        model.retain(|at| !hit(at));
                        prop_assert_eq!(books.drop(&area), any);
                    }
                    Step::Clear => {
                        books.clear();
                        model.clear();
                    }
                }
                let owned: Vec<[i64; 2]> = books.held.iter().flatten().copied().collect();
                prop_assert_eq!(owned.len(), model.len());
                prop_assert!(owned.iter().all(|cell| model.contains(cell)));
            }
        }
    }
}
