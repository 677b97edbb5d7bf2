//! Thin slices of the view, and for each the bounds of its receivers and casters and the amount of
//! shadow edges that the image shows there.

use glam::DVec3;

use crate::bounds::Placed;
use crate::casters::{Gathered, Group, Most};
use crate::geometry::region::{DIRECTIONS, Fan, Region};
use crate::geometry::volume::{Lies, Slice, lies_below};
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

/// The part of the view between two candidate planes.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    slice: Slice,
    /// The receivers inside, in the light's plane and in the world.
    pub receivers: Region,
    bounds: Aabb,
    /// Bounds of the whole casters that can shade the receivers; empty if there are none.
    pub casters: Region,
    /// Expected length of shadow edges in the light's plane, in [`Cells::unit`]: an integer, so
    /// that the sum does not depend on its order.
    edges: u64,
    /// [`Region::least_direction`] of the receivers, once all are included.
    least_direction: usize,
}

impl Cell {
    fn new(slice: Slice) -> Self {
        Self {
            slice,
            receivers: Region::EMPTY,
            bounds: Aabb::EMPTY,
            casters: Region::EMPTY,
            edges: 0,
            least_direction: 0,
        }
    }

    /// Includes a point of a box.
    fn include(&mut self, fan: &Fan, point: DVec3, of: &Aabb) {
        self.receivers.include_point(fan, point);
        self.bounds = self.bounds.including(point.clamp(of.min, of.max));
    }

    /// Returns whether no part of a box can change the cell.
    fn holds(&self, fan: &Fan, bounds: &Aabb, Placed { center, half }: &Placed) -> bool {
        self.bounds.union(*bounds) == self.bounds && self.receivers.encloses_box(fan, *center, *half)
    }

    /// Returns whether a caster with these bounds can shade the cell's receivers.
    fn can_be_shadowed_by(&self, bounds: &Region) -> bool {
        bounds.depth.0 <= self.receivers.depth.1
            && (0..DIRECTIONS).all(|k| bounds.lo[k] <= self.receivers.hi[k] && bounds.hi[k] >= self.receivers.lo[k])
    }
}

/// The share of a caster's rectangle that lies in `region`, on the axes of the least rectangle of
/// `region`.
fn share(caster: &Region, region: &Region, u: usize) -> f64 {
    [u, u + DIRECTIONS / 2]
        .into_iter()
        .map(|k| {
            let width = caster.hi[k] - caster.lo[k];
            let common = caster.hi[k].min(region.hi[k]) - caster.lo[k].max(region.lo[k]);
            if width > 0.0 { (common / width).clamp(0.0, 1.0) } else { 1.0 }
        })
        .product()
}

/// Length of a box's outline as seen from the light: two edges along each axis.
fn outline(half: DVec3, direction: DVec3) -> f64 {
    (0..3).map(|axis| 4.0 * half[axis] * (1.0 - direction[axis] * direction[axis]).max(0.0).sqrt()).sum()
}

/// A receiver with parts in more cells than this counts as long.
const LONG: usize = 8;

/// Number of units in the longest outline of a caster.
const UNITS: f64 = (1u64 << 32) as f64;

/// All cells between a row of rising view depths.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    pub cells: Vec<Cell>,
    shares: Vec<f64>,
    /// Unit in which edges are counted, in metres.
    unit: f64,
}

impl Cells {
    /// Fills the cells between `depths`.
    pub fn gather(&mut self, sight: &Sight, depths: &[f64]) {
        self.cells.clear();
        self.cells.extend(depths.windows(2).map(|pair| Cell::new(Slice::new(sight.view, pair[0], pair[1]))));
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
        // Few boxes make most of the bounds: those that are long, a ground above all.
        for group in groups.iter().filter(|group| is_long(&group.bounds)) {
            for placed in boxes(group).iter().filter(|it| is_long(it)) {
                self.include((sight, depths), &whole, placed, extent(placed));
            }
        }
        for group in groups {
            let holds = |i: usize| self.cells[i].holds(fan, &group.exact, &group.bounds);
            if extent(&group.bounds).all(holds) {
                continue;
            }
            for placed in boxes(group).iter().filter(|it| !is_long(it)) {
                self.include((sight, depths), &whole, placed, extent(placed));
            }
        }
    }

    /// Includes a receiver in the cells in which it has a part.
    fn include(
        &mut self,
        (sight, depths): (&Sight, &[f64]),
        whole: &Slice,
        placed: &Placed,
        cells: std::ops::Range<usize>,
    ) {
        let lies = whole.classify(placed.center, placed.half);
        if lies == Lies::Outside {
            return;
        }
        let bounds = placed.bounds();
        for i in cells {
            let cell = &mut self.cells[i];
            if cell.holds(sight.fan, &bounds, placed) {
                continue;
            }
            let slice = cell.slice;
            let include = |point| cell.include(sight.fan, point, &bounds);
            match lies {
                Lies::Inside => between_depths(sight.view, &bounds, depths[i], depths[i + 1], include),
                _ => {
                    slice.clip_box(&bounds, include);
                }
            }
        }
    }

    fn gather_casters(&mut self, sight: &Sight, depths: &[f64]) {
        let &Sight { view, fan, .. } = sight;
        let forward = view.forward();
        let direction = fan.depth;
        let longest = sight.casters.most(|caster| outline(caster.half, direction));
        self.unit = longest.max(f64::MIN_POSITIVE) / UNITS;
        let deepest = self.cells.iter().map(|cell| cell.receivers.depth.1).fold(f64::NEG_INFINITY, f64::max);
        for &Placed { center, half } in &sight.casters.boxes {
            let mut bounds = Region::EMPTY;
            bounds.include_box(fan, center, half);
            // The shadow leaves the box along the light until it is below all receivers.
            let (depth, reach) = (view.view_depth(center), forward.abs().dot(half));
            let travel = direction.dot(forward) * (deepest - bounds.depth.0).max(0.0);
            let from = depth - reach + travel.min(0.0);
            let to = depth + reach + travel.max(0.0);
            let reached = cells_between(depths, from, to);
            self.shares.clear();
            self.shares.extend(self.cells[reached.clone()].iter().map(|cell| {
                let shaded = !cell.receivers.is_empty()
                    && cell.can_be_shadowed_by(&bounds)
                    && !lies_below(center, half, &cell.bounds, direction, 0.0);
                if shaded { share(&bounds, &cell.receivers, cell.least_direction) } else { -1.0 }
            }));
            // A shadow lies in one place: where boxes are high, several cells seem to hold the same
            // piece of it.
            let held: f64 = self.shares.iter().map(|share| share.max(0.0)).sum();
            let length = outline(half, direction) / held.max(1.0);
            for (cell, &share) in self.cells[reached].iter_mut().zip(&self.shares) {
                if share >= 0.0 {
                    cell.casters.include_region(&bounds);
                    cell.edges += (share * length / self.unit) as u64;
                }
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
        assert!((outline(DVec3::splat(0.5), DVec3::NEG_Y) - 4.0).abs() < 1e-12);
    }
}
