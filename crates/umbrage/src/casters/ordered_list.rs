//! The boxes of a list, in an order in which neighbours in space lie beside each other.

use super::curve::Curve;
use super::gathered::sort_by_first;
use super::tree::BoxTree;
use crate::Aabb;
use crate::bounds::Placed;

/// Factor by which the spread of leaves may grow after they were last put in order.
const MOST_SPREAD: f64 = 1.5;

/// A tree over the boxes of a list. The order is kept from list to list as long as it serves.
#[derive(Clone, Debug, Default)]
pub(crate) struct OrderedList {
    pub tree: BoxTree,
    /// For each box of the tree its place in the list.
    pub names: Vec<u32>,
    /// Scratch of the sorting.
    codes: Vec<(u32, u32)>,
    unsorted: Vec<(u32, u32)>,
    /// Spread of the leaves when they were last put in order.
    ordered_spread: f64,
}

impl OrderedList {
    /// Replaces all boxes.
    pub fn fill(&mut self, list: &[Aabb]) {
        let is_known = self.names.len() == list.len();
        if is_known {
            self.fill_tree(list);
        }
        if !is_known || self.tree.spread() > MOST_SPREAD * self.ordered_spread {
            self.order(list);
            self.fill_tree(list);
            self.ordered_spread = self.tree.spread();
        }
    }

    /// Replaces all boxes by others in the order of their list.
    pub fn fill_as_given(&mut self, list: &[Aabb]) {
        self.names.clear();
        self.names.extend(0..list.len() as u32);
        self.fill_tree(list);
    }

    fn fill_tree(&mut self, list: &[Aabb]) {
        self.tree.fill(self.names.iter().map(|&name| Placed::from(list[name as usize])));
    }

    fn order(&mut self, list: &[Aabb]) {
        let curve = Curve::through(list.iter().fold(Aabb::EMPTY, |all, it| all.including(it.center())));
        self.codes.clear();
        self.codes.extend(list.iter().zip(0..).map(|(it, name)| (curve.coarse_code(it.center()), name)));
        sort_by_first(&mut self.codes, &mut self.unsorted);
        self.names.clear();
        self.names.extend(self.codes.iter().map(|&(_, name)| name));
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Boxes in a row that is taken every seventh box.
    fn row(count: u32, step: f64) -> Vec<Aabb> {
        let at = |i: u32| DVec3::X * step * f64::from(i * 7 % count);
        (0..count).map(|i| Aabb::new(at(i), at(i) + DVec3::ONE)).collect()
    }

    fn check(listed: &OrderedList, list: &[Aabb]) {
        let mut names = listed.names.clone();
        names.sort_unstable();
        assert!(names.iter().copied().eq(0..list.len() as u32), "every box once");
    }

    #[test]
    fn neighbours_are_brought_together_and_the_order_is_kept() {
        let (mut listed, list) = (OrderedList::default(), row(1000, 1.0));
        listed.fill(&list);
        check(&listed, &list);
        assert!(listed.names.windows(2).all(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|name| list[name as usize].min.x);
            (a - b).abs() < 1.5
        }));
        let before = listed.names.clone();
        let moved: Vec<Aabb> = list.iter().map(|it| Aabb::new(it.min + 0.3, it.max + 0.4)).collect();
        listed.fill(&moved);
        assert_eq!(listed.names, before);
        // Boxes that have changed places are put in order anew.
        let mut other = list.clone();
        other.reverse();
        other[..500].rotate_left(123);
        listed.fill(&other);
        check(&listed, &other);
        assert_ne!(listed.names, before);
        listed.fill(&list[..17]);
        check(&listed, &list[..17]);
        listed.fill(&[]);
        assert!(listed.names.is_empty());
    }
}
