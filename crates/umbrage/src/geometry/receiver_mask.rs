//! Mask of the receivers of a split along the light. A caster without a receiver behind it casts no
//! visible shadow.
//!
//! Source: Bittner, Mattausch, Silvennoinen and Wimmer, *Shadow Caster Culling for Efficient Shadow
//! Mapping*, I3D 2011. They draw the receivers into a mask on the GPU and test it by occlusion
//! queries. Here it is a small grid on the CPU, made from boxes, so that it is known before
//! anything is drawn.

use glam::{DVec2, DVec3};

use super::volume::{Lies, Slice};
use crate::{Aabb, CasterMask};

/// Cells along each edge of the grid.
pub(crate) const CELLS: usize = 64;

/// Steepest receiver, as depth along the light over length across it, whose plane a filter follows
/// beyond the receiver's own box.
const STEEPEST: f64 = 4.0;

/// Least rise of the light over one metre of a world axis for which the axis may serve as the axis
/// of heights.
const LEAST_RISE: f64 = 0.1;

/// A grid across the light that stores in each cell how far down the light the receivers of a split
/// reach.
///
/// The grid lies in a plane square to a world axis and is looked at along the light, so that a box
/// that is flat along this axis, a piece of ground, has the same height everywhere: *height* is the
/// coordinate along that axis, counted towards the light.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ReceiverMask {
    /// World axes: that of heights, then those of the grid.
    axes: [usize; 3],
    /// Sign, 1 or −1: height is `sign` times the coordinate.
    sign: f64,
    /// Distance that a ray of light moves along the grid's axes per unit of height.
    slope: DVec2,
    begin: DVec2,
    cell: DVec2,
    /// Least heights of receivers, row after row; infinite for a cell without receivers.
    lowest: Vec<f32>,
}

impl ReceiverMask {
    /// Fills the mask with the parts of the boxes `parts` that lie in `slice`; `bounds` is around
    /// all of them. Filters reach `margin` metres.
    pub fn fill(&mut self, slice: &Slice, bounds: &Aabb, parts: &[Aabb], direction: DVec3, margin: f64) {
        let extent = bounds.max - bounds.min;
        let crossed_fast = |axis: usize| match direction[axis].abs() {
            rise if rise >= LEAST_RISE => rise / extent[axis].max(1e-9),
            _ => 0.0,
        };
        let axis = (1..3).fold(0, |best, axis| if crossed_fast(axis) > crossed_fast(best) { axis } else { best });
        self.axes = [axis, (axis + 1) % 3, (axis + 2) % 3];
        self.sign = -direction[axis].signum();
        let rise = direction[axis].abs();
        self.slope = DVec2::new(direction[self.axes[1]], direction[self.axes[2]]) / rise;
        // Across the light `margin` metres are at most so many in the grid's plane, and so much of
        // height.
        let reach = margin / rise;
        let room = margin * ((1.0 - rise * rise).max(0.0).sqrt() + STEEPEST * rise);

        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in slice.corners {
            let at = self.on_grid(corner);
            (lo, hi) = (lo.min(at), hi.max(at));
        }
        let (box_lo, box_hi) = self.footprint(bounds.center(), bounds.half_extent());
        (lo, hi) = (lo.max(box_lo) - reach, hi.min(box_hi) + reach);
        self.lowest.clear();
        self.lowest.resize(CELLS * CELLS, f32::INFINITY);
        self.begin = lo;
        // Rounding must not make a cell of nothing.
        self.cell = ((hi - lo) / CELLS as f64).max(DVec2::splat(1e-9 * (1.0 + lo.abs().max_element())));

        for part in parts {
            let (center, half) = (part.center(), part.half_extent());
            if slice.classify(center, half) == Lies::Outside {
                continue;
            }
            let (lo, hi) = self.footprint(center, half);
            let Some([columns, rows]) = self.cells(lo - reach, hi + reach) else { continue };
            for row in rows {
                for column in columns.clone() {
                    let part = self.heights_of_box(center, half, column, row, reach);
                    if part.0 <= part.1
                        && let within = self.heights_of_slice(slice, column, row, reach)
                        && part.0.max(within.0) <= part.1.min(within.1)
                    {
                        // Rounded down.
                        let height = (part.0.max(within.0) - room) as f32;
                        let lowest = &mut self.lowest[row * CELLS + column];
                        *lowest = lowest.min(height.next_down());
                    }
                }
            }
        }
    }

    /// The mask for boxes relative to an origin, in `f32`.
    pub fn caster_mask(&self, origin: DVec3) -> CasterMask {
        let below = self.sign * origin[self.axes[0]];
        CasterMask {
            axis: self.axes[0] as u32,
            sign: self.sign as f32,
            slope: self.slope.as_vec2(),
            begin: (self.begin - self.on_grid(origin)).as_vec2(),
            cell: self.cell.as_vec2(),
            lowest: self.lowest.iter().map(|&height| ((f64::from(height) - below) as f32).next_down()).collect(),
        }
    }

    /// Returns whether a receiver lies behind any part of a box as seen from the light
    /// (conservative).
    pub fn lies_before_some(&self, center: DVec3, half: DVec3) -> bool {
        let (lo, hi) = self.footprint(center, half);
        let Some([columns, mut rows]) = self.cells(lo, hi) else { return false };
        rows.any(|row| {
            columns.clone().any(|column| {
                let lowest = f64::from(self.lowest[row * CELLS + column]);
                let heights = self.heights_of_box(center, half, column, row, 0.0);
                heights.0 <= heights.1 && heights.1 > lowest
            })
        })
    }

    fn height(&self, point: DVec3) -> f64 {
        self.sign * point[self.axes[0]]
    }

    /// The point where the ray of light through `point` crosses height 0.
    fn on_grid(&self, point: DVec3) -> DVec2 {
        DVec2::new(point[self.axes[1]], point[self.axes[2]]) + self.slope * self.height(point)
    }

    /// The rectangle around a box on the grid's plane.
    fn footprint(&self, center: DVec3, half: DVec3) -> (DVec2, DVec2) {
        let at = self.on_grid(center);
        let reach = DVec2::new(half[self.axes[1]], half[self.axes[2]]) + self.slope.abs() * half[self.axes[0]];
        (at - reach, at + reach)
    }

    /// Columns and rows of the cells that a rectangle touches.
    fn cells(&self, lo: DVec2, hi: DVec2) -> Option<[std::ops::RangeInclusive<usize>; 2]> {
        let (lo, hi) = (((lo - self.begin) / self.cell).floor(), ((hi - self.begin) / self.cell).floor());
        let last = (CELLS - 1) as f64;
        let meets = hi.cmpge(DVec2::ZERO).all() && lo.cmple(DVec2::splat(last)).all();
        let range = |lo: f64, hi: f64| lo.max(0.0) as usize..=hi.min(last) as usize;
        meets.then(|| [range(lo.x, hi.x), range(lo.y, hi.y)])
    }

    /// A cell widened by `reach`.
    fn rectangle(&self, column: usize, row: usize, reach: f64) -> (DVec2, DVec2) {
        // A little more, for the rounding of whoever asks for a cell.
        let reach = DVec2::splat(reach) + 1e-6 * self.cell;
        let lo = self.begin + self.cell * DVec2::new(column as f64, row as f64);
        (lo - reach, lo + self.cell + reach)
    }

    /// Lowest and highest height of a box over a cell. The first is above the second if the box is
    /// nowhere over the cell.
    fn heights_of_box(&self, center: DVec3, half: DVec3, column: usize, row: usize, reach: f64) -> (f64, f64) {
        let (lo, hi) = self.rectangle(column, row, reach);
        let (middle, thickness) = (self.height(center), half[self.axes[0]]);
        let mut heights = (middle - thickness, middle + thickness);
        for k in 0..2 {
            let (middle, width, slope) = (center[self.axes[1 + k]], half[self.axes[1 + k]], self.slope[k]);
            // At height h the box is over grid coordinates middle ± width + slope h.
            if slope.abs() > 1e-9 {
                let (a, b) = ((lo[k] - middle - width) / slope, (hi[k] - middle + width) / slope);
                heights = (heights.0.max(a.min(b)), heights.1.min(a.max(b)));
            }
        }
        heights
    }

    /// Heights between which a slice lies over a column and row.
    fn heights_of_slice(&self, slice: &Slice, column: usize, row: usize, reach: f64) -> (f64, f64) {
        let (lo, hi) = self.rectangle(column, row, reach);
        let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
        let mut heights = (f64::NEG_INFINITY, f64::INFINITY);
        for plane in &slice.planes {
            let across = DVec2::new(plane.normal[self.axes[1]], plane.normal[self.axes[2]]);
            // The plane's distance from where the light crosses height h, over the middle: `at +
            // rise h`.
            let rise = self.sign * plane.normal[self.axes[0]] - across.dot(self.slope);
            let at = across.dot(middle) - plane.offset - across.abs().dot(half);
            match rise {
                rise if rise > 1e-9 => heights.1 = heights.1.min(-at / rise),
                rise if rise < -1e-9 => heights.0 = heights.0.max(-at / rise),
                // Along the light; the plane may rise by so much over any height that matters.
                _ if at > 1e-3 => return (f64::INFINITY, f64::NEG_INFINITY),
                _ => {}
            }
        }
        heights
    }
}
