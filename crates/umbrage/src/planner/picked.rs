//! The gathered casters that a split draws.

use crate::bounds::Placed;
use crate::casters::{Gathered, Group};
use crate::geometry::region::Hull;

/// Casters of a split, as indices into the gathered ones, in the groups in which they were
/// gathered.
#[derive(Clone, Debug, Default)]
pub(super) struct Picked {
    places: Vec<u32>,
    pub parts: Vec<Part>,
}

/// Choice of boxes of a group.
pub(super) enum Asked<T> {
    All,
    /// Boxes that pass a test.
    Each(T),
}

/// The picked casters of a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Place of the group.
    group: u32,
    begin: u32,
    end: u32,
}

impl Picked {
    pub fn clear(&mut self) {
        self.places.clear();
        self.parts.clear();
    }

    pub fn places(&self) -> &[u32] {
        &self.places
    }

    pub fn len(&self) -> usize {
        self.places.len()
    }

    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Picks boxes: of each group those that pass the group's test, or all if there is none. `ask`
    /// gives `None` for a group, or a block of groups, of which no box is picked.
    pub fn pick<T: Fn(&Placed) -> bool>(
        &mut self,
        casters: &Gathered,
        ask: impl Fn(&Group, Option<&Hull>) -> Option<Asked<T>>,
    ) {
        self.clear();
        for (block, hull) in casters.blocks() {
            let Some(of_block) = ask(block, hull) else { continue };
            for ((group, hull), number) in casters.groups_of(block).zip(block.begin..) {
                let of_group = if let Asked::All = of_block { Some(Asked::All) } else { ask(group, hull) };
                let begin = self.places.len();
                match of_group {
                    None => {}
                    Some(Asked::All) => self.places.extend(group.begin..group.end),
                    Some(Asked::Each(test)) => {
                        let boxes = (group.begin..).zip(&casters.boxes[group.range()]);
                        self.places.extend(boxes.filter(|(_, placed)| test(placed)).map(|(at, _)| at));
                    }
                }
                if begin < self.places.len() {
                    self.parts.push(Part { group: number, begin: begin as u32, end: self.places.len() as u32 });
                }
            }
        }
    }

    /// Keeps of each group the boxes that pass the group's test: [`Picked::pick`] for tests that
    /// pass no other boxes than those by which these were picked.
    pub fn narrow<T: Fn(&Placed) -> bool>(
        &mut self,
        casters: &Gathered,
        ask: impl Fn(&Group, Option<&Hull>) -> Option<Asked<T>>,
    ) {
        let Self { places, parts } = self;
        let mut kept = 0;
        parts.retain_mut(|part| {
            let (begin, range) = (kept, part.begin as usize..part.end as usize);
            let asked = ask(&casters.groups[part.group as usize], casters.hull(part.group));
            for at in range {
                let passes = match &asked {
                    None => false,
                    Some(Asked::All) => true,
                    Some(Asked::Each(test)) => test(&casters.boxes[places[at] as usize]),
                };
                places[kept] = places[at];
                kept += usize::from(passes);
            }
            (part.begin, part.end) = (begin as u32, kept as u32);
            begin < kept
        });
        places.truncate(kept);
    }

    /// Removes the boxes that fail a test. Returns their number.
    pub fn retain(&mut self, casters: &Gathered, test: impl Fn(&Placed) -> bool) -> u32 {
        let (before, mut kept) = (self.places.len(), 0);
        for part in &mut self.parts {
            let begin = kept;
            for at in part.begin as usize..part.end as usize {
                let place = self.places[at];
                if test(&casters.boxes[place as usize]) {
                    self.places[kept] = place;
                    kept += 1;
                }
            }
            (part.begin, part.end) = (begin as u32, kept as u32);
        }
        self.places.truncate(kept);
        (before - kept) as u32
    }

    /// Bounds of the whole group of a part across the light, if they are measured.
    pub fn hull<'a>(&self, casters: &'a Gathered, part: &Part) -> Option<&'a Hull> {
        casters.hull(part.group)
    }

    /// Bounds of the whole group of a part.
    pub fn bounds<'a>(&self, casters: &'a Gathered, part: &Part) -> &'a Placed {
        &casters.groups[part.group as usize].bounds
    }

    /// The picked boxes of a group.
    pub fn boxes<'a>(&'a self, casters: &'a Gathered, part: &Part) -> impl Iterator<Item = &'a Placed> + Clone {
        self.places[part.begin as usize..part.end as usize].iter().map(|&at| &casters.boxes[at as usize])
    }

    /// The largest value of a monotone measure; −∞ if there is no box.
    pub fn most(&self, casters: &Gathered, measure: impl Fn(&Placed) -> f64) -> f64 {
        self.parts.iter().fold(f64::NEG_INFINITY, |best, part| match measure(self.bounds(casters, part)) > best {
            true => self.boxes(casters, part).map(&measure).fold(best, f64::max),
            false => best,
        })
    }
}
