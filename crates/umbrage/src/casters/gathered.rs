//! Boxes that a query has found, in groups of neighbours.

use glam::DVec3;

use super::tree::with_room;
use crate::Aabb;
use crate::bounds::Placed;
use crate::geometry::region::{Fan, Hull, greater, lesser};

/// Boxes whose largest measure is found without looking at each.
pub(crate) trait Most {
    /// The largest value of a monotone measure; −∞ if there is no box.
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64;

    /// The box around all boxes that pass a monotone test.
    fn bounds(&self, test: impl Fn(&Placed) -> bool) -> Aabb {
        let end = |of: &dyn Fn(&Placed) -> f64| self.most(|it| if test(it) { of(it) } else { f64::NEG_INFINITY });
        let least = |axis: usize| -end(&|it| -(it.center[axis] - it.half[axis]));
        let most = |axis: usize| end(&|it| it.center[axis] + it.half[axis]);
        Aabb::new(DVec3::new(least(0), least(1), least(2)), DVec3::new(most(0), most(1), most(2)))
    }
}

/// Gathered boxes in groups of neighbours, with their names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gathered {
    pub boxes: Vec<Placed>,
    pub names: Vec<u32>,
    pub groups: Vec<Group>,
    /// Groups of neighbouring groups.
    pub blocks: Vec<Group>,
    /// Bounds of groups and blocks across the light, once they are measured.
    hulls: [Vec<Hull>; 2],
    /// True once names have been put in order.
    is_ordered: bool,
    /// Places of boxes sorted by name, and the rank of each. Empty if boxes are already in that
    /// order.
    order: Vec<(u32, u32)>,
    ranks: Vec<u32>,
    /// Scratch: a bit for each rank.
    marks: Vec<u64>,
    /// Scratch: places in order.
    ordered: Vec<u32>,
    /// Scratch of the sorting.
    unsorted: Vec<(u32, u32)>,
}

/// Boxes that lie beside each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    /// Box around all of them, with room for rounding.
    pub bounds: Placed,
    /// Box around all of them, exact.
    pub exact: Aabb,
    /// The greatest of their lower corners and the least of their upper corners: the box that all
    /// of them contain, or an inverted one.
    pub core: Aabb,
    /// Places of the boxes; of a block, those of its groups.
    pub begin: u32,
    pub end: u32,
}

/// Groups of a block.
const BLOCK: usize = 8;

impl Group {
    pub fn range(&self) -> std::ops::Range<usize> {
        self.begin as usize..self.end as usize
    }
}

impl Gathered {
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Measures groups and blocks across the light, for all who ask for them.
    pub fn measure(&mut self, fan: &Fan) {
        for (hulls, groups) in self.hulls.iter_mut().zip([&self.groups, &self.blocks]) {
            hulls.clear();
            hulls.extend(groups.iter().map(|group| Hull::new(fan, &group.bounds)));
        }
    }

    /// The groups of a block, each with its bounds across the light if they are measured.
    pub fn groups_of(&self, block: &Group) -> impl Iterator<Item = (&Group, Option<&Hull>)> {
        block.range().map(|at| (&self.groups[at], self.hulls[0].get(at)))
    }

    /// Bounds of a group across the light, if they are measured.
    pub fn hull(&self, group: u32) -> Option<&Hull> {
        self.hulls[0].get(group as usize)
    }

    /// All blocks, each with its bounds across the light if they are measured.
    pub fn blocks(&self) -> impl Iterator<Item = (&Group, Option<&Hull>)> {
        self.blocks.iter().enumerate().map(|(at, block)| (block, self.hulls[1].get(at)))
    }

    pub(super) fn clear(&mut self) {
        self.hulls.iter_mut().for_each(Vec::clear);
        self.is_ordered = false;
        self.boxes.clear();
        self.names.clear();
        self.groups.clear();
    }

    pub(super) fn push(&mut self, name: u32, placed: Placed) {
        self.names.push(name);
        self.boxes.push(placed);
    }

    pub(super) fn end_group(&mut self) {
        let begin = self.groups.last().map_or(0, |group| group.end as usize);
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut most_min, mut least_max) = (max, min);
        for Placed { center, half } in &self.boxes[begin..] {
            for axis in 0..3 {
                let (lo, hi) = (center[axis] - half[axis], center[axis] + half[axis]);
                (min[axis], max[axis]) = (lesser(min[axis], lo), greater(max[axis], hi));
                (most_min[axis], least_max[axis]) = (greater(most_min[axis], lo), lesser(least_max[axis], hi));
            }
        }
        let [min, max, most_min, least_max] = [min, max, most_min, least_max].map(DVec3::from);
        if begin < self.boxes.len() {
            let bounds = middle_of(Aabb::new(min, max));
            let (exact, core) = (Aabb::new(min, max), Aabb::new(most_min, least_max));
            self.groups.push(Group { bounds, exact, core, begin: begin as u32, end: self.boxes.len() as u32 });
        }
    }

    /// Ends the gathering: enlarges groups for tests that are taken `farthest` metres from the
    /// origin.
    pub(super) fn finish(&mut self, farthest: f64) {
        self.blocks.clear();
        let mut begin = 0;
        for groups in self.groups.chunks_mut(BLOCK) {
            let (mut exact, mut core) = (groups[0].exact, groups[0].core);
            for group in groups.iter_mut() {
                group.bounds = with_room(group.bounds, farthest);
                exact = exact.union(group.exact);
                core = Aabb::new(core.min.max(group.core.min), core.max.min(group.core.max));
            }
            let end = begin + groups.len() as u32;
            self.blocks.push(Group { bounds: with_room(middle_of(exact), farthest), exact, core, begin, end });
            begin = end;
        }
    }

    /// Puts names in order when they are first needed.
    fn order(&mut self) {
        if self.is_ordered {
            return;
        }
        self.is_ordered = true;
        self.order.clear();
        self.ranks.clear();
        if self.names.is_sorted() {
            return;
        }
        self.order.extend(self.names.iter().zip(0..).map(|(&name, at)| (name, at)));
        sort_by_first(&mut self.order, &mut self.unsorted);
        self.ranks.resize(self.names.len(), 0);
        for (&(_, at), rank) in self.order.iter().zip(0..) {
            self.ranks[at as usize] = rank;
        }
    }

    /// All boxes in the order of their names.
    pub fn in_order(&mut self) -> impl Iterator<Item = &Placed> {
        self.order();
        let is_ordered = self.order.is_empty();
        let ordered = self.boxes.iter().filter(move |_| is_ordered);
        ordered.chain(self.order.iter().map(|&(_, at)| &self.boxes[at as usize]))
    }

    /// Some boxes, by their places, in the order of their names.
    pub fn ordered(&mut self, places: &[u32]) -> impl Iterator<Item = &Placed> {
        self.order();
        self.ordered.clear();
        if self.order.is_empty() {
            self.ordered.extend_from_slice(places);
        } else {
            self.ordered.extend(places.iter().map(|&at| self.ranks[at as usize]));
            self.ordered.sort_unstable();
            self.ordered.iter_mut().for_each(|rank| *rank = self.order[*rank as usize].1);
        }
        self.ordered.iter().map(|&at| &self.boxes[at as usize])
    }

    /// Appends the names of some boxes, by their places, in rising order and each once.
    pub fn name(&mut self, places: &[u32], names: &mut Vec<u32>) {
        self.order();
        let begin = names.len();
        if self.order.is_empty() {
            names.extend(places.iter().map(|&at| self.names[at as usize]));
            debug_assert!(names[begin..].is_sorted(), "boxes stand in the order of their names");
        } else {
            self.marks.clear();
            self.marks.resize(self.order.len().div_ceil(64), 0);
            for &at in places {
                let rank = self.ranks[at as usize];
                self.marks[rank as usize / 64] |= 1 << (rank % 64);
            }
            for (word, &marks) in self.marks.iter().enumerate() {
                let mut left = marks;
                while left != 0 {
                    names.push(self.order[64 * word + left.trailing_zeros() as usize].0);
                    left &= left - 1;
                }
            }
        }
        // Casters that share a name are drawn as one.
        let mut kept = begin;
        for at in begin..names.len() {
            if kept == begin || names[kept - 1] != names[at] {
                names[kept] = names[at];
                kept += 1;
            }
        }
        names.truncate(kept);
    }
}

impl Most for Gathered {
    fn most(&self, measure: impl Fn(&Placed) -> f64) -> f64 {
        let of_group = |best, group: &Group| match measure(&group.bounds) > best {
            true => self.boxes[group.range()].iter().map(&measure).fold(best, f64::max),
            false => best,
        };
        self.blocks.iter().fold(f64::NEG_INFINITY, |best, block| match measure(&block.bounds) > best {
            true => self.groups[block.range()].iter().fold(best, of_group),
            false => best,
        })
    }
}

fn middle_of(Aabb { min, max }: Aabb) -> Placed {
    Placed { center: 0.5 * (min + max), half: 0.5 * (max - min) }
}

/// Neighbours of which [`spread`] gives one at first.
const NEIGHBOURS: usize = 7;

/// All of a row of neighbours, in an order in which a few are spread over all of the row: bounds
/// that include them grow early.
pub(crate) fn spread<T>(row: &[T]) -> impl Iterator<Item = &T> {
    (0..NEIGHBOURS).flat_map(move |begin| row.iter().skip(begin).step_by(NEIGHBOURS))
}

/// Bits of a number that one pass of the sorting looks at.
const DIGIT: u32 = 11;

/// Pairs from which on passes are quicker than comparisons.
const MANY: usize = 512;

/// Sorts pairs whose second numbers rise by their first numbers, equal ones by their second.
pub(super) fn sort_by_first(pairs: &mut Vec<(u32, u32)>, unsorted: &mut Vec<(u32, u32)>) {
    if pairs.len() < MANY {
        pairs.sort_unstable();
        return;
    }
    let most = pairs.iter().fold(0, |most, &(name, _)| most | name);
    for shift in (0..u32::BITS).step_by(DIGIT as usize).take_while(|&shift| most >> shift != 0) {
        let digit = |name: u32| (name >> shift) as usize & ((1 << DIGIT) - 1);
        let mut ends = [0u32; 1 << DIGIT];
        pairs.iter().for_each(|&(name, _)| ends[digit(name)] += 1);
        let mut sum = 0;
        for end in &mut ends {
            (*end, sum) = (sum, sum + *end);
        }
        std::mem::swap(pairs, unsorted);
        pairs.resize(unsorted.len(), (0, 0));
        for &pair in unsorted.iter() {
            let end = &mut ends[digit(pair.0)];
            pairs[*end as usize] = pair;
            *end += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreading_a_row_leaves_none_out() {
        for count in [0, 1, NEIGHBOURS, 100] {
            let row: Vec<usize> = (0..count).collect();
            let mut all: Vec<usize> = spread(&row).copied().collect();
            all.sort_unstable();
            assert_eq!(all, row);
        }
    }

    #[test]
    fn pairs_are_sorted_by_passes_as_by_comparisons() {
        for (count, shift) in [(3, 0), (MANY, 0), (2000, 8), (5000, 20), (700, 31)] {
            let name = |i: u32| (i.wrapping_mul(2_654_435_761) >> shift) / 3;
            let mut pairs: Vec<(u32, u32)> = (0..count as u32).map(|i| (name(i), i)).collect();
            let mut sorted = pairs.clone();
            sorted.sort_unstable();
            sort_by_first(&mut pairs, &mut Vec::new());
            assert!(pairs == sorted, "{count} names, {shift} bits less");
        }
    }
}
