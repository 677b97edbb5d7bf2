//! Rectangles of approximately stabilised maps: their edges change in steps, on axes that are fixed
//! to the light.

use glam::DVec2;

use super::size::ENOUGH;
use crate::config::ExtentSteps;
use crate::geometry::region::{DIRECTIONS, Region};
use crate::maths;

/// Relative room for rounding, so that an extent that stays constant while the camera walks also
/// keeps its step.
const ROUNDING: f64 = 1e-9;

/// Orientation, position and extent of an approximately stabilised map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    /// Index of the u axis in the fan of directions; v is a quarter turn further.
    pub direction: usize,
    /// Centre along u and v in metres.
    pub center: DVec2,
    /// Extent along u and v in metres.
    pub extent: DVec2,
}

impl Rectangle {
    pub fn area(&self) -> f64 {
        self.extent.x * self.extent.y
    }

    /// The rectangle of an extent with its centre in that of `target`.
    fn centered(target: &Region, direction: usize, extent: DVec2) -> Self {
        let (lo, hi) = target.bounds(direction);
        Self { direction, center: 0.5 * (lo + hi), extent }
    }

    /// The smallest rectangle along `direction` with edges of whole steps.
    fn around(target: &Region, direction: usize, steps: ExtentSteps, whole: f64) -> Self {
        let needed = needed(target, direction);
        let extent = match steps {
            ExtentSteps::PerDoubling(count) => {
                let steps = f64::from(count);
                let round_up = |extent: f64| {
                    maths::exp2((steps * maths::log2(extent * (1.0 + ROUNDING))).ceil() / steps).max(extent)
                };
                needed.map(round_up)
            }
            ExtentSteps::Levels(count) => {
                let level = whole / f64::from(count);
                (needed / level - ROUNDING).ceil().max(DVec2::ONE) * level * (1.0 + ROUNDING)
            }
        };
        Self::centered(target, direction, extent)
    }

    /// This rectangle around `target`, with those edges made longer that are too short.
    fn grown_to(&self, target: &Region, steps: ExtentSteps, whole: f64) -> Self {
        let needed = needed(target, self.direction);
        let around = Self::around(target, self.direction, steps, whole);
        Self { extent: DVec2::select(needed.cmple(self.extent), self.extent, around.extent), ..around }
    }

    /// The rectangle of least area in whole steps. The levels of the source have one orientation.
    fn least(target: &Region, steps: ExtentSteps, whole: f64) -> Self {
        let around = |direction| Self::around(target, direction, steps, whole);
        let directions = match steps {
            ExtentSteps::PerDoubling(_) => DIRECTIONS / 2,
            ExtentSteps::Levels(_) => 1,
        };
        (1..directions).map(around).fold(around(0), |best, other| {
            // Steps make ties of rectangles that differ by rounding only; the first stays.
            if other.area() < best.area() * (1.0 - ROUNDING) { other } else { best }
        })
    }
}

/// Goal of a rectangle that grows before planes move.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Goal {
    rectangle: Rectangle,
    /// Extent in metres of what it serves by the new planes; `None` if that is nothing.
    needed: Option<DVec2>,
}

/// Holds a rectangle from frame to frame for as long as it serves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HeldRectangle {
    held: Option<Rectangle>,
    /// Goal before planes move, while the camera stands still.
    goal: Option<Goal>,
    /// Factor by which edges were too long at the last frame; 1 if that is not worth a step.
    excess: f64,
}

impl HeldRectangle {
    /// The rectangle for `target`. `whole` is the width of the unsplit light frustum in metres, of
    /// which the steps of \[PCSM\] are fractions.
    ///
    /// With geometric steps a rectangle grows where it has to. It is kept while it is at most one
    /// step larger along each edge (or two along one) than the best one, which is the smallest in
    /// whole steps along any of the fan's directions. The steps of the source have neither
    /// orientation nor memory.
    pub fn hold(&mut self, target: &Region, steps: ExtentSteps, whole: f64) -> Rectangle {
        let best = Rectangle::least(target, steps, whole);
        let enough = best.area() * most_excess(steps);
        let grown = self.held.map(|held| held.grown_to(target, steps, whole));
        let rectangle = grown.filter(|grown| grown.area() <= enough).unwrap_or(best);
        *self = Self { held: Some(rectangle), goal: None, excess: 1.0 };
        rectangle
    }

    /// The rectangle for `target` while the camera stands still: it changes by `stride` alone, or
    /// where `target` has moved and leaves no choice.
    pub fn approach(&mut self, target: &Region, (steps, whole): (ExtentSteps, f64), stride: Stride) -> Rectangle {
        let Some(held) = self.held else { return self.hold(target, steps, whole) };
        let best = Rectangle::least(target, steps, whole);
        let moved = match stride {
            Stride::Stay => held,
            Stride::Grow(step) => self.goal.map_or(held, |goal| held.towards(&goal.rectangle, step)),
            Stride::Shrink(step) => match held.aim(target, &best, (steps, whole)) {
                Aim::Same(own) => held.towards(&own, step),
                Aim::Turned => held.turned(&best, step),
            },
        };
        let rectangle = moved.serving(target, steps, whole);
        self.held = Some(rectangle);
        let is_enough = rectangle.area() <= best.area() * worth_keeping(steps);
        self.excess = match rectangle.aim(target, &best, (steps, whole)) {
            _ if is_enough => 1.0,
            Aim::Same(own) => (rectangle.extent / own.extent).max_element(),
            // One edge may have it all.
            Aim::Turned => rectangle.area() / best.area(),
        };
        rectangle
    }

    /// Lets the rectangle grow until it contains what it serves by the present planes and by new
    /// ones. `by_new` bounds the latter alone; `None` if nothing is left for it to serve.
    pub fn set_goal(&mut self, by_both: &Region, by_new: Option<&Region>) {
        self.goal = self.held.map(|held| Goal {
            rectangle: held.including(by_both),
            needed: by_new.map(|region| needed(region, held.direction)),
        });
    }

    /// Begins with the best rectangle for what a map serves by new planes, if it has no casters by
    /// the present ones.
    pub fn begin(&mut self, by_both: Option<&Region>, steps: ExtentSteps, whole: f64) {
        let held = by_both.map(|region| Rectangle::least(region, steps, whole));
        *self = Self { held, goal: None, excess: 1.0 };
    }

    /// Changes nothing in a frame in which the map has no casters.
    pub fn rest(&mut self) {
        (self.goal, self.excess) = (None, 1.0);
    }

    /// Limits the goal: a map with texels as large as the next one's, of which `next` square metres
    /// would be such a map, shows no more than that one. So it need not grow any more, wherever it
    /// moves to with the planes. A map that will serve nothing has to grow so far, and one that
    /// begins to serve begins so, as the next map has answered for its points so far.
    pub fn limit_goal(&mut self, next: f64) {
        let Some(held) = &mut self.held else { return };
        let like_next = held.enlarged_to(next);
        match &mut self.goal {
            None => *held = like_next,
            Some(goal) => {
                let is_enough = goal.needed.is_none_or(|needed| {
                    goal.rectangle.area() > like_next.area() && needed.cmple(like_next.extent).all()
                });
                if is_enough {
                    goal.rectangle = like_next;
                }
            }
        }
    }

    /// Area in square metres to which it grows, if anything is held.
    pub fn goal_area(&self) -> Option<f64> {
        self.goal.map(|goal| goal.rectangle).or(self.held).map(|rectangle| rectangle.area())
    }

    /// Forgets what it was to grow to.
    pub fn clear_goal(&mut self) {
        self.goal = None;
    }

    /// Factor by which the edges of the map have to grow to contain what it serves by the new
    /// planes.
    pub fn growth(&self) -> f64 {
        self.held.zip(self.goal).map_or(1.0, |(held, goal)| (goal.rectangle.extent / held.extent).max_element())
    }

    /// Factor by which the longer edges of the map have to shrink, as of the last frame; 1 if they
    /// are hardly too long.
    pub fn excess(&self) -> f64 {
        self.excess
    }

    /// The longest edge in metres; 0 if nothing is held.
    pub fn longest_edge(&self) -> f64 {
        self.held.map_or(0.0, |held| held.extent.max_element())
    }
}

/// Ratio of areas up to which a rectangle is kept although another one would be smaller.
fn most_excess(steps: ExtentSteps) -> f64 {
    let excess = match steps {
        ExtentSteps::PerDoubling(count) => maths::exp2(2.0 / f64::from(count)),
        ExtentSteps::Levels(_) => 1.0,
    };
    excess * (1.0 + ROUNDING)
}

/// Ratio of areas up to which a rectangle is kept although a smaller one is wanted.
fn worth_keeping(steps: ExtentSteps) -> f64 {
    most_excess(steps).min(ENOUGH * ENOUGH)
}

/// The rectangle that a larger one shrinks to.
enum Aim {
    /// Along the same axes.
    Same(Rectangle),
    /// The best one, along others.
    Turned,
}

/// Change of a rectangle in a frame of a camera that stands still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stride {
    Stay,
    /// Towards its goal, each edge by this factor at most.
    Grow(f64),
    /// Towards the best rectangle, each edge by this factor at most.
    Shrink(f64),
}

impl Stride {
    /// The factor by which an edge grows at most.
    pub fn most(self) -> f64 {
        match self {
            Self::Grow(step) => step,
            Self::Stay | Self::Shrink(_) => 1.0,
        }
    }
}

/// Changes of a rectangle while the camera stands still.
impl Rectangle {
    /// A rectangle between this one and `goal`, along the axes of both. Each edge changes by the
    /// factor `step` at most.
    fn towards(&self, goal: &Self, step: f64) -> Self {
        let extent = goal.extent.clamp(self.extent / step, self.extent * step);
        let (way, whole_way) = (extent - self.extent, goal.extent - self.extent);
        let is_there = |axis: usize| extent[axis] == goal.extent[axis];
        let share = |axis: usize| if is_there(axis) { 1.0 } else { way[axis] / whole_way[axis] };
        let center = self.center + DVec2::new(share(0), share(1)) * (goal.center - self.center);
        Self { center, extent, ..*self }
    }

    /// Aim of a rectangle that shrinks to `target`, of which `best` is the least rectangle: along
    /// these axes if that is hardly larger.
    fn aim(&self, target: &Region, best: &Self, (steps, whole): (ExtentSteps, f64)) -> Aim {
        let own = Self::around(target, self.direction, steps, whole);
        if own.area() <= best.area() * worth_keeping(steps) { Aim::Same(own) } else { Aim::Turned }
    }

    /// A rectangle along the axes of `best` and around it, smaller than this one by `step` squared
    /// in area where that is enough.
    fn turned(&self, best: &Self, step: f64) -> Self {
        best.enlarged_to(self.area() / (step * step))
    }

    /// This rectangle with a larger area: a square, if that is large enough, or else with its
    /// shorter edges made longer. So no edge is longer than it has to be.
    fn enlarged_to(&self, area: f64) -> Self {
        let area = area.max(self.area());
        let (is_wide, longest) = (self.extent.x >= self.extent.y, self.extent.max_element());
        let long = longest.max(area.sqrt());
        let short = area / long;
        let extent = if is_wide { DVec2::new(long, short) } else { DVec2::new(short, long) };
        Self { extent: extent.max(self.extent), ..*self }
    }

    /// This rectangle moved as little as possible to contain `target`, with those edges made longer
    /// that are too short.
    fn serving(&self, target: &Region, steps: ExtentSteps, whole: f64) -> Self {
        let around = Self::around(target, self.direction, steps, whole);
        let needed = needed(target, self.direction);
        let extent = DVec2::select(needed.cmple(self.extent * (1.0 + ROUNDING)), self.extent, around.extent);
        let room = (0.5 * (extent - needed)).max(DVec2::ZERO);
        let center = self.center.clamp(around.center - room, around.center + room);
        Self { direction: self.direction, center, extent }
    }

    /// This rectangle, with edges moved outwards to contain `target`.
    fn including(&self, target: &Region) -> Self {
        let (lo, hi) = target.bounds(self.direction);
        let lo = lo.min(self.center - 0.5 * self.extent);
        let hi = hi.max(self.center + 0.5 * self.extent);
        Self { center: 0.5 * (lo + hi), extent: (hi - lo).max(self.extent), ..*self }
    }
}

/// The longest possible edge of a held rectangle for a target that is `widest` metres wide: two
/// steps of rounding and two of hysteresis, if all of them fall on one edge.
pub(crate) fn longest_edge(steps: ExtentSteps, widest: f64, whole: f64) -> f64 {
    match steps {
        ExtentSteps::PerDoubling(count) => widest * maths::exp2(4.0 / f64::from(count)),
        ExtentSteps::Levels(count) => widest + whole / f64::from(count),
    }
}

/// The extent of `target` along a direction and across it. A target without width (a wall seen
/// edge-on by the light) still gets a small extent.
fn needed(target: &Region, direction: usize) -> DVec2 {
    let (lo, hi) = target.bounds(direction);
    let longest = (hi - lo).max_element();
    (hi - lo).max(DVec2::splat(1e-3 * longest.max(1e-3)))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::region::Fan;

    /// A box of `w` by `h` metres seen from above, turned by `angle`.
    fn turned(w: f64, h: f64, angle: f64) -> Region {
        let fan = Fan::new(DVec3::X, DVec3::NEG_Y);
        let (sin, cos) = angle.sin_cos();
        let mut region = Region::EMPTY;
        for (x, y) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
            let (x, y) = (x * w, y * h);
            region.include_point(&fan, DVec3::new(x * cos - y * sin, 0.0, x * sin + y * cos));
        }
        region
    }

    const STEPS: ExtentSteps = ExtentSteps::PerDoubling(8);
    const STEP: f64 = 1.090_507_732_665_257_7;

    #[test]
    fn an_extent_is_rounded_up_to_a_power_of_the_step() {
        let mut held = HeldRectangle::default();
        let rectangle = held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0);
        assert_eq!(rectangle.direction, 0);
        // 2^(54/8) = 107.6 is the first above 100, 2^(43/8) = 41.5 the first above 40.
        assert!((rectangle.extent - DVec2::new(2f64.powf(54.0 / 8.0), 2f64.powf(43.0 / 8.0))).length() < 1e-9);
    }

    #[test]
    fn one_step_of_hysteresis_in_either_direction() {
        let mut held = HeldRectangle::default();
        let first = held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0);
        for (w, h) in [(107.0, 41.0), (100.0 / STEP, 40.0), (107.0, 41.4 / STEP), (96.0, 37.0), (100.0, 40.0)] {
            assert_eq!(held.hold(&turned(w, h, 0.0), STEPS, 0.0), first, "{w} × {h}");
        }
        let larger = held.hold(&turned(108.0, 40.0, 0.0), STEPS, 0.0);
        assert!((larger.extent.x / first.extent.x - STEP).abs() < 1e-9, "one step up");
        assert_eq!(held.hold(&turned(100.0, 40.0, 0.0), STEPS, 0.0), larger, "and not down again at once");
        let smaller = held.hold(&turned(60.0, 40.0, 0.0), STEPS, 0.0);
        assert!(smaller.extent.x < larger.extent.x / STEP.powi(2));
    }

    #[test]
    fn the_rectangle_turns_with_its_target_now_and_then() {
        let (mut held, mut changes, mut area) = (HeldRectangle::default(), 0, 0.0);
        let mut before = None;
        for k in 0..524 {
            let target = turned(120.0, 70.0, 0.003 * f64::from(k));
            let rectangle = held.hold(&target, STEPS, 0.0);
            assert!(needed(&target, rectangle.direction).cmple(rectangle.extent).all());
            changes += i32::from(before.is_some_and(|before| before != rectangle));
            area += rectangle.area() / (120.0 * 70.0) / 524.0;
            before = Some(rectangle);
        }
        // A quarter turn in steps of 0.003 rad.
        assert!(changes < 524 / 10, "{changes} changes");
        assert!(area < 1.3, "{area} times the area on average");
    }

    #[test]
    fn the_source_counts_levels_of_the_whole_frustum() {
        let mut held = HeldRectangle::default();
        let of = |held: &mut HeldRectangle, w| held.hold(&turned(w, 40.0, 0.0), ExtentSteps::Levels(64), 640.0).extent;
        // s = 640 / 101, 64 / s = 10.1, s_q = 64 / 11: 110 m.
        assert!((of(&mut held, 101.0) - DVec2::new(110.0, 40.0)).length() < 1e-6);
        assert!((of(&mut held, 100.0) - DVec2::new(100.0, 40.0)).length() < 1e-6, "no hysteresis");
        assert!((of(&mut held, 0.5).x - 10.0).abs() < 1e-6, "the first level is all that a near split gets");
    }

    #[test]
    fn no_edge_is_longer_than_promised() {
        let mut held = HeldRectangle::default();
        for k in 0..400 {
            let wave = 1.0 + 0.3 * (f64::from(k) * 0.37).sin();
            let target = turned(100.0 * wave, 40.0 / wave, f64::from(k) * 0.01);
            let edge = held.hold(&target, STEPS, 0.0).extent.max_element();
            assert!(edge <= longest_edge(STEPS, target.widest(), 0.0), "{edge}");
        }
    }

    /// Returns whether a rectangle shows all of a target.
    fn shows(rectangle: &Rectangle, target: &Region) -> bool {
        let (lo, hi) = target.bounds(rectangle.direction);
        let reach = 0.5 * rectangle.extent * (1.0 + 1e-9);
        (rectangle.center - reach).cmple(lo).all() && (rectangle.center + reach).cmpge(hi).all()
    }

    #[test]
    fn a_rectangle_grows_to_both_targets_step_by_step_and_shrinks_to_the_new_one() {
        let fan = Fan::new(DVec3::X, DVec3::NEG_Y);
        let (now, mut both, mut new) = (turned(10.0, 4.0, 0.0), turned(10.0, 4.0, 0.0), Region::EMPTY);
        for (x, z) in [(20.0, 0.0), (26.0, 6.0), (27.0, 4.0)] {
            new.include_point(&fan, DVec3::new(x, 0.0, z));
        }
        both.include_region(&new);
        let mut held = HeldRectangle::default();
        let mut before = held.hold(&now, STEPS, 0.0);
        held.set_goal(&both, Some(&new));
        let mut frames = 0;
        let mut step = |held: &mut HeldRectangle, target: &Region, stride| {
            let after = held.approach(target, (STEPS, 0.0), stride);
            assert!(shows(&after, target), "{after:?}");
            let texel = (after.area() / before.area()).sqrt();
            assert!(texel < STEP + 1e-9 && texel > 1.0 / STEP - 1e-9, "{before:?} to {after:?}");
            (before, frames) = (after, frames + 1);
            after
        };
        while held.growth() > 1.0 + ROUNDING {
            step(&mut held, &now, Stride::Grow(STEP));
        }
        assert!(shows(&step(&mut held, &now, Stride::Stay), &both));
        step(&mut held, &new, Stride::Stay);
        while held.excess() > 1.0 {
            step(&mut held, &new, Stride::Shrink(STEP));
        }
        let best = HeldRectangle::default().hold(&new, STEPS, 0.0);
        assert!((10..80).contains(&frames) && before.area() <= best.area() * most_excess(STEPS), "{frames} frames");
    }

    #[test]
    fn a_map_grows_no_larger_than_the_next_and_begins_as_large() {
        let (small, large) = (turned(10.0, 4.0, 0.0), turned(100.0, 40.0, 0.0));
        let mut held = HeldRectangle::default();
        held.hold(&small, STEPS, 0.0);
        held.set_goal(&large, Some(&small));
        held.limit_goal(400.0);
        assert!((held.goal_area().expect("a goal") - 400.0).abs() < 1e-9);
        // What it has to show by the new planes does not fit into that.
        held.set_goal(&large, Some(&large));
        held.limit_goal(400.0);
        assert!(held.goal_area().expect("a goal") >= 4000.0);
        // Nothing is left to show.
        held.set_goal(&small, None);
        held.limit_goal(400.0);
        assert!((held.goal_area().expect("a goal") - 400.0).abs() < 1e-9);
        held.begin(Some(&small), STEPS, 0.0);
        held.limit_goal(400.0);
        let first = held.approach(&small, (STEPS, 0.0), Stride::Stay);
        assert!((first.area() - 400.0).abs() < 1e-9 && shows(&first, &small), "{first:?}");
        held.begin(None, STEPS, 0.0);
        assert_eq!((held.goal_area(), held.growth(), held.excess()), (None, 1.0, 1.0));
    }
}
