//! The gathered casters that a split draws.

use crate::bounds::Placed;
use crate::casters::{Gathered, Group};

/// Casters of a split, as indices into the gathered ones, in the groups in which they were
/// gathered.
#[derive(Clone, Debug, Default)]
pub(super) struct Picked {
    places: Vec<u32>,
    pub parts: Vec<Part>,
}

/// The picked casters of a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Bounds of the whole group.
    pub bounds: Placed,
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

    /// Picks the boxes of a group that pass a test.
    pub fn pick(&mut self, casters: &Gathered, group: &Group, test: impl Fn(&Placed) -> bool) {
        let begin = self.places.len();
        self.places.extend(group.range().filter(|&at| test(&casters.boxes[at])).map(|at| at as u32));
        if begin < self.places.len() {
            self.parts.push(Part { bounds: group.bounds, begin: begin as u32, end: self.places.len() as u32 });
        }
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

    /// The picked boxes of a group.
    pub fn boxes<'a>(&'a self, casters: &'a Gathered, part: &Part) -> impl Iterator<Item = &'a Placed> {
        self.places[part.begin as usize..part.end as usize].iter().map(|&at| &casters.boxes[at as usize])
    }

    /// The largest value of a monotone measure; −∞ if there is no box.
    pub fn most(&self, casters: &Gathered, measure: impl Fn(&Placed) -> f64) -> f64 {
        self.parts.iter().fold(f64::NEG_INFINITY, |best, part| match measure(&part.bounds) > best {
            true => self.boxes(casters, part).map(&measure).fold(best, f64::max),
            false => best,
        })
    }
}
