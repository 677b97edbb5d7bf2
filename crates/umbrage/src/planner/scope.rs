//! Stage 0 of a sun's plan: the extent of the shadows that a frame can show, whichever way the
//! camera turns.
//!
//! A range that ends with the scene wastes its splits if the scene is a few boxes on a ground of a
//! thousand kilometres, or if one hut stands beyond the horizon. The range therefore follows from
//! where shadows fall: each caster's box, swept along the light through the box around all
//! receivers.

use glam::{DVec2, DVec3};

use super::frame::{Frame, Sun};
use crate::bounds::Placed;
use crate::casters::Most;
use crate::geometry::volume::lies_below;
use crate::{Aabb, Projection, View, maths};

/// Receivers that together fill less than this share of the image, and lie beyond all others, are
/// ignored in the range.
const LEAST_SHARE: f64 = 1e-4;

/// Receivers beyond are ignored only if the range would be this many times as long with them.
const MUCH_FARTHER: f64 = 4.0;

/// Most multiples of the depth of the deepest shadow at which the range ends. With a lower value
/// shadows are sharper, but the range follows the casters; with a higher one they are blurred.
const SLACK: f64 = 1.5;

/// Range of a view that looks away from all shadows, as a share of their greatest distance.
const LOOKING_AWAY: f64 = 0.5;

/// Number of classes of distance, one for each doubling, from 2^-[`NEAREST`] m on.
const CLASSES: usize = 96;
const NEAREST: i32 = 32;

/// Most casters without thickness whose shadows are looked for receiver by receiver; more are
/// assumed to be the worst case.
const MOST_SHEETS: usize = 8;

/// The relevant part of the scene for a frame. It is measured when it is needed.
#[derive(Clone, Copy)]
pub(super) struct Scope<'a> {
    frame: &'a Frame<'a>,
    direction: DVec3,
    /// Distance from the camera in metres beyond which no receiver is relevant: one that begins
    /// there or farther.
    distance: f64,
    /// Distance from the camera in metres beyond which no shadow is relevant: where the relevant
    /// receivers end.
    shadow_distance: f64,
}

/// Extent of the relevant part of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    /// View depth of the deepest relevant receiver, or of the deepest shadow with [`SLACK`],
    /// whichever is less.
    pub deepest: f64,
    /// Distance from the camera in metres of the farthest of both.
    pub farthest: f64,
    /// Distance from the camera in metres of the box around all receivers.
    pub nearest: f64,
}

impl<'a> Scope<'a> {
    pub fn new(frame: &'a Frame<'a>, sun: &Sun<'_>) -> Self {
        let [distance, shadow_distance] = visible_distances(frame);
        Self { frame, direction: sun.direction, distance, shadow_distance }
    }

    /// Returns whether a receiver, or any receiver in a box, is relevant.
    pub fn matters(&self, receiver: &Placed) -> bool {
        receiver.distance_to(self.frame.view.eye()) <= self.distance
    }

    /// View depth of the deepest of all receivers.
    pub fn deepest_receiver(&self) -> f64 {
        self.frame.receivers.most(|receiver| deepest(self.frame.view, receiver))
    }

    /// Measures the extent of the relevant part of the scene.
    pub fn extent(&self) -> Extent {
        let &Self { frame, direction, shadow_distance, .. } = self;
        let matters = |receiver: &Placed| self.matters(receiver);
        let bounds = frame.receivers.bounds(matters);
        let all = Reach::most(frame.view, |of| frame.receivers.most(|r| if matters(r) { of(r) } else { NOTHING }));
        let nearest = if bounds.is_empty() { 0.0 } else { Placed::from(bounds).distance_to(frame.view.eye()) };
        let shadows = Shadows { frame, direction, distance: shadow_distance }.reach(&bounds);
        let (mut deepest, mut farthest) = (all.deepest, all.farthest);
        if shadows.farthest > 0.0 {
            let ahead = (SLACK * shadows.deepest).max(LOOKING_AWAY * shadows.farthest);
            (deepest, farthest) = (deepest.min(ahead), farthest.min(SLACK * shadows.farthest));
        }
        Extent { deepest, farthest, nearest }
    }
}

/// Depth and distance of the farthest of some boxes.
#[derive(Clone, Copy, Debug)]
struct Reach {
    deepest: f64,
    farthest: f64,
}

/// Measure of a box that does not count.
const NOTHING: f64 = f64::NEG_INFINITY;

impl Reach {
    const NONE: Self = Self { deepest: NOTHING, farthest: 0.0 };

    /// The reach of some boxes, whose largest measure `most` finds.
    fn most(view: &View, most: impl Fn(&dyn Fn(&Placed) -> f64) -> f64) -> Self {
        let eye = view.eye();
        Self { deepest: most(&|it| deepest(view, it)), farthest: most(&|it| farthest(eye, it)).max(0.0) }
    }

    fn union(self, other: Self) -> Self {
        Self { deepest: self.deepest.max(other.deepest), farthest: self.farthest.max(other.farthest) }
    }
}

/// View depth of the deepest point of a box.
fn deepest(view: &View, placed: &Placed) -> f64 {
    let forward = view.forward();
    forward.dot(placed.center - view.eye()) + forward.abs().dot(placed.half)
}

/// Distance from the camera to the farthest point of a box in metres.
fn farthest(eye: DVec3, placed: &Placed) -> f64 {
    ((placed.center - eye).abs() + placed.half).length()
}

/// Distances from the camera in metres beyond which the image shows nothing, or almost nothing:
/// where receivers begin, and where those end that begin nearer.
fn visible_distances(frame: &Frame<'_>) -> [f64; 2] {
    let (eye, frustum) = (frame.view.eye(), frame.view.frustum());
    let side = DVec2::new(frustum.left.abs().max(frustum.right.abs()), frustum.bottom.abs().max(frustum.top.abs()));
    let most = match frustum.projection {
        Projection::Perspective => frustum.far * maths::hypot(side.length(), 1.0),
        Projection::Orthographic => maths::hypot(frustum.far.abs().max(frustum.near.abs()), side.length()),
    };
    if frustum.projection == Projection::Orthographic {
        return [most; 2];
    }
    let picture = (frustum.right - frustum.left) * (frustum.top - frustum.bottom);
    let Some(end) = Shares { frame, most, picture }.kept() else { return [most; 2] };
    let reach = |within: f64| {
        let measure = |r: &Placed| if r.distance_to(eye) <= within { farthest(eye, r) } else { NOTHING };
        frame.receivers.most(measure).max(0.0)
    };
    let kept = reach(end).min(most);
    if reach(most).min(most) > MUCH_FARTHER * kept { [end, kept] } else { [most; 2] }
}

/// Shares of the image that receivers fill, by their distance.
struct Shares<'a> {
    frame: &'a Frame<'a>,
    /// Distance in metres beyond which the camera shows nothing.
    most: f64,
    /// Area of the image in tangents squared.
    picture: f64,
}

impl Shares<'_> {
    /// The distance beyond which all receivers together are almost nothing; `None` if that leaves
    /// none out.
    fn kept(&self) -> Option<f64> {
        // From the farthest class to the nearest, as long as all that is left out is next to
        // nothing. Shares are summed as whole numbers, in any order: the sum does not depend on it.
        let mut sum = 0;
        let mut class = self.farthest_class(f64::INFINITY)?;
        let farthest = class;
        loop {
            self.add(class, &mut sum);
            let begin = begin_of(class);
            if sum >= LEAST_UNITS {
                return (class < farthest).then_some((2.0 * begin).next_down());
            }
            class = self.farthest_class(begin)?.min(class.checked_sub(1)?);
        }
    }

    /// The class of the farthest receiver that is nearer than `within` metres.
    fn farthest_class(&self, within: f64) -> Option<usize> {
        let eye = self.frame.view.eye();
        let is_there = |distance: f64| distance <= self.most && distance < within;
        let of = |distance: f64| class(distance) as f64;
        // A box holds points at most so far away, or at least so near.
        let bound = |r: &Placed| match is_there(r.distance_to(eye)) {
            true => of(farthest(eye, r).min(self.most).min(within)),
            false => NOTHING,
        };
        let measure = |r: &Placed| Some(r.distance_to(eye)).filter(|&it| is_there(it)).map_or(NOTHING, of);
        let class = self.frame.receivers.most_within(bound, measure);
        (class > NOTHING).then_some(class as usize)
    }

    /// Adds the shares of a class, until the sum is large enough.
    fn add(&self, of: usize, sum: &mut u64) {
        let eye = self.frame.view.eye();
        let (begin, end) = (begin_of(of), begin_of(of + 1));
        let begin = if of == 0 { 0.0 } else { begin * (1.0 - 1e-9) };
        let end = if of == CLASSES - 1 { f64::INFINITY } else { end * (1.0 + 1e-9) };
        let end = end.min(self.most);
        let total = std::cell::Cell::new(*sum);
        let may_be = |r: &Placed| total.get() < LEAST_UNITS && r.distance_to(eye) <= end && farthest(eye, r) >= begin;
        self.frame.receivers.each(may_be, |_, receiver| {
            let distance = receiver.distance_to(eye);
            if distance <= self.most && class(distance) == of {
                let size = receiver.half.length() / distance.max(1e-9);
                let share = (std::f64::consts::PI * size * size / self.picture).min(1.0);
                total.set(total.get() + (UNITS * share) as u64);
            }
        });
        *sum = total.get();
    }
}

/// The class of a distance.
fn class(distance: f64) -> usize {
    (maths::doubling(distance) + NEAREST).clamp(0, CLASSES as i32 - 1) as usize
}

/// Begin of a class in metres.
fn begin_of(class: usize) -> f64 {
    maths::exp2(class as f64 - f64::from(NEAREST))
}

/// The whole image as a whole number of units.
const UNITS: f64 = (1u64 << 40) as f64;

/// [`LEAST_SHARE`] in [`UNITS`].
const LEAST_UNITS: u64 = (LEAST_SHARE * UNITS) as u64;

/// The shadows of a frame.
struct Shadows<'a> {
    frame: &'a Frame<'a>,
    direction: DVec3,
    distance: f64,
}

impl Shadows<'_> {
    /// Depth and distance of the farthest shadow within `bounds`, the box around all receivers.
    fn reach(&self, bounds: &Aabb) -> Reach {
        let mut reach = Reach::NONE;
        if bounds.is_empty() {
            return reach;
        }
        let Frame { view, casters, receivers, .. } = self.frame;
        let sheets = self.sheets(bounds);
        let is_sheet = |caster: &Placed| sheets.iter().flatten().any(|(_, sheet)| sheet == caster);
        let is_void =
            |caster: &Placed| lies_below(caster.center, caster.half, bounds, self.direction, 0.0) || is_sheet(caster);
        let shadow = |caster: &Placed, within: &Aabb, of: &dyn Fn(&Placed) -> f64| {
            self.shadow(caster, within).map_or(NOTHING, |shadow| of(&shadow))
        };
        reach = reach.union(Reach::most(view, |of| {
            casters.most_within(
                |it| shadow(it, bounds, of),
                |it| if is_void(it) { NOTHING } else { shadow(it, bounds, of) },
            )
        }));
        // A sheet, such as a ground that something reaches below of, shades nothing of its own.
        for (_, sheet) in sheets.iter().flatten() {
            reach = reach.union(Reach::most(view, |of| {
                let on = |receiver: &Placed| shadow(sheet, &receiver.bounds(), of);
                receivers.most_within(on, |receiver| if receiver == sheet { NOTHING } else { on(receiver) })
            }));
        }
        reach
    }

    /// The first casters, by name, that have no thickness and lie above some receiver.
    fn sheets(&self, bounds: &Aabb) -> [Option<(u32, Placed)>; MOST_SHEETS] {
        let mut sheets = [None; MOST_SHEETS];
        self.frame.casters.flats(|name, caster| {
            if lies_below(caster.center, caster.half, bounds, self.direction, 0.0) {
                return;
            }
            let comes_first = |sheet: &Option<(u32, Placed)>| sheet.is_none_or(|(other, _)| name < other);
            if let Some(at) = sheets.iter().position(comes_first) {
                sheets[at..].rotate_right(1);
                sheets[at] = Some((name, *caster));
            }
        });
        sheets
    }

    /// The part of `within` that a caster, or any caster in a box, can shade; `None` if that is
    /// empty, or too far away to be relevant.
    fn shadow(&self, caster: &Placed, within: &Aabb) -> Option<Placed> {
        let (enter, leave) = self.passage(caster, within)?;
        let (begin, end) = (caster.center + enter * self.direction, caster.center + leave * self.direction);
        let lo = (begin.min(end) - caster.half).max(within.min);
        let hi = (begin.max(end) + caster.half).min(within.max);
        let shadow = Placed::from(Aabb::new(lo.min(hi), hi));
        (shadow.distance_to(self.frame.view.eye()) <= self.distance).then_some(shadow)
    }

    /// Interval of travel along the light, in metres, in which a caster's box meets another box;
    /// `None` if it never does.
    fn passage(&self, caster: &Placed, within: &Aabb) -> Option<(f64, f64)> {
        let (lo, hi) = (within.min - caster.half - caster.center, within.max + caster.half - caster.center);
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let along = self.direction[axis];
            if along.abs() < 1e-12 {
                if lo[axis] > 0.0 || hi[axis] < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (lo[axis] / along, hi[axis] / along);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        (enter <= leave).then_some((enter, leave))
    }
}
