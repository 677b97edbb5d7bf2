//! Thin slices of the view, and for each the bounds of its receivers and casters and the amount of
//! shadow edges that the image shows there.

mod cell;
mod shaded;

use glam::DVec3;

pub(crate) use cell::Cell;
use shaded::{Lanes, Question, across, outline};

use crate::bounds::Placed;
use crate::casters::{Gathered, Group, Most, WIDE, spread};
use crate::geometry::region::{Fan, Hull, Region, Undecided, greater};
use crate::geometry::volume::{Lies, Slice};
use crate::{Aabb, Projection, View};

/// Inputs for the placement of planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight<'a> {
    pub view: &'a View,
    pub fan: &'a Fan,
    /// The receivers that the view shows in range.
    pub receivers: &'a Gathered,
    /// The casters that can shade anything in range.
    pub casters: &'a Gathered,
    /// Region of the last map, if it does not follow from its slice: all geometry that may come
    /// into view, where `receivers` are only those that were seen.
    pub last_map: Option<Region>,
}

/// A receiver with parts in more cells than this counts as long.
const LONG: usize = 8;

/// Number of units in the longest outline of a caster.
const UNITS: f64 = (1u64 << 32) as f64;

/// All cells between a row of rising view depths.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    pub cells: Vec<Cell>,
    /// Scratch: bounds of each cell that the receivers of a group may change; `None` if they change
    /// none.
    widened: Vec<Option<Undecided>>,
    /// Scratch: the questions about a group of casters, and the cells that they are about.
    questions: Vec<(usize, Question)>,
    /// Scratch: the shares of the casters in each of these cells.
    shares: Vec<[f64; WIDE]>,
    /// Unit in which edges are counted, in metres.
    unit: f64,
}

impl Cells {
    /// Fills the cells between `depths`.
    pub fn gather(&mut self, sight: &Sight, depths: &[f64]) {
        self.cells.clear();
        self.cells.extend(depths.windows(2).map(|pair| Cell::new(Slice::new(sight.view, pair[0], pair[1]), sight.fan)));
        self.gather_receivers(sight, depths);
        self.cells.iter_mut().for_each(|cell| cell.least_direction = cell.receivers.least_direction());
        self.gather_casters(sight, depths);
    }

    fn gather_receivers(&mut self, sight: &Sight, depths: &[f64]) {
        let &Sight { view, fan, .. } = sight;
        let forward = view.forward();
        let whole = Slice::new(view, depths[0], depths[depths.len() - 1]);
        let extent = |placed: &Placed| {
            let (depth, reach) = (view.view_depth(placed.center), forward.abs().dot(placed.half));
            cells_between(depths, depth - reach, depth + reach)
        };
        let groups = &sight.receivers.groups;
        let boxes = |group: &Group| &sight.receivers.boxes[group.range()];
        let is_long = |placed: &Placed| extent(placed).len() > LONG;
        let mut widened = std::mem::take(&mut self.widened);
        widened.clear();
        widened.resize(self.cells.len(), Some(Undecided::ALL));
        // Few boxes make most of the bounds: those that are long, a ground above all.
        for group in groups.iter().filter(|group| is_long(&group.bounds)) {
            for placed in boxes(group).iter().filter(|it| is_long(it)) {
                self.include((sight, depths), (&whole, &widened), placed, extent(placed));
            }
        }
        for group in spread(groups) {
            let (hull, cells) = (Hull::new(fan, &group.bounds), extent(&group.bounds));
            let mut any = false;
            for (cell, asked) in self.cells[cells.clone()].iter().zip(&mut widened[cells]) {
                let among = cell.receivers.widened_by(&hull);
                *asked = cell.widened(fan, (&group.bounds, &group.exact), among);
                any |= asked.is_some();
            }
            if any {
                for placed in boxes(group).iter().filter(|it| !is_long(it)) {
                    self.include((sight, depths), (&whole, &widened), placed, extent(placed));
                }
            }
        }
        self.widened = widened;
    }

    /// Includes a receiver in the cells in which it has a part and whose bounds it may change.
    fn include(
        &mut self,
        (sight, depths): (&Sight, &[f64]),
        (whole, widened): (&Slice, &[Option<Undecided>]),
        placed: &Placed,
        cells: std::ops::Range<usize>,
    ) {
        let mut lies = None;
        let bounds = placed.bounds();
        for i in cells {
            let cell = &mut self.cells[i];
            let Some(widened) = widened[i].and_then(|among| cell.widened(sight.fan, (placed, &bounds), among)) else {
                continue;
            };
            let slice = cell.slice;
            let include = |point| cell.include(sight.fan, point, (&bounds, widened));
            match lies.get_or_insert_with(|| whole.classify(placed.center, placed.half)) {
                Lies::Outside => return,
                Lies::Inside => between_depths(sight.view, &bounds, depths[i], depths[i + 1], include),
                Lies::Across => {
                    slice.clip_box(&bounds, include);
                }
            }
        }
    }

    fn gather_casters(&mut self, sight: &Sight, depths: &[f64]) {
        let &Sight { view, fan, .. } = sight;
        let (forward, direction) = (view.forward(), fan.depth);
        let (slope, across) = (direction.dot(forward), across(direction));
        let longest = sight.casters.most(|caster| outline(caster.half, across));
        self.unit = longest.max(f64::MIN_POSITIVE) / UNITS;
        let deepest = self.cells.iter().map(|cell| cell.receivers.depth.1).fold(f64::NEG_INFINITY, f64::max);
        // View depths between which a shadow lies: it leaves its box along the light until it is
        // below all receivers.
        let shadow = |placed: &Placed, first: f64| {
            let (depth, reach) = (view.view_depth(placed.center), forward.abs().dot(placed.half));
            let travel = slope * (deepest - first).max(0.0);
            (depth - reach + travel.min(0.0), depth + reach + travel.max(0.0))
        };
        let Self { cells, questions, shares, unit, .. } = self;
        let mut casters = Lanes::new();
        for (group, hull) in sight.casters.blocks().flat_map(|(block, _)| sight.casters.groups_of(block)) {
            let own;
            let hull = match hull {
                Some(hull) => hull,
                None => {
                    own = Hull::new(fan, &group.bounds);
                    &own
                }
            };
            let (from, to) = shadow(&group.bounds, hull.region.depth.0);
            let reached = cells_between(depths, from, to);
            questions.clear();
            questions
                .extend(reached.filter_map(|i| Some((i, Question::new(&cells[i], &group.core, hull, direction)?))));
            if questions.is_empty() {
                continue;
            }
            let asked = questions.iter().fold(0, |asked, (_, it)| asked | it.directions);
            casters.fill(&sight.casters.boxes[group.range()], (fan, asked), shadow, across);
            let mut held = [0.0; WIDE];
            shares.clear();
            for (i, question) in questions.iter() {
                let own = question.shares(&cells[*i], &casters, (depths[*i], depths[*i + 1]), direction);
                for lane in 0..WIDE {
                    held[lane] += greater(own[lane], 0.0);
                }
                shares.push(own);
            }
            // A shadow lies in one place: where boxes are high, several cells seem to hold the same
            // piece of it.
            let mut length = [0.0; WIDE];
            for lane in 0..WIDE {
                length[lane] = casters.outline[lane] / greater(held[lane], 1.0);
            }
            for ((i, question), own) in questions.iter().zip(shares.iter()) {
                let cell = &mut cells[*i];
                for lane in (0..WIDE).filter(|&lane| own[lane] >= 0.0) {
                    cell.edges += (own[lane] * length[lane] / *unit) as u64;
                }
                cell.include_casters(&casters, own, question.widened);
            }
        }
    }

    /// Weight of each cell: the expected error of its pixels for each metre of a texel's edge, as a
    /// share of that of all cells.
    ///
    /// An edge of a shadow is off by a share of a texel, so that the wrongly shaded area is the
    /// length of the edges times the texel's edge. Shadows mostly lie on ground, of which a view
    /// from some height shows 1/z³ pixels per square metre at depth z. A small part of the weight
    /// uses pixels alone, for edges that boxes do not represent: the rows of pixels that such
    /// ground fills.
    pub fn weigh(&self, projection: Projection, depths: &[f64], weights: &mut Vec<f64>) {
        let pixels = |pair: &[f64]| match projection {
            Projection::Perspective => 1.0 / pair[0] - 1.0 / pair[1],
            Projection::Orthographic => pair[1] - pair[0],
        };
        let edges = |pair: &[f64], cell: &Cell| match projection {
            Projection::Perspective => self.unit * cell.edges as f64 * to_minus_three_halves(pair[0] * pair[1]),
            Projection::Orthographic => self.unit * cell.edges as f64,
        };
        let shadowed = || depths.windows(2).zip(&self.cells).filter(|(_, cell)| !cell.casters.is_empty());
        let all_pixels: f64 = shadowed().map(|(pair, _)| pixels(pair)).sum();
        let all_edges: f64 = shadowed().map(|(pair, cell)| edges(pair, cell)).sum();
        weights.clear();
        weights.extend(depths.windows(2).zip(&self.cells).map(|(pair, cell)| {
            if cell.casters.is_empty() {
                return 0.0;
            }
            let by_pixels = pixels(pair) / all_pixels;
            let by_edges = if all_edges > 0.0 { edges(pair, cell) / all_edges } else { by_pixels };
            (1.0 - SHARE_BY_PIXELS) * by_edges + SHARE_BY_PIXELS * by_pixels
        }));
    }
}

/// Share of the expected error that is spread by pixels alone.
const SHARE_BY_PIXELS: f64 = 0.1;

/// The cells that have a part between two view depths.
fn cells_between(depths: &[f64], from: f64, to: f64) -> std::ops::Range<usize> {
    let last = depths.len() - 1;
    let begin = depths.partition_point(|&depth| depth <= from).saturating_sub(1);
    let end = depths.partition_point(|&depth| depth < to).min(last);
    begin.min(end)..end
}

/// Calls `each` with points whose convex hull is the part of `bounds` between two view depths.
fn between_depths(view: &View, bounds: &Aabb, from: f64, to: f64, mut each: impl FnMut(DVec3)) {
    let corners = bounds.corners();
    let depths = corners.map(|corner| view.view_depth(corner));
    for (i, &corner) in corners.iter().enumerate() {
        if (from..=to).contains(&depths[i]) {
            each(corner);
        }
        for j in [i | 1, i | 2, i | 4] {
            for plane in [from, to] {
                let (a, b) = (depths[i] - plane, depths[j] - plane);
                if a * b < 0.0 {
                    each(corner.lerp(corners[j], a / (a - b)));
                }
            }
        }
    }
}

/// `x` to the power of −3/2, by operations that are exactly defined.
fn to_minus_three_halves(x: f64) -> f64 {
    1.0 / (x * x.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Frustum;

    #[test]
    fn cells_of_an_interval() {
        let depths = [1.0, 2.0, 4.0, 8.0];
        assert_eq!(cells_between(&depths, 0.0, 0.5), 0..0);
        assert_eq!(cells_between(&depths, 0.0, 1.5), 0..1);
        assert_eq!(cells_between(&depths, 2.5, 3.0), 1..2);
        assert_eq!(cells_between(&depths, 2.0, 4.0), 1..2);
        assert_eq!(cells_between(&depths, 1.5, 100.0), 0..3);
        assert!(cells_between(&depths, 9.0, 100.0).is_empty());
    }

    #[test]
    fn a_cell_meets_an_interval_that_meets_its_depths() {
        let depths = [1.0, 2.0, 4.0, 8.0, 16.0];
        let ends = [-1.0, 0.5, 1.0, 1.5, 2.0, 3.0, 8.0, 9.0, 16.0, 20.0];
        for (from, to) in ends.iter().flat_map(|&from| ends.map(|to| (from, to))).filter(|(from, to)| from <= to) {
            let meets = |&i: &usize| depths[i + 1] > from && depths[i] < to;
            assert!(cells_between(&depths, from, to).eq((0..4).filter(meets)), "{from} {to}");
        }
    }

    #[test]
    fn a_box_between_two_depths_keeps_its_sides_and_loses_its_ends() {
        let frustum = Frustum::perspective(1.0, 1.0, 1.0, 100.0).expect("valid");
        let view = View::look_at_upright(DVec3::ZERO, DVec3::NEG_Z, frustum).expect("valid");
        let bounds = Aabb::new(DVec3::new(-1.0, -2.0, -30.0), DVec3::new(1.0, 2.0, -10.0));
        let mut part = Aabb::EMPTY;
        between_depths(&view, &bounds, 15.0, 20.0, |point| part = part.including(point));
        assert!((part.min - DVec3::new(-1.0, -2.0, -20.0)).length() < 1e-9, "{part:?}");
        assert!((part.max - DVec3::new(1.0, 2.0, -15.0)).length() < 1e-9, "{part:?}");
    }

    #[test]
    fn the_outline_of_a_cube_seen_along_an_axis_is_its_square() {
        assert!((outline(DVec3::splat(0.5), across(DVec3::NEG_Y)) - 4.0).abs() < 1e-12);
    }
}
