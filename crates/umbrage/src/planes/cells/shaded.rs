//! The casters that shade the receivers of a cell, and the share of their shadows that it holds: a
//! group of neighbours at a time.

use glam::DVec3;

use super::cell::Cell;
use crate::Aabb;
use crate::bounds::Placed;
use crate::casters::WIDE;
use crate::geometry::region::{DIRECTIONS, Fan, Hull, Undecided, bits, greater, lesser};
use crate::geometry::volume::{lies_below, some_lies_below};

impl Cell {
    /// Includes those casters that have a share in those bounds that they may change.
    pub(super) fn include_casters(&mut self, casters: &Lanes, shares: &[f64; WIDE], widened: Undecided) {
        let region = &mut self.casters;
        let has_share = |lane: usize| shares[lane] >= 0.0;
        for k in bits(widened.directions) {
            let (lo, hi) = &casters.ends[k];
            let (mut least, mut most) = ([f64::INFINITY; CHAINS], [f64::NEG_INFINITY; CHAINS]);
            for lane in 0..WIDE {
                let (least, most) = (&mut least[lane % CHAINS], &mut most[lane % CHAINS]);
                *least = lesser(*least, if has_share(lane) { lo[lane] } else { f64::INFINITY });
                *most = greater(*most, if has_share(lane) { hi[lane] } else { f64::NEG_INFINITY });
            }
            region.lo[k] = least.into_iter().fold(region.lo[k], lesser);
            region.hi[k] = most.into_iter().fold(region.hi[k], greater);
        }
        for lane in (0..WIDE).filter(|&lane| widened.depth && has_share(lane)) {
            region.depth = (region.depth.0.min(casters.first[lane]), region.depth.1.max(casters.last[lane]));
        }
    }
}

/// A question about a cell for the casters of a group.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Question {
    /// Bounds of the receivers on which it depends whether a caster can shade them.
    shading: Undecided,
    /// True if a caster may lie below all receivers.
    may_be_below: bool,
    /// Bounds of the casters that one of them may change.
    pub widened: Undecided,
    /// True if every caster lies in the receivers' rectangle.
    is_inside: bool,
    /// Directions along which bounds of a caster have to be known.
    pub directions: u32,
}

impl Question {
    /// The question about a group; `None` if none of its casters can shade the cell's receivers.
    pub fn new(cell: &Cell, core: &Aabb, hull: &Hull, direction: DVec3) -> Option<Self> {
        if cell.receivers.is_empty() {
            return None;
        }
        let shading = cell.receivers.undecided_in(hull, 0.0)?;
        let widened = cell.casters.widened_by(hull);
        let rectangle = 1 << cell.least_direction | 1 << (cell.least_direction + DIRECTIONS / 2);
        let is_inside = shading.directions & rectangle == 0;
        let directions = shading.directions | widened.directions | if is_inside { 0 } else { rectangle };
        let may_be_below = some_lies_below(core, &cell.bounds, direction);
        Some(Self { shading, may_be_below, widened, is_inside, directions })
    }

    /// The share of each caster's shadow that the cell holds; [`NONE`] for those that cannot shade
    /// the cell's receivers. The cell lies between these view depths.
    pub fn shares(&self, cell: &Cell, casters: &Lanes, (near, far): (f64, f64), direction: DVec3) -> [f64; WIDE] {
        let receivers = &cell.receivers;
        let set_if = |holds: bool| 0u64.wrapping_sub(u64::from(holds));
        let mut out: [u64; WIDE] =
            std::array::from_fn(|lane| set_if((far <= casters.from[lane]) | (near >= casters.to[lane])));
        if self.shading.depth {
            for (out, &first) in out.iter_mut().zip(&casters.first) {
                *out |= set_if(first > receivers.depth.1);
            }
        }
        for k in bits(self.shading.directions) {
            let (lo, hi, ends) = (receivers.lo[k], receivers.hi[k], &casters.ends[k]);
            for (out, (&begin, &end)) in out.iter_mut().zip(ends.0.iter().zip(&ends.1)) {
                *out |= set_if((begin > hi) | (end < lo));
            }
        }
        if self.may_be_below {
            for (out, caster) in out.iter_mut().zip(casters.boxes) {
                *out |= set_if(lies_below(caster.center, caster.half, &cell.bounds, direction, 0.0));
            }
        }
        let mut shares = [1.0; WIDE];
        if !self.is_inside {
            // On the axes of the receivers' least rectangle.
            for k in [cell.least_direction, cell.least_direction + DIRECTIONS / 2] {
                let (lo, hi, ends) = (receivers.lo[k], receivers.hi[k], &casters.ends[k]);
                for (own, (&begin, &end)) in shares.iter_mut().zip(ends.0.iter().zip(&ends.1)) {
                    *own *= share((begin, end), (lo, hi));
                }
            }
        }
        for (share, out) in shares.iter_mut().zip(out) {
            *share = if out == 0 { *share } else { NONE };
        }
        shares
    }
}

/// Numbers of which the least and the greatest are looked for side by side.
const CHAINS: usize = 4;

/// A share that stands for no shadow at all.
const NONE: f64 = -1.0;

/// The share of a caster's extent that lies within others'.
fn share(caster: (f64, f64), within: (f64, f64)) -> f64 {
    let (width, common) = (caster.1 - caster.0, lesser(caster.1, within.1) - greater(caster.0, within.0));
    if width > 0.0 { lesser(greater(common / width, 0.0), 1.0) } else { 1.0 }
}

/// The casters of a group, value by value. Lanes without a caster repeat the first one, out of
/// reach of every cell.
pub(super) struct Lanes<'a> {
    boxes: &'a [Placed],
    /// Bounds along those directions that are asked for.
    ends: [([f64; WIDE], [f64; WIDE]); DIRECTIONS],
    /// Depths along the light.
    first: [f64; WIDE],
    last: [f64; WIDE],
    /// View depths between which the shadow lies.
    from: [f64; WIDE],
    to: [f64; WIDE],
    /// Lengths of outlines.
    pub outline: [f64; WIDE],
}

impl<'a> Lanes<'a> {
    pub fn new() -> Self {
        let (boxes, ends) = (&[][..], [([0.0; WIDE], [0.0; WIDE]); DIRECTIONS]);
        let [first, last, from, to, outline] = [[0.0; WIDE]; 5];
        Self { boxes, ends, first, last, from, to, outline }
    }

    pub fn fill(
        &mut self,
        boxes: &'a [Placed],
        (fan, directions): (&Fan, u32),
        shadow: impl Fn(&Placed, f64) -> (f64, f64),
        across: DVec3,
    ) {
        self.boxes = boxes;
        let (mut center, mut half) = ([[0.0; WIDE]; 3], [[0.0; WIDE]; 3]);
        for lane in 0..WIDE {
            let caster = boxes.get(lane).unwrap_or(&boxes[0]);
            for axis in 0..3 {
                (center[axis][lane], half[axis][lane]) = (caster.center[axis], caster.half[axis]);
            }
            (self.first[lane], self.last[lane]) = fan.depths(caster);
            (self.from[lane], self.to[lane]) = match lane < boxes.len() {
                true => shadow(caster, self.first[lane]),
                false => (f64::INFINITY, f64::NEG_INFINITY),
            };
            self.outline[lane] = outline(caster.half, across);
        }
        for k in bits(directions) {
            fan.ends_of_all(k, &center, &half, &mut self.ends[k]);
        }
    }
}

/// Lengths across the light of a metre along each world axis.
pub(super) fn across(direction: DVec3) -> DVec3 {
    DVec3::from([0, 1, 2].map(|axis| (1.0 - direction[axis] * direction[axis]).max(0.0).sqrt()))
}

/// Length of a box's outline as seen from the light: two edges along each axis.
pub(super) fn outline(half: DVec3, across: DVec3) -> f64 {
    (0..3).map(|axis| 4.0 * half[axis] * across[axis]).sum()
}
