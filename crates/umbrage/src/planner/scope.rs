//! Stage 0 of a sun's plan: how far the shadows reach that a frame can show, whichever way the camera turns.
//!
//! A range that ends with the scene wastes its splits where the scene is a few boxes on a ground of a thousand kilometres, or
//! where one hut stands beyond the horizon. What counts is where shadows fall: each caster's box, swept along the light
//! through the box around all receivers.

use glam::{DVec2, DVec3};

use super::frame::{Frame, Sun};
use crate::bounds::Placed;
use crate::geometry::volume::{lies_below, rounding};
use crate::{Aabb, Projection, View};

/// Receivers that fill less than this share of the picture together, and lie beyond all others, have no say in the range.
const LEAST_SHARE: f64 = 1e-4;

/// Receivers beyond have no say only where the range would be this many times as long with them.
const MUCH_FARTHER: f64 = 4.0;

/// The range ends at this many times the depth of the deepest shadow, at most. Lower: sharper, but the range follows the
/// casters. Higher: blurred.
const SLACK: f64 = 1.5;

/// A view that looks away from all shadows has this share of their greatest distance for its range.
const LOOKING_AWAY: f64 = 0.5;

/// Classes of distance, one for each doubling, from 2^-[`NEAREST`] m on.
const CLASSES: usize = 96;
const NEAREST: f64 = 32.0;

/// Casters without thickness whose shadows are looked for receiver by receiver; more are taken for the worst.
const MOST_SHEETS: usize = 8;

/// What of the scene matters to a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scope {
    /// Metres from the eye beyond which no receiver matters.
    pub distance: f64,
    /// View depth of the deepest receiver of all.
    pub deepest_receiver: f64,
    /// That of the deepest receiver that matters, or of the deepest shadow with [`SLACK`], whichever is less.
    pub deepest: f64,
    /// As `deepest`, by distance from the eye.
    pub farthest: f64,
    /// Metres from the eye to the box around all receivers.
    pub nearest: f64,
}

impl Scope {
    pub fn new(frame: &Frame<'_>, sun: &Sun<'_>) -> Self {
        let distance = visible_distance(frame);
        let (mut bounds, mut all) = (Aabb::EMPTY, Reach::NONE);
        let eye = frame.view.eye();
        for receiver in frame.receivers.iter().filter(|r| r.distance_to(eye) <= distance) {
            bounds = bounds.union(receiver.bounds());
            all.include(frame.view, receiver);
        }
        let mut every = Reach::NONE;
        frame.receivers.iter().for_each(|receiver| every.include(frame.view, receiver));
        let nearest = if bounds.is_empty() { 0.0 } else { Placed::from(bounds).distance_to(frame.view.eye()) };
        let shadows = Shadows { frame, direction: sun.direction, distance }.reach(&bounds);
        let (mut deepest, mut farthest) = (all.deepest, all.farthest);
        if shadows.farthest > 0.0 {
            let ahead = (SLACK * shadows.deepest).max(LOOKING_AWAY * shadows.farthest);
            (deepest, farthest) = (deepest.min(ahead), farthest.min(SLACK * shadows.farthest));
        }
        Self { distance, deepest_receiver: every.deepest, deepest, farthest, nearest }
    }
}

impl Scope {
    /// The receivers that matter.
    pub fn receivers<'a>(&self, frame: &Frame<'a>) -> impl Iterator<Item = &'a Placed> + use<'a> {
        let (eye, distance) = (frame.view.eye(), self.distance);
        frame.receivers.iter().filter(move |receiver| receiver.distance_to(eye) <= distance)
    }
}

/// Depth and distance of the farthest of some boxes.
#[derive(Clone, Copy, Debug)]
struct Reach {
    deepest: f64,
    farthest: f64,
}

impl Reach {
    const NONE: Self = Self { deepest: f64::NEG_INFINITY, farthest: 0.0 };

    fn include(&mut self, view: &View, placed: &Placed) {
        let (forward, from_eye) = (view.forward(), placed.center - view.eye());
        self.deepest = self.deepest.max(forward.dot(from_eye) + forward.abs().dot(placed.half));
        self.farthest = self.farthest.max((from_eye.abs() + placed.half).length());
    }
}

/// Metres from the eye beyond which the picture shows nothing, or next to nothing.
fn visible_distance(frame: &Frame<'_>) -> f64 {
    let (eye, frustum) = (frame.view.eye(), frame.view.frustum());
    let side = DVec2::new(frustum.left.abs().max(frustum.right.abs()), frustum.bottom.abs().max(frustum.top.abs()));
    let most = match frustum.projection {
        Projection::Perspective => frustum.far * side.length().hypot(1.0),
        Projection::Orthographic => frustum.far.abs().max(frustum.near.abs()).hypot(side.length()),
    };
    if frustum.projection == Projection::Orthographic {
        return most;
    }
    let picture = (frustum.right - frustum.left) * (frustum.top - frustum.bottom);
    let mut shares = [0.0; CLASSES];
    let class = |distance: f64| (distance.log2() + NEAREST).clamp(0.0, (CLASSES - 1) as f64) as usize;
    for receiver in frame.receivers {
        let distance = receiver.distance_to(eye);
        if distance <= most {
            let size = receiver.half.length() / distance.max(1e-9);
            shares[class(distance)] += (std::f64::consts::PI * size * size / picture).min(1.0);
        }
    }
    // From the farthest class to the nearest, as long as all that is left out is next to nothing.
    let mut sum = 0.0;
    let first_kept = (0..CLASSES).rev().find(|&class| {
        sum += shares[class];
        sum >= LEAST_SHARE
    });
    let Some(kept) = first_kept else { return most };
    let end = 2f64.powf(kept as f64 + 1.0 - NEAREST).next_down();
    let farthest = |within: f64| {
        let near = frame.receivers.iter().filter(|r| r.distance_to(eye) <= within);
        near.map(|r| ((r.center - eye).abs() + r.half).length()).fold(0.0, f64::max)
    };
    if farthest(most).min(most) > MUCH_FARTHER * farthest(end).min(most) { end } else { most }
}

/// Where the shadows of a frame fall.
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
        let (mut sheets, mut count) = ([0; MOST_SHEETS], 0);
        let flat = |caster: &Placed| 2.0 * caster.half.min_element() <= rounding(caster.half);
        for (i, caster) in self.frame.casters.iter().enumerate() {
            if lies_below(caster.center, caster.half, bounds, self.direction, 0.0) {
                continue;
            }
            if flat(caster) && count < MOST_SHEETS {
                (sheets[count], count) = (i, count + 1);
                continue;
            }
            self.include(&mut reach, caster, bounds);
        }
        // A sheet, such as a ground that something reaches below of, shades nothing of its own.
        for caster in sheets[..count].iter().map(|&i| &self.frame.casters[i]) {
            let others = self.frame.receivers.iter().filter(|receiver| *receiver != caster);
            others.for_each(|receiver| self.include(&mut reach, caster, &receiver.bounds()));
        }
        reach
    }

    /// Takes the part of `within` that a caster can shade.
    fn include(&self, reach: &mut Reach, caster: &Placed, within: &Aabb) {
        let Some((enter, leave)) = self.passage(caster, within) else { return };
        let (begin, end) = (caster.center + enter * self.direction, caster.center + leave * self.direction);
        let lo = (begin.min(end) - caster.half).max(within.min);
        let hi = (begin.max(end) + caster.half).min(within.max);
        let shadow = Placed::from(Aabb::new(lo.min(hi), hi));
        if shadow.distance_to(self.frame.view.eye()) <= self.distance {
            reach.include(self.frame.view, &shadow);
        }
    }

    /// Between how many metres of travel along the light a caster's box meets another; `None` if it never does.
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
