//! Cells to be drawn, joined into rectangles.

use super::area::Area;
use super::books::Books;

/// Calls `each` with rectangles that together cover the `wanted` cells within `cells`, each cell
/// once. No rectangle crosses the texture's seam.
pub(super) fn rectangles(
    books: &Books,
    cells: Area,
    wanted: impl Fn([i64; 2]) -> bool,
    mut each: impl FnMut(Area, [i64; 2]),
) {
    let mut done: Vec<Area> = Vec::new();
    let is_free =
        |done: &[Area], cell: [i64; 2]| wanted(cell) && !done.iter().any(|area| area.meets(&Area::square(cell, 1)));
    for cell in cells.each() {
        if !is_free(&done, cell) {
            continue;
        }
        let turn = books.turn(cell);
        let joins = |done: &[Area], at: [i64; 2]| books.turn(at) == turn && is_free(done, at);
        let mut max = [cell[0] + 1, cell[1] + 1];
        while max[0] < cells.max[0] && joins(&done, [max[0], cell[1]]) {
            max[0] += 1;
        }
        while max[1] < cells.max[1] && (cell[0]..max[0]).all(|x| joins(&done, [x, max[1]])) {
            max[1] += 1;
        }
        let area = Area { min: cell, max };
        done.push(area);
        each(area, turn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rectangles_are_the_wanted_cells(
            min in [-40..40i64, -40..40i64],
            edges in [1..10i64, 1..10i64],
            holes in any::<u128>(),
        ) {
            let books = Books::new(64);
            let cells = Area { min, max: [min[0] + edges[0], min[1] + edges[1]] };
            let number = |[x, y]: [i64; 2]| (y - min[1]) * edges[0] + (x - min[0]);
            let wanted = |cell: [i64; 2]| holes >> number(cell) & 1 == 1;
            let mut drawn = Vec::new();
            rectangles(&books, cells, wanted, |area, turn| {
                assert!(area.each().all(|cell| books.turn(cell) == turn), "{area:?} lies across the seam");
                drawn.extend(area.each());
            });
            drawn.sort_unstable();
            let mut all: Vec<[i64; 2]> = cells.each().filter(|&cell| wanted(cell)).collect();
            all.sort_unstable();
            prop_assert_eq!(drawn, all);
        }
    }

    #[test]
    fn a_strip_is_one_rectangle_and_the_seam_makes_two() {
        let books = Books::new(64);
        let count = |cells: Area| {
            let mut count = 0;
            rectangles(&books, cells, |_| true, |_, _| count += 1);
            count
        };
        assert_eq!(count(Area { min: [0, 0], max: [1, 9] }), 1);
        assert_eq!(count(Area { min: [3, 5], max: [4, 14] }), 2);
        assert_eq!(count(Area { min: [5, 5], max: [14, 14] }), 4);
    }
}
